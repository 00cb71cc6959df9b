//! Isotropic linear elasticity in the plane [EFG, Eqs. 20, 23, 24].

use crate::math::Matrix2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What the third direction does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PlaneState {
    /// No strain normal to the plane: thick bodies.
    Strain,
    /// No stress normal to the plane: thin plates.
    Stress,
}

/// Young's modulus, Poisson's ratio and plane state of a homogeneous body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elasticity {
    /// Young's modulus [stress], positive.
    pub young: f64,
    /// Poisson's ratio, above -1 and below 0.5.
    pub poisson: f64,
    /// Plane strain or plane stress.
    pub plane: PlaneState,
}

impl Elasticity {
    /// Shear modulus μ [stress].
    pub fn shear(&self) -> f64 {
        0.5 * self.young / (1.0 + self.poisson)
    }

    /// First Lamé constant of the plane problem [stress]; plane stress has 2λμ/(λ+2μ) in place of λ.
    pub fn lame(&self) -> f64 {
        let nu = self.poisson;
        match self.plane {
            PlaneState::Strain => self.young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            PlaneState::Stress => self.young * nu / (1.0 - nu * nu),
        }
    }

    /// Kolosov constant κ [EFG, after Eq. 38].
    pub fn kolosov(&self) -> f64 {
        match self.plane {
            PlaneState::Strain => 3.0 - 4.0 * self.poisson,
            PlaneState::Stress => (3.0 - self.poisson) / (1.0 + self.poisson),
        }
    }

    /// E' with `J = (K_I² + K_II²) / E'` [stress].
    pub fn effective_young(&self) -> f64 {
        match self.plane {
            PlaneState::Strain => self.young / (1.0 - self.poisson * self.poisson),
            PlaneState::Stress => self.young,
        }
    }

    /// In-plane stress of a displacement gradient, `gradient[(i, j)] = ∂u_i/∂x_j`.
    #[inline]
    pub fn stress(&self, gradient: &Matrix2) -> Matrix2 {
        let mu = self.shear();
        let trace = self.lame() * gradient.trace();
        (gradient + gradient.transpose()) * mu + Matrix2::from_diagonal_element(trace)
    }

    /// In-plane strain of an in-plane stress.
    pub fn strain(&self, stress: &Matrix2) -> Matrix2 {
        let (lambda, mu) = (self.lame(), self.shear());
        let trace = stress.trace() * lambda / (2.0 * (lambda + mu));
        (stress - Matrix2::from_diagonal_element(trace)) / (2.0 * mu)
    }

    /// Normal stress out of the plane.
    pub fn out_of_plane_stress(&self, stress: &Matrix2) -> f64 {
        match self.plane {
            PlaneState::Strain => self.poisson * stress.trace(),
            PlaneState::Stress => 0.0,
        }
    }

    /// Normal strain out of the plane.
    pub fn out_of_plane_strain(&self, stress: &Matrix2) -> f64 {
        match self.plane {
            PlaneState::Strain => 0.0,
            PlaneState::Stress => -self.poisson / self.young * stress.trace(),
        }
    }

    /// Von Mises stress of an in-plane stress state.
    pub fn von_mises(&self, stress: &Matrix2) -> f64 {
        let (x, y, xy) = (stress[(0, 0)], stress[(1, 1)], stress[(0, 1)]);
        let z = self.out_of_plane_stress(stress);
        (0.5 * ((x - y).powi(2) + (y - z).powi(2) + (z - x).powi(2)) + 3.0 * xy * xy).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strain_inverts_stress_and_uniaxial_tension_is_hookes_law() {
        for plane in [PlaneState::Strain, PlaneState::Stress] {
            let material = Elasticity { young: 7.0, poisson: 0.3, plane };
            let gradient = Matrix2::new(0.1, 0.2, -0.4, 0.5);
            let strain = material.strain(&material.stress(&gradient));
            assert!((strain - (gradient + gradient.transpose()) * 0.5).norm() < 1e-15);
            let uniaxial = material.strain(&Matrix2::new(1.0, 0.0, 0.0, 0.0));
            assert!((uniaxial[(0, 0)] - 1.0 / material.effective_young()).abs() < 1e-15);
        }
    }
}
