//! What a step leaves behind: its record as JSON, and arrays.

use crate::approximation::Approximation;
use crate::error;
use numpy::{PyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::exceptions::{PyIndexError, PyKeyError, PyValueError};
use pyo3::prelude::*;
use riss::analysis::{GrowthState, Settings, SolidGrowthState, StaticResult};
use riss::math::{Matrix2, Vector2};
use riss::model::Model;
use riss::output::results::StepResults;
use std::path::PathBuf;
use std::sync::Arc;

/// A step that is done.
#[pyclass(frozen, module = "riss._riss")]
pub struct Step {
    /// Everything that was found.
    pub result: Arc<StaticResult>,
    /// The record as it stands in `results.json`.
    pub record: StepResults,
    /// The model as it was in this step.
    pub model: Arc<Model>,
    /// Numerical choices.
    pub settings: Arc<Settings>,
    /// From where the step can be repeated.
    pub state: Option<GrowthState>,
}

/// All that a step of growth needs to know of those before it.
#[pyclass(frozen, module = "riss._riss")]
pub struct State {
    /// What Rust knows.
    pub state: AnyState,
}

/// A state of any method.
pub enum AnyState {
    /// Of a body in the plane.
    Plane(GrowthState),
    /// Of a solid.
    Solid(SolidGrowthState),
}

#[pymethods]
impl State {
    #[getter]
    fn step(&self) -> usize {
        match &self.state {
            AnyState::Plane(state) => state.step,
            AnyState::Solid(state) => state.step,
        }
    }

    fn to_json(&self) -> PyResult<String> {
        match &self.state {
            AnyState::Plane(state) => serde_json::to_string(state),
            AnyState::Solid(state) => serde_json::to_string(state),
        }
        .map_err(error::of_text)
    }

    #[staticmethod]
    fn from_json(json: &str) -> PyResult<Self> {
        match serde_json::from_str(json) {
            Ok(state) => Ok(Self { state: AnyState::Solid(state) }),
            Err(_) => serde_json::from_str(json).map(|s| Self { state: AnyState::Plane(s) }).map_err(error::of_text),
        }
    }
}

impl State {
    /// That of a body in the plane.
    pub fn plane(&self) -> PyResult<GrowthState> {
        match &self.state {
            AnyState::Plane(state) => Ok(state.clone()),
            AnyState::Solid(_) => {
                Err(PyValueError::new_err("`start` is a state of a solid, the case one of the plane"))
            }
        }
    }

    /// That of a solid with so many cracks.
    pub fn solid(&self, n_cracks: usize) -> PyResult<SolidGrowthState> {
        match &self.state {
            AnyState::Solid(state) if state.sources.iter().any(|s| *s >= n_cracks) => {
                Err(PyValueError::new_err(format!("`start` goes on with more cracks than the {n_cracks} of the case")))
            }
            AnyState::Solid(state) => Ok(state.clone()),
            AnyState::Plane(_) => {
                Err(PyValueError::new_err("`start` is a state of the plane, the case one of a solid"))
            }
        }
    }
}

#[pymethods]
impl Step {
    /// The record, as JSON.
    fn record_json(&self) -> PyResult<String> {
        serde_json::to_string(&self.record).map_err(error::of_text)
    }

    #[getter]
    fn end_json(&self) -> PyResult<Option<String>> {
        self.result.step.end.as_ref().map(|e| serde_json::to_string(e).map_err(error::of_text)).transpose()
    }

    #[getter]
    fn state(&self) -> Option<State> {
        self.state.clone().map(|s| State { state: AnyState::Plane(s) })
    }

    #[getter]
    fn n_unknowns(&self) -> usize {
        self.result.n_unknowns
    }

    #[getter]
    fn energy_error(&self) -> Option<f64> {
        self.result.energy_error
    }

    #[getter]
    fn residual(&self) -> f64 {
        self.result.residual
    }

    /// Triangles by point, shape (n, 3).
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let flat: Vec<u32> = self.result.fields.triangles.iter().flatten().copied().collect();
        let n = self.result.fields.triangles.len();
        PyArray1::from_vec(py, flat).reshape([n, 3])
    }

    /// A vector at every point of the fields or at every node, shape (n, 2).
    fn vectors<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (fields, nodes) = (&self.result.fields, &self.result.nodes);
        match name {
            "points" => pairs(py, &fields.positions),
            "displacement" => pairs(py, &fields.displacement),
            "nodes" => pairs(py, &nodes.iter().map(|n| n.position).collect::<Vec<_>>()),
            "nodal_parameters" => pairs(py, &nodes.iter().map(|n| n.parameters).collect::<Vec<_>>()),
            "integration_points" => pairs(py, &self.result.integration_points.iter().map(|p| p.0).collect::<Vec<_>>()),
            _ => Err(PyKeyError::new_err(name.to_string())),
        }
    }

    /// A tensor at every point of the fields, shape (n, 2, 2).
    fn tensors<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray3<f64>>> {
        match name {
            "stress" => tensors(py, &self.result.fields.stress),
            "strain" => tensors(py, &self.result.fields.strain),
            _ => Err(PyKeyError::new_err(name.to_string())),
        }
    }

    /// A number at every point of the fields, at every node or integration point, shape (n,).
    fn scalars<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let fields = &self.result.fields;
        let values = match name {
            "von_mises" => fields.von_mises.clone(),
            "out_of_plane_stress" => fields.out_of_plane_stress.clone(),
            "out_of_plane_strain" => fields.out_of_plane_strain.clone(),
            "error_indicator" => fields.error_indicator.clone(),
            "support_radii" => self.result.nodes.iter().map(|n| n.support_radius).collect(),
            "integration_weights" => self.result.integration_points.iter().map(|p| p.1).collect(),
            _ => return Err(PyKeyError::new_err(name.to_string())),
        };
        Ok(PyArray1::from_vec(py, values))
    }

    /// Points along a crack and the displacement of its left and right face.
    #[allow(clippy::type_complexity)]
    fn crack_faces<'py>(&self, py: Python<'py>, crack: usize) -> PyResult<[Bound<'py, PyArray2<f64>>; 3]> {
        let faces = self.result.fields.crack_faces.get(crack);
        let faces = faces.ok_or_else(|| PyIndexError::new_err("there are no faces of such a crack"))?;
        Ok([pairs(py, &faces.positions)?, pairs(py, &faces.left)?, pairs(py, &faces.right)?])
    }

    /// The approximation of this step.
    fn approximation(&self, py: Python<'_>) -> PyResult<Approximation> {
        py.detach(|| Approximation::new(self))
    }
}

