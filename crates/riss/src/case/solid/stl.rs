//! Triangles of STL files, ASCII and binary (the `stl_io` crate).

use crate::geometry::surface::{Shape, TriangleMesh};
use crate::math::Vector3;

/// Reads the bytes of an STL file as one part named `surface`.
///
/// # Errors
/// What is wrong with them. No bytes make it panic.
pub fn read_stl(bytes: &[u8]) -> Result<TriangleMesh, String> {
    let mut reader = std::io::Cursor::new(bytes);
    let triangles = stl_io::create_stl_reader(&mut reader).map_err(|e| format!("not an STL file: {e}"))?;
    let mut mesh = TriangleMesh::default();
    let part = mesh.add_part("surface", Shape::Triangles);
    for triangle in triangles {
        let triangle = triangle.map_err(|e| format!("triangle {}: {e}", mesh.triangles.len() + 1))?;
        mesh.push(triangle.vertices.map(|v| Vector3::new(v[0].into(), v[1].into(), v[2].into())), part);
    }
    Ok(mesh)
}
