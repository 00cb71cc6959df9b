//! Closed-form solutions of plane elasticity: loads, boundary values and references for errors.
//!
//! Knows materials, but no model and no nodes.

pub mod cantilever;
pub mod crack_front_field;
pub mod crack_tip_field;
pub mod plate_with_hole;

use crate::material::Elasticity;
use crate::math::{Matrix2, Vector2};
pub use cantilever::Cantilever;
pub use crack_front_field::{CrackFrontField, out_of_plane_gradient};
pub use crack_tip_field::CrackTipField;
pub use plate_with_hole::PlateWithHole;

/// A displacement field that satisfies equilibrium without body force.
pub trait ExactField: std::fmt::Debug + Send + Sync {
    /// Displacement [length].
    fn displacement(&self, material: &Elasticity, at: Vector2) -> Vector2;
    /// Displacement gradient, `[(i, j)] = ∂u_i/∂x_j`.
    fn gradient(&self, material: &Elasticity, at: Vector2) -> Matrix2;
    /// In-plane stress [stress].
    fn stress(&self, material: &Elasticity, at: Vector2) -> Matrix2 {
        material.stress(&self.gradient(material, at))
    }
}

/// `u = constant + gradient · x`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearField {
    /// Displacement at the origin [length].
    pub constant: Vector2,
    /// Displacement gradient.
    pub gradient: Matrix2,
}

impl ExactField for LinearField {
    fn displacement(&self, _: &Elasticity, at: Vector2) -> Vector2 {
        self.constant + self.gradient * at
    }
    fn gradient(&self, _: &Elasticity, _: Vector2) -> Matrix2 {
        self.gradient
    }
}

/// Gradient from the derivatives of the displacement by the polar coordinates `r`, `theta`.
fn gradient_from_polar(r: f64, theta: f64, by_r: Vector2, by_theta: Vector2) -> Matrix2 {
    let (sin, cos) = theta.sin_cos();
    let x = by_r * cos - by_theta * (sin / r);
    let y = by_r * sin + by_theta * (cos / r);
    Matrix2::from_columns(&[x, y])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::PlaneState;

    /// Gradients against finite differences, and equilibrium of the stress.
    fn check_field(field: &dyn ExactField, points: &[(f64, f64)]) {
        for plane in [PlaneState::Strain, PlaneState::Stress] {
            let material = Elasticity { young: 3.0, poisson: 0.27, plane };
            for &(x, y) in points {
                let at = Vector2::new(x, y);
                let h = 1e-5;
                let mut divergence = Vector2::zeros();
                for j in 0..2 {
                    let step = Vector2::ith(j, h);
                    let u = field.displacement(&material, at + step) - field.displacement(&material, at - step);
                    let exact = field.gradient(&material, at).column(j).into_owned();
                    assert!((u / (2.0 * h) - exact).norm() < 1e-8 * (1.0 + exact.norm()), "{field:?} at {at:?}");
                    let s = field.stress(&material, at + step) - field.stress(&material, at - step);
                    divergence += s.column(j) / (2.0 * h);
                }
                assert!(divergence.norm() < 1e-7, "{field:?} at {at:?} is not in equilibrium: {divergence:?}");
            }
        }
    }

    const POINTS: [(f64, f64); 4] = [(1.3, 0.4), (-0.9, 1.7), (0.2, -2.0), (-1.5, -0.6)];

    #[test]
    fn gradients_and_equilibrium() {
        check_field(&LinearField { constant: Vector2::new(1.0, 2.0), gradient: Matrix2::new(1., 2., 3., 4.) }, &POINTS);
        check_field(&PlateWithHole { center: Vector2::new(0.1, 0.2), radius: 0.7, stress: 2.0 }, &POINTS);
        check_field(&Cantilever { length: 8.0, height: 2.0, load: 1.5 }, &POINTS);
        check_field(
            &CrackTipField { tip: Vector2::new(0.1, 0.0), angle: 0.3, k1: 1.0, k2: -0.7, t_stress: 0.4 },
            &POINTS,
        );
    }

    #[test]
    fn hole_has_stress_concentration_three_and_free_edge() {
        let material = Elasticity { young: 3.0, poisson: 0.27, plane: PlaneState::Strain };
        let field = PlateWithHole { center: Vector2::zeros(), radius: 0.7, stress: 2.0 };
        let top = field.stress(&material, Vector2::new(0.0, 0.7));
        assert!((top[(0, 0)] - 6.0).abs() < 1e-12);
        let n = crate::math::direction(0.8);
        assert!((field.stress(&material, n * 0.7) * n).norm() < 1e-12);
        assert!((field.stress(&material, n * 1e6)[(0, 0)] - 2.0).abs() < 1e-9);
    }

    #[test]
    fn crack_faces_are_free_and_stress_ahead_is_k_over_root_two_pi_r() {
        let material = Elasticity { young: 3.0, poisson: 0.27, plane: PlaneState::Stress };
        let field = CrackTipField { tip: Vector2::zeros(), angle: 0.0, k1: 2.0, k2: 3.0, t_stress: 0.5 };
        let ahead = field.stress(&material, Vector2::new(0.04, 0.0));
        let unit = 1.0 / (2.0 * std::f64::consts::PI * 0.04).sqrt();
        assert!((ahead[(1, 1)] - 2.0 * unit).abs() < 1e-12 && (ahead[(0, 1)] - 3.0 * unit).abs() < 1e-12);
        let face = field.stress(&material, Vector2::new(-0.04, 1e-17));
        assert!(face[(1, 1)].abs() < 1e-12 && face[(0, 1)].abs() < 1e-12);
    }
}
