//! The boundary of a mesh that a file gives.

use super::boundary::{Boundary, Edge};
use super::report::Report;
use crate::case::files::Files;
use crate::case::gmsh::read_gmsh;
use crate::model::Domain;

/// Key that all edges of a mesh come from.
const KEY: &str = "geometry.gmsh.file";

/// Adds the loops and parts of the mesh in file `name`; `None` if it has problems.
pub(super) fn add_mesh(boundary: &mut Boundary, name: &str, files: &Files, report: &mut Report) -> Option<()> {
    let bytes = report.known(KEY, files.bytes(name))?;
    let domain = match read_gmsh(&bytes).and_then(|mesh| mesh.into_domain()) {
        Ok(domain) => domain,
        Err(e) => {
            report.error(KEY, e.to_string());
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
