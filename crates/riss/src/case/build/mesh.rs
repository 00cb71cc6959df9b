//! The boundary of a Gmsh mesh.

use super::boundary::Boundary;
use super::report::Report;
use std::path::Path;

/// Adds the loops and parts of the mesh in `path`; `None` if it has problems.
pub(super) fn add_mesh(_boundary: &mut Boundary, path: &Path, report: &mut Report) -> Option<()> {
    match crate::case::read_bytes(path, crate::case::MAX_MESH_BYTES) {
        // The reader of Gmsh files joins here.
        Ok(_) => report.error("geometry.gmsh.file", "Gmsh files cannot be read yet"),
        Err(problem) => report.error("geometry.gmsh.file", problem.message),
    };
    None
}
