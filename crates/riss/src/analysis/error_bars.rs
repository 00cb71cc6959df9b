//! Error bars of stress intensity factors.
//!
//! A bar is the sum of two parts, and no less than the third:
//! - the spread over the integration domains;
//! - what the discretization leaves out: the error of `K = a(u, d)` with the extraction field `d` is
//!   `a(u - u_h, d - d_h)`, at most the product of two errors in the energy norm [BeckerRannacher2001]. Near a tip both
//!   fields go with `√r`, so their errors are alike, and the bound in a disk of radius `R` is a multiple of
//!   `λ = ‖e‖² E' / (K² R)`, with the error estimate `‖e‖`;
//! - the difference between `√(E' J)` and the factors.
//!
//! Where the nodes hold the field of the tip, it is not smoothed, and the estimate sees little: what is left is the error of
//! polynomials in the rest of the field, which goes with the square of the supports over the size of the domain, and more so
//! where nodes become coarser within it.
//!
//! J goes with the square of the factors, and so does its bar, which is no less than its spread. That of the T-stress has
//! shares of its spread and of what the discretization leaves out of the factors, over `√(πR)`.
//!
//! The multiple is calibrated by bodies with known factors (`cargo xtask calibrate`). It grows with `λ`, as recovery sees
//! less of the error on coarse nodes.

use super::record::{CrackRecord, TipRecord};
use crate::adaptivity::{SingularStress, TipDisk, estimate_error_within};
use crate::approximation::tip_functions::TipCoordinates;
use crate::error::Result;
use crate::math::{Matrix2, Vector2};
use crate::model::Model;
use crate::system::{Discretization, Solution};
use std::f64::consts::PI;

/// Part of `λ` that is in a bar on fine nodes.
const SHARE: f64 = 0.25;
/// How fast that part grows with `λ`.
const SHARE_GROWTH: f64 = 20.0;
/// Where nodes hold the field of the tip, a bar has these parts of the square of the support at the tip over the radius of
/// the largest domain, and of what the largest support in the domain adds to that: nodes that become coarser within it.
const ENRICHED_SHARES: [f64; 2] = [0.001, 0.008];

/// Parts of the spread of the T-stress, and of what the discretization leaves out of the factors over `√(πR)`, that are
/// in its bar.
const T_SHARES: [f64; 2] = [0.8, 0.9];

/// Widens the bars of all tips, which hold the spread over the domains before.
///
/// - `gradients`: of the displacement at all integration points
///
/// # Errors
/// Those of the shape functions.
pub(super) fn widen_error_bars(
    model: &Model,
    discrete: &Discretization,
    solution: &Solution,
    gradients: &[Matrix2],
    cracks: &mut [CrackRecord],
) -> Result<()> {
    let mut tips: Vec<&mut TipRecord> =
        cracks.iter_mut().flat_map(|c| &mut c.tips).filter(|t| t.k1.is_some() && !t.radii.is_empty()).collect();
    let disk = |tip: &&mut TipRecord| {
        let coordinates = enriched(discrete, tip.position);
        let factors = [tip.k1, tip.k2].map(|k| k.unwrap_or(0.0));
        let singular = coordinates.map(|c| SingularStress::new(&model.material, c, factors));
        TipDisk { center: tip.position, radius: tip.radii.iter().copied().fold(0.0, f64::max), singular }
    };
    let disks: Vec<TipDisk> = tips.iter().map(disk).collect();
    let errors = estimate_error_within(model, discrete, solution, gradients, &disks)?;
    let young = model.material.effective_young();
    for ((tip, error), TipDisk { radius, singular, .. }) in tips.iter_mut().zip(errors).zip(disks) {
        let (Some(k1), Some(k2), Some(spread)) = (tip.k1, tip.k2, tip.k_uncertainty) else { continue };
        let size = k1.hypot(k2);
        let part = size * numerical_part(error * young / (size * size * radius));
        // A tip without load has no part.
        let part = if part.is_finite() { part } else { 0.0 };
        let second = tip.j.map_or(0.0, |j| ((young * j.max(0.0)).sqrt() - size).abs());
        let smooth = match singular {
            Some(_) => size * smooth_part(discrete, tip.position, radius),
            None => 0.0,
        };
        let bar = (spread + part + smooth).max(second);
        tip.k_uncertainty = Some(bar);
        tip.j_uncertainty = tip.j_uncertainty.map(|spread| spread.max(j_bar(size, bar, young)));
        let unit = (PI * radius).sqrt();
        tip.t_uncertainty = tip.t_uncertainty.map(|spread| T_SHARES[0] * spread + T_SHARES[1] * (part + smooth) / unit);
    }
    Ok(())
}

/// Bar of J that follows from that of the factors, with whose square it goes [stress·length].
///
/// - `size`: magnitude of the factors, `bar`: theirs [stress·√length]
/// - `young`: Young's modulus of the plane state [stress]
pub(super) fn j_bar(size: f64, bar: f64, young: f64) -> f64 {
    (2.0 * size + bar) * bar / young
}

/// Coordinates at a tip whose field the nodes hold.
fn enriched(discrete: &Discretization, tip: Vector2) -> Option<&TipCoordinates> {
    discrete.approximation.enrichment()?.coordinates().find(|c| c.tip() == tip)
}

/// What polynomials leave out of the rest of the field where nodes hold that of the tip, over the size of the factors.
fn smooth_part(discrete: &Discretization, tip: Vector2, radius: f64) -> f64 {
    let nodes = discrete.approximation.nodes();
    let (mut nearest, mut largest) = ((f64::INFINITY, 0.0), 0.0f64);
    for (position, support) in nodes.positions.iter().zip(&nodes.support_radii) {
        let (distance, support) = ((position - tip).norm(), support.max());
        if distance < nearest.0 {
            nearest = (distance, support);
        }
        if distance < radius {
            largest = largest.max(support);
        }
    }
    let [at_tip, most] = [nearest.1, largest.max(nearest.1)].map(|support| (support / radius).powi(2));
    ENRICHED_SHARES[0] * at_tip + ENRICHED_SHARES[1] * (most - at_tip)
}

/// What the discretization leaves out, over the size of the factors, for a given `λ`.
fn numerical_part(lambda: f64) -> f64 {
    SHARE * lambda * (1.0 + SHARE_GROWTH * lambda)
}
