//! What hides nodes from points: cracks, and the boundary where the body is not convex [EFG, section 4.1].

use crate::geometry::curve::Curve;
use crate::geometry::obstacles::Obstacles;
use crate::geometry::predicates::orientation;
use crate::math::{Vector2, cross};
use crate::model::Model;
use crate::nodes::Triangulation;

/// A crack mouth is drawn this much past the boundary, over the length of its first segment, so that no gap is left.
const MOUTH_OVERSHOOT: f64 = 1e-9;

/// Opaque segments of a model under the visibility criterion.
///
/// Arcs are replaced by lines that lie outside the body and touch it at the boundary points: chords of a concave
/// arc, tangents of a convex one. Neighbors on the rim of a hole thus see each other.
pub fn visibility_obstacles(model: &Model, triangulation: &Triangulation) -> Obstacles {
    let mut segments = vec![];
    for crack in &model.cracks {
        let last = crack.vertices.len() - 1;
        for (k, w) in crack.vertices.windows(2).enumerate() {
            let e = (w[1] - w[0]) * MOUTH_OVERSHOOT;
            let start = if k == 0 && !crack.start_is_tip { w[0] - e } else { w[0] };
            let end = if k + 1 == last && !crack.end_is_tip { w[1] + e } else { w[1] };
            segments.push([start, end]);
        }
    }
    for range in &model.domain.loops {
        let outline = boundary_lines(model, triangulation, |edge| range.contains(&edge));
        if !is_convex_outline(&outline) {
            segments.extend(outline);
        }
    }
    Obstacles::new(segments)
}

fn boundary_lines(model: &Model, triangulation: &Triangulation, belongs: impl Fn(usize) -> bool) -> Vec<[Vector2; 2]> {
    let mut lines = vec![];
    for s in triangulation.boundary.iter().filter(|s| belongs(s.edge)) {
        let [a, b] = s.points.map(|c| triangulation.position(c));
        match model.domain.edges[s.edge] {
            Curve::Arc { center, radius, sweep, .. } if sweep > 0.0 => {
                // The tangents at both ends meet on the bisector.
                let middle = (a + b) * 0.5 - center;
                let corner = center + middle * (radius * radius / middle.norm_squared());
                lines.extend([[a, corner], [corner, b]]);
            }
            _ => lines.push([a, b]),
        }
    }
    lines
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
