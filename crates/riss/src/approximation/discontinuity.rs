//! What stands between nodes and points: cracks, and the boundary where the body is not convex [EFG, section 4].

use super::fade::Fade;
use super::settings::{CrackSmoothing, HoleSmoothing, SmoothingSettings};
use crate::crack::meetings::shared_vertices;
use crate::crack::{CrackPath, End, EndKind};
use crate::geometry::curve::Curve;
use crate::geometry::geodesics::{Bend, Corners};
use crate::geometry::obstacles::Obstacles;
use crate::geometry::predicates::orientation;
use crate::math::{Vector2, cross};
use crate::model::Model;
use crate::nodes::triangulation::{PointCopy, SIGHT_SHIFT};
use crate::nodes::{BoundarySegment, Triangulation};
use std::f64::consts::PI;

/// A crack mouth is drawn this much past the boundary, over the length of its first segment, so that no gap is left.
const MOUTH_OVERSHOOT: f64 = 1e-9;

/// How deep the lines behind a concave arc are sunk, in multiples of the angle between two neighbors on it.
///
/// Plain chords would hide the next but one node on the rim, and stress there would come from one side only.
const SINK: f64 = 1.5;

/// Sectors of material that are wider than a half turn by more than this are corners to bend around [rad].
///
/// Flatter ones hide nothing: points of view are shifted by more.
const BEND: f64 = 1e-8;

/// Obstacles, corners around which nodes act, and what is transparent.
#[derive(Clone, Debug)]
pub struct Barriers {
    /// What sight lines cannot pass.
    pub(super) obstacles: Obstacles,
    /// Where ways bend around them.
    pub(super) corners: Corners,
    /// All obstacles and corners, where some of them are seen through.
    pub(super) links: Option<(Obstacles, Corners)>,
    /// For each obstacle, where it is transparent; empty if none is.
    pub(super) fades: Vec<Option<Fade>>,
    /// Exponent of the detour.
    pub(super) lambda: f64,
}

impl From<Obstacles> for Barriers {
    /// Opaque obstacles that no way leads around.
    fn from(obstacles: Obstacles) -> Self {
        Self { obstacles, corners: Corners::new(vec![]), links: None, fades: vec![], lambda: 1.0 }
    }
}

/// Where the lines of a concave arc are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rim {
    /// Behind the boundary.
    Sunk,
    /// From node to node.
    Chords,
}

/// Opaque segments of a model under the visibility criterion.
///
/// Arcs are replaced by lines that lie outside the body: tangents of a convex arc, which touch it at the boundary
/// points, and a polygon behind a concave one. Neighbors on the rim of a hole thus see each other.
pub fn visibility_obstacles(model: &Model, triangulation: &Triangulation) -> Obstacles {
    let cracks = model.cracks.iter().flat_map(|c| crack_lines(c, &overshoot));
    Obstacles::new(cracks.chain(outlines(model, triangulation, Rim::Sunk)).collect())
}

/// Obstacles and corners of a model for a choice of smoothing.
pub fn barriers(model: &Model, triangulation: &Triangulation, smoothing: &SmoothingSettings) -> Barriers {
    let (cracks, holes) = (smoothing.cracks(), smoothing.holes());
    let through_hole = |p: Vector2, outward: Vector2| through_void(model, p, outward);
    let past_mouth: PastMouth = if holes == HoleSmoothing::SeeThrough { &through_hole } else { &overshoot };
    let mut lines: Vec<[Vector2; 2]> = vec![];
    let mut fades = vec![];
    let shared: Vec<Vector2> = shared_vertices(&model.cracks).into_iter().map(|m| m.place).collect();
    for crack in &model.cracks {
        let own = crack_lines(crack, past_mouth);
        match cracks {
            CrackSmoothing::Visibility | CrackSmoothing::Diffraction { .. } => lines.extend(own),
            CrackSmoothing::Transparency { kappa, lambda } => {
                fades.extend(crack_fades(crack, &own, triangulation, &shared, [kappa, lambda]));
                lines.extend(own);
            }
            CrackSmoothing::SeeThrough => {}
        }
    }
    match holes {
        HoleSmoothing::Visibility => lines.extend(outlines(model, triangulation, Rim::Sunk)),
        HoleSmoothing::Diffraction { .. } => lines.extend(outlines(model, triangulation, Rim::Chords)),
        HoleSmoothing::SeeThrough => {}
    }
    if !fades.is_empty() {
        fades.resize(lines.len(), None);
    }
    let sees_through = cracks == CrackSmoothing::SeeThrough || holes == HoleSmoothing::SeeThrough;
    let links = sees_through.then(|| {
        let cracks = model.cracks.iter().flat_map(|c| crack_lines(c, &overshoot));
        let all = cracks.chain(outlines(model, triangulation, Rim::Chords)).collect();
        (Obstacles::new(all), Corners::new(corners(triangulation, |_| Some(Bend::Every))))
    });
    let bends = |corner: &Corner| match (corner.is_on_boundary, cracks) {
        (true, _) => matches!(holes, HoleSmoothing::Diffraction { .. }).then_some(Bend::Every),
        (false, CrackSmoothing::Diffraction { .. }) => Some(Bend::Every),
        // Whoever sees the tip sees through the crack.
        (false, CrackSmoothing::Transparency { .. }) if corner.is_tip => Some(Bend::Hidden),
        (false, CrackSmoothing::Transparency { .. }) => Some(Bend::Every),
        (false, CrackSmoothing::Visibility | CrackSmoothing::SeeThrough) => None,
    };
    let lambda = match (cracks, holes) {
        // The shortest of ways with shades is continuous as it is, not with an exponent.
        (CrackSmoothing::Transparency { .. }, _) => 1.0,
        (CrackSmoothing::Diffraction { lambda }, _) | (_, HoleSmoothing::Diffraction { lambda }) => lambda,
        (_, HoleSmoothing::Visibility | HoleSmoothing::SeeThrough) => 1.0,
    };
    let mut corners = corners(triangulation, bends);
    if holes == HoleSmoothing::SeeThrough && !matches!(cracks, CrackSmoothing::Visibility | CrackSmoothing::SeeThrough)
    {
        corners.extend(model.cracks.iter().flat_map(|c| far_ends(model, c)).map(|p| (p, Bend::Every)));
    }
    let corners = Corners::new(corners);
    Barriers { obstacles: Obstacles::new(lines), corners, links, fades, lambda }
}

