//! The argument of a weight function behind an obstacle, with its derivatives [EFG, Eqs. 29, 31, 32].

use crate::math::{Matrix2, Vector2};

/// A scalar function of the point with its derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    pub value: f64,
    pub gradient: Vector2,
    pub second: Matrix2,
}

impl Jet {
    pub const ZERO: Self =
        Self { value: 0.0, gradient: Vector2::new(0.0, 0.0), second: Matrix2::new(0.0, 0.0, 0.0, 0.0) };

    /// Distance from a fixed place to the point.
    #[inline]
    pub fn distance(at: Vector2, from: Vector2) -> Self {
        let value = (at - from).norm();
        if value == 0.0 {
            return Self::ZERO;
        }
        let gradient = (at - from) / value;
        Self { value, gradient, second: (Matrix2::identity() - gradient * gradient.transpose()) / value }
    }

    #[inline]
    pub fn plus(self, other: Self, factor: f64) -> Self {
        Self {
            value: self.value + other.value * factor,
            gradient: self.gradient + other.gradient * factor,
            second: self.second + other.second * factor,
        }
    }
}

/// `(g/s)^λ s` for a way of length `g` instead of the distance `s` [EFG, Eq. 29, with the shortest of all ways].
///
/// - `g`, `s`: length of the way and straight distance from the node [length]
#[inline]
pub(super) fn lengthened(g: Jet, s: Jet, lambda: f64) -> Jet {
    if lambda == 1.0 {
        return g;
    }
    if s.value == 0.0 {
        return Jet { value: f64::INFINITY, ..g };
    }
    let ratio = g.value / s.value;
    let (by_g, by_s) = (lambda * ratio.powf(lambda - 1.0), (1.0 - lambda) * ratio.powf(lambda));
    let (e, f) = (g.gradient, s.gradient);
    // Second derivatives of r(g, s), which is homogeneous of first degree: r_gg g² = -r_gs g s = r_ss s².
    let bend = lambda * (lambda - 1.0) * ratio.powf(lambda - 1.0) / g.value;
    let d = e - f * ratio;
    Jet {
        value: ratio.powf(lambda) * s.value,
        gradient: e * by_g + f * by_s,
        second: d * d.transpose() * bend + g.second * by_g + s.second * by_s,
    }
}
