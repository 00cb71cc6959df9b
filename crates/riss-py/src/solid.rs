//! Solids in space: cases, and what a run leaves behind.

use crate::error;
use numpy::{PyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::exceptions::{PyIndexError, PyKeyError};
use pyo3::prelude::*;
use riss::analysis::{OpenedCrack, SolidResult};
use riss::case::AnyCase;
use riss::math::Vector3;
use riss::output::SolidResults;
use std::path::PathBuf;
use std::sync::Arc;

/// A valid case of a solid.
#[pyclass(frozen, module = "riss._riss")]
pub struct SolidCase {
    /// What Rust knows.
    pub case: Arc<riss::case::SolidCase>,
}

#[pymethods]
impl SolidCase {
    /// From a file; none if it is not that of a solid.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, overrides: Vec<String>) -> PyResult<Option<Self>> {
        py.detach(|| AnyCase::read(&path, &overrides)).map(Self::of).map_err(|e| error::of_case(&e))
    }

    /// From the text of a file; none if it is not that of a solid.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, path: PathBuf, overrides: Vec<String>) -> PyResult<Option<Self>> {
        py.detach(|| AnyCase::parse(text, &path, &overrides)).map(Self::of).map_err(|e| error::of_case(&e))
    }

    /// From JSON with the sections of a case file; none if it is not that of a solid.
    #[staticmethod]
    fn from_json(py: Python<'_>, json: &str, path: PathBuf) -> PyResult<Option<Self>> {
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
}

impl SolidCase {
    fn of(case: AnyCase) -> Option<Self> {
        match case {
            AnyCase::Plane(_) => None,
            AnyCase::Solid(case) => Some(Self { case: Arc::from(case) }),
        }
    }
}

/// What a run of a solid found.
#[pyclass(frozen, module = "riss._riss")]
pub struct Solid {
    /// Everything that was found.
    pub result: SolidResult,
    /// The record as it stands in `results.json`.
    pub record: SolidResults,
}

#[pymethods]
impl Solid {
    /// The record, as JSON.
    fn record_json(&self) -> PyResult<String> {
        serde_json::to_string(&self.record).map_err(error::of_text)
    }

    /// A vector at every node, shape (n, 3).
    fn vectors<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray2<f64>>> {
        match name {
            "nodes" => triples(py, &self.result.cloud.positions),
            "displacement" => triples(py, &self.result.displacements),
            _ => Err(PyKeyError::new_err(name.to_string())),
        }
    }

    /// The stress at every node, shape (n, 3, 3).
    fn stress<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        // Symmetric: rows or columns first is the same.
        let flat: Vec<f64> = self.result.stresses.iter().flat_map(|t| t.iter().copied()).collect();
        PyArray::from_vec(py, flat).reshape([self.result.stresses.len(), 3, 3])
    }

    /// Points of a crack, shape (n, 3), and the displacement of its positive face over that of its negative one.
    fn crack<'py>(&self, py: Python<'py>, crack: usize) -> PyResult<[Bound<'py, PyArray2<f64>>; 2]> {
        let crack = self.opened(crack)?;
        Ok([triples(py, &crack.positions)?, triples(py, &crack.openings)?])
    }

    /// Triangles between the points of a crack, shape (n, 3).
    fn crack_triangles<'py>(&self, py: Python<'py>, crack: usize) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let triangles = &self.opened(crack)?.triangles;
        PyArray1::from_vec(py, triangles.iter().flatten().copied().collect()).reshape([triangles.len(), 3])
    }
}

impl Solid {
    fn opened(&self, crack: usize) -> PyResult<&OpenedCrack> {
        self.result.opened_cracks.get(crack).ok_or_else(|| PyIndexError::new_err("there is no such crack"))
    }
}

fn triples<'py>(py: Python<'py>, vectors: &[Vector3]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat: Vec<f64> = vectors.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
    PyArray::from_vec(py, flat).reshape([vectors.len(), 3])
}
