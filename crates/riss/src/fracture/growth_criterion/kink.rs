//! Stress intensity factors of an infinitely short kink, and the directions that follow from them [Amestoy1992].

use super::falling_root::falling_root;
use super::{hoop_stress, scaled};
use std::f64::consts::PI;

const PI_2: f64 = PI * PI;
const PI_3: f64 = PI_2 * PI;
const PI_4: f64 = PI_2 * PI_2;
const PI_5: f64 = PI_4 * PI;
const PI_6: f64 = PI_4 * PI_2;

/// Coefficients of `1, m², m⁴, ...` [Amestoy1992].
const F11: [f64; 11] = [
    1.0,
    -3.0 / 8.0 * PI_2,
    PI_2 - 5.0 / 128.0 * PI_4,
    PI_2 / 9.0 - 11.0 / 72.0 * PI_4 + 119.0 / 15360.0 * PI_6,
    5.07790,
    -2.88312,
    -0.0925,
    2.996,
    -4.059,
    1.63,
    4.1,
];

/// Coefficients of `m, m³, m⁵, ...` [Amestoy1992].
const F12: [f64; 10] = [
    -1.5 * PI,
    10.0 / 3.0 * PI + PI_3 / 16.0,
    -2.0 * PI - 133.0 / 180.0 * PI_3 + 59.0 / 1280.0 * PI_5,
    12.313906,
    -7.32433,
    1.5793,
    4.0216,
    -6.915,
    4.21,
    4.56,
];

/// Coefficients of `m, m³, m⁵, ...` [Amestoy1992].
const F21: [f64; 10] = [
    0.5 * PI,
    -4.0 / 3.0 * PI - PI_3 / 48.0,
    -2.0 / 3.0 * PI + 13.0 / 30.0 * PI_3 - 59.0 / 3840.0 * PI_5,
    -6.176023,
    4.44112,
    -1.5340,
    -2.0700,
    4.684,
    -3.95,
    -1.32,
];

/// Coefficients of `1, m², m⁴, ...` [Amestoy1992].
const F22: [f64; 11] = [
    1.0,
    -4.0 - 3.0 / 8.0 * PI_2,
    8.0 / 3.0 + 29.0 / 18.0 * PI_2 - 5.0 / 128.0 * PI_4,
    -32.0 / 15.0 - 4.0 / 9.0 * PI_2 - 1159.0 / 7200.0 * PI_4 + 119.0 / 15360.0 * PI_6,
    10.58254,
    -4.78511,
    -1.8804,
    7.280,
    -7.591,
    0.25,
    12.5,
];

/// Where both directions lie as multiples of the angle of the largest hoop stress: from 1 in mode I to 1.0965 in mode II.
const SOUGHT: [f64; 2] = [0.75, 1.25];

/// Stress intensity factors `(K_I, K_II)` at the tip of an infinitely short straight kink [stress·√length], exact but
/// for the truncation of the series [Amestoy1992].
///
/// - `k1`, `k2`: factors of the crack before it kinks, any sign [stress·√length]
/// - `angle`: from the direction of the crack to that of the kink, counter-clockwise positive [rad]. The series hold to
///   1e-5 up to a right angle and to 4e-4 up to 110°; they are of no use from 135° on.
pub fn kinked_factors(k1: f64, k2: f64, angle: f64) -> (f64, f64) {
    let (one, two) = factors_and_slopes(k1, k2, angle / PI);
    (one[0], two[0])
}

/// Both factors of the kink at `angle = π m`, each with its derivative by `m`.
fn factors_and_slopes(k1: f64, k2: f64, m: f64) -> ([f64; 2], [f64; 2]) {
    let (f11, f12, f21, f22) = (even(&F11, m), odd(&F12, m), odd(&F21, m), even(&F22, m));
    let combine = |a: [f64; 2], b: [f64; 2]| [a[0] * k1 + b[0] * k2, a[1] * k1 + b[1] * k2];
    (combine(f11, f12), combine(f21, f22))
}

