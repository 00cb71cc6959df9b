//! Error of the stress in the energy norm, from what smoothing changes of it [CPM, Eqs. A.1-A.6].

use super::recovery::{Buffer, RecoveredStress, SingularStress};
use crate::error::Result;
use crate::integration::cells::as_usize;
use crate::material::Elasticity;
use crate::math::{Matrix2, Vector2};
use crate::model::Model;
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
/// - `gradients`: of the displacement at all integration points
///
/// # Errors
/// Those of the shape functions.
pub fn estimate_error(
    model: &Model,
    discrete: &Discretization,
    solution: &Solution,
    gradients: &[Matrix2],
) -> Result<ErrorEstimate> {
    let material = &model.material;
    let recovered = RecoveredStress::new(model, discrete, solution)?;
    let cells: Vec<(Vec<f64>, f64)> = (0..discrete.cells.len())
        .into_par_iter()
        .with_min_len(32)
        .map_init(Buffer::default, |buffer, cell| cell_errors(material, discrete, gradients, &recovered, cell, buffer))
        .collect::<Result<_>>()?;
    let energy = cells.iter().map(|c| c.1).sum();
    let points: Vec<f64> = cells.into_iter().flat_map(|c| c.0).collect();
    Ok(ErrorEstimate { error: points.iter().sum(), points, energy })
}

/// A disk around a tip.
#[derive(Clone, Debug)]
pub struct TipDisk {
    /// Center.
    pub center: Vector2,
    /// Radius [length].
    pub radius: f64,
    /// The singular stress, where nodes hold it.
    pub singular: Option<SingularStress>,
}

/// Squared energy norm of the estimated error in each of some disks [stress·length²].
///
/// - `gradients`: of the displacement at all integration points
///
/// # Errors
/// Those of the shape functions.
pub fn estimate_error_within(
    model: &Model,
    discrete: &Discretization,
    solution: &Solution,
    gradients: &[Matrix2],
    disks: &[TipDisk],
) -> Result<Vec<f64>> {
    let places = |disks: &[TipDisk]| disks.iter().map(|d| (d.center, d.radius)).collect::<Vec<_>>();
    if disks.iter().all(|d| d.singular.is_none()) {
        return errors_within(model, discrete, solution, gradients, &places(disks), None);
    }
    // What is left of the stress without the singular part of one tip is smooth at that tip only.
    let one = |d: &TipDisk| {
        let disk = [(d.center, d.radius)];
        let found = errors_within(model, discrete, solution, gradients, &disk, d.singular.clone())?;
        Ok(found[0])
    };
    disks.iter().map(one).collect()
}

fn errors_within(
    model: &Model,
    discrete: &Discretization,
    solution: &Solution,
    gradients: &[Matrix2],
    disks: &[(Vector2, f64)],
    singular: Option<SingularStress>,
) -> Result<Vec<f64>> {
    let cells = &discrete.cells;
    let points = |cell: usize| &cells.points[as_usize(&cells.point_ranges[cell])];
    let is_in = |p: Vector2, disk: &(Vector2, f64)| (p - disk.0).norm() < disk.1;
    let near: Vec<usize> = (0..cells.len())
        .into_par_iter()
        .filter(|&cell| points(cell).iter().any(|p| disks.iter().any(|d| is_in(p.position, d))))
        .collect();
    // A cell at the rim of a disk has points outside.
    let reach = |&(center, radius): &(Vector2, f64)| {
        let far = near.iter().flat_map(|&cell| {
            let is_part = points(cell).iter().any(|p| is_in(p.position, &(center, radius)));
            points(cell).iter().filter(move |_| is_part).map(|p| (p.position - center).norm())
        });
        (center, far.fold(radius, f64::max))
    };
    let reached: Vec<_> = disks.iter().map(reach).collect();
    let recovered = RecoveredStress::within(model, discrete, solution, &reached, singular)?;
    let errors: Vec<(Vec<f64>, f64)> = near
        .par_iter()
        .with_min_len(8)
        .map_init(Buffer::default, |buffer, &cell| {
            cell_errors(&model.material, discrete, gradients, &recovered, cell, buffer)
        })
        .collect::<Result<_>>()?;
    let sum = |disk: &(Vector2, f64)| {
        let pairs = near.iter().zip(&errors).flat_map(|(&cell, (errors, _))| points(cell).iter().zip(errors));
        pairs.filter(|(p, _)| is_in(p.position, disk)).map(|(_, e)| e).sum()
    };
    Ok(disks.iter().map(sum).collect())
}

/// Error at each point of a cell, and the energy of the cell [stress·length²].
fn cell_errors(
    material: &Elasticity,
    discrete: &Discretization,
    gradients: &[Matrix2],
    recovered: &RecoveredStress,
    cell: usize,
    buffer: &mut Buffer,
) -> Result<(Vec<f64>, f64)> {
    let range = as_usize(&discrete.cells.point_ranges[cell]);
    recovered.survey(&discrete.cells.bounds(cell), buffer);
    let mut energy = 0.0;
    let errors = discrete.cells.points[range.clone()].iter().zip(&gradients[range]).map(|(point, gradient)| {
        let stress = material.stress(gradient);
        energy += 0.5 * point.weight * stress.dot(gradient);
        let difference = recovered.at(point.position, point.position, buffer)? - stress;
        Ok(0.5 * point.weight * difference.dot(&material.strain(&difference)))
    });
    Ok((errors.collect::<Result<_>>()?, energy))
}
