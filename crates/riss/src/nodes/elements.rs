//! Elements between the points: the triangles, or rectangles where two of them form one.

use super::triangulation::Triangulation;
use crate::geometry::curve::Curve;
use crate::model::Domain;
use rustc_hash::FxHashMap;

/// An element by the copies at its corners, counterclockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// Three corners.
    Triangle([u32; 3]),
    /// Four corners; the sides may have any direction.
    Rectangle([u32; 4]),
}

impl Element {
    /// The copies at the corners.
    pub fn corners(&self) -> &[u32] {
        match self {
            Self::Triangle(corners) => corners,
            Self::Rectangle(corners) => corners,
        }
    }

    /// All triangles.
    pub fn triangles(triangulation: &Triangulation) -> Vec<Self> {
        triangulation.triangles.iter().map(|t| Self::Triangle(*t)).collect()
    }

    /// Rectangles of two triangles, and the triangles that are left.
    pub fn joined(triangulation: &Triangulation, domain: &Domain) -> Vec<Self> {
        let (arcs, left_of) = (arcs(triangulation, domain), left_of(triangulation));
        let mut done = vec![false; triangulation.triangles.len()];
        let mut result = vec![];
        for i in 0..triangulation.triangles.len() {
            if std::mem::replace(&mut done[i], true) {
                continue;
            }
            result.push(match rectangle_with(triangulation, &arcs, &left_of, i, &done) {
                Some((other, corners)) => {
                    done[other] = true;
                    Self::Rectangle(corners)
                }
                None => Self::Triangle(triangulation.triangles[i]),
            });
        }
        result
    }
}

/// Curved boundary pieces by the copies at their ends.
pub fn arcs(triangulation: &Triangulation, domain: &Domain) -> FxHashMap<[u32; 2], Curve> {
    let curved = triangulation.boundary.iter().filter(|s| matches!(domain.edges[s.edge], Curve::Arc { .. }));
    curved.map(|s| (s.points, domain.edges[s.edge].piece(s.range[0], s.range[1]))).collect()
}

/// The triangle to the left of each directed edge.
pub fn left_of(triangulation: &Triangulation) -> FxHashMap<[u32; 2], u32> {
    let sides = |(i, t): (usize, &[u32; 3])| {
        let t = *t;
        (0..3).map(move |k| ([t[k], t[(k + 1) % 3]], i as u32))
    };
    triangulation.triangles.iter().enumerate().flat_map(sides).collect()
}

/// The neighbor of triangle `i` with which it forms a rectangle, and the corners.
fn rectangle_with(
    triangulation: &Triangulation,
    arcs: &FxHashMap<[u32; 2], Curve>,
    left_of: &FxHashMap<[u32; 2], u32>,
    i: usize,
    done: &[bool],
) -> Option<(usize, [u32; 4])> {
    let t = triangulation.triangles[i];
    for k in 0..3 {
        let [a, b, c] = [t[k], t[(k + 1) % 3], t[(k + 2) % 3]];
        let Some(&other) = left_of.get(&[c, b]) else { continue };
        if done[other as usize] {
            continue;
        }
        let d = triangulation.triangles[other as usize].into_iter().find(|v| *v != b && *v != c)?;
        let [pa, pb, pc, pd] = [a, b, c, d].map(|v| triangulation.position(v));
        let (u, v) = (pb - pa, pc - pa);
        let small = 1e-9 * (u.norm() + v.norm());
        let is_rectangle = (pa + u + v - pd).norm() < small && u.dot(&v).abs() < small * u.norm();
        let corners = [a, b, d, c];
        let curved = (0..4).any(|k| arcs.contains_key(&[corners[k], corners[(k + 1) % 4]]));
        if is_rectangle && !curved {
            return Some((other as usize, corners));
        }
    }
    None
}