/// A point of the triangulation with a sector of material wider than a half turn.
struct Corner {
    is_on_boundary: bool,
    is_tip: bool,
}

/// Places slightly inside the sectors of all corners that `bends` selects.
fn corners(triangulation: &Triangulation, bends: impl Fn(&Corner) -> Option<Bend>) -> Vec<(Vector2, Bend)> {
    let mut is_on_boundary = vec![false; triangulation.copies.len()];
    triangulation.boundary.iter().flat_map(|s| s.points).for_each(|c| is_on_boundary[c as usize] = true);
    let place = |copy: &PointCopy| {
        let point = copy.point as usize;
        triangulation.positions[point] + copy.middle * (SIGHT_SHIFT * triangulation.edge_length[point])
    };
    let corner = |(copy, is_on_boundary): (&PointCopy, bool)| {
        let is_wide = copy.opening > PI + BEND && copy.middle != Vector2::zeros();
        let is_tip = copy.sight == triangulation.positions[copy.point as usize];
        let bend = is_wide.then(|| bends(&Corner { is_on_boundary, is_tip }))?;
        Some((place(copy), bend?))
    };
    triangulation.copies.iter().zip(is_on_boundary).filter_map(corner).collect()
}

/// How far a crack is drawn past a mouth, from the mouth and the way from the first vertex inside to it.
type PastMouth<'a> = &'a dyn Fn(Vector2, Vector2) -> Vector2;

fn overshoot(_: Vector2, outward: Vector2) -> Vector2 {
    outward * MOUTH_OVERSHOOT
}

/// From a mouth straight on to the far side of the hole, so that nothing sees around the mouth through it.
pub(super) fn through_void(model: &Model, mouth: Vector2, outward: Vector2) -> Vector2 {
    let size = model.domain.aabb().size().norm();
    let all = outward.normalize() * size;
    let cuts = model.domain.edges.iter().flat_map(|e| e.meetings(mouth, mouth + all, 1e-9 * size));
    all * cuts.filter(|t| *t > 1e-6).fold(1.0, f64::min)
}

/// Where the lines of a crack through holes end, moved slightly on into the body: corners like tips.
fn far_ends(model: &Model, crack: &CrackPath) -> Vec<Vector2> {
    let ends = [End::Start, End::End].into_iter().filter(|e| crack.end_kind(*e) == EndKind::Mouth);
    let far = |end: End| {
        let path = crack.from_end(end);
        path[0] + through_void(model, path[0], path[0] - path[1]) * (1.0 + SIGHT_SHIFT)
    };
    ends.map(far).collect()
}

/// The segments of a crack, longer at its mouths.
fn crack_lines(crack: &CrackPath, past_mouth: PastMouth) -> Vec<[Vector2; 2]> {
    let mut lines: Vec<[Vector2; 2]> = crack.segments().map(|(a, b)| [a, b]).collect();
    let last = lines.len() - 1;
    if crack.end_kind(End::Start) == EndKind::Mouth {
        let [a, b] = lines[0];
        lines[0][0] = a + past_mouth(a, a - b);
    }
    if crack.end_kind(End::End) == EndKind::Mouth {
        let [a, b] = lines[last];
        lines[last][1] = b + past_mouth(b, b - a);
    }
    lines
}

