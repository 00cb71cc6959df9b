//! What stress intensity factors must do when the problem is moved, scaled, mirrored or solved by more threads.

use crate::bodies::*;
use riss::analysis::{Settings, StaticResult};
use riss::crack::EndKind::{Mouth, Tip};
use riss::geometry::curve::Curve;
use riss::material::PlaneState;
use riss::math::{Matrix2, Vector2};
use riss::model::{BoundaryLoad, Direction, Model, PointSupport, ScalarField, TractionValue};
use riss::nodes::NodeSettings;

/// A motion of the plane: linear part, then shift.
#[derive(Clone, Copy)]
struct Motion {
    linear: Matrix2,
    shift: Vector2,
}

impl Motion {
    fn turn(angle: f64, shift: (f64, f64)) -> Self {
        let (sin, cos) = angle.to_radians().sin_cos();
        Self { linear: Matrix2::new(cos, -sin, sin, cos), shift: Vector2::new(shift.0, shift.1) }
    }

    fn scale(factor: f64) -> Self {
        Self { linear: Matrix2::identity() * factor, shift: Vector2::zeros() }
    }

    fn point(&self, p: Vector2) -> Vector2 {
        self.linear * p + self.shift
    }
}

/// A plate with an oblique center crack under tension, moved as a whole; `stress` acts on the unmoved plate.
fn plate(motion: Motion, stress: f64) -> Model {
    let at = |x: f64, y: f64| motion.point(Vector2::new(x, y));
    let corners = [at(0.0, 0.0), at(2.0, 0.0), at(2.0, 3.0), at(0.0, 3.0)];
    let sides = (0..4).map(|k| Curve::Line { start: corners[k], end: corners[(k + 1) % 4] }).collect();
    let domain = riss::model::Domain::new(sides, vec![]);
    let mut model = body(domain, PlaneState::Strain);
    let mut path = crack(&[(0.7, 1.3), (1.25, 1.65)], [Tip; 2]);
    path.vertices.iter_mut().for_each(|v| *v = motion.point(*v));
    model.cracks.push(path);
    let rotation = motion.linear / motion.linear.determinant().abs().sqrt();
    let tension = rotation * Matrix2::new(0.0, 0.0, 0.0, stress) * rotation.transpose();
    model.loads.push(BoundaryLoad { part: None, value: TractionValue::UniformStress(tension) });
    model.rigid_motion = riss::model::RigidMotion::MeanIsZero;
    model
}

const STILL: Motion = Motion { linear: Matrix2::new(1.0, 0.0, 0.0, 1.0), shift: Vector2::new(0.0, 0.0) };

/// Random nodes of the plate, moved with it.
fn moved_nodes(motion: Motion) -> NodeSettings {
    let mut random = Random(7);
    let n = 16;
    let mut positions = vec![];
    for i in 0..n {
        for j in 0..3 * n / 2 {
            let step = 2.0 / n as f64;
            let x = step * (i as f64 + 0.5 + random.between(-0.3, 0.3));
            let y = step * (j as f64 + 0.5 + random.between(-0.3, 0.3));
            positions.push(motion.point(Vector2::new(x, y)).into());
        }
    }
    listed(positions)
}

/// `[K_I, K_II]` of both tips.
fn factors(result: &StaticResult) -> Vec<[f64; 2]> {
    let tips = &result.step.cracks[0].tips;
    tips.iter().map(|t| [t.k1.expect("evaluated"), t.k2.expect("evaluated")]).collect()
}

fn solve(model: &Model, nodes: NodeSettings) -> Vec<[f64; 2]> {
    factors(&run(model, &with_nodes(nodes)))
}

/// Checks factors against others, within a fraction of the largest.
fn check_factors(found: &[[f64; 2]], expected: &[[f64; 2]], tolerance: f64) {
    let size = expected.iter().flatten().fold(0.0f64, |m, k| m.max(k.abs()));
    let worst = found.iter().flatten().zip(expected.iter().flatten()).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(worst <= tolerance * size, "{found:?} instead of {expected:?}: {:.2e}", worst / size);
}

