//! Growth along the configurational force: what it says beside the factors, and where it leads.

use crate::bodies::{BOTH, body, crack, hold, polygon, rectangle, with_parts};
use crate::steps::grow;
use riss::analysis::crack_growth::settings::IncrementControl;
use riss::analysis::{GrowthSettings, Method};
use riss::crack::EndKind::{Mouth, Tip};
use riss::fracture::{GrowthCriterion, force_of_factors};
use riss::material::PlaneState;
use riss::math::Vector2;
use riss::model::{BoundaryLoad, Direction, Domain, Model, TractionValue};

fn along_the_force(method: Method, increment: f64, steps: usize) -> GrowthSettings {
    let criterion = GrowthCriterion::ConfigurationalForce;
    GrowthSettings { increment: Some(increment), steps, criterion, ..method.growth() }
}

/// Arms of 1×1 around a center of 1×1, a crack of 0.2 from the lower right corner into the center [CPM, section 4.4]; top
/// pulled, the other ends held normal to themselves.
fn cruciform() -> Model {
    let corners = [
        (1., 0.),
        (2., 0.),
        (2., 1.),
        (3., 1.),
        (3., 2.),
        (2., 2.),
        (2., 3.),
        (1., 3.),
        (1., 2.),
        (0., 2.),
        (0., 1.),
        (1., 1.),
    ];
    let names = ["0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11"];
    let mut model = body(with_parts(Domain::new(polygon(&corners), vec![]), &names), PlaneState::Strain);
    for (part, direction) in [(0, Direction::Y), (3, Direction::X), (9, Direction::X)] {
        hold(&mut model, part, direction, 0.0);
    }
    let value = TractionValue::Components([0.0.into(), 100.0.into()]);
    model.loads.push(BoundaryLoad { part: Some(6), value });
    let side = 0.2 * 0.5f64.sqrt();
    model.cracks.push(crack(&[(2.0, 1.0), (2.0 - side, 1.0 + side)], [Mouth, Tip]));
    model
}

/// `g = ((K_I² + K_II²)/E', -2 K_I K_II/E')` along the path within 1 % [CPM, Eq. 21, section 4.4].
fn check_force(method: Method) {
    let model = cruciform();
    let (steps, _) = grow(&model, &method.settings(), &along_the_force(method, 0.05, 6));
    for k in 0..=6 {
        let tip = steps.tip(k, 0);
        let force = tip.configurational_force.expect("evaluated");
        let expected = force_of_factors(tip.k1.expect("evaluated"), tip.k2.expect("evaluated"), &model.material);
        assert!((force - expected).norm() < 0.01 * expected.norm(), "step {k}: {force} {expected}");
        assert!((tip.j.expect("evaluated") / force.x - 1.0).abs() < 0.01, "step {k}: {force}, J = {:?}", tip.j);
    }
}

#[test]
fn force_is_that_of_the_factors_along_the_path() {
    check_force(Method::ElementFreeGalerkin);
}

#[test]
fn force_is_that_of_the_factors_along_the_path_of_cracking_particles() {
    check_force(Method::CrackingParticles);
}

/// A square clamped below and shifted above, a crack to its middle: pure mode II [CPM, section 4.3] but for the last 0.02, which
/// lean by 10°, so that the crack turns to the side on which it opens, and not by chance to the other.
fn sheared_square() -> Model {
    let mut model = body(rectangle((0.0, -0.5), (1.0, 0.5)), PlaneState::Stress);
    for direction in BOTH {
        hold(&mut model, 0, direction, 0.0);
        hold(&mut model, 2, direction, if direction == Direction::X { 0.02 } else { 0.0 });
    }
    model.cracks.push(crack(&[(0.0, 0.0), (0.48, 0.0), (0.5, -0.0035)], [Mouth, Tip]));
    model
}

/// The path comes to that of the hoop stress as increments shrink [CPM, Fig. 13]: to x = 0.53216 at y = -0.1 by an independent
/// quadratic finite element program.
///
/// - `runs`: increment and number of steps of two runs; the second must be nearer by `factor`
fn check_path(method: Method, runs: [(f64, usize); 2], factor: f64) {
    let apart = runs.map(|(increment, steps)| {
        let (found, _) = grow(&sheared_square(), &method.settings(), &along_the_force(method, increment, steps));
        let path = &found.cracks()[0].vertices;
        let (a, b) = (at_height(path, -0.05), at_height(path, -0.1));
        // The slope near 70° where the path has turned [CPM, section 4.3].
        let slope = 0.05f64.atan2(b.x - a.x).to_degrees();
        assert!((65.0..72.0).contains(&slope), "{increment}: {slope}");
        b.x - 0.53216
    });
    assert!(apart.iter().all(|d| *d > 0.0 && *d < 0.02) && apart[1] < factor * apart[0], "{apart:?}");
}

/// Measured: 0.0104 apart for increments of 0.01, 0.0039 for 0.005; 0.0136 for 0.02 is too good by chance to begin with.
#[test]
fn path_of_the_force_comes_to_that_of_the_hoop_stress() {
    check_path(Method::ElementFreeGalerkin, [(0.01, 18), (0.005, 36)], 0.6);
}

/// Increments are halved while the path turns. Measured: 0.0111 apart for increments of 0.02, 0.0046 for 0.01.
#[test]
fn path_of_cracking_particles_comes_to_that_of_the_hoop_stress() {
    check_path(Method::CrackingParticles, [(0.02, 12), (0.01, 20)], 0.8);
}

/// From a straight crack in pure mode II by the other criterion of [CPM, section 4.3]: 70.5° at once, and the path of the
/// independent program.
#[test]
fn cracking_particles_follow_the_hoop_stress_too() {
    let mut model = sheared_square();
    model.cracks[0].vertices = vec![Vector2::new(0.0, 0.0), Vector2::new(0.5, 0.0)];
    let criterion = GrowthCriterion::MaximumCircumferentialStress;
    let control = IncrementControl::Fixed;
    let growth = GrowthSettings { criterion, control, ..along_the_force(Method::CrackingParticles, 0.025, 5) };
    let (found, _) = grow(&model, &Method::CrackingParticles.settings(), &growth);
    let turn = found.tip(0, 0).kink_angle.expect("evaluated").to_degrees();
    assert!((turn + 70.53).abs() < 0.1, "{turn}");
    let at = at_height(&found.cracks()[0].vertices, -0.1);
    assert!((at.x - 0.53216).abs() < 0.005, "{at}");
}

/// Where a path first comes to a height.
fn at_height(path: &[Vector2], y: f64) -> Vector2 {
    let w = path.windows(2).find(|w| (w[0].y - y) * (w[1].y - y) <= 0.0 && w[0].y != w[1].y);
    let w = w.unwrap_or_else(|| panic!("the path does not come to {y}: {path:?}"));
    w[0] + (w[1] - w[0]) * ((y - w[0].y) / (w[1].y - w[0].y))
}
