//! Strips of triangles between a front and where it moves to.

use super::smooth::bend;
use super::{EdgeLimits, FrontStep, GrowingFront};
use crate::geometry::aabb::Aabb;
use crate::geometry::surface::Surface;
use crate::geometry::triangle::{cuts_segment, orientation3};
use crate::math::Vector3;
use std::collections::BTreeSet;

/// A vertex that would come to less than this share of the shortest edge before the boundary goes through it.
const NEARLY: f64 = 0.5;
/// How far beyond the boundary it goes then, over the shortest edge.
const BEYOND: f64 = 0.25;
/// Distance that a front keeps from another crack, over the shortest edge.
const STANDOFF: f64 = 0.5;
/// How far strips are carried on past the ends of a front, over the longest edge and the step.
pub(super) const PAST_END: f64 = 2.0;

/// The strips of all fronts of a crack.
pub(super) struct Strips<'a> {
    vertices: &'a mut Vec<Vector3>,
    limits: &'a EdgeLimits,
    body: &'a Surface,
    others: &'a [&'a Surface],
    short_ends: &'a BTreeSet<u32>,
    pub triangles: Vec<[u32; 3]>,
    /// Edges of the old fronts that strips begin from.
    pub bases: Vec<[u32; 2]>,
}

/// A point of the new front.
#[derive(Clone, Copy)]
struct NewPoint {
    at: Vector3,
    /// Where it came from.
    from: Vector3,
    /// Tangent of the old front, none where points were made one.
    tangent: Option<Vector3>,
    /// The vertex, if it did not move.
    stays: Option<u32>,
}

