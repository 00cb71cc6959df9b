//! What makes the fronts of a solid grow.

use crate::fracture::GrowthCriterion;
use crate::nodes::solid::SpacingPlan;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How cracks of a solid grow.
#[derive(Clone, Debug)]
pub struct SolidGrowthSettings {
    /// Number of steps at most: solutions after the first.
    pub steps: usize,
    /// Longest step of a front [length].
    pub increment: f64,
    /// Which vertices of fronts grow, and which way.
    pub criterion: FrontCriterion,
    /// From which the spacing of nodes follows, as fronts move.
    pub spacing: SpacingPlan,
}

/// Which vertices of a front grow, and which way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum FrontCriterion {
    /// Where the largest principal stress reaches a strength, across that stress [C3D, section 2.5]; each by the increment.
    LargestPrincipalStress {
        /// Tensile strength, positive [stress].
        tensile_strength: f64,
    },
    /// By the stress intensity factors: the increment where they are largest, elsewhere less.
    StressIntensityFactors {
        /// Lengths go with the equivalent factor to this power: the exponent of Paris's law in fatigue.
        #[schemars(range(min = 0.0, max = 20.0))]
        exponent: f64,
        /// The direction, from the factors of modes I and II.
        #[serde(default)]
        direction: GrowthCriterion,
    },
}
