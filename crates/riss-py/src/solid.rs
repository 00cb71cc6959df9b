//! Solids in space: cases, and what a run leaves behind.

use crate::error;
use crate::step::{AnyState, State};
use numpy::{PyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::exceptions::{PyIndexError, PyKeyError};
use pyo3::prelude::*;
use riss::analysis::{GrowthEnd, LoadPoint, OpenedCrack, SolidGrowthState, SolidResult};
use riss::case::AnyCase;
use riss::math::Vector3;
use riss::output::solid_results::SolidStepResults;
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

    /// Number of steps after the first, if cracks grow.
    #[getter]
    fn growth_steps(&self) -> Option<usize> {
        self.case.growth.as_ref().map(|g| g.steps)
    }

    /// Whether cohesive cracks are loaded; nobody knows in how many steps.
    #[getter]
    fn is_loaded(&self) -> bool {
        self.case.loading.is_some()
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

/// A solved solid: the only state of a static run, a step of growth, a state of loading.
#[pyclass(frozen, module = "riss._riss")]
pub struct SolidStep {
    /// Everything that was found.
    pub result: SolidResult,
    /// The record as it stands among the steps of `results.json`.
    pub record: SolidStepResults,
    /// Vertices and triangles of each crack.
    pub surfaces: Vec<(Vec<Vector3>, Vec<[u32; 3]>)>,
    /// Traction between the faces of each crack, where they are loaded.
    pub tractions: Vec<Vec<f64>>,
    /// Point of the load curve, where cohesive cracks are loaded.
    pub point: Option<LoadPoint>,
    /// From where the step can be repeated, in growth.
    pub state: Option<SolidGrowthState>,
    /// Why growth ends with this step.
    pub end: Option<GrowthEnd>,
}

#[pymethods]
impl SolidStep {
    /// The record, as JSON.
    fn record_json(&self) -> PyResult<String> {
        serde_json::to_string(&self.record).map_err(error::of_text)
    }

    /// The point of the load curve, as JSON.
    #[getter]
    fn point_json(&self) -> PyResult<Option<String>> {
        self.point.as_ref().map(|p| serde_json::to_string(p).map_err(error::of_text)).transpose()
    }

    #[getter]
    fn end_json(&self) -> PyResult<Option<String>> {
        self.end.as_ref().map(|e| serde_json::to_string(e).map_err(error::of_text)).transpose()
    }

    #[getter]
    fn state(&self) -> Option<State> {
        self.state.clone().map(|s| State { state: AnyState::Solid(s) })
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
        corners(py, &self.opened(crack)?.triangles)
    }

    /// Traction that pulls the faces of a cohesive crack together at its points, shape (n,); empty without loading.
    fn traction<'py>(&self, py: Python<'py>, crack: usize) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.tractions.get(crack).cloned().unwrap_or_default())
    }

    /// Vertices of a crack, shape (n, 3), and its triangles, shape (m, 3).
    #[allow(clippy::type_complexity)]
    fn surface<'py>(
        &self,
        py: Python<'py>,
        crack: usize,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<u32>>)> {
        let (vertices, triangles) = self.surfaces.get(crack).ok_or_else(no_crack)?;
        Ok((triples(py, vertices)?, corners(py, triangles)?))
    }
}

impl SolidStep {
    fn opened(&self, crack: usize) -> PyResult<&OpenedCrack> {
        self.result.opened_cracks.get(crack).ok_or_else(no_crack)
    }
}

fn no_crack() -> PyErr {
    PyIndexError::new_err("there is no such crack")
}

fn corners<'py>(py: Python<'py>, triangles: &[[u32; 3]]) -> PyResult<Bound<'py, PyArray2<u32>>> {
    PyArray1::from_vec(py, triangles.iter().flatten().copied().collect()).reshape([triangles.len(), 3])
}

fn triples<'py>(py: Python<'py>, vectors: &[Vector3]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat: Vec<f64> = vectors.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
    PyArray::from_vec(py, flat).reshape([vectors.len(), 3])
}
