//! Error of the stress in the energy norm, from what smoothing changes of it [CPM, Eqs. A.1-A.6].

use super::recovery::{Buffer, RecoveredStress};
use crate::error::Result;
use crate::integration::cells::as_usize;
use crate::model::Model;
use crate::system::galerkin::{Scratch, cell_displacement_gradient, cell_gradients};
use crate::system::{Discretization, Solution};
use rayon::prelude::*;

/// The estimated error, point by point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorEstimate {
    /// `(σ^p - σ^h) : C⁻¹ (σ^p - σ^h) / 2` times the weight of each integration point [stress·length²].
    pub points: Vec<f64>,
    /// Squared energy norm of the error [stress·length²].
    pub error: f64,
    /// Squared energy norm of the stress [stress·length²].
    pub energy: f64,
}

impl ErrorEstimate {
    /// `η_g`, the norm of the error over the norm of the stress [CPM, Eq. A.3]; zero for a body without stress.
    pub fn relative(&self) -> f64 {
        if self.energy > 0.0 { (self.error / self.energy).sqrt() } else { 0.0 }
    }
}

/// Compares the stress of a solution with the recovered one at all integration points.
///
/// # Errors
/// Those of the shape functions.
pub fn estimate_error(model: &Model, discrete: &Discretization, solution: &Solution) -> Result<ErrorEstimate> {
    let material = &model.material;
    let recovered = RecoveredStress::new(model, discrete, solution)?;
    let cells: Vec<(Vec<f64>, f64)> = (0..discrete.cells.len())
        .into_par_iter()
        .with_min_len(32)
        .map_init(<(Scratch, Buffer)>::default, |(scratch, buffer), cell| {
            cell_gradients(discrete, cell, scratch, None)?;
            let nodes = discrete.cell_nodes.get(cell);
            let points = &discrete.cells.points[as_usize(&discrete.cells.point_ranges[cell])];
            let mut energy = 0.0;
            let errors = points.iter().enumerate().map(|(q, point)| {
                let gradient = cell_displacement_gradient(nodes, q, scratch, &solution.parameters);
                let stress = material.stress(&gradient);
                energy += 0.5 * point.weight * stress.dot(&gradient);
                let difference = recovered.at(point.position, point.position, buffer)? - stress;
                Ok(0.5 * point.weight * difference.dot(&material.strain(&difference)))
            });
            Ok((errors.collect::<Result<_>>()?, energy))
        })
        .collect::<Result<_>>()?;
    let energy = cells.iter().map(|c| c.1).sum();
    let points: Vec<f64> = cells.into_iter().flat_map(|c| c.0).collect();
    Ok(ErrorEstimate { error: points.iter().sum(), points, energy })
}
