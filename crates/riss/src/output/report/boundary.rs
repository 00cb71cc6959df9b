//! The fields on the boundary of a solid as its report holds them: in few bytes, compressed.

use super::quantize::{Channel, Scale, push_channel, push_triangles};
use super::step_fields::{COMPRESSION, numbered};
use crate::analysis::{BoundaryFields, principal_stresses};
use crate::geometry::triangle::area_vector;
use crate::output::field_picture::scale;
use crate::output::solid_files::von_mises;
use crate::output::vtk::push_base64;
use serde::Serialize;
use std::collections::BTreeMap;

/// Names of the components of a symmetric tensor.
const COMPONENTS: [(&str, [usize; 2]); 6] = [
    ("stress_xx", [0, 0]),
    ("stress_yy", [1, 1]),
    ("stress_zz", [2, 2]),
    ("stress_xy", [0, 1]),
    ("stress_yz", [1, 2]),
    ("stress_xz", [0, 2]),
];

/// Fields on a boundary as JSON.
#[derive(Serialize)]
struct Packed {
    n_vertices: usize,
    n_triangles: usize,
    /// In the order of `data`.
    channels: Vec<Channel>,
    /// Ends of the color scale by quantity.
    ranges: BTreeMap<&'static str, [f64; 2]>,
    /// Base64 over zlib: planes of the channels, then triangles.
    data: String,
}

/// The fields on a boundary.
///
/// # Errors
/// None but those of the writer of JSON.
pub(super) fn pack(fields: &BoundaryFields) -> serde_json::Result<serde_json::Value> {
    let (triangles, vertices) = numbered(fields.positions.len(), fields.triangles.clone());
    let at = |value: &dyn Fn(usize) -> f64| -> Vec<f64> { vertices.iter().map(|v| value(*v as usize)).collect() };
    let (mut data, mut channels) = (vec![], vec![]);
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        channels.push(push_channel(name, &at(&|v| fields.positions[v][k]), Scale::Linear, 3, &mut data));
    }
    let mut ranges = BTreeMap::new();
    let mut range = |name: &'static str, values: &[f64]| {
        let area = |t: &[u32; 3]| area_vector(t.map(|v| fields.positions[vertices[v as usize] as usize])).norm();
        let (low, high) = scale(&triangles, values, area);
        ranges.insert(name, [low, high]);
    };
    for (k, name) in ["displacement_x", "displacement_y", "displacement_z"].into_iter().enumerate() {
        let values = at(&|v| fields.displacements[v][k]);
        range(name, &values);
        channels.push(push_channel(name, &values, Scale::Linear, 2, &mut data));
    }
    for (name, [i, j]) in COMPONENTS {
        let values = at(&|v| 0.5 * (fields.stresses[v][(i, j)] + fields.stresses[v][(j, i)]));
        range(name, &values);
        channels.push(push_channel(name, &values, Scale::for_singular(&values), 2, &mut data));
    }
    range("displacement", &at(&|v| fields.displacements[v].norm()));
    range("von_mises", &at(&|v| von_mises(&fields.stresses[v])));
    range("max_principal_stress", &at(&|v| principal_stresses(&fields.stresses[v])[0]));
    push_triangles(&triangles, &mut data);
    let mut base64 = String::new();
    push_base64(&miniz_oxide::deflate::compress_to_vec_zlib(&data, COMPRESSION), &mut base64);
    let (n_vertices, n_triangles) = (vertices.len(), triangles.len());
    serde_json::to_value(Packed { n_vertices, n_triangles, channels, ranges, data: base64 })
}
