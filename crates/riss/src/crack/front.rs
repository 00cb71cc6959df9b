//! Fronts of crack surfaces: where they end inside the body.

use crate::math::Vector3;
use serde::{Deserialize, Serialize};

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
            let chord = weighted.try_normalize(0.0).unwrap_or_else(|| (after - before).normalize());
            let normal = (normals[k] - chord * normals[k].dot(&chord)).normalize();
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
        let tangent = mix(p.tangent, q.tangent).normalize();
        let normal = mix(p.normal, q.normal);
        let normal = (normal - tangent * normal.dot(&tangent)).normalize();
        FrontPoint {
            position: mix(p.position, q.position),
            ahead: normal.cross(&tangent),
            normal,
            tangent,
            curvature: p.curvature * (1.0 - t) + q.curvature * t,
            s,
        }
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

/// Curvature of the circle through three points, positive if it bends away from `ahead`; zero at ends.
fn curvature(back: Vector3, forth: Vector3, ahead: Vector3) -> f64 {
    let product = back.norm() * forth.norm() * (back + forth).norm();
    let turn = back.cross(&forth).norm();
    let bend = (back / back.norm().max(f64::MIN_POSITIVE) - forth / forth.norm().max(f64::MIN_POSITIVE)).dot(&ahead);
    if product > 0.0 { 2.0 * turn / product * bend.signum() } else { 0.0 }
}
