//! The load curve of cohesive cracks, in results and as a table.

use super::results::finite;
use crate::analysis::{GrownSurface, GrowthEnd, LoadPoint, PlaneLoadingRecord};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::io;

/// Name of the load curve as a table.
pub const LOAD_CURVE_FILE: &str = "load_curve.csv";

/// How far cohesive cracks were loaded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadingResults {
    /// The point of the greatest load.
    pub peak: LoadCurvePoint,
    /// Energy dissipated in the end [stress·length³].
    pub dissipated_energy: Option<f64>,
    /// Why it ended.
    pub end: GrowthEnd,
    /// Surfaces of a solid from first to last, if they grow.
    #[serde(default)]
    pub surfaces: Vec<GrownSurface>,
}

impl LoadingResults {
    /// Of a curve that ended; none if it has no peak.
    pub(super) fn new(curve: &[LoadCurvePoint], peak: usize, end: &GrowthEnd) -> Option<Self> {
        let peak = curve.get(peak)?.clone();
        let dissipated_energy = curve.last().and_then(|p| p.dissipated_energy);
        Some(Self { peak, dissipated_energy, end: end.clone(), surfaces: vec![] })
    }
}

/// A point of the load curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadCurvePoint {
    /// Its number, from 0 at rest; names the files of those that have some.
    pub step: usize,
    /// Factor on all loads and prescribed displacements.
    pub load_factor: Option<f64>,
    /// Displacement on which the load does its work [length].
    pub displacement: Option<f64>,
    /// Resultant of the loads; with prescribed displacements, the force that takes the largest of them [stress·length²].
    pub load: Option<f64>,
    /// Energy dissipated by the cracks [stress·length³].
    pub dissipated_energy: Option<f64>,
    /// Energy stored in the body and in unbroken bonds [stress·length³].
    pub elastic_energy: Option<f64>,
    /// Work of the load [stress·length³], which the two energies add up to.
    pub external_work: Option<f64>,
    /// Area of crack that has reached the strength [area].
    pub crack_area: Option<f64>,
}

impl LoadCurvePoint {
    pub(super) fn new(step: usize, point: &LoadPoint) -> Self {
        Self {
            step,
            load_factor: finite(point.load_factor),
            displacement: finite(point.displacement),
            load: finite(point.load),
            dissipated_energy: finite(point.dissipated_energy),
            elastic_energy: finite(point.elastic_energy),
            external_work: finite(point.external_work),
            crack_area: finite(point.crack_area),
        }
    }
}

/// Points as results have them.
pub(super) fn load_curve(curve: &[LoadPoint]) -> Vec<LoadCurvePoint> {
    curve.iter().enumerate().map(|(step, point)| LoadCurvePoint::new(step, point)).collect()
}

/// `loading` and `load_curve` as `results.json` has them, as text; none if the curve has no peak.
pub fn loading_json(record: &PlaneLoadingRecord) -> Option<String> {
    let curve = load_curve(&record.curve);
    let loading = LoadingResults::new(&curve, record.peak, &record.end)?;
    Some(serde_json::json!({ "loading": loading, "load_curve": curve, "growth_end": record.growth_end }).to_string())
}

/// The curve as a table.
pub(super) fn table(curve: &[LoadCurvePoint]) -> io::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(vec![]);
    for point in curve {
        writer.serialize(point)?;
    }
    writer.into_inner().map_err(|e| io::Error::other(e.to_string()))
}
