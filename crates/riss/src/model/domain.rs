//! The body: an outline with holes, made of straight and circular edges in named parts.

use crate::geometry::aabb::Aabb;
use crate::geometry::curve::Curve;
use crate::geometry::polygon;
use crate::math::Vector2;
use std::ops::Range;

/// Index of an edge in [`Domain::edges`].
pub type EdgeId = usize;
/// Index of a part in [`Domain::parts`].
pub type PartId = usize;

/// A named set of edges.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryPart {
    /// Name in the case file.
    pub name: String,
    /// Its edges; parts may overlap.
    pub edges: Vec<EdgeId>,
}

/// A body in the plane; the material lies to the left of every edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    /// Edges of all loops, loop by loop; consecutive edges share their end point exactly.
    pub edges: Vec<Curve>,
    /// Edges of each closed loop: first the outline (counterclockwise), then the holes (clockwise).
    pub loops: Vec<Range<EdgeId>>,
    /// Named parts.
    pub parts: Vec<BoundaryPart>,
}

impl Domain {
    /// A domain without named parts from an outline and holes; each is turned so that the body lies to its left.
    pub fn new(outline: Vec<Curve>, holes: Vec<Vec<Curve>>) -> Self {
        let mut domain = Self { edges: vec![], loops: vec![], parts: vec![] };
        domain.push_loop(outline, true);
        for hole in holes {
            domain.push_loop(hole, false);
        }
        domain
    }

    fn push_loop(&mut self, mut edges: Vec<Curve>, counterclockwise: bool) {
        let area: f64 = edges.iter().map(Curve::area_share).sum();
        if (area > 0.0) != counterclockwise {
            edges = edges.iter().rev().map(Curve::reversed).collect();
        }
        let start = self.edges.len();
        self.edges.extend(edges);
        self.loops.push(start..self.edges.len());
    }

    /// Adds a named part; returns its index.
    pub fn add_part(&mut self, name: &str, edges: Vec<EdgeId>) -> PartId {
        self.parts.push(BoundaryPart { name: name.into(), edges });
        self.parts.len() - 1
    }

    /// The edges of the outline.
    pub fn outline(&self) -> Range<EdgeId> {
        self.loops[0].clone()
    }

    /// Whether `p` lies in the body (points on the boundary may fall either way).
    pub fn contains(&self, p: Vector2) -> bool {
        // The even-odd rule needs no orientation: each loop that contains the point flips the answer.
        self.loops.iter().fold(false, |inside, range| inside ^ self.loop_contains(range.clone(), p))
    }

    fn loop_contains(&self, range: Range<EdgeId>, p: Vector2) -> bool {
        let edges = &self.edges[range];
        let chords: Vec<Vector2> = edges
            .iter()
            .flat_map(|e| match e {
                Curve::Line { .. } => vec![e.point(0.0)],
                // Thirds, so that a full circle has an inside.
                Curve::Arc { .. } => vec![e.point(0.0), e.point(1.0 / 3.0), e.point(2.0 / 3.0)],
            })
            .collect();
        let mut inside = polygon::contains(&chords, p);
        for e in edges {
            let Curve::Arc { center, radius, .. } = *e else { continue };
            if (p - center).norm() >= radius {
                continue;
            }
            for k in 0..3 {
                let (a, b) = (e.point(k as f64 / 3.0), e.point((k + 1) as f64 / 3.0));
                // In the circular segment between chord and arc: on the arc's side of the chord.
                let middle = e.point((k as f64 + 0.5) / 3.0);
                let side = |q| crate::geometry::predicates::orientation(a, b, q) > 0.0;
                if side(p) == side(middle) {
                    inside = !inside;
                }
            }
        }
        inside
    }

    /// Distance from `p` to the boundary.
    pub fn distance_to_boundary(&self, p: Vector2) -> f64 {
        self.edges.iter().map(|e| e.distance(p)).fold(f64::INFINITY, f64::min)
    }

    /// Bounding box.
    pub fn aabb(&self) -> Aabb<2> {
        self.edges.iter().fold(Aabb::empty(), |b, e| b.union(e.aabb()))
    }

    /// Area of the body [length²].
    pub fn area(&self) -> f64 {
        self.edges.iter().map(Curve::area_share).sum()
    }

    /// The point of an edge that is closest to `p`; exact on edges along an axis.
    pub fn on_edge(&self, edge: EdgeId, p: Vector2) -> Vector2 {
        let curve = &self.edges[edge];
        // A distance that underflows is zero, too: axes are set below even then.
        let mut q = if curve.distance(p) == 0.0 { p } else { curve.point(curve.closest_parameter(p)) };
        if let Curve::Line { start, end } = *curve {
            for axis in 0..2 {
                if start[axis] == end[axis] {
                    q[axis] = start[axis];
                }
            }
        }
        q
    }

    /// The edge and its parameter closest to `p`.
    pub fn closest_edge(&self, p: Vector2) -> (EdgeId, f64) {
        let edge = (0..self.edges.len())
            .min_by(|&a, &b| self.edges[a].distance(p).total_cmp(&self.edges[b].distance(p)))
            .expect("a domain has edges");
        (edge, self.edges[edge].closest_parameter(p))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn disk_with_hole() {
        let circle = |r| vec![Curve::circle(Vector2::new(1.0, 2.0), r)];
        let domain = Domain::new(circle(2.0), vec![circle(0.5)]);
        assert!((domain.area() - std::f64::consts::PI * 3.75).abs() < 1e-12);
        for k in 0..200 {
            let d = crate::math::direction(k as f64 * 0.7);
            for (r, inside) in [(0.49, false), (0.51, true), (1.99, true), (2.01, false)] {
                assert_eq!(domain.contains(Vector2::new(1.0, 2.0) + d * r), inside, "r = {r}, direction {d:?}");
            }
        }
    }
}
