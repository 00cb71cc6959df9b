//! Fronts of crack surfaces: where they end inside the body.

use crate::math::Vector3;
use serde::{Deserialize, Serialize};

/// Fronts that turn by more at a point have a corner there, and no radius [rad].
const CORNER: f64 = 0.4;
/// Sums of unit vectors that are shorter than this have no direction: they were opposite.
const OPPOSITE: f64 = 1e-6;

/// A point of a crack front with its axes, which are right-handed: `ahead × normal = tangent`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrontPoint {
    /// Position.
    pub position: Vector3,
    /// Unit vector along the crack surface, normal to the front, away from the crack (x1).
    pub ahead: Vector3,
    /// Unit normal of the crack surface (x2), on its positive side.
    pub normal: Vector3,
    /// Unit tangent of the front (x3).
    pub tangent: Vector3,
    /// Curvature of the front in the surface of the crack [1/length]; positive if the crack is convex.
    pub curvature: f64,
    /// Length along the front, in the direction of `tangent` [length].
    pub s: f64,
}

/// A stretch of front.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CrackFront {
    /// Points in the direction of the tangents; a closed front does not repeat its first.
    pub points: Vec<FrontPoint>,
    /// Whether the last point is joined to the first; otherwise the front ends at the boundary of the body.
    pub is_closed: bool,
    /// Length [length].
    pub length: f64,
}

impl CrackFront {
    /// A front through points in order, with the normals of the crack there; the crack lies on the side of
    /// `tangent × normal`.
    pub(super) fn new(positions: &[Vector3], normals: &[Vector3], is_closed: bool) -> Self {
        let n = positions.len();
        let mut points = Vec::with_capacity(n);
        let mut s = 0.0;
        for k in 0..n {
            let before = if is_closed || k > 0 { positions[(k + n - 1) % n] } else { positions[k] };
            let after = if is_closed || k + 1 < n { positions[(k + 1) % n] } else { positions[k] };
            let (back, forth) = (positions[k] - before, after - positions[k]);
            // Tangent of the circle through the three points; each side counts by the length of the other.
            let weighted = back * forth.norm_squared() + forth * back.norm_squared();
            let chord = weighted.try_normalize(0.0).or((after - before).try_normalize(0.0)).unwrap_or(Vector3::x());
            let normal = across(chord, &[normals[k]]);
            let ahead = normal.cross(&chord);
            let curvature = curvature(back, forth, ahead);
            points.push(FrontPoint { position: positions[k], ahead, normal, tangent: chord, curvature, s });
            s += forth.norm();
        }
        Self { points, is_closed, length: s }
    }

    /// The point at a length along the front, between its points; lengths outside wrap around or are clipped.
    pub fn at(&self, s: f64) -> FrontPoint {
        let n = self.points.len();
        let s = if self.is_closed { s.rem_euclid(self.length) } else { s.clamp(0.0, self.length) };
        let last = if self.is_closed { n } else { n - 1 };
        let k = self.points.partition_point(|p| p.s <= s).clamp(1, last) - 1;
        let (p, q) = (&self.points[k], &self.points[(k + 1) % n]);
        let piece = if k + 1 < n { q.s - p.s } else { self.length - p.s };
        let t = ((s - p.s) / piece).clamp(0.0, 1.0);
        let mix = |a: Vector3, b: Vector3| a * (1.0 - t) + b * t;
        let nearer = if t < 0.5 { p } else { q };
        let tangent = mix(p.tangent, q.tangent).try_normalize(OPPOSITE).unwrap_or(nearer.tangent);
        let normal = across(tangent, &[mix(p.normal, q.normal), nearer.normal]);
        FrontPoint {
            position: mix(p.position, q.position),
            ahead: normal.cross(&tangent),
            normal,
            tangent,
            curvature: p.curvature * (1.0 - t) + q.curvature * t,
            s,
        }
    }

    /// Largest curvature, corners left out [1/length].
    pub fn largest_curvature(&self) -> f64 {
        let step = self.length / self.points.len() as f64;
        self.points.iter().map(|p| p.curvature.abs()).filter(|c| c * step < CORNER).fold(0.0, f64::max)
    }

