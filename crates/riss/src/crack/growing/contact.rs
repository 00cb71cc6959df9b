//! New triangles that run into others of the same crack.

use crate::geometry::aabb::Aabb;
use crate::geometry::tree::BoxTree;
use crate::geometry::triangle::{Triangle, bounds, closest, crossing};
use crate::math::Vector3;
use std::collections::BTreeSet;

/// The middle of a triangle nearer to another than this share of the size of the crack lies on it.
const ON: f64 = 1e-8;

/// Where triangles from `first` on cross or cover others, or share an edge with two of them or the wrong way.
pub(super) fn contacts(vertices: &[Vector3], triangles: &[[u32; 3]], first: usize) -> Vec<Vector3> {
    let corners = |t: usize| -> Triangle { triangles[t].map(|v| vertices[v as usize]) };
    let middle = |t: usize| corners(t).iter().sum::<Vector3>() / 3.0;
    let boxes: Vec<Aabb<3>> = (0..triangles.len()).map(|t| bounds(corners(t))).collect();
    let size = boxes.iter().fold(Aabb::empty(), |b, t| b.union(*t)).size().norm();
    let tree = BoxTree::new(&boxes);
    let mut found = vec![];
    for t in first..triangles.len() {
        tree.visit(&boxes[t], |other| {
            let o = other as usize;
            if o == t || (o > t && o >= first) {
                return;
            }
            let is_neighbor = triangles[o].iter().any(|v| triangles[t].contains(v));
            let is_on = |a: usize, b: usize| (closest(corners(a), middle(b)).0 - middle(b)).norm() <= ON * size;
            if is_on(t, o) || is_on(o, t) || (!is_neighbor && crossing(corners(t), corners(o)).is_some()) {
                found.push(middle(t));
            }
        });
    }
    let mut edges = BTreeSet::new();
    for t in triangles {
        for k in 0..3 {
            let edge = [t[k], t[(k + 1) % 3]];
            if !edges.insert(edge) {
                found.push((vertices[edge[0] as usize] + vertices[edge[1] as usize]) * 0.5);
            }
        }
    }
    found
}
