//! Points along the boundary and the cracks: the lines that triangles must respect.

use super::spacing::SpacingField;
use super::triangulation::Triangulation;
use crate::geometry::curve::Curve;
use crate::math::Vector2;
use crate::model::{Domain, EdgeId, Model};
use std::ops::Range;

/// A stretch of a boundary edge between two neighboring points, body to its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundarySegment {
    /// First and second point.
    pub points: [u32; 2],
    /// Edge of the domain.
    pub edge: EdgeId,
    /// Parameters of both points on the edge.
    pub range: [f64; 2],
}

/// Points that triangles must have as corners, and lines that they must have as edges.
#[derive(Clone, Debug, Default)]
pub struct Chains {
    /// Points: those of the boundary, then those of the cracks, then free ones.
    pub positions: Vec<Vector2>,
    /// Whether a node stands at the point; otherwise it only shapes the cells.
    pub is_node: Vec<bool>,
    /// Spacing at each point [length].
    pub spacing: Vec<f64>,
    /// Boundary, loop by loop.
    pub boundary: Vec<BoundarySegment>,
    /// Pieces of cracks between neighboring points, in the order and direction of the path.
    pub crack_pieces: Vec<CrackPiece>,
}

/// A piece of a crack between two neighboring points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrackPiece {
    /// First and second point, in the direction of the path.
    pub points: [u32; 2],
    /// Index of the crack.
    pub crack: usize,
}

impl Chains {
    /// Adds a point; returns its index.
    pub fn push(&mut self, position: Vector2, is_node: bool, spacing: f64) -> u32 {
        self.positions.push(position);
        self.is_node.push(is_node);
        self.spacing.push(spacing);
        (self.positions.len() - 1) as u32
    }

    /// Points along every edge at the spacing that `step` gives for a position and a tangent.
    ///
    /// Edge ends and crack mouths are always points.
    pub fn add_boundary(&mut self, model: &Model, step: &dyn Fn(Vector2, Vector2) -> f64) {
        let mouths: Vec<(EdgeId, f64, Vector2)> = model
            .cracks
            .iter()
            .flat_map(|c| c.mouths())
            .map(|p| {
                let (edge, t) = model.domain.closest_edge(p);
                (edge, t, p)
            })
            .collect();
        for range in &model.domain.loops {
            let first_segment = self.boundary.len();
            let start = self.positions.len() as u32;
            for edge in range.clone() {
                let curve = model.domain.edges[edge];
                let mut stops: Vec<(f64, Vector2)> = vec![(0.0, curve.point(0.0))];
                // Corners are shared with mouths that stand on them.
                let near = 1e-9;
                stops.extend(
                    mouths.iter().filter(|m| m.0 == edge && m.1 > near && m.1 < 1.0 - near).map(|m| (m.1, m.2)),
                );
                stops.sort_by(|a, b| a.0.total_cmp(&b.0));
                // Cracks may share a mouth.
                stops.dedup_by(|a, b| a.1 == b.1);
                let ends: Vec<f64> = stops.iter().map(|s| s.0).skip(1).chain([1.0]).collect();
                for ((from, p), to) in stops.into_iter().zip(ends) {
                    let whole = (from, to) == (0.0, 1.0);
                    let parameters = subdivide(&curve, from, to, if whole { least_pieces(&curve) } else { 1 }, step);
                    for (k, w) in parameters.windows(2).enumerate() {
                        let q = if k == 0 { p } else { curve.point(w[0]) };
                        let h = step(q, curve.tangent(w[0]));
                        let index = self.push(q, true, h);
                        self.boundary.push(BoundarySegment { points: [index, index + 1], edge, range: [w[0], w[1]] });
                    }
                }
            }
            let last = self.boundary.len() - 1;
            debug_assert!(last >= first_segment);
            self.boundary[last].points[1] = start;
        }
    }

    /// The boundary of a triangulation along one loop, its arcs subdivided to pieces of at most `turn` [rad].
    pub fn add_loop(&mut self, nodal: &Triangulation, edges: Range<EdgeId>, domain: &Domain, turn: f64) {
        let start = self.positions.len() as u32;
        for s in nodal.boundary.iter().filter(|s| edges.contains(&s.edge)) {
            let (curve, [from, to]) = (&domain.edges[s.edge], s.range);
            let n = match curve {
                Curve::Line { .. } => 1,
                Curve::Arc { sweep, .. } => (sweep.abs() * (to - from) / turn).ceil().max(1.0) as usize,
            };
            let h = curve.length() * (to - from) / n as f64;
            for k in 0..n {
                let t = |k: usize| from + (to - from) * k as f64 / n as f64;
                let p = if k == 0 { nodal.position(s.points[0]) } else { curve.point(t(k)) };
                let index = self.push(p, true, h);
                self.boundary.push(BoundarySegment {
                    points: [index, index + 1],
                    edge: s.edge,
                    range: [t(k), t(k + 1)],
                });
            }
        }
        if let Some(last) = self.boundary.last_mut() {
            last.points[1] = start;
        }
    }

