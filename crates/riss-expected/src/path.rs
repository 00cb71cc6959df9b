//! How far a computed crack path lies from a reference path.

use std::ops::RangeInclusive;

/// `[x, y]`.
pub type Point = [f64; 2];

/// Samples per segment: the farthest point of a polyline from another need not be a vertex.
const SAMPLES: usize = 16;

/// The part of the plane in which paths are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    /// Range of x.
    pub x: RangeInclusive<f64>,
    /// Range of y.
    pub y: RangeInclusive<f64>,
}

impl Default for Window {
    fn default() -> Self {
        let all = f64::NEG_INFINITY..=f64::INFINITY;
        Self { x: all.clone(), y: all }
    }
}

/// Reads a path: lines of `x,y`; comments begin with `#`, and a heading `x,y` is skipped.
///
/// # Errors
/// Says which line is no point, or that there are fewer than two.
pub fn parse(text: &str) -> Result<Vec<Point>, String> {
    let mut path = vec![];
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') || line == "x,y" {
            continue;
        }
        let numbers: Vec<f64> = line.split(',').filter_map(|n| n.trim().parse().ok()).collect();
        match numbers[..] {
            [x, y] if x.is_finite() && y.is_finite() => path.push([x, y]),
            _ => return Err(format!("line {}: `{line}` is no point", i + 1)),
        }
    }
    if path.len() < 2 { Err("a path needs two points".into()) } else { Ok(path) }
}

/// Symmetric Hausdorff distance of two paths over their common extent.
///
/// Both begin at the mouth. Each is cut to its first stretch within the window; what then sticks out at the start is
/// cut off, since a reference may begin outside the body. At the end a computed path may be longer; a reference may stick
/// out by its last segment, which may overshoot what stops the crack, but not by more: a crack that stops early is far off.
///
/// `None` if one of them is not in the window at all.
pub fn distance(computed: &[Point], reference: &[Point], window: &Window) -> Option<f64> {
    let (mut a, _) = clip(computed, window)?;
    let (mut b, is_cut) = clip(reference, window)?;
    let (starts_a, starts_b) = (nearest(b[0], &a).1, nearest(a[0], &b).1);
    (a, b) = (stretch(&a, starts_a, (a.len() - 1) as f64), stretch(&b, starts_b, (b.len() - 1) as f64));
    let last_b = (b.len() - 1) as f64;
    let ends_a = nearest(b[b.len() - 1], &a).1;
    let ends_b = nearest(a[a.len() - 1], &b).1.max(last_b - if is_cut { 0.0 } else { 1.0 });
    (a, b) = (stretch(&a, 0.0, ends_a), stretch(&b, 0.0, ends_b));
    Some(farthest(&a, &b).max(farthest(&b, &a)))
}

/// The first stretch within the window, and whether its end is cut.
fn clip(path: &[Point], window: &Window) -> Option<(Vec<Point>, bool)> {
    let mut kept: Vec<Point> = vec![];
    for (i, w) in path.windows(2).enumerate() {
        match inside(w[0], w[1], window) {
            Some([from, to]) => {
                if kept.is_empty() {
                    kept.push(between(w[0], w[1], from));
                }
                kept.push(between(w[0], w[1], to));
                if to < 1.0 {
                    return Some((kept, true));
                }
            }
            None if kept.is_empty() => {}
            None => return Some((kept, i + 2 < path.len())),
        }
    }
    (kept.len() >= 2).then_some((kept, false))
}

/// Parameters on a segment between which it is in the window.
fn inside(p: Point, q: Point, window: &Window) -> Option<[f64; 2]> {
    let mut range = [0.0, 1.0];
    for (k, bounds) in [&window.x, &window.y].into_iter().enumerate() {
        let d = q[k] - p[k];
        let (low, high) = (bounds.start() - p[k], bounds.end() - p[k]);
        if d == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (enter, leave) = if d > 0.0 { (low / d, high / d) } else { (high / d, low / d) };
        range = [f64::max(range[0], enter), f64::min(range[1], leave)];
    }
    (range[0] < range[1]).then_some(range)
}

fn between(p: Point, q: Point, t: f64) -> Point {
    if t == 1.0 { q } else { [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])] }
}

