//! `results.json`: the numbers of a run, for other programs. Its schema is `docs/reference/results.schema.json`.
//!
//! What is not known is `null`, never 0 and never left out; so is a number that is not finite.

use super::RunInfo;
use super::load_curve::{LoadCurvePoint, LoadingResults, load_curve};
use crate::analysis::{
    CrackRecord, GrowthEnd, PlaneLoadingRecord, RefinementRecord, Stability, StaticResult, StepRecord, TipRecord,
    TipStatus,
};
use crate::crack::{End, EndKind};
use crate::math::Vector2;
use crate::model::UnitNames;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What a run found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Results {
    /// Version of riss that wrote the file.
    pub riss: String,
    /// Title of the case.
    pub case: String,
    /// Name of the method.
    pub method: String,
    /// Units of all numbers, if the case says them.
    #[serde(default)]
    pub units: Option<UnitNames>,
    /// How the run ended.
    pub status: RunStatus,
    /// Number of nodes in the last step.
    pub nodes: usize,
    /// Number of unknowns in the last step, multipliers included.
    pub unknowns: usize,
    /// Number of integration points in the last step.
    pub integration_points: usize,
    /// Time from start to end [s].
    pub wall_time_s: Option<f64>,
    /// Time of each stage [s].
    pub stage_time_s: BTreeMap<String, f64>,
    /// Greatest memory use.
    pub peak_memory_bytes: Option<u64>,
    /// Strain energy over the thickness in the last step [stress·length³].
    pub strain_energy: Option<f64>,
    /// Energy norm of the error over that of the solution, where an exact field is named.
    pub energy_error: Option<f64>,
    /// Relative residual of the linear system in the last step.
    pub residual: Option<f64>,
    /// All warnings, in order.
    pub warnings: Vec<String>,
    /// Names of the other files of this run, in the same folder.
    pub files: Vec<String>,
    /// Why crack growth ended, where it did.
    pub growth_end: Option<GrowthEnd>,
    /// Steps in order; a static run has one. With cohesive cracks points of the load curve, by their numbers.
    pub steps: Vec<StepResults>,
    /// How far cohesive cracks were loaded.
    #[serde(default)]
    pub loading: Option<LoadingResults>,
    /// Load curve of cohesive cracks from rest; none without.
    #[serde(default)]
    pub load_curve: Vec<LoadCurvePoint>,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RunStatus {
    /// As asked for.
    Done,
    /// Early, or still running; what was found until then is there.
    Stopped,
}

/// One step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StepResults {
    /// Number of the step, from 0.
    pub step: usize,
    /// Factor on the loads at which the crack grows; 1 unless growth is quasi-static, and all else is for a factor of 1.
    /// Cohesive cracks: the factor on the loads that all else is for.
    pub load_factor: Option<f64>,
    /// Load cycles so far, in fatigue.
    pub cycles: Option<f64>,
    /// The same if all factors are larger, or smaller, by their error bars; null where the crack then does not grow.
    pub cycles_range: Option<[Option<f64>; 2]>,
    /// Whether the load must rise for the crack to go on, in quasi-static growth.
    pub stability: Option<Stability>,
    /// Number of nodes; null in a step that could not be solved.
    pub nodes: Option<usize>,
    /// Strain energy over the thickness [stress·length³].
    pub strain_energy: Option<f64>,
    /// Time of each stage [s].
    pub stage_time_s: BTreeMap<String, f64>,
    /// Warnings of this step.
    pub warnings: Vec<String>,
    /// Solutions on the way to the accuracy that was asked for, the result last; none without such a wish.
    #[serde(default)]
    pub refinements: Vec<RefinementResults>,
    /// Every crack, in the order of the case.
    pub cracks: Vec<CrackResults>,
    /// Force of each supported part on the body over the thickness, by name of the part.
    pub reactions: BTreeMap<String, Option<[f64; 2]>>,
}

/// A solution on the way to the accuracy that was asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RefinementResults {
    /// Number of nodes.
    pub nodes: usize,
    /// Estimated error of the stress in the energy norm, over the norm of the stress.
    pub error_estimate: Option<f64>,
    /// The error itself, where an exact field is named.
    pub energy_error: Option<f64>,
    /// Largest error bar of the stress intensity factors over their magnitude.
    #[serde(rename = "K_error")]
    pub k_error: Option<f64>,
    /// K_I and K_II of every tip that has them, in order [stress·√length].
    #[serde(rename = "K")]
    pub factors: Vec<[Option<f64>; 2]>,
}

