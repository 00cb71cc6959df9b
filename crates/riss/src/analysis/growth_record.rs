//! The words of records for growth: what each tip does, and why growth ended.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a tip does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TipStatus {
    /// Evaluated, not grown.
    Stationary,
    /// Under compression: `K_I <= 0`, where the faces would touch; with contact also that they touch at the tip.
    Closed,
    /// No integration domain fits: fracture quantities are absent.
    NotEvaluated,
    /// Grows to the next step.
    Growing,
    /// Another tip is driven harder and grows in its place.
    Waiting,
    /// Below the fatigue threshold.
    Arrested,
    /// Its piece of the body carries nothing any more.
    Unloaded,
    /// At the fracture toughness under cyclic loading: the rest of the life is not counted in cycles.
    Unstable,
    /// Not allowed to grow by the case.
    Held,
    /// Its increment ends at the outline.
    ReachedBoundary,
    /// Its increment ends in a hole.
    ReachedHole,
    /// Its increment ends at a crack.
    ReachedCrack,
}

/// What the load does as a crack goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Stability {
    /// It must rise.
    Stable,
    /// It falls: under a load that stays, the crack runs on.
    Unstable,
}

/// Why crack growth ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrowthEnd {
    /// The kind of end.
    pub kind: GrowthEndKind,
    /// In words with numbers.
    pub reason: String,
}

/// Kinds of ends of crack growth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GrowthEndKind {
    /// All steps that were asked for are done.
    StepsDone,
    /// No tip grows any more.
    NoTipGrows,
    /// The body has fallen into pieces that nothing holds.
    Separated,
    /// Fatigue has reached the fracture toughness.
    ToughnessReached,
    /// A limit of `growth.stop` is reached.
    LimitReached,
    /// The body with the longer cracks could not be analyzed.
    Failed,
}

impl TipStatus {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stationary => "stationary",
            Self::Closed => "closed",
            Self::NotEvaluated => "not-evaluated",
            Self::Growing => "growing",
            Self::Waiting => "waiting",
            Self::Arrested => "arrested",
            Self::Unloaded => "unloaded",
            Self::Unstable => "unstable",
            Self::Held => "held",
            Self::ReachedBoundary => "reached-boundary",
            Self::ReachedHole => "reached-hole",
            Self::ReachedCrack => "reached-crack",
        }
    }
}
