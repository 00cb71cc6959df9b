//! How far two polylines lie apart.

use crate::math::Vector2;

/// Samples on each segment: the farthest point of a polyline from another need not be a vertex.
const SAMPLES: usize = 32;

/// Symmetric Hausdorff distance of two paths over their common extent: what sticks out at the ends is cut off, where the
/// end of the other one is nearest. Zero for paths of less than two points.
pub fn path_distance(a: &[Vector2], b: &[Vector2]) -> f64 {
    if a.len() < 2 || b.len() < 2 {
        return 0.0;
    }
    let (first, last) = (|p: &[Vector2]| p[0], |p: &[Vector2]| p[p.len() - 1]);
    let trimmed_a = stretch(a, nearest(first(b), a).1, nearest(last(b), a).1);
    let trimmed_b = stretch(b, nearest(first(a), b).1, nearest(last(a), b).1);
    farthest(&trimmed_a, b).max(farthest(&trimmed_b, a))
}

/// Length of a polyline [length].
pub fn path_length(path: &[Vector2]) -> f64 {
    path.windows(2).map(|w| (w[1] - w[0]).norm()).sum()
}

/// Distance of a point from a path, and where: the number of the segment plus the parameter on it.
fn nearest(p: Vector2, path: &[Vector2]) -> (f64, f64) {
    let mut best = (f64::INFINITY, 0.0);
    for (i, w) in path.windows(2).enumerate() {
        let (d, r) = (w[1] - w[0], p - w[0]);
        let squared = d.norm_squared();
        let t = if squared == 0.0 { 0.0 } else { (r.dot(&d) / squared).clamp(0.0, 1.0) };
        let distance = (r - d * t).norm();
        if distance < best.0 {
            best = (distance, i as f64 + t);
        }
    }
    best
}

/// The path between two places as [`nearest`] names them; a point twice if the second is not behind the first.
fn stretch(path: &[Vector2], from: f64, to: f64) -> Vec<Vector2> {
    let at = |u: f64| {
        let i = (u as usize).min(path.len() - 2);
        path[i] + (path[i + 1] - path[i]) * (u - i as f64)
    };
    let inner = path.iter().enumerate().filter(|(i, _)| *i as f64 > from && (*i as f64) < to).map(|(_, p)| *p);
    std::iter::once(at(from)).chain(inner).chain([at(to.max(from))]).collect()
}

/// The distance from `other` of the point of `path` that is farthest from it.
fn farthest(path: &[Vector2], other: &[Vector2]) -> f64 {
    let samples =
        path.windows(2).flat_map(|w| (0..=SAMPLES).map(|k| w[0] + (w[1] - w[0]) * (k as f64 / SAMPLES as f64)));
    samples.map(|p| nearest(p, other).0).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_distance(a: &[(f64, f64)], b: &[(f64, f64)], expected: f64) {
        let [a, b] = [a, b].map(|p| p.iter().map(|v| Vector2::new(v.0, v.1)).collect::<Vec<_>>());
        for (a, b) in [(&a, &b), (&b, &a)] {
            let found = path_distance(a, b);
            assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
        }
    }

    #[test]
    fn the_farthest_point_counts_from_both_sides() {
        let line = [(0.0, 0.0), (4.0, 0.0)];
        check_distance(&line, &line, 0.0);
        check_distance(&[(0.0, 0.3), (4.0, 0.3)], &line, 0.3);
        check_distance(&[(0.0, 0.0), (1.9, 0.0), (2.0, 0.7), (2.1, 0.0), (4.0, 0.0)], &line, 0.7);
        // The slanted line is cut off beside the end of the other, which lies 4/√17 from it.
        check_distance(&[(0.0, 0.0), (4.0, 1.0)], &line, 4.0 / 17.0f64.sqrt());
    }

    #[test]
    fn what_sticks_out_at_the_ends_does_not_count() {
        check_distance(&[(0.0, 0.0), (1.0, 0.0), (9.0, 5.0)], &[(-0.5, 0.0), (1.0, 0.0)], 0.0);
        check_distance(&[(0.0, 0.1), (3.0, 0.1)], &[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], 0.1);
    }
}
