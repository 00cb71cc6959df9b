//! Largest hoop stress around a crack tip, with and without the T-stress.

use super::falling_root::falling_roots;
use super::scaled;
use std::f64::consts::{PI, SQRT_2};

/// The hoop stress with T has at most a few extrema over half a turn; a degree parts them.
const N_INTERVALS: usize = 180;

/// `σ_θθ √(2πr)` of the singular terms at `angle` [rad], counter-clockwise positive [ErdoganSih1963] [stress·√length].
pub fn circumferential_factor(k1: f64, k2: f64, angle: f64) -> f64 {
    let (sin, cos) = (0.5 * angle).sin_cos();
    cos * cos * (k1 * cos - 3.0 * k2 * sin)
}

/// Clockwise angle of the largest singular hoop stress, for `k2 > 0`, [rad].
///
/// `tan(θ/2) = (K_I - √(K_I² + 8 K_II²)) / (4 K_II)` of [ErdoganSih1963], for `K_I ≥ 0` in the form without difference.
pub(super) fn clockwise_angle(k1: f64, k2: f64) -> f64 {
    let (k1, k2, _) = scaled(k1, k2);
    let root = k1.hypot(2.0 * SQRT_2 * k2);
    let half = if k1 >= 0.0 { (2.0 * k2).atan2(k1 + root) } else { (root - k1).atan2(4.0 * k2) };
    2.0 * half
}

/// Clockwise angle of the largest `σ_θθ = circumferential factor / √(2πr) + T sin²θ` at `r = critical_distance`, for
/// `k2 > 0`, [rad] [Williams1972; Finnie1973].
///
/// Only half a turn is searched: on the other side each stress is lower by `3 K_II sin θ cos(θ/2) / √(2πr)`.
/// Where no hoop stress has a maximum, which takes `K_I < 0`, the T-stress is left out.
pub(super) fn clockwise_angle_with_t_stress(k1: f64, k2: f64, t_stress: f64, critical_distance: f64) -> f64 {
    // Finite T must not become infinite, or its ratio to itself would be undefined.
    let t = (t_stress * (2.0 * PI * critical_distance.max(0.0)).sqrt()).clamp(-f64::MAX, f64::MAX);
    let scale = k1.abs().max(k2).max(t.abs());
    let (p, q, t) = (k1 / scale, k2 / scale, t / scale);
    let stress = |angle: f64| circumferential_factor(p, q, -angle) + t * angle.sin().powi(2);
    let slope = |angle: f64| {
        let (sin, cos) = (0.5 * angle).sin_cos();
        1.5 * cos * (q * (cos * cos - 2.0 * sin * sin) - p * cos * sin) + t * (2.0 * angle).sin()
    };
    falling_roots(slope, 0.0, PI, N_INTERVALS)
        .into_iter()
        .map(|angle| (stress(angle), angle))
        .reduce(|best, next| if next.0 > best.0 { next } else { best })
        .map_or_else(|| clockwise_angle(k1, k2), |(_, angle)| angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `σ_θθ` of the tip field [Williams1957] in the usual sum of half angles, independent of the form in use.
    fn check_global_maximum(k1: f64, k2: f64, t: f64, distance: f64) {
        let found = -clockwise_angle_with_t_stress(k1, k2, t, distance);
        let stress = |x: f64| {
            let one = 0.25 * (3.0 * (0.5 * x).cos() + (1.5 * x).cos());
            let two = -0.75 * ((0.5 * x).sin() + (1.5 * x).sin());
            (k1 * one + k2 * two) / (2.0 * PI * distance).sqrt() + t * 0.5 * (1.0 - (2.0 * x).cos())
        };
        let size = (k1.abs() + k2) / (2.0 * PI * distance).sqrt() + t.abs();
        let slope = (stress(found + 1e-5) - stress(found - 1e-5)) / 2e-5;
        assert!(slope.abs() < 1e-9 * size, "{k1} {k2} {t}: slope {slope}");
        let most = (-20_000..20_000).map(|i| stress(f64::from(i) * PI / 20_000.0)).fold(f64::MIN, f64::max);
        assert!(stress(found) >= most - 1e-14 * size, "{k1} {k2} {t}: {found}, {} < {most}", stress(found));
    }

    #[test]
    fn hoop_stress_is_the_largest_of_all_directions() {
        for k1 in [0.0, 0.01, 0.3, 1.0, 4.0] {
            for k2 in [0.02, 0.5, 1.0, 3.0] {
                for t in [-10.0, -1.0, -0.1, 0.1, 0.4, 1.0, 3.0, 20.0] {
                    check_global_maximum(k1, k2, t, 0.2);
                }
                check_global_maximum(-k1, k2, 0.5, 0.2);
            }
        }
    }

    #[test]
    fn closed_form_is_the_limit_without_t_stress() {
        for (k1, k2) in [(1.0, 0.2), (0.0, 1.0), (0.3, 2.0), (-1.0, 1.0), (-8.0, 1.0), (1e6, 1.0)] {
            let closed = clockwise_angle(k1, k2);
            assert!((clockwise_angle_with_t_stress(k1, k2, 7.0, 0.0) - closed).abs() < 4e-16 * closed.max(1.0));
            assert!((clockwise_angle_with_t_stress(k1, k2, 0.0, 7.0) - closed).abs() < 4e-16 * closed.max(1.0));
        }
    }

    /// From `σ_rθ = 0`: `K_I sin θ + K_II (3 cos θ - 1) = 0` [ErdoganSih1963].
    #[test]
    fn shear_vanishes_where_the_hoop_stress_is_largest() {
        for (k1, k2) in [(1.0, 0.2), (0.3, 2.0), (-1.0, 1.0), (-8.0, 1.0), (1e6, 1.0), (1.0, 1e9)] {
            let (sin, cos) = (-clockwise_angle(k1, k2)).sin_cos();
            assert!((k1 * sin + k2 * (3.0 * cos - 1.0)).abs() < 1e-15 * (k1.abs() + 4.0 * k2));
        }
    }

    #[test]
    fn simple_angles_of_the_closed_form() {
        // cos θ = 1/3, 70.53°, in pure mode II; tan(θ/2) = 1/2 for equal factors.
        assert!((clockwise_angle(0.0, 2.0) - (1.0_f64 / 3.0).acos()).abs() < 1e-15);
        assert!((clockwise_angle(5.0, 5.0) - 2.0 * 0.5_f64.atan()).abs() < 1e-15);
        assert!((clockwise_angle(-5.0, 5.0) - 0.5 * PI).abs() < 1e-15);
    }

    /// The straight path of mode I is stable up to `r = (9/128π) (K_I/T)²` [Streit1980]; beyond, a trace of mode II
    /// turns the crack far away.
    #[test]
    fn straight_growth_is_stable_up_to_the_critical_distance() {
        let (k1, t) = (2.0, 1.5);
        let critical = 9.0 / (128.0 * PI) * (k1 / t) * (k1 / t);
        let angle = |ratio: f64| clockwise_angle_with_t_stress(k1, 1e-12, t, ratio * critical);
        assert!(angle(0.99) < 1e-9);
        // Stationary in mode I off the axis: (3/8) K_I cos(θ/2) = T √(2πr) cos θ, with T √(2πr) = (3/8) K_I √ratio.
        for ratio in [1.02, 1.5, 4.0_f64] {
            let found = angle(ratio);
            assert!(found > 0.1);
            assert!(((0.5 * found).cos() - ratio.sqrt() * found.cos()).abs() < 1e-9);
        }
    }
}
