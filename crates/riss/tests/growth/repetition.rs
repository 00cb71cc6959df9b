//! The same steps again: from a restart, and with any number of threads.

use crate::bodies::{BOTH, body, crack, graded_to, hold, rectangle, with_nodes};
use crate::steps::Steps;
use riss::analysis::crack_growth::settings::{AdvanceLaw, Fatigue, IncrementControl, IncrementForm};
use riss::analysis::{GrowthSettings, GrowthState, crack_growth};
use riss::crack::EndKind::{Mouth, Tip};
use riss::fracture::fatigue::{GrowthLaw, LoadSpectrum};
use riss::material::PlaneState;
use riss::model::{BoundaryLoad, Model, TractionValue};

/// A clamped plate under shear with two cracks that grow at different rates.
fn sheared_plate() -> Model {
    let mut model = body(rectangle((0.0, 0.0), (4.0, 5.0)), PlaneState::Strain);
    BOTH.into_iter().for_each(|d| hold(&mut model, 0, d, 0.0));
    let traction = TractionValue::Components([1.0.into(), 0.5.into()]);
    model.loads.push(BoundaryLoad { part: Some(2), value: traction });
    model.cracks.push(crack(&[(0.0, 2.6), (1.5, 2.6)], [Mouth, Tip]));
    model.cracks.push(crack(&[(2.2, 3.6), (2.9, 3.4)], [Tip; 2]));
    model.cracks[1].name = "inner".into();
    model
}

fn everything() -> GrowthSettings {
    let rate = GrowthLaw::Paris { coefficient: 1e-6, exponent: 2.5, threshold: None, toughness: None };
    GrowthSettings {
        increment: Some(0.2),
        steps: 4,
        law: AdvanceLaw::Fatigue(Fatigue { rate, spectrum: LoadSpectrum::default() }),
        control: IncrementControl::HalvedOnTurns { angle_deg: 6.0, least: 0.0625 },
        form: IncrementForm::Curved,
        ..GrowthSettings::default()
    }
}

fn run(growth: &GrowthSettings, start: Option<GrowthState>, most: Option<usize>) -> Steps {
    let mut steps = Steps { most, ..Steps::default() };
    crack_growth(&sheared_plate(), &with_nodes(graded_to(0.3, 0.02)), growth, start, &mut steps)
        .expect("it can be solved");
    steps
}

#[test]
fn an_interrupted_run_goes_on_to_the_same_bits() {
    let growth = everything();
    let whole = run(&growth, None, None);
    assert_eq!(whole.records.len(), 5);
    assert!(whole.records.windows(2).all(|w| w[1].cycles > w[0].cycles));
    for step in [0, 1, 3, 4] {
        // By way of the file that a restart reads.
        let text = serde_json::to_string(&whole.states[step]).expect("a state is plain values");
        let state: GrowthState = serde_json::from_str(&text).expect("it was just written");
        assert_eq!(state, whole.states[step]);
        let rest = run(&growth, Some(state), None);
        assert_eq!(rest.records, whole.records[step..]);
    }
}

/// The automatic increment follows from the cracks at the beginning, not from those of a restart.
#[test]
fn an_automatic_increment_stays_after_a_restart() {
    let growth = GrowthSettings { increment: None, steps: 2, ..GrowthSettings::default() };
    let whole = run(&growth, None, None);
    let rest = run(&growth, Some(whole.states[1].clone()), None);
    assert_eq!(rest.records, whole.records[1..]);
    // A hundredth of the root of the area, which lies between a tenth and half of the shorter crack, 0.5 |(0.7, -0.2)|.
    let increment = whole.tip(1, 0).increment.expect("it grows");
    assert!((increment - 0.01 * 20f64.sqrt()).abs() < 1e-12, "{increment}");
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let runs = [1, 2, 4].map(|n| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads can be started");
        pool.install(|| run(&everything(), None, Some(3)).records)
    });
    assert!(runs[0] == runs[1] && runs[0] == runs[2]);
}

#[test]
fn growth_settings_may_change_between_runs() {
    let first = run(&everything(), None, Some(3));
    let shorter = GrowthSettings { increment: Some(0.05), steps: 3, ..everything() };
    let rest = run(&shorter, Some(first.states[2].clone()), None);
    assert_eq!(rest.records[0].cracks[0].path, first.records[2].cracks[0].path);
    let increments: Vec<f64> =
        rest.records[0].cracks.iter().flat_map(|c| &c.tips).filter_map(|t| t.increment).collect();
    assert!(increments.iter().all(|i| *i <= 0.05 + 1e-12), "{increments:?}");
}
