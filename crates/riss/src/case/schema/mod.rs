//! What a case file may say. Shape only: ranges and sense are checked in `build`.

mod conditions;
mod geometry;

pub(in crate::case) use conditions::*;
pub(in crate::case) use geometry::*;

use crate::adaptivity::AccuracySettings;
use crate::analysis::{GrowthSettings, LoadingSettings, Method};
use crate::approximation::ApproximationSettings;
use crate::case::build::softening::Cohesive;
use crate::case::files::FileAccess;
use crate::fracture::FractureSettings;
use crate::integration::IntegrationSettings;
use crate::material::PlaneState;
use crate::model::Contact;
use crate::nodes::settings::{Graded, Listed, Star, Structured};
use crate::system::{ConstraintMethod, LinearSolver};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// `[x, y]` [length].
pub(in crate::case) type Point = [f64; 2];

/// A riss case: a linear elastic body in the plane with cracks, loads and supports. Units are free but consistent.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "riss case")]
pub(in crate::case) struct CaseFile {
    /// Title in the results.
    #[serde(default)]
    pub title: Option<String>,
    /// Units of length, force and stress, such as "mm, N, MPa"; then numbers may carry units of their own, "200 GPa".
    #[serde(default, rename = "units")]
    pub _units: Option<String>,
    /// Where the files that the case names may lie.
    #[serde(default, rename = "files")]
    pub _files: FileAccess,
    /// Numbers with names, for expressions such as "2*a" wherever a number is due, and for sweeps.
    #[serde(default, rename = "parameters")]
    pub _parameters: BTreeMap<String, f64>,
    /// Numerical method.
    #[serde(default)]
    pub method: Method,
    /// Elastic constants.
    pub material: Material,
    /// Outline of the body.
    pub geometry: Geometry,
    /// Holes in the body.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub hole: Vec<Hole>,
    /// Stretches of the boundary that get a name of their own.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub part: Vec<Part>,
    /// Cracks.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub crack: Vec<Crack>,
    /// Contact of crack faces without friction; without this section they may overlap.
    #[serde(default)]
    pub contact: Option<Contact>,
    /// Tractions on parts of the boundary.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub load: Vec<Load>,
    /// Uniform stress on every outer edge.
    #[serde(default)]
    pub remote_stress: Option<Stress>,
    /// Prescribed displacements.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub support: Vec<Support>,
    /// Elastic foundations.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub spring: Vec<Spring>,
    /// Forces at points.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub point_load: Vec<PointLoad>,
    /// Force per volume.
    #[serde(default)]
    pub body_force: Option<BodyForce>,
    /// What holds the body as a whole.
    #[serde(default)]
    pub rigid_motion: RigidMotion,
    /// Known solution, for `exact = true` and for the error of the result.
    #[serde(default)]
    pub exact: Option<Exact>,
    /// Placement of nodes.
    #[serde(default)]
    pub nodes: Nodes,
    /// Shape functions.
    #[serde(default)]
    pub approximation: ApproximationSettings,
    /// Numerical integration.
    #[serde(default)]
    pub integration: IntegrationSettings,
    /// How prescribed displacements are enforced.
    #[serde(default)]
    pub constraints: ConstraintMethod,
    /// Linear solver.
    #[serde(default)]
    pub solver: LinearSolver,
    /// Fracture quantities.
    #[serde(default)]
    pub fracture: FractureSettings,
    /// Accuracy to refine for; without it, the nodes are as placed.
    #[serde(default)]
    pub accuracy: Option<AccuracySettings>,
    /// Crack growth; without it, the cracks stay as they are.
    #[serde(default)]
    pub growth: Option<GrowthSettings>,
    /// How far cohesive cracks are loaded.
    #[serde(default)]
    pub loading: Option<LoadingSettings>,
    /// What is written.
    #[serde(default)]
    pub output: OutputSettings,
}

/// Elastic constants.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Material {
    /// Young's modulus [stress], positive.
    pub young: f64,
    /// Poisson's ratio, above -1 and below 0.5.
    pub poisson: f64,
    /// Plane strain or plane stress.
    pub plane: PlaneState,
    /// Thickness [length], positive; 1 if not given.
    #[serde(default)]
    pub thickness: Option<f64>,
    /// Yield stress [stress], positive: with it, riss warns where linear elasticity or the plane state is doubtful.
    #[serde(default)]
    pub yield_stress: Option<f64>,
    /// Softening of cohesive cracks.
    #[serde(default)]
    pub cohesive: Option<Cohesive>,
}

/// Placement of nodes.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(in crate::case) struct Nodes {
    /// Where nodes stand.
    pub layout: Layout,
    /// Rings of nodes around each crack tip.
    pub star: Option<Star>,
}

/// Ways to place nodes, one of these.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(in crate::case) enum Layout {
    /// Irregular nodes, finer towards crack tips, holes, arcs and thin ligaments.
    Graded(Graded),
    /// A regular grid over the bounding box of the body.
    Structured(Structured),
    /// Given positions inside the body.
    Listed(Listed),
    /// Positions inside the body from a file, `x,y` a line.
    File(NodeFile),
}

impl Default for Layout {
    fn default() -> Self {
        Self::Graded(Graded::default())
    }
}

/// A file of node positions.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct NodeFile {
    /// Path, relative to the case file.
    pub path: String,
}

/// What is written besides the fracture quantities.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OutputSettings {
    /// Positions, supports and parameters of the nodes.
    pub nodes: bool,
    /// Positions and weights of the integration points.
    pub integration_points: bool,
    /// Displacement, stress and strain over the body, and a picture of them.
    pub fields: bool,
}

impl Default for OutputSettings {
    fn default() -> Self {
        Self { nodes: false, integration_points: false, fields: true }
    }
}
