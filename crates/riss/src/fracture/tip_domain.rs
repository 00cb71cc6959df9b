//! Domains around a crack tip, cut by the crack however it bends.

use super::settings::TipDomainShape;
use crate::crack::{TipFrame, TipId};
use crate::error::{Error, Result};
use crate::math::gauss_legendre::gauss_legendre;
use crate::math::{Vector2, cross, turn_left};
use crate::model::Model;
use crate::nodes::spacing::free_radius;
use crate::nodes::triangulation::SIGHT_SHIFT;
use std::f64::consts::{PI, TAU};

/// Sizes of the automatic domains, over that of the largest one that fits.
const AUTOMATIC_SIZES: [f64; 3] = [0.5, 0.65, 0.8];
/// Share of a domain's radius in which q is one and its gradient zero.
pub const PLATEAU: f64 = 0.35;
/// Points across the ring and around it.
const RADIAL_POINTS: usize = 12;
const ANGULAR_POINTS: usize = 96;
/// Pieces of an octant of a contour: nothing is averaged across it, so it sees each node.
const CONTOUR_PANELS: usize = 4;
/// A turn of the crack that disturbs the fields beside it [rad].
const SHARP_TURN: f64 = 0.2;
/// Radius of a domain over the distance of a kink that it leaves out (squares reach a little beyond).
const KINK_CLEARANCE: f64 = 0.9;
/// Least radius of such a domain over the node spacing at the tip.
const LEAST_SPACINGS: f64 = 4.0;
/// Points on each stretch of a crack face along which q is smooth.
const FACE_POINTS: usize = 16;

/// The crack as seen from its tip.
#[derive(Clone, Debug)]
pub struct TipView {
    /// The tip.
    pub id: TipId,
    /// Its frame.
    pub frame: TipFrame,
    /// Vertices from the tip into the crack.
    pub path: Vec<Vector2>,
    /// Largest radius of a domain around the tip.
    pub largest_radius: f64,
}

/// An integration point of a domain integral, in the tip frame.
#[derive(Clone, Copy, Debug)]
pub struct DomainPoint {
    /// Position [length].
    pub position: Vector2,
    /// From where visibility is asked.
    pub sight: Vector2,
    /// Distance from the tip [length].
    pub r: f64,
    /// Angle from the direction ahead, continued along a bent crack so that only the crack itself cuts it [rad].
    pub theta: f64,
    /// Gradient of q, global axes [1/length]; on faces and for body forces q itself along the first axis.
    pub q: Vector2,
    /// Integration weight [length²], on faces and contours [length].
    pub weight: f64,
    /// Normal of the face out of the body, or of the contour away from the tip; zero in the domain.
    pub normal: Vector2,
}

/// Points of a domain: the ring where q falls from one to zero, and the crack faces below it.
#[derive(Clone, Debug, Default)]
pub struct TipDomain {
    /// Radius of a disk, half edge of a square [length].
    pub radius: f64,
    /// Points in the domain.
    pub area: Vec<DomainPoint>,
    /// Points on the crack faces, where they leave the line straight behind the tip.
    pub faces: Vec<DomainPoint>,
}

impl TipView {
    /// The view from a tip of the model.
    pub fn new(model: &Model, id: TipId) -> Self {
        let crack = &model.cracks[id.crack];
        let frame = crack.frame(id.end);
        let path = crack.from_end(id.end);
        let free = free_radius(model, id.crack, frame.position);
        let mut view = Self { id, frame, path, largest_radius: free };
        view.largest_radius = view.single_crossing(free);
        view
    }

    /// Largest radius up to `limit` at which every smaller circle meets the path once.
    fn single_crossing(&self, limit: f64) -> f64 {
        let tip = self.frame.position;
        let mut previous = 0.0;
        for p in &self.path[1..] {
            let r = (p - tip).norm();
            if r < previous {
                return previous.min(limit) * 0.999;
            }
            previous = r;
            if r > limit {
                break;
            }
        }
        // The distance along a segment may dip between its ends.
        for w in self.path.windows(2) {
            let (a, e) = (w[0] - tip, w[1] - w[0]);
            if a.norm() > 0.0 && a.dot(&e) < 0.0 {
                return a.norm().min(limit) * 0.999;
            }
        }
        limit.min(previous)
    }

