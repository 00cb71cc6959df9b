//! How nodes are placed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Placement of nodes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct NodeSettings {
    /// Where nodes stand.
    pub layout: Layout,
    /// Rings of nodes around each crack tip [EFG, section 2.2]; nodes of the layout inside the outermost ring are switched off.
    pub star: Option<Star>,
}

/// Ways to place nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Layout {
    /// Irregular nodes, finer towards crack tips, holes, arcs and thin ligaments.
    Graded(Graded),
    /// A regular grid over the bounding box of the body.
    Structured(Structured),
    /// Given positions inside the body, one `[x, y]` a node; nodes on the boundary are added along it.
    Listed(Listed),
}

impl Default for Layout {
    fn default() -> Self {
        Self::Graded(Graded::default())
    }
}

/// Graded irregular nodes. Whatever is not given follows from the geometry.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Graded {
    /// Largest node spacing [length].
    #[schemars(range(min = 0.0))]
    pub spacing: Option<f64>,
    /// Node spacing at crack tips [length]; a 300th of the free radius if not given, and less by as much as `spacing` is
    /// below what it is if not given.
    #[schemars(range(min = 0.0))]
    pub tip_spacing: Option<f64>,
    /// Growth of the spacing with distance from where it is smallest, in (0, 1]; about 0.2 is usual.
    #[schemars(range(min = 0.02, max = 1.0))]
    pub growth: Option<f64>,
}

/// A regular grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Structured {
    /// Nodes along x, at least 2.
    #[schemars(range(min = 2))]
    pub nx: usize,
    /// Nodes along y, at least 2.
    #[schemars(range(min = 2))]
    pub ny: usize,
}

/// Given nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Listed {
    /// Positions `[x, y]` [length].
    pub positions: Vec<[f64; 2]>,
}

/// Rings of nodes around a crack tip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Star {
    /// Radii of the rings as multiples of the crack length (half length for a crack with two tips), ascending.
    pub radii: Vec<f64>,
    /// Nodes in each ring, at least 3.
    #[schemars(range(min = 3))]
    pub nodes_per_ring: usize,
}