/// Distance of a point from a path, and where: the number of the segment plus the parameter on it.
fn nearest(point: Point, path: &[Point]) -> (f64, f64) {
    let mut best = (f64::INFINITY, 0.0);
    for (i, w) in path.windows(2).enumerate() {
        let d = [w[1][0] - w[0][0], w[1][1] - w[0][1]];
        let r = [point[0] - w[0][0], point[1] - w[0][1]];
        let squared = d[0] * d[0] + d[1] * d[1];
        let t = if squared == 0.0 { 0.0 } else { ((r[0] * d[0] + r[1] * d[1]) / squared).clamp(0.0, 1.0) };
        let distance = f64::hypot(r[0] - t * d[0], r[1] - t * d[1]);
        if distance < best.0 {
            best = (distance, i as f64 + t);
        }
    }
    best
}

/// The path between two places as [`nearest`] names them; a point twice if they are the same.
fn stretch(path: &[Point], from: f64, to: f64) -> Vec<Point> {
    let at = |u: f64| {
        let i = (u as usize).min(path.len() - 2);
        between(path[i], path[i + 1], u - i as f64)
    };
    let inner = path.iter().enumerate().filter(|(i, _)| *i as f64 > from && (*i as f64) < to).map(|(_, p)| *p);
    std::iter::once(at(from)).chain(inner).chain([at(to.max(from))]).collect()
}

/// The distance from `other` of the point of `path` that is farthest from it.
fn farthest(path: &[Point], other: &[Point]) -> f64 {
    let samples = path.windows(2).flat_map(|w| (0..=SAMPLES).map(|k| between(w[0], w[1], k as f64 / SAMPLES as f64)));
    samples.map(|p| nearest(p, other).0).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: fn() -> Window = Window::default;

    fn check_distance(computed: &[Point], reference: &[Point], window: Window, expected: f64) {
        let found = distance(computed, reference, &window).unwrap();
        assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
    }

    #[test]
    fn the_farthest_point_counts_from_both_sides() {
        let line = [[0.0, 0.0], [4.0, 0.0]];
        check_distance(&line, &line, ALL(), 0.0);
        check_distance(&[[0.0, 0.3], [4.0, 0.3]], &line, ALL(), 0.3);
        // A spike that only one of them has, as computed path and as reference.
        let spike = [[0.0, 0.0], [1.9, 0.0], [2.0, 0.7], [2.1, 0.0], [4.0, 0.0]];
        check_distance(&spike, &line, ALL(), 0.7);
        check_distance(&line, &spike, ALL(), 0.7);
        // No vertex is far: the middle of the upper side is 1 from both legs of the other.
        let detour = [[0.0, 0.0], [0.0, 1.0], [2.0, 1.0], [2.0, 0.0]];
        check_distance(&detour, &[[0.0, 0.0], [0.0, 1.0], [0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 0.0]], ALL(), 1.0);
    }

    #[test]
    fn mouth_extensions_and_overshoots_do_not_count() {
        let computed = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.1], [2.5, 0.1]];
        let reference = [[-0.5, 0.0], [1.0, 0.0], [2.0, 0.1], [3.0, 0.1]];
        check_distance(&computed, &reference, ALL(), 0.0);
        // A computed path that goes on is compared as far as the reference reaches.
        check_distance(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.1], [3.0, 0.1], [9.0, 5.0]], &reference, ALL(), 0.0);
    }

    #[test]
    fn a_crack_that_stops_early_is_far_off() {
        let reference = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [4.0, 0.0]];
        check_distance(&[[0.0, 0.0], [1.5, 0.0]], &reference, ALL(), 1.5);
        let window = Window { x: 0.0..=2.5, ..ALL() };
        check_distance(&[[0.0, 0.0], [1.5, 0.0]], &reference, window.clone(), 1.0);
        check_distance(&[[0.0, 0.0], [2.6, 0.0]], &reference, window, 0.0);
    }

    #[test]
    fn only_the_window_is_compared() {
        let reference = [[0.0, 0.0], [2.0, 0.0], [2.0, 3.0]];
        let computed = [[0.0, 0.1], [2.0, 0.1], [2.0, 1.0], [5.0, 9.0]];
        check_distance(&computed, &reference, Window { y: -1.0..=1.0, ..ALL() }, 0.1);
        check_distance(&computed, &reference, Window { x: 0.5..=1.5, y: -1.0..=1.0 }, 0.1);
        assert_eq!(distance(&computed, &reference, &Window { x: 7.0..=8.0, ..ALL() }), None);
    }

    #[test]
    fn paths_are_read_and_refused() {
        assert_eq!(parse("# by hand\nx,y\n1.0, 2\n-3e-1,4\n").unwrap(), [[1.0, 2.0], [-0.3, 4.0]]);
        assert!(parse("1,2\n3\n").unwrap_err().contains("line 2"));
        assert!(parse("1,2\n").unwrap_err().contains("two points"));
    }
}