    /// Angle of the crack at distance `r`, near π for a straight one.
    fn crack_angle(&self, r: f64) -> f64 {
        let tip = self.frame.position;
        let segment = self.path.windows(2).find(|w| (w[1] - tip).norm() >= r);
        let w = segment.unwrap_or(&self.path[self.path.len() - 2..]);
        let (a, e) = (w[0] - tip, w[1] - w[0]);
        // |a + t e| = r.
        let (aa, ae, ee) = (a.norm_squared() - r * r, a.dot(&e), e.norm_squared());
        let t = (-ae + (ae * ae - aa * ee).max(0.0).sqrt()) / ee;
        let p = a + e * t;
        let local = Vector2::new(p.dot(&self.frame.x1()), p.dot(&self.frame.x2()));
        // In (0, 2π): a path that turns around the tip by less than a half turn stays continuous.
        local.y.atan2(local.x).rem_euclid(TAU)
    }

    /// Radii to use: those asked for as far as they fit, or three automatic ones. Says what was shrunk.
    ///
    /// # Errors
    /// [`Error::NoTipDomain`] if nothing fits.
    pub fn radii(&self, shape: TipDomainShape, wanted: Option<&[f64]>) -> Result<(Vec<f64>, Option<String>)> {
        // A square of half edge c needs room for its corners.
        let limit = match shape {
            TipDomainShape::Disc => self.largest_radius,
            TipDomainShape::Square => self.largest_radius / std::f64::consts::SQRT_2,
        } * 0.98;
        if !(limit > 0.0) {
            return Err(Error::NoTipDomain {
                tip: self.frame.position,
                reason: "the tip has no room around it".into(),
            });
        }
        let Some(wanted) = wanted else {
            return Ok((AUTOMATIC_SIZES.map(|s| s * limit).to_vec(), None));
        };
        let largest = wanted.iter().copied().fold(0.0, f64::max);
        if largest <= limit {
            return Ok((wanted.to_vec(), None));
        }
        let shrunk: Vec<f64> = wanted.iter().map(|r| r * limit / largest).collect();
        let note = format!(
            "the domains around the tip at ({:.6}, {:.6}) would meet a boundary, a hole, another crack or the crack's own bend; they were shrunk by a factor {:.3}",
            self.frame.position.x,
            self.frame.position.y,
            limit / largest
        );
        Ok((shrunk, Some(note)))
    }

    /// The radii, shrunk until no sharp kink of the crack lies within them, unless too few nodes would be left: what the
    /// faces hold near a kink is poor, and counts in full for the configurational force.
    ///
    /// - `spacing`: distance between the nodes at the tip [length]
    pub fn clear_of_kinks(&self, radii: &[f64], spacing: f64) -> Vec<f64> {
        let largest = radii.iter().copied().fold(0.0, f64::max);
        let smallest = radii.iter().copied().fold(f64::INFINITY, f64::min);
        let kink = self.path.windows(3).find_map(|w| {
            let (a, b) = (w[1] - w[0], w[2] - w[1]);
            let is_sharp = cross(a, b).abs().atan2(a.dot(&b)) > SHARP_TURN;
            is_sharp.then(|| (w[1] - self.frame.position).norm())
        });
        let share = kink.map_or(1.0, |d| (KINK_CLEARANCE * d / largest).min(1.0));
        if share * smallest < LEAST_SPACINGS * spacing {
            radii.to_vec()
        } else {
            radii.iter().map(|r| r * share).collect()
        }
    }