/// A crack in one step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CrackResults {
    /// Name of the crack.
    pub name: String,
    /// Vertices of its path.
    pub path: Vec<[f64; 2]>,
    /// What its first and its last vertex are.
    pub ends: [EndKind; 2],
    /// Its tips.
    pub tips: Vec<TipResults>,
}

/// A tip in one step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TipResults {
    /// Which end of the path.
    pub end: End,
    /// Position of the tip.
    pub position: [f64; 2],
    /// Direction ahead, counterclockwise from the x axis [degree].
    pub angle_deg: f64,
    /// Mode I stress intensity factor [stress·√length], positive if the crack opens.
    #[serde(rename = "K_I")]
    pub k1: Option<f64>,
    /// Mode II stress intensity factor [stress·√length], positive if the face to the left slides ahead.
    #[serde(rename = "K_II")]
    pub k2: Option<f64>,
    /// Error bar of both, at least what the last refinement lets expect of the next ones [stress·√length].
    #[serde(rename = "K_uncertainty")]
    pub k_uncertainty: Option<f64>,
    /// Mode I factor that was solved for as an unknown, with `extrinsic-mls` enrichment [stress·√length].
    #[serde(rename = "K_I_direct")]
    pub k1_direct: Option<f64>,
    /// Mode II factor that was solved for as an unknown, with `extrinsic-mls` enrichment [stress·√length].
    #[serde(rename = "K_II_direct")]
    pub k2_direct: Option<f64>,
    /// J-integral [stress·length].
    #[serde(rename = "J")]
    pub j: Option<f64>,
    /// Error bar of the J-integral [stress·length].
    #[serde(rename = "J_uncertainty")]
    pub j_uncertainty: Option<f64>,
    /// T-stress [stress].
    #[serde(rename = "T")]
    pub t_stress: Option<f64>,
    /// Error bar of the T-stress [stress].
    #[serde(rename = "T_uncertainty")]
    pub t_uncertainty: Option<f64>,
    /// Configurational force, ahead and to the left [stress·length].
    pub configurational_force: Option<[f64; 2]>,
    /// Angle of the next increment against the direction ahead, counterclockwise [degree].
    pub kink_angle_deg: Option<f64>,
    /// Mode I factor that drives as hard as both modes together [stress·√length].
    #[serde(rename = "K_equivalent")]
    pub k_equivalent: Option<f64>,
    /// Length of the next increment [length]; 0 for a tip that stays.
    pub increment: Option<f64>,
    /// Growth per cycle in fatigue [length].
    pub growth_rate: Option<f64>,
    /// What the tip does.
    pub status: TipStatus,
    /// Why, in words, where growth was asked for.
    pub reason: Option<String>,
    /// Radii of the integration domains [length].
    pub domain_radii: Vec<f64>,
}

impl Results {
    /// The results of a static run; `files` is empty.
    pub fn new(info: &RunInfo, result: &StaticResult) -> Self {
        let step = StepResults::new(result, &info.stage_time_s);
        Self::of_steps(info, result, vec![step])
    }

    /// The results of a run of several steps; `last` is the last that was solved, `files` is empty.
    pub fn of_steps(info: &RunInfo, last: &StaticResult, steps: Vec<StepResults>) -> Self {
        let stage_time_s = sum_by_stage(&info.stage_time_s);
        Self {
            riss: env!("CARGO_PKG_VERSION").into(),
            case: info.title.clone(),
            method: info.method.clone(),
            units: info.units.clone(),
            status: info.status,
            nodes: last.n_nodes,
            unknowns: last.n_unknowns,
            integration_points: last.n_integration_points,
            wall_time_s: finite(info.wall_time_s),
            stage_time_s,
            peak_memory_bytes: info.peak_memory_bytes,
            strain_energy: finite(last.strain_energy),
            energy_error: last.energy_error.and_then(finite),
            residual: finite(last.residual),
            warnings: steps.iter().flat_map(|s| s.warnings.iter().cloned()).collect(),
            files: vec![],
            growth_end: last.step.end.clone(),
            steps,
            loading: None,
            load_curve: vec![],
        }
    }

    /// What is known of the whole run only when it is over.
    pub(super) fn told(&mut self, info: &RunInfo) {
        self.status = info.status;
        self.wall_time_s = finite(info.wall_time_s);
        self.stage_time_s = sum_by_stage(&info.stage_time_s);
        self.peak_memory_bytes = info.peak_memory_bytes;
    }

