//! Errors of the library as exceptions of Python, with the same text.

use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use riss::case::{CaseErrors, Problem};

pyo3::create_exception!(
    _riss,
    CaseError,
    PyValueError,
    "A case that is not valid. `problems` lists every one as a dict with `place`, `key`, `message`, `value`, `allowed` \
     and `suggestion`."
);
pyo3::create_exception!(_riss, AnalysisError, PyRuntimeError, "An analysis that could not be carried out.");

/// All problems of a case, one below the other.
pub fn of_case(errors: &CaseErrors) -> PyErr {
    let error = CaseError::new_err(errors.to_string());
    Python::attach(|py| {
        let list = problems(py, errors).and_then(|list| error.value(py).setattr("problems", list));
        match list {
            Ok(()) => error,
            Err(e) => e,
        }
    })
}

fn problems<'py>(py: Python<'py>, errors: &CaseErrors) -> PyResult<Bound<'py, PyList>> {
    let dict = |problem: &Problem| {
        let dict = PyDict::new(py);
        dict.set_item("place", errors.place(problem))?;
        dict.set_item("key", &problem.key)?;
        dict.set_item("message", &problem.message)?;
        dict.set_item("value", &problem.value)?;
        dict.set_item("allowed", &problem.allowed)?;
        dict.set_item("suggestion", &problem.suggestion)?;
        Ok(dict)
    };
    PyList::new(py, errors.problems.iter().map(dict).collect::<PyResult<Vec<_>>>()?)
}

/// A case that is wrong as a whole.
pub fn of_text(message: impl std::fmt::Display) -> PyErr {
    CaseError::new_err(message.to_string())
}

/// Of an analysis.
pub fn of_analysis(error: &riss::error::Error) -> PyErr {
    AnalysisError::new_err(error.to_string())
}

/// Of files, with the path.
pub fn of_files(path: &std::path::Path, error: &std::io::Error) -> PyErr {
    PyOSError::new_err(format!("{}: {error}", path.display()))
}
