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
    /// What weights do near crack tips, holes and re-entrant corners.
    pub smoothing: SmoothingSettings,
    /// The field of the tip in the basis near crack tips.
    pub enrichment: EnrichmentSettings,
    /// Distance from cracks beyond which shape functions are those of finite elements between the nodes, joined to moving
    /// least squares by a ramp of one element [length] [Belytschko1995]; nowhere if not given. Bilinear on regular nodes,
    /// linear on others: cheaper, less accurate.
    #[schemars(range(min = 0.0))]
    pub finite_elements_beyond: Option<f64>,
}

impl Default for ApproximationSettings {
    fn default() -> Self {
        Self {
            basis: Basis::Linear,
            weight_function: WeightFunction::QuarticSpline,
            dilation: None,
            support: SupportShape::Circular,
            spacing_from: SpacingFrom::Automatic,
            smoothing: SmoothingSettings::default(),
            enrichment: EnrichmentSettings::default(),
            finite_elements_beyond: None,
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

    /// The smoothing that is used, nothing left open; rectangular supports know visibility only. The full enriched basis
    /// and extrinsic enrichment need continuous weights around tips: diffraction with λ = 1 if nothing is said.
    pub fn resolved_smoothing(&self) -> SmoothingSettings {
        let mut given = match self.support {
            SupportShape::Circular => self.smoothing,
            SupportShape::Rectangular => SmoothingSettings::VISIBILITY,
        };
        let wants_diffraction = match self.enrichment.kind {
            EnrichmentKind::IntrinsicFull
            | EnrichmentKind::ExtrinsicFull
            | EnrichmentKind::ExtrinsicRadial
            | EnrichmentKind::ExtrinsicMls => true,
            EnrichmentKind::Automatic | EnrichmentKind::None | EnrichmentKind::IntrinsicRadial => false,
        };
        if wants_diffraction && given.cracks.is_none() {
            given.cracks = Some(CrackSmoothing::Diffraction { lambda: 1.0 });
        }
        SmoothingSettings { cracks: Some(given.cracks()), holes: Some(given.holes()) }
    }
}

/// Weight functions near boundaries that are not convex [EFG, section 4].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SmoothingSettings {
    /// Around cracks; if not given visibility, or diffraction with the full enriched basis and extrinsic enrichment.
    pub cracks: Option<CrackSmoothing>,
    /// Around holes and re-entrant corners; visibility if not given. Wide supports at round holes want diffraction.
    pub holes: Option<HoleSmoothing>,
}

impl SmoothingSettings {
    /// Plain visibility everywhere.
    pub const VISIBILITY: Self =
        Self { cracks: Some(CrackSmoothing::Visibility), holes: Some(HoleSmoothing::Visibility) };

    /// What is used at cracks: as given, or visibility, which gives the best K with polynomial bases.
    pub fn cracks(&self) -> CrackSmoothing {
        self.cracks.unwrap_or(CrackSmoothing::Visibility)
    }

    /// What is used at holes and re-entrant corners: as given, or visibility, which is best at sharp corners.
    pub fn holes(&self) -> HoleSmoothing {
        self.holes.unwrap_or(HoleSmoothing::Visibility)
    }
}

/// How a node acts behind a crack.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum CrackSmoothing {
    /// Not at all: cracks are opaque, and weights jump along the lines from nodes over a tip (4.1).
    Visibility,
    /// Around tips and kinks, by the shortest way (4.2).
    Diffraction {
        /// Exponent λ of the detour in Eq. 29, at least 1; the weight's argument is the length of the way for 1.
        #[serde(default = "two")]
        #[schemars(range(min = 1.0, max = 10.0))]
        lambda: f64,
    },
    /// Through the crack close to a tip, less the farther behind it; around kinks by the shortest way (4.3).
    Transparency {
        /// Distance behind the tip where the crack becomes opaque, over the node spacing at the tip (κ), positive.
        #[serde(default = "half")]
        #[schemars(range(min = 0.0, max = 10.0))]
        kappa: f64,
        /// Exponent λ of Eq. 32, at least 2.
        #[serde(default = "two")]
        #[schemars(range(min = 2.0, max = 10.0))]
        lambda: f64,
    },
    /// As if there were no crack, wherever a line inside the support leads around a tip (4.4). Shortens the crack; for
    /// comparison.
    SeeThrough,
}

/// How a node acts behind a hole or a re-entrant corner.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum HoleSmoothing {
    /// Not at all: weights jump along the lines that graze the boundary (4.1). A little is seen beyond the horizon of
    /// arcs, so that neighbors on the rim of a hole see each other.
    Visibility,
    /// Around the boundary, by the shortest way (4.2).
    Diffraction {
        /// Exponent λ of the detour in Eq. 29, at least 1, the same as around cracks; 1 where cracks are transparent.
        #[serde(default = "two")]
        #[schemars(range(min = 1.0, max = 10.0))]
        lambda: f64,
    },
    /// As if the hole were filled, wherever a line inside the support leads around it (4.4).
    SeeThrough,
}

