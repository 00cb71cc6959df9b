//! The NASGRO equation: growth from the near threshold regime to fracture, with Newman's crack closure.

use super::growth_law::Rate;
use super::{FieldProblem, Problems};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The closure function is constant below [NASGRO].
const LEAST_STRESS_RATIO: f64 = -2.0;

/// da/dN = C [(1 − f)/(1 − R) ΔK]^m (1 − ΔK_th/ΔK)^p / (1 − K_max/K_c)^q [NASGRO].
///
/// ΔK = K_max − K_min, compression included; f is the ratio of opening to largest stress intensity factor [Newman1984].
/// The threshold is that of long cracks: ΔK_th = ΔK_1 [(1 − R)/(1 − f)]^(1 + R C⁺) / (1 − A₀)^((1 − R) C⁺) for R ≥ 0 and
/// ΔK_1 [(1 − R)/(1 − f)]^(1 + R C⁻) / (1 − A₀)^(C⁺ − R C⁻) for R < 0, where A₀ is f at R = 0. A cycle with R < −2 does
/// what one with the same K_max and R = −2 does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Nasgro {
    /// C, positive [length per cycle / (stress·√length)^m].
    pub coefficient: f64,
    /// m, positive.
    pub exponent: f64,
    /// Exponent of the threshold term, not negative.
    pub p: f64,
    /// Exponent of the toughness term, not negative.
    pub q: f64,
    /// K_c for the thickness at hand, positive [stress·√length]: K_max at which the crack is unstable.
    pub toughness: f64,
    /// ΔK_1, positive [stress·√length]: threshold range of a long crack for R towards 1.
    pub threshold: f64,
    /// C⁺: spread of the threshold over positive stress ratios.
    #[serde(default)]
    pub threshold_spread: f64,
    /// C⁻: spread of the threshold over negative stress ratios.
    #[serde(default)]
    pub negative_threshold_spread: f64,
    /// α: constraint at the tip, from 1 in plane stress to 3 in plane strain.
    pub alpha: f64,
    /// S_max/σ₀: largest applied stress over flow stress, from 0 to less than 1.
    #[serde(default = "default_stress_level")]
    pub stress_level: f64,
}

/// The value of the material tables in the manual [NASGRO].
fn default_stress_level() -> f64 {
    0.3
}

impl Nasgro {
    /// Growth in a cycle whose `maximum` is positive, above `minimum` and below the toughness.
    pub(super) fn rate_below_toughness(&self, minimum: f64, maximum: f64) -> Rate {
        let ratio = (minimum / maximum).max(LEAST_STRESS_RATIO);
        let range = maximum * (1.0 - ratio);
        let distance = 1.0 - self.threshold_range(ratio) / range;
        if !(distance > 0.0) {
            return Rate::Arrested;
        }
        let effective = maximum * (1.0 - self.opening(ratio));
        let growth = self.coefficient * effective.powf(self.exponent) * distance.powf(self.p);
        Rate::from_growth(growth / (1.0 - maximum / self.toughness).powf(self.q))
    }

    /// Opening over largest stress intensity factor, f, for a stress ratio below 1 [Newman1984].
    pub fn opening(&self, stress_ratio: f64) -> f64 {
        let (a0, a1) = self.opening_at_zero();
        let a3 = 2.0 * a0 + a1 - 1.0;
        let a2 = 1.0 - a0 - a1 - a3;
        let r = stress_ratio;
        if r >= 0.0 { (a0 + r * (a1 + r * (a2 + r * a3))).max(r) } else { a0 + a1 * r.max(LEAST_STRESS_RATIO) }
    }

    /// Threshold range at a stress ratio below 1 [stress·√length].
    pub fn threshold_range(&self, stress_ratio: f64) -> f64 {
        let (a0, _) = self.opening_at_zero();
        let r = stress_ratio.max(LEAST_STRESS_RATIO);
        let (positive, negative) = (self.threshold_spread, self.negative_threshold_spread);
        let (spread, a0_power) =
            if r >= 0.0 { (positive, (1.0 - r) * positive) } else { (negative, positive - r * negative) };
        self.threshold * ((1.0 - r) / (1.0 - self.opening(r))).powf(1.0 + r * spread) / (1.0 - a0).powf(a0_power)
    }

    /// A₀ and A₁: the opening at R = 0 and its slope [Newman1984].
    fn opening_at_zero(&self) -> (f64, f64) {
        let alpha = self.alpha;
        let by_level = (std::f64::consts::FRAC_PI_2 * self.stress_level).cos().powf(1.0 / alpha);
        ((0.825 - 0.34 * alpha + 0.05 * alpha * alpha) * by_level, (0.415 - 0.071 * alpha) * self.stress_level)
    }

