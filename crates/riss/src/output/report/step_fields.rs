//! The fields of one step as the report holds them: thinned, in few bytes, compressed.

use super::quantize::{Channel, Scale, push_channel, push_triangles};
use super::thinning::{Mesh, N_FEATURES};
use crate::analysis::{CrackFaces, Fields};
use crate::geometry::aabb::Aabb;
use crate::math::{Vector2, principal_stresses};
use crate::output::field_picture::{scale, twice_area};
use crate::output::vtk::push_base64;
use serde::Serialize;
use std::collections::BTreeMap;

/// Most vertices of a step that stands alone in a report.
const FINE: usize = 60_000;
/// Most vertices of a step among many.
const COARSE: usize = 6_000;
/// The color scale needs no more triangles than these.
const SAMPLED_TRIANGLES: usize = 20_000;
/// Effort of compression: the report is read more often than written.
pub(super) const COMPRESSION: u8 = 7;
/// Out-of-plane stress is not stored if it follows from the others to this share of the greatest.
const SAME: f64 = 1e-9;

/// How much is left of the fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Detail {
    /// For a report of few steps.
    Fine,
    /// For a report of many steps; there is none where the fine fields are small already.
    Coarse,
}

/// Fields of a step as JSON.
#[derive(Serialize)]
struct Packed {
    step: usize,
    /// Number of vertices here, and of those in the files for ParaView.
    n_vertices: usize,
    n_computed: usize,
    n_triangles: usize,
    /// Number of points of each crack.
    n_crack_points: Vec<usize>,
    /// Out-of-plane stress over the sum of those in the plane, where that is the same everywhere.
    out_of_plane: Option<f64>,
    /// In the order of `data`: first of the vertices, then of the crack points.
    channels: Vec<Channel>,
    crack_channels: Vec<Channel>,
    /// Ends of the color scale, then least and greatest value, by quantity.
    ranges: BTreeMap<&'static str, [f64; 4]>,
    /// Base64 over zlib: planes of the channels, triangles, planes of the crack channels.
    data: String,
}

/// The fields of a step, from fine to coarse; none if there are no fields.
pub(super) fn pack(step: usize, fields: &Fields) -> Vec<(Detail, String)> {
    if fields.triangles.is_empty() {
        return vec![];
    }
    let ranges = ranges(fields);
    let features = features(fields, &ranges);
    let mut mesh = Mesh::new(&fields.positions, &features, &fields.triangles);
    let mut levels = vec![];
    for (detail, most) in [(Detail::Fine, FINE), (Detail::Coarse, COARSE)] {
        if detail == Detail::Coarse && mesh.n_vertices() <= COARSE {
            break;
        }
        mesh.thin(most);
        levels.push((detail, pack_triangles(step, fields, mesh.triangles(), &ranges)));
    }
    levels
}

fn pack_triangles(
    step: usize,
    fields: &Fields,
    triangles: Vec<[u32; 3]>,
    ranges: &BTreeMap<&'static str, [f64; 4]>,
) -> String {
    let (triangles, vertices) = in_order(&fields.positions, triangles);
    let at = |value: &dyn Fn(usize) -> f64| -> Vec<f64> { vertices.iter().map(|v| value(*v as usize)).collect() };
    let mut data = vec![];
    let mut channels = vec![];
    for (name, values, bytes) in [
        // Zooming in to a tip takes finer positions than a color takes values.
        ("x", at(&|v| fields.positions[v].x), 3),
        ("y", at(&|v| fields.positions[v].y), 3),
        ("displacement_x", at(&|v| fields.displacement[v].x), 2),
        ("displacement_y", at(&|v| fields.displacement[v].y), 2),
    ] {
        channels.push(push_channel(name, &values, Scale::Linear, bytes, &mut data));
    }
    let out_of_plane = out_of_plane_ratio(fields);
    let mut singular = vec![
        ("stress_xx", at(&|v| fields.stress[v][(0, 0)])),
        ("stress_yy", at(&|v| fields.stress[v][(1, 1)])),
        ("stress_xy", at(&|v| 0.5 * (fields.stress[v][(0, 1)] + fields.stress[v][(1, 0)]))),
        ("error_indicator", at(&|v| fields.error_indicator[v])),
    ];
    if out_of_plane.is_none() {
        singular.push(("stress_zz", at(&|v| fields.out_of_plane_stress[v])));
    }
    for (name, values) in singular {
        channels.push(push_channel(name, &values, Scale::for_singular(&values), 2, &mut data));
    }
    push_triangles(&triangles, &mut data);
    let crack_channels = push_cracks(&fields.crack_faces, &mut data);
    let mut base64 = String::new();
    push_base64(&miniz_oxide::deflate::compress_to_vec_zlib(&data, COMPRESSION), &mut base64);
    let packed = Packed {
        step,
        n_vertices: vertices.len(),
        n_computed: fields.positions.len(),
        n_triangles: triangles.len(),
        n_crack_points: fields.crack_faces.iter().map(|c| c.positions.len()).collect(),
        out_of_plane,
        channels,
        crack_channels,
        ranges: ranges.clone(),
        data: base64,
    };
    // Strings, numbers and maps with text keys cannot fail.
    serde_json::to_string(&packed).expect("fields are plain values")
}

