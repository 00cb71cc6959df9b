//! Laws of growth against closed forms: load factors, lives, thresholds, limits.

use crate::bodies::{body, crack, rectangle};
use crate::steps::grow;
use riss::analysis::crack_growth::settings::{AdvanceLaw, Fatigue, QuasiStatic, StopSettings};
use riss::analysis::{GrowthEndKind, GrowthSettings, Settings, Stability, TipStatus};
use riss::crack::EndKind::{Mouth, Tip};
use riss::fracture::fatigue::{GrowthLaw, LoadSpectrum};
use riss::material::PlaneState;
use riss::math::Matrix2;
use riss::model::{BoundaryLoad, Model, RigidMotion, TractionValue};
use std::f64::consts::PI;

const HALF_WIDTH: f64 = 5.0;

/// A long plate in tension with a central crack of half length 1. Twice as long as wide, it would be 0.1 % off the handbook's strip.
fn center_crack() -> Model {
    let mut model = body(rectangle((-HALF_WIDTH, -15.0), (HALF_WIDTH, 15.0)), PlaneState::Strain);
    model.rigid_motion = RigidMotion::MeanIsZero;
    let stress = TractionValue::UniformStress(Matrix2::new(0.0, 0.0, 0.0, 1.0));
    model.loads.push(BoundaryLoad { part: None, value: stress });
    model.cracks.push(crack(&[(-1.0, 0.0), (1.0, 0.0)], [Tip; 2]));
    model
}

/// Center crack of finite width [Tada, p. 41]: good to 0.1 % for every ratio in a long plate.
fn handbook(a: f64) -> f64 {
    let r = a / HALF_WIDTH;
    (1.0 - 0.025 * r.powi(2) + 0.06 * r.powi(4)) * (1.0 / (0.5 * PI * r).cos()).sqrt() * (PI * a).sqrt()
}

fn paris(coefficient: f64, exponent: f64, threshold: Option<f64>, toughness: Option<f64>) -> AdvanceLaw {
    let rate = GrowthLaw::Paris { coefficient, exponent, threshold, toughness };
    AdvanceLaw::Fatigue(Fatigue { rate, spectrum: LoadSpectrum::default() })
}

