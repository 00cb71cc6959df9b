//! Cuts off what of new triangles lies outside a body.

use crate::geometry::surface::Surface;
use crate::geometry::surface::makers::across;
use crate::geometry::surface::mesh::weld;
use crate::geometry::triangle::{area_vector, bounds, crossing};
use crate::math::Vector3;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation as _};
use std::collections::{BTreeMap, BTreeSet};

/// Points nearer than this share of the body's size are one.
const SAME: f64 = 5e-10;

/// What is left.
pub(super) struct Clipped {
    pub triangles: Vec<[u32; 3]>,
    /// New vertices on edges, in order from the lower index of the edge to the higher.
    pub on_edges: BTreeMap<[u32; 2], Vec<u32>>,
}

struct Vertex {
    at: Point2<f64>,
    index: u32,
}

impl HasPosition for Vertex {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        self.at
    }
}

fn key(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Splits triangles along the boundary of the body and keeps the pieces inside; new vertices are appended.
pub(super) fn clip(vertices: &mut Vec<Vector3>, triangles: &[[u32; 3]], body: &Surface) -> Clipped {
    let tolerance = SAME * body.bounds().size().norm();
    let (mut ends, mut owners) = (vec![], vec![]);
    for (t, corners) in triangles.iter().enumerate() {
        let corners = corners.map(|v| vertices[v as usize]);
        body.tree().visit(&bounds(corners), |b| {
            if let Some(found) = crossing(corners, body.corners(b)) {
                ends.extend(found);
                owners.push(t);
            }
        });
    }
    let ids = numbered(vertices, &ends, tolerance);
    let mut segments: Vec<BTreeSet<[u32; 2]>> = vec![BTreeSet::new(); triangles.len()];
    for (pair, owner) in ids.chunks_exact(2).zip(owners) {
        segments[owner].insert(key(pair[0], pair[1]));
    }
    let on_edges = edge_points(vertices, triangles, &segments, tolerance);
    let mut kept = vec![];
    for (corners, segments) in triangles.iter().zip(&segments) {
        for piece in pieces(vertices, *corners, segments, &on_edges) {
            let [a, b, c] = piece.map(|v| vertices[v as usize]);
            if body.contains((a + b + c) / 3.0) {
                kept.push(piece);
            }
        }
    }
    Clipped { triangles: kept, on_edges }
}

/// Indices of points, those that are new appended to the vertices.
fn numbered(vertices: &mut Vec<Vector3>, points: &[Vector3], tolerance: f64) -> Vec<u32> {
    let n = vertices.len();
    let all: Vec<Vector3> = vertices.iter().chain(points).copied().collect();
    let (kept, index) = weld(&all, tolerance);
    let mut id = vec![u32::MAX; kept.len()];
    for (j, k) in index.iter().enumerate() {
        if id[*k as usize] == u32::MAX {
            id[*k as usize] = if j < n { j as u32 } else { vertices.len() as u32 };
            if j >= n {
                vertices.push(kept[*k as usize]);
            }
        }
    }
    index[n..].iter().map(|k| id[*k as usize]).collect()
}

/// Points of the segments that lie on edges: triangles on both sides of an edge get the same.
fn edge_points(
    vertices: &[Vector3],
    triangles: &[[u32; 3]],
    segments: &[BTreeSet<[u32; 2]>],
    tolerance: f64,
) -> BTreeMap<[u32; 2], Vec<u32>> {
    let mut found: BTreeMap<[u32; 2], BTreeSet<u32>> = BTreeMap::new();
    for (corners, segments) in triangles.iter().zip(segments) {
        for p in segments.iter().flatten().filter(|p| !corners.contains(p)) {
            for k in 0..3 {
                let edge = key(corners[k], corners[(k + 1) % 3]);
                let [a, b, at] = [edge[0], edge[1], *p].map(|v| vertices[v as usize]);
                let e = b - a;
                let share = (at - a).dot(&e) / e.norm_squared();
                if (0.0..=1.0).contains(&share) && (a + e * share - at).norm() <= tolerance {
                    found.entry(edge).or_default().insert(*p);
                }
            }
        }
    }
    let ordered = |(edge, points): ([u32; 2], BTreeSet<u32>)| {
        let from = vertices[edge[0] as usize];
        let mut points: Vec<u32> = points.into_iter().collect();
        points.sort_by(|p, q| {
            let distance = |v: u32| (vertices[v as usize] - from).norm();
            distance(*p).total_cmp(&distance(*q))
        });
        (edge, points)
    };
    found.into_iter().map(ordered).collect()
}

/// A triangle in pieces along segments.
fn pieces(
    vertices: &[Vector3],
    corners: [u32; 3],
    segments: &BTreeSet<[u32; 2]>,
    on_edges: &BTreeMap<[u32; 2], Vec<u32>>,
) -> Vec<[u32; 3]> {
    let sides: [Vec<u32>; 3] = [0, 1, 2].map(|k| {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let between = on_edges.get(&key(a, b)).into_iter().flatten().copied();
        [a, b].into_iter().chain(between).collect()
    });
    let points: BTreeSet<u32> = sides.iter().flatten().chain(segments.iter().flatten()).copied().collect();
    let [a, b, c] = corners.map(|v| vertices[v as usize]);
    let Some(normal) = area_vector([a, b, c]).try_normalize(0.0) else { return vec![] };
    if points.len() == 3 {
        return vec![corners];
    }
    let [x, y] = across(normal);
    let mut plane = ConstrainedDelaunayTriangulation::<Vertex>::new();
    let mut handles = BTreeMap::new();
    for index in &points {
        let p = vertices[*index as usize] - a;
        if let Ok(handle) = plane.insert(Vertex { at: Point2::new(p.dot(&x), p.dot(&y)), index: *index }) {
            handles.insert(*index, handle);
        }
    }
    for [p, q] in segments {
        if let (Some(p), Some(q)) = (handles.get(p), handles.get(q))
            && p != q
            && plane.can_add_constraint(*p, *q)
        {
            plane.add_constraint(*p, *q);
        }
    }
    let is_flat = |t: &[u32; 3]| sides.iter().any(|s| t.iter().all(|v| s.contains(v)));
    plane.inner_faces().map(|f| f.vertices().map(|v| v.data().index)).filter(|t| !is_flat(t)).collect()
}

/// Splits triangles at vertices on their edges.
pub(super) fn split_edges(triangles: &mut Vec<[u32; 3]>, on_edges: &BTreeMap<[u32; 2], Vec<u32>>) {
    let mut t = 0;
    while t < triangles.len() {
        let corners = triangles[t];
        let found = (0..3).find_map(|k| {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let points = on_edges.get(&key(a, b)).filter(|p| !p.is_empty())?;
            let inner: Vec<u32> = if a < b { points.clone() } else { points.iter().rev().copied().collect() };
            Some((k, inner))
        });
        if let Some((k, inner)) = found {
            let (b, opposite) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            triangles[t] = [corners[k], inner[0], opposite];
            for (j, p) in inner.iter().enumerate() {
                triangles.push([*p, inner.get(j + 1).copied().unwrap_or(b), opposite]);
            }
        } else {
            t += 1;
        }
    }
}

/// The pieces that hang together with the edges that the strips began from.
pub(super) fn connected(cut: &Clipped, bases: &[[u32; 2]]) -> Vec<[u32; 3]> {
    let mut at_edge: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (t, corners) in cut.triangles.iter().enumerate() {
        (0..3).for_each(|k| at_edge.entry(key(corners[k], corners[(k + 1) % 3])).or_default().push(t));
    }
    let mut is_reached = vec![false; cut.triangles.len()];
    let mut queue = vec![];
    for [a, b] in bases {
        let edge = key(*a, *b);
        let mut line = vec![edge[0]];
        line.extend(cut.on_edges.get(&edge).into_iter().flatten());
        line.push(edge[1]);
        queue.extend(line.windows(2).flat_map(|w| at_edge.get(&key(w[0], w[1])).into_iter().flatten().copied()));
    }
    while let Some(t) = queue.pop() {
        if !std::mem::replace(&mut is_reached[t], true) {
            let corners = cut.triangles[t];
            queue.extend((0..3).flat_map(|k| at_edge[&key(corners[k], corners[(k + 1) % 3])].iter().copied()));
        }
    }
    cut.triangles.iter().zip(is_reached).filter(|(_, r)| *r).map(|(t, _)| *t).collect()
}
