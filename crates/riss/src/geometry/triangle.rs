//! Triangles in space: tests with exact signs, closest points, where two of them meet.

use super::aabb::Aabb;
use crate::math::Vector3;

/// Corners of a triangle.
pub type Triangle = [Vector3; 3];

/// Six times the signed volume of the tetrahedron `a b c d`, with the sign exact: positive if `a b c` runs
/// counterclockwise as seen from `d`, that is, if `d` lies on the side that the normal of the triangle points to.
#[inline]
pub fn orientation3(a: Vector3, b: Vector3, c: Vector3, d: Vector3) -> f64 {
    let coord = |p: Vector3| robust::Coord3D { x: p.x, y: p.y, z: p.z };
    -robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// Normal of a triangle, twice its area long.
#[inline]
pub fn area_vector([a, b, c]: Triangle) -> Vector3 {
    (b - a).cross(&(c - a))
}

/// Least box around a triangle.
#[inline]
pub fn bounds(triangle: Triangle) -> Aabb<3> {
    Aabb::of_points(triangle)
}

/// Whether the segment from `p` to `q` is cut by a triangle taken with its edges.
///
/// Passing through an edge or a corner counts, so that a sight line cannot slip between two triangles of a surface;
/// ending on the triangle does not, nor does running within its plane.
#[inline]
pub fn cuts_segment([a, b, c]: Triangle, p: Vector3, q: Vector3) -> bool {
    let (above, below) = (orientation3(a, b, c, p), orientation3(a, b, c, q));
    if !((above > 0.0 && below < 0.0) || (above < 0.0 && below > 0.0)) {
        return false;
    }
    let turns = [orientation3(p, q, a, b), orientation3(p, q, b, c), orientation3(p, q, c, a)];
    turns.iter().all(|t| *t >= 0.0) || turns.iter().all(|t| *t <= 0.0)
}

/// Where on a triangle a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// Inside.
    Face,
    /// On the edge from corner `k` to the next.
    Edge(usize),
    /// At corner `k`.
    Corner(usize),
}

