//! What the case file of a solid may say. Shape only: ranges and sense are checked in the files beside.

use super::exact::SolidExact;
use super::growth::SolidGrowth;
use crate::analysis::LoadingSettings;
use crate::case::build::softening::Cohesive;
use crate::case::files::FileAccess;
use crate::case::schema::{Names, RigidMotion, Scalar};
use crate::nodes::solid::NodesOnFronts;
use crate::system::CollocationSettings;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// `[x, y, z]`.
pub(in crate::case) type Triple = [f64; 3];

/// A riss case: a linear elastic solid with cracks, loads and supports. Units are free but consistent.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "riss case of a solid")]
pub(in crate::case) struct SolidFile {
    /// Title in the results.
    #[serde(default)]
    pub title: Option<String>,
    /// Units of length, force and stress, such as "mm, N, MPa"; then numbers may carry units of their own, "200 GPa".
    #[serde(default, rename = "units")]
    pub _units: Option<String>,
    /// Numbers with names, for expressions such as "2*a" wherever a number is due, and for sweeps.
    #[serde(default, rename = "parameters")]
    pub _parameters: BTreeMap<String, f64>,
    /// Where the files that the case names may lie.
    #[serde(default, rename = "files")]
    pub _files: FileAccess,
    /// Numerical method.
    #[serde(rename = "method")]
    pub _method: SolidMethod,
    /// Elastic constants.
    pub material: SolidMaterial,
    /// The body.
    pub geometry: SolidGeometry,
    /// Voids in the body.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub void: Vec<Void>,
    /// Pieces of the boundary that get a name of their own.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub part: Vec<SolidPart>,
    /// Cracks.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub crack: Vec<SolidCrack>,
    /// Tractions on parts of the boundary.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub load: Vec<SolidLoad>,
    /// Uniform stress on all of the outer boundary.
    #[serde(default)]
    pub remote_stress: Option<SolidStress>,
    /// Prescribed displacements.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub support: Vec<SolidSupport>,
    /// Force per volume.
    #[serde(default)]
    pub body_force: Option<SolidBodyForce>,
    /// What holds the body as a whole; with `mean-is-zero`, in the motions that supports leave free.
    #[serde(default)]
    pub rigid_motion: RigidMotion,
    /// Known solution, for `exact = true`.
    #[serde(default)]
    pub exact: Option<SolidExact>,
    /// Placement of nodes.
    #[serde(default)]
    pub nodes: SolidNodes,
    /// Shape functions, corners and solver.
    #[serde(default)]
    pub collocation: CollocationSettings,
    /// Fracture quantities.
    #[serde(default)]
    pub fracture: SolidFracture,
    /// How cracks grow; without it they stay as they are.
    #[serde(default)]
    pub growth: Option<SolidGrowth>,
    /// How far the load is followed where cracks are cohesive.
    #[serde(default)]
    pub loading: Option<LoadingSettings>,
}

/// Numerical method.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(in crate::case) enum SolidMethod {
    /// Point collocation with constrained moving least squares, in space.
    Collocation,
}

/// Elastic constants.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct SolidMaterial {
    /// Young's modulus [stress], positive.
    pub young: f64,
    /// Poisson's ratio, above -1 and up to 0.45.
    pub poisson: f64,
    /// Yield stress [stress]: with it, plastic zones that are too large for linear elasticity are told.
    #[serde(default)]
    pub yield_stress: Option<f64>,
    /// Softening of cohesive cracks.
    #[serde(default)]
    pub cohesive: Option<Cohesive>,
}

/// The body, one of these.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(in crate::case) enum SolidGeometry {
    /// Parts x-min, x-max, y-min, y-max, z-min, z-max.
    Box(SolidBox),
    /// Parts side, bottom (at `from`), top.
    Cylinder(SolidCylinder),
    /// Part surface.
    Ball(SolidBall),
    /// Triangles of an STL file; its smooth pieces are the parts face-1, face-2 and so on
    Stl(SolidMeshFile),
    /// Surface triangles of a Gmsh mesh; parts are its physical surfaces.
    Gmsh(SolidMeshFile),
}

/// A box along the axes.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct SolidBox {
    /// Corner of least coordinates [length].
    pub lower: Triple,
    /// Corner of greatest coordinates [length].
    pub upper: Triple,
}

/// A circular cylinder.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct SolidCylinder {
    /// Center of one end [length].
    pub from: Triple,
    /// Center of the other end [length].
    pub to: Triple,
    /// Radius [length], positive.
    pub radius: f64,
}

/// A ball.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct SolidBall {
    /// Center [length].
    pub center: Triple,
    /// Radius [length], positive.
    pub radius: f64,
}

/// A file beside the case.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct SolidMeshFile {
    /// Path, relative to the case file.
    pub file: String,
    /// Angle between triangles from which an edge is sharp [degrees]; 30 if not given.
    #[serde(default)]
    #[schemars(range(min = 1.0, max = 90.0))]
    pub feature_angle: Option<f64>,
}

/// A void inside the body: one of `ball`, `cylinder`, `box`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Void {
    /// Name of its surface as a part; void-1, void-2, ... if not given. That of a box or cylinder has several pieces.
    #[serde(default)]
    pub name: Option<String>,
    /// A ball.
    #[serde(default)]
    pub ball: Option<SolidBall>,
    /// A cylinder.
    #[serde(default)]
    pub cylinder: Option<SolidCylinder>,
    /// A box.
    #[serde(default, rename = "box")]
    pub cuboid: Option<SolidBox>,
}