/// Points along a crack.
type CrackPoints = fn(&CrackFaces) -> &[Vector2];

fn push_cracks(cracks: &[CrackFaces], data: &mut Vec<u8>) -> Vec<Channel> {
    let of = |points: CrackPoints, k: usize| -> Vec<f64> {
        cracks.iter().flat_map(|c| points(c).iter().map(move |p| p[k])).collect()
    };
    let sides: [([&'static str; 2], CrackPoints, u32); 3] = [
        (["x", "y"], |c| &c.positions, 3),
        (["left_x", "left_y"], |c| &c.left, 2),
        (["right_x", "right_y"], |c| &c.right, 2),
    ];
    let mut channels = vec![];
    for (names, points, bytes) in sides {
        for (k, name) in names.into_iter().enumerate() {
            channels.push(push_channel(name, &of(points, k), Scale::Linear, bytes, data));
        }
    }
    channels
}

/// Triangles along a curve that fills the plane, and the vertices in the order in which they name them, by old number.
fn in_order(positions: &[Vector2], mut triangles: Vec<[u32; 3]>) -> (Vec<[u32; 3]>, Vec<u32>) {
    let bounds = Aabb::of_points(positions.iter().copied());
    let to_grid = f64::from(u16::MAX) / bounds.size().max().max(f64::MIN_POSITIVE);
    triangles.sort_by_cached_key(|t| {
        let middle = t.iter().map(|v| positions[*v as usize] - bounds.lower).sum::<Vector2>() / 3.0;
        spread((middle.x * to_grid) as u32) | spread((middle.y * to_grid) as u32) << 1
    });
    numbered(positions.len(), triangles)
}

/// Triangles with their vertices numbered in the order in which they name them, and the old number of each.
pub(super) fn numbered(n_vertices: usize, mut triangles: Vec<[u32; 3]>) -> (Vec<[u32; 3]>, Vec<u32>) {
    let mut new = vec![u32::MAX; n_vertices];
    let mut old = vec![];
    for vertex in triangles.iter_mut().flatten() {
        let number = &mut new[*vertex as usize];
        if *number == u32::MAX {
            *number = old.len() as u32;
            old.push(*vertex);
        }
        *vertex = *number;
    }
    (triangles, old)
}

/// The lower 16 bits with a gap after each: two of them make a Morton number.
fn spread(bits: u32) -> u32 {
    [(8, 0x00ff_00ff), (4, 0x0f0f_0f0f), (2, 0x3333_3333), (1, 0x5555_5555)]
        .into_iter()
        .fold(bits & 0xffff, |b, (shift, mask)| (b | b << shift) & mask)
}

/// What thinning must keep: displacement over its range, and stress so that singular tips do not take all vertices.
fn features(fields: &Fields, ranges: &BTreeMap<&'static str, [f64; 4]>) -> Vec<[f64; N_FEATURES]> {
    let positive = |v: f64| if v > 0.0 && v.is_finite() { 1.0 / v } else { 0.0 };
    let displacement = positive(ranges["displacement"][3]);
    let stress_unit = ranges["von_mises"][1].max(f64::MIN_POSITIVE);
    let known = |v: f64| if v.is_finite() { v } else { 0.0 };
    let bounded = |s: f64| known(s / (stress_unit + s.abs()));
    (0..fields.positions.len())
        .map(|v| {
            let (u, s) = (fields.displacement[v], &fields.stress[v]);
            let [ux, uy] = [u.x, u.y].map(|c| known(c * displacement));
            [ux, uy, bounded(s[(0, 0)]), bounded(s[(1, 1)]), bounded(s[(0, 1)])]
        })
        .collect()
}

/// `0` in plane stress, Poisson's ratio in plane strain; none if the out-of-plane stress has another source.
fn out_of_plane_ratio(fields: &Fields) -> Option<f64> {
    let pairs = || fields.stress.iter().map(|s| s.trace()).zip(fields.out_of_plane_stress.iter().copied());
    let (mut product, mut square, mut greatest) = (0.0, 0.0, 0.0_f64);
    for (sum, out) in pairs().filter(|(s, o)| s.is_finite() && o.is_finite()) {
        product += sum * out;
        square += sum * sum;
        greatest = greatest.max(sum.abs()).max(out.abs());
    }
    let ratio = if square > 0.0 { product / square } else { 0.0 };
    let fits =
        |(sum, out): (f64, f64)| !(out - ratio * sum).is_finite() || (out - ratio * sum).abs() <= SAME * greatest;
    pairs().all(fits).then_some(ratio)
}

fn ranges(fields: &Fields) -> BTreeMap<&'static str, [f64; 4]> {
    let every = fields.triangles.len().div_ceil(SAMPLED_TRIANGLES).max(1);
    let sample: Vec<[u32; 3]> = fields.triangles.iter().step_by(every).copied().collect();
    let principal: Vec<_> = fields.stress.iter().map(principal_stresses).collect();
    let of_stress = |i: usize, k: usize| -> Vec<f64> { fields.stress.iter().map(|s| s[(i, k)]).collect() };
    let of_displacement = |f: fn(&Vector2) -> f64| -> Vec<f64> { fields.displacement.iter().map(f).collect() };
    let quantities: [(&'static str, Vec<f64>); 10] = [
        ("displacement", of_displacement(|u| u.norm())),
        ("displacement_x", of_displacement(|u| u.x)),
        ("displacement_y", of_displacement(|u| u.y)),
        ("stress_xx", of_stress(0, 0)),
        ("stress_yy", of_stress(1, 1)),
        ("stress_xy", of_stress(0, 1)),
        ("von_mises", fields.von_mises.clone()),
        ("max_principal_stress", principal.iter().map(|p| p.0).collect()),
        ("min_principal_stress", principal.iter().map(|p| p.1).collect()),
        ("error_indicator", fields.error_indicator.clone()),
    ];
    let range = |values: &[f64]| {
        let (low, high) = scale(&sample, values, |t| twice_area(&fields.positions, t));
        let finite = || values.iter().copied().filter(|v| v.is_finite());
        let [least, greatest] = [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)];
        [low, high, if least.is_finite() { least } else { 0.0 }, if greatest.is_finite() { greatest } else { 0.0 }]
    };
    quantities.into_iter().map(|(name, values)| (name, range(&values))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Matrix2;

    #[test]
    fn morton_numbers_interleave() {
        assert_eq!(spread(0b1011), 0b0100_0101);
        assert_eq!(spread(0xffff), 0x5555_5555);
    }

    #[test]
    fn vertices_are_numbered_as_triangles_name_them() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Vector2::new(x, y));
        let (triangles, old) = in_order(&corners, vec![[3, 1, 2], [3, 0, 1]]);
        // The lower left triangle comes first.
        assert_eq!((triangles, old), (vec![[0, 1, 2], [0, 2, 3]], vec![3, 0, 1, 2]));
    }

    #[test]
    fn out_of_plane_stress_is_found_or_kept() {
        let stress = vec![Matrix2::new(1.0, 0.2, 0.2, 3.0), Matrix2::new(-2.0, 0.0, 0.0, 0.5)];
        let with = |out: Vec<f64>| Fields { stress: stress.clone(), out_of_plane_stress: out, ..Fields::default() };
        assert_eq!(out_of_plane_ratio(&with(vec![0.0, 0.0])), Some(0.0));
        let strain = out_of_plane_ratio(&with(vec![1.2, -0.45])).unwrap();
        assert!((strain - 0.3).abs() < 1e-15);
        assert_eq!(out_of_plane_ratio(&with(vec![1.2, 0.0])), None);
    }
}
