//! Paths: symmetry, convergence with the increment, criteria that agree.

use crate::bodies::{BOTH, body, crack, hold, rectangle};
use crate::steps::{Steps, grow};
use riss::analysis::crack_growth::settings::{IncrementControl, IncrementForm};
use riss::analysis::{GrowthSettings, Settings};
use riss::approximation::EnrichmentKind;
use riss::crack::EndKind::{Mouth, Tip};
use riss::fracture::GrowthCriterion;
use riss::geometry::predicates::distance_to_segment;
use riss::material::PlaneState;
use riss::math::Vector2;
use riss::model::{BoundaryLoad, Model, PointLoad, TractionValue};

/// The double cantilever beam with a slightly bent crack [EFG, section 6.2]: its straight path is unstable.
fn double_cantilever() -> Model {
    let mut model = body(rectangle((0.0, 0.0), (300.0, 100.0)), PlaneState::Stress);
    BOTH.into_iter().for_each(|d| hold(&mut model, 1, d, 0.0));
    let load = |y: f64, force: f64| PointLoad { at: Vector2::new(0.0, y), force: Vector2::new(0.0, force) };
    model.point_loads.extend([load(0.0, -100.0), load(100.0, 100.0)]);
    let (sin, cos) = 4.8f64.to_radians().sin_cos();
    model.cracks.push(crack(&[(0.0, 50.0), (138.0, 50.0), (138.0 + 12.0 * cos, 50.0 - 12.0 * sin)], [Mouth, Tip]));
    model
}

/// Where the path crosses a height.
fn x_at(steps: &Steps, y: f64) -> f64 {
    let path = &steps.cracks()[0].vertices;
    let crossing = path.windows(2).find(|w| (w[0].y - y) * (w[1].y - y) <= 0.0 && w[0].y != w[1].y);
    let w = crossing.unwrap_or_else(|| panic!("the path never comes to y = {y}: {path:?}"));
    w[0].x + (w[1].x - w[0].x) * (y - w[0].y) / (w[1].y - w[0].y)
}

#[test]
fn curved_increments_give_one_path_where_straight_ones_give_many() {
    let x = |increment: f64, form: IncrementForm| {
        let growth = GrowthSettings { increment: Some(increment), form, ..GrowthSettings::default() };
        x_at(&grow(&double_cantilever(), &Settings::default(), &growth).0, 25.0)
    };
    // An independent finite element program with straight increments finds 182.8 for 5 mm and, extrapolated, about 170.7.
    assert!((x(5.0, IncrementForm::Straight) - 182.8).abs() < 1.5);
    let (coarse, fine) = (x(5.0, IncrementForm::Curved), x(1.25, IncrementForm::Curved));
    assert!((coarse - fine).abs() < 0.5, "{coarse} {fine}");
    assert!((fine - 170.7).abs() < 1.5, "{fine}");
}

/// Each step has its own region, around a crack that bends.
#[test]
fn enriched_region_travels_with_the_tip() {
    let growth = GrowthSettings { increment: Some(5.0), form: IncrementForm::Straight, ..GrowthSettings::default() };
    let mut settings = Settings::default();
    settings.approximation.enrichment.kind = EnrichmentKind::IntrinsicFull;
    let x = x_at(&grow(&double_cantilever(), &settings, &growth).0, 25.0);
    // The path of the finite element program above.
    assert!((x - 182.8).abs() < 1.5, "{x}");
}

/// A clamped plate under shear with a crack from the left side.
fn sheared_plate() -> Model {
    let mut model = body(rectangle((0.0, 0.0), (7.0, 16.0)), PlaneState::Strain);
    BOTH.into_iter().for_each(|d| hold(&mut model, 0, d, 0.0));
    let traction = TractionValue::Components([1.0.into(), 0.0.into()]);
    model.loads.push(BoundaryLoad { part: Some(2), value: traction });
    model.cracks.push(crack(&[(0.0, 8.0), (3.5, 8.0)], [Mouth, Tip]));
    model
}

