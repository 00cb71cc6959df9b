//! Surface triangles of a mesh in space, with the names of their physical groups.

use super::GmshError;
use super::format::{RawMesh, Shape};
use crate::geometry::surface::{Shape as SurfaceShape, TriangleMesh};
use crate::math::Vector3;
use std::collections::BTreeMap;

/// Corners of the triangles that a surface element falls into, as places in its list of nodes.
fn pieces(shape: Shape, n_nodes: usize) -> &'static [[usize; 3]] {
    match (shape, n_nodes) {
        (Shape::Triangle, 3) => &[[0, 1, 2]],
        (Shape::Triangle, _) => &[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
        (Shape::Quad, 4) => &[[0, 1, 2], [0, 2, 3]],
        (Shape::Quad, 8) => &[[0, 4, 7], [4, 1, 5], [5, 2, 6], [6, 3, 7], [4, 5, 6], [4, 6, 7]],
        (Shape::Quad, _) => &[[0, 4, 8], [0, 8, 7], [4, 1, 5], [4, 5, 8], [8, 5, 2], [8, 2, 6], [7, 8, 6], [7, 6, 3]],
        (Shape::Point | Shape::Line | Shape::Solid, _) => &[],
    }
}

/// Triangles of all surface elements; those without a physical group belong to the part `unnamed`.
pub(super) fn build(mesh: &RawMesh) -> Result<TriangleMesh, GmshError> {
    let mut found = TriangleMesh::default();
    let mut parts: BTreeMap<Option<u32>, u32> = BTreeMap::new();
    for element in &mesh.elements {
        for corners in pieces(element.shape, element.nodes.len()) {
            let group = element.groups.first().copied();
            let part = *parts.entry(group).or_insert_with(|| {
                let name = match group {
                    None => "unnamed".into(),
                    Some(tag) => mesh.surface_groups.get(&tag).cloned().unwrap_or_else(|| format!("physical-{tag}")),
                };
                found.add_part(&name, SurfaceShape::Triangles)
            });
            let mut at = [Vector3::zeros(); 3];
            for (k, corner) in corners.iter().enumerate() {
                let tag = element.nodes[*corner];
                let node = mesh.nodes.get(&tag).ok_or_else(|| GmshError::Content {
                    place: element.place,
                    section: "Elements".into(),
                    problem: format!("node {tag} is not defined"),
                })?;
                at[k] = Vector3::from(node.position);
            }
            found.push(at, part);
        }
    }
    Ok(found)
}
