//! Which way a crack tip grows in the plane, and how hard it is driven.
//!
//! [`hoop_stress`], [`kink`] and [`energy_density`] hold the functions that the criteria maximize or minimize,
//! [`falling_root`] finds the extrema, [`equivalent_factor`] makes one number of two factors.
//!
//! Angles turn counter-clockwise from the direction of the crack at its tip; `K_II > 0` slides the face on the left of
//! that direction forwards, and turns the crack to the right, to negative angles.

pub mod energy_density;
pub mod equivalent_factor;
pub mod hoop_stress;
pub mod kink;

mod falling_root;

use crate::material::Elasticity;
use crate::math::Vector2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use equivalent_factor::EquivalentFactor;
pub use kink::kinked_factors;

/// Direction in which a crack tip grows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum GrowthCriterion {
    /// Where the singular hoop stress at the tip is largest [ErdoganSih1963].
    #[default]
    MaximumCircumferentialStress,
    /// Where a short kink would release most energy, by the exact factors of the kink [Amestoy1992].
    MaximumEnergyReleaseRate,
    /// Where the density of strain energy ahead of the tip is least; depends on Poisson's ratio [Sih1974].
    MinimumStrainEnergyDensity,
    /// Where a short kink would open without sliding, by the exact factors of the kink [Goldstein1974; Amestoy1992].
    LocalSymmetry,
    /// Where the hoop stress with its T-stress term is largest at a distance from the tip [Williams1972; Finnie1973].
    MaximumCircumferentialStressWithTStress {
        /// Distance from the tip, zero or positive [length]; zero leaves the T-stress out.
        #[schemars(range(min = 0.0))]
        critical_distance: f64,
    },
    /// Along the configurational force on the tip [CPM, section 3.2]: at most 45° off in a step, as small increments turn
    /// into the path of the others.
    ConfigurationalForce,
}

/// What loads a crack tip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TipDriving {
    /// Mode I stress intensity factor, positive if the crack opens [stress·√length].
    pub k1: f64,
    /// Mode II stress intensity factor, positive if the left face slides forwards [stress·√length].
    pub k2: f64,
    /// Stress along the crack that is constant at the tip [stress].
    pub t_stress: f64,
    /// Configurational force, ahead and to the left, if it was integrated [stress·length]; else that of the factors.
    pub force: Option<Vector2>,
}

impl GrowthCriterion {
    /// Angle from the present direction of the crack to the direction of growth [rad], counter-clockwise positive.
    ///
    /// Odd in `K_II` to the last bit and zero for `K_II = 0`, also where a large T-stress makes the straight path
    /// unstable: then the least `K_II` chooses the side. Finite for finite input. For `K_I < 0` the criteria of the kink
    /// take `K_I = 0`, since faces that touch carry the pressure; the others follow their fields as they are. A
    /// configurational force that was integrated is followed whatever the factors are.
    pub fn kink_angle(&self, driving: &TipDriving, material: &Elasticity) -> f64 {
        if let (Self::ConfigurationalForce, Some(force)) = (self, driving.force) {
            return force.y.atan2(force.x);
        }
        if driving.k2 == 0.0 {
            return 0.0;
        }
        // All criteria are sought for K_II > 0 in the clockwise angle.
        let (k1, k2) = (driving.k1, driving.k2.abs());
        let clockwise = match *self {
            Self::MaximumCircumferentialStress => hoop_stress::clockwise_angle(k1, k2),
            Self::MaximumEnergyReleaseRate => kink::clockwise_angle_of_most_energy(k1, k2),
            Self::MinimumStrainEnergyDensity => energy_density::clockwise_angle(k1, k2, material.kolosov()),
            Self::LocalSymmetry => kink::clockwise_angle_of_symmetry(k1, k2),
            Self::MaximumCircumferentialStressWithTStress { critical_distance } => {
                hoop_stress::clockwise_angle_with_t_stress(k1, k2, driving.t_stress, critical_distance)
            }
            Self::ConfigurationalForce => {
                // Scaled, so that squares stay in range; the angle of the force does not depend on the moduli.
                let (k1, k2, _) = scaled(k1, k2);
                let (ahead, left) = (k1.mul_add(k1, k2 * k2), -2.0 * k1 * k2);
                (-left).atan2(ahead)
            }
        };
        -driving.k2.signum() * clockwise
    }
}

