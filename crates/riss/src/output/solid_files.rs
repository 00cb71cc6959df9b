//! Files of a solid: its nodes with their fields, its cracks with their opening, its results.

use super::report::REPORT_FILE;
use super::report::solid_scene::{Scenes, clear_scenes, write_scene};
use super::results::Results;
use super::solid_report::solid_report;
use super::solid_results::SolidResults;
use super::vtk::{Array, CellType, Cells, collection, spatial_grid};
use super::whole_file::{write_all, write_whole};
use super::{RESULTS_FILE, RunInfo};
use crate::analysis::{BoundaryFields, SolidResult, principal_stresses};
use crate::math::{Matrix, Vector3};
use crate::model::SolidModel;
use crate::nodes::cloud::{Cloud, Place, SurfaceId};
use std::io;
use std::path::{Path, PathBuf};

/// Name of the method of solids.
const COLLOCATION: &str = "collocation";

/// Writes the nodes alone, for ParaView; returns the path.
///
/// # Errors
/// What the system says.
pub fn write_solid_cloud(dir: &Path, cloud: &Cloud<3>) -> io::Result<PathBuf> {
    let path = dir.join("nodes.vtu");
    write_whole(&path, &spatial_grid(&cloud.positions, &vertices(cloud.len()), &places(cloud), &[]))?;
    Ok(path)
}

/// Writes all files of a run into `dir`; returns their paths, `results.json` last.
///
/// # Errors
/// What the system says.
pub fn write_solid_results(
    dir: &Path,
    model: &SolidModel,
    info: &RunInfo,
    result: &SolidResult,
) -> io::Result<Vec<PathBuf>> {
    std::fs::create_dir_all(dir)?;
    match std::fs::remove_file(dir.join(RESULTS_FILE)) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(e),
        _ => {}
    }
    let mut files = vec![("nodes-0000.vtu".to_string(), nodes(result))];
    files.push(("nodes.pvd".into(), collection(&[(0, "nodes-0000.vtu".into())])));
    files.push(("boundary-0000.vtu".into(), boundary(result)));
    files.push(("boundary.pvd".into(), collection(&[(0, "boundary-0000.vtu".into())])));
    if !model.cracks.is_empty() {
        files.push(("cracks-0000.vtu".into(), cracks(result)));
        files.push(("cracks.pvd".into(), collection(&[(0, "cracks-0000.vtu".into())])));
    }
    clear_scenes(dir, 0)?;
    let scenes = write_scene(dir, 0, model, result)?;
    let names = files.iter().map(|f| f.0.clone()).chain(scenes).chain([REPORT_FILE.into()]).collect();
    let results = SolidResults::new(model, info, result, names);
    files.push((REPORT_FILE.into(), solid_report(&results, &Scenes::read(dir)?).into_bytes()));
    let mut text = serde_json::to_string_pretty(&results)?;
    text.push('\n');
    files.push((RESULTS_FILE.into(), text.into_bytes()));
    write_all(dir, &files)
}

/// The results in a folder, if they are those of a solid.
pub fn read_solid_results(dir: &Path) -> Option<SolidResults> {
    serde_json::from_str(&std::fs::read_to_string(dir.join(RESULTS_FILE)).ok()?).ok()
}

/// The results of a run of any method.
#[derive(Clone, Debug)]
pub enum AnyResults {
    /// Of a body in the plane.
    Plane(Box<Results>),
    /// Of a solid.
    Solid(Box<SolidResults>),
}

/// The results in a folder, whichever they are.
///
/// # Errors
/// What the system says; `InvalidData` if the file is none of ours.
pub fn read_any_results(dir: &Path) -> io::Result<AnyResults> {
    let text = std::fs::read_to_string(dir.join(RESULTS_FILE))?;
    let value: serde_json::Value = serde_json::from_str(&text)?;
    Ok(match value["method"].as_str() {
        Some(COLLOCATION) => AnyResults::Solid(Box::new(serde_json::from_value(value)?)),
        Some(_) | None => AnyResults::Plane(Box::new(serde_json::from_value(value)?)),
    })
}

