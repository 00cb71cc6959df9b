//! Error bars along crack fronts.
//!
//! The bar of the factors is the sum of
//! - the spread over the discs;
//! - the difference between the factors and what J says of their size: it sees what the field outside the discs lacks;
//! - what the functions of a front leave out where it is curved: it goes with the square of the spacing over the radius of
//!   curvature, that at the point and, as it limits their reach all along the front, the least;
//! - for fronts that end on the boundary, a multiple of the spacing over the length of the crack: such cracks let the body
//!   bend, and collocation holds the moment across the ligament no better than that.
//!
//! J goes with the square of the factors, and so does its bar. That of T is its spread and the other two parts over `√(πR)`.
//! The multiples are calibrated by fronts with known factors (`cargo xtask calibrate`).

use super::error_bars::j_bar;
use crate::crack::CrackSurface;
use crate::fracture::FrontFactors;
use crate::material::Elasticity;
use std::f64::consts::PI;

/// Multiples of the square of the spacing over the radius of curvature: at the point, and the least of the front.
const BENDS: [f64; 2] = [5.0, 2.0];
/// At corners the spacing over the radius counts as no more than this.
const SHARPEST: f64 = 0.3;
/// Multiple of the spacing over the length of a crack that ends on the boundary.
const OPEN: f64 = 0.4;
/// The residual of the solver leaves no less than this.
const LEAST: f64 = 1e-5;

/// Length of a crack as handbooks have it: area over length of the front, twice that for a closed one, which is the radius
/// of a disc and the depth of an edge crack [length].
pub(super) fn crack_length(crack: &CrackSurface, is_closed: bool) -> f64 {
    let along: f64 = crack.fronts.iter().map(|f| f.length).sum();
    crack.surface.area(None) / along * if is_closed { 2.0 } else { 1.0 }
}

/// Widens the bars at a point of a front, which hold the spread over the discs before.
///
/// - `bends`: node spacing over the radius of curvature of the front, at the point and where that is least
/// - `open`: node spacing over the length of the crack if the front ends on the boundary, else zero
/// - `radius`: that of the largest disc [length]
pub(super) fn widen_front_bars(
    factors: &mut FrontFactors,
    material: &Elasticity,
    bends: [f64; 2],
    open: f64,
    radius: f64,
) {
    let young = material.effective_young();
    let [k1, k2, k3] = factors.factors;
    // J = (K_I² + K_II²)/E' + K_III²/(2μ).
    let size = (k1 * k1 + k2 * k2 + k3 * k3 * young / (2.0 * material.shear())).sqrt();
    let second = ((young * factors.j.max(0.0)).sqrt() - size).abs();
    let bend: f64 = BENDS.iter().zip(bends).map(|(multiple, b)| multiple * b.min(SHARPEST).powi(2)).sum();
    let left_out = second + size * (bend + OPEN * open + LEAST);
    factors.uncertainty += left_out;
    factors.j_uncertainty = factors.j_uncertainty.max(j_bar(size, factors.uncertainty, young));
    factors.t_uncertainty += left_out / (PI * radius).sqrt();
}
