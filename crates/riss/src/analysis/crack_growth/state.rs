//! What a step needs to know of the steps before it: enough to go on from there.

use crate::crack::{CrackPath, TipId};
use crate::model::Model;
use serde::{Deserialize, Serialize};

/// The automatic increment: shares of the shortest crack, and of the root of the area.
const INCREMENT_OF_CRACK: [f64; 2] = [0.1, 0.5];
const INCREMENT_OF_BODY: f64 = 0.01;

/// Where crack growth stands at the beginning of a step. The same state gives the same steps, bit by bit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GrowthState {
    /// Number of the step.
    pub step: usize,
    /// Cracks in this step.
    pub cracks: Vec<CrackPath>,
    /// Load cycles up to the step before.
    pub cycles: f64,
    /// The same if all factors are larger, or smaller, by their error bars; the largest number where that is too few to grow.
    #[serde(default)]
    pub cycles_range: [f64; 2],
    /// The increment from the step before, which the cycles are still to be counted of.
    pub leader: Option<Leader>,
    /// Factor on the loads in the step before.
    pub load_factor: Option<f64>,
    /// The largest equivalent factor of any open tip so far, before loads are scaled [stress·√length].
    #[serde(default)]
    pub hardest: f64,
    /// Increment that follows from the cracks at the beginning, for a case that gives none [length].
    pub automatic_increment: f64,
    /// Share of the increment that the increment control has left.
    pub scale: f64,
    /// What tips carry from step to step.
    pub tips: Vec<TipMemory>,
    /// Loops of the domain that cracks have reached and that may start new ones, in order.
    pub reached_loops: Vec<usize>,
    /// Warnings that were said and are not said again.
    #[serde(default)]
    pub said: Vec<String>,
}

/// The tip that set the pace of an increment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Leader {
    /// The tip.
    pub tip: TipId,
    /// Length of its crack as in handbooks, before and after the increment [length].
    pub lengths: [f64; 2],
    /// Equivalent factor before the increment [stress·√length].
    pub k_equivalent: f64,
    /// Error bar of the factors before the increment [stress·√length].
    #[serde(default)]
    pub k_uncertainty: f64,
}

/// What a tip carries from step to step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TipMemory {
    /// The tip.
    pub tip: TipId,
    /// Curvature of its last increment, positive to the left [1/length].
    pub curvature: f64,
    /// Growth that was too short to be made yet [length].
    pub pending: f64,
}

impl GrowthState {
    /// The state of the first step.
    pub fn first(model: &Model) -> Self {
        let automatic_increment = automatic_increment(model);
        Self { cracks: model.cracks.clone(), automatic_increment, scale: 1.0, ..Self::default() }
    }

    /// Memory of a tip; nothing for a new one.
    pub fn memory(&self, tip: TipId) -> TipMemory {
        let known = self.tips.iter().find(|m| m.tip == tip).copied();
        known.unwrap_or(TipMemory { tip, curvature: 0.0, pending: 0.0 })
    }
}

/// A length that follows the cracks and the body.
fn automatic_increment(model: &Model) -> f64 {
    let shortest = model.cracks.iter().map(|c| c.handbook_length()).fold(f64::INFINITY, f64::min);
    let of_body = INCREMENT_OF_BODY * model.domain.area().sqrt();
    if shortest.is_finite() {
        of_body.clamp(INCREMENT_OF_CRACK[0] * shortest, INCREMENT_OF_CRACK[1] * shortest)
    } else {
        of_body
    }
}