fn vertices(n: usize) -> Cells {
    Cells { cell_type: CellType::Vertex, points: (0..n as u32).collect(), sizes: vec![1; n] }
}

/// What nodes stand on: 0 inside, 1 on the boundary, 2 on its edges and corners, 3 on a crack face, 4 on a front; and
/// their spacing.
fn places(cloud: &Cloud<3>) -> Vec<Array> {
    let is_face = |id: SurfaceId| matches!(id, SurfaceId::Face { .. });
    let kind = |place: &Place<3>| match place {
        Place::Inside => 0,
        Place::Surface(facets) if facets.iter().any(|f| is_face(f.surface)) => 3,
        Place::Surface(facets) if facets.len() > 1 => 2,
        Place::Surface(_) => 1,
        Place::Front { .. } => 4,
    };
    let normal = |place: &Place<3>| match place {
        Place::Inside => Default::default(),
        Place::Surface(facets) | Place::Front { facets, .. } => {
            facets.first().map_or_else(Default::default, |f| f.normal)
        }
    };
    vec![
        Array::integers("kind", cloud.places.iter().map(kind)),
        Array::scalars("spacing", cloud.spacings.iter().copied()),
        Array::spatial_vectors("normal", cloud.places.iter().map(normal)),
    ]
}

pub(super) fn nodes(result: &SolidResult) -> Vec<u8> {
    let mut arrays = places(&result.cloud);
    push_fields(&mut arrays, &result.displacements, &result.stresses);
    spatial_grid(&result.cloud.positions, &vertices(result.n_nodes), &arrays, &[])
}

/// The boundary of the body in triangles, with the fields there.
pub(super) fn boundary(result: &SolidResult) -> Vec<u8> {
    let BoundaryFields { positions, triangles, displacements, stresses } = &result.boundary;
    let points = triangles.iter().flatten().copied().collect();
    let cells = Cells { cell_type: CellType::Triangle, points, sizes: vec![3; triangles.len()] };
    let mut arrays = vec![];
    push_fields(&mut arrays, displacements, stresses);
    spatial_grid(positions, &cells, &arrays, &[])
}

fn push_fields(arrays: &mut Vec<Array>, displacements: &[Vector3], stresses: &[Matrix<3>]) {
    arrays.push(Array::spatial_vectors("displacement", displacements.iter().copied()));
    arrays.push(Array::spatial_tensors("stress", stresses.iter().copied()));
    arrays.push(Array::triples("principal stress", &["1", "2", "3"], stresses.iter().map(principal_stresses)));
    arrays.push(Array::scalars("von Mises stress", stresses.iter().map(von_mises)));
}

/// Equivalent stress [stress].
pub(super) fn von_mises(stress: &Matrix<3>) -> f64 {
    let deviator = stress - Matrix::from_diagonal_element(stress.trace() / 3.0);
    (1.5 * deviator.norm_squared()).sqrt()
}

pub(super) fn cracks(result: &SolidResult) -> Vec<u8> {
    cracks_with(result, None)
}

/// The cracks with the tractions between their faces, if there are some.
pub(super) fn cracks_with(result: &SolidResult, tractions: Option<&[Vec<f64>]>) -> Vec<u8> {
    let (mut positions, mut openings, mut gaps) = (vec![], vec![], vec![]);
    let mut cells = Cells { cell_type: CellType::Triangle, points: vec![], sizes: vec![] };
    let mut index = vec![];
    for (crack, opened) in result.opened_cracks.iter().enumerate() {
        let first = positions.len() as u32;
        positions.extend(&opened.positions);
        openings.extend(&opened.openings);
        gaps.extend(&opened.gaps);
        for t in &opened.triangles {
            cells.points.extend(t.map(|k| k + first));
            cells.sizes.push(3);
            index.push(crack as i64);
        }
    }
    let mut arrays = vec![Array::spatial_vectors("opening", openings), Array::scalars("normal opening", gaps)];
    arrays.extend(tractions.map(|t| Array::scalars("cohesive traction", t.iter().flatten().copied())));
    spatial_grid(&positions, &cells, &arrays, &[Array::integers("crack", index)])
}
