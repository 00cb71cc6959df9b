//! Williams' field at a crack tip [EFG, Eq. 38], and the point force that the T-stress integral needs.

use super::{ExactField, gradient_from_polar};
use crate::material::Elasticity;
use crate::math::{Matrix2, Vector2, direction, turn_left};
use std::f64::consts::PI;

/// Which of the fields that are singular at the tip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TipMode {
    /// Opening, unit `K_I`.
    Opening,
    /// Sliding, unit `K_II`; positive if the face at `x2 > 0` slides towards `+x1`.
    Sliding,
    /// Unit force per thickness on the tip along `+x1` [Kfouri1986]; stress ∝ 1/r, faces free.
    PointForce,
}

/// Displacement and its gradient in the tip frame (`x1` ahead, `x2` to the left) at polar coordinates `r`, `theta`.
///
/// `theta` may leave (-π, π]: the field is continued analytically, so that the cut can follow a bent crack.
pub fn tip_field(mode: TipMode, material: &Elasticity, r: f64, theta: f64) -> (Vector2, Matrix2) {
    let (kappa, mu) = (material.kolosov(), material.shear());
    let (sin, cos) = theta.sin_cos();
    match mode {
        TipMode::Opening | TipMode::Sliding => {
            let (s, c) = (0.5 * theta).sin_cos();
            let (value, by_theta) = if mode == TipMode::Opening {
                let f = kappa - cos;
                (Vector2::new(c * f, s * f), Vector2::new(-0.5 * s * f + c * sin, 0.5 * c * f + s * sin))
            } else {
                let (f, g) = (kappa + 2.0 + cos, kappa - 2.0 + cos);
                (Vector2::new(s * f, -c * g), Vector2::new(0.5 * c * f - s * sin, 0.5 * s * g + c * sin))
            };
            let scale = (r / (2.0 * PI)).sqrt() / (2.0 * mu);
            let (value, by_theta) = (value * scale, by_theta * scale);
            (value, gradient_from_polar(r, theta, value / (2.0 * r), by_theta))
        }
        TipMode::PointForce => {
            let scale = 1.0 / (8.0 * PI * mu);
            let value =
                Vector2::new(-(kappa + 1.0) * r.ln() - 2.0 * sin * sin, -(kappa - 1.0) * theta + 2.0 * sin * cos)
                    * scale;
            let by_r = Vector2::new(-(kappa + 1.0) / r, 0.0) * scale;
            let by_theta = Vector2::new(-4.0 * sin * cos, -(kappa - 1.0) + 2.0 * (cos * cos - sin * sin)) * scale;
            (value, gradient_from_polar(r, theta, by_r, by_theta))
        }
    }
}

/// The field at a tip with given stress intensity factors and T-stress; the crack lies straight behind the tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrackTipField {
    /// Crack tip.
    pub tip: Vector2,
    /// Growth direction, from the x axis [rad].
    pub angle: f64,
    /// Mode I stress intensity factor [stress·√length].
    pub k1: f64,
    /// Mode II stress intensity factor [stress·√length].
    pub k2: f64,
    /// Stress along the crack that does not fade at the tip [stress].
    pub t_stress: f64,
}

impl CrackTipField {
    fn local(&self, material: &Elasticity, at: Vector2) -> (Vector2, Matrix2) {
        let e1 = direction(self.angle);
        let d = at - self.tip;
        let (x, y) = (d.dot(&e1), d.dot(&turn_left(e1)));
        let r = x.hypot(y);
        // The T-stress part: E' ε = T in x1.
        let (kappa, mu) = (material.kolosov(), material.shear());
        let mut gradient =
            Matrix2::from_diagonal(&Vector2::new(kappa + 1.0, kappa - 3.0)) * (self.t_stress / (8.0 * mu));
        let mut u = gradient * Vector2::new(x, y);
        if r > 0.0 {
            for (mode, k) in [(TipMode::Opening, self.k1), (TipMode::Sliding, self.k2)] {
                let (value, slope) = tip_field(mode, material, r, y.atan2(x));
                u += value * k;
                gradient += slope * k;
            }
        }
        let rotation = Matrix2::from_columns(&[e1, turn_left(e1)]);
        (rotation * u, rotation * gradient * rotation.transpose())
    }
}

impl ExactField for CrackTipField {
    fn displacement(&self, material: &Elasticity, at: Vector2) -> Vector2 {
        self.local(material, at).0
    }
    fn gradient(&self, material: &Elasticity, at: Vector2) -> Matrix2 {
        self.local(material, at).1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::PlaneState;

    #[test]
    fn point_force_has_radial_stress_and_unit_resultant() {
        let material = Elasticity { young: 2.0, poisson: 0.3, plane: PlaneState::Strain };
        let n = 4000;
        let mut resultant = Vector2::zeros();
        for k in 0..n {
            let theta = -PI + (k as f64 + 0.5) * 2.0 * PI / n as f64;
            let stress = material.stress(&tip_field(TipMode::PointForce, &material, 0.5, theta).1);
            let normal = direction(theta);
            let traction = stress * normal;
            assert!((traction + normal * (theta.cos() / (PI * 0.5))).norm() < 1e-12);
            resultant += traction * (0.5 * 2.0 * PI / n as f64);
        }
        assert!((resultant + Vector2::new(1.0, 0.0)).norm() < 1e-6);
    }
}
