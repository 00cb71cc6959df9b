//! The boundary of a mesh that a file gives.

use super::boundary::{Boundary, Edge};
use super::report::Report;
use crate::case::gmsh::read_gmsh;
use crate::model::Domain;
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
    add_domain(boundary, &domain, KEY, report)
}

/// Adds the loops and parts of a body that a file gives.
pub(super) fn add_domain(boundary: &mut Boundary, domain: &Domain, key: &str, report: &mut Report) -> Option<()> {
    let edge = |curve| Edge { curve, parts: vec![], key: key.into() };
    let mut edges: Vec<Edge> = domain.edges.iter().copied().map(edge).collect();
    for part in &domain.parts {
        if part.name == super::OUTLINE {
            report.error(key, format!("a part of the file has the name `{}`, which is all of the outline", part.name));
            return None;
        }
        let id = boundary.part(&part.name);
        part.edges.iter().for_each(|&e| edges[e].parts.push(id));
    }
    for range in &domain.loops {
        boundary.push_loop(edges[range.clone()].to_vec());
    }
    Some(())
}
