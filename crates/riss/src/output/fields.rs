//! Files for ParaView: the body, both faces of the cracks, nodes and integration points.
//!
//! Warping by `displacement` deforms the body and opens the cracks in both.

use super::OutputOptions;
use super::vtk::{Array, CellType, Cells, grid};
use crate::analysis::{CrackFaces, Fields, NodeRecord, StaticResult};
use crate::math::{Matrix2, Vector2, principal_stresses, turn_left};
use std::io;

/// A file of one step.
pub struct StepFile {
    /// What it shows; files of one kind make a collection.
    pub kind: &'static str,
    /// Its name, with the step.
    pub name: String,
    /// What is in it.
    pub content: Vec<u8>,
}

/// The files of one step.
///
/// # Errors
/// `InvalidData` if the arrays of the fields do not fit together.
pub fn step_files(result: &StaticResult, options: &OutputOptions) -> io::Result<Vec<StepFile>> {
    let mut grids = vec![];
    // A step that could not be solved has none.
    if options.fields && result.n_nodes > 0 {
        check(&result.fields)?;
        grids.push(("fields", body(&result.fields)));
        if !result.fields.crack_faces.is_empty() {
            grids.push(("cracks", cracks(&result.fields.crack_faces)));
        }
    }
    if options.nodes {
        grids.push(("nodes", nodes(&result.nodes)));
    }
    if options.integration_points {
        grids.push(("integration_points", integration_points(&result.integration_points)));
    }
    let file = |(kind, content)| StepFile { kind, name: step_file_name(kind, result.step.step), content };
    Ok(grids.into_iter().map(file).collect())
}

/// Kinds of files that a step may have.
pub const STEP_FILE_KINDS: [&str; 4] = ["fields", "cracks", "nodes", "integration_points"];

/// Name of a file of a step.
pub fn step_file_name(kind: &str, step: usize) -> String {
    format!("{kind}_{step:04}.vtu")
}

pub(super) fn check(fields: &Fields) -> io::Result<()> {
    let n = fields.positions.len();
    for (name, length) in [
        ("displacement", fields.displacement.len()),
        ("stress", fields.stress.len()),
        ("strain", fields.strain.len()),
        ("out_of_plane_stress", fields.out_of_plane_stress.len()),
        ("out_of_plane_strain", fields.out_of_plane_strain.len()),
        ("von_mises", fields.von_mises.len()),
        ("error_indicator", fields.error_indicator.len()),
    ] {
        if length != n {
            return Err(invalid(format!("the field {name} has {length} values for {n} positions")));
        }
    }
    if fields.triangles.iter().flatten().any(|&v| v as usize >= n) {
        return Err(invalid(format!("a triangle names a vertex beyond the {n} positions")));
    }
    for (k, faces) in fields.crack_faces.iter().enumerate() {
        if faces.left.len() != faces.positions.len() || faces.right.len() != faces.positions.len() {
            return Err(invalid(format!("the faces of crack {k} have not as many displacements as positions")));
        }
    }
    Ok(())
}

fn invalid(message: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, message)
}

fn body(fields: &Fields) -> Vec<u8> {
    let cells = Cells {
        cell_type: CellType::Triangle,
        points: fields.triangles.concat(),
        sizes: vec![3; fields.triangles.len()],
    };
    let with_normal = |tensors: &[Matrix2], normal: &[f64]| -> Vec<(Matrix2, f64)> {
        tensors.iter().copied().zip(normal.iter().copied()).collect()
    };
    let principal: Vec<_> = fields.stress.iter().map(principal_stresses).collect();
    let arrays = [
        Array::vectors("displacement", fields.displacement.iter().copied()),
        Array::tensors("stress", with_normal(&fields.stress, &fields.out_of_plane_stress)),
        Array::tensors("strain", with_normal(&fields.strain, &fields.out_of_plane_strain)),
        Array::scalars("von_mises", fields.von_mises.iter().copied()),
        Array::scalars("max_principal_stress", principal.iter().map(|p| p.0)),
        Array::scalars("min_principal_stress", principal.iter().map(|p| p.1)),
        Array::vectors("max_principal_direction", principal.iter().map(|p| p.2)),
        Array::scalars("error_indicator", fields.error_indicator.iter().copied()),
    ];
    grid(&fields.positions, &cells, &arrays, &[])
}

