//! Infinite plate with a circular hole under uniaxial tension (Kirsch) [EFG, Eq. 35].

use super::{ExactField, gradient_from_polar};
use crate::material::Elasticity;
use crate::math::{Matrix2, Vector2};

/// Remote tension along x; the hole is free of traction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateWithHole {
    /// Center of the hole.
    pub center: Vector2,
    /// Radius of the hole [length].
    pub radius: f64,
    /// Remote stress in the x direction [stress].
    pub stress: f64,
}

impl PlateWithHole {
    fn polar(&self, at: Vector2) -> (f64, f64) {
        let d = at - self.center;
        (d.norm(), d.y.atan2(d.x))
    }
}

impl ExactField for PlateWithHole {
    fn displacement(&self, material: &Elasticity, at: Vector2) -> Vector2 {
        let (r, theta) = self.polar(at);
        let kappa = material.kolosov();
        let (a, b) = (self.radius * self.radius / r, self.radius.powi(4) / r.powi(3));
        let (s1, c1) = theta.sin_cos();
        let (s3, c3) = (3.0 * theta).sin_cos();
        Vector2::new(
            r * (kappa + 1.0) * c1 + 2.0 * a * ((1.0 + kappa) * c1 + c3) - 2.0 * b * c3,
            r * (kappa - 3.0) * s1 + 2.0 * a * ((1.0 - kappa) * s1 + s3) - 2.0 * b * s3,
        ) * (self.stress / (8.0 * material.shear()))
    }

    fn gradient(&self, material: &Elasticity, at: Vector2) -> Matrix2 {
        let (r, theta) = self.polar(at);
        let kappa = material.kolosov();
        let (a, b) = (self.radius * self.radius / r, self.radius.powi(4) / r.powi(3));
        let (da, db) = (-a / r, -3.0 * b / r);
        let (s1, c1) = theta.sin_cos();
        let (s3, c3) = (3.0 * theta).sin_cos();
        let scale = self.stress / (8.0 * material.shear());
        let by_r = Vector2::new(
            (kappa + 1.0) * c1 + 2.0 * da * ((1.0 + kappa) * c1 + c3) - 2.0 * db * c3,
            (kappa - 3.0) * s1 + 2.0 * da * ((1.0 - kappa) * s1 + s3) - 2.0 * db * s3,
        );
        let by_theta = Vector2::new(
            -r * (kappa + 1.0) * s1 - 2.0 * a * ((1.0 + kappa) * s1 + 3.0 * s3) + 6.0 * b * s3,
            r * (kappa - 3.0) * c1 + 2.0 * a * ((1.0 - kappa) * c1 + 3.0 * c3) - 6.0 * b * c3,
        );
        gradient_from_polar(r, theta, by_r * scale, by_theta * scale)
    }
}
