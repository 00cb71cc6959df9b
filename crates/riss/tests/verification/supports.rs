//! Supports on inclined edges and at points, springs: closed forms and equilibrium.

use crate::bodies::*;
use riss::analysis::Settings;
use riss::crack::EndKind::{Mouth, Tip};
use riss::exact::LinearField;
use riss::geometry::curve::Curve;
use riss::material::PlaneState;
use riss::math::{Matrix2, Vector2, direction, turn_left};
use riss::model::{
    BoundaryLoad, Direction, Domain, Model, PointLoad, PointSupport, ScalarField, Spring, TractionValue,
};
use riss::system::ConstraintMethod;

/// Rounding of a solution that the approximation contains.
const ROUNDING: f64 = 1e-9;

/// A rectangle of 3×1 turned by an angle around the origin.
fn turned_bar(angle: f64) -> Domain {
    let (e1, e2) = (direction(angle), turn_left(direction(angle)));
    let corners = [e1 * 0.0, e1 * 3.0, e1 * 3.0 + e2, e2];
    let sides = (0..4).map(|k| Curve::Line { start: corners[k], end: corners[(k + 1) % 4] }).collect();
    with_parts(Domain::new(sides, vec![]), &["bottom", "right", "top", "left"])
}

/// Rollers on two inclined edges, uniform tension along the bar: the linear field is exact.
#[test]
fn rollers_on_inclined_edges() {
    let angle = 0.4;
    let (e1, e2) = (direction(angle), turn_left(direction(angle)));
    for method in
        [ConstraintMethod::default(), ConstraintMethod::LagrangeMultipliers, ConstraintMethod::FiniteElementCoupled]
    {
        let mut model = body(turned_bar(angle), PlaneState::Strain);
        hold(&mut model, LEFT, Direction::Normal, 0.0);
        hold(&mut model, BOTTOM, Direction::Normal, 0.0);
        let stress = e1 * e1.transpose() * 5.0;
        let value = TractionValue::Components([e1.x, e1.y].map(|d| ScalarField::Constant(5.0 * d)));
        model.loads.push(BoundaryLoad { part: Some(RIGHT), value });
        let field = LinearField { constant: Vector2::zeros(), gradient: model.material.strain(&stress) };
        let settings = Settings { constraints: method, ..with_nodes(graded(0.3)) };
        let result = run(&model, &settings);
        let (displacement, stress_error) = differences(&model, &field, &result);
        assert!(displacement < ROUNDING * 3.0 * field.gradient.norm(), "{displacement:.2e}");
        assert!(stress_error < ROUNDING * 5.0, "{stress_error:.2e}");
        assert!((reaction(&result, "left") + e1 * 5.0).norm() < ROUNDING * 5.0, "{:?}", result.step.reactions);
        assert!(reaction(&result, "bottom").dot(&e2).abs() < ROUNDING * 5.0);
    }
}

/// A bar of length 3 on a foundation of stiffness k under a pressure p at its free end: uniform stress -p, the held
/// end sinks by p / k and the other one by p / k + 3 p / E.
#[test]
fn bar_on_springs() {
    let (p, k) = (2.0, 400.0);
    let mut model = body(rectangle((0.0, 0.0), (3.0, 1.0)), PlaneState::Stress);
    model.springs.push(Spring { part: LEFT, direction: Direction::Normal, stiffness: ScalarField::Constant(k) });
    hold(&mut model, BOTTOM, Direction::Y, 0.0);
    let pressure = TractionValue::Pressure(ScalarField::Constant(p));
    model.loads.push(BoundaryLoad { part: Some(RIGHT), value: pressure });
    let stress = Matrix2::new(-p, 0.0, 0.0, 0.0);
    let field = LinearField { constant: Vector2::new(-p / k, 0.0), gradient: model.material.strain(&stress) };
    let result = run(&model, &with_nodes(graded(0.3)));
    let (displacement, stress_error) = differences(&model, &field, &result);
    assert!(displacement < ROUNDING * p / k, "{displacement:.2e}");
    assert!(stress_error < ROUNDING * p, "{stress_error:.2e}");
    assert!((reaction(&result, "left").x - p).abs() < ROUNDING * p, "{:?}", result.step.reactions);
    let end = displacement_near(&result, (3.0, 1.0)).x;
    assert!((end + p / k + 3.0 * p / model.material.young).abs() < ROUNDING * p / k, "{end}");
}