impl<'a> Strips<'a> {
    pub fn new(
        vertices: &'a mut Vec<Vector3>,
        limits: &'a EdgeLimits,
        body: &'a Surface,
        others: &'a [&'a Surface],
        short_ends: &'a BTreeSet<u32>,
    ) -> Self {
        Self { vertices, limits, body, others, short_ends, triangles: vec![], bases: vec![] }
    }

    /// Adds the strip ahead of a front.
    pub fn advance(&mut self, front: &GrowingFront, steps: &[FrontStep]) {
        let n = front.vertices.len();
        let is_closed = front.line.is_closed;
        let points: Vec<NewPoint> = (0..n).map(|k| self.moved(front, k, &steps[k])).collect();
        if points.iter().all(|p| p.stays.is_some()) {
            return;
        }
        let anchor = points.iter().position(|p| p.stays.is_some());
        let start = if is_closed { anchor.unwrap_or(0) } else { 0 };
        let order: Vec<usize> = (0..n + usize::from(is_closed)).map(|k| (start + k) % n).collect();
        if is_closed && anchor.is_none() {
            self.loop_around(front, &points, &order);
            return;
        }
        // Stretches between vertices that stay.
        let mut from = 0;
        for k in 1..order.len() {
            if points[order[k]].stays.is_some() || k + 1 == order.len() {
                if order[from..=k].iter().any(|i| points[*i].stays.is_none()) {
                    self.stretch(front, &points, &order[from..=k]);
                }
                from = k;
            }
        }
    }

    fn moved(&self, front: &GrowingFront, k: usize, step: &FrontStep) -> NewPoint {
        let from = self.vertices[front.vertices[k] as usize];
        let length = if step.is_move() { self.free_length(from, step) } else { 0.0 };
        let stays = (length <= 0.0).then_some(front.vertices[k]);
        NewPoint { at: from + step.direction * length, from, tangent: Some(front.line.points[k].tangent), stays }
    }

    /// The length of a step, changed where it ends at the boundary or at another crack.
    fn free_length(&self, from: Vector3, step: &FrontStep) -> f64 {
        let mut length = step.length;
        let (nearly, standoff) = (NEARLY * self.limits.shortest, STANDOFF * self.limits.shortest);
        let end = from + step.direction * length;
        if let Some(share) = first_cut(self.body, end, end + step.direction * nearly) {
            length += share * nearly + BEYOND * self.limits.shortest;
        }
        for other in self.others {
            let reach = length + standoff;
            if let Some(share) = first_cut(other, from, from + step.direction * reach) {
                length = length.min(share * reach - standoff);
            }
        }
        // What is left of a step at another crack is none if it is too short for triangles.
        if length < step.length.min(0.1 * self.limits.shortest) { 0.0 } else { length }
    }

    fn stretch(&mut self, front: &GrowingFront, points: &[NewPoint], order: &[usize]) {
        let mut old: Vec<u32> = order.iter().map(|k| front.vertices[*k]).collect();
        let line = in_order(order.iter().map(|k| points[*k]).collect());
        let line = self.refined(&self.thinned(&line));
        if line.iter().all(|p| p.stays.is_some()) {
            return;
        }
        self.bases.extend(old.windows(2).map(|w| [w[0], w[1]]));
        let mut new: Vec<u32> = line.iter().map(|p| self.vertex(p)).collect();
        // An end that moves goes past the boundary, which cuts it off.
        let ends = [(order[0], 1.0, 0), (order[order.len() - 1], -1.0, line.len() - 1)];
        for (k, sign, i) in ends {
            if points[k].stays.is_none() && !self.short_ends.contains(&front.vertices[k]) {
                let length = (points[k].at - points[k].from).norm();
                let out = past_end(front.line.points[k].tangent, sign, length, self.limits);
                let beyond = [points[k].from, line[i].at].map(|p| self.push(p + out));
                let place = |list: &mut Vec<u32>, v| if sign > 0.0 { list.insert(0, v) } else { list.push(v) };
                place(&mut old, beyond[0]);
                // A vertex just before the boundary would leave an edge that counts as part of it: the next strip would begin
                // beside it, with a slit between.
                let reach = line[i].at + out.normalize() * self.limits.shortest;
                if first_cut(self.body, line[i].at, reach).is_some() {
                    new.remove(if sign > 0.0 { 0 } else { new.len() - 1 });
                }
                place(&mut new, beyond[1]);
            }
        }
        // Vertices that stay are part of the old line already.
        new.retain(|v| !old.contains(v));
        zip(self.vertices, &old, &new, &mut self.triangles);
    }

    fn loop_around(&mut self, front: &GrowingFront, points: &[NewPoint], order: &[usize]) {
        let old: Vec<u32> = order.iter().map(|k| front.vertices[*k]).collect();
        let line = in_order(order.iter().map(|k| points[*k]).collect());
        let line = self.refined(&self.thinned(&line));
        self.bases.extend(old.windows(2).map(|w| [w[0], w[1]]));
        let distinct = &line[..line.len() - 1];
        let new: Vec<u32> = if distinct.len() < 3 {
            // The front shrinks to a point.
            let middle = points.iter().map(|p| p.from).sum::<Vector3>() / points.len() as f64;
            vec![self.push(middle)]
        } else {
            let mut new: Vec<u32> = distinct.iter().map(|p| self.vertex(p)).collect();
            new.push(new[0]);
            new
        };
        zip(self.vertices, &old, &new, &mut self.triangles);
    }

    fn push(&mut self, p: Vector3) -> u32 {
        self.vertices.push(p);
        self.vertices.len() as u32 - 1
    }

    fn vertex(&mut self, p: &NewPoint) -> u32 {
        p.stays.unwrap_or_else(|| self.push(p.at))
    }

    /// Without points too near to each other; the ends are kept, and one that moves.
    fn thinned(&self, line: &[NewPoint]) -> Vec<NewPoint> {
        let near = |p: &NewPoint, q: &NewPoint| (p.at - q.at).norm() < self.limits.shortest;
        let (first, last) = (line[0], line[line.len() - 1]);
        let mut kept = vec![first];
        for p in &line[1..line.len() - 1] {
            if !near(p, &kept[kept.len() - 1]) {
                kept.push(*p);
            }
        }
        if kept.len() > 1 && near(&last, &kept[kept.len() - 1]) {
            kept.pop();
        }
        if kept.len() == 1 && first.stays.is_some() && last.stays.is_some() {
            let travel = |p: &&NewPoint| (p.at - p.from).norm();
            kept.extend(line[1..line.len() - 1].iter().max_by(|p, q| travel(p).total_cmp(&travel(q))));
        }
        kept.push(last);
        kept
    }

    /// With more points on long edges, on the arc that the tangents make.
    fn refined(&self, line: &[NewPoint]) -> Vec<NewPoint> {
        let mut refined = vec![line[0]];
        for w in line.windows(2) {
            let chord = w[1].at - w[0].at;
            let pieces = (chord.norm() / self.limits.longest).ceil().max(1.0) as usize;
            let is_moved = w.iter().all(|p| p.stays.is_none());
            let tangents = w[0].tangent.zip(w[1].tangent).filter(|_| is_moved);
            for j in 1..pieces {
                let s = j as f64 / pieces as f64;
                let mix = |a: Vector3, b: Vector3| a * (1.0 - s) + b * s;
                let off = tangents.map_or_else(Vector3::zeros, |(a, b)| bend(chord, [a, b], s));
                let at = mix(w[0].at, w[1].at) + off;
                refined.push(NewPoint { at, from: mix(w[0].from, w[1].from), tangent: None, stays: None });
            }
            refined.push(w[1]);
        }
        refined
    }
}

