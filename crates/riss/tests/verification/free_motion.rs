//! Bodies that are not held are refused, and the message names the motion that is free.

use crate::bodies::*;
use riss::analysis::{Settings, Silent, linear_static};
use riss::crack::EndKind::Mouth;
use riss::error::Error;
use riss::material::PlaneState;
use riss::math::Vector2;
use riss::model::{BoundaryLoad, Direction, Model, PointSupport, ScalarField, TractionValue};

/// A square under shear on top, to be held.
fn square() -> Model {
    let mut model = body(rectangle((0.0, 0.0), (2.0, 2.0)), PlaneState::Strain);
    let shear = TractionValue::Components([ScalarField::Constant(1.0), ScalarField::Constant(0.0)]);
    model.loads.push(BoundaryLoad { part: Some(TOP), value: shear });
    model
}

/// The motion of the error, and a point of the piece that moves.
fn free_motion(model: &Model) -> (String, Option<Vector2>) {
    let settings = Settings { nodes: graded(0.3), ..Settings::default() };
    match linear_static(model, &settings, &mut Silent) {
        Err(Error::FreeRigidMotion { motion, component }) => (motion, component),
        other => panic!("{:?} in place of a free motion", other.map(|r| r.n_nodes)),
    }
}

#[test]
fn no_support() {
    assert_eq!(free_motion(&square()), ("every motion (two translations and the rotation)".into(), None));
}

#[test]
fn rollers_only() {
    let mut model = square();
    hold(&mut model, BOTTOM, Direction::Y, 0.0);
    assert_eq!(free_motion(&model), ("the translation along x".into(), None));
    let mut model = square();
    hold(&mut model, LEFT, Direction::X, 0.0);
    hold(&mut model, RIGHT, Direction::X, 0.0);
    assert_eq!(free_motion(&model), ("the translation along y".into(), None));
}

#[test]
fn one_point_held() {
    let mut model = square();
    model.point_supports.push(PointSupport { at: Vector2::new(0.5, 2.0), displacement: [Some(0.0), Some(0.0)] });
    assert_eq!(free_motion(&model), ("the rotation around (0.500000, 2.000000)".into(), None));
}

/// Two rollers whose normals meet leave the rotation around that point.
#[test]
fn normals_that_meet() {
    let mut model = square();
    model.point_supports.push(PointSupport { at: Vector2::new(0.5, 0.0), displacement: [None, Some(0.0)] });
    model.point_supports.push(PointSupport { at: Vector2::new(0.0, 1.25), displacement: [Some(0.0), None] });
    assert_eq!(free_motion(&model), ("the rotation around (0.500000, 1.250000)".into(), None));
}

#[test]
fn a_piece_cut_off_by_a_crack() {
    let mut model = square();
    for direction in BOTH {
        hold(&mut model, BOTTOM, direction, 0.0);
    }
    model.cracks.push(crack(&[(0.0, 1.2), (2.0, 1.2)], [Mouth; 2]));
    let (motion, component) = free_motion(&model);
    assert_eq!(motion, "every motion (two translations and the rotation)");
    assert!(component.expect("the body falls into two").y > 1.2);
}