/// Greatest distance of the vertices of one path from the other.
fn distance(a: &Steps, b: &Steps) -> f64 {
    let (a, b) = (&a.cracks()[0], &b.cracks()[0]);
    let away = |p: &Vector2| b.segments().map(|(s, t)| distance_to_segment(*p, s, t)).fold(f64::INFINITY, f64::min);
    a.vertices.iter().map(away).fold(0.0, f64::max)
}

#[test]
fn criteria_agree_on_smooth_paths_and_local_symmetry_leaves_no_mode_two() {
    let run = |criterion| {
        let growth = GrowthSettings { increment: Some(0.3), steps: 6, criterion, ..GrowthSettings::default() };
        grow(&sheared_plate(), &Settings::default(), &growth).0
    };
    let hoop = run(GrowthCriterion::MaximumCircumferentialStress);
    for other in [
        GrowthCriterion::MaximumEnergyReleaseRate,
        GrowthCriterion::MinimumStrainEnergyDensity,
        GrowthCriterion::LocalSymmetry,
    ] {
        let found = run(other);
        assert!(distance(&found, &hoop) < 0.03, "{other:?}: {}", distance(&found, &hoop));
        if other == GrowthCriterion::LocalSymmetry {
            for k in 1..=6 {
                let tip = found.tip(k, 0);
                let (k1, k2) = (tip.k1.expect("evaluated"), tip.k2.expect("evaluated"));
                assert!(k2.abs() < 2e-3 * k1, "step {k}: {k1} {k2}");
            }
        }
    }
}

#[test]
fn converged_increments_shorten_only_where_the_path_turns() {
    let control = IncrementControl::Converged { tolerance: 0.02 };
    let growth = GrowthSettings { increment: Some(0.8), steps: 4, control, ..GrowthSettings::default() };
    let (steps, _) = grow(&sheared_plate(), &Settings::default(), &growth);
    for record in &steps.records[1..] {
        let turn = record.cracks[0].tips[0].kink_angle.expect("evaluated");
        // A quarter of the turn is how far two half steps end from the whole one.
        assert!(0.25 * turn.abs() <= 0.02, "step {}: {turn}", record.step);
    }
    let control = IncrementControl::HalvedOnTurns { angle_deg: 5.0, least: 0.0625 };
    let growth = GrowthSettings { increment: Some(0.4), steps: 3, control, ..GrowthSettings::default() };
    let (steps, _) = grow(&sheared_plate(), &Settings::default(), &growth);
    let increments: Vec<f64> = (0..3).map(|k| steps.tip(k, 0).increment.expect("it grows")).collect();
    assert!((increments[0] - 0.2).abs() < 1e-12 && (increments[1] - 0.4).abs() < 1e-12, "{increments:?}");
}

#[test]
fn point_symmetric_cracks_stay_so() {
    let mut model = body(rectangle((-5.0, -4.0), (5.0, 4.0)), PlaneState::Strain);
    BOTH.into_iter().for_each(|d| hold(&mut model, 0, d, if d == BOTH[1] { -0.01 } else { 0.0 }));
    BOTH.into_iter().for_each(|d| hold(&mut model, 2, d, if d == BOTH[1] { 0.01 } else { 0.0 }));
    model.cracks.push(crack(&[(-5.0, 0.4), (-3.0, 0.4)], [Mouth, Tip]));
    model.cracks.push(crack(&[(5.0, -0.4), (3.0, -0.4)], [Mouth, Tip]));
    model.cracks[1].name = "right".into();
    let growth = GrowthSettings { increment: Some(0.5), steps: 5, ..GrowthSettings::default() };
    let (steps, _) = grow(&model, &Settings::default(), &growth);
    let [a, b] = [0, 1].map(|k| steps.cracks()[k].vertices.clone());
    assert_eq!((a.len(), b.len()), (7, 7));
    for (p, q) in a.iter().zip(&b) {
        // A thousandth of the plate.
        assert!((p + q).norm() < 1e-2, "{p:?} {q:?}");
    }
}