    /// Adds how cohesive cracks were loaded.
    pub fn loaded(&mut self, record: &PlaneLoadingRecord) {
        self.load_curve = load_curve(&record.curve);
        self.loading = LoadingResults::new(&self.load_curve, record.peak, &record.end);
        self.growth_end.clone_from(&record.growth_end);
    }

    /// Load curve and what became of it, if there is one.
    pub(super) fn loading_with_curve(&self) -> Option<(&LoadingResults, &[LoadCurvePoint])> {
        Some((self.loading.as_ref()?, &self.load_curve))
    }

    /// As text, with a line break at the end.
    pub fn to_json(&self) -> String {
        // Strings, numbers and maps with text keys cannot fail.
        serde_json::to_string_pretty(self).expect("results are plain values") + "\n"
    }
}

impl StepResults {
    /// A step; the times are those of its stages.
    pub fn new(result: &StaticResult, stage_time_s: &[(String, f64)]) -> Self {
        let step: &StepRecord = &result.step;
        Self {
            step: step.step,
            load_factor: finite(step.load_factor),
            cycles: step.cycles.and_then(finite),
            cycles_range: step.cycles_range.map(|range| range.map(finite)),
            stability: step.stability,
            nodes: (result.n_nodes > 0).then_some(result.n_nodes),
            strain_energy: finite(result.strain_energy),
            stage_time_s: sum_by_stage(stage_time_s),
            warnings: result.warnings.iter().map(ToString::to_string).collect(),
            refinements: result.refinements.iter().map(RefinementResults::new).collect(),
            cracks: step.cracks.iter().map(CrackResults::new).collect(),
            reactions: step.reactions.iter().map(|(part, force)| (part.clone(), finite_pair(*force))).collect(),
        }
    }
}

impl RefinementResults {
    fn new(record: &RefinementRecord) -> Self {
        Self {
            nodes: record.n_nodes,
            error_estimate: finite(record.error_estimate),
            energy_error: record.energy_error.and_then(finite),
            k_error: record.k_error.and_then(finite),
            factors: record.factors.iter().map(|k| k.map(finite)).collect(),
        }
    }
}

impl CrackResults {
    fn new(crack: &CrackRecord) -> Self {
        Self {
            name: crack.name.clone(),
            path: crack.path.iter().map(|p| [p.x, p.y]).collect(),
            ends: crack.ends,
            tips: crack.tips.iter().map(TipResults::new).collect(),
        }
    }
}

impl TipResults {
    fn new(tip: &TipRecord) -> Self {
        Self {
            end: tip.end,
            position: tip.position.into(),
            angle_deg: tip.angle.to_degrees(),
            k1: tip.k1.and_then(finite),
            k2: tip.k2.and_then(finite),
            k_uncertainty: tip.k_uncertainty.and_then(finite),
            k1_direct: tip.k1_direct.and_then(finite),
            k2_direct: tip.k2_direct.and_then(finite),
            j: tip.j.and_then(finite),
            j_uncertainty: tip.j_uncertainty.and_then(finite),
            t_stress: tip.t_stress.and_then(finite),
            t_uncertainty: tip.t_uncertainty.and_then(finite),
            configurational_force: tip.configurational_force.and_then(finite_pair),
            kink_angle_deg: tip.kink_angle.and_then(finite).map(f64::to_degrees),
            k_equivalent: tip.k_equivalent.and_then(finite),
            increment: tip.increment.and_then(finite),
            growth_rate: tip.growth_rate.and_then(finite),
            status: tip.status,
            reason: tip.reason.clone(),
            domain_radii: tip.radii.clone(),
        }
    }
}

/// The content of `results.json` without the other files.
pub fn results_json(info: &RunInfo, result: &StaticResult) -> String {
    Results::new(info, result).to_json()
}

/// The JSON schema of `results.json`.
pub fn results_schema() -> String {
    let mut schema = SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<Results>();
    schema.insert("title".into(), "results.json of riss".into());
    serde_json::to_string_pretty(&schema).expect("a schema is plain values") + "\n"
}

fn sum_by_stage(times: &[(String, f64)]) -> BTreeMap<String, f64> {
    let mut sums = BTreeMap::new();
    for (stage, time) in times {
        *sums.entry(stage.clone()).or_insert(0.0) += time;
    }
    sums
}

pub(super) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn finite_pair(v: Vector2) -> Option<[f64; 2]> {
    (v.x.is_finite() && v.y.is_finite()).then(|| v.into())
}