    pub(super) fn problems(&self) -> Vec<FieldProblem> {
        let mut problems = Problems::of("nasgro");
        problems.positive("coefficient", self.coefficient);
        problems.positive("exponent", self.exponent);
        problems.demand("p", self.p, "at least 0", |v| v >= 0.0);
        problems.demand("q", self.q, "at least 0", |v| v >= 0.0);
        problems.positive("toughness", self.toughness);
        problems.positive("threshold", self.threshold);
        problems.finite("threshold_spread", self.threshold_spread);
        problems.finite("negative_threshold_spread", self.negative_threshold_spread);
        problems.demand("alpha", self.alpha, "1 to 3", |v| (1.0..=3.0).contains(&v));
        problems.demand("stress_level", self.stress_level, "0 to less than 1", |v| (0.0..1.0).contains(&v));
        if self.threshold >= self.toughness {
            problems.report("threshold", format!("is {}", self.threshold), "below `toughness`");
        }
        problems.found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(alpha: f64, stress_level: f64) -> Nasgro {
        Nasgro {
            coefficient: 2e-11,
            exponent: 3.0,
            p: 0.5,
            q: 1.0,
            toughness: 80.0,
            threshold: 1.2,
            threshold_spread: 1.5,
            negative_threshold_spread: 0.1,
            alpha,
            stress_level,
        }
    }

    fn check_opening(alpha: f64, stress_level: f64, ratio: f64, expected: f64) {
        let f = law(alpha, stress_level).opening(ratio);
        assert!((f - expected).abs() < 1e-14, "alpha {alpha}, level {stress_level}, R {ratio}: {f}, not {expected}");
    }

    /// Sums of the rational coefficients of [Newman1984] by hand: without stress A₀ = 0.535, 0.345, 0.255 for
    /// α = 1, 2, 3, A₁ = 0, A₃ = 2 A₀ − 1 and A₂ = 2 − 3 A₀.
    #[test]
    fn the_closure_function_has_the_values_of_the_formula() {
        check_opening(1.0, 0.0, 0.0, 0.535);
        check_opening(2.0, 0.0, 0.0, 0.345);
        check_opening(3.0, 0.0, 0.0, 0.255);
        check_opening(1.0, 0.0, 0.5, 0.535 + 0.395 / 4.0 + 0.07 / 8.0);
        check_opening(1.0, 0.0, -1.0, 0.535);
        // cos(π/6) is √3/2, cos(π/4) is 1/√2; A₁ is 0.344/3 for α = 1 and 0.202/2 for α = 3.
        check_opening(1.0, 1.0 / 3.0, 0.0, 0.535 * 0.75_f64.sqrt());
        check_opening(1.0, 1.0 / 3.0, -1.0, 0.535 * 0.75_f64.sqrt() - 0.344 / 3.0);
        check_opening(3.0, 0.5, -2.0, 0.255 / 2_f64.powf(1.0 / 6.0) - 0.202);
        check_opening(3.0, 0.5, -5.0, 0.255 / 2_f64.powf(1.0 / 6.0) - 0.202);
    }

    /// With α = 3 and no stress the cubic 0.255 + 1.235 R² − 0.49 R³ is R + (1 − R)² (0.255 − 0.49 R), below R from
    /// R = 0.5204 on.
    #[test]
    fn the_crack_is_always_open_at_large_stress_ratios() {
        check_opening(3.0, 0.0, 0.5, 0.5 + 0.25 * 0.01);
        check_opening(3.0, 0.0, 0.6, 0.6);
        for alpha in [1.0, 2.0, 3.0] {
            for level in [0.0, 0.3, 0.8] {
                check_opening(alpha, level, 1.0, 1.0);
                let near = law(alpha, level).opening(1.0 - 1e-6);
                // f'(1) is 1 by the choice of A₂ and A₃, so f − R vanishes quadratically.
                assert!((near - (1.0 - 1e-6)).abs() < 1e-11, "{alpha} {level}: {near}");
            }
        }
    }

    /// Limits of the threshold equation: ΔK_1/(1 − A₀)^(1 + C⁺) at R = 0 from both sides, ΔK_1 towards R = 1.
    #[test]
    fn the_threshold_has_its_limits() {
        let law = law(2.0, 0.0);
        let at_zero = 1.2 / (1.0_f64 - 0.345).powf(2.5);
        assert!((law.threshold_range(0.0) - at_zero).abs() < 1e-13);
        assert!((law.threshold_range(-1e-12) - at_zero).abs() < 1e-10);
        assert!((law.threshold_range(1.0 - 1e-7) - 1.2).abs() < 1e-5);
        // R = −1: [2/0.655]^0.9 / 0.655^1.6.
        let expected = 1.2 * (2.0_f64 / 0.655).powf(0.9) / 0.655_f64.powf(1.6);
        assert!((law.threshold_range(-1.0) - expected).abs() < 1e-13);
    }

    /// Without the end terms the equation is a power law of the open part of the cycle, where f is 0.345 up to R = 0 and
    /// R + (1 − R)² (0.345 − 0.31 R) above.
    #[test]
    fn the_middle_is_a_power_law_of_the_effective_range() {
        let plain = Nasgro { p: 0.0, q: 0.0, ..law(2.0, 0.0) };
        for (minimum, effective) in [(0.0, 20.0 * 0.655), (-20.0, 20.0 * 0.655), (18.0, 20.0 * (0.1 - 0.01 * 0.066))] {
            let Rate::Growing(rate) = plain.rate_below_toughness(minimum, 20.0) else { panic!("grows") };
            let expected = 2e-11 * f64::powi(effective, 3);
            assert!((rate / expected - 1.0).abs() < 1e-13, "{minimum}: {rate}, not {expected}");
        }
    }

    #[test]
    fn compression_beyond_the_fit_adds_nothing() {
        let law = law(1.5, 0.4);
        assert_eq!(law.rate_below_toughness(-20.0, 10.0), law.rate_below_toughness(-300.0, 10.0));
        assert_eq!(law.rate_below_toughness(-300.0, 1.0), Rate::Arrested);
    }
}