/// Enrichment near crack tips [EFG, section 5].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct EnrichmentSettings {
    /// What the basis, or the nodes, hold besides polynomials.
    pub kind: EnrichmentKind,
    /// How enriched and plain shape functions are joined (Eq. 54), and how the functions of `extrinsic-mls` fade.
    pub ramp: Ramp,
    /// Distance from a tip up to which only enriched shape functions are used [length]; half of `r2` if not given, 0 with
    /// `extrinsic-mls`, which needs a wide ramp.
    #[schemars(range(min = 0.0))]
    pub r1: Option<f64>,
    /// Distance from a tip at which only plain shape functions are left [length]; half of the distance to boundaries,
    /// other cracks and the far end of the crack if not given, but at least 2 node spacings, or 6 where the basis is
    /// enriched; never farther than to a sharp kink. Regions never overlap. With
    /// `extrinsic-mls` they may, and end at a sharp kink or where the crack does if not given: nowhere for an edge crack.
    #[schemars(range(min = 0.0))]
    pub r2: Option<f64>,
    /// Support radius over characteristic node spacing of the nodes that reach into a region, if larger than
    /// elsewhere; the longer basis needs more neighbors.
    #[schemars(range(min = 1.0, max = 10.0))]
    pub dilation: Option<f64>,
}

impl EnrichmentSettings {
    /// The dilation that is used in the regions, if it is larger than elsewhere: as given, or for the full basis 2.75
    /// on irregular and 3.2 on regular nodes, where K is then good to 0.01 % on 9×9 nodes.
    pub fn dilation(&self, is_regular: bool) -> f64 {
        self.dilation.unwrap_or(match self.kind {
            EnrichmentKind::IntrinsicFull if is_regular => 3.2,
            EnrichmentKind::IntrinsicFull => 2.75,
            EnrichmentKind::Automatic
            | EnrichmentKind::None
            | EnrichmentKind::IntrinsicRadial
            | EnrichmentKind::ExtrinsicFull
            | EnrichmentKind::ExtrinsicRadial
            | EnrichmentKind::ExtrinsicMls => 0.0,
        })
    }
}

/// Kind of enrichment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum EnrichmentKind {
    /// `extrinsic-full` at each tip where nodes are coarse: as far apart as elsewhere, and by more than a hundredth of the
    /// distance to whatever else is there, as regular nodes are. The default nodes are finer at tips. None with an accuracy to meet, cracking particles, nodal
    /// integration, a quadratic basis, rectangular supports or another smoothing around cracks than diffraction with λ = 1.
    #[default]
    Automatic,
    /// None: polynomials only.
    None,
    /// Four functions that span the displacements at a tip in both modes, in the basis (5.3.1).
    IntrinsicFull,
    /// The root of the distance from the tip, in the basis (5.3.2): cheaper, less accurate.
    IntrinsicRadial,
    /// The four functions times the shape functions of the nodes nearer to a tip than `r2`, as further unknowns (5.2);
    /// there is no ramp, and `r1` has no meaning.
    ExtrinsicFull,
    /// The root of the distance times the shape functions of the nodes nearer to a tip than `r2` (5.2).
    ExtrinsicRadial,
    /// The displacements of both modes at each tip, with `K_I` and `K_II` as unknowns (5.1); they fade between `r1` and `r2`.
    ExtrinsicMls,
}

/// Ramp between enriched and plain shape functions [EFG, Eq. 54].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Ramp {
    /// Straight: strains jump a little at both ends.
    Linear,
    /// `1 - 10 ξ³ + 15 ξ⁴ - 6 ξ⁵`: strains are continuous.
    #[default]
    Quintic,
    /// None: the basis changes at `r2`, where displacements jump a little. For comparison.
    Abrupt,
}

fn half() -> f64 {
    0.5
}

fn two() -> f64 {
    2.0
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

/// Constrained moving least squares for point collocation [C3D, section 2.1].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ConstrainedMlsSettings {
    /// Degree of the Taylor polynomials, at least 2.
    #[schemars(range(min = 2, max = 6))]
    pub order: usize,
    /// Weight function.
    pub weight: CollocationWeight,
    /// Nodes in a support; if not given 7.89 for each term of the polynomial in space and 4.44 in the plane.
    #[schemars(range(min = 6, max = 1000))]
    pub neighbors: Option<usize>,
}

impl Default for ConstrainedMlsSettings {
    fn default() -> Self {
        Self { order: 3, weight: CollocationWeight::NonSmooth, neighbors: None }
    }
}

/// Weight function of a fit that is not differentiated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum CollocationWeight {
    /// `(1 - √s)²`, with a peak at the center [C3D, Eq. 12].
    #[default]
    NonSmooth,
    /// A smooth one.
    Smooth(WeightFunction),
}