    /// The domain of a given size.
    pub fn domain(&self, shape: TipDomainShape, radius: f64) -> TipDomain {
        let mut domain = TipDomain { radius, ..TipDomain::default() };
        let (around, across) = (gauss_legendre(ANGULAR_POINTS / 8), gauss_legendre(RADIAL_POINTS));
        for &(s, ws) in &across {
            let s = PLATEAU + (1.0 - PLATEAU) * s;
            for octant in 0..8 {
                for &(t, wt) in &around {
                    self.add_area(&mut domain, shape, s, ws * (1.0 - PLATEAU), (octant as f64 + t) / 8.0, wt / 8.0);
                }
            }
        }
        domain.faces = self.faces(shape, radius, PLATEAU, 1);
        domain
    }

    /// Points of the contour at a given size.
    pub fn contour(&self, shape: TipDomainShape, radius: f64) -> Vec<DomainPoint> {
        let mut domain = TipDomain { radius, ..TipDomain::default() };
        let line = gauss_legendre(ANGULAR_POINTS / 8);
        let n = 8 * CONTOUR_PANELS;
        for panel in 0..n {
            for &(t, wt) in &line {
                self.add_area(&mut domain, shape, 1.0, 1.0, (panel as f64 + t) / n as f64, wt / n as f64);
            }
        }
        let line_weight = |mut p: DomainPoint| {
            // Area weight is ds times the ray's advance along the normal, which is -1/|∇q| here.
            let slope = p.q.norm();
            p.normal = -p.q / slope;
            p.weight *= slope * (1.0 - PLATEAU);
            p
        };
        domain.area.into_iter().map(line_weight).collect()
    }

    /// Points all over the domain, with q along the first axis: one up to the share `plateau` of the way out, then
    /// falling to zero.
    pub fn interior(&self, shape: TipDomainShape, radius: f64, plateau: f64) -> Vec<DomainPoint> {
        let mut domain = TipDomain { radius, ..TipDomain::default() };
        let (around, across) = (gauss_legendre(ANGULAR_POINTS / 8), gauss_legendre(RADIAL_POINTS));
        for (from, to) in [(0.0, plateau), (plateau, 1.0)].into_iter().filter(|p| p.0 < p.1) {
            for &(s, ws) in &across {
                let s = from + (to - from) * s;
                for octant in 0..8 {
                    for &(t, wt) in &around {
                        self.add_area(&mut domain, shape, s, ws * (to - from), (octant as f64 + t) / 8.0, wt / 8.0);
                        let q = if s <= plateau { 1.0 } else { (1.0 - s) / (1.0 - plateau) };
                        domain.area.last_mut().expect("it was just added").q = Vector2::new(q, 0.0);
                    }
                }
            }
        }
        domain.area
    }

    /// Adds the point at share `s` of the way out and share `turn` of the way around, from the lower to the upper face.
    fn add_area(&self, domain: &mut TipDomain, shape: TipDomainShape, s: f64, ws: f64, turn: f64, wt: f64) {
        // Where the ray leaves the domain depends on the angle, and the angle of the cut on the distance: the angle is
        // counted from the cut at this share of the way out, so that every level s is a closed path from face to face.
        let cut = |level: f64| {
            let mut theta = PI;
            for _ in 0..60 {
                let next = self.crack_angle(level * rim(shape, theta) * domain.radius);
                if (next - theta).abs() < 1e-14 {
                    break;
                }
                theta = next;
            }
            theta
        };
        let theta_cut = cut(s);
        let theta = theta_cut - TAU + TAU * turn;
        let reach = rim(shape, theta) * domain.radius;
        let r = s * reach;
        let local = Vector2::new(r * theta.cos(), r * theta.sin());
        let position = self.frame.global(local);
        // q = 1 - (s - plateau)/(1 - plateau); its gradient is that of s.
        let gradient = local_gradient(shape, theta, domain.radius) * (-1.0 / (1.0 - PLATEAU));
        let q = self.frame.x1() * gradient.x + self.frame.x2() * gradient.y;
        // dA = r dr dθ with r = s reach(θ).
        let weight = s * reach * reach * ws * TAU * wt;
        domain.area.push(DomainPoint { position, sight: position, r, theta, q, weight, normal: Vector2::zeros() });
    }

