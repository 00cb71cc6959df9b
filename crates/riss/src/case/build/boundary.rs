//! The boundary while it is put together: loops of edges that know their parts and where they were written.

use crate::geometry::curve::Curve;
use crate::math::Vector2;
use crate::model::{BoundaryPart, Domain, PartId};

/// Points closer than this times the size of the body are the same.
pub(super) const SAME_POINT: f64 = 1e-9;

/// One edge.
#[derive(Clone, Debug)]
pub(super) struct Edge {
    pub curve: Curve,
    pub parts: Vec<PartId>,
    /// Key that gives it in the case file.
    pub key: String,
}

/// All loops: first the outline (counterclockwise), then the holes (clockwise).
#[derive(Debug, Default)]
pub(super) struct Boundary {
    pub loops: Vec<Vec<Edge>>,
    /// Names of the parts.
    pub names: Vec<String>,
}

impl Boundary {
    /// The part of this name, new if there is none yet.
    pub fn part(&mut self, name: &str) -> PartId {
        self.find_part(name).unwrap_or_else(|| {
            self.names.push(name.into());
            self.names.len() - 1
        })
    }

    /// The part of this name.
    pub fn find_part(&self, name: &str) -> Option<PartId> {
        self.names.iter().position(|n| n == name)
    }

    /// Adds a loop, turned so that the body lies to its left.
    pub fn push_loop(&mut self, mut edges: Vec<Edge>) {
        let area: f64 = edges.iter().map(|e| e.curve.area_share()).sum();
        if (area > 0.0) != self.loops.is_empty() {
            edges.reverse();
            for edge in &mut edges {
                edge.curve = edge.curve.reversed();
            }
        }
        self.loops.push(edges);
    }

    /// Diagonal of the bounding box of the outline.
    pub fn size(&self) -> f64 {
        let boxes = self.loops.first().into_iter().flatten().map(|e| e.curve.aabb());
        boxes.reduce(|a, b| a.union(b)).map_or(0.0, |b| b.size().norm())
    }

    /// Splits a loop at a point of one of its edges; returns the index of the edge that starts there.
    pub fn split(&mut self, loop_index: usize, edge: usize, at: f64) -> usize {
        let tolerance = 1e-6 * self.size();
        let edges = &mut self.loops[loop_index];
        let length = edges[edge].curve.length();
        if at * length <= tolerance {
            return edge;
        }
        if (1.0 - at) * length <= tolerance {
            return (edge + 1) % edges.len();
        }
        let mut second = edges[edge].clone();
        second.curve = second.curve.piece(at, 1.0);
        edges[edge].curve = edges[edge].curve.piece(0.0, at);
        edges.insert(edge + 1, second);
        edge + 1
    }

    /// The body, with consecutive edges joined exactly wherever one of them is straight.
    pub fn into_domain(mut self) -> Domain {
        self.loops.iter_mut().for_each(|edges| join(edges));
        let mut parts: Vec<BoundaryPart> =
            self.names.into_iter().map(|name| BoundaryPart { name, edges: vec![] }).collect();
        let (mut edges, mut loops) = (vec![], vec![]);
        for list in self.loops {
            let start = edges.len();
            for edge in list {
                for part in edge.parts {
                    parts[part].edges.push(edges.len());
                }
                edges.push(edge.curve);
            }
            loops.push(start..edges.len());
        }
        Domain { edges, loops, parts }
    }
}

/// Moves the ends of straight edges onto the computed ends of arcs beside them.
fn join(edges: &mut [Edge]) {
    let n = edges.len();
    let is_arc = |e: &Edge| matches!(e.curve, Curve::Arc { .. });
    for k in 0..n {
        let (before, after) = (&edges[(k + n - 1) % n], &edges[(k + 1) % n]);
        let from: Option<Vector2> = is_arc(before).then(|| before.curve.point(1.0));
        let to: Option<Vector2> = is_arc(after).then(|| after.curve.point(0.0));
        if let Curve::Line { start, end } = &mut edges[k].curve {
            *start = from.unwrap_or(*start);
            *end = to.unwrap_or(*end);
        }
    }
}
