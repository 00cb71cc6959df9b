//! Straight and circular pieces of a boundary or a crack.

use super::aabb::Aabb;
use crate::math::{Vector2, cross, direction, turn_left};
use std::f64::consts::TAU;

/// A straight segment or a circular arc, run through by a parameter from 0 to 1 at constant speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// From `start` to `end`.
    Line {
        /// Point at parameter 0.
        start: Vector2,
        /// Point at parameter 1.
        end: Vector2,
    },
    /// Around `center`; counterclockwise if `sweep > 0`.
    Arc {
        /// Center of the circle.
        center: Vector2,
        /// Radius of the circle.
        radius: f64,
        /// Angle of the point at parameter 0 [rad].
        start_angle: f64,
        /// Signed angle run through [rad], at most a full turn.
        sweep: f64,
    },
}

impl Curve {
    /// A full circle, counterclockwise from angle 0.
    pub fn circle(center: Vector2, radius: f64) -> Self {
        Self::Arc { center, radius, start_angle: 0.0, sweep: TAU }
    }

    /// The arc from `start` through `middle` to `end`, or `None` if the three lie on a line.
    pub fn arc_through(start: Vector2, middle: Vector2, end: Vector2) -> Option<Self> {
        let (p, q) = (middle - start, end - start);
        let d = 2.0 * cross(p, q);
        if d.abs() <= 1e-12 * p.norm() * q.norm() {
            return None;
        }
        let offset = Vector2::new(
            q.y * p.norm_squared() - p.y * q.norm_squared(),
            p.x * q.norm_squared() - q.x * p.norm_squared(),
        ) / d;
        let center = start + offset;
        Some(Self::arc_around(center, start, end, d > 0.0))
    }

    /// The arc around `center` from `start` to `end`; the radius is the distance of `start`.
    pub fn arc_around(center: Vector2, start: Vector2, end: Vector2, counterclockwise: bool) -> Self {
        let angle = |p: Vector2| (p.y - center.y).atan2(p.x - center.x);
        let start_angle = angle(start);
        let mut sweep = (angle(end) - start_angle).rem_euclid(TAU);
        if sweep < 1e-12 {
            sweep = TAU;
        }
        if !counterclockwise {
            sweep -= TAU;
            if sweep > -1e-12 {
                sweep = -TAU;
            }
        }
        Self::Arc { center, radius: (start - center).norm(), start_angle, sweep }
    }

    /// The point at parameter `t`.
    pub fn point(&self, t: f64) -> Vector2 {
        match *self {
            // Exact at both ends.
            Self::Line { start, end } => start * (1.0 - t) + end * t,
            Self::Arc { center, radius, start_angle, sweep } => center + direction(start_angle + t * sweep) * radius,
        }
    }

    /// Derivative of [`Self::point`] by the parameter [length].
    pub fn velocity(&self, t: f64) -> Vector2 {
        match *self {
            Self::Line { start, end } => end - start,
            Self::Arc { radius, start_angle, sweep, .. } => {
                turn_left(direction(start_angle + t * sweep)) * (radius * sweep)
            }
        }
    }

    /// Unit tangent in the direction of growing parameter.
    pub fn tangent(&self, t: f64) -> Vector2 {
        self.velocity(t).normalize()
    }

    /// Unit normal to the right of the tangent: outward where the body lies to the left.
    pub fn right_normal(&self, t: f64) -> Vector2 {
        -turn_left(self.tangent(t))
    }

    /// Length of the curve.
    pub fn length(&self) -> f64 {
        match *self {
            Self::Line { start, end } => (end - start).norm(),
            Self::Arc { radius, sweep, .. } => radius * sweep.abs(),
        }
    }

    /// The piece between two parameters; run backwards if `from > to`.
    pub fn piece(&self, from: f64, to: f64) -> Self {
        match *self {
            Self::Line { .. } => Self::Line { start: self.point(from), end: self.point(to) },
            Self::Arc { center, radius, start_angle, sweep } => {
                Self::Arc { center, radius, start_angle: start_angle + from * sweep, sweep: (to - from) * sweep }
            }
        }
    }

    /// The curve run backwards.
    pub fn reversed(&self) -> Self {
        self.piece(1.0, 0.0)
    }

    /// Parameter of the point of the curve that is closest to `p`.
    pub fn closest_parameter(&self, p: Vector2) -> f64 {
        match *self {
            Self::Line { start, end } => {
                let e = end - start;
                ((p - start).dot(&e) / e.norm_squared()).clamp(0.0, 1.0)
            }
            Self::Arc { center, start_angle, sweep, .. } => {
                let angle = (p.y - center.y).atan2(p.x - center.x);
                let along = ((angle - start_angle) * sweep.signum()).rem_euclid(TAU);
                let t = along / sweep.abs();
                if t <= 1.0 {
                    t
                } else if (self.point(0.0) - p).norm() <= (self.point(1.0) - p).norm() {
                    0.0
                } else {
                    1.0
                }
            }
        }
    }