/// A beam on two points with a force in between: the lever rule, whatever the mesh; prescribed values are met.
#[test]
fn forces_and_supports_at_points() {
    let mut model = body(rectangle((0.0, 0.0), (4.0, 1.0)), PlaneState::Stress);
    model.thickness = 2.5;
    let at = |x: f64, y: f64| Vector2::new(x, y);
    model.point_supports.push(PointSupport { at: at(0.5, 0.0), displacement: [Some(0.1), Some(0.02)] });
    model.point_supports.push(PointSupport { at: at(3.5, 0.0), displacement: [None, Some(-0.03)] });
    model.point_loads.push(PointLoad { at: at(1.25, 1.0), force: at(0.7, -8.0) });
    model.point_loads.push(PointLoad { at: at(2.1, 0.4), force: at(-0.2, 1.0) });
    let settings = with_nodes(graded(0.2));
    let result = run(&model, &settings);
    let [left, right] = [reaction(&result, "point-support-1"), reaction(&result, "point-support-2")];
    // Moments around the left support: arms of the forces over the distance of the supports.
    let moment = 0.75 * -8.0 - 1.0 * 0.7 + 1.6 * 1.0 - 0.4 * -0.2;
    let expected_right = -moment / 3.0;
    let size = 8.0;
    assert!((left.x + 0.5).abs() < ROUNDING * size && right.x == 0.0, "{left:?} {right:?}");
    assert!((right.y - expected_right).abs() < ROUNDING * size, "{} {expected_right}", right.y);
    assert!((left.y + right.y - 7.0).abs() < ROUNDING * size, "{left:?} {right:?}");
    let (u, v) = (displacement_at(&model, &settings, &result, at(0.5, 0.0)), at(0.1, 0.02));
    assert!((u - v).norm() < ROUNDING, "{u:?}");
    let u = displacement_at(&model, &settings, &result, at(3.5, 0.0));
    assert!((u.y + 0.03).abs() < ROUNDING, "{u:?}");
}

/// Edges and points hold together: all reactions balance all loads.
#[test]
fn reactions_balance_the_loads() {
    for method in [
        ConstraintMethod::default(),
        ConstraintMethod::LagrangeMultipliers,
        ConstraintMethod::ModifiedVariational,
        ConstraintMethod::FiniteElementCoupled,
    ] {
        let mut model = held_block();
        model.point_loads.push(PointLoad { at: Vector2::new(0.9, 1.4), force: Vector2::new(0.4, -0.9) });
        let settings = Settings { constraints: method, ..with_nodes(graded(0.2)) };
        let total = total_reaction(&run(&model, &settings));
        let load = Vector2::new(0.3 * 2.0 + 0.4, 1.2 * 2.0 - 0.9);
        assert!((total + load).norm() < ROUNDING * load.norm(), "{method:?}: {total:?} against {load:?}");
    }
}

fn held_block() -> Model {
    let mut model = body(rectangle((0.0, 0.0), (2.0, 2.0)), PlaneState::Strain);
    for direction in BOTH {
        hold(&mut model, BOTTOM, direction, 0.0);
    }
    model.cracks.push(crack(&[(0.0, 0.9), (0.8, 0.9)], [Mouth, Tip]));
    let pull = TractionValue::Components([ScalarField::Constant(0.3), ScalarField::Constant(1.2)]);
    model.loads.push(BoundaryLoad { part: Some(TOP), value: pull });
    model
}
