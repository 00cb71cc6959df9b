//! Cracks that are transparent near their tips [EFG, section 4.3].

use super::detour::Jet;
use crate::math::{Matrix2, Vector2, cross, turn_left};

/// Where a segment of a crack is seen through: near one of the tips of the crack.
#[derive(Clone, Debug)]
pub struct Fade {
    /// Start and unit vector of the segment.
    start: Vector2,
    along: Vector2,
    /// For each tip, the distance to it from the start along the crack, whether it grows (1) or falls (-1) along the
    /// segment, and the distance from the tip at which the crack is opaque [length].
    tips: Vec<[f64; 3]>,
    lambda: f64,
}

impl Fade {
    /// A segment from `a` to `b`; see the fields for `tips`.
    pub(super) fn new(a: Vector2, b: Vector2, tips: Vec<[f64; 3]>, lambda: f64) -> Self {
        Self { start: a, along: (b - a).normalize(), tips, lambda }
    }

    /// `(s_c/s̄_c)^λ` for a line from `node` to `point` that crosses the segment [EFG, Eq. 32], with derivatives by
    /// the point; nothing where the crack is opaque.
    // Differs from [EFG, Eq. 34]: the derivatives of s_c are those of the true intersection.
    pub(super) fn shade(&self, node: Vector2, point: Vector2) -> Option<Jet> {
        let axes = |p: Vector2| [(p - self.start).dot(&self.along), cross(self.along, p - self.start)];
        let ([t_node, h_node], [t, h]) = (axes(node), axes(point));
        let (side, h_node, h) = (h.signum(), h_node.abs(), h.abs());
        let sum = h_node + h;
        // Intersection at (h_node t + h t_node)/(h_node + h) along the segment.
        let meeting = (h_node * t + h * t_node) / sum;
        let (by_t, by_h) = (h_node / sum, h_node * (t_node - t) / (sum * sum));
        let (by_th, by_hh) = (-h_node / (sum * sum), -2.0 * by_h / sum);
        let distance = |tip: &[f64; 3]| (tip[0] + tip[1] * meeting) / tip[2];
        let tip = self.tips.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let s = distance(tip).max(0.0);
        if s >= 1.0 {
            return None;
        }
        let normal = turn_left(self.along) * side;
        let slope = tip[1] / tip[2];
        let gradient = (self.along * by_t + normal * by_h) * slope;
        let mixed = self.along * normal.transpose();
        let second = ((mixed + mixed.transpose()) * by_th + normal * normal.transpose() * by_hh) * slope;
        let (first, bend) = (self.lambda * s.powf(self.lambda - 1.0), self.lambda * (self.lambda - 1.0));
        let square: Matrix2 = gradient * gradient.transpose();
        Some(Jet {
            value: s.powf(self.lambda),
            gradient: gradient * first,
            second: second * first + square * (bend * s.powf(self.lambda - 2.0)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shade_grows_from_the_tip_and_its_derivatives_are_those_of_differences() {
        // A crack from (0.2, 0.1) at 30° to its tip one length away, opaque 0.4 behind it.
        let along = crate::math::direction(30f64.to_radians());
        let start = Vector2::new(0.2, 0.1);
        let fade = Fade::new(start, start + along, vec![[1.0, -1.0, 0.4]], 2.0);
        let at = |t: f64, h: f64| start + along * t + turn_left(along) * h;
        // Halfway between the feet of node and point, 0.2 behind the tip: a quarter.
        let shade = |point: Vector2| fade.shade(at(0.7, -0.2), point).unwrap();
        assert!((shade(at(0.9, 0.2)).value - 0.25).abs() < 1e-12);
        assert!(fade.shade(at(0.7, -0.2), at(0.3, 0.2)).is_none());
        assert!(shade(at(1.3, 0.2)).value < 1e-12);
        let step = 1e-5;
        for point in [at(0.9, 0.2), at(0.85, 0.05), at(1.0, 0.3)] {
            let j = shade(point);
            for d in 0..2 {
                let e = Vector2::ith(d, step);
                let (ahead, behind) = (shade(point + e), shade(point - e));
                assert!(((ahead.value - behind.value) / (2.0 * step) - j.gradient[d]).abs() < 1e-8);
                assert!(((ahead.gradient - behind.gradient) / (2.0 * step) - j.second.column(d)).norm() < 1e-7);
            }
        }
    }
}
