//! Boxes along the axes.

use super::report::Report;
use crate::geometry::aabb::Aabb;
use crate::math::Vector;

/// The box between two corners; none if it is empty.
pub(in crate::case) fn bounds<const D: usize>(
    lower: [f64; D],
    upper: [f64; D],
    key: &str,
    report: &mut Report,
) -> Option<Aabb<D>> {
    if (0..D).any(|d| upper[d] <= lower[d]) {
        report.error(format!("{key}.upper"), "every coordinate must be greater than that of `lower`");
        return None;
    }
    Some(Aabb { lower: Vector::from(lower), upper: Vector::from(upper) })
}
