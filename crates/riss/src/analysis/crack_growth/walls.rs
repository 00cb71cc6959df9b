//! What a growing tip runs into: the boundary, a hole, another crack, its own path.

use crate::crack::{End, TipId};
use crate::geometry::aabb::Aabb;
use crate::geometry::predicates::closest_on_segment;
use crate::geometry::tree::BoxTree;
use crate::math::{Vector2, cross};
use crate::model::{EdgeId, Model};

/// A wall this near ahead of the new tip is reached, over the length of the increment.
pub const LOOK_AHEAD: f64 = 0.2;
/// A wall this near to the new tip on any side is reached, over the length of the increment.
pub const CLOSE: f64 = 0.05;
/// A path that misses the end of a wall by less than this does not miss it, over the length of the increment.
const CAPTURE: f64 = 0.02;
/// A meeting this near to a corner or a vertex is moved there, over the length of the increment.
const SNAP: f64 = 0.05;

/// What an increment ends at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Nothing: the tip goes on.
    Free,
    /// An edge of the body.
    Boundary(EdgeId),
    /// A crack, by index.
    Crack(usize),
}

/// Segments of all cracks with a tree over them.
pub struct Walls<'a> {
    model: &'a Model,
    segments: Vec<CrackSegment>,
    tree: BoxTree<2>,
}

#[derive(Clone, Copy)]
struct CrackSegment {
    crack: usize,
    /// Index in the path.
    index: usize,
    ends: [Vector2; 2],
}

/// A place on a wall.
#[derive(Clone, Copy, Debug)]
struct Hit {
    /// Parameter on a segment that meets it, or distance from a point beside it [length].
    at: f64,
    point: Vector2,
    ending: Ending,
}

impl<'a> Walls<'a> {
    /// The walls of a model.
    pub fn new(model: &'a Model) -> Self {
        let mut segments = vec![];
        for (crack, path) in model.cracks.iter().enumerate() {
            segments.extend(path.segments().enumerate().map(|(index, (a, b))| CrackSegment {
                crack,
                index,
                ends: [a, b],
            }));
        }
        let boxes: Vec<Aabb<2>> = segments.iter().map(|s| Aabb::of_points(s.ends)).collect();
        Self { model, tree: BoxTree::new(&boxes), segments }
    }

    /// Shortens (or slightly lengthens) the way of a tip so that it ends at the first wall on it.
    ///
    /// - `way`: vertices from the tip, which is the first of them
    pub fn clip(&self, tip: TipId, way: &[Vector2]) -> (Vec<Vector2>, Ending) {
        let length = length_of(way);
        let last = way.len() - 2;
        for (k, w) in way.windows(2).enumerate() {
            let direction = (w[1] - w[0]).normalize();
            let to = if k == last { w[1] + direction * (LOOK_AHEAD * length) } else { w[1] };
            if let Some(hit) = self.first_hit(tip, w[0], to, length) {
                let mut clipped = way[..=k].to_vec();
                clipped.push(self.snapped(&hit, length));
                return (clipped, hit.ending);
            }
        }
        let end = way[way.len() - 1];
        match self.closest(tip, end, CLOSE * length) {
            Some(hit) => {
                let mut lengthened = way.to_vec();
                lengthened.push(self.snapped(&hit, length));
                (lengthened, hit.ending)
            }
            None => (way.to_vec(), Ending::Free),
        }
    }

