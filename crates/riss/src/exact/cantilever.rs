//! Timoshenko's cantilever with a parabolic end shear [Timoshenko1970, art. 21].

use super::ExactField;
use crate::material::Elasticity;
use crate::math::{Matrix2, Vector2};

/// Beam on `0 <= x <= length`, `|y| <= height/2`; the end `x = length` carries the shear force, `x = 0` is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cantilever {
    /// Length of the beam [length].
    pub length: f64,
    /// Height of the beam [length].
    pub height: f64,
    /// Force at the end along `-y` per thickness [stress·length].
    pub load: f64,
}

impl Cantilever {
    /// `P / (6 E' I)`, and the effective Poisson's ratio of the plane state.
    fn constants(&self, material: &Elasticity) -> (f64, f64) {
        let young = material.effective_young();
        // ε_y / ε_x in uniaxial stress, whatever the plane state.
        let poisson = (3.0 - material.kolosov()) / (1.0 + material.kolosov());
        (self.load / (6.0 * young * self.height.powi(3) / 12.0), poisson)
    }
}

impl ExactField for Cantilever {
    fn displacement(&self, material: &Elasticity, at: Vector2) -> Vector2 {
        let (c, nu) = self.constants(material);
        let (x, y, l, h2) = (at.x, at.y, self.length, self.height * self.height);
        Vector2::new(
            c * y * ((6.0 * l - 3.0 * x) * x + (2.0 + nu) * (y * y - h2 / 4.0)),
            -c * (3.0 * nu * y * y * (l - x) + (4.0 + 5.0 * nu) * h2 * x / 4.0 + (3.0 * l - x) * x * x),
        )
    }

    fn gradient(&self, material: &Elasticity, at: Vector2) -> Matrix2 {
        let (c, nu) = self.constants(material);
        let (x, y, l, h2) = (at.x, at.y, self.length, self.height * self.height);
        Matrix2::new(
            c * y * 6.0 * (l - x),
            c * ((6.0 * l - 3.0 * x) * x + (2.0 + nu) * (3.0 * y * y - h2 / 4.0)),
            -c * (-3.0 * nu * y * y + (4.0 + 5.0 * nu) * h2 / 4.0 + 6.0 * l * x - 3.0 * x * x),
            -c * 6.0 * nu * y * (l - x),
        )
    }
}
