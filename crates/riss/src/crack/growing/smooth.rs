//! The crack with smooth fronts, for nodes and fields near them: at corners of a front they would see a kink that only
//! the length of its edges makes.

use super::clip::split_edges;
use super::{GrowingCrack, GrowingFront};
use crate::math::Vector3;
use std::collections::BTreeMap;

/// Largest turn between neighboring pieces of a smooth front [rad].
const TURN: f64 = 0.025;
/// Most pieces of an edge.
const MOST: usize = 24;
/// Only tangents within this cosine of an edge bend it.
const ALONG: f64 = 0.7;

/// Point of the cubic between two points with directions, at a share of it; the bend off the straight line.
pub(super) fn bend(chord: Vector3, tangents: [Vector3; 2], share: f64) -> Vector3 {
    let length = chord.norm();
    let is_along = tangents.iter().all(|t| t.dot(&chord) > ALONG * length);
    if !is_along {
        return Vector3::zeros();
    }
    let [from, to] = tangents.map(|t| t * length - chord);
    from * (share * (1.0 - share).powi(2)) - to * (share * share * (1.0 - share))
}

/// Vertices and triangles with edges of fronts replaced by arcs along their tangents.
pub(super) fn smoothed(crack: &GrowingCrack) -> (Vec<Vector3>, Vec<[u32; 3]>) {
    let (mut vertices, mut triangles) = (crack.vertices.clone(), crack.triangles.clone());
    let mut on_edges: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for GrowingFront { vertices: ids, line } in &crack.fronts {
        let n = ids.len();
        for k in 0..n - usize::from(!line.is_closed) {
            let next = (k + 1) % n;
            let (p, q) = (&line.points[k], &line.points[next]);
            let turn = p.tangent.cross(&q.tangent).norm().atan2(p.tangent.dot(&q.tangent));
            let pieces = ((turn / TURN).ceil() as usize).clamp(1, MOST);
            let chord = q.position - p.position;
            let mut points = vec![];
            for j in 1..pieces {
                let share = j as f64 / pieces as f64;
                points.push(vertices.len() as u32);
                vertices.push(p.position + chord * share + bend(chord, [p.tangent, q.tangent], share));
            }
            if ids[k] > ids[next] {
                points.reverse();
            }
            on_edges.insert([ids[k].min(ids[next]), ids[k].max(ids[next])], points);
        }
    }
    split_edges(&mut triangles, &on_edges);
    (vertices, triangles)
}
