//! Loops of edges to straight lines and arcs: quadratic edges are curved, and what goes on along a line or a circle is one.

use crate::case::gmsh::GmshModel;
use crate::geometry::curve::Curve;
use crate::math::{Vector2, cross};

/// Distance from a circle over its radius, and from a line over its length, up to which points lie on it: input files
/// often have no more than six digits.
const DIGITS: f64 = 2e-6;
/// The rise of an edge over its length from which it is an arc: below it, what six digits leave open.
const CURVED: f64 = 1e-5;

/// A curve and the parts that it belongs to, by index.
pub(super) struct Side {
    pub curve: Curve,
    pub parts: Vec<usize>,
}

/// A stretch of the boundary on one line or circle.
struct Stretch {
    points: Vec<Vector2>,
    is_arc: bool,
    parts: Vec<usize>,
}

/// The sides of each loop of a mesh.
pub(super) fn sides(model: &GmshModel) -> Vec<Vec<Side>> {
    (0..model.boundary.len()).map(|k| join(stretches(model, k))).collect()
}

/// One stretch for each edge of an element.
fn stretches(model: &GmshModel, index: usize) -> Vec<Stretch> {
    let mut edges = model.boundary[index].clone();
    // A loop may start at a midside node.
    let first = edges.iter().position(|e| !model.midside.contains(&e.start)).unwrap_or(0);
    edges.rotate_left(first);
    let at = |v: u32| model.vertices[v as usize];
    let mut stretches: Vec<Stretch> = vec![];
    for edge in edges {
        match stretches.last_mut() {
            Some(stretch) if model.midside.contains(&edge.start) => {
                let (a, b, c) = (stretch.points[0], at(edge.start), at(edge.end));
                let rise = cross(c - a, b - a).abs() / (c - a).norm();
                stretch.is_arc = rise > CURVED * (c - a).norm();
                stretch.points = vec![a, b, c];
            }
            _ => {
                stretches.push(Stretch { points: vec![at(edge.start), at(edge.end)], is_arc: false, parts: edge.parts })
            }
        }
    }
    stretches
}

fn join(stretches: Vec<Stretch>) -> Vec<Side> {
    let mut joined: Vec<Stretch> = vec![];
    for stretch in stretches {
        match joined.last_mut().and_then(|last| last.with(&stretch).map(|points| (last, points))) {
            Some((last, points)) => last.points = points,
            None => joined.push(stretch),
        }
    }
    // The loop may start in the middle of a side.
    if joined.len() > 1
        && let Some(points) = joined[joined.len() - 1].with(&joined[0])
    {
        joined.pop();
        joined[0].points = points;
    }
    joined.into_iter().map(|s| Side { curve: s.curve(), parts: s.parts }).collect()
}

impl Stretch {
    /// The points of this stretch and the next one, if they lie on one line or circle.
    fn with(&self, next: &Self) -> Option<Vec<Vector2>> {
        if self.parts != next.parts || self.is_arc != next.is_arc {
            return None;
        }
        let mut points = self.points.clone();
        points.extend(&next.points[1..]);
        let (first, last) = (points[0], points[points.len() - 1]);
        if !self.is_arc {
            let chord = last - first;
            let is_near = |p: &Vector2| cross(chord, p - first).abs() <= DIGITS * chord.norm_squared();
            let (before, after) = (self.points[self.points.len() - 2], next.points[1]);
            let goes_on = (next.points[0] - before).dot(&(after - next.points[0])) > 0.0;
            return (goes_on && points.iter().all(is_near)).then_some(points);
        }
        let Curve::Arc { center, radius, sweep, .. } = circle(&points)? else { return None };
        let Curve::Arc { sweep: own, .. } = self.curve() else { return None };
        let is_near = |p: &Vector2| ((p - center).norm() - radius).abs() <= DIGITS * radius;
        (own * sweep > 0.0 && points.iter().all(is_near)).then_some(points)
    }

    fn curve(&self) -> Curve {
        let (start, end) = (self.points[0], self.points[self.points.len() - 1]);
        let arc = if self.is_arc { circle(&self.points) } else { None };
        arc.unwrap_or(Curve::Line { start, end })
    }
}

/// The arc through the first, a middle and the last point; a whole circle if it is closed.
fn circle(points: &[Vector2]) -> Option<Curve> {
    let n = points.len() - 1;
    let (start, end) = (points[0], points[n]);
    if start != end {
        return Curve::arc_through(start, points[n / 2], end);
    }
    let Curve::Arc { center, sweep, .. } = Curve::arc_through(start, points[n / 3], points[2 * n / 3])? else {
        return None;
    };
    Some(Curve::arc_around(center, start, end, sweep > 0.0))
}
