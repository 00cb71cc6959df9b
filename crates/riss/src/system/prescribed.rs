//! What prescribed displacements on the boundary add to load and energy.

use super::block_matrix::LocalMatrix;
use super::constraints::{Supports, boundary_matrix};
use super::discretization::Discretization;
use super::galerkin::Scratch;
use super::settings::ConstraintMethod;
use crate::error::Result;
use crate::model::Model;

/// Parts of the weak form that prescribed displacements stand in, for a factor of one, per thickness.
#[derive(Clone, Debug, Default)]
pub struct Prescribed {
    /// Their part of the load vector.
    pub load: Vec<f64>,
    /// `∫ β g² ds`, of the stabilization `β` [stress·length²].
    pub energy: f64,
    /// The largest of them, those of points among them [length].
    pub largest: f64,
}

impl Prescribed {
    /// Integrates over the supported boundary.
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn new(model: &Model, discrete: &Discretization, method: &ConstraintMethod) -> Result<Self> {
        let on = Supports::new(model, method).without_loads();
        let mut result = Self { load: vec![0.0; 2 * discrete.n_functions()], ..Self::default() };
        let at_points = model.point_supports.iter().flat_map(|s| s.displacement).flatten();
        result.largest = at_points.fold(0.0, |m, v| m.max(v.abs()));
        let (mut scratch, mut local) = (Scratch::default(), LocalMatrix::default());
        for (index, element) in discrete.boundary.iter().enumerate() {
            let supports = on.on(element.edge);
            if supports.is_empty() {
                continue;
            }
            boundary_matrix(model, discrete, &on, index, &mut scratch, &mut local)?;
            for (&node, force) in local.nodes.iter().zip(local.load.chunks_exact(2)) {
                (0..2).for_each(|d| result.load[2 * node as usize + d] += force[d]);
            }
            let (_, stabilization) = on.terms(&model.material, element);
            for (point, support) in element.points.iter().flat_map(|p| supports.iter().map(move |s| (p, s))) {
                let value = support.value.value(&model.material, support.direction, &point.field_point());
                result.energy += stabilization * value * value * point.weight;
                result.largest = result.largest.max(value.abs());
            }
        }
        Ok(result)
    }
}
