//! Growth of a front where the largest principal stress reaches the tensile strength [C3D, sections 2.4 and 2.5].

use crate::crack::FrontPoint;
use crate::math::symmetric_eigen::symmetric_eigen;
use crate::math::{Matrix, Vector3};

/// A largest principal stress within this sine of the tangent of the front says nothing about where the front goes.
const ALONG_FRONT: f64 = 1e-3;

/// The largest principal stress of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargestPrincipal {
    /// Its value, positive in tension [stress].
    pub stress: f64,
    /// Unit vector along it, of either sign.
    pub direction: Vector3,
}

impl LargestPrincipal {
    /// That of a symmetric stress [stress].
    pub fn of(stress: &Matrix<3>) -> Self {
        let rows: Vec<Vec<f64>> =
            (0..3).map(|i| (0..3).map(|j| 0.5 * (stress[(i, j)] + stress[(j, i)])).collect()).collect();
        let (values, vectors) = symmetric_eigen(&rows);
        let mut largest = 0;
        (1..3).for_each(|k| largest = if values[k] > values[largest] { k } else { largest });
        let v = &vectors[largest];
        Self { stress: values[largest], direction: Vector3::new(v[0], v[1], v[2]).normalize() }
    }

    /// Stress over the tensile strength: a front grows where it is one or more.
    pub fn ratio(&self, tensile_strength: f64) -> f64 {
        self.stress / tensile_strength
    }

    /// Unit vector in which a front grows: normal to this stress and to the tangent of the front, away from the crack.
    ///
    /// Straight ahead if the stress runs along the front. Differs from [C3D]: one direction at a vertex of the front, with the
    /// mean tangent, not one for each of the two edges there.
    pub fn growth_direction(&self, point: &FrontPoint) -> Vector3 {
        let across = self.direction.cross(&point.tangent);
        if across.norm() < ALONG_FRONT {
            return point.ahead;
        }
        let direction = across.normalize();
        // If the stress runs ahead, the sign of rounding would choose a side: both are as good, and the normal's is taken.
        let along = direction.dot(&point.ahead);
        let is_forward = if along.abs() > ALONG_FRONT { along > 0.0 } else { direction.dot(&point.normal) > 0.0 };
        if is_forward { direction } else { -direction }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Axes turned by an angle about the tangent, and by another about the old direction ahead.
    fn point(about_tangent: f64, about_ahead: f64) -> FrontPoint {
        let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::x_axis(), about_ahead)
            * nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), about_tangent);
        let axis = |k: usize| turn.matrix().column(k).into_owned();
        FrontPoint {
            position: Vector3::zeros(),
            ahead: axis(0),
            normal: axis(1),
            tangent: axis(2),
            curvature: 0.0,
            s: 0.0,
        }
    }

    fn in_axes(p: &FrontPoint, stress: [[f64; 3]; 3]) -> Matrix<3> {
        let axes = Matrix::<3>::from_columns(&[p.ahead, p.normal, p.tangent]);
        axes * Matrix::<3>::from_fn(|i, j| stress[i][j]) * axes.transpose()
    }

    /// Mohr's circle: `σ = (a + b)/2 + √((a - b)²/4 + c²)`, its direction at half the angle of the diameter.
    #[test]
    fn principal_stresses_are_those_of_mohrs_circle() {
        for (a, b, c) in [(3.0, 1.0, 0.0), (1.0, 3.0, 2.0), (-4.0, -1.0, 0.7), (0.0, 0.0, 5.0)] {
            let p = point(0.4, -1.1);
            let found = LargestPrincipal::of(&in_axes(&p, [[a, c, 0.0], [c, b, 0.0], [0.0, 0.0, -9.0]]));
            let radius = f64::hypot(0.5 * (a - b), c);
            assert!((found.stress - 0.5 * (a + b) - radius).abs() < 1e-12);
            let angle = 0.5 * f64::atan2(2.0 * c, a - b);
            let expected = p.ahead * angle.cos() + p.normal * angle.sin();
            assert!((found.direction.dot(&expected).abs() - 1.0).abs() < 1e-12);
            assert!((found.ratio(2.0) - 0.5 * found.stress).abs() < 1e-15);
        }
    }

    /// Tension at an angle to the crack turns it by that angle; for either sign of the eigenvector.
    #[test]
    fn fronts_grow_across_the_tension() {
        for angle in [0.0, 0.3, -0.3, 1.2, -1.2] {
            let p = point(-0.7, 0.9);
            let tension = p.normal * f64::cos(angle) + p.ahead * f64::sin(angle);
            for direction in [tension, -tension] {
                let found = LargestPrincipal { stress: 1.0, direction }.growth_direction(&p);
                let expected = p.ahead * f64::cos(angle) - p.normal * f64::sin(angle);
                assert!((found - expected).norm() < 1e-12, "{angle}");
            }
        }
    }

    /// A part of the tension along the front changes nothing; tension along the front alone leaves it straight.
    #[test]
    fn tension_along_the_front_does_not_turn_it() {
        let p = point(0.2, 0.5);
        let direction = (p.normal + p.tangent * 2.0).normalize();
        assert!((LargestPrincipal { stress: 1.0, direction }.growth_direction(&p) - p.ahead).norm() < 1e-12);
        assert_eq!(LargestPrincipal { stress: 1.0, direction: p.tangent }.growth_direction(&p), p.ahead);
        // Tension along the crack splits it at a right angle, always to the same side.
        for sign in [1.0, -1.0] {
            let found = LargestPrincipal { stress: 1.0, direction: p.ahead * sign }.growth_direction(&p);
            assert!((found - p.normal).norm() < 1e-12);
        }
    }
}