/// Where each of the lines of a crack is transparent.
fn crack_fades(
    crack: &CrackPath,
    lines: &[[Vector2; 2]],
    triangulation: &Triangulation,
    shared: &[Vector2],
    [kappa, lambda]: [f64; 2],
) -> Vec<Option<Fade>> {
    let total = crack.length();
    let depth = |end: End| {
        let tip = crack.end_position(end);
        let point = triangulation.positions.iter().position(|p| *p == tip)?;
        // Not beyond where others meet the crack: they would hide at once what is seen through it.
        let arm = arm_length(&crack.from_end(end), shared);
        (crack.end_kind(end) == EndKind::Tip).then(|| arm.min(kappa * triangulation.edge_length[point]))
    };
    let (start, end) = (depth(End::Start), depth(End::End));
    let mut before = 0.0;
    let mut fades = vec![];
    for (&[a, b], (from, to)) in lines.iter().zip(crack.segments()) {
        let along = before - (a - from).norm();
        let tips = [start.map(|depth| [along, 1.0, depth]), end.map(|depth| [total - along, -1.0, depth])];
        fades.push(Some(Fade::new(a, b, tips.into_iter().flatten().collect(), lambda)));
        before += (to - from).norm();
    }
    fades
}

/// Length from the start of a path to its first vertex that belongs to other cracks too, or to its end.
fn arm_length(path: &[Vector2], shared: &[Vector2]) -> f64 {
    let mut length = 0.0;
    for w in path.windows(2) {
        length += (w[1] - w[0]).norm();
        if shared.contains(&w[1]) {
            break;
        }
    }
    length
}

/// Opaque lines along all loops that are not convex.
fn outlines(model: &Model, triangulation: &Triangulation, rim: Rim) -> Vec<[Vector2; 2]> {
    let mut segments = vec![];
    let mouths: Vec<Vector2> = model.cracks.iter().flat_map(|c| c.mouths()).collect();
    for range in &model.domain.loops {
        let pieces: Vec<&BoundarySegment> = triangulation.boundary.iter().filter(|s| range.contains(&s.edge)).collect();
        let outline = boundary_lines(model, triangulation, &pieces, rim);
        if !is_convex_outline(&outline.concat()) {
            // A crack that starts on a concave arc goes on to the sunk line: nothing sees around its mouth.
            for (piece, lines) in pieces.iter().zip(&outline) {
                let p = triangulation.position(piece.points[0]);
                let near =
                    1e-6 * triangulation.edge_length[triangulation.copies[piece.points[0] as usize].point as usize];
                if lines[0][0] != p && mouths.iter().any(|m| (m - p).norm() <= near) {
                    segments.push([p, lines[0][0]]);
                }
            }
            segments.extend(outline.concat());
        }
    }
    segments
}

/// Opaque lines for each piece of a loop, in order.
fn boundary_lines(
    model: &Model,
    triangulation: &Triangulation,
    pieces: &[&BoundarySegment],
    rim: Rim,
) -> Vec<Vec<[Vector2; 2]>> {
    let n = pieces.len();
    let concave = |s: &BoundarySegment| match model.domain.edges[s.edge] {
        Curve::Arc { center, radius, sweep, .. } if sweep < 0.0 => {
            Some((center, radius, (sweep * (s.range[1] - s.range[0])).abs()))
        }
        _ => None,
    };
    // The corner that starts each piece, moved toward the center inside a concave arc, but not where it ends.
    let corner = |i: usize| {
        let p = triangulation.position(pieces[i % n].points[0]);
        match (concave(pieces[(i + n - 1) % n]), concave(pieces[i % n])) {
            (Some((a, radius, before)), Some((b, _, after))) if rim == Rim::Sunk && (a - b).norm() <= 1e-9 * radius => {
                let turn = (SINK * before.max(after)).min(1.2);
                b + (p - b) * turn.cos()
            }
            _ => p,
        }
    };
    (0..n)
        .map(|i| match model.domain.edges[pieces[i].edge] {
            Curve::Arc { center, radius, sweep, .. } if sweep > 0.0 => {
                let [a, b] = pieces[i].points.map(|c| triangulation.position(c));
                // The tangents at both ends meet on the bisector.
                let middle = (a + b) * 0.5 - center;
                let meeting = center + middle * (radius * radius / middle.norm_squared());
                vec![[a, meeting], [meeting, b]]
            }
            Curve::Arc { .. } => vec![[corner(i), corner(i + 1)]],
            Curve::Line { .. } => {
                let [a, b] = pieces[i].points.map(|c| triangulation.position(c));
                vec![[a, b]]
            }
        })
        .collect()
}

/// Whether a closed outline, body to its left, never turns right: nothing can then hide behind it.
fn is_convex_outline(lines: &[[Vector2; 2]]) -> bool {
    let n = lines.len();
    let turns_left = (0..n).all(|i| {
        let ([a, b], [_, c]) = (lines[i], lines[(i + 1) % n]);
        // Rounding may bend a straight side a little.
        cross(b - a, c - b) >= -1e-9 * (b - a).norm() * (c - b).norm() || orientation(a, b, c) >= 0.0
    });
    let area: f64 = lines.iter().map(|[a, b]| cross(*a - lines[0][0], *b - lines[0][0])).sum();
    turns_left && area > 0.0
}
