//! Shape functions and fields at any point.

use crate::error;
use crate::step::{Step, pairs, tensors};
use numpy::{PyArray1, PyArray2, PyArray3, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;
use riss::analysis::{Silent, discretize};
use riss::approximation::moving_least_squares::Derivatives;
use riss::approximation::{ShapeFunctions, Surroundings};
use riss::math::{Matrix2, Vector2};
use riss::model::Model;
use riss::system::Discretization;
use std::sync::Arc;

/// Points count as on the boundary within this part of the size of the body.
const ON_BOUNDARY: f64 = 1e-9;

/// Nodes with their shape functions, and the nodal parameters of a step.
#[pyclass(frozen, module = "riss._riss")]
pub struct Approximation {
    model: Arc<Model>,
    discrete: Discretization,
    parameters: Vec<Vector2>,
}

impl Approximation {
    /// Discretizes the model of a step once more: the same nodes follow.
    pub fn new(step: &Step) -> PyResult<Self> {
        if step.result.nodes.is_empty() {
            return Err(PyValueError::new_err("the step was not solved"));
        }
        let discrete = discretize(&step.model, &step.settings, &mut Silent).map_err(|e| error::of_analysis(&e))?;
        let of_nodes = step.result.nodes.iter().map(|n| n.parameters);
        let parameters = of_nodes.chain(step.result.extra_parameters.iter().copied()).collect();
        Ok(Self { model: step.model.clone(), discrete, parameters })
    }

    fn is_inside(&self, p: Vector2) -> bool {
        let size = self.model.domain.aabb().size().max();
        self.model.domain.contains(p) || self.model.domain.distance_to_boundary(p) < ON_BOUNDARY * size
    }

    /// Displacement and its gradient, not a number outside.
    fn value(
        &self,
        (at, sight): (Vector2, Option<Vector2>),
        around: &mut Surroundings,
        shape: &mut ShapeFunctions<2>,
    ) -> riss::error::Result<(Vector2, Matrix2)> {
        if !self.is_inside(at) {
            return Ok((Vector2::repeat(f64::NAN), Matrix2::repeat(f64::NAN)));
        }
        let sight = sight.unwrap_or_else(|| self.discrete.sight_at(&self.model, at));
        self.discrete.approximation.evaluate(at, sight, Derivatives::First, around, shape)?;
        Ok((shape.value(&self.parameters), shape.gradient(&self.parameters)))
    }
}

#[pymethods]
impl Approximation {
    /// Displacement, its gradient and the stress at points, given from where each sees.
    #[allow(clippy::type_complexity)]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
        sights: Option<PyReadonlyArray2<'py, f64>>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray3<f64>>, Bound<'py, PyArray3<f64>>)> {
        let points = vectors(&points)?;
        let sights = sights.as_ref().map(vectors).transpose()?;
        if sights.as_ref().is_some_and(|s| s.len() != points.len()) {
            return Err(PyValueError::new_err("there must be as many sights as points"));
        }
        let values = py
            .detach(|| {
                (0..points.len())
                    .into_par_iter()
                    .with_min_len(64)
                    .map_init(<(Surroundings, ShapeFunctions<2>)>::default, |(around, shape), i| {
                        self.value((points[i], sights.as_ref().map(|s| s[i])), around, shape)
                    })
                    .collect::<riss::error::Result<Vec<_>>>()
            })
            .map_err(|e| error::of_analysis(&e))?;
        let displacement: Vec<Vector2> = values.iter().map(|v| v.0).collect();
        let gradient: Vec<Matrix2> = values.iter().map(|v| v.1).collect();
        let stress: Vec<Matrix2> = gradient.iter().map(|g| self.model.material.stress(g)).collect();
        Ok((pairs(py, &displacement)?, tensors(py, &gradient)?, tensors(py, &stress)?))
    }

    /// Neighbors of a point, the values of their shape functions and the gradients.
    #[allow(clippy::type_complexity)]
    fn shape_functions<'py>(
        &self,
        py: Python<'py>,
        x: f64,
        y: f64,
    ) -> PyResult<(Bound<'py, PyArray1<u32>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>)> {
        let at = Vector2::new(x, y);
        if !self.is_inside(at) {
            return Err(PyValueError::new_err(format!("({x}, {y}) is not in the body")));
        }
        let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
        let sight = self.discrete.sight_at(&self.model, at);
        let found = self.discrete.approximation.evaluate(at, sight, Derivatives::First, &mut around, &mut shape);
        found.map_err(|e| error::of_analysis(&e))?;
        let gradients = pairs(py, &shape.gradients)?;
        Ok((PyArray1::from_vec(py, shape.neighbors), PyArray1::from_vec(py, shape.values), gradients))
    }
}

/// The rows of an array of shape (n, 2).
fn vectors(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<Vector2>> {
    if array.shape()[1] != 2 {
        return Err(PyValueError::new_err("points must have shape (n, 2)"));
    }
    let rows: Vec<Vector2> = array.as_array().rows().into_iter().map(|r| Vector2::new(r[0], r[1])).collect();
    match rows.iter().all(|r| r.iter().all(|v| v.is_finite())) {
        true => Ok(rows),
        false => Err(PyValueError::new_err("points must be finite")),
    }
}
