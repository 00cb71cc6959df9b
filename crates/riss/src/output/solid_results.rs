//! `results.json` of a solid.
//!
//! What is not known is `null`, never 0 and never left out; so is a number that is not finite.

use super::load_curve::{LoadCurvePoint, LoadingResults, load_curve};
use super::{RunInfo, RunStatus};
use crate::analysis::{FrontPointRecord, FrontRecord, GrowthEnd, LoadingRecord, SolidResult, SolidStep};
use crate::model::{SolidModel, UnitNames};
use crate::nodes::cloud::Place;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What a run of a solid found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidResults {
    /// Version of riss that wrote the file.
    pub riss: String,
    /// Title of the case.
    pub case: String,
    /// Name of the method.
    pub method: String,
    /// Units of all values, if the case says them.
    #[serde(default)]
    pub units: Option<UnitNames>,
    /// How the run ended.
    pub status: RunStatus,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Time from start to end [s].
    pub wall_time_s: Option<f64>,
    /// Time of each stage [s].
    pub stage_time_s: BTreeMap<String, f64>,
    /// Greatest memory use.
    pub peak_memory_bytes: Option<u64>,
    /// What the linear solver did.
    pub solver: SolverResults,
    /// What deserves a second look: key of the case, what happened, what to do.
    pub warnings: Vec<String>,
    /// Names of the other files of this run, in the same folder.
    pub files: Vec<String>,
    /// Largest stresses at nodes.
    pub stress: StressResults,
    /// Every crack, in the order of the case.
    pub cracks: Vec<SolidCrackResults>,
    /// Every front: pieces of the rim of a crack inside the body; where cracks grow, those of the last step.
    pub fronts: Vec<FrontResults>,
    /// Area of all cracks in the body in the last step [area], where they grow.
    #[serde(default)]
    pub crack_area: Option<f64>,
    /// Why crack growth ended, where it did.
    #[serde(default)]
    pub growth_end: Option<GrowthEnd>,
    /// Steps of growth in order; none without.
    #[serde(default)]
    pub steps: Vec<SolidStepResults>,
    /// How far cohesive cracks were loaded; fields, cracks and fronts are then those at the peak.
    #[serde(default)]
    pub loading: Option<LoadingResults>,
    /// Load curve of cohesive cracks from rest; none without.
    #[serde(default)]
    pub load_curve: Vec<LoadCurvePoint>,
}

/// A step of growth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidStepResults {
    /// Number of the step, from 0.
    pub step: usize,
    /// Number of nodes.
    pub nodes: usize,
    /// Factor on the loads at which the tensile strength is reached somewhere ahead of the fronts.
    pub load_factor: Option<f64>,
    /// Number of vertices of all fronts.
    pub front_vertices: usize,
    /// Number of those that move to the next step.
    pub moving_vertices: usize,
    /// Every crack.
    pub cracks: Vec<SolidStepCrack>,
    /// Every front.
    pub fronts: Vec<FrontResults>,
    /// What deserves a second look in this step.
    pub warnings: Vec<String>,
}

/// A crack in a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidStepCrack {
    /// Its name; that of the first of those that joined.
    pub name: String,
    /// Its area in the body [area].
    pub area: Option<f64>,
}

impl SolidStepResults {
    /// The results of a step.
    pub fn new(step: &SolidStep) -> Self {
        let crack = |(name, area): (&String, &f64)| SolidStepCrack { name: name.clone(), area: finite(*area) };
        Self {
            step: step.step,
            nodes: step.result.n_nodes,
            load_factor: step.load_factor.and_then(finite),
            front_vertices: step.n_vertices,
            moving_vertices: step.n_moving,
            cracks: step.model.crack_names.iter().zip(&step.areas).map(crack).collect(),
            fronts: fronts(&step.model, &step.result),
            warnings: step.result.warnings.iter().map(ToString::to_string).collect(),
        }
    }
}

/// What the linear solver did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolverResults {
    /// The method.
    pub method: String,
    /// Multiplications by the matrix.
    pub iterations: usize,
    /// Relative residual.
    pub residual: Option<f64>,
}

/// Largest stresses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StressResults {
    /// Largest principal stress at a node that is not on a front [stress].
    pub largest_principal: Option<f64>,
    /// Where it is.
    pub position: Option<[f64; 3]>,
}

/// A crack.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidCrackResults {
    /// Its name.
    pub name: String,
    /// Largest opening between nodes of both faces [length].
    pub largest_opening: Option<f64>,
    /// Smallest opening [length]; negative if faces overlap.
    pub smallest_opening: Option<f64>,
}

/// A front.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrontResults {
    /// Name of its crack.
    pub crack: String,
    /// Whether it is a loop.
    pub closed: bool,
    /// Its length [length].
    pub length: Option<f64>,
    /// Points along it.
    pub points: Vec<FrontPointResults>,
}

/// Fracture quantities at a point of a front.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrontPointResults {
    /// The point.
    pub position: [Option<f64>; 3],
    /// Length along the front, in the direction `ahead` × `normal` [length].
    pub s: Option<f64>,
    /// Direction ahead of the crack (x1).
    pub ahead: [Option<f64>; 3],
    /// Normal of the crack (x2).
    pub normal: [Option<f64>; 3],
    /// Stress intensity factor of mode I [stress·√length].
    #[serde(rename = "K_I")]
    pub k1: Option<f64>,
    /// Stress intensity factor of mode II [stress·√length].
    #[serde(rename = "K_II")]
    pub k2: Option<f64>,
    /// Stress intensity factor of mode III [stress·√length].
    #[serde(rename = "K_III")]
    pub k3: Option<f64>,
    /// Error bar of the factors [stress·√length].
    #[serde(rename = "K_uncertainty")]
    pub k_uncertainty: Option<f64>,
    /// Stress along `ahead` that does not fade at the front [stress].
    #[serde(rename = "T")]
    pub t_stress: Option<f64>,
    /// Error bar of the T-stress [stress].
    #[serde(rename = "T_uncertainty")]
    pub t_uncertainty: Option<f64>,
    /// J-integral [stress·length].
    #[serde(rename = "J")]
    pub j: Option<f64>,
    /// Error bar of J [stress·length].
    #[serde(rename = "J_uncertainty")]
    pub j_uncertainty: Option<f64>,
    /// Radius of the largest disc [length].
    pub disc_radius: Option<f64>,
}

