//! The boundary of a Gmsh mesh.

use super::boundary::{Boundary, Edge};
use super::report::Report;
use crate::case::gmsh::read_gmsh;
use std::path::Path;

/// Key that all edges of a mesh come from.
const KEY: &str = "geometry.gmsh.file";

/// Adds the loops and parts of the mesh in `path`; `None` if it has problems.
pub(super) fn add_mesh(boundary: &mut Boundary, path: &Path, report: &mut Report) -> Option<()> {
    let domain = crate::case::read_bytes(path, crate::case::MAX_MESH_BYTES)
        .map_err(|problem| problem.message)
        .and_then(|bytes| read_gmsh(&bytes).and_then(|mesh| mesh.into_domain()).map_err(|e| e.to_string()));
    let domain = match domain {
        Ok(domain) => domain,
        Err(message) => {
            report.error(KEY, message);
            return None;
        }
    };
    let edge = |curve| Edge { curve, parts: vec![], key: KEY.into() };
    let mut edges: Vec<Edge> = domain.edges.iter().copied().map(edge).collect();
    for part in &domain.parts {
        if part.name == super::OUTLINE {
            report.error(KEY, format!("a physical group has the name `{}`, which is all of the outline", part.name));
            return None;
        }
        let id = boundary.part(&part.name);
        part.edges.iter().for_each(|&e| edges[e].parts.push(id));
    }
    for range in domain.loops {
        boundary.push_loop(edges[range].to_vec());
    }
    Some(())
}