    fn first_hit(&self, tip: TipId, a: Vector2, b: Vector2, length: f64) -> Option<Hit> {
        // The tip itself stands clear of the boundary by more than this.
        let start = 1e-9 * length / (b - a).norm();
        let mut best: Option<Hit> = None;
        let mut consider = |at: f64, ending: Ending| {
            if at > start && best.is_none_or(|h| at < h.at) {
                best = Some(Hit { at, point: a + (b - a) * at, ending });
            }
        };
        for (edge, curve) in self.model.domain.edges.iter().enumerate() {
            for at in curve.meetings(a, b, 1e-9 * length) {
                consider(at, Ending::Boundary(edge));
            }
        }
        let mut near = vec![];
        let reach = Vector2::repeat(CAPTURE * length);
        let bounds = Aabb::of_points([a, b]);
        self.tree.visit(&Aabb { lower: bounds.lower - reach, upper: bounds.upper + reach }, |i| near.push(i));
        near.sort_unstable();
        for i in near {
            let wall = &self.segments[i as usize];
            if self.is_behind(tip, wall) {
                continue;
            }
            if let Some(at) = crossing(a, b, wall.ends, CAPTURE * length) {
                consider(at, Ending::Crack(wall.crack));
            }
        }
        best
    }

    /// The nearest wall within `reach` of a point.
    fn closest(&self, tip: TipId, p: Vector2, reach: f64) -> Option<Hit> {
        let domain = &self.model.domain;
        let (edge, t) = domain.closest_edge(p);
        let on_boundary = domain.edges[edge].point(t);
        let boundary = Hit { at: (on_boundary - p).norm(), point: on_boundary, ending: Ending::Boundary(edge) };
        let mut best = Some(boundary).filter(|h| h.at <= reach);
        let mut near = vec![];
        self.tree.visit(&Aabb::around(p, Vector2::repeat(reach)), |i| near.push(i));
        near.sort_unstable();
        for i in near {
            let wall = &self.segments[i as usize];
            let point = closest_on_segment(p, wall.ends[0], wall.ends[1]);
            let distance = (point - p).norm();
            if !self.is_behind(tip, wall) && distance <= reach && best.is_none_or(|h| distance < h.at) {
                best = Some(Hit { at: distance, point, ending: Ending::Crack(wall.crack) });
            }
        }
        best
    }

    /// Whether a wall is the segment that the tip ends: it is no obstacle ahead.
    fn is_behind(&self, tip: TipId, wall: &CrackSegment) -> bool {
        let last = match tip.end {
            End::Start => 0,
            End::End => self.model.cracks[tip.crack].vertices.len() - 2,
        };
        wall.crack == tip.crack && wall.index == last
    }

    /// The point of a hit, moved to a vertex or corner that is very near.
    fn snapped(&self, hit: &Hit, length: f64) -> Vector2 {
        let mut places: Vec<Vector2> = vec![];
        match hit.ending {
            Ending::Free => {}
            Ending::Boundary(edge) => {
                let curve = &self.model.domain.edges[edge];
                places.extend([curve.point(0.0), curve.point(1.0)]);
                places.extend(self.model.cracks.iter().flat_map(|c| c.mouths()));
            }
            Ending::Crack(crack) => places.extend(&self.model.cracks[crack].vertices),
        }
        let away = |p: &Vector2| (p - hit.point).norm();
        let nearest = places.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        match (nearest.filter(|p| away(p) <= SNAP * length), hit.ending) {
            (Some(p), _) => p,
            (None, Ending::Boundary(edge)) => self.model.domain.on_edge(edge, hit.point),
            (None, Ending::Free | Ending::Crack(_)) => hit.point,
        }
    }
}

/// Length of a polyline.
pub fn length_of(way: &[Vector2]) -> f64 {
    way.windows(2).map(|w| (w[1] - w[0]).norm()).sum()
}

/// Parameter on `a b` at which it meets a wall that is taken longer by `margin` at both ends.
fn crossing(a: Vector2, b: Vector2, wall: [Vector2; 2], margin: f64) -> Option<f64> {
    let (d, e) = (b - a, wall[1] - wall[0]);
    let turn = cross(d, e);
    if turn.abs() <= 1e-12 * d.norm() * e.norm() {
        return None;
    }
    let (at, along) = (cross(wall[0] - a, e) / turn, cross(wall[0] - a, d) / turn);
    let slack = margin / e.norm();
    ((0.0..=1.0).contains(&at) && (-slack..=1.0 + slack).contains(&along)).then_some(at)
}
