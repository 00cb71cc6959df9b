//! How a body with cohesive cracks is loaded.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How far the load of a body with cohesive cracks is followed. All loads and prescribed displacements grow by one factor,
/// which rises and falls so that the cracks open.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LoadingSettings {
    /// Number of steps along the load curve at most.
    #[schemars(range(min = 1, max = 100000))]
    pub steps: usize,
    /// Share of the greatest load at which the run ends.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub stop_load: f64,
    /// Displacement of the load at which the run ends [length].
    pub largest_displacement: Option<f64>,
}

impl Default for LoadingSettings {
    fn default() -> Self {
        Self { steps: 5000, stop_load: 0.02, largest_displacement: None }
    }
}
