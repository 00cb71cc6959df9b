//! Cracks that close around a piece of the body, and cracks that meet.

use crate::bodies::{BOTH, body, crack, hold, polygon, rectangle, run};
use crate::steps::grow;
use riss::analysis::{GrowthEndKind, GrowthSettings, Settings, StaticResult, TipStatus};
use riss::crack::EndKind::{Junction, Mouth, Tip};
use riss::geometry::curve::Curve;
use riss::material::PlaneState;
use riss::math::Matrix2;
use riss::model::{BoundaryLoad, Domain, Model, RigidMotion, TractionValue};

const SQUARE: [(f64, f64); 4] = [(1.6, 1.7), (2.4, 1.7), (2.4, 2.3), (1.6, 2.3)];

/// A square in tension with an edge crack beside a square hole or a crack all around it.
fn plate(holes: Vec<Vec<Curve>>) -> Model {
    let outer = rectangle((0.0, 0.0), (4.0, 4.0));
    let mut domain = Domain::new(outer.edges, holes);
    domain.parts = outer.parts;
    let mut model = body(domain, PlaneState::Strain);
    model.rigid_motion = RigidMotion::MeanIsZero;
    let stress = TractionValue::UniformStress(Matrix2::new(0.0, 0.0, 0.0, 1.0));
    model.loads.push(BoundaryLoad { part: None, value: stress });
    model.cracks.push(crack(&[(0.0, 2.1), (0.9, 2.1)], [Mouth, Tip]));
    model
}

fn factors(result: &StaticResult) -> [f64; 2] {
    let tip = &result.step.cracks[0].tips[0];
    [tip.k1.expect("evaluated"), tip.k2.expect("evaluated")]
}

/// What a crack cuts out carries nothing: it might as well be a hole.
#[test]
fn a_piece_that_is_cut_out_is_like_a_hole() {
    let hole = factors(&run(&plate(vec![polygon(&SQUARE)]), &Settings::default()));
    let mut model = plate(vec![]);
    let mut around = SQUARE.to_vec();
    around.push(SQUARE[0]);
    model.cracks.push(crack(&around, [Junction; 2]));
    let piece = factors(&run(&model, &Settings::default()));
    assert!((piece[0] / hole[0] - 1.0).abs() < 2e-3, "{piece:?} {hole:?}");
    assert!((piece[1] - hole[1]).abs() < 2e-3 * hole[0], "{piece:?} {hole:?}");
}

/// Two cracks that meet end to end are one crack.
#[test]
fn cracks_that_meet_at_their_ends_are_like_one() {
    let mut one = plate(vec![]);
    one.cracks[0] = crack(&[(0.0, 2.1), (0.9, 2.1), (1.7, 2.4)], [Mouth, Tip]);
    let mut two = plate(vec![]);
    two.cracks[0] = crack(&[(0.9, 2.1), (1.7, 2.4)], [Junction, Tip]);
    two.cracks.push(crack(&[(0.0, 2.1), (0.9, 2.1)], [Mouth, Junction]));
    two.cracks[1].name = "first half".into();
    let [one, two] = [one, two].map(|m| factors(&run(&m, &Settings::default())));
    // The domains of the second are smaller: they end where its path does.
    assert!((two[0] / one[0] - 1.0).abs() < 2e-3, "{one:?} {two:?}");
    assert!((two[1] - one[1]).abs() < 2e-3 * one[0], "{one:?} {two:?}");
}

/// Between clamps both halves are held once a crack has gone through, and what is left of factors is rounding.
#[test]
fn cracks_in_pieces_that_carry_nothing_do_not_grow() {
    let mut model = body(rectangle((0.0, 0.0), (4.0, 6.0)), PlaneState::Strain);
    hold(&mut model, 0, BOTH[0], 0.0023);
    hold(&mut model, 0, BOTH[1], -0.0071);
    hold(&mut model, 2, BOTH[0], 0.0031);
    hold(&mut model, 2, BOTH[1], 0.0113);
    model.cracks.push(crack(&[(0.0, 3.0), (3.8, 3.0)], [Mouth, Tip]));
    // Rounding has either sign: one crack alone might be closed by chance.
    for (k, [from, to]) in
        [[(0.0, 4.5), (0.8, 4.6)], [(4.0, 4.2), (3.3, 4.1)], [(0.0, 1.5), (0.7, 1.6)], [(4.0, 1.4), (3.2, 1.5)]]
            .into_iter()
            .enumerate()
    {
        model.cracks.push(crack(&[from, to], [Mouth, Tip]));
        model.cracks[k + 1].name = format!("beside-{k}");
    }
    let growth = GrowthSettings { increment: Some(0.3), ..GrowthSettings::default() };
    let (steps, end) = grow(&model, &Settings::default(), &growth);
    assert_eq!((steps.records.len(), end.kind), (2, GrowthEndKind::NoTipGrows), "{end:?}");
    assert_eq!(steps.records[0].cracks[0].tips[0].status, TipStatus::ReachedBoundary);
    for beside in 1..=4 {
        let left = steps.tip(1, beside);
        assert!(matches!(left.status, TipStatus::Unloaded | TipStatus::Closed), "{left:?}");
        assert_eq!(left.increment, Some(0.0));
    }
}
