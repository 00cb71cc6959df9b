//! Outline, holes, parts and cracks.

use super::{Point, Scalar};
use schemars::JsonSchema;
use serde::Deserialize;

/// Outline of the body, one of these.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(in crate::case) enum Geometry {
    /// Parts left, right, bottom, top.
    Rectangle(Rectangle),
    /// Part edge.
    Disk(Disk),
    /// Straight edges.
    Polygon(Polygon),
    /// Straight and circular edges.
    Outline(Outline),
    /// Boundary of a Gmsh mesh; parts are its physical curves.
    Gmsh(MeshFile),
    /// Boundary of an input file of Abaqus or CalculiX; parts are its surfaces and sets. Its material, supports and loads
    /// hold unless the case names its own.
    Abaqus(MeshFile),
}

/// An axis-aligned rectangle.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Rectangle {
    /// Lower left corner [length].
    pub lower: Point,
    /// Upper right corner [length].
    pub upper: Point,
}

/// A disk or circle.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Disk {
    /// Center [length].
    pub center: Point,
    /// Radius [length], positive.
    pub radius: f64,
}

/// A polygon in either direction.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Polygon {
    /// Corners in order, at least 3 [length].
    pub corners: Vec<Point>,
    /// Name of the edge that leaves each corner; edge-1, edge-2, ... if not given.
    #[serde(default)]
    pub parts: Option<Vec<String>>,
}

/// A closed chain of edges in either direction.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Outline {
    /// Where the first edge begins [length].
    pub start: Point,
    /// Edges in order; a straight one closes the chain if the last does not end at `start`.
    pub edges: Vec<OutlineEdge>,
}

/// Straight, or an arc if `through` or `center` is given.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct OutlineEdge {
    /// End point [length].
    pub to: Point,
    /// A point on the arc between its ends [length].
    #[serde(default)]
    pub through: Option<Point>,
    /// Center of the arc [length]; needs `turn`.
    #[serde(default)]
    pub center: Option<Point>,
    /// Which way the arc turns around `center`.
    #[serde(default)]
    pub turn: Option<Turn>,
    /// Name; edge-1, edge-2, ... if not given. Edges may share a name.
    #[serde(default)]
    pub part: Option<String>,
}

/// Which way an arc turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(in crate::case) enum Turn {
    /// Counterclockwise.
    Left,
    /// Clockwise.
    Right,
}

/// A file beside the case.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct MeshFile {
    /// Path, relative to the case file.
    pub file: String,
}

/// A hole: one of `circle`, `polygon`, `outline`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Hole {
    /// Name of its edge as a part; hole-1, hole-2, ... if not given.
    #[serde(default)]
    pub name: Option<String>,
    /// A circle.
    #[serde(default)]
    pub circle: Option<Disk>,
    /// Corners of a polygon [length].
    #[serde(default)]
    pub polygon: Option<Vec<Point>>,
    /// Straight and circular edges.
    #[serde(default)]
    pub outline: Option<Outline>,
}

/// A stretch of a part, counterclockwise from `from` to `to` if the part is a whole outline or hole, else between them.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Part {
    /// Name of the stretch.
    pub name: String,
    /// The part it lies on.
    pub on: String,
    /// One end, on that part [length].
    pub from: Point,
    /// The other end, on that part [length].
    pub to: Point,
}

/// A crack: `path` or `arc`. Ends on the boundary are mouths, ends on other cracks junctions, others tips.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Crack {
    /// Name in the results; crack-1, crack-2, ... if not given.
    #[serde(default)]
    pub name: Option<String>,
    /// Points in order, at least 2 [length].
    #[serde(default)]
    pub path: Option<Vec<Point>>,
    /// A circular arc.
    #[serde(default)]
    pub arc: Option<CrackArc>,
    /// Pressure on both faces [stress]; positive pushes them apart. In expressions nx and ny are zero.
    #[serde(default)]
    pub pressure: Option<Scalar>,
    /// Whether the crack obeys [material.cohesive]: it is tied until it reaches its strength.
    #[serde(default)]
    pub cohesive: bool,
    /// Boxes in which a cohesive crack is open and free from the beginning.
    #[serde(default)]
    pub notch: Vec<Rectangle>,
}

/// A circular crack, turned into a polyline.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct CrackArc {
    /// One end [length].
    pub start: Point,
    /// A point between the ends [length].
    pub through: Point,
    /// The other end [length].
    pub end: Point,
    /// Longest segment of the polyline [length]; segments turn by 2 degrees at most in any case.
    #[serde(default)]
    pub spacing: Option<f64>,
}
