//! Choices of numerical integration.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Integration of the weak form [EFG, section 3.2].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct IntegrationSettings {
    /// The cells.
    pub scheme: Scheme,
    /// Gauss points in each direction of a quadrilateral; triangles take a rule of like density.
    #[schemars(range(min = 1, max = 30))]
    pub points: usize,
    /// The same in cells at a crack tip.
    #[schemars(range(min = 1, max = 30))]
    pub tip_points: usize,
    /// Where points stand in cells at a crack tip.
    pub tip_rule: TipRule,
    /// Whether gradients are corrected so that each cell satisfies the divergence theorem.
    pub gradient_correction: GradientCorrection,
}

impl Default for IntegrationSettings {
    fn default() -> Self {
        Self {
            scheme: Scheme::Elements,
            points: 4,
            tip_points: 9,
            tip_rule: TipRule::Automatic,
            gradient_correction: GradientCorrection::Cell,
        }
    }
}

impl IntegrationSettings {
    /// These settings with the given rule at tips, if that is left to choose.
    pub fn at_tips(&self, rule: TipRule) -> Self {
        let tip_rule = if self.tip_rule == TipRule::Automatic { rule } else { self.tip_rule };
        Self { tip_rule, ..*self }
    }
}

/// Rule in cells at a crack tip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TipRule {
    /// Graded with enrichment, else product.
    Automatic,
    /// Gauss points in each direction; triangles are squares collapsed to the tip.
    Product,
    /// All cells are collapsed to the tip, with distances from it that are squares of Gauss points: exact for powers of
    /// the root of the distance [Duffy1982].
    Graded,
}

/// The cells that carry the integration points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Scheme {
    /// Triangles and rectangles between the nodes, fitted to boundary and cracks (element quadrature).
    Elements,
    /// A background grid clipped by the boundary (cell quadrature).
    Cells {
        /// Edge length of a cell [length].
        #[schemars(range(min = 0.0))]
        size: f64,
    },
    /// Cells around the nodes; strains are means over them [Chen2001], stabilized by those of their parts [Puso2008].
    /// Needs the gradient correction, and takes no Gauss points inside the body.
    Nodal {
        /// Weight of the difference between the strain of a part and that of its cell, from 0 (as in the first paper) to 1
        /// (the parts stand for themselves).
        #[serde(default = "full_stabilization")]
        #[schemars(range(min = 0.0, max = 1.0))]
        stabilization: f64,
    },
}

fn full_stabilization() -> f64 {
    1.0
}

/// Correction of shape function gradients at integration points [Duan2012].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GradientCorrection {
    /// Plain Gauss integration, as in the papers.
    None,
    /// A constant for each cell and node, so that linear patch tests hold to round-off.
    Cell,
}
