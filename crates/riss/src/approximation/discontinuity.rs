//! What hides nodes from points: cracks, and the boundary where the body is not convex [EFG, section 4.1].

use crate::crack::EndKind;
use crate::geometry::curve::Curve;
use crate::geometry::obstacles::Obstacles;
use crate::geometry::predicates::orientation;
use crate::math::{Vector2, cross};
use crate::model::Model;
use crate::nodes::{BoundarySegment, Triangulation};

/// A crack mouth is drawn this much past the boundary, over the length of its first segment, so that no gap is left.
const MOUTH_OVERSHOOT: f64 = 1e-9;

/// How deep the lines behind a concave arc are sunk, in multiples of the angle between two neighbors on it.
///
/// Plain chords would hide the next but one node on the rim, and stress there would come from one side only.
const SINK: f64 = 1.5;

/// Opaque segments of a model under the visibility criterion.
///
/// Arcs are replaced by lines that lie outside the body: tangents of a convex arc, which touch it at the boundary
/// points, and a polygon behind a concave one. Neighbors on the rim of a hole thus see each other.
pub fn visibility_obstacles(model: &Model, triangulation: &Triangulation) -> Obstacles {
    let mut segments = vec![];
    for crack in &model.cracks {
        let last = crack.vertices.len() - 1;
        for (k, w) in crack.vertices.windows(2).enumerate() {
            let e = (w[1] - w[0]) * MOUTH_OVERSHOOT;
            let start = if k == 0 && crack.ends[0] == EndKind::Mouth { w[0] - e } else { w[0] };
            let end = if k + 1 == last && crack.ends[1] == EndKind::Mouth { w[1] + e } else { w[1] };
            segments.push([start, end]);
        }
    }
    let mouths: Vec<Vector2> = model.cracks.iter().flat_map(|c| c.mouths()).collect();
    for range in &model.domain.loops {
        let pieces: Vec<&BoundarySegment> = triangulation.boundary.iter().filter(|s| range.contains(&s.edge)).collect();
        let outline = boundary_lines(model, triangulation, &pieces);
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
    Obstacles::new(segments)
}

/// Opaque lines for each piece of a loop, in order.
fn boundary_lines(model: &Model, triangulation: &Triangulation, pieces: &[&BoundarySegment]) -> Vec<Vec<[Vector2; 2]>> {
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
            (Some((a, radius, before)), Some((b, _, after))) if (a - b).norm() <= 1e-9 * radius => {
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
