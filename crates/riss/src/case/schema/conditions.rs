//! Loads, supports and known solutions.

use super::Point;
use schemars::JsonSchema;
use serde::Deserialize;

/// A number, or an expression such as "2*y^2 - sin(pi*x)" in x, y and on the boundary the outward normal nx, ny.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(in crate::case) enum Scalar {
    /// A number.
    Number(f64),
    /// An expression.
    Expression(String),
}

impl Scalar {
    /// Its value, unless it is an expression.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Expression(_) => None,
        }
    }
}

/// One name or several.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(in crate::case) enum Names {
    /// One.
    One(String),
    /// Several.
    Many(Vec<String>),
}

/// A traction: one of `traction`, `pressure`, `stress`, `exact`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Load {
    /// Part or parts; outline is every outer edge.
    pub on: Names,
    /// Force per area along x and y [stress].
    #[serde(default)]
    pub traction: Option<[Scalar; 2]>,
    /// Pressure against the body [stress].
    #[serde(default)]
    pub pressure: Option<Scalar>,
    /// The traction of this uniform stress.
    #[serde(default)]
    pub stress: Option<Stress>,
    /// The traction of the field in `[exact]`.
    #[serde(default)]
    pub exact: Option<bool>,
}

/// A uniform stress [stress]; components that are not given are zero.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Stress {
    /// Normal stress along x.
    #[serde(default)]
    pub xx: f64,
    /// Normal stress along y.
    #[serde(default)]
    pub yy: f64,
    /// Shear stress.
    #[serde(default)]
    pub xy: f64,
}

/// Prescribed displacements on parts (`on`) or at a point (`at`); directions that are not given stay free.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Support {
    /// Part or parts; outline is every outer edge.
    #[serde(default)]
    pub on: Option<Names>,
    /// A point of the body [length].
    #[serde(default)]
    pub at: Option<Point>,
    /// Displacement along x [length].
    #[serde(default)]
    pub x: Option<Scalar>,
    /// Displacement along y [length].
    #[serde(default)]
    pub y: Option<Scalar>,
    /// Displacement along the outward normal [length].
    #[serde(default)]
    pub normal: Option<Scalar>,
    /// Both components of the field in `[exact]`.
    #[serde(default)]
    pub exact: Option<bool>,
}

/// Springs that resist displacement [stress/length].
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Spring {
    /// Part or parts; outline is every outer edge.
    pub on: Names,
    /// Stiffness along x.
    #[serde(default)]
    pub x: Option<Scalar>,
    /// Stiffness along y.
    #[serde(default)]
    pub y: Option<Scalar>,
    /// Stiffness along the normal.
    #[serde(default)]
    pub normal: Option<Scalar>,
}

/// A force at a point.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct PointLoad {
    /// A point of the body [length].
    pub at: Point,
    /// Force along x and y over the whole thickness [force].
    pub force: [f64; 2],
}

/// Force per volume [stress/length]; components that are not given are zero.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct BodyForce {
    /// Along x.
    #[serde(default)]
    pub x: Option<Scalar>,
    /// Along y.
    #[serde(default)]
    pub y: Option<Scalar>,
}

/// What holds the body as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(in crate::case) enum RigidMotion {
    /// The supports.
    #[default]
    Supported,
    /// The mean displacement and rotation of the body are zero; loads must balance.
    MeanIsZero,
}

/// A known solution, one of these.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(in crate::case) enum Exact {
    /// Near-tip field of a crack.
    CrackTip(CrackTip),
    /// Infinite plate with a circular hole under tension along x.
    PlateWithHole(PlateWithHole),
    /// Timoshenko's cantilever on 0 <= x <= length, |y| <= height/2, held at x = 0.
    Cantilever(Cantilever),
    /// Displacement linear in x and y.
    Linear(Linear),
}

/// Near-tip field.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub(in crate::case) struct CrackTip {
    /// The tip [length].
    pub tip: Point,
    /// Direction ahead of the crack, from the x axis [degrees].
    #[serde(default)]
    pub angle_deg: f64,
    /// Mode I stress intensity factor [stress·√length].
    #[serde(default)]
    pub K_I: f64,
    /// Mode II stress intensity factor [stress·√length].
    #[serde(default)]
    pub K_II: f64,
    /// T-stress [stress].
    #[serde(default)]
    pub T: f64,
}

/// Plate with a hole.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct PlateWithHole {
    /// Center of the hole [length].
    pub center: Point,
    /// Radius of the hole [length], positive.
    pub radius: f64,
    /// Remote stress along x [stress].
    pub stress: f64,
}

/// Cantilever.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Cantilever {
    /// Length [length], positive.
    pub length: f64,
    /// Height [length], positive.
    pub height: f64,
    /// Force at the end along -y per thickness [stress·length].
    pub load: f64,
}

/// Linear field.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Linear {
    /// Displacement at the origin [length].
    #[serde(default)]
    pub constant: Point,
    /// Displacement gradient, rows `[[ux,x, ux,y], [uy,x, uy,y]]`.
    pub gradient: [[f64; 2]; 2],
}