/// JSON schema of `results.json` of a solid.
pub fn solid_results_schema() -> String {
    let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
    let mut schema = generator.into_root_schema_for::<SolidResults>();
    schema.insert("title".into(), "results.json of riss for solids".into());
    serde_json::to_string_pretty(&schema).expect("a schema is plain values") + "\n"
}

impl SolidResults {
    /// The results of a run; `files` are the names of the others.
    pub fn new(model: &SolidModel, info: &RunInfo, result: &SolidResult, files: Vec<String>) -> Self {
        let mut stage_time_s = BTreeMap::new();
        for (stage, time) in &info.stage_time_s {
            *stage_time_s.entry(stage.clone()).or_insert(0.0) += time;
        }
        let cracks = model.crack_names.iter().zip(&result.opened_cracks).map(|(name, opened)| SolidCrackResults {
            name: name.clone(),
            largest_opening: opened.gaps.iter().copied().reduce(f64::max).and_then(finite),
            smallest_opening: opened.gaps.iter().copied().reduce(f64::min).and_then(finite),
        });
        let effort = &result.effort;
        Self {
            riss: env!("CARGO_PKG_VERSION").into(),
            case: info.title.clone(),
            method: info.method.clone(),
            units: info.units.clone(),
            status: info.status,
            nodes: result.n_nodes,
            unknowns: 3 * result.n_nodes,
            wall_time_s: finite(info.wall_time_s),
            stage_time_s,
            peak_memory_bytes: info.peak_memory_bytes,
            solver: SolverResults {
                method: effort.method.into(),
                iterations: effort.iterations,
                residual: finite(effort.residual),
            },
            warnings: result.warnings.iter().map(ToString::to_string).collect(),
            files,
            stress: stress(result),
            cracks: cracks.collect(),
            fronts: fronts(model, result),
            crack_area: None,
            growth_end: None,
            steps: vec![],
            loading: None,
            load_curve: vec![],
        }
    }

    /// Load curve and what became of it, if there is one.
    pub(super) fn loading_with_curve(&self) -> Option<(&LoadingResults, &[LoadCurvePoint])> {
        Some((self.loading.as_ref()?, &self.load_curve))
    }

    /// Adds how the cracks were loaded.
    pub fn loaded(&mut self, record: &LoadingRecord) {
        self.load_curve = load_curve(&record.curve);
        self.crack_area = self.load_curve.last().and_then(|p| p.crack_area);
        let loading = LoadingResults::new(&self.load_curve, record.peak, &record.end);
        self.loading = loading.map(|l| LoadingResults { surfaces: record.surfaces.clone(), ..l });
    }

    /// Adds how the cracks grew.
    pub fn grown(&mut self, steps: Vec<SolidStepResults>, end: Option<GrowthEnd>) {
        self.crack_area = steps.last().and_then(|s| s.cracks.iter().map(|c| c.area).sum());
        (self.growth_end, self.steps) = (end, steps);
    }
}

fn fronts(model: &SolidModel, result: &SolidResult) -> Vec<FrontResults> {
    let front = |front: &FrontRecord| FrontResults {
        crack: model.crack_names[front.crack].clone(),
        closed: front.is_closed,
        length: finite(front.length),
        points: front.points.iter().map(point).collect(),
    };
    result.fronts.iter().map(front).collect()
}

fn stress(result: &SolidResult) -> StressResults {
    // On a front the stress is none.
    let is_front = |k: usize| matches!(result.cloud.places[k], Place::Front { .. });
    let largest = (0..result.n_nodes)
        .filter(|k| !is_front(*k))
        .map(|k| (result.principal_stresses(k)[0], k))
        .filter(|(s, _)| s.is_finite())
        .max_by(|a, b| a.0.total_cmp(&b.0));
    StressResults {
        largest_principal: largest.map(|l| l.0),
        position: largest.map(|(_, k)| result.cloud.positions[k].into()),
    }
}

fn point(record: &FrontPointRecord) -> FrontPointResults {
    let (p, factors) = (&record.point, record.factors.as_ref());
    let of = |k: usize| factors.and_then(|f| finite(f.factors[k]));
    let triple = |v: crate::math::Vector3| [finite(v.x), finite(v.y), finite(v.z)];
    FrontPointResults {
        position: triple(p.position),
        s: finite(p.s),
        ahead: triple(p.ahead),
        normal: triple(p.normal),
        k1: of(0),
        k2: of(1),
        k3: of(2),
        k_uncertainty: factors.and_then(|f| finite(f.uncertainty)),
        t_stress: factors.and_then(|f| finite(f.t_stress)),
        t_uncertainty: factors.and_then(|f| finite(f.t_uncertainty)),
        j: factors.and_then(|f| finite(f.j)),
        j_uncertainty: factors.and_then(|f| finite(f.j_uncertainty)),
        disc_radius: record.radius.and_then(finite),
    }
}

fn finite(v: f64) -> Option<f64> {
    v.is_finite().then_some(v)
}