/// Triangles between two lines in the same direction; shorter diagonals first.
pub(super) fn zip(vertices: &[Vector3], old: &[u32], new: &[u32], triangles: &mut Vec<[u32; 3]>) {
    let (mut i, mut k) = (0, 0);
    while i + 1 < old.len() || k + 1 < new.len() {
        let diagonal = |a: u32, b: u32| (vertices[a as usize] - vertices[b as usize]).norm_squared();
        let moves_on_old =
            k + 1 >= new.len() || (i + 1 < old.len() && diagonal(old[i + 1], new[k]) <= diagonal(old[i], new[k + 1]));
        let triangle = if moves_on_old {
            i += 1;
            [old[i - 1], old[i], new[k]]
        } else {
            k += 1;
            [old[i], new[k], new[k - 1]]
        };
        let [a, b, c] = triangle;
        if a != b && b != c && c != a {
            triangles.push(triangle);
        }
    }
}

/// How far a strip is carried on past an end of a front, so that the boundary cuts it off: with `sign` 1 past the first
/// vertex, with -1 past the last.
pub(super) fn past_end(tangent: Vector3, sign: f64, length: f64, limits: &EdgeLimits) -> Vector3 {
    tangent * (-sign * PAST_END * length.max(limits.longest))
}

/// Makes points one that passed each other, as those of a hollow front do.
fn in_order(mut line: Vec<NewPoint>) -> Vec<NewPoint> {
    let passed = |p: &NewPoint, q: &NewPoint| (q.at - p.at).dot(&(q.from - p.from)) <= 0.0;
    while let Some(k) = (1..line.len()).find(|k| passed(&line[k - 1], &line[*k])) {
        let (p, q) = (line[k - 1], line[k]);
        let is_end = |k: usize| k == 0 || k + 1 == line.len();
        match (p.stays.is_some() || is_end(k - 1), q.stays.is_some() || is_end(k)) {
            (false, false) => {
                let middle = |a: Vector3, b: Vector3| (a + b) * 0.5;
                line[k - 1] =
                    NewPoint { at: middle(p.at, q.at), from: middle(p.from, q.from), tangent: None, stays: None };
                line.remove(k);
            }
            (true, false) => {
                line.remove(k);
            }
            (false, true) => {
                line.remove(k - 1);
            }
            (true, true) => break,
        }
    }
    line
}

/// Where a segment first meets a surface, as a share of it.
fn first_cut(surface: &Surface, p: Vector3, q: Vector3) -> Option<f64> {
    let mut first: Option<f64> = None;
    surface.tree().visit(&Aabb::of_points([p, q]), |t| {
        let [a, b, c] = surface.corners(t);
        if cuts_segment([a, b, c], p, q) {
            let (from, to) = (orientation3(a, b, c, p), orientation3(a, b, c, q));
            let share = from / (from - to);
            first = Some(first.map_or(share, |f| f.min(share)));
        }
    });
    first
}
