//! Laws of growth against closed forms: load factors, lives, thresholds, limits.

use crate::bodies::{body, crack, rectangle};
use crate::steps::{Steps, grow};
use riss::analysis::crack_growth::settings::{AdvanceLaw, Fatigue, QuasiStatic, StopSettings};
use riss::analysis::{GrowthEndKind, GrowthSettings, Settings, Stability, TipStatus};
use riss::crack::EndKind::{Mouth, Tip};
use riss::fracture::fatigue::{GrowthLaw, LoadSpectrum, Nasgro, Rate};
use riss::material::PlaneState;
use riss::math::{Matrix2, Vector2};
use riss::model::{BoundaryLoad, Model, PointSupport, RigidMotion, TractionValue};
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
        // A bar of a factor is m times as wide for the life.
        let [fewest, most] = record.cycles_range.expect("fatigue counts cycles");
        let tips = steps.records[..=record.step].iter().flat_map(|r| &r.cracks[0].tips);
        let bars: Vec<f64> = tips.map(|t| m * t.k_uncertainty.unwrap() / t.k1.unwrap()).collect();
        let [least, largest] = [f64::min, f64::max].map(|pick| bars.iter().copied().reduce(pick).unwrap());
        for width in [1.0 - fewest / cycles, most / cycles - 1.0] {
            assert!(width > 0.95 * least && width < 1.05 * largest, "step {}: {width}", record.step);
        }
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

/// Arms of a double cantilever beam held apart: K falls as 1/a², and passes the threshold within an increment.
#[test]
fn where_the_factor_falls_growth_ends_at_the_threshold_or_never_gets_there() {
    let mut model = body(rectangle((0.0, -1.0), (20.0, 1.0)), PlaneState::Strain);
    model.cracks.push(crack(&[(0.0, 0.0), (6.0, 0.0)], [Mouth, Tip]));
    for y in [-1.0, 1.0] {
        model.point_supports.push(PointSupport { at: Vector2::new(0.0, y), displacement: [None, Some(1e-3 * y)] });
    }
    model.point_supports.push(PointSupport { at: Vector2::new(20.0, 0.0), displacement: [Some(0.0); 2] });
    let run = |law| {
        let growth = GrowthSettings { increment: Some(0.5), law, ..GrowthSettings::default() };
        grow(&model, &Settings::default(), &growth)
    };
    let free = run(paris(1.0, 2.0, None, None)).0;
    let k: Vec<f64> = (0..4).map(|step| free.tip(step, 0).k_equivalent.expect("evaluated")).collect();
    assert!(k.windows(2).all(|w| w[1] < w[0]), "{k:?}");
    // In the middle of the third increment.
    let threshold = 0.5 * (k[2] + k[3]);
    let (cut, end) = run(paris(1.0, 2.0, Some(threshold), None));
    assert_eq!(end.kind, GrowthEndKind::NoTipGrows);
    assert_eq!(cut.records.len(), 4);
    assert_eq!(cut.tip(3, 0).status, TipStatus::Arrested);
    let cycles = |steps: &Steps, step: usize| steps.records[step].cycles.expect("fatigue counts");
    // The same rate as without a threshold as far as it goes.
    let (whole, part) = (cycles(&free, 3) - cycles(&free, 2), cycles(&cut, 3) - cycles(&cut, 2));
    assert!(part > 0.4 * whole && part < 0.6 * whole, "{part} of {whole}");
    // A rate that vanishes linearly at the threshold never brings the tip there.
    let nasgro = |threshold: f64| {
        let (coefficient, exponent, p, q, toughness) = (1.0, 2.0, 1.0, 0.0, 100.0 * k[0]);
        let (threshold_spread, negative_threshold_spread, alpha, stress_level) = (0.0, 0.0, 2.0, 0.3);
        GrowthLaw::Nasgro(Nasgro {
            coefficient,
            exponent,
            p,
            q,
            toughness,
            threshold,
            threshold_spread,
            negative_threshold_spread,
            alpha,
            stress_level,
        })
    };
    let ends_there = |law: &GrowthLaw| law.rate(0.0, k[2]) != Rate::Arrested && law.rate(0.0, k[3]) == Rate::Arrested;
    let rate = (0..100).map(|i| nasgro(k[3] * 0.02 * i as f64)).find(ends_there).expect("a threshold between");
    let (crept, end) = run(AdvanceLaw::Fatigue(Fatigue { rate, spectrum: LoadSpectrum::default() }));
    assert_eq!((crept.records.len(), end.kind), (4, GrowthEndKind::NoTipGrows));
    assert!(end.reason.contains("creeps towards its threshold"), "{}", end.reason);
    assert!(crept.records[3].cycles.is_some_and(f64::is_finite));
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