/// All left faces, then all right ones, segment by segment.
fn cracks(cracks: &[CrackFaces]) -> Vec<u8> {
    let positions: Vec<Vector2> = cracks.iter().flat_map(|c| c.positions.iter().copied()).collect();
    let jump: Vec<Vector2> = cracks.iter().flat_map(|c| c.left.iter().zip(&c.right)).map(|(l, r)| l - r).collect();
    let normal_opening: Vec<f64> = cracks.iter().flat_map(left_normals).zip(&jump).map(|(n, j)| n.dot(j)).collect();
    let mut cells = Cells { cell_type: CellType::Line, points: vec![], sizes: vec![] };
    let (mut crack_of_cell, mut face_of_cell) = (vec![], vec![]);
    let mut first = 0;
    // 1 to the left of the path, -1 to the right.
    for face in [1, -1] {
        for (k, crack) in cracks.iter().enumerate() {
            let n = crack.positions.len() as u32;
            for p in first..(first + n).saturating_sub(1) {
                cells.points.extend([p, p + 1]);
                cells.sizes.push(2);
                crack_of_cell.push(k as i64);
                face_of_cell.push(face);
            }
            first += n;
        }
    }
    let traction = |c: &CrackFaces| -> Vec<f64> {
        (0..c.positions.len()).map(|k| c.traction.get(k).copied().unwrap_or(0.0)).collect()
    };
    let tractions: Vec<f64> = cracks.iter().flat_map(traction).collect();
    let faces = |face: fn(&CrackFaces) -> &[Vector2]| cracks.iter().flat_map(move |c| face(c).iter().copied());
    grid(
        &twice(&positions),
        &cells,
        &[
            Array::vectors("displacement", faces(|c| &c.left).chain(faces(|c| &c.right))),
            Array::vectors("opening", twice(&jump)),
            Array::scalars("normal_opening", twice(&normal_opening)),
            Array::scalars("cohesive_traction", twice(&tractions)),
        ],
        &[Array::integers("crack", crack_of_cell), Array::integers("face", face_of_cell)],
    )
}

fn twice<T: Copy>(items: &[T]) -> Vec<T> {
    [items, items].concat()
}

/// Unit normals to the left at the vertices of a path, the mean of both sides at kinks.
fn left_normals(crack: &CrackFaces) -> Vec<Vector2> {
    let p = &crack.positions;
    let last = p.len().saturating_sub(1);
    (0..p.len())
        .map(|k| {
            let unit = |a: usize, b: usize| (p[b] - p[a]).try_normalize(0.0).unwrap_or_default();
            let ahead = unit(k, (k + 1).min(last)) + unit(k.saturating_sub(1), k);
            turn_left(ahead).try_normalize(0.0).unwrap_or_default()
        })
        .collect()
}

fn vertices(n: usize) -> Cells {
    Cells { cell_type: CellType::Vertex, points: (0..n as u32).collect(), sizes: vec![1; n] }
}

fn nodes(nodes: &[NodeRecord]) -> Vec<u8> {
    let positions: Vec<Vector2> = nodes.iter().map(|n| n.position).collect();
    let arrays = [
        Array::scalars("support_radius", nodes.iter().map(|n| n.support_radius)),
        Array::vectors("parameters", nodes.iter().map(|n| n.parameters)),
    ];
    grid(&positions, &vertices(nodes.len()), &arrays, &[])
}

fn integration_points(points: &[(Vector2, f64)]) -> Vec<u8> {
    let positions: Vec<Vector2> = points.iter().map(|p| p.0).collect();
    let weights = Array::scalars("integration_weight", points.iter().map(|p| p.1));
    grid(&positions, &vertices(points.len()), &[weights], &[])
}
