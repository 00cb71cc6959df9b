//! Python bindings: values in, values out. Defaults, names and documentation for users are in `python/riss`.
//!
//! Reading order: [`case`], [`analysis`] (a run, and how it talks to Python), [`step`] (what it leaves behind),
//! [`solid`] and [`solid_analysis`] (the same of solids), [`approximation`] (fields and shape functions anywhere), [`error`].

mod analysis;
mod approximation;
mod case;
mod error;
mod solid;
mod solid_analysis;
mod step;

use pyo3::prelude::*;

/// The compiled part of `riss`.
#[pymodule]
fn _riss(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("CaseError", module.py().get_type::<error::CaseError>())?;
    module.add("AnalysisError", module.py().get_type::<error::AnalysisError>())?;
    module.add_class::<case::Case>()?;
    module.add_class::<step::Step>()?;
    module.add_class::<step::State>()?;
    module.add_class::<solid::SolidCase>()?;
    module.add_class::<solid::SolidStep>()?;
    module.add_class::<approximation::Approximation>()?;
    module.add_function(wrap_pyfunction!(case::schema, module)?)?;
    module.add_function(wrap_pyfunction!(case::solid_schema, module)?)?;
    module.add_function(wrap_pyfunction!(analysis::run, module)?)?;
    module.add_function(wrap_pyfunction!(solid_analysis::run_solid, module)?)?;
    module.add_function(wrap_pyfunction!(step::history_csv, module)?)?;
    module.add_function(wrap_pyfunction!(step::restart_state, module)?)
}