    /// Distance from `p` to the curve.
    pub fn distance(&self, p: Vector2) -> f64 {
        (self.point(self.closest_parameter(p)) - p).norm()
    }

    /// Points at equal steps such that chords leave the curve by at most `tolerance`; both ends are included.
    pub fn flattened(&self, tolerance: f64) -> Vec<Vector2> {
        let n = match *self {
            Self::Line { .. } => 1,
            Self::Arc { radius, sweep, .. } => {
                let step = 2.0 * (1.0 - (tolerance / radius).min(0.5)).acos();
                ((sweep.abs() / step).ceil() as usize).max(2)
            }
        };
        (0..=n).map(|k| self.point(k as f64 / n as f64)).collect()
    }

    /// Parameters along the segment `a b` at which it meets the curve, ends included, to within `tolerance`.
    pub fn meetings(&self, a: Vector2, b: Vector2, tolerance: f64) -> Vec<f64> {
        let d = b - a;
        let slack = tolerance / d.norm();
        let candidates: Vec<f64> = match *self {
            Self::Line { start, end } => {
                let e = end - start;
                let turn = cross(d, e);
                if turn.abs() <= 1e-12 * d.norm() * e.norm() { vec![] } else { vec![cross(start - a, e) / turn] }
            }
            Self::Arc { center, radius, .. } => {
                let to_center = center - a;
                let foot = to_center.dot(&d) / d.norm_squared();
                let height = (to_center - d * foot).norm();
                if height > radius + tolerance {
                    vec![]
                } else {
                    let half = (radius * radius - height * height).max(0.0).sqrt() / d.norm();
                    vec![foot - half, foot + half]
                }
            }
        };
        let fits = |s: &f64| *s >= -slack && *s <= 1.0 + slack && self.distance(a + d * *s) <= 2.0 * tolerance;
        candidates.into_iter().filter(fits).collect()
    }

    /// Bounding box.
    pub fn aabb(&self) -> Aabb<2> {
        let mut bounds = Aabb::of_points([self.point(0.0), self.point(1.0)]);
        if let Self::Arc { center, radius, start_angle, sweep } = *self {
            for quarter in 0..4 {
                let angle = quarter as f64 * TAU / 4.0;
                let along = ((angle - start_angle) * sweep.signum()).rem_euclid(TAU);
                if along <= sweep.abs() {
                    bounds = bounds.including(center + direction(angle) * radius);
                }
            }
        }
        bounds
    }

    /// Integral of `(x dy - y dx) / 2` along the curve: its share of the enclosed area.
    pub fn area_share(&self) -> f64 {
        match *self {
            Self::Line { start, end } => 0.5 * cross(start, end),
            Self::Arc { center, radius, sweep, .. } => {
                0.5 * (cross(center, self.point(1.0) - self.point(0.0)) + radius * radius * sweep)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arc_through_three_points() {
        let arc = Curve::arc_through(Vector2::new(1.0, 0.0), Vector2::new(0.0, 1.0), Vector2::new(-1.0, 0.0)).unwrap();
        assert!((arc.length() - std::f64::consts::PI).abs() < 1e-14);
        assert!((arc.point(0.5) - Vector2::new(0.0, 1.0)).norm() < 1e-14);
        let back = Curve::arc_through(Vector2::new(-1.0, 0.0), Vector2::new(0.0, 1.0), Vector2::new(1.0, 0.0)).unwrap();
        assert!((back.point(0.5) - Vector2::new(0.0, 1.0)).norm() < 1e-14);
        assert!((back.right_normal(0.5) - Vector2::new(0.0, 1.0)).norm() > 1.0);
    }

    #[test]
    fn closest_parameter_and_area() {
        let circle = Curve::circle(Vector2::new(2.0, 1.0), 0.5);
        assert!((circle.area_share() - 0.25 * std::f64::consts::PI).abs() < 1e-14);
        assert!((circle.distance(Vector2::new(2.0, 1.1)) - 0.4).abs() < 1e-14);
        let quarter = circle.piece(0.0, 0.25);
        assert!((quarter.closest_parameter(Vector2::new(2.0, 0.0)) - 0.0).abs() < 1e-14);
        assert!((quarter.aabb().upper - Vector2::new(2.5, 1.5)).norm() < 1e-14);
    }
}
