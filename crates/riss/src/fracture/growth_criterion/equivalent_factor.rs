//! One stress intensity factor in place of two, to compare with the toughness or to put into a law of growth.

use super::hoop_stress::{circumferential_factor, clockwise_angle};
use super::scaled;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Equivalent stress intensity factor of a crack tip under mixed mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EquivalentFactor {
    /// `cos²(θ/2) (K_I cos(θ/2) - 3 K_II sin(θ/2))` in the direction θ of largest hoop stress [ErdoganSih1963].
    #[default]
    MaximumCircumferentialStress,
    /// `(K_I⁴ + 8 K_II⁴)^¼`, from fatigue tests [Tanaka1974].
    Tanaka,
    /// `√(K_I² + K_II²)`: the energy that straight growth releases [Rice1968].
    EnergyReleaseRate,
    /// `((K_I² + K_II²)² + 4 K_I² K_II²)^¼`: the configurational force reaches the fracture energy [CPM, section 3.2].
    ConfigurationalForce,
    /// `K_I` alone.
    ModeI,
}

impl EquivalentFactor {
    /// The factor that drives growth [stress·√length]; even in `k2`, equal to `k1` for `k1 > 0` without mode II.
    ///
    /// - `k1`: mode I factor [stress·√length]; where it is negative the faces touch: all powers of factors take zero in its place, the others may return a negative factor, which drives nothing
    /// - `k2`: mode II factor, any sign [stress·√length]
    pub fn value(&self, k1: f64, k2: f64) -> f64 {
        let k2 = k2.abs();
        match self {
            Self::MaximumCircumferentialStress => {
                let angle = if k2 > 0.0 { clockwise_angle(k1, k2) } else { 0.0 };
                circumferential_factor(k1, k2, -angle)
            }
            // Differs from [Tanaka1974]: the tests were under tension, an even power must not make it of compression.
            Self::Tanaka => {
                let (k1, k2, scale) = scaled(k1.max(0.0), k2);
                scale * (k1.powi(4) + 8.0 * k2.powi(4)).sqrt().sqrt()
            }
            Self::EnergyReleaseRate => k1.max(0.0).hypot(k2),
            Self::ConfigurationalForce => {
                let (k1, k2, scale) = scaled(k1.max(0.0), k2);
                scale * (k1 * k1 + k2 * k2).hypot(2.0 * k1 * k2).sqrt()
            }
            Self::ModeI => k1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::EquivalentFactor::{
        ConfigurationalForce, EnergyReleaseRate, MaximumCircumferentialStress, ModeI, Tanaka,
    };
    use super::*;

    const ALL: [EquivalentFactor; 5] =
        [MaximumCircumferentialStress, Tanaka, EnergyReleaseRate, ConfigurationalForce, ModeI];

    fn check_value(factor: EquivalentFactor, k1: f64, k2: f64, expected: f64) {
        for k2 in [k2, -k2] {
            let found = factor.value(k1, k2);
            assert!((found - expected).abs() <= 1e-15 * expected.abs(), "{factor:?}: {found}, {expected}");
        }
    }

    #[test]
    fn mode_one_is_its_own_equivalent() {
        for factor in ALL {
            for k1 in [0.0, 1.0, 3.7e5, 1e-200, 1e200] {
                check_value(factor, k1, 0.0, k1);
            }
        }
    }

    #[test]
    fn pure_mode_two() {
        // cos θ = 1/3, cos²(θ/2) = 2/3, sin(θ/2) = 1/√3: 3 · 2/3 / √3.
        check_value(MaximumCircumferentialStress, 0.0, 5.0, 10.0 / 3.0_f64.sqrt());
        check_value(Tanaka, 0.0, 5.0, 5.0 * 8.0_f64.sqrt().sqrt());
        check_value(EnergyReleaseRate, 0.0, 5.0, 5.0);
        check_value(ConfigurationalForce, 0.0, 5.0, 5.0);
        check_value(ModeI, 0.0, 5.0, 0.0);
    }

    #[test]
    fn mixed_mode() {
        // tan(θ/2) = 1/2 for equal factors: 4/5 · (2 + 3)/√5.
        check_value(MaximumCircumferentialStress, 1.0, 1.0, 0.8 * 5.0_f64.sqrt());
        check_value(Tanaka, 1.0, 1.0, 3.0_f64.sqrt());
        check_value(EnergyReleaseRate, 3.0, 4.0, 5.0);
        // |g| E' = |(9 + 1, -2 · 3)|.
        check_value(ConfigurationalForce, 3.0, 1.0, 136.0_f64.sqrt().sqrt());
        check_value(ModeI, 3.0, 4.0, 3.0);
    }

    #[test]
    fn closed_cracks_are_driven_by_mode_two_at_most() {
        // θ = 90° for K_I = -K_II: 1/2 · (-1 + 3)/√2.
        check_value(MaximumCircumferentialStress, -1.0, 1.0, 0.5_f64.sqrt());
        check_value(MaximumCircumferentialStress, -2.0, 0.0, -2.0);
        check_value(Tanaka, -100.0, 1.0, 8.0_f64.sqrt().sqrt());
        check_value(EnergyReleaseRate, -100.0, 1.0, 1.0);
        check_value(ConfigurationalForce, -100.0, 1.0, 1.0);
    }

    #[test]
    fn powers_stay_in_range() {
        for size in [1e-300, 1e-90, 1e90, 1e300] {
            check_value(Tanaka, size, size, size * 3.0_f64.sqrt());
        }
        assert!((MaximumCircumferentialStress.value(1e300, 1e300) / 0.8e300 / 5.0_f64.sqrt() - 1.0).abs() < 1e-15);
    }
}