/// Both numbers over the larger magnitude, so that no power of them leaves the range of `f64`; zeros stay zeros.
fn scaled(k1: f64, k2: f64) -> (f64, f64, f64) {
    let scale = k1.abs().max(k2.abs());
    if scale > 0.0 { (k1 / scale, k2 / scale, scale) } else { (k1, k2, 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::PlaneState;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;
    use std::f64::consts::FRAC_PI_4;

    const MATERIAL: Elasticity = Elasticity { young: 1.0, poisson: 0.3, plane: PlaneState::Strain };
    const ALL: [GrowthCriterion; 7] = [
        GrowthCriterion::MaximumCircumferentialStress,
        GrowthCriterion::MaximumEnergyReleaseRate,
        GrowthCriterion::MinimumStrainEnergyDensity,
        GrowthCriterion::LocalSymmetry,
        GrowthCriterion::MaximumCircumferentialStressWithTStress { critical_distance: 0.0 },
        GrowthCriterion::MaximumCircumferentialStressWithTStress { critical_distance: 0.1 },
        GrowthCriterion::ConfigurationalForce,
    ];

    fn angle(criterion: GrowthCriterion, k1: f64, k2: f64, t_stress: f64) -> f64 {
        criterion.kink_angle(&TipDriving { k1, k2, t_stress, force: None }, &MATERIAL)
    }

    /// All criteria agree with local symmetry to first order, `θ = -2 K_II / K_I` [Cotterell1980].
    #[test]
    fn small_angles_are_twice_the_ratio_of_the_factors() {
        for criterion in ALL {
            for ratio in [1e-4, 1e-9, 1e-40, 1e-200, 1e-300] {
                let found = angle(criterion, 3.0, 3.0 * ratio, 0.0) / (-2.0 * ratio);
                assert!((found - 1.0).abs() < 10.0 * ratio * ratio + 1e-12, "{criterion:?}, {ratio}: {found}");
            }
        }
    }

    /// tan θ = g_2/g_1 = -2 K_I K_II / (K_I² + K_II²) [CPM, Eq. 21]: none in pure mode II, 45° for equal factors.
    #[test]
    fn configurational_force_points_the_way() {
        let criterion = GrowthCriterion::ConfigurationalForce;
        assert_eq!(angle(criterion, 0.0, 1.0, 0.0).abs(), 0.0);
        assert!((angle(criterion, 2.0, 2.0, 0.0) + FRAC_PI_4).abs() < 1e-15);
        assert!((angle(criterion, 3.0, -1.0, 9.0) - 0.6f64.atan()).abs() < 1e-15);
        let force = Some(Vector2::new(2.0, -1.0));
        let driving = TipDriving { k1: 1.0, k2: 0.0, t_stress: 0.0, force };
        assert!((criterion.kink_angle(&driving, &MATERIAL) + 0.5f64.atan()).abs() < 1e-15);
        let hoop = GrowthCriterion::MaximumCircumferentialStress;
        assert_eq!(hoop.kink_angle(&driving, &MATERIAL), 0.0);
    }

    #[test]
    fn nothing_turns_a_crack_without_mode_two() {
        for criterion in ALL {
            for (k1, t) in [(1.0, 0.0), (1.0, 50.0), (-1.0, 1.0), (0.0, 1.0), (0.0, 0.0)] {
                for k2 in [0.0, -0.0] {
                    assert_eq!(angle(criterion, k1, k2, t).to_bits(), 0.0_f64.to_bits());
                }
            }
        }
    }

    #[test]
    fn extreme_numbers_give_finite_angles() {
        let numbers = [0.0, 5e-324, 1e-310, 1e-160, 1e-9, 1.0, 1e9, 1e160, f64::MAX];
        let sides = [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
        for criterion in ALL {
            for i in 0..numbers.len().pow(3) {
                let [k1, k2, t] = [1, 9, 81].map(|stride| numbers[i / stride % numbers.len()]);
                for (a, b) in sides {
                    let found = angle(criterion, a * k1, k2, b * t);
                    let right =
                        if criterion == GrowthCriterion::ConfigurationalForce && a < 0.0 { FRAC_PI_4 } else { 0.0 };
                    assert!((-std::f64::consts::PI..=right).contains(&found), "{criterion:?} {k1} {k2} {t}: {found}");
                }
            }
        }
    }

    #[test]
    fn case_files_name_the_criteria_in_kebab_case() {
        let text = "{\"maximum-circumferential-stress-with-t-stress\":{\"critical-distance\":0.1}}";
        assert!(serde_json::from_str::<GrowthCriterion>(text).is_err(), "keys of fields keep their underscores");
        assert_eq!(serde_json::from_str::<GrowthCriterion>(&text.replace("l-d", "l_d")).unwrap(), ALL[5]);
        assert_eq!(serde_json::from_str::<GrowthCriterion>("\"local-symmetry\"").unwrap(), ALL[3]);
        assert_eq!(GrowthCriterion::default(), ALL[0]);
    }

    proptest! {
        #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn angles_are_odd_in_mode_two_and_free_of_units(k1 in -5.0..5.0, k2 in 1e-6..5.0, t in -5.0..5.0) {
            for criterion in ALL {
                let found = angle(criterion, k1, k2, t);
                prop_assert!(found < 0.0 || criterion == GrowthCriterion::ConfigurationalForce && k1 <= 0.0);
                prop_assert_eq!((-found).to_bits(), angle(criterion, k1, -k2, t).to_bits());
                // A power of two scales without rounding.
                prop_assert_eq!(found.to_bits(), angle(criterion, 1024.0 * k1, 1024.0 * k2, 1024.0 * t).to_bits());
            }
        }
    }
}
