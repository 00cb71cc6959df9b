//! Cases: read, parsed or put together from values.

use crate::error;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A valid case.
#[pyclass(frozen, module = "riss._riss")]
pub struct Case {
    /// What Rust knows.
    pub case: Arc<riss::case::Case>,
}

#[pymethods]
impl Case {
    /// From a file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, overrides: Vec<String>) -> PyResult<Self> {
        py.detach(|| riss::case::Case::read(&path, &overrides)).map(Self::of).map_err(|e| error::of_case(&e))
    }

    /// From the text of a file; files that it names are sought beside `path`.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, path: PathBuf, overrides: Vec<String>) -> PyResult<Self> {
        py.detach(|| riss::case::Case::parse(text, &path, &overrides)).map(Self::of).map_err(|e| error::of_case(&e))
    }

    /// From JSON with the sections of a case file.
    #[staticmethod]
    fn from_json(py: Python<'_>, json: &str, path: PathBuf) -> PyResult<Self> {
        let value: serde_json::Value = serde_json::from_str(json).map_err(error::of_text)?;
        let text = toml::to_string(&value).map_err(error::of_text)?;
        Self::parse(py, &text, path, vec![])
    }

    #[getter]
    fn title(&self) -> &str {
        &self.case.model.title
    }

    #[getter]
    fn text(&self) -> &str {
        &self.case.text
    }

    #[getter]
    fn path(&self) -> PathBuf {
        self.case.path.clone()
    }

    #[getter]
    fn overrides(&self) -> Vec<String> {
        self.case.overrides.clone()
    }

    /// What the author should know, although the case is valid.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.case.notes.iter().map(|note| format!("{}: {note}", self.case.place(note))).collect()
    }

    /// Most steps that growth may take; none if nothing grows.
    #[getter]
    fn growth_steps(&self) -> Option<usize> {
        self.case.growth.as_ref().map(|growth| growth.steps)
    }
}

impl Case {
    fn of(case: riss::case::Case) -> Self {
        Self { case: Arc::new(case) }
    }
}

/// The JSON schema of the case file.
#[pyfunction]
pub fn schema() -> String {
    riss::case::json_schema().to_string()
}

/// The JSON schema of the case file of a solid.
#[pyfunction]
pub fn solid_schema() -> String {
    riss::case::solid_json_schema().to_string()
}