/// Value and derivative of `Σ c_i m^(2i)`.
fn even(coefficients: &[f64], m: f64) -> [f64; 2] {
    let [value, slope] = horner(coefficients, m * m);
    [value, 2.0 * m * slope]
}

/// Value and derivative of `Σ c_i m^(2i+1)`.
fn odd(coefficients: &[f64], m: f64) -> [f64; 2] {
    let [value, slope] = horner(coefficients, m * m);
    [m * value, value + 2.0 * m * m * slope]
}

fn horner(coefficients: &[f64], x: f64) -> [f64; 2] {
    coefficients.iter().rev().fold([0.0, 0.0], |[value, slope], c| [value * x + c, slope * x + value])
}

/// Clockwise angle of the kink that releases most energy, for `k2 > 0`, [rad].
pub(super) fn clockwise_angle_of_most_energy(k1: f64, k2: f64) -> f64 {
    sought(k1, k2, |one, two| one[0] * one[1] + two[0] * two[1])
}

/// Clockwise angle of the kink without mode II, for `k2 > 0`, [rad].
pub(super) fn clockwise_angle_of_symmetry(k1: f64, k2: f64) -> f64 {
    sought(k1, k2, |_, two| two[0])
}

/// Where `falling`, of both factors of the kink and their derivatives by the clockwise angle, falls through zero.
fn sought(k1: f64, k2: f64, falling: impl Fn([f64; 2], [f64; 2]) -> f64) -> f64 {
    let (k1, k2, _) = scaled(k1.max(0.0), k2);
    let near = hoop_stress::clockwise_angle(k1, k2);
    let f = |angle: f64| {
        let (one, two) = factors_and_slopes(k1, k2, -angle / PI);
        falling([one[0], -one[1]], [two[0], -two[1]])
    };
    falling_root(f, SOUGHT[0] * near, SOUGHT[1] * near)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Degrees and `F11, F12, F21, F22` of a kink of finite length on a half-infinite crack, which differs from the
    /// infinitely short kink by its length only. The kink is a row of dislocations, each with the closed-form field that
    /// frees the faces of the main crack; their strength follows from the traction on the kink at Chebyshev points
    /// (Erdogan and Gupta), with 200, 400 and 800 of them extrapolated. Uncertain by at most 8e-6, at a right angle.
    const INTEGRAL_EQUATION: [[f64; 5]; 7] = [
        [10.0, 0.988634, -0.259679, 0.086441, 0.976371],
        [20.0, 0.955220, -0.506829, 0.168012, 0.907147],
        [30.0, 0.901739, -0.729842, 0.240249, 0.797162],
        [45.0, 0.790898, -0.998203, 0.323280, 0.572903],
        [60.0, 0.655669, -1.167991, 0.369250, 0.307871],
        [75.0, 0.511243, -1.231059, 0.376248, 0.039606],
        [90.0, 0.371867, -1.193468, 0.348083, -0.196562],
    ];

    #[test]
    fn factors_are_those_of_the_integral_equation_of_a_kink() {
        for [degrees, f11, f12, f21, f22] in INTEGRAL_EQUATION {
            for side in [1.0, -1.0] {
                let (a, c) = kinked_factors(1.0, 0.0, side * degrees.to_radians());
                let (b, d) = kinked_factors(0.0, 1.0, side * degrees.to_radians());
                for (found, expected) in [(a, f11), (b, side * f12), (c, side * f21), (d, f22)] {
                    assert!((found - expected).abs() < 1e-5, "{degrees}: {found}, {expected}");
                }
            }
        }
    }

    /// To first order the factors are the singular stresses ahead of the crack [Cotterell1980].
    #[test]
    fn small_kinks_see_the_stress_of_the_crack() {
        let angle = 1e-5_f64;
        let (one, two) = kinked_factors(2.0, 3.0, angle);
        assert!((one - (2.0 - 1.5 * angle * 3.0)).abs() < 1e-9);
        assert!((two - (3.0 + 0.5 * angle * 2.0)).abs() < 1e-9);
        assert_eq!(kinked_factors(2.0, 3.0, 0.0), (2.0, 3.0));
    }

    #[test]
    fn slopes_are_those_of_finite_differences() {
        let h = 1e-5;
        for m in [-0.45, -0.2, 0.0, 0.1, 0.4] {
            let (one, two) = factors_and_slopes(0.7, -1.1, m);
            let ((a, b), (c, d)) = (kinked_factors(0.7, -1.1, PI * (m - h)), kinked_factors(0.7, -1.1, PI * (m + h)));
            assert!((one[1] - (c - a) / (2.0 * h)).abs() < 1e-7);
            assert!((two[1] - (d - b) / (2.0 * h)).abs() < 1e-7);
        }
    }

    /// Extrema of the integral equation, interpolated between angles 5° apart: 16 of them, a polynomial of degree 15.
    #[test]
    fn directions_are_those_of_the_integral_equation() {
        for (k1, symmetric, opening, energetic, released) in [
            (0.0, 77.33008, 1.231495, 75.7565, 1.517222),
            (0.5, 66.57349, 1.505025, 65.7766, 2.265345),
            (1.0, 56.95797, 1.826469, 56.5652, 3.336075),
            (2.0, 42.12590, 2.582877, 42.0294, 6.671262),
        ] {
            let angle = clockwise_angle_of_symmetry(k1, 1.0);
            assert!((angle.to_degrees() - symmetric).abs() < 1e-4);
            assert!((kinked_factors(k1, 1.0, -angle).0 - opening).abs() < 1e-5);
            let angle = clockwise_angle_of_most_energy(k1, 1.0);
            // A maximum is known to the root of the accuracy of the function.
            assert!((angle.to_degrees() - energetic).abs() < 3e-4);
            let (one, two) = kinked_factors(k1, 1.0, -angle);
            assert!((one * one + two * two - released).abs() < 1e-5);
        }
    }

    fn check_extrema(k1: f64, k2: f64) {
        let (size, of_kink) = (k1.hypot(k2), |angle: f64| kinked_factors(k1, k2, -angle));
        let symmetric = clockwise_angle_of_symmetry(k1, k2);
        assert!(of_kink(symmetric).1.abs() < 1e-14 * size);
        assert!(of_kink(symmetric).0 > 0.9 * size);
        let energy = |angle: f64| of_kink(angle).0.powi(2) + of_kink(angle).1.powi(2);
        let found = clockwise_angle_of_most_energy(k1, k2);
        assert!(((energy(found + 1e-5) - energy(found - 1e-5)) / 2e-5).abs() < 1e-9 * size * size);
        // Of all directions whose kink is open, on both sides.
        let most = (-9500..=9500)
            .map(|i| (f64::from(i) * 0.01).to_radians())
            .filter(|angle| of_kink(*angle).0 > 0.0)
            .map(energy)
            .fold(0.0, f64::max);
        assert!(energy(found) >= most * (1.0 - 1e-14) && of_kink(found).0 > 0.0);
    }

    #[test]
    fn energy_is_the_largest_of_all_directions_and_sliding_vanishes() {
        for k1 in [0.0, 0.003, 0.1, 0.4, 1.0, 3.0, 20.0, 1e4] {
            check_extrema(k1, 1.0);
        }
    }

    #[test]
    fn touching_faces_carry_compression() {
        assert_eq!(clockwise_angle_of_symmetry(-3.0, 1.0), clockwise_angle_of_symmetry(0.0, 1.0));
        assert_eq!(clockwise_angle_of_most_energy(-3.0, 1.0), clockwise_angle_of_most_energy(0.0, 1.0));
    }
}
