//! Body forces and loads on crack faces against closed forms.

use crate::bodies::*;
use riss::crack::EndKind;
use riss::exact::{ExactField, LinearField};
use riss::material::{Elasticity, PlaneState};
use riss::math::{Matrix2, Vector2};
use riss::model::{BodyForce, BoundaryLoad, CrackFaceLoad, Direction, RigidMotion, ScalarField, TractionValue};
use std::sync::Arc;

/// A column of height 2 under its own weight: `σ_yy = -w (2 - y)`, held at its foot by the exact displacement.
#[derive(Debug)]
struct Column {
    weight: f64,
}

const HEIGHT: f64 = 2.0;

impl ExactField for Column {
    fn displacement(&self, material: &Elasticity, at: Vector2) -> Vector2 {
        let (young, poisson) = plane_constants(material);
        let c = self.weight / young;
        // ε_xx = -ν σ_yy / E bends lines across the column: u_y gains ν x² c / 2.
        Vector2::new(
            poisson * c * (HEIGHT - at.y) * at.x,
            c * (at.y * at.y / 2.0 - HEIGHT * at.y) + 0.5 * poisson * c * at.x * at.x,
        )
    }
    fn gradient(&self, material: &Elasticity, at: Vector2) -> Matrix2 {
        let (young, poisson) = plane_constants(material);
        let c = self.weight / young;
        Matrix2::new(poisson * c * (HEIGHT - at.y), -poisson * c * at.x, poisson * c * at.x, c * (at.y - HEIGHT))
    }
}

/// Modulus and contraction in uniaxial stress in the plane.
fn plane_constants(material: &Elasticity) -> (f64, f64) {
    let strain = material.strain(&Matrix2::new(1.0, 0.0, 0.0, 0.0));
    (1.0 / strain[(0, 0)], -strain[(1, 1)] / strain[(0, 0)])
}

/// The relative gradient of the stress over a spacing is 0.1 / 2; a linear interpolation misses it by that over √12,
/// 1.4 %, and moving least squares by less (0.2 %). The reaction is the weight.
#[test]
fn column_under_its_own_weight() {
    for plane in [PlaneState::Strain, PlaneState::Stress] {
        let field: Arc<dyn ExactField> = Arc::new(Column { weight: 3.0 });
        let mut model = body(rectangle((-0.5, 0.0), (0.5, HEIGHT)), plane);
        hold_exactly(&mut model, BOTTOM, &[Direction::X, Direction::Y], &field);
        model.body_force = Some(BodyForce([0.0, -3.0].map(ScalarField::Constant)));
        model.exact = Some(field);
        let result = run(&model, &with_nodes(graded(0.1)));
        let error = result.energy_error.expect("the field is known");
        assert!(error < 0.014, "{error:.2e}");
        let foot = reaction(&result, "bottom");
        assert!((foot - Vector2::new(0.0, 3.0 * HEIGHT)).norm() < 1e-9 * 6.0, "{foot:?}");
    }
}

/// The same pressure all around a body and in its cracks is a uniform stress: a patch test of the loads on crack faces.
/// K vanishes, T is the stress along the crack.
#[test]
fn pressure_all_around_and_inside_a_kinked_crack_is_uniform() {
    for plane in [PlaneState::Strain, PlaneState::Stress] {
        let mut model = body(rectangle((-1.0, -1.0), (1.0, 1.0)), plane);
        model.cracks = vec![
            crack(&[(-1.0, 0.3), (-0.4, 0.2), (-0.2, 0.4)], [EndKind::Mouth, EndKind::Tip]),
            crack(&[(-0.1, -0.4), (0.5, -0.1)], [EndKind::Tip; 2]),
        ];
        model.rigid_motion = RigidMotion::MeanIsZero;
        let stress = Matrix2::from_diagonal_element(-2.0);
        let gradient = model.material.strain(&stress);
        model.exact = Some(Arc::new(LinearField { constant: Vector2::zeros(), gradient }));
        model.loads = vec![BoundaryLoad { part: None, value: TractionValue::Pressure(2.0.into()) }];
        model.crack_face_loads = (0..2).map(|crack| CrackFaceLoad { crack, pressure: 2.0.into() }).collect();
        let result = run(&model, &with_nodes(graded(0.2)));
        let error = result.energy_error.expect("the field is known");
        assert!(error < 1e-10, "{error:.2e}");
        assert!(result.warnings.is_empty(), "{:?}", result.warnings);
        for tip in result.step.cracks.iter().flat_map(|c| &c.tips) {
            // On bent faces the quadrature of the tip fields is good to some 1e-5.
            assert!(tip.k1.unwrap().abs() < 1e-3 && tip.k2.unwrap().abs() < 1e-3, "{tip:?}");
            assert!((tip.t_stress.unwrap() + 2.0).abs() < 1e-3, "{tip:?}");
        }
    }
}
