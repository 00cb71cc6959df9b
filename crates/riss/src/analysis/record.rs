//! What an analysis reports.

use super::cohesive::LoadPoint;
use super::crack_growth::GrowthState;
use super::growth_record::{GrowthEnd, Stability, TipStatus};
use super::solid_cohesive::{CohesiveSurfaces, LoadingStep};
use super::solid_growth::{SolidGrowthState, SolidStep};
use super::warnings::Warning;
use crate::crack::{End, EndKind, TipFrame};
use crate::math::{Matrix2, Vector2};
use std::ops::ControlFlow;

/// Stages of an analysis, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Node generation.
    Nodes,
    /// Supports, neighbor lists and integration points.
    Discretization,
    /// Stiffness matrix and load vector.
    Assembly,
    /// Linear solve.
    Solve,
    /// Stress intensity factors and J.
    Fracture,
    /// Fields for output.
    Fields,
}

impl Stage {
    /// Name in results and on the terminal.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nodes => "nodes",
            Self::Discretization => "discretization",
            Self::Assembly => "assembly",
            Self::Solve => "solve",
            Self::Fracture => "fracture",
            Self::Fields => "fields",
        }
    }
}

/// Hears how an analysis goes on; the only way out of it.
pub trait Observer {
    /// A stage begins; the one before has ended.
    fn stage(&mut self, _stage: Stage) {}
    /// Something the user should know.
    fn warning(&mut self, _warning: &Warning) {}
    /// A solution on the way to the accuracy that was asked for is complete.
    fn refinement(&mut self, _record: &RefinementRecord) {}
    /// Whether fields shall be sampled in a step: they cost about as much as assembly.
    fn wants_fields(&self, _step: usize) -> bool {
        true
    }
    /// A step is complete. A break ends the analysis there.
    fn step(&mut self, _result: &StaticResult, _state: Option<&GrowthState>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// The path of a loaded solid with cohesive cracks has come to one more point, the last of `curve`; it begins anew after a
    /// front grew. A break ends the analysis there.
    fn load_curve(&mut self, _curve: &[LoadPoint]) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// Cohesive surfaces have grown, and are loaded from rest next. A break ends the analysis there.
    fn surfaces_grown(&mut self, _surfaces: &CohesiveSurfaces) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// A step of the growth of cohesive cracks in the plane, which come to their load later, began with this state. A break
    /// ends the analysis there.
    fn ways_grown(&mut self, _state: &GrowthState) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// A state of a loaded solid with cohesive cracks is complete with its fields. A break ends the analysis there.
    fn loading_step(&mut self, _step: &LoadingStep) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// A step of growth in a solid is complete; `state` is the one that it began with. A break ends the analysis there.
    fn solid_step(&mut self, _step: &SolidStep, _state: &SolidGrowthState) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Hears nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {}

/// One step; a static analysis has one.
#[derive(Clone, Debug, PartialEq)]
pub struct StepRecord {
    /// Number of the step, from 0.
    pub step: usize,
    /// Factor on the loads at which the crack grows; 1 unless growth is quasi-static, and all else is for a factor of 1.
    /// Cohesive cracks: the factor on the loads that all else is for.
    pub load_factor: f64,
    /// Load cycles so far, in fatigue.
    pub cycles: Option<f64>,
    /// The same if all factors are larger, or smaller, by their error bars; infinite where the crack then does not grow.
    pub cycles_range: Option<[f64; 2]>,
    /// Whether the load must rise for the crack to go on, in quasi-static growth from the second step on.
    pub stability: Option<Stability>,
    /// Why growth ends with this step, if it does.
    pub end: Option<GrowthEnd>,
    /// Every crack, in the order of the case.
    pub cracks: Vec<CrackRecord>,
    /// Force of each supported part on the body, by name, over the thickness.
    pub reactions: Vec<(String, Vector2)>,
}

/// A crack in one step.
#[derive(Clone, Debug, PartialEq)]
pub struct CrackRecord {
    /// Name of the crack.
    pub name: String,
    /// Its path.
    pub path: Vec<Vector2>,
    /// What its first and last vertex are.
    pub ends: [EndKind; 2],
    /// Its tips.
    pub tips: Vec<TipRecord>,
}

/// A tip in one step. What is not known is `None`.
#[derive(Clone, Debug, PartialEq)]
pub struct TipRecord {
    /// Which end of the path.
    pub end: End,
    /// Position of the tip.
    pub position: Vector2,
    /// Direction ahead from the x axis [rad].
    pub angle: f64,
    /// Mode I stress intensity factor [stress·√length].
    pub k1: Option<f64>,
    /// Mode II stress intensity factor [stress·√length].
    pub k2: Option<f64>,
    /// Error bar of both ([`error_bars`](super::error_bars)); with an accuracy to meet at least what the last refinement
    /// lets expect of the next ones [stress·√length].
    pub k_uncertainty: Option<f64>,
    /// Mode I factor that was solved for as an unknown, with `extrinsic-mls` [stress·√length].
    pub k1_direct: Option<f64>,
    /// Mode II factor that was solved for as an unknown, with `extrinsic-mls` [stress·√length].
    pub k2_direct: Option<f64>,
    /// J-integral [stress·length].
    pub j: Option<f64>,
    /// Error bar of the J-integral ([`error_bars`](super::error_bars)) [stress·length].
    pub j_uncertainty: Option<f64>,
    /// T-stress [stress].
    pub t_stress: Option<f64>,
    /// Error bar of the T-stress ([`error_bars`](super::error_bars)) [stress].
    pub t_uncertainty: Option<f64>,
    /// Configurational force in the tip frame [stress·length].
    pub configurational_force: Option<Vector2>,
    /// Angle of the next increment against the direction ahead, counterclockwise [rad].
    pub kink_angle: Option<f64>,
    /// Mode I factor that drives as hard as both modes together [stress·√length].
    pub k_equivalent: Option<f64>,
    /// Length of the next increment [length]; 0 for a tip that stays.
    pub increment: Option<f64>,
    /// Growth per cycle in fatigue [length].
    pub growth_rate: Option<f64>,
    /// What the tip does.
    pub status: TipStatus,
    /// Why, in words with numbers, where growth was asked for.
    pub reason: Option<String>,
    /// Radii of the integration domains that were used [length].
    pub radii: Vec<f64>,
}

impl TipRecord {
    /// A tip of which only the place is known.
    pub fn unknown(end: End, frame: TipFrame) -> Self {
        Self {
            end,
            position: frame.position,
            angle: frame.angle,
            k1: None,
            k2: None,
            k_uncertainty: None,
            k1_direct: None,
            k2_direct: None,
            j: None,
            j_uncertainty: None,
            t_stress: None,
            t_uncertainty: None,
            configurational_force: None,
            kink_angle: None,
            k_equivalent: None,
            increment: None,
            growth_rate: None,
            status: TipStatus::NotEvaluated,
            reason: None,
            radii: vec![],
        }
    }
}

/// One of the solutions on the way to the accuracy that was asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct RefinementRecord {
    /// Number of nodes.
    pub n_nodes: usize,
    /// Estimated error of the stress in the energy norm, over the norm of the stress.
    pub error_estimate: f64,
    /// The error itself, where an exact field is known.
    pub energy_error: Option<f64>,
    /// Largest error bar of the stress intensity factors over their magnitude; unknown in the first solution.
    pub k_error: Option<f64>,
    /// `K_I` and `K_II` of every tip that has them, in order [stress·√length].
    pub factors: Vec<[f64; 2]>,
}

/// Everything a static analysis finds.
#[derive(Clone, Debug)]
pub struct StaticResult {
    /// Cracks, tips and reactions.
    pub step: StepRecord,
    /// Number of nodes.
    pub n_nodes: usize,
    /// Number of unknowns, multipliers included.
    pub n_unknowns: usize,
    /// Number of integration points.
    pub n_integration_points: usize,
    /// Strain energy over the thickness [stress·length³].
    pub strain_energy: f64,
    /// Energy norm of the error over that of the solution, where an exact field is known.
    pub energy_error: Option<f64>,
    /// Relative residual of the linear system.
    pub residual: f64,
    /// Solutions on the way to the accuracy that was asked for, this one last; none without such a wish.
    pub refinements: Vec<RefinementRecord>,
    /// Fields over the body.
    pub fields: Fields,
    /// Positions of the nodes.
    pub nodes: Vec<NodeRecord>,
    /// Parameters of the additional functions of enriched nodes [length].
    pub extra_parameters: Vec<Vector2>,
    /// Integration points: position and integration weight.
    pub integration_points: Vec<(Vector2, f64)>,
    /// All warnings, in order.
    pub warnings: Vec<Warning>,
}

impl StaticResult {
    /// A step without a solution.
    pub fn unsolved(step: StepRecord) -> Self {
        Self {
            step,
            n_nodes: 0,
            n_unknowns: 0,
            n_integration_points: 0,
            strain_energy: f64::NAN,
            energy_error: None,
            residual: f64::NAN,
            refinements: vec![],
            fields: Fields::default(),
            nodes: vec![],
            extra_parameters: vec![],
            integration_points: vec![],
            warnings: vec![],
        }
    }
}

/// A node as output shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeRecord {
    /// Position.
    pub position: Vector2,
    /// Support radius [length].
    pub support_radius: f64,
    /// Nodal parameters of the displacement [length].
    pub parameters: Vector2,
}

