//! How the load curves of two runs with cohesive cracks differ, in the plane and in space.

use super::load_curve::{LoadCurvePoint, LoadingResults};
use crate::geometry::path_distance::path_distance;
use crate::math::Vector2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Differences of two load curves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadingComparison {
    /// Greatest loads [stress·length²].
    pub peak_loads: [Option<f64>; 2],
    /// Displacements there [length].
    pub peak_displacements: [Option<f64>; 2],
    /// Energies dissipated in the end [stress·length³].
    pub dissipated_energies: [Option<f64>; 2],
    /// Difference of the greatest loads over the first.
    pub peak_load_difference: Option<f64>,
    /// Greatest distance of the curves, as far as both go, with loads over the greatest load and displacements over the
    /// greatest displacement of the first.
    pub curve_distance: f64,
}

/// Largest differences that still agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Of paths and fronts, over their length.
    pub path: f64,
    /// Of factors, over their magnitude.
    pub k: f64,
    /// Of loads, over the greatest.
    pub load: f64,
}

impl LoadingComparison {
    /// Compares two load curves; none if one run has none.
    pub(super) fn new(
        first: Option<(&LoadingResults, &[LoadCurvePoint])>,
        second: Option<(&LoadingResults, &[LoadCurvePoint])>,
    ) -> Option<Self> {
        let ((a, curve_a), (b, curve_b)) = (first?, second?);
        let most = |of: fn(&LoadCurvePoint) -> Option<f64>| {
            curve_a.iter().filter_map(of).map(f64::abs).fold(f64::MIN_POSITIVE, f64::max)
        };
        let size = Vector2::new(most(|p| p.displacement), most(|p| p.load));
        let line = |curve: &[LoadCurvePoint]| {
            let point = |p: &LoadCurvePoint| Some(Vector2::new(p.displacement?, p.load?).component_div(&size));
            curve.iter().filter_map(point).collect::<Vec<_>>()
        };
        let peak_loads = [a, b].map(|l| l.peak.load);
        Some(Self {
            peak_loads,
            peak_displacements: [a, b].map(|l| l.peak.displacement),
            dissipated_energies: [a, b].map(|l| l.dissipated_energy),
            peak_load_difference: relative(peak_loads),
            curve_distance: path_distance(&line(curve_a), &line(curve_b)),
        })
    }

    /// Whether the curves are the same within a share of the greatest load.
    pub fn agrees(&self, load: f64) -> bool {
        self.curve_distance <= load && self.peak_load_difference.is_some_and(|d| d.abs() <= load)
    }
}

/// Difference of the second from the first, over the first.
pub(super) fn relative([a, b]: [Option<f64>; 2]) -> Option<f64> {
    let (a, b) = (a?, b?);
    (a != 0.0).then(|| (b - a) / a.abs()).or_else(|| (a == b).then_some(0.0))
}
