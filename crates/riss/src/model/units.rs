//! Names of the units in which a problem is stated.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Names of consistent units: stress is force over length squared.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UnitNames {
    /// Of lengths, such as `mm`.
    pub length: String,
    /// Of forces, such as `N`.
    pub force: String,
    /// Of stresses, such as `MPa`.
    pub stress: String,
}

impl UnitNames {
    /// Of stress intensity factors, such as `MPa√mm`.
    pub fn stress_intensity(&self) -> String {
        format!("{}√{}", self.stress, self.length)
    }
}
