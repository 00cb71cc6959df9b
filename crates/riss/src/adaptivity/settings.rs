//! How accurate a result shall be.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Accuracy that is asked for instead of a node spacing: nodes are refined where the error is, until it is met. Give
/// `K_percent`, `energy_percent` or both.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct AccuracySettings {
    /// Largest error bar of `K_I` and `K_II` at every tip [% of their magnitude]: the bar of any solution, or
    /// what the last refinement lets expect of the next ones.
    #[serde(rename = "K_percent")]
    #[schemars(range(min = 0.0))]
    pub k_percent: Option<f64>,
    /// Largest estimated error of the stress over the body in the energy norm, η_t of [CPM, Appendix A] [% of the norm of the
    /// stress].
    #[schemars(range(min = 0.0))]
    pub energy_percent: Option<f64>,
    /// Most refinements.
    #[schemars(range(min = 1, max = 50))]
    pub refinements: usize,
    /// Most nodes: a refinement that needs more is not made.
    #[schemars(range(min = 1, max = 2_000_000))]
    pub nodes: usize,
    /// Growth of the spacing with the distance from finer squares, in (0, 1].
    #[schemars(range(min = 0.02, max = 1.0))]
    pub growth: f64,
}

impl Default for AccuracySettings {
    fn default() -> Self {
        Self { k_percent: None, energy_percent: None, refinements: 12, nodes: 100_000, growth: 0.4 }
    }
}
