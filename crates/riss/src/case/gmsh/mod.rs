//! Meshes of Gmsh as bodies: the boundary loops of a plane `.msh` file and the names of their parts.
//!
//! Reads versions 2.2 and 4.1, ASCII and binary [MSH formats of the Gmsh manual]; no maintained crate reads 2.2.
//! Reading order: `scanner` (tokens and numbers), `format` (sections), `msh2` and `msh4` (nodes and elements),
//! `boundary` (free edges to loops), `domain` (loops to a [`Domain`](crate::model::Domain)).

mod boundary;
mod domain;
mod format;
mod msh2;
mod msh4;
mod scanner;
mod surface;

use crate::geometry::surface::TriangleMesh;
use crate::math::Vector2;
pub(super) use boundary::build;
pub(super) use format::{RawElement, RawMesh, RawNode, Shape};
use std::collections::BTreeSet;
use std::fmt;

/// A plane mesh: its cells, and its boundary with the names of the physical groups there.
#[derive(Clone, Debug, PartialEq)]
pub struct GmshModel {
    /// Corners of cells and all points of the boundary.
    pub vertices: Vec<Vector2>,
    /// Triangles by vertex, counterclockwise.
    pub triangles: Vec<[u32; 3]>,
    /// Quadrilaterals by vertex, counterclockwise.
    pub quads: Vec<[u32; 4]>,
    /// Names of the physical line groups that touch the boundary, in the order of their tags; `physical-<tag>` where
    /// the file names none.
    pub parts: Vec<String>,
    /// Closed loops with the body to the left: first the outline (counterclockwise), then the holes (clockwise).
    ///
    /// A loop starts at its vertex of least x, then y; holes are sorted by that vertex. An edge of second order comes
    /// as two.
    pub boundary: Vec<Vec<BoundaryEdge>>,
    /// Vertices in the middle of an edge of second order.
    pub(in crate::case) midside: BTreeSet<u32>,
}

/// A straight edge of the boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryEdge {
    /// Vertex where it starts.
    pub start: u32,
    /// Vertex where it ends.
    pub end: u32,
    /// Parts that it belongs to, by index in [`GmshModel::parts`], ascending.
    pub parts: Vec<usize>,
}

/// A place in a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Line of an ASCII file, from 1.
    Line(usize),
    /// Offset in a binary file, from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(n) => write!(f, "line {n}"),
            Self::Byte(n) => write!(f, "byte {n}"),
        }
    }
}

/// A mesh file that cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GmshError {
    /// The file breaks its format, or says something that has no meaning here.
    #[error("{place}{}: {problem}", in_section(.section))]
    Content {
        /// Where.
        place: Place,
        /// Name of the section, without `$`; empty between sections.
        section: String,
        /// What is wrong.
        problem: String,
    },
    /// Not a version that can be read.
    #[error("MSH version {version}; versions 2.2 and 4.1 can be read: save with Mesh.MshFileVersion = 4.1")]
    Version {
        /// Version as the file says it.
        version: String,
    },
    /// The nodes do not share one z.
    #[error("{place}, section Nodes: the mesh is not plane: node {node} has z = {z}, others have z = {plane}")]
    NotPlane {
        /// Where the node is.
        place: Place,
        /// Tag of the node.
        node: u64,
        /// Its z.
        z: f64,
        /// The z of the first node.
        plane: f64,
    },
    /// No surface elements.
    #[error(
        "section Elements: no triangles or quadrilaterals; where physical groups exist, Gmsh saves only these: \
         add the surface to one, or save with Mesh.SaveAll = 1"
    )]
    NoSurface,
    /// Two loops, or a loop and itself, meet in a vertex.
    #[error("section Elements: the boundary of the mesh touches itself at ({}, {})", at.x, at.y)]
    TouchingBoundary {
        /// The vertex.
        at: Vector2,
    },
    /// A loop that encloses nothing.
    #[error(
        "section Elements: the mesh is cut open at ({}, {}); leave cracks out of the mesh and give them as [[crack]]",
        at.x, at.y
    )]
    CutOpen {
        /// First vertex of the loop.
        at: Vector2,
    },
    /// The mesh has several outlines.
    #[error(
        "section Elements: the mesh falls into {count} pieces, one of them at ({}, {}); one connected body is needed",
        at.x, at.y
    )]
    SeveralPieces {
        /// Number of outlines.
        count: usize,
        /// First vertex of the second outline.
        at: Vector2,
    },
}

fn in_section(section: &str) -> String {
    if section.is_empty() { String::new() } else { format!(", section {section}") }
}

/// Reads the bytes of a `.msh` file.
///
/// First- and second-order triangles and quadrilaterals make the surface, lines of physical groups name its boundary;
/// points and unused nodes are ignored.
///
/// # Errors
/// [`GmshError`] says where and what. No bytes make it panic, and none make it reserve more than a small multiple of
/// their length.
pub fn read_gmsh(bytes: &[u8]) -> Result<GmshModel, GmshError> {
    boundary::build(&format::read(bytes, format::Solids::Refused)?)
}

/// Reads the surface elements of a `.msh` file of a model in space; lines and solids are ignored.
///
/// Each physical surface group is a part.
///
/// # Errors
/// See [`read_gmsh`].
pub fn read_gmsh_surface(bytes: &[u8]) -> Result<TriangleMesh, GmshError> {
    surface::build(&format::read(bytes, format::Solids::LeftOut)?)
}
