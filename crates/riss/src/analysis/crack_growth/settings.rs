//! Choices for crack growth.

use crate::fracture::fatigue::{GrowthLaw, LoadSpectrum};
use crate::fracture::{EquivalentFactor, GrowthCriterion};
use crate::material::Elasticity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Crack growth: which way, how far in a step, when to stop.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct GrowthSettings {
    /// Length that the tip that grows fastest advances in a step [length], positive. If not given: a tenth of the shortest
    /// crack, at least a hundredth of the size of the body, at most half of the shortest crack.
    #[schemars(range(min = 0.0))]
    pub increment: Option<f64>,
    /// Most steps of growth.
    #[schemars(range(min = 1, max = 100_000))]
    pub steps: usize,
    /// Which way a tip grows.
    pub criterion: GrowthCriterion,
    /// How both modes together are compared with a toughness, a threshold or another tip.
    pub equivalent: EquivalentFactor,
    /// Which tips grow, and how far beside the fastest.
    pub law: AdvanceLaw,
    /// How the increment follows the turns of the path.
    pub control: IncrementControl,
    /// Form of an increment.
    pub form: IncrementForm,
    /// Names of cracks that do not grow.
    pub held: Vec<String>,
    /// Cracks that start where the boundary is stretched most.
    pub seeding: Option<Seeding>,
    /// When to stop.
    pub stop: StopSettings,
}

impl Default for GrowthSettings {
    fn default() -> Self {
        Self {
            increment: None,
            steps: 100,
            criterion: GrowthCriterion::default(),
            equivalent: EquivalentFactor::default(),
            law: AdvanceLaw::default(),
            control: IncrementControl::default(),
            form: IncrementForm::default(),
            held: vec![],
            seeding: None,
            stop: StopSettings::default(),
        }
    }
}

/// Which tips grow, and how far beside the fastest.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum AdvanceLaw {
    /// Every open tip advances by the same length.
    #[default]
    Equal,
    /// The load is raised until the tip that is driven hardest reaches the toughness; it grows, and all that are as near.
    QuasiStatic(QuasiStatic),
    /// Every tip advances by its growth per cycle.
    Fatigue(Fatigue),
}

/// Growth at the toughness: `toughness` or `fracture_energy`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuasiStatic {
    /// Fracture toughness K_Ic [stress·√length], positive.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub toughness: Option<f64>,
    /// Fracture energy G_c [stress·length], positive.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub fracture_energy: Option<f64>,
    /// Tips within this part of the greatest factor grow with it, in [0, 1): numerical noise must not choose between equal ones.
    #[serde(default = "default_tie")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub tie: f64,
}

/// Ten times the usual error of a stress intensity factor.
fn default_tie() -> f64 {
    0.01
}

/// Growth by load cycles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fatigue {
    /// Growth per cycle.
    pub rate: GrowthLaw,
    /// Cycles of the loads; the loads of the case are the factor 1.
    #[serde(default)]
    pub spectrum: LoadSpectrum,
}

/// How the increment follows the turns of the path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum IncrementControl {
    /// The same in every step.
    #[default]
    Fixed,
    /// Halved in a step in which a tip turns by more than an angle [CPM, section 3.2]; doubled again where no tip turns by half of it.
    HalvedOnTurns {
        /// The angle [degrees], positive; 5 in [CPM, section 3.2].
        #[schemars(range(min = 0.0, max = 90.0))]
        angle_deg: f64,
        /// Share of the increment at which no turn halves it any more, above 0 and at most 1; 0.5 in [CPM, section 3.2].
        #[serde(default = "least_share")]
        #[schemars(range(min = 0.0, max = 1.0))]
        least: f64,
    },
    /// Halved, down to 1/16, until a step ends where two of half the length would; doubled again after steps that are four times better: the path is converged step by step.
    Converged {
        /// Distance between both ends over the increment, positive; about 0.01 is usual.
        #[schemars(range(min = 0.0, max = 1.0))]
        tolerance: f64,
    },
}

/// Four halvings.
fn least_share() -> f64 {
    1.0 / 16.0
}

/// Form of an increment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IncrementForm {
    /// Straight, as the criterion says at the tip before the increment: the usual explicit scheme. The path depends on the increment to first order.
    #[default]
    Straight,
    /// An arc whose curvature is corrected until the criterion asks for no turn at its end. Two to four solutions a step; the path hardly depends on the increment.
    Curved,
}

/// Cracks that start at the boundary, normal to it, where the tangential stress is greatest [EFG, section 6.5].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Seeding {
    /// Length of a new crack [length], positive.
    #[schemars(range(min = 0.0))]
    pub length: f64,
    /// Most cracks to start at the beginning.
    #[serde(default)]
    pub number: Option<usize>,
    /// Tangential stress from which a crack starts [stress], positive.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub stress: Option<f64>,
    /// Parts where cracks may start; every edge if not given.
    #[serde(default)]
    pub on: Vec<String>,
    /// Least distance between new cracks along the boundary [length]; four times their length if not given.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub separation: Option<f64>,
    /// Whether cracks start at the beginning only, or also from holes that a crack has reached.
    #[serde(default)]
    pub when: SeedingTime,
}

/// When cracks start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SeedingTime {
    /// Once, in the body as it is given.
    #[default]
    Once,
    /// Also in every later step from the rims of holes that cracks have reached, where the stress is beyond `stress`.
    AtReachedHoles,
}

/// When to stop; whatever comes first.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StopSettings {
    /// Load cycles.
    #[schemars(range(min = 0.0))]
    pub cycles: Option<f64>,
    /// Length of a crack [length]; half of it if both ends are tips.
    #[schemars(range(min = 0.0))]
    pub crack_length: Option<f64>,
    /// Factor on the loads in quasi-static growth.
    #[schemars(range(min = 0.0))]
    pub load_factor: Option<f64>,
}

impl QuasiStatic {
    /// The fracture toughness, from the fracture energy if that is given [stress·√length].
    pub fn toughness(&self, material: &Elasticity) -> f64 {
        let from_energy = self.fracture_energy.map(|g| (g * material.effective_young()).sqrt());
        self.toughness.or(from_energy).unwrap_or(f64::INFINITY)
    }
}
