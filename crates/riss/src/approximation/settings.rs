//! Choices of the moving least squares approximation.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Moving least squares: basis, weight function and supports.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ApproximationSettings {
    /// Polynomial basis.
    pub basis: Basis,
    /// Weight function.
    pub weight_function: WeightFunction,
    /// Support radius over characteristic node spacing (d_max); at least 1.01 for the linear and 2 for the quadratic basis.
    #[schemars(range(min = 1.0, max = 10.0))]
    pub dilation: Option<f64>,
    /// Shape of the supports.
    pub support: SupportShape,
    /// Which neighbor gives the characteristic spacing; automatic: second for regular nodes, third for irregular ones.
    pub spacing_from: SpacingFrom,
}

impl Default for ApproximationSettings {
    fn default() -> Self {
        Self {
            basis: Basis::Linear,
            weight_function: WeightFunction::QuarticSpline,
            dilation: None,
            support: SupportShape::Circular,
            spacing_from: SpacingFrom::Automatic,
        }
    }
}

impl ApproximationSettings {
    /// The dilation that is used: as given, or 3.2 (quadratic basis), 2 (linear basis on irregular nodes), 2.5 (on
    /// regular ones, and with the Gaussian [EFG, section 2]).
    pub fn dilation(&self, is_regular: bool) -> f64 {
        self.dilation.unwrap_or(match (self.basis, self.weight_function) {
            (Basis::Quadratic, _) => 3.2,
            (Basis::Linear, WeightFunction::Gaussian) => 2.5,
            (Basis::Linear, WeightFunction::QuarticSpline | WeightFunction::CubicSpline) if is_regular => 2.5,
            (Basis::Linear, WeightFunction::QuarticSpline | WeightFunction::CubicSpline) => 2.0,
        })
    }
}

/// Polynomial basis [EFG, Eq. 5].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// `[1, x, y]`.
    Linear,
    /// `[1, x, y, x², xy, y²]`.
    Quadratic,
}

/// Weight function of the distance over the support radius [EFG, Eq. 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WeightFunction {
    /// Gaussian with α = d_max/4.
    Gaussian,
    /// `1 - 6 s² + 8 s³ - 3 s⁴`.
    QuarticSpline,
    /// Cubic B-spline.
    CubicSpline,
}

/// Shape of a node's support.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SupportShape {
    /// A disk.
    Circular,
    /// A rectangle: the weight is a product over the axes.
    Rectangular,
}

/// Which neighbor's distance is the characteristic spacing of a node [EFG, section 2].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpacingFrom {
    /// Second for structured nodes, third otherwise.
    Automatic,
    /// The second nearest.
    SecondNeighbor,
    /// The third nearest.
    ThirdNeighbor,
}