#[test]
fn paris_life_is_the_integral_of_the_handbook() {
    let (c, m) = (1e-5, 3.0);
    let growth =
        GrowthSettings { increment: Some(0.25), steps: 8, law: paris(c, m, None, None), ..GrowthSettings::default() };
    let (steps, end) = grow(&center_crack(), &Settings::default(), &growth);
    assert_eq!(end.kind, GrowthEndKind::StepsDone);
    // Simpson's rule on the handbook's factor.
    let n = 2000;
    let rate = |a: f64| 1.0 / (c * handbook(a).powf(m));
    for record in &steps.records[1..] {
        let h = 0.25 * record.step as f64 / n as f64;
        let weight = |k: usize| {
            if k == 0 || k == n {
                1.0
            } else if k % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        let life: f64 = (0..=n).map(|k| weight(k) * rate(1.0 + k as f64 * h)).sum::<f64>() * h / 3.0;
        let cycles = record.cycles.expect("fatigue counts cycles");
        // Three times the 0.1 % of the handbook's factor.
        assert!((cycles / life - 1.0).abs() < 3e-3, "step {}: {cycles} of {life}", record.step);
        let lengths: Vec<f64> = record.cracks[0].tips.iter().map(|t| t.position.x.abs()).collect();
        assert!((lengths[0] - lengths[1]).abs() < 1e-3 * lengths[0], "{lengths:?}");
    }
}

#[test]
fn load_factor_follows_the_toughness_and_falls_where_growth_is_unstable() {
    let law = AdvanceLaw::QuasiStatic(QuasiStatic { toughness: Some(10.0), fracture_energy: None, tie: 0.01 });
    let growth = GrowthSettings { increment: Some(0.4), steps: 3, law, ..GrowthSettings::default() };
    let model = center_crack();
    let (steps, _) = grow(&model, &Settings::default(), &growth);
    for (k, record) in steps.records.iter().enumerate() {
        let expected = 10.0 / handbook(1.0 + 0.4 * k as f64);
        assert!((record.load_factor / expected - 1.0).abs() < 2e-3, "{} of {expected}", record.load_factor);
        assert_eq!(record.stability, (k > 0).then_some(Stability::Unstable));
    }
    // The fracture energy says the same: G_c = K² / E'.
    let energy = 100.0 / model.material.effective_young();
    let law = AdvanceLaw::QuasiStatic(QuasiStatic { toughness: None, fracture_energy: Some(energy), tie: 0.01 });
    let (again, _) = grow(&model, &Settings::default(), &GrowthSettings { steps: 1, law, ..growth });
    assert!((again.records[0].load_factor / steps.records[0].load_factor - 1.0).abs() < 1e-12);
}

#[test]
fn below_the_threshold_nothing_grows_and_at_the_toughness_it_ends() {
    let k0 = handbook(1.0);
    let arrested = GrowthSettings { law: paris(1e-5, 3.0, Some(1.01 * k0), None), ..GrowthSettings::default() };
    let (steps, end) = grow(&center_crack(), &Settings::default(), &arrested);
    assert_eq!((steps.records.len(), end.kind), (1, GrowthEndKind::NoTipGrows));
    assert!(steps.records[0].cracks[0].tips.iter().all(|t| t.status == TipStatus::Arrested));
    let law = paris(1e-5, 3.0, None, Some(handbook(1.45)));
    let brittle = GrowthSettings { increment: Some(0.2), law, ..GrowthSettings::default() };
    let (steps, end) = grow(&center_crack(), &Settings::default(), &brittle);
    assert_eq!((steps.records.len(), end.kind), (4, GrowthEndKind::ToughnessReached));
}

#[test]
fn stops_are_kept() {
    let stop = StopSettings { crack_length: Some(1.3), ..StopSettings::default() };
    let growth = GrowthSettings { increment: Some(0.2), stop, ..GrowthSettings::default() };
    let (steps, end) = grow(&center_crack(), &Settings::default(), &growth);
    assert_eq!((steps.records.len(), end.kind), (3, GrowthEndKind::LimitReached));
    let stop = StopSettings { cycles: Some(1.0), ..StopSettings::default() };
    let growth =
        GrowthSettings { increment: Some(0.2), stop, law: paris(1e-5, 3.0, None, None), ..GrowthSettings::default() };
    assert_eq!(grow(&center_crack(), &Settings::default(), &growth).1.kind, GrowthEndKind::LimitReached);
}

#[test]
fn a_crack_in_compression_is_closed_and_a_held_one_stays() {
    let mut model = center_crack();
    model.loads[0].value = TractionValue::UniformStress(Matrix2::new(0.0, 0.0, 0.0, -1.0));
    let (steps, end) = grow(&model, &Settings::default(), &GrowthSettings::default());
    assert_eq!(end.kind, GrowthEndKind::NoTipGrows);
    assert!(steps.records[0].cracks[0].tips.iter().all(|t| t.status == TipStatus::Closed && t.increment == Some(0.0)));
    let mut model = center_crack();
    model.cracks.push(crack(&[(-5.0, 6.0), (-3.8, 6.0)], [Mouth, Tip]));
    model.cracks[1].name = "edge".into();
    let growth =
        GrowthSettings { increment: Some(0.2), steps: 1, held: vec!["crack".into()], ..GrowthSettings::default() };
    let (steps, _) = grow(&model, &Settings::default(), &growth);
    assert_eq!(steps.cracks()[0], model.cracks[0]);
    assert_eq!(steps.tip(0, 0).status, TipStatus::Held);
    assert!((steps.cracks()[1].length() - 1.4).abs() < 1e-12);
}
