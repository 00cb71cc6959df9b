//! What supports do: by virtual work on a displacement field that is theirs where they hold, and nearly rigid around.
//!
//! Any field would do that has their displacements. That of the load itself has its largest strains at the ends of supports,
//! where its energy is not known well: the force on a punch came out 10 % too small.

use super::work::Work;
use crate::material::Elasticity;
use crate::math::{Matrix, Vector3};
use crate::system::{Collocation, CollocationSystem};
use rayon::prelude::*;

/// Power of the distance by which held nodes count less: high enough that the field is flat near each support.
const POWER: i32 = 6;
/// A node counts for itself as if it were this far away, over its spacing.
const AT_NODE: f64 = 1e-2;
/// What directions that nothing holds get, over the rest.
const REST: f64 = 1e-13;

/// The field, if supports have ends: displacements node by node for a unit load factor. At each place it is the mean of what
/// the held nodes have, in the directions that they hold, weighted by distance.
pub(super) fn virtual_field(collocation: &Collocation<3>, system: &CollocationSystem<3>) -> Option<Vec<f64>> {
    if !collocation.has_support_ends() {
        return None;
    }
    let cloud = collocation.cloud();
    let held: Vec<(Vector3, f64, Matrix<3>, Vector3)> = (0..cloud.len())
        .filter(|i| system.fixed[*i].trace() > 0.5)
        .map(|i| {
            let fixed = system.fixed[i];
            let prescribed = fixed * Vector3::from_column_slice(&system.load[3 * i..3 * i + 3]);
            (cloud.positions[i], cloud.spacings[i], fixed, prescribed)
        })
        .collect();
    let at = |i: usize| {
        let (mut matrix, mut right) = (Matrix::<3>::zeros(), Vector3::zeros());
        let nearest = (AT_NODE * cloud.spacings[i]).powi(2);
        for (p, spacing, fixed, prescribed) in &held {
            let apart = (p - cloud.positions[i]).norm_squared().max(nearest);
            let weight = spacing * spacing / apart.powi(POWER / 2);
            matrix += fixed * weight;
            right += prescribed * weight;
        }
        let rest = REST * matrix.trace();
        let solved = (matrix + Matrix::from_diagonal_element(rest)).cholesky().map(|c| c.solve(&right));
        <[f64; 3]>::from(solved.unwrap_or_default())
    };
    Some((0..cloud.len()).into_par_iter().flat_map_iter(at).collect())
}

/// What the mean stress of a field does against what the cells miss of the gradient of another [stress·length³]: with it,
/// the work of a uniform stress is exact.
///
/// - `gradients`: integrals over the cells of the gradients of the stressed field and of the other
pub(super) fn missed_work(
    material: &Elasticity,
    volume: f64,
    work: &Work,
    field: &[f64],
    gradients: [Matrix<3>; 2],
) -> f64 {
    let [of_stressed, of_field] = gradients;
    let strain = (of_stressed + of_stressed.transpose()) * (0.5 / volume);
    let stress = Matrix::from_diagonal_element(material.lame() * strain.trace()) + strain * (2.0 * material.shear());
    stress.dot(&(work.outside(field) + work.held - of_field))
}
