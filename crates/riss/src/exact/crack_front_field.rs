//! The field at a straight crack front in space: plane strain with a third mode [Williams1957; Tada].

use super::crack_tip_field::{TipMode, tip_field};
use crate::material::Elasticity;
use crate::math::{Matrix, Matrix2, Vector, Vector2};
use std::f64::consts::{PI, TAU};

/// A straight front in space with the crack plane behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrackFrontField {
    /// A point of the front.
    pub origin: Vector<3>,
    /// Unit vector ahead (x1).
    pub ahead: Vector<3>,
    /// Unit normal of the crack (x2).
    pub normal: Vector<3>,
    /// Factors of modes I, II and III [stress·√length]. Positive ones open the crack, slide the face at `x2 > 0` to `+x1`
    /// and tear it to `+x3`, `x3 = x1 × x2`.
    pub factors: [f64; 3],
    /// Stress along x1 that does not fade at the front [stress].
    pub t_stress: f64,
}

/// Gradient in the tip frame of the displacement of a unit mode III, which lies along the front:
/// `u_3 = 2/μ √(r/2π) sin θ/2`.
pub fn out_of_plane_gradient<const D: usize>(material: &Elasticity, r: f64, theta: f64) -> Vector<D> {
    let scale = 1.0 / (material.shear() * (TAU * r).sqrt());
    let (sin, cos) = (0.5 * theta).sin_cos();
    Vector::from_fn(|d, _| [-sin * scale, cos * scale, 0.0][d])
}

impl CrackFrontField {
    /// Displacement and its gradient, `[(i, j)] = ∂u_i/∂x_j`; `sight` tells the side of points on the crack.
    ///
    /// The plane state of the material must be that of plane strain.
    pub fn evaluate(&self, material: &Elasticity, at: Vector<3>, sight: Vector<3>) -> (Vector<3>, Matrix<3>) {
        let axes = Matrix::<3>::from_columns(&[self.ahead, self.normal, self.ahead.cross(&self.normal)]);
        let plane =
            |p: Vector<3>| Vector2::new((p - self.origin).dot(&self.ahead), (p - self.origin).dot(&self.normal));
        let polar = |p: Vector<3>| [plane(p).norm(), plane(p).y.atan2(plane(p).x)];
        let [r, theta] = polar(at);
        let theta = theta + TAU * ((polar(sight)[1] - theta) / TAU).round();
        if r == 0.0 {
            return Default::default();
        }
        let mut gradient = material.strain(&Matrix2::new(self.t_stress, 0.0, 0.0, 0.0));
        let mut u = gradient * plane(at);
        for (mode, k) in [(TipMode::Opening, self.factors[0]), (TipMode::Sliding, self.factors[1])] {
            let (value, slope) = tip_field(mode, material, r, theta);
            u += value * k;
            gradient += slope * k;
        }
        let out = self.factors[2] * 2.0 / material.shear() * (r / (2.0 * PI)).sqrt() * (0.5 * theta).sin();
        let slope = out_of_plane_gradient::<3>(material, r, theta) * self.factors[2];
        let local = Matrix::<3>::from_fn(|i, j| match (i, j) {
            (2, _) => slope[j],
            (_, 2) => 0.0,
            (_, _) => gradient[(i, j)],
        });
        (axes * Vector::<3>::new(u.x, u.y, out), axes * local * axes.transpose())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::PlaneState;

    #[test]
    fn gradient_equilibrium_and_free_faces() {
        let material = Elasticity { young: 3.0, poisson: 0.27, plane: PlaneState::Strain };
        let (ahead, normal) = (Vector::<3>::new(0.6, 0.0, 0.8), Vector::<3>::new(0.0, 1.0, 0.0));
        let field = CrackFrontField {
            origin: Vector::<3>::new(0.1, 0.2, 0.3),
            ahead,
            normal,
            factors: [1.0, -0.7, 1.3],
            t_stress: 0.4,
        };
        let stress = |g: Matrix<3>| {
            (g + g.transpose()) * material.shear() + Matrix::from_diagonal_element(material.lame() * g.trace())
        };
        let at = Vector::<3>::new(0.5, -0.3, 0.1);
        let (_, gradient) = field.evaluate(&material, at, at);
        let mut divergence = Vector::<3>::zeros();
        for d in 0..3 {
            let step = Vector::<3>::ith(d, 1e-5);
            let [(u, g), (v, h)] = [at + step, at - step].map(|p| field.evaluate(&material, p, p));
            assert!(((u - v) / 2e-5 - gradient.column(d)).norm() < 1e-8);
            divergence += (stress(g) - stress(h)).column(d) / 2e-5;
        }
        assert!(divergence.norm() < 1e-7);
        let behind = field.origin - ahead * 0.4 + ahead.cross(&normal) * 0.7;
        for side in [1.0, -1.0] {
            let (u, g) = field.evaluate(&material, behind, behind + normal * side * 1e-9);
            assert!((stress(g) * normal).norm() < 1e-12);
            // Without factors nothing but T is left of the stress along the crack.
            let rest = CrackFrontField { factors: [0.0; 3], ..field };
            let along = stress(rest.evaluate(&material, behind, behind).1);
            assert!((along * ahead - ahead * 0.4).norm() < 1e-12);
            assert!((u.dot(&normal) * side) > 0.0 && u.dot(&ahead.cross(&normal)) * side > 0.0);
        }
    }
}