/// Vectors as an array of shape (n, 2).
pub fn pairs<'py>(py: Python<'py>, vectors: &[Vector2]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat: Vec<f64> = vectors.iter().flat_map(|v| [v.x, v.y]).collect();
    PyArray::from_vec(py, flat).reshape([vectors.len(), 2])
}

/// Tensors as an array of shape (n, 2, 2), rows first.
pub fn tensors<'py>(py: Python<'py>, tensors: &[Matrix2]) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let flat: Vec<f64> = tensors.iter().flat_map(|t| [t[(0, 0)], t[(0, 1)], t[(1, 0)], t[(1, 1)]]).collect();
    PyArray::from_vec(py, flat).reshape([tensors.len(), 2, 2])
}

/// The table of all tips, as in `history.csv`.
#[pyfunction]
pub fn history_csv(steps: Vec<PyRef<'_, Step>>) -> PyResult<String> {
    let records: Vec<StepResults> = steps.iter().map(|s| s.record.clone()).collect();
    let bytes = riss::output::history::history_csv(&records).map_err(error::of_text)?;
    String::from_utf8(bytes).map_err(error::of_text)
}

/// The state in a folder of results from which a step can be repeated.
#[pyfunction]
pub fn restart_state(dir: PathBuf, step: usize) -> PyResult<State> {
    match riss::output::solid_restart_state(&dir, step) {
        Ok(state) => Ok(State { state: AnyState::Solid(state) }),
        Err(_) => riss::output::restart_state(&dir, step)
            .map(|s| State { state: AnyState::Plane(s) })
            .map_err(|e| error::of_files(&dir, &e)),
    }
}