#[test]
fn turned_and_shifted_with_its_nodes() {
    let motion = Motion::turn(37.0, (11.0, -5.0));
    let still = solve(&plate(STILL, 1.0), moved_nodes(STILL));
    check_factors(&solve(&plate(motion, 1.0), moved_nodes(motion)), &still, 1e-8);
}

/// The program places other nodes on a turned body: what changes is the discretization error of the default.
#[test]
fn turned_with_nodes_of_its_own() {
    let still = solve(&plate(STILL, 1.0), NodeSettings::default());
    let turned = solve(&plate(Motion::turn(37.0, (11.0, -5.0)), 1.0), NodeSettings::default());
    check_factors(&turned, &still, 3e-3);
}

#[test]
fn proportional_to_the_load() {
    let one = solve(&plate(STILL, 1.0), moved_nodes(STILL));
    let many: Vec<[f64; 2]> = one.iter().map(|k| k.map(|k| -250.0 * k)).collect();
    check_factors(&solve(&plate(STILL, -250.0), moved_nodes(STILL)), &many, 1e-10);
}

#[test]
fn lengths_and_stiffness_in_other_units() {
    let one = solve(&plate(STILL, 1.0), moved_nodes(STILL));
    let large = Motion::scale(1000.0);
    let longer: Vec<[f64; 2]> = one.iter().map(|k| k.map(|k| k * 1000f64.sqrt())).collect();
    check_factors(&solve(&plate(large, 1.0), moved_nodes(large)), &longer, 1e-8);
    let mut stiffer = plate(STILL, 1.0);
    stiffer.material.young *= 1e6;
    check_factors(&solve(&stiffer, moved_nodes(STILL)), &one, 1e-10);
}

#[test]
fn crack_run_through_backwards() {
    let one = solve(&plate(STILL, 1.0), moved_nodes(STILL));
    let mut backwards = plate(STILL, 1.0);
    backwards.cracks[0].vertices.reverse();
    let swapped: Vec<[f64; 2]> = one.into_iter().rev().collect();
    check_factors(&solve(&backwards, moved_nodes(STILL)), &swapped, 1e-8);
}

#[test]
fn mirrored() {
    let mirror = Motion { linear: Matrix2::new(-1.0, 0.0, 0.0, 1.0), shift: Vector2::new(2.0, 0.0) };
    let one = solve(&plate(STILL, 1.0), moved_nodes(STILL));
    let other_sign: Vec<[f64; 2]> = one.iter().map(|[k1, k2]| [*k1, -k2]).collect();
    check_factors(&solve(&plate(mirror, 1.0), moved_nodes(mirror)), &other_sign, 1e-8);
}

/// Supports, a spring-like mixture of conditions and a crack: every number of the result, bit by bit.
#[test]
fn same_bits_for_any_number_of_threads() {
    let mut model = body(rectangle((0.0, 0.0), (2.0, 3.0)), PlaneState::Stress);
    model.cracks.push(crack(&[(0.0, 1.4), (0.6, 1.5), (0.9, 1.8)], [Mouth, Tip]));
    hold(&mut model, BOTTOM, Direction::Y, 0.0);
    model.point_supports.push(PointSupport { at: Vector2::new(0.0, 0.0), displacement: [Some(0.0), None] });
    let pull = TractionValue::Components([ScalarField::Constant(0.2), ScalarField::Constant(1.0)]);
    model.loads.push(BoundaryLoad { part: Some(TOP), value: pull });
    let run_with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
        pool.install(|| run(&model, &Settings::default()))
    };
    let one = run_with(1);
    for threads in [2, 4] {
        let other = run_with(threads);
        // Debug output of numbers is exact: it reads back to the same bits.
        assert!(format!("{one:?}") == format!("{other:?}"), "{threads} threads give other numbers");
    }
}