    /// Points on both faces of the crack inside the domain, from the segment number `first` on, with q along the first
    /// axis: one up to the share `plateau` of the way out, then falling to zero.
    ///
    /// On the segment at the tip the points crowd there, as the root of r: they integrate `1/√r` well.
    pub fn faces(&self, shape: TipDomainShape, radius: f64, plateau: f64, first: usize) -> Vec<DomainPoint> {
        let mut points = vec![];
        let line = gauss_legendre(FACE_POINTS);
        for (k, w) in self.path.windows(2).enumerate().skip(first) {
            let stops = self.stops(w, shape, radius, plateau);
            for piece in stops.windows(2).filter(|p| p[1] > p[0]) {
                let (from, length) = (piece[0], piece[1] - piece[0]);
                for &(s, ws) in &line {
                    let (t, wt) =
                        if k == 0 && from == 0.0 { (s * s * length, 2.0 * s * ws) } else { (from + s * length, ws) };
                    let position = w[0] + (w[1] - w[0]) * t;
                    let level = self.level(position, shape, radius);
                    let q = if level <= plateau { 1.0 } else { ((1.0 - level) / (1.0 - plateau)).max(0.0) };
                    if q > 0.0 {
                        self.add_pair(&mut points, position, w[1] - w[0], q, wt * length);
                    }
                }
            }
        }
        points
    }

    /// Parameters between which q is smooth on a segment of the crack.
    fn stops(&self, w: &[Vector2], shape: TipDomainShape, radius: f64, plateau: f64) -> Vec<f64> {
        let level = |t: f64| self.level(w[0] + (w[1] - w[0]) * t, shape, radius);
        let mut stops = vec![0.0];
        for target in [plateau, 1.0] {
            let (mut low, mut high) = (0.0, 1.0);
            if level(low) < target && level(high) > target {
                for _ in 0..50 {
                    let middle = 0.5 * (low + high);
                    if level(middle) < target { low = middle } else { high = middle }
                }
                stops.push(low);
            }
        }
        stops.push(1.0);
        stops
    }

    /// Share of the way out of the domain at a point of the crack.
    fn level(&self, position: Vector2, shape: TipDomainShape, radius: f64) -> f64 {
        let r = self.frame.local(position).norm();
        r / (rim(shape, self.crack_angle(r)) * radius)
    }

    /// Adds the point on both faces of a segment along `e`, which leads away from the tip.
    fn add_pair(&self, points: &mut Vec<DomainPoint>, position: Vector2, e: Vector2, q: f64, share: f64) {
        // Material above the path (left of x1) is to its right.
        let left = turn_left(e.normalize());
        let r = self.frame.local(position).norm();
        let angle = self.crack_angle(r);
        let shift = SIGHT_SHIFT * r.min(e.norm());
        for (theta, inward) in [(angle, -left), (angle - TAU, left)] {
            points.push(DomainPoint {
                position,
                sight: position + inward * shift,
                r,
                theta,
                q: Vector2::new(q, 0.0),
                weight: share * e.norm(),
                normal: -inward,
            });
        }
    }
}

/// Distance to the rim of the domain of unit size in direction `theta`.
pub(super) fn rim(shape: TipDomainShape, theta: f64) -> f64 {
    match shape {
        TipDomainShape::Disc => 1.0,
        TipDomainShape::Square => 1.0 / theta.cos().abs().max(theta.sin().abs()),
    }
}

/// Gradient of the share of the way out.
fn local_gradient(shape: TipDomainShape, theta: f64, radius: f64) -> Vector2 {
    let (sin, cos) = theta.sin_cos();
    match shape {
        TipDomainShape::Disc => Vector2::new(cos, sin) / radius,
        TipDomainShape::Square if cos.abs() >= sin.abs() => Vector2::new(cos.signum() / radius, 0.0),
        TipDomainShape::Square => Vector2::new(0.0, sin.signum() / radius),
    }
}
