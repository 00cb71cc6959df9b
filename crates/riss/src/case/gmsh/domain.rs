//! From boundary loops to a domain: edges that continue each other become one.

use super::{BoundaryEdge, GmshError, GmshModel};
use crate::geometry::curve::Curve;
use crate::math::{Vector2, cross};
use crate::model::Domain;

/// Sine of the angle up to which two edges are one line: coordinates of a file have 16 digits, and no arc is so fine.
const ANGLE_TOLERANCE: f64 = 1e-9;

/// A straight side and the parts that it belongs to.
struct Side {
    start: Vector2,
    end: Vector2,
    parts: Vec<usize>,
}

impl GmshModel {
    /// The body; consecutive edges on one line and in the same parts become one.
    ///
    /// # Errors
    /// [`GmshError::NoSurface`] without a boundary.
    pub fn into_domain(self) -> Result<Domain, GmshError> {
        let mut loops = self.boundary.iter().map(|edges| self.sides(edges));
        let outline = loops.next().ok_or(GmshError::NoSurface)?;
        let holes: Vec<Vec<Side>> = loops.collect();
        let curves =
            |sides: &[Side]| sides.iter().map(|s| Curve::Line { start: s.start, end: s.end }).collect::<Vec<_>>();
        // The loops already have the body to their left, so that their edges keep this order.
        let mut domain = Domain::new(curves(&outline), holes.iter().map(|h| curves(h)).collect());
        let mut edges = vec![vec![]; self.parts.len()];
        for (edge, side) in outline.iter().chain(holes.iter().flatten()).enumerate() {
            side.parts.iter().for_each(|&part| edges[part].push(edge));
        }
        for (name, edges) in self.parts.iter().zip(edges) {
            domain.add_part(name, edges);
        }
        Ok(domain)
    }

    fn sides(&self, edges: &[BoundaryEdge]) -> Vec<Side> {
        let mut sides: Vec<Side> = vec![];
        for edge in edges {
            let [start, end] = [edge.start, edge.end].map(|v| self.vertices[v as usize]);
            match sides.last_mut() {
                Some(side) if side.parts == edge.parts && continues(side.start, side.end, end) => side.end = end,
                _ => sides.push(Side { start, end, parts: edge.parts.clone() }),
            }
        }
        // The loop may start in the middle of a side.
        if let [first, .., last] = &sides[..]
            && first.parts == last.parts
            && continues(last.start, last.end, first.end)
        {
            let start = last.start;
            sides.pop();
            sides[0].start = start;
        }
        sides
    }
}

/// Whether `b` to `c` goes straight on from `a` to `b`.
fn continues(a: Vector2, b: Vector2, c: Vector2) -> bool {
    let (d, e) = (b - a, c - b);
    cross(d, e).abs() <= ANGLE_TOLERANCE * d.norm() * e.norm() && d.dot(&e) > 0.0
}