/// A named piece of the boundary: all of its triangles inside a box.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct SolidPart {
    /// Its name.
    pub name: String,
    /// The box that holds it.
    pub within: SolidBox,
}

/// A crack: one of `disc`, `ellipse`, `polygon`, `stl`. What of it lies outside the body is cut off.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct SolidCrack {
    /// Name in the results; crack-1, crack-2, ... if not given.
    #[serde(default)]
    pub name: Option<String>,
    /// A disc.
    #[serde(default)]
    pub disc: Option<Disc>,
    /// An ellipse.
    #[serde(default)]
    pub ellipse: Option<Ellipse>,
    /// Corners of a plane polygon, at least 3 [length]; seen from its positive side they run counterclockwise.
    #[serde(default)]
    pub polygon: Option<Vec<Triple>>,
    /// An STL file of an open surface, relative to the case file.
    #[serde(default)]
    pub stl: Option<String>,
    /// Pressure on both faces [stress]; positive pushes them apart.
    #[serde(default)]
    pub pressure: Option<f64>,
    /// Whether its faces are tied until they reach the strength, and then open by `[material.cohesive]`.
    #[serde(default)]
    pub cohesive: bool,
    /// Boxes in which a cohesive crack is open and free from the beginning.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub notch: Vec<SolidBox>,
}

/// A disc.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Disc {
    /// Center [length].
    pub center: Triple,
    /// Normal, to its positive side; of any length.
    pub normal: Triple,
    /// Radius [length], positive.
    pub radius: f64,
}

/// An ellipse.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Ellipse {
    /// Center [length].
    pub center: Triple,
    /// Normal, to its positive side; of any length.
    pub normal: Triple,
    /// Direction of the first half axis; its part along the normal does not count.
    pub axis: Triple,
    /// Half axes [length], positive.
    pub radii: [f64; 2],
}

/// A traction: one of `traction`, `pressure`, `stress`, `exact`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct SolidLoad {
    /// Part or parts; boundary is all of it.
    pub on: Names,
    /// Force per area along x, y and z [stress].
    #[serde(default)]
    pub traction: Option<[Scalar; 3]>,
    /// Pressure against the body [stress].
    #[serde(default)]
    pub pressure: Option<Scalar>,
    /// The traction of this uniform stress.
    #[serde(default)]
    pub stress: Option<SolidStress>,
    /// The traction of the field in `[exact]`.
    #[serde(default)]
    pub exact: Option<bool>,
}

/// A uniform stress [stress]; components that are not given are zero.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[derive(Default)]
pub(in crate::case) struct SolidStress {
    /// Normal stress along x [stress].
    pub xx: f64,
    /// Normal stress along y [stress].
    pub yy: f64,
    /// Normal stress along z [stress].
    pub zz: f64,
    /// Shear stress [stress].
    pub xy: f64,
    /// Shear stress [stress].
    pub yz: f64,
    /// Shear stress [stress].
    pub xz: f64,
}

/// Prescribed displacements on parts; directions that are not given stay free.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct SolidSupport {
    /// Part or parts; boundary is all of it.
    pub on: Names,
    /// Displacement along x [length].
    #[serde(default)]
    pub x: Option<Scalar>,
    /// Displacement along y [length].
    #[serde(default)]
    pub y: Option<Scalar>,
    /// Displacement along z [length].
    #[serde(default)]
    pub z: Option<Scalar>,
    /// Displacement along the outward normal [length].
    #[serde(default)]
    pub normal: Option<Scalar>,
    /// All components of the field in `[exact]`.
    #[serde(default)]
    pub exact: Option<bool>,
}

/// Force per volume [stress/length]; components that are not given are zero.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct SolidBodyForce {
    /// Along x.
    #[serde(default)]
    pub x: Option<Scalar>,
    /// Along y.
    #[serde(default)]
    pub y: Option<Scalar>,
    /// Along z.
    #[serde(default)]
    pub z: Option<Scalar>,
}

/// Placement of nodes. Whatever is not given follows from the geometry.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(in crate::case) struct SolidNodes {
    /// Largest node spacing [length].
    pub spacing: Option<f64>,
    /// Node spacing at crack fronts [length].
    pub front_spacing: Option<f64>,
    /// Growth of the spacing with distance from where it is smaller, 0.15 if not given.
    #[schemars(range(min = 0.02, max = 0.5))]
    pub growth: Option<f64>,
    /// Where nodes stand closer.
    #[schemars(length(max = 1000))]
    pub finer: Vec<Finer>,
    /// Whether nodes stand on crack fronts; single if not given.
    pub on_fronts: Option<NodesOnFronts>,
}

/// A region of closer nodes: one of `part`, `box`, `ball`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Finer {
    /// Node spacing there [length].
    pub spacing: f64,
    /// On a part of the boundary.
    #[serde(default)]
    pub part: Option<String>,
    /// In a box.
    #[serde(default, rename = "box")]
    pub cuboid: Option<SolidBox>,
    /// In a ball.
    #[serde(default)]
    pub ball: Option<SolidBall>,
}

/// Fracture quantities.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(in crate::case) struct SolidFracture {
    /// Points at which each front is evaluated.
    #[schemars(range(min = 1, max = 10000))]
    pub points: usize,
}

impl Default for SolidFracture {
    fn default() -> Self {
        Self { points: 16 }
    }
}
