//! Exact orientation tests (adaptive arithmetic of the `robust` crate).

use crate::math::Vector2;

/// Twice the signed area of the triangle `a b c`, with the sign exact: positive if it is counterclockwise.
#[inline]
pub fn orientation(a: Vector2, b: Vector2, c: Vector2) -> f64 {
    let coord = |p: Vector2| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// Whether the open segments `a b` and `c d` cross at one interior point of both.
///
/// Segments that only touch, or that overlap on one line, do not cross.
#[inline]
pub fn segments_cross(a: Vector2, b: Vector2, c: Vector2, d: Vector2) -> bool {
    let (p, q) = (orientation(a, b, c), orientation(a, b, d));
    if !((p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0)) {
        return false;
    }
    let (p, q) = (orientation(c, d, a), orientation(c, d, b));
    (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0)
}

/// Whether the segment from `a` to `b` is cut by the segment `c d` taken with its end points.
///
/// Passing through an end of `c d` counts, so that a sight line cannot slip between two segments of a chain;
/// ending on `c d` does not.
#[inline]
pub fn segment_is_cut(a: Vector2, b: Vector2, c: Vector2, d: Vector2) -> bool {
    let (p, q) = (orientation(c, d, a), orientation(c, d, b));
    if !((p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0)) {
        return false;
    }
    let (p, q) = (orientation(a, b, c), orientation(a, b, d));
    !((p > 0.0 && q > 0.0) || (p < 0.0 && q < 0.0))
}

/// Distance from `p` to the segment `a b`.
pub fn distance_to_segment(p: Vector2, a: Vector2, b: Vector2) -> f64 {
    (p - closest_on_segment(p, a, b)).norm()
}

/// The point of the segment `a b` that is closest to `p`.
pub fn closest_on_segment(p: Vector2, a: Vector2, b: Vector2) -> Vector2 {
    let e = b - a;
    let length2 = e.norm_squared();
    let t = if length2 > 0.0 { ((p - a).dot(&e) / length2).clamp(0.0, 1.0) } else { 0.0 };
    a + e * t
}

/// Least distance between the segments `a b` and `c d`; zero if they meet.
pub fn distance_between_segments(a: Vector2, b: Vector2, c: Vector2, d: Vector2) -> f64 {
    if segments_cross(a, b, c, d) {
        return 0.0;
    }
    distance_to_segment(a, c, d)
        .min(distance_to_segment(b, c, d))
        .min(distance_to_segment(c, a, b))
        .min(distance_to_segment(d, a, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn v(x: f64, y: f64) -> Vector2 {
        Vector2::new(x, y)
    }

    #[test]
    fn crossing_touching_and_apart() {
        assert!(segments_cross(v(0., 0.), v(1., 1.), v(0., 1.), v(1., 0.)));
        assert!(!segments_cross(v(0., 0.), v(1., 1.), v(0.5, 0.5), v(1., 0.)));
        assert!(!segments_cross(v(0., 0.), v(1., 0.), v(0., 1.), v(1., 1.)));
        assert!(!segments_cross(v(0., 0.), v(1., 0.), v(0.5, 0.), v(2., 0.)));
    }

    #[test]
    fn sight_through_an_end_is_cut_but_touching_is_not() {
        assert!(segment_is_cut(v(-1., 0.), v(1., 0.), v(0., 0.), v(0., 1.)));
        assert!(!segment_is_cut(v(-1., 0.), v(0., 0.), v(0., -1.), v(0., 1.)));
        assert!(!segment_is_cut(v(-1., 0.), v(1., 0.), v(0., 1e-300), v(0., 1.)));
    }
}