/// The point of a triangle that is closest to `p` [Ericson2005, section 5.1.5].
pub fn closest([a, b, c]: Triangle, p: Vector3) -> (Vector3, Feature) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, Feature::Corner(0));
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, Feature::Corner(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3 {
        return (a + ab * (d1 / (d1 - d3)), Feature::Edge(0));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, Feature::Corner(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6 {
        return (a + ac * (d2 / (d2 - d6)), Feature::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 && (d4 - d3) + (d5 - d6) > 0.0 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (b + (c - b) * t, Feature::Edge(1));
    }
    let whole = va + vb + vc;
    if !(whole > 0.0) {
        return closest_on_edges([a, b, c], p);
    }
    let scale = 1.0 / whole;
    (a + ab * (vb * scale) + ac * (vc * scale), Feature::Face)
}

/// The same for a triangle that has no area in numbers.
#[cold]
fn closest_on_edges(corners: Triangle, p: Vector3) -> (Vector3, Feature) {
    let on_edge = |k: usize| {
        let (a, e) = (corners[k], corners[(k + 1) % 3] - corners[k]);
        let length2 = e.norm_squared();
        let t = if length2 > 0.0 { ((p - a).dot(&e) / length2).clamp(0.0, 1.0) } else { 0.0 };
        (a + e * t, Feature::Edge(k))
    };
    let mut best = on_edge(0);
    for found in [on_edge(1), on_edge(2)] {
        if (found.0 - p).norm() < (best.0 - p).norm() {
            best = found;
        }
    }
    best
}

/// The segment in which two triangles meet, if they cross.
///
/// Triangles that only touch, and those in one plane, do not cross.
pub fn crossing(first: Triangle, second: Triangle) -> Option<[Vector3; 2]> {
    let in_second = cut_by_plane(first, second)?;
    let in_first = cut_by_plane(second, first)?;
    // Both lie on the line of the two planes; the common part of them is the answer.
    let axis = (in_second[1] - in_second[0]).try_normalize(0.0)?;
    let origin = in_second[0];
    let order = |[p, q]: [Vector3; 2]| {
        let (s, t) = ((p - origin).dot(&axis), (q - origin).dot(&axis));
        if s <= t { [(s, p), (t, q)] } else { [(t, q), (s, p)] }
    };
    let (one, two) = (order(in_second), order(in_first));
    let from = if one[0].0 >= two[0].0 { one[0] } else { two[0] };
    let to = if one[1].0 <= two[1].0 { one[1] } else { two[1] };
    (from.0 < to.0).then_some([from.1, to.1])
}

/// The segment of a triangle in the plane of another.
fn cut_by_plane(triangle: Triangle, [a, b, c]: Triangle) -> Option<[Vector3; 2]> {
    let side = triangle.map(|p| orientation3(a, b, c, p));
    let mut ends = [Vector3::zeros(); 2];
    let mut n = 0;
    for k in 0..3 {
        let l = (k + 1) % 3;
        if side[k] == 0.0 && n < 2 {
            ends[n] = triangle[k];
            n += 1;
        } else if (side[k] < 0.0 && side[l] > 0.0) || (side[k] > 0.0 && side[l] < 0.0) {
            if n == 2 {
                return None;
            }
            // The same point from either direction of the edge.
            let (p, q) = if side[k] < 0.0 { (k, l) } else { (l, k) };
            let t = side[p] / (side[p] - side[q]);
            ends[n] = triangle[p] + (triangle[q] - triangle[p]) * t;
            n += 1;
        }
    }
    (n == 2 && side.iter().any(|s| *s != 0.0)).then_some(ends)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn v(x: f64, y: f64, z: f64) -> Vector3 {
        Vector3::new(x, y, z)
    }

    const UNIT: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    fn unit() -> Triangle {
        UNIT.map(Vector3::from)
    }

    #[test]
    fn orientation_is_that_of_the_normal() {
        let [a, b, c] = unit();
        assert_eq!(orientation3(a, b, c, v(0.3, 0.3, 2.0)), 2.0);
        assert!(orientation3(a, b, c, v(0.3, 0.3, -1e-300)) < 0.0);
        assert_eq!(area_vector(unit()), v(0.0, 0.0, 1.0));
    }

    /// Found by fuzzing: two corners at one place gave no number.
    #[test]
    fn flat_triangles_have_closest_points() {
        let (a, b, p) = (v(0.0, 0.0, 0.0), v(2.0, 0.0, 0.0), v(1.0, 1.0, 0.0));
        for corners in [[a, a, b], [a, b, b], [b, a, b], [a, b, v(1.0, 0.0, 0.0)]] {
            assert_eq!(closest(corners, p).0, v(1.0, 0.0, 0.0), "{corners:?}");
        }
        assert_eq!(closest([a, a, a], p).0, a);
    }

    #[test]
    fn sight_through_edges_and_corners_is_cut_but_touching_is_not() {
        let through = |x: f64, y: f64| cuts_segment(unit(), v(x, y, -1.0), v(x, y, 1.0));
        assert!(through(0.2, 0.2) && through(0.5, 0.0) && through(0.5, 0.5) && through(0.0, 0.0) && through(1.0, 0.0));
        assert!(!through(-1e-300, 0.2) && !through(0.5, 0.5 + 1e-15));
        assert!(!cuts_segment(unit(), v(0.2, 0.2, 0.0), v(0.2, 0.2, 1.0)));
        assert!(!cuts_segment(unit(), v(-1.0, 0.2, 0.0), v(2.0, 0.2, 0.0)));
    }

    #[test]
    fn crossing_triangles_share_a_segment() {
        let upright = [v(0.25, -1.0, -1.0), v(0.25, 3.0, -1.0), v(0.25, 0.5, 1.0)];
        let mut ends = crossing(unit(), upright).unwrap();
        ends.sort_by(|a, b| a.y.total_cmp(&b.y));
        assert!((ends[0] - v(0.25, 0.0, 0.0)).norm() < 1e-15 && (ends[1] - v(0.25, 0.75, 0.0)).norm() < 1e-15);
        assert!(crossing(unit(), unit().map(|p| p + v(0.0, 0.0, 0.1))).is_none());
        assert!(crossing(unit(), unit()).is_none());
        assert!(crossing(unit(), upright.map(|p| p + v(2.0, 0.0, 0.0))).is_none());
    }

    proptest! {
        #[test]
        fn no_sampled_point_is_closer(
            corners in proptest::array::uniform3(proptest::array::uniform3(-1.0..1.0f64)),
            p in proptest::array::uniform3(-2.0..2.0f64),
        ) {
            let triangle = corners.map(Vector3::from);
            let p = Vector3::from(p);
            let found = (closest(triangle, p).0 - p).norm();
            let mut sampled = f64::INFINITY;
            for i in 0..=40 {
                for j in 0..=40 - i {
                    let (s, t) = (i as f64 / 40.0, j as f64 / 40.0);
                    let q = triangle[0] * (1.0 - s - t) + triangle[1] * s + triangle[2] * t;
                    sampled = sampled.min((q - p).norm());
                }
            }
            let longest = (0..3).map(|k| (triangle[k] - triangle[(k + 1) % 3]).norm()).fold(0.0, f64::max);
            prop_assert!(found <= sampled + 1e-12 && found >= sampled - longest / 40.0);
        }
    }
}