    /// Points along every crack at the given spacing; vertices and tips are always points.
    ///
    /// Points that exist already on the path (`reuse`) become corners of it, so that grid nodes on a crack are split.
    pub fn add_cracks(&mut self, model: &Model, spacing: &SpacingField, nodes: CrackNodes, reuse: usize) {
        for (index, crack) in model.cracks.iter().enumerate() {
            let mut previous = self.find_or_push(crack.vertices[0], spacing, nodes);
            for (a, b) in crack.segments() {
                let mut stops = self.points_on(a, b, reuse);
                stops.sort_by(|p, q| p.0.total_cmp(&q.0));
                let mut parameters = vec![0.0];
                let line = Curve::Line { start: a, end: b };
                for to in stops.iter().map(|s| s.0).chain([1.0]) {
                    let from = *parameters.last().expect("starts with 0");
                    parameters.extend(subdivide(&line, from, to, 1, &|p, _| spacing.at(p)).into_iter().skip(1));
                }
                for &t in &parameters[1..] {
                    let known = stops.iter().find(|s| s.0 == t).map(|s| s.1);
                    let point = match known {
                        Some(point) => point,
                        None if t == 1.0 => self.find_or_push(b, spacing, nodes),
                        None => {
                            let p = line.point(t);
                            self.push(p, nodes == CrackNodes::AtSpacing, spacing.at(p))
                        }
                    };
                    self.crack_pieces.push(CrackPiece { points: [previous, point], crack: index });
                    previous = point;
                }
            }
        }
    }

    /// The points along a crack, from its start to its end.
    pub fn positions_along(&self, crack: usize) -> Vec<Vector2> {
        let pieces = || self.crack_pieces.iter().filter(|p| p.crack == crack);
        let points = pieces().take(1).map(|p| p.points[0]).chain(pieces().map(|p| p.points[1]));
        points.map(|i| self.positions[i as usize]).collect()
    }

    fn find_or_push(&mut self, p: Vector2, spacing: &SpacingField, nodes: CrackNodes) -> u32 {
        let h = spacing.at(p);
        match self.positions.iter().position(|q| (q - p).norm() <= 1e-6 * h) {
            Some(index) => index as u32,
            None => self.push(p, nodes == CrackNodes::AtSpacing, h),
        }
    }

    /// Known points strictly between `a` and `b` on the segment, with their parameter.
    fn points_on(&self, a: Vector2, b: Vector2, limit: usize) -> Vec<(f64, u32)> {
        let e = b - a;
        let length = e.norm();
        (0..limit.min(self.positions.len()))
            .filter_map(|i| {
                let d = self.positions[i] - a;
                let t = d.dot(&e) / (length * length);
                let off = crate::math::cross(e, d).abs() / length;
                let near = 1e-6 * self.spacing[i];
                (off <= near && t * length > near && (1.0 - t) * length > near).then_some((t, i as u32))
            })
            .collect()
    }
}

/// Whether nodes are put along cracks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CrackNodes {
    /// Pairs of nodes at the local spacing.
    AtSpacing,
    /// Only where nodes stand on the crack anyway.
    WhereTheyStand,
}

fn least_pieces(curve: &Curve) -> usize {
    match curve {
        Curve::Line { .. } => 1,
        // Segments of at most 45°, so that chords and tangents stay close to the arc.
        Curve::Arc { sweep, .. } => (sweep.abs() / std::f64::consts::FRAC_PI_4).ceil() as usize,
    }
}

/// Parameters from `from` to `to` whose distances follow `step`, at least `least` pieces; the same points if the curve
/// is run backwards.
fn subdivide(curve: &Curve, from: f64, to: f64, least: usize, step: &dyn Fn(Vector2, Vector2) -> f64) -> Vec<f64> {
    let (ahead, back) = (count_steps(curve, from, to, step), count_steps(curve, to, from, step));
    let total = |table: &[(f64, f64)]| table[table.len() - 1].1;
    let n = (0.5 * (total(&ahead) + total(&back)) - 1e-6).ceil().max(least as f64) as usize;
    let (ahead, back) = (equal_shares(&ahead, n), equal_shares(&back, n));
    let inner = (1..n).map(|i| 0.5 * (ahead[i] + back[n - i]));
    [from].into_iter().chain(inner).chain([to]).collect()
}

/// Cumulative `∫ ds/h` along the curve, in steps well below h: pieces of equal integral follow the grading.
fn count_steps(curve: &Curve, from: f64, to: f64, step: &dyn Fn(Vector2, Vector2) -> f64) -> Vec<(f64, f64)> {
    let (length, sign) = (curve.length(), (to - from).signum());
    let (mut t, mut sum, mut table) = (from, 0.0, vec![(from, 0.0)]);
    while (to - t) * sign > 0.0 {
        let h = step(curve.point(t), curve.tangent(t));
        let dt = (0.1 * h / length).min((to - t) * sign).max(1e-12);
        let middle = t + 0.5 * sign * dt;
        sum += dt * length / step(curve.point(middle), curve.tangent(middle));
        t += sign * dt;
        table.push((t, sum));
    }
    table
}

/// Parameters at the ends of `n` pieces of equal integral.
fn equal_shares(table: &[(f64, f64)], n: usize) -> Vec<f64> {
    let sum = table[table.len() - 1].1;
    let mut parameters = vec![table[0].0];
    let mut k = 0;
    for i in 1..n {
        let target = sum * i as f64 / n as f64;
        while table[k + 1].1 < target {
            k += 1;
        }
        let ((t0, s0), (t1, s1)) = (table[k], table[k + 1]);
        parameters.push(t0 + (t1 - t0) * (target - s0) / (s1 - s0));
    }
    parameters.push(table[table.len() - 1].0);
    parameters
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subdivision_follows_the_spacing() {
        let line = Curve::Line { start: Vector2::zeros(), end: Vector2::new(1.0, 0.0) };
        let t = subdivide(&line, 0.0, 1.0, 1, &|p, _| 0.01 + 0.2 * p.x);
        assert!((t[1] - 0.01).abs() < 0.003 && *t.last().unwrap() == 1.0);
        for w in t.windows(3) {
            let ratio = (w[2] - w[1]) / (w[1] - w[0]);
            assert!((1.0..1.35).contains(&ratio), "{ratio}");
        }
        assert_eq!(subdivide(&line, 0.0, 1.0, 1, &|_, _| 0.25).len(), 5);
    }
}
