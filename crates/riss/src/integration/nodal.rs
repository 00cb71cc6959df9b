//! Cells around the nodes: a third of each triangle goes to each of its corners [Chen2001; Puso2008].
//!
//! The part of a triangle at a corner is the quadrilateral between the corner, the middles of both edges there and the
//! centroid. All parts around a node are its cell. Cells and parts share their outlines, so that the fluxes of shape
//! functions through them cancel inside the body, and linear patch tests hold to round-off.

use super::IntegrationPoint;
use super::cells::{EdgePoint, IntegrationCells, Smoothing, edge_rule};
use super::settings::IntegrationSettings;
use crate::geometry::curve::Curve;
use crate::math::{Vector2, turn_left};
use crate::model::Domain;
use crate::nodes::Triangulation;
use crate::nodes::elements::{arcs, left_of};
use crate::nodes::triangulation::SIGHT_SHIFT;
use rustc_hash::FxHashMap;

impl IntegrationCells {
    /// Cells around the copies of a triangulation.
    ///
    /// - `stabilization`: from 0 to 1, see [`Scheme::Nodal`](super::Scheme::Nodal)
    pub fn nodal(
        triangulation: &Triangulation,
        domain: &Domain,
        stabilization: f64,
        settings: &IntegrationSettings,
    ) -> Self {
        let mut builder = Builder::new(triangulation, domain, stabilization > 0.0, settings);
        let mut around = vec![vec![]; triangulation.copies.len()];
        for (i, corners) in triangulation.triangles.iter().enumerate() {
            for (k, corner) in corners.iter().enumerate() {
                around[*corner as usize].push((i, k));
            }
        }
        for triangles in around.iter().filter(|t| !t.is_empty()) {
            builder.add_cell(triangles);
        }
        let smoothing = Smoothing { between: builder.between, share: stabilization.sqrt() };
        Self { smoothing: Some(smoothing), ..builder.cells }
    }
}

/// An oriented stretch of outline, with the part to its left.
struct Stretch {
    curve: Curve,
    /// Whether a face or the boundary of the body is there.
    is_outer: bool,
    /// Number of the part to the left, and to the right if that is in the cell, too.
    between: [Option<u32>; 2],
}

struct Builder<'a> {
    triangulation: &'a Triangulation,
    /// Curved boundary pieces by the copies at their ends.
    arcs: FxHashMap<[u32; 2], Curve>,
    /// The triangle to the left of each directed edge.
    left_of: FxHashMap<[u32; 2], u32>,
    has_parts: bool,
    /// Rule along half an edge of the boundary, from 0 to 1.
    half: Vec<(f64, f64)>,
    cells: IntegrationCells,
    between: Vec<[Option<u32>; 2]>,
}

impl<'a> Builder<'a> {
    fn new(triangulation: &'a Triangulation, domain: &Domain, has_parts: bool, settings: &IntegrationSettings) -> Self {
        let rule = edge_rule(settings);
        let half = rule[..rule.len() / 2].iter().map(|(t, w)| (2.0 * t, 2.0 * w)).collect();
        let (arcs, left_of) = (arcs(triangulation, domain), left_of(triangulation));
        Self { triangulation, arcs, left_of, has_parts, half, cells: IntegrationCells::default(), between: vec![] }
    }

    /// The cell of a copy, from the triangles around it and the number of its corner in each.
    fn add_cell(&mut self, triangles: &[(usize, usize)]) {
        let mut stretches = vec![];
        let mut corners = vec![];
        for (number, &(i, k)) in triangles.iter().enumerate() {
            let part = if self.has_parts { number as u32 } else { 0 };
            let t = self.triangulation.triangles[i];
            let [at, next, last] = [t[k], t[(k + 1) % 3], t[(k + 2) % 3]];
            let centroid = t.iter().map(|v| self.triangulation.position(*v)).sum::<Vector2>() / 3.0;
            let (ahead, behind) = (self.edge(at, next), self.edge(last, at));
            let (m, n) = (ahead.point(0.5), behind.point(0.5));
            for (start, end) in [(m, centroid), (centroid, n)] {
                let curve = Curve::Line { start, end };
                stretches.push(Stretch { curve, is_outer: false, between: [Some(part), None] });
            }
            corners.extend([m, centroid]);
            match self.left_of.get(&[next, at]) {
                None => {
                    let curve = ahead.piece(0.0, 0.5);
                    stretches.push(Stretch { curve, is_outer: true, between: [Some(part), None] });
                }
                Some(&other) if self.has_parts => {
                    let beyond = triangles.iter().position(|(j, _)| *j == other as usize).map(|n| n as u32);
                    let curve = ahead.piece(0.0, 0.5);
                    stretches.push(Stretch { curve, is_outer: false, between: [Some(part), beyond] });
                }
                Some(_) => {}
            }
            if !self.left_of.contains_key(&[at, last]) {
                let curve = behind.piece(0.5, 1.0);
                stretches.push(Stretch { curve, is_outer: true, between: [Some(part), None] });
            }
        }
        let n_parts = if self.has_parts { triangles.len() } else { 1 };
        let first = self.cells.edge_points.len();
        stretches.iter().for_each(|s| self.add_stretch(s));
        self.add_points(n_parts, first);
        self.cells.close(corners);
    }

    /// An edge from one copy to another.
    fn edge(&self, a: u32, b: u32) -> Curve {
        let [start, end] = [a, b].map(|v| self.triangulation.position(v));
        self.arcs.get(&[a, b]).copied().unwrap_or(Curve::Line { start, end })
    }

    fn add_stretch(&mut self, stretch: &Stretch) {
        // The middle is enough for linear fields on straight stretches.
        let rule: &[(f64, f64)] = if stretch.is_outer { &self.half } else { &[(0.5, 1.0)] };
        for &(t, w) in rule {
            let (position, right) = (stretch.curve.point(t), -turn_left(stretch.curve.velocity(t)));
            let sight = if stretch.is_outer { position - right * (2.0 * SIGHT_SHIFT) } else { position };
            self.cells.edge_points.push(EdgePoint { position, sight, normal: right * w });
            self.between.push(stretch.between);
        }
    }

    /// A point at the centroid of each part: area and moments from the outline.
    fn add_points(&mut self, n_parts: usize, first: usize) {
        let mut parts = vec![(0.0, Vector2::zeros()); n_parts];
        let edges = self.cells.edge_points[first..].iter().zip(&self.between[first..]);
        let origin = self.cells.edge_points[first].position;
        for (edge, between) in edges {
            let r = edge.position - origin;
            for (part, sign) in between.iter().zip([1.0, -1.0]) {
                if let Some(part) = part {
                    let flux = 0.5 * sign * r.dot(&edge.normal);
                    parts[*part as usize].0 += flux;
                    parts[*part as usize].1 += r * (flux / 1.5);
                }
            }
        }
        for (area, moment) in parts {
            let position = origin + moment / area;
            self.cells.points.push(IntegrationPoint { position, weight: area });
        }
    }
}
