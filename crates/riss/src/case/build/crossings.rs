//! Where boundaries and cracks meet that must not.

use super::boundary::{Boundary, SAME_POINT};
use super::report::Report;
use crate::geometry::aabb::Aabb;
use crate::geometry::curve::Curve;
use crate::geometry::predicates::{distance_between_segments, distance_to_segment, segments_cross};
use crate::geometry::tree::BoxTree;
use crate::math::Vector2;
use crate::model::Domain;

/// Arcs are flattened to this times the size of the body.
const FLATNESS: f64 = 1e-5;
/// Least ligament between loops, times the size of the body.
const LIGAMENT: f64 = 1e-4;

/// A straight piece of a chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub ends: (Vector2, Vector2),
    /// Which loop or crack.
    pub chain: usize,
    /// Which edge of it.
    pub edge: usize,
}

/// The first pair of segments closer than `tolerance`, in the order of the list, that `counts`.
pub(super) fn first_contact(
    segments: &[Segment],
    tolerance: f64,
    counts: impl Fn(usize, usize) -> bool,
) -> Option<(usize, usize)> {
    let boxes: Vec<_> = segments.iter().map(|s| Aabb::of_points([s.ends.0, s.ends.1])).collect();
    let tree = BoxTree::new(&boxes);
    for (i, s) in segments.iter().enumerate() {
        let margin = Vector2::repeat(tolerance);
        let query = Aabb { lower: boxes[i].lower - margin, upper: boxes[i].upper + margin };
        let mut found: Option<usize> = None;
        tree.visit(&query, |j| {
            let j = j as usize;
            if j > i && found.is_none_or(|f| j < f) && counts(i, j) {
                let t = &segments[j];
                if distance_between_segments(s.ends.0, s.ends.1, t.ends.0, t.ends.1) <= tolerance {
                    found = Some(j);
                }
            }
        });
        if let Some(j) = found {
            return Some((i, j));
        }
    }
    None
}

/// The first vertex of a chain at which it turns back on itself; the chain is closed if its ends meet.
pub(super) fn folds_back(a: &Segment, b: &Segment, tolerance: f64) -> bool {
    distance_to_segment(b.ends.1, a.ends.0, a.ends.1) <= tolerance
        || distance_to_segment(a.ends.0, b.ends.0, b.ends.1) <= tolerance
}

/// Reports edges without length, loops that cross themselves or one another, and holes outside the body.
pub(super) fn check_loops(boundary: &Boundary, report: &mut Report) -> bool {
    let size = boundary.size();
    if !has_usable_size(boundary, size, report) {
        return false;
    }
    let mut sound = true;
    for edge in boundary.loops.iter().flatten() {
        if edge.curve.length() <= SAME_POINT * size {
            report.error(edge.key.clone(), "this edge has no length");
            sound = false;
        }
    }
    if !sound {
        return false;
    }
    let chains: Vec<Vec<Segment>> = (0..boundary.loops.len()).map(|l| flatten(boundary, l, size)).collect();
    for chain in &chains {
        sound &= check_simple(boundary, chain, SAME_POINT * size, report);
    }
    sound && check_apart(boundary, &chains, size, report)
}

fn has_usable_size(boundary: &Boundary, size: f64, report: &mut Report) -> bool {
    let edges = || boundary.loops.iter().flatten().map(|e| e.curve.aabb());
    let reach = edges().fold(0.0, |r: f64, b| r.max(b.lower.amax()).max(b.upper.amax()));
    // Beyond this, squares and products overflow or vanish, and distances lose all digits.
    let usable = reach < 1e60 && size > 1e-60 && size > 1e-9 * reach;
    if !usable {
        report.error("geometry", "the body is too large, too small, or too far from the origin for its size");
    }
    usable
}

fn flatten(boundary: &Boundary, chain: usize, size: f64) -> Vec<Segment> {
    let mut segments = vec![];
    for (edge, e) in boundary.loops[chain].iter().enumerate() {
        let points = e.curve.flattened(FLATNESS * size);
        segments.extend(points.windows(2).map(|w| Segment { ends: (w[0], w[1]), chain, edge }));
    }
    segments
}

fn check_simple(boundary: &Boundary, chain: &[Segment], tolerance: f64, report: &mut Report) -> bool {
    let n = chain.len();
    let neighbors = |i: usize, j: usize| j == i + 1 || (i == 0 && j == n - 1);
    let contact = first_contact(chain, tolerance, |i, j| !neighbors(i, j))
        .or_else(|| (0..n).map(|i| (i, (i + 1) % n)).find(|&(i, j)| folds_back(&chain[i], &chain[j], tolerance)));
    if let Some((i, j)) = contact {
        let edges = &boundary.loops[chain[i].chain];
        let (a, b) = (&edges[chain[i].edge], &edges[chain[j].edge]);
        let p = chain[j].ends.0;
        let which = if chain[i].chain == 0 { "outline" } else { "hole" };
        let message = format!("the {which} crosses or touches itself near ({:.6}, {:.6})", p.x, p.y);
        report.error(a.key.clone(), message).suggest(format!("see {} and {}", a.key, b.key));
    }
    contact.is_none()
}

fn check_apart(boundary: &Boundary, chains: &[Vec<Segment>], size: f64, report: &mut Report) -> bool {
    let all: Vec<Segment> = chains.iter().flatten().copied().collect();
    let key = |l: usize| boundary.loops[l][0].key.clone();
    let name = |l: usize| &boundary.names[boundary.loops[l][0].parts[0]];
    if let Some((i, j)) = first_contact(&all, LIGAMENT * size, |i, j| all[i].chain != all[j].chain) {
        let (s, t) = (&all[i], &all[j]);
        let cuts = segments_cross(s.ends.0, s.ends.1, t.ends.0, t.ends.1);
        let verb = if cuts { "crosses" } else { "touches" };
        let other = if s.chain == 0 { "the outline".to_string() } else { format!("the hole `{}`", name(s.chain)) };
        let p = t.ends.0;
        let message = format!("this hole {verb} {other} near ({:.6}, {:.6})", p.x, p.y);
        report.error(key(t.chain), message).suggest("leave material between them, or draw one outline around both");
        return false;
    }
    let mut sound = true;
    for (l, edges) in boundary.loops.iter().enumerate().skip(1) {
        let inside = |other: usize, l: usize| contains(boundary, other, boundary.loops[l][0].curve.point(0.0));
        if !inside(0, l) {
            report.error(edges[0].key.clone(), "this hole lies outside the body");
            sound = false;
        } else if let Some(other) = (1..boundary.loops.len()).find(|&o| o != l && inside(o, l)) {
            let message = format!("this hole lies inside the hole `{}`", name(other));
            report.error(edges[0].key.clone(), message);
            sound = false;
        }
    }
    sound
}

fn contains(boundary: &Boundary, l: usize, p: Vector2) -> bool {
    let edges: Vec<Curve> = boundary.loops[l].iter().map(|e| e.curve).collect();
    let loops = std::iter::once(0..edges.len()).collect();
    Domain { edges, loops, parts: vec![] }.contains(p)
}