    /// Curvature out of the surface of the crack at one of its points, from places this far to both sides [1/length]; positive
    /// if the front bends away from the normal.
    pub fn normal_curvature(&self, p: &FrontPoint, reach: f64) -> f64 {
        let reach = if self.is_closed { reach.min(0.25 * self.length) } else { reach.min(0.5 * self.length) };
        let s = if self.is_closed { p.s } else { p.s.clamp(reach, self.length - reach) };
        let [before, at, after] = [s - reach, s, s + reach].map(|s| self.at(s).position);
        let bend = (before - at) + (after - at);
        let chord = 0.25 * (after - before).norm_squared();
        if chord > 0.0 { -bend.dot(&p.normal) / chord } else { 0.0 }
    }

    /// `n` points evenly along the front: with both ends if it is open.
    pub fn sampled(&self, n: usize) -> Vec<FrontPoint> {
        let pieces = if self.is_closed { n } else { n.max(2) - 1 };
        (0..n).map(|k| self.at(self.length * k as f64 / pieces as f64)).collect()
    }

    /// Straight pieces between neighboring points.
    pub fn segments(&self) -> impl Iterator<Item = [Vector3; 2]> + '_ {
        let n = self.points.len();
        let last = if self.is_closed { n } else { n.saturating_sub(1) };
        (0..last).map(move |k| [self.points[k].position, self.points[(k + 1) % n].position])
    }
}

/// The first of some directions that is not along a tangent, as the unit vector normal to that; without any, one of all.
fn across(tangent: Vector3, directions: &[Vector3]) -> Vector3 {
    let axis = Vector3::ith(tangent.iamin(), 1.0);
    let across = |d: &Vector3| (d - tangent * d.dot(&tangent)).try_normalize(OPPOSITE);
    directions.iter().chain([&axis]).find_map(across).unwrap_or(axis)
}

/// Curvature of the circle through three points, positive if it bends away from `ahead`; zero at ends.
fn curvature(back: Vector3, forth: Vector3, ahead: Vector3) -> f64 {
    let product = back.norm() * forth.norm() * (back + forth).norm();
    let turn = back.cross(&forth).norm();
    let bend = (back / back.norm().max(f64::MIN_POSITIVE) - forth / forth.norm().max(f64::MIN_POSITIVE)).dot(&ahead);
    if product > 0.0 { 2.0 * turn / product * bend.signum() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle of radius 2 on a cone of half a radian.
    #[test]
    fn the_front_of_a_cone_bends_out_of_it() {
        let n = 2000;
        let around = |k: usize, r: f64, z: f64| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
            Vector3::new(r * cos, r * sin, z)
        };
        let (sin, cos) = 0.5f64.sin_cos();
        let positions: Vec<Vector3> = (0..n).map(|k| around(k, 2.0, 0.0)).collect();
        let normals: Vec<Vector3> = (0..n).map(|k| around(k, sin, cos)).collect();
        let front = CrackFront::new(&positions, &normals, true);
        for p in &front.points {
            let found = front.normal_curvature(p, 0.2);
            assert!((found - 0.5 * sin).abs() < 1e-3, "{found}");
        }
    }

    /// A front that turns around on itself, as between flat triangles: its axes are still unit vectors.
    #[test]
    fn axes_of_a_front_that_turns_back_are_orthonormal() {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 0.0, 0.0]].map(Vector3::from);
        let up = Vector3::z();
        for normals in [[up, -up, up, -up], [Vector3::x(), up, -up, Vector3::zeros()]] {
            for is_closed in [false, true] {
                let front = CrackFront::new(&positions, &normals, is_closed);
                for p in front.sampled(17) {
                    for (a, b, dot) in [
                        (p.ahead, p.ahead, 1.0),
                        (p.normal, p.normal, 1.0),
                        (p.tangent, p.tangent, 1.0),
                        (p.ahead, p.normal, 0.0),
                        (p.normal, p.tangent, 0.0),
                        (p.tangent, p.ahead, 0.0),
                    ] {
                        assert!((a.dot(&b) - dot).abs() < 1e-12, "{p:?}");
                    }
                }
            }
        }
    }
}