/// Fields sampled at the vertices of triangles that cover the body; vertices on crack faces come once for each face.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fields {
    /// Vertex positions.
    pub positions: Vec<Vector2>,
    /// Triangles by vertex, counterclockwise.
    pub triangles: Vec<[u32; 3]>,
    /// Displacement [length].
    pub displacement: Vec<Vector2>,
    /// In-plane stress [stress].
    pub stress: Vec<Matrix2>,
    /// In-plane strain.
    pub strain: Vec<Matrix2>,
    /// Normal stress out of the plane [stress].
    pub out_of_plane_stress: Vec<f64>,
    /// Normal strain out of the plane.
    pub out_of_plane_strain: Vec<f64>,
    /// Von Mises stress [stress].
    pub von_mises: Vec<f64>,
    /// Error indicator: difference between stress and smoothed stress in the energy norm, per point [√(stress)].
    pub error_indicator: Vec<f64>,
    /// Displacement of both faces along each crack, for the crack lines.
    pub crack_faces: Vec<CrackFaces>,
}

/// Both faces of a crack, vertex by vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CrackFaces {
    /// Points along the path, from start to end.
    pub positions: Vec<Vector2>,
    /// Displacement of the face to the left of the path [length].
    pub left: Vec<Vector2>,
    /// Displacement of the face to the right of the path [length].
    pub right: Vec<Vector2>,
    /// Traction that pulls the faces together along the normal [stress]; none unless the crack is cohesive.
    pub traction: Vec<f64>,
}
