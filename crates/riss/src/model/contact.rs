//! Contact of crack faces.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Contact of crack faces without friction: where they would overlap, a pressure in proportion to the mean overlap over
/// some spacings holds them apart.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Contact {
    /// Pressure per overlap, times the length of the mean over Young's modulus, positive; about 1e3.
    #[schemars(range(min = 0.0))]
    pub penalty: f64,
}

/// The K_I of a crack that compression closes all over is 5e-4 and 5e-5 of that without contact for 1e2 and 1e3; the
/// search for the closed part settles for 1e5 as well.
impl Default for Contact {
    fn default() -> Self {
        Self { penalty: 1e3 }
    }
}
