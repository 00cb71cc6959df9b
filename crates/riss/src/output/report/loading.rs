//! How cohesive cracks were loaded: the section that reports in the plane and in space share.

use super::chart::{Curve, cell, chart};
use super::html;
use crate::output::load_curve::{LoadCurvePoint, LoadingResults};
use std::fmt::Write;

/// Load curve and energies; nothing without cohesive cracks.
pub(in crate::output) fn loading_section(loading: Option<&LoadingResults>, load_curve: &[LoadCurvePoint]) -> String {
    let Some(loading) = loading else { return String::new() };
    let mut page = String::new();
    let point = |p: &LoadCurvePoint| Some([p.displacement?, p.load?, 0.0]);
    let points: Vec<[f64; 3]> = load_curve.iter().filter_map(point).collect();
    let end = points.iter().map(|p| p[0]).fold(f64::MIN_POSITIVE, f64::max);
    let energy = |get: fn(&LoadCurvePoint) -> Option<f64>| {
        load_curve.iter().filter_map(|p| Some([p.displacement?, get(p)?, 0.0])).collect()
    };
    let curve = |name, points| Curve { name, points, has_marks: false };
    let energies = [
        curve("work", energy(|p| p.external_work)),
        curve("stored", energy(|p| p.elastic_energy)),
        curve("dissipated", energy(|p| p.dissipated_energy)),
    ];
    page.push_str("<section class=\"wide\">\n<h2>Load curve</h2>\n<div class=\"charts\">\n");
    page.push_str(&chart(&[curve("load", points)], end, "displacement", "load over displacement"));
    page.push_str(&chart(&energies, end, "displacement", "energies over displacement"));
    let peak = &loading.peak;
    let _ = write!(
        page,
        "</div>\n<p>Peak: load {} at displacement {}. Dissipated in the end: {}. Loading ended: {}</p>\n</section>\n",
        cell(peak.load),
        cell(peak.displacement),
        cell(loading.dissipated_energy),
        html(&loading.end.reason)
    );
    page
}
