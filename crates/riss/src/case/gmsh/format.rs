//! The sections of a `.msh` file, and what they hold before it is understood.

use super::scanner::{ByteOrder, Scanner, shortened};
use super::{GmshError, Place, msh2, msh4};
use std::collections::{BTreeMap, HashMap};

/// What the file says.
#[derive(Default)]
pub(in crate::case) struct RawMesh {
    /// Nodes by tag.
    pub nodes: HashMap<u64, RawNode>,
    /// Lines, triangles and quadrilaterals, in the order of the file.
    pub elements: Vec<RawElement>,
    /// Names of physical line groups, by tag.
    pub line_groups: BTreeMap<u32, String>,
    /// Names of physical surface groups, by tag.
    pub surface_groups: BTreeMap<u32, String>,
    /// Physical groups of each curve, by tag of the curve; only in version 4.1.
    pub curve_groups: HashMap<i32, Vec<u32>>,
    /// The same of each surface.
    pub entity_groups: HashMap<i32, Vec<u32>>,
    /// What becomes of elements with a volume.
    pub solids: Solids,
}

/// What becomes of elements with a volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::case) enum Solids {
    #[default]
    Refused,
    LeftOut,
}

#[derive(Clone, Copy)]
pub(in crate::case) struct RawNode {
    pub position: [f64; 3],
    pub place: Place,
}

pub(in crate::case) struct RawElement {
    pub shape: Shape,
    /// Corners, then midside nodes (that of corners 0 and 1 first), then the rest.
    pub nodes: Vec<u64>,
    /// Physical groups, for lines and surfaces.
    pub groups: Vec<u32>,
    pub place: Place,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::case) enum Shape {
    Point,
    Line,
    Triangle,
    Quad,
    Solid,
}

/// Shape and number of nodes of an element type of the format.
pub(super) fn element_type(scanner: &Scanner, solids: Solids, number: i32) -> Result<(Shape, usize), GmshError> {
    Ok(match number {
        1 => (Shape::Line, 2),
        2 => (Shape::Triangle, 3),
        3 => (Shape::Quad, 4),
        8 => (Shape::Line, 3),
        9 => (Shape::Triangle, 6),
        10 => (Shape::Quad, 9),
        15 => (Shape::Point, 1),
        16 => (Shape::Quad, 8),
        4..=7 | 11..=14 | 17..=19 if solids == Solids::LeftOut => {
            let sizes =
                [(4, 4), (5, 8), (6, 6), (7, 5), (11, 10), (12, 27), (13, 18), (14, 14), (17, 20), (18, 15), (19, 13)];
            (Shape::Solid, sizes.iter().find(|s| s.0 == number).map_or(0, |s| s.1))
        }
        4..=7 | 11..=14 | 17..=19 => {
            return Err(scanner.error(format!("element type {number} is a solid; a plane mesh is needed")));
        }
        _ => {
            return Err(scanner.error(format!(
                "element type {number} is not known; lines, triangles and quadrilaterals of first and second order are"
            )));
        }
    })
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    V2,
    V4,
}

pub(super) fn read(bytes: &[u8], solids: Solids) -> Result<RawMesh, GmshError> {
    let mut scanner = Scanner::new(bytes);
    let mut mesh = RawMesh { solids, ..RawMesh::default() };
    if scanner.token("$MeshFormat")? != "$MeshFormat" {
        return Err(scanner.error("not a Gmsh mesh: it does not begin with $MeshFormat"));
    }
    let version = read_format(&mut scanner)?;
    while let Some(token) = scanner.next_token()? {
        let name = token.strip_prefix('$').filter(|name| !name.starts_with("End")).ok_or_else(|| {
            scanner.error(format!("`{}` stands where a section such as $Nodes is due", shortened(token)))
        })?;
        scanner.section = shortened(name);
        match (name, version) {
            ("PhysicalNames", _) => read_names(&mut scanner, &mut mesh)?,
            ("Nodes", Version::V2) => msh2::read_nodes(&mut scanner, &mut mesh)?,
            ("Elements", Version::V2) => msh2::read_elements(&mut scanner, &mut mesh)?,
            ("Entities", Version::V4) => msh4::read_entities(&mut scanner, &mut mesh)?,
            ("Nodes", Version::V4) => msh4::read_nodes(&mut scanner, &mut mesh)?,
            ("Elements", Version::V4) => msh4::read_elements(&mut scanner, &mut mesh)?,
            ("PartitionedEntities", Version::V4) => {
                return Err(scanner.error("partitioned meshes cannot be read; save one without partitions"));
            }
            _ => scanner.skip_to(&format!("$End{name}"))?,
        }
        end_section(&mut scanner, name)?;
    }
    Ok(mesh)
}

fn end_section(scanner: &mut Scanner, name: &str) -> Result<(), GmshError> {
    let end = format!("$End{name}");
    let token = scanner.token(&end)?;
    if token != end {
        return Err(scanner.error(format!("`{}` stands where {end} is due", shortened(token))));
    }
    scanner.section.clear();
    Ok(())
}

fn read_format(scanner: &mut Scanner) -> Result<Version, GmshError> {
    scanner.section = "MeshFormat".into();
    let version = match scanner.token("the version")? {
        "2.2" => Version::V2,
        "4.1" => Version::V4,
        other => return Err(GmshError::Version { version: shortened(other) }),
    };
    let binary: i32 = scanner.text_number("the file type (0 or 1)")?;
    let size: i32 = scanner.text_number("the size of numbers")?;
    if size != 8 {
        return Err(scanner.error(format!("numbers of {size} bytes; 8 are needed")));
    }
    match binary {
        0 => {}
        1 => {
            scanner.order = Some(ByteOrder::Little);
            scanner.begin_binary()?;
            match i32::from_le_bytes(scanner.raw("the byte order")?) {
                1 => {}
                0x0100_0000 => scanner.order = Some(ByteOrder::Big),
                other => return Err(scanner.error(format!("{other} stands where 1 shows the byte order"))),
            }
        }
        other => return Err(scanner.error(format!("file type {other}; 0 (ASCII) or 1 (binary) is due"))),
    }
    end_section(scanner, "MeshFormat")?;
    Ok(version)
}

/// Text in binary files too.
fn read_names(scanner: &mut Scanner, mesh: &mut RawMesh) -> Result<(), GmshError> {
    let count: u64 = scanner.text_number("the number of names")?;
    for _ in 0..count {
        let dimension: i32 = scanner.text_number("a dimension")?;
        let tag: i32 = scanner.text_number("a group tag")?;
        let text = scanner.rest_of_line()?;
        let name = text.strip_prefix('"').and_then(|t| t.strip_suffix('"'));
        let name = name.ok_or_else(|| scanner.error(format!("the name of group {tag} is not in quotes")))?;
        if dimension == 1 {
            mesh.line_groups.insert(tag.unsigned_abs(), name.into());
        }
        if dimension == 2 {
            mesh.surface_groups.insert(tag.unsigned_abs(), name.into());
        }
    }
    Ok(())
}

/// Adds a node; each tag may come once.
pub(super) fn push_node(
    scanner: &Scanner,
    mesh: &mut RawMesh,
    tag: u64,
    place: Place,
    position: [f64; 3],
) -> Result<(), GmshError> {
    match mesh.nodes.insert(tag, RawNode { position, place }) {
        None => Ok(()),
        Some(_) => Err(scanner.error_at(place, format!("node {tag} is there twice"))),
    }
}
