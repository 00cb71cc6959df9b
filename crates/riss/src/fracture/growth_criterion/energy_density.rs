//! Least strain energy density around a crack tip [Sih1974].

use super::falling_root::falling_roots;
use super::hoop_stress;
use super::scaled;

/// Where the minimum lies as a multiple of the angle of the largest hoop stress: for Poisson's ratios from 0 to 0.5 and
/// all mixtures between `(3-√5)/2` (a
/// trace of mode II, Poisson's ratio 0) and 1.36.
const SOUGHT: [f64; 2] = [0.25, 1.5];

/// Enough to part the minimum from the maximum beside it.
const N_INTERVALS: usize = 64;

/// Strain energy density factor times `16πμ`, `a11 K_I² + 2 a12 K_I K_II + a22 K_II²` without `1/(16πμ)`, at `angle`
/// [rad], counter-clockwise positive [Sih1974] [stress²·length].
pub fn scaled_density(k1: f64, k2: f64, kolosov: f64, angle: f64) -> f64 {
    let (sin, cos) = angle.sin_cos();
    let a11 = (1.0 + cos) * (kolosov - cos);
    let a12 = sin * (2.0 * cos - (kolosov - 1.0));
    let a22 = (kolosov + 1.0) * (1.0 - cos) + (1.0 + cos) * (3.0 * cos - 1.0);
    a11 * k1 * k1 + 2.0 * a12 * k1 * k2 + a22 * k2 * k2
}

/// Clockwise angle of the minimum of the density on the side of tension that is nearest to the largest hoop stress, for
/// `k2 > 0`, [rad].
///
/// With a negative Poisson's ratio there may be none, since the density is then largest straight ahead in mode I; the
/// direction of the largest hoop stress takes its place.
pub(super) fn clockwise_angle(k1: f64, k2: f64, kolosov: f64) -> f64 {
    let nearest = hoop_stress::clockwise_angle(k1, k2);
    let (k1, k2, _) = scaled(k1, k2);
    // The slope with 2 cos θ = 2 - 4 sin²(θ/2), which keeps its sign at small angles.
    let rise = 3.0 - kolosov;
    let falling = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let difference = rise - 4.0 * (0.5 * angle).sin().powi(2);
        2.0 * k1 * k2 * (cos * difference - 2.0 * sin * sin)
            - k1 * k1 * sin * difference
            - k2 * k2 * sin * (kolosov - 1.0 - 6.0 * cos)
    };
    // Compression rules up to tan(θ/2) = -K_I / (3 K_II).
    let tension = if k1 < 0.0 { 2.0 * (-k1).atan2(3.0 * k2) } else { 0.0 };
    let low = (SOUGHT[0] * nearest).max(tension);
    let high = (SOUGHT[1] * nearest).min(std::f64::consts::PI);
    falling_roots(falling, low, high, N_INTERVALS)
        .into_iter()
        .reduce(|best, next| if (next - nearest).abs() < (best - nearest).abs() { next } else { best })
        .unwrap_or(nearest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{CrackTipField, ExactField};
    use crate::material::{Elasticity, PlaneState};
    use crate::math::Vector2;
    use std::f64::consts::PI;

    /// `cos θ = (1 - 2ν)/3` in plane strain, `(1 - ν)/(3 (1 + ν))` in plane stress: `cos θ = (κ - 1)/6` [Sih1974].
    #[test]
    fn pure_mode_two_has_a_closed_form() {
        for (poisson, degrees) in [(0.0, 70.53), (0.1, 74.53), (0.3, 82.34), (0.5, 90.0)] {
            let found = clockwise_angle(0.0, 1.0, 3.0 - 4.0 * poisson);
            assert!((found - ((1.0 - 2.0 * poisson) / 3.0).acos()).abs() < 1e-15);
            assert!((found.to_degrees() - degrees).abs() < 0.006);
        }
        let found = clockwise_angle(0.0, 1.0, 2.7 / 1.3);
        assert!((found - (0.7_f64 / 3.9).acos()).abs() < 1e-15);
    }

    /// The density of the exact tip field, from its stresses and strains.
    #[test]
    fn density_is_that_of_the_crack_tip_field() {
        for plane in [PlaneState::Strain, PlaneState::Stress] {
            let material = Elasticity { young: 3.0, poisson: 0.2, plane };
            let field = CrackTipField { k1: 1.3, k2: 0.4, t_stress: 0.0, tip: Vector2::zeros(), angle: 0.0 };
            for angle in [-2.5, -1.0, 0.0, 0.3, 2.0_f64] {
                let r = 0.25;
                let stress = field.stress(&material, Vector2::new(angle.cos(), angle.sin()) * r);
                let density = 0.5 * stress.dot(&material.strain(&stress));
                let found = scaled_density(1.3, 0.4, material.kolosov(), angle) / (16.0 * PI * material.shear() * r);
                assert!((found / density - 1.0).abs() < 1e-13);
            }
        }
    }

    /// Least among all directions in which the hoop stress is tension, ends aside.
    fn check_minimum(k1: f64, k2: f64, kolosov: f64) {
        let found = clockwise_angle(k1, k2, kolosov);
        let density = |angle: f64| scaled_density(k1, k2, kolosov, -angle);
        let size = k1 * k1 + k2 * k2;
        assert!(hoop_stress::circumferential_factor(k1, k2, -found) > 0.0);
        assert!(((density(found + 1e-5) - density(found - 1e-5)) / 2e-5).abs() < 1e-9 * size);
        let curvature = (density(found + 1e-3) - 2.0 * density(found) + density(found - 1e-3)) / 1e-6;
        assert!(curvature > 0.0, "{k1} {k2} {kolosov}: curvature {curvature} at {found}");
        // No minimum lies nearer to the largest hoop stress.
        let nearest = hoop_stress::clockwise_angle(k1, k2);
        let n = 2000;
        let at = |i: i32| nearest + (found - nearest) * f64::from(i) / f64::from(n);
        assert!((0..n).all(|i| density(at(i)) > density(at(i + 1)) - 1e-14 * size));
    }

    #[test]
    fn density_has_a_minimum_under_tension() {
        for kolosov in [3.0, 2.96, 2.6, 1.8, 1.0] {
            for k1 in [0.0, 0.1, 0.5, 1.0, 2.0, 10.0] {
                check_minimum(k1, 1.0, kolosov);
                check_minimum(-k1, 1.0, kolosov);
            }
        }
    }

    /// With K_II much smaller than K_I and κ = 3, the slope vanishes with `φ² - 6 e φ + 4 e²`, `e = K_II/K_I`.
    #[test]
    fn without_contraction_the_angle_is_smaller() {
        let found = clockwise_angle(1.0, 1e-4, 3.0) / 1e-4;
        assert!((found - (3.0 - 5.0_f64.sqrt())).abs() < 1e-6);
    }

    #[test]
    fn auxetic_bodies_fall_back_to_the_hoop_stress() {
        assert_eq!(clockwise_angle(1.0, 0.1, 5.0), hoop_stress::clockwise_angle(1.0, 0.1));
    }
}
