//! Shape functions of elements joined to moving least squares: they reproduce linear fields, their derivatives are those of
//! finite differences, they do not jump between elements, and at supports they are one at their node and zero at others.

use crate::bodies::*;
use riss::analysis::{Settings, Silent, discretize};
use riss::approximation::moving_least_squares::Derivatives;
use riss::approximation::{MovingLeastSquares, ShapeFunctions, Surroundings};
use riss::crack::EndKind::{Mouth, Tip};
use riss::geometry::predicates::distance_to_segment;
use riss::material::PlaneState;
use riss::math::{Matrix2, Vector2};
use riss::model::{Direction, Model};
use riss::nodes::NodeSettings;
use riss::system::{ConstraintMethod, Discretization};

/// A clamped square with an edge crack whose mouth stands on the support.
fn square() -> Model {
    let mut model = body(rectangle((0.0, 0.0), (1.0, 1.0)), PlaneState::Strain);
    hold(&mut model, LEFT, Direction::X, 0.0);
    hold(&mut model, BOTTOM, Direction::Normal, 0.0);
    model.cracks.push(crack(&[(0.0, 0.55), (0.43, 0.52)], [Mouth, Tip]));
    model
}

fn coupled(model: &Model, nodes: NodeSettings, beyond: Option<f64>) -> Discretization {
    let constraints = ConstraintMethod::FiniteElementCoupled;
    let mut settings = Settings { constraints, ..with_nodes(nodes) };
    settings.approximation.finite_elements_beyond = beyond;
    discretize(model, &settings, &mut Silent).expect("the nodes are dense enough")
}

fn all(model: &Model) -> Vec<Discretization> {
    let layouts = [structured(11, 9), random_nodes(&model.domain, 10, 5), graded_to(0.15, 0.08)];
    let cases = layouts.into_iter().flat_map(|nodes| [None, Some(0.25)].map(|beyond| (nodes.clone(), beyond)));
    cases.map(|(nodes, beyond)| coupled(model, nodes, beyond)).collect()
}

fn evaluate(mls: &MovingLeastSquares, at: Vector2) -> ShapeFunctions<2> {
    let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
    mls.evaluate(at, at, Derivatives::Second, &mut around, &mut shape).expect("the fit is regular");
    shape
}

/// Points of the square, clear of its crack.
fn points(model: &Model, n: usize, seed: u64) -> Vec<Vector2> {
    let mut random = Random(seed);
    let all = (0..n).map(|_| Vector2::new(random.between(0.001, 0.999), random.between(0.001, 0.999)));
    let (a, b) = model.cracks[0].segments().next().unwrap();
    all.filter(|p| distance_to_segment(*p, a, b) > 1e-3).collect()
}

#[test]
fn linear_fields_are_reproduced() {
    let model = square();
    for discrete in all(&model) {
        let mls = &discrete.approximation;
        let n = mls.nodes().len();
        for at in points(&model, 300, 1) {
            let shape = evaluate(mls, at);
            assert!(shape.neighbors.windows(2).all(|w| w[0] < w[1]));
            let (mut one, mut place, mut gradient) = (0.0, Vector2::zeros(), Matrix2::zeros());
            let of_nodes =
                shape.neighbors.iter().zip(&shape.values).zip(&shape.gradients).filter(|k| (*k.0.0 as usize) < n);
            for ((&i, &v), g) in of_nodes {
                one += v;
                place += mls.nodes().positions[i as usize] * v;
                gradient += mls.nodes().positions[i as usize] * g.transpose();
            }
            // Gradients are differences of terms of 1/h, h about 0.1.
            assert!((one - 1.0).abs() < 1e-11 && (place - at).norm() < 1e-11, "{at}: {one} {place}");
            assert!((gradient - Matrix2::identity()).norm() < 1e-9, "{at}: {gradient}");
        }
    }
}

/// A random field of the nodal parameters, its gradient and second derivatives, at a point.
fn field(mls: &MovingLeastSquares, at: Vector2) -> (f64, Vector2, Matrix2) {
    let shape = evaluate(mls, at);
    let parameter = |i: u32| Random(u64::from(i) * 7919).unit();
    let mut found = (0.0, Vector2::zeros(), Matrix2::zeros());
    for (k, &i) in shape.neighbors.iter().enumerate() {
        found.0 += parameter(i) * shape.values[k];
        found.1 += shape.gradients[k] * parameter(i);
        found.2 += shape.second_derivatives[k] * parameter(i);
    }
    found
}

#[test]
fn derivatives_are_those_of_finite_differences() {
    let model = square();
    for discrete in all(&model) {
        let mls = &discrete.approximation;
        let mut n_checked = 0;
        for at in points(&model, 150, 2) {
            const STEP: f64 = 1e-6;
            let here = field(mls, at);
            let sides = [Vector2::x(), Vector2::y()].map(|e| [field(mls, at + e * STEP), field(mls, at - e * STEP)]);
            // Gradients jump between elements; where the ends of the step agree, none lies between.
            let is_smooth = sides.iter().flatten().all(|s| (s.1 - here.1).norm() < 1e-4 * (10.0 + here.2.norm()));
            if !is_smooth {
                continue;
            }
            n_checked += 1;
            for (d, [ahead, behind]) in sides.into_iter().enumerate() {
                let slope = (ahead.0 - behind.0) / (2.0 * STEP);
                assert!(
                    (slope - here.1[d]).abs() < 1e-6 * (1.0 + here.1.norm() + here.2.norm()),
                    "{at}: {slope} {}",
                    here.1
                );
                let bend = (ahead.1 - behind.1) / (2.0 * STEP);
                assert!((bend - here.2.column(d)).norm() < 1e-3 * (10.0 + here.2.norm()), "{at}: {bend} {}", here.2);
            }
        }
        assert!(n_checked > 100, "{n_checked}");
    }
}

/// Fields are continuous along lines through the body: steps of 1e-7 change them by no more than the slope allows.
#[test]
fn nothing_jumps_between_elements() {
    let model = square();
    for discrete in all(&model) {
        let mls = &discrete.approximation;
        // Right of the tip, on nodes and beside them.
        for x in [0.6, 0.73, 0.955] {
            let mut previous: Option<(f64, Vector2)> = None;
            for k in 0..2000 {
                let at = Vector2::new(x, 0.001 + 0.998 * f64::from(k) / 2000.0);
                let (value, gradient, _) = field(mls, at);
                if let Some((before, slope)) = previous {
                    let allowed = 0.998 / 2000.0 * (slope.norm() + gradient.norm()) * 1.5 + 1e-3;
                    assert!((value - before).abs() < allowed, "{at}: {before} {value}");
                }
                previous = Some((value, gradient));
            }
        }
    }
}

#[test]
fn nodes_on_supports_have_their_values() {
    let model = square();
    for discrete in all(&model) {
        let mls = &discrete.approximation;
        let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
        let nodes = mls.nodes();
        let held = (0..nodes.len()).filter(|i| nodes.positions[*i].x == 0.0 || nodes.positions[*i].y == 0.0);
        for i in held {
            mls.evaluate(nodes.positions[i], nodes.sights[i], Derivatives::First, &mut around, &mut shape).unwrap();
            for (&j, &v) in shape.neighbors.iter().zip(&shape.values) {
                let expected = if j as usize == i { 1.0 } else { 0.0 };
                assert!((v - expected).abs() < 1e-9, "{}: {j} {v}", nodes.positions[i]);
            }
        }
    }
}
