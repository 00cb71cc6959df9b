//! Distances to a surface, and inside or outside.

use super::Surface;
use crate::geometry::aabb::Aabb;
use crate::geometry::triangle::{Feature, closest, cuts_segment};
use crate::math::Vector3;

/// Surfaces are two sides of a wall if the cosine of the angle between them is larger.
const PARALLEL: f64 = 0.9;
/// Vertices of a plane surface are this near to its plane, over its size.
const PLANE: f64 = 1e-9;

/// The point of a surface that is closest to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Its triangle.
    pub triangle: u32,
    /// Where on the triangle.
    pub feature: Feature,
    /// The point.
    pub position: Vector3,
    /// Distance between the two [length].
    pub distance: f64,
}

impl Surface {
    /// The closest point within a distance, if there is one.
    pub fn closest_within(&self, p: Vector3, limit: f64) -> Option<Foot> {
        self.closest_where(p, limit, |_| true)
    }

    /// The same among triangles that `accepts` does not refuse.
    pub fn closest_where(&self, p: Vector3, limit: f64, accepts: impl Fn(u32) -> bool) -> Option<Foot> {
        let mut best: Option<Foot> = None;
        self.tree.visit(&Aabb::around(p, Vector3::repeat(limit)), |t| {
            if !accepts(t) {
                return;
            }
            let (position, feature) = closest(self.corners(t), p);
            let distance = (position - p).norm();
            let is_nearer = best.is_none_or(|b| distance < b.distance || (distance == b.distance && t < b.triangle));
            if distance <= limit && is_nearer {
                best = Some(Foot { triangle: t, feature, position, distance });
            }
        });
        best
    }

    /// The closest point.
    pub fn closest(&self, p: Vector3) -> Foot {
        let bounds = self.bounds();
        let outside = (bounds.lower - p).sup(&(p - bounds.upper)).sup(&Vector3::zeros()).norm();
        let mut limit = outside + 0.02 * bounds.size().norm();
        loop {
            if let Some(foot) = self.closest_within(p, limit) {
                return foot;
            }
            limit *= 2.0;
        }
    }

    /// Where on the surface a point lies: a corner within the tolerance, else an edge, else a triangle.
    pub fn locate(&self, p: Vector3, tolerance: f64) -> Option<Foot> {
        let mut best: Option<(usize, Foot)> = None;
        self.tree.visit(&Aabb::around(p, Vector3::repeat(tolerance)), |t| {
            let corners = self.corners(t);
            let (mut position, mut feature) = closest(corners, p);
            if (position - p).norm() > tolerance {
                return;
            }
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let on_edge = a + (b - a) * ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
                if feature == Feature::Face && (on_edge - p).norm() <= tolerance {
                    (position, feature) = (on_edge, Feature::Edge(k));
                }
            }
            if let Some(k) = (0..3).find(|k| (corners[*k] - p).norm() <= tolerance) {
                (position, feature) = (corners[k], Feature::Corner(k));
            }
            let rank = match feature {
                Feature::Corner(_) => 0,
                Feature::Edge(_) => 1,
                Feature::Face => 2,
            };
            if best.is_none_or(|(r, foot)| (rank, t) < (r, foot.triangle)) {
                best = Some((rank, Foot { triangle: t, feature, position, distance: (position - p).norm() }));
            }
        });
        best.map(|(_, foot)| foot)
    }

    /// Whether all of it lies in one plane.
    pub fn is_plane(&self) -> bool {
        let (origin, normal) = (self.corners(0)[0], self.normals()[0]);
        let tolerance = PLANE * self.bounds().size().norm();
        self.vertices().iter().all(|p| (p - origin).dot(&normal).abs() <= tolerance)
    }

    /// Edges between triangles whose normals differ by more than an angle, with a triangle and its number there.
    ///
    /// - `angle`: [rad]
    pub fn folds(&self, angle: f64) -> impl Iterator<Item = (u32, usize)> + '_ {
        let is_fold = move |t: u32, k: usize| {
            let other = self.across(t, k).filter(|o| t < *o)?;
            let (a, b) = (self.normals()[t as usize], self.normals()[other as usize]);
            (a.cross(&b).norm().atan2(a.dot(&b)) > angle).then_some((t, k))
        };
        (0..self.triangles().len() as u32).flat_map(move |t| (0..3).filter_map(move |k| is_fold(t, k)))
    }

    /// Least box around the surface.
    pub fn bounds(&self) -> Aabb<3> {
        self.bounds
    }

    /// Whether a point lies on the inner side of a closed surface, of which `foot` is the point closest to it: by the
    /// normal there, weighted by angles on edges and corners [Baerentzen2005].
    pub fn is_behind(&self, p: Vector3, foot: &Foot) -> bool {
        let t = foot.triangle as usize;
        let normal = match foot.feature {
            Feature::Face => self.normals[t],
            Feature::Edge(k) => {
                self.normals[t] + self.neighbors[t][k].map_or(Vector3::zeros(), |o| self.normals[o as usize])
            }
            Feature::Corner(k) => self.vertex_normals[self.triangles[t][k] as usize],
        };
        (p - foot.position).dot(&normal) < 0.0
    }

    /// Whether a point lies inside a closed surface.
    pub fn contains(&self, p: Vector3) -> bool {
        self.bounds().contains(&p) && self.is_behind(p, &self.closest(p))
    }

    /// Distance to a closed surface, negative inside [length].
    pub fn signed_distance(&self, p: Vector3) -> f64 {
        let foot = self.closest(p);
        if self.is_behind(p, &foot) { -foot.distance } else { foot.distance }
    }

    /// Whether a triangle cuts the segment from `p` to `q`; touching at an end does not cut.
    pub fn cuts(&self, p: Vector3, q: Vector3) -> bool {
        self.tree.any_along(p, q, |t| cuts_segment(self.corners(t), p, q))
    }

    /// Distance through the material from a point of a triangle to the surface across, if that is within `limit` and
    /// nearly parallel [length].
    pub fn wall(&self, triangle: u32, p: Vector3, limit: f64) -> Option<f64> {
        let normal = self.normals()[triangle as usize];
        let q = p - normal * limit;
        let mut nearest: Option<(f64, u32)> = None;
        self.tree.visit(&Aabb::of_points([p, q]), |t| {
            let corners = self.corners(t);
            if t == triangle || !cuts_segment(corners, p, q) {
                return;
            }
            let across = self.normals()[t as usize];
            let distance = (p - corners[0]).dot(&across) / normal.dot(&across);
            if nearest.is_none_or(|n| (distance, t) < n) {
                nearest = Some((distance, t));
            }
        });
        nearest.filter(|(_, t)| self.normals()[*t as usize].dot(&normal) < -PARALLEL).map(|n| n.0)
    }
}
