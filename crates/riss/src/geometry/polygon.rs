//! Simple polygons given by their corners.

use super::aabb::Aabb;
use super::predicates::{orientation, segments_cross};
use crate::math::{Vector2, cross};

/// Signed area; positive if the corners run counterclockwise.
pub fn area(corners: &[Vector2]) -> f64 {
    // Relative to the first corner, so that a far origin costs no digits.
    let origin = corners.first().copied().unwrap_or_default();
    0.5 * edges(corners).map(|(a, b)| cross(a - origin, b - origin)).sum::<f64>()
}

/// The edges, last to first corner included.
pub fn edges(corners: &[Vector2]) -> impl Iterator<Item = (Vector2, Vector2)> + '_ {
    (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]))
}

/// Whether `p` lies inside (even-odd rule, exact orientation); points on the boundary may fall either way.
pub fn contains(corners: &[Vector2], p: Vector2) -> bool {
    let mut inside = false;
    for (a, b) in edges(corners) {
        if (a.y > p.y) != (b.y > p.y) {
            let left = orientation(a, b, p) > 0.0;
            if left == (b.y > a.y) {
                inside = !inside;
            }
        }
    }
    inside
}

/// Whether the polygon is convex (collinear corners allowed).
pub fn is_convex(corners: &[Vector2]) -> bool {
    let n = corners.len();
    let sign = area(corners).signum();
    (0..n).all(|i| sign * orientation(corners[i], corners[(i + 1) % n], corners[(i + 2) % n]) >= 0.0)
}

/// The first two edges that cross, by index, if any.
pub fn self_crossing(corners: &[Vector2]) -> Option<(usize, usize)> {
    let list: Vec<_> = edges(corners).collect();
    for i in 0..list.len() {
        for j in i + 1..list.len() {
            if segments_cross(list[i].0, list[i].1, list[j].0, list[j].1) {
                return Some((i, j));
            }
        }
    }
    None
}

/// The part of a polygon inside a box, half plane by half plane [Sutherland1974]; pieces that fall apart stay joined along
/// the sides of the box.
pub fn clipped(corners: &[Vector2], bounds: &Aabb<2>) -> Vec<Vector2> {
    let mut polygon = corners.to_vec();
    for axis in 0..2 {
        for (bound, sign) in [(bounds.lower[axis], 1.0), (bounds.upper[axis], -1.0)] {
            let depth = |p: &Vector2| sign * (p[axis] - bound);
            let mut kept = Vec::with_capacity(polygon.len() + 1);
            for (p, q) in edges(&polygon) {
                let (dp, dq) = (depth(&p), depth(&q));
                if dp >= 0.0 {
                    kept.push(p);
                }
                if (dp > 0.0 && dq < 0.0) || (dp < 0.0 && dq > 0.0) {
                    let mut cut = p + (q - p) * (dp / (dp - dq));
                    cut[axis] = bound;
                    kept.push(cut);
                }
            }
            polygon = kept;
        }
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<Vector2> {
        [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)].map(|(x, y)| Vector2::new(x, y)).to_vec()
    }

    #[test]
    fn square_facts() {
        let s = square();
        assert_eq!(area(&s), 2.0);
        assert!(contains(&s, Vector2::new(1.0, 0.5)) && !contains(&s, Vector2::new(2.5, 0.5)));
        assert!(is_convex(&s) && self_crossing(&s).is_none());
        let mut bow = s.clone();
        bow.swap(2, 3);
        assert!(self_crossing(&bow).is_some());
    }
}
