//! Lives against closed forms and Simpson's rule.

use super::*;
use crate::fracture::fatigue::{Block, LoadSpectrum, Nasgro, TablePoint};
use std::f64::consts::PI;

const C: f64 = 2e-12;
const STRESS: f64 = 90.0;

fn paris(exponent: f64, threshold: Option<f64>, toughness: Option<f64>) -> GrowthLaw {
    GrowthLaw::Paris { coefficient: C, exponent, threshold, toughness }
}

fn constant(stress_ratio: f64) -> Vec<LoadCycle> {
    LoadSpectrum::ConstantAmplitude { stress_ratio, maximum: 1.0 }.cycles()
}

/// A crack in an infinite plate, K = σ √(π a).
fn plate(a_start: f64, a_end: f64) -> Increment {
    let k = |a: f64| STRESS * (PI * a).sqrt();
    Increment { a_start, a_end, k_start: k(a_start), k_end: k(a_end) }
}

fn check_life(law: &GrowthLaw, cycles: &[LoadCycle], increment: Increment, expected: f64) -> Ending {
    let life = cycles_over(law, cycles, increment);
    assert!((life.cycles / expected - 1.0).abs() < 1e-9, "{law:?}: {life:?}, not {expected}");
    assert!(life.error <= 1e-8 * expected, "{law:?}: {life:?}");
    life.ending
}

/// ∫ a^s da.
fn power_integral(s: f64, from: f64, to: f64) -> f64 {
    if s == -1.0 { (to / from).ln() } else { (to.powf(s + 1.0) - from.powf(s + 1.0)) / (s + 1.0) }
}

/// ∫ da / (C (K₁ √a)^m), the closed form of the law of Paris for K = K₁ √a.
fn paris_life(k_unit: f64, m: f64, from: f64, to: f64) -> f64 {
    power_integral(-0.5 * m, from, to) / (C * k_unit.powf(m))
}

#[test]
fn paris_in_an_infinite_plate_is_the_closed_form() {
    for m in [2.0, 3.0, 4.0, 3.3] {
        for (from, to) in [(0.01, 0.0101), (0.01, 0.02), (0.001, 0.1)] {
            for ratio in [0.0, 0.5, -1.0_f64] {
                let expected = paris_life(STRESS * PI.sqrt() * (1.0 - ratio.max(0.0)), m, from, to);
                assert_eq!(
                    check_life(&paris(m, None, None), &constant(ratio), plate(from, to), expected),
                    Ending::Grown
                );
            }
        }
    }
}

#[test]
fn walker_in_an_infinite_plate_is_the_closed_form() {
    let law = |gamma| GrowthLaw::Walker { coefficient: C, exponent: 3.2, gamma, threshold: None, toughness: None };
    for gamma in [0.0, 0.4, 1.0] {
        for ratio in [0.0, 0.7] {
            let by_ratio = (1.0 - ratio) / f64::powf(1.0 - ratio, 1.0 - gamma);
            let expected = paris_life(STRESS * PI.sqrt() * by_ratio, 3.2, 0.01, 0.03);
            check_life(&law(gamma), &constant(ratio), plate(0.01, 0.03), expected);
        }
        check_life(&law(gamma), &constant(-2.0), plate(0.01, 0.03), paris_life(STRESS * PI.sqrt(), 3.2, 0.01, 0.03));
    }
}

/// 1/rate is the sum of two powers of a: (1 − R) K_c ΔK^(−m) / C − ΔK^(1 − m) / C.
fn forman_life(toughness: f64, ratio: f64, m: f64, from: f64, to: f64) -> f64 {
    let range = STRESS * PI.sqrt() * (1.0 - ratio);
    (1.0 - ratio) * toughness * paris_life(range, m, from, to) - paris_life(range, m - 1.0, from, to)
}

#[test]
fn forman_in_an_infinite_plate_is_the_closed_form() {
    for (m, ratio) in [(3.0, 0.0), (3.4, 0.5), (2.0, 0.2)] {
        let law = GrowthLaw::Forman { coefficient: C, exponent: m, toughness: 60.0, threshold: None };
        let expected = forman_life(60.0, ratio, m, 0.01, 0.05);
        assert_eq!(check_life(&law, &constant(ratio), plate(0.01, 0.05), expected), Ending::Grown);
        // K reaches 60 at a = (60/90)²/π.
        let critical = (60.0_f64 / STRESS).powi(2) / PI;
        let expected = forman_life(60.0, ratio, m, 0.01, critical);
        let Ending::Unstable { at } = check_life(&law, &constant(ratio), plate(0.01, 0.5), expected) else {
            panic!("unstable")
        };
        assert!((at / critical - 1.0).abs() < 1e-14, "{at}");
    }
}

/// The equation with α = 2 and S_max/σ₀ = 0, where A₀ = 0.345, A₁ = 0, A₂ = 0.965, A₃ = −0.31.
fn nasgro_rate(law: &Nasgro, ratio: f64, k: f64) -> f64 {
    let f = if ratio < 0.0 { 0.345 } else { 0.345 + 0.965 * ratio.powi(2) - 0.31 * ratio.powi(3) };
    let threshold = if ratio < 0.0 {
        law.threshold * ((1.0 - ratio) / (1.0 - f)).powf(1.0 + 0.1 * ratio) / 0.655_f64.powf(1.5 - 0.1 * ratio)
    } else {
        law.threshold * ((1.0 - ratio) / (1.0 - f)).powf(1.0 + 1.5 * ratio) / 0.655_f64.powf(1.5 * (1.0 - ratio))
    };
    let range = (1.0 - ratio) * k;
    let effective = (1.0 - f) / (1.0 - ratio) * range;
    law.coefficient * effective.powf(law.exponent) * (1.0 - threshold / range).powf(law.p)
        / (1.0 - k / law.toughness).powf(law.q)
}

fn nasgro(exponent: f64, p: f64, q: f64) -> Nasgro {
    Nasgro {
        coefficient: C,
        exponent,
        p,
        q,
        toughness: 70.0,
        threshold: 1.5,
        threshold_spread: 1.5,
        negative_threshold_spread: 0.1,
        alpha: 2.0,
        stress_level: 0.0,
    }
}

fn simpson(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    const N: usize = 20_000;
    let h = (to - from) / N as f64;
    let weight = |i| if i == 0 || i == N { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
    (0..=N).map(|i| weight(i) * f(from + h * i as f64)).sum::<f64>() * h / 3.0
}

#[test]
fn nasgro_in_an_infinite_plate_is_what_simpson_says() {
    for ratio in [0.0, 0.4, -1.0] {
        for (p, q) in [(0.5, 1.0), (0.25, 0.25), (2.0, 0.0)] {
            let law = nasgro(3.1, p, q);
            let (from, to) = (0.01, 0.1);
            let expected = simpson(|a| 1.0 / nasgro_rate(&law, ratio, STRESS * (PI * a).sqrt()), from, to);
            check_life(&GrowthLaw::Nasgro(law), &constant(ratio), plate(from, to), expected);
        }
    }
}

/// K = 20/a falls to the threshold of R = 0, K_th = 1.5 / 0.655^2.5. With v = 1 − K_th/K the life until then is
/// 20 / (C 0.655^m K_th^(m + 1)) ∫ (1 − v)^m v^(−1/2) dv from 0 to 1 − K_th/20, here for m = 2.
#[test]
fn nasgro_arrests_after_the_closed_form() {
    let increment = Increment { a_start: 1.0, a_end: 16.0, k_start: 20.0, k_end: 1.25 };
    let law = nasgro(2.0, 0.5, 0.0);
    let threshold = 1.5 / 0.655_f64.powf(2.5);
    let v = 1.0 - threshold / 20.0;
    let powers = 2.0 * v.powf(0.5) - 4.0 / 3.0 * v.powf(1.5) + 0.4 * v.powf(2.5);
    let expected = 20.0 / (C * 0.655_f64.powi(2) * threshold.powi(3)) * powers;
    let Ending::Arrests { at } = check_life(&GrowthLaw::Nasgro(law), &constant(0.0), increment, expected) else {
        panic!("arrests")
    };
    assert!((at / (20.0 / threshold) - 1.0).abs() < 1e-14, "{at}");
    let life = cycles_over(&GrowthLaw::Nasgro(nasgro(2.0, 1.0, 0.0)), &constant(0.0), increment);
    assert_eq!(life.cycles, f64::INFINITY);
    assert!(matches!(life.ending, Ending::Arrests { .. }));
}

/// K = 20/a and a rate C K³ that breaks off at K = 12, a = 5/3: N = ∫ a³ da / (C 20³).
#[test]
fn paris_arrests_at_its_threshold() {
    let increment = Increment { a_start: 1.0, a_end: 2.0, k_start: 20.0, k_end: 10.0 };
    let at_threshold = 20.0_f64 / 12.0;
    let expected = power_integral(3.0, 1.0, at_threshold) / (C * 8000.0);
    let law = paris(3.0, Some(12.0), None);
    let Ending::Arrests { at } = check_life(&law, &constant(0.0), increment, expected) else { panic!("arrests") };
    assert!((at / at_threshold - 1.0).abs() < 1e-14, "{at}");
    // Backwards the crack never starts, and above the toughness it never grows in a stable way.
    let back = Increment { k_start: 10.0, k_end: 20.0, ..increment };
    let at = increment.a_start;
    let immediately = |ending| LifeOverIncrement { cycles: 0.0, error: 0.0, ending };
    assert_eq!(cycles_over(&law, &constant(0.0), back), immediately(Ending::Arrests { at }));
    let brittle = paris(3.0, None, Some(20.0));
    assert_eq!(cycles_over(&brittle, &constant(0.0), increment), immediately(Ending::Unstable { at }));
}

/// Small cycles take part from ΔK = 12 on: factor 0.5, thus K = 24 or a = (24/90)²/π = 0.0226.
#[test]
fn small_cycles_of_a_spectrum_take_part_above_their_threshold() {
    let block = |maximum, cycles| Block { minimum: 0.0, maximum, cycles };
    let spectrum = LoadSpectrum::Blocks { blocks: vec![block(1.0, 1.0), block(0.5, 3.0)] };
    let joins = (24.0_f64 / STRESS).powi(2) / PI;
    let plain = |from, to| paris_life(STRESS * PI.sqrt(), 4.0, from, to);
    // Per four cycles the growth is 1, later 1 + 3/16 times that of the large cycle.
    let expected = 4.0 * plain(0.02, joins) + 4.0 / (1.0 + 3.0 / 16.0) * plain(joins, 0.03);
    check_life(&paris(4.0, Some(12.0), None), &spectrum.cycles(), plate(0.02, 0.03), expected);
    // Underneath a toughness that only the large cycle meets at K = 25.
    let Ending::Unstable { at } =
        cycles_over(&paris(4.0, None, Some(25.0)), &spectrum.cycles(), plate(0.02, 0.03)).ending
    else {
        panic!("unstable")
    };
    assert!((at / ((25.0_f64 / STRESS).powi(2) / PI) - 1.0).abs() < 1e-14, "{at}");
}

/// From a length of zero K is linear in a: N = L/(K₁ − K₀) ∫ dK / (C K^m).
#[test]
fn without_logarithms_the_path_is_linear() {
    let increment = Increment { a_start: 0.0, a_end: 0.5, k_start: 5.0, k_end: 8.0 };
    let expected = 0.5 / 3.0 * power_integral(-3.0, 5.0, 8.0) / C;
    assert_eq!(check_life(&paris(3.0, None, None), &constant(0.0), increment, expected), Ending::Grown);
    let closing = Increment { k_start: 5.0, k_end: -5.0, ..increment };
    let life = cycles_over(&paris(3.0, Some(1.0), None), &constant(0.0), closing);
    // K = 5 − 20 a falls to 1 at a = 0.2.
    assert!(matches!(life.ending, Ending::Arrests { at } if (at - 0.2).abs() < 1e-15), "{life:?}");
    let expected = 0.05 * power_integral(-3.0, 1.0, 5.0) / C;
    assert!((life.cycles / expected - 1.0).abs() < 1e-9, "{life:?}, not {expected}");
}

#[test]
fn an_increment_of_no_length_takes_no_cycles() {
    let life = cycles_over(&paris(3.0, None, None), &constant(0.0), plate(0.01, 0.01));
    assert_eq!(life, LifeOverIncrement { cycles: 0.0, error: 0.0, ending: Ending::Grown });
}

/// Many small cycles, each with its own threshold within the increment, still add up; between the thresholds the
/// closed form holds.
#[test]
fn a_spectrum_with_many_thresholds_is_integrated() {
    let blocks = (0..60).map(|i| Block { minimum: 0.0, maximum: 1.0 - 0.005 * f64::from(i), cycles: 1.0 }).collect();
    let cycles = LoadSpectrum::Blocks { blocks }.cycles();
    let law = paris(3.0, Some(20.0), None);
    let increment = plate(0.018, 0.03);
    let place = |factor: f64| (20.0 / (factor * STRESS)).powi(2) / PI;
    let mut expected = 0.0;
    let mut places: Vec<f64> = cycles.iter().map(|c| place(c.maximum)).filter(|a| (0.018..0.03).contains(a)).collect();
    places.insert(0, 0.018);
    places.push(0.03);
    for pair in places.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        let cubes: f64 = cycles.iter().filter(|c| place(c.maximum) < middle).map(|c| c.maximum.powi(3)).sum();
        expected += 60.0 / cubes * paris_life(STRESS * PI.sqrt(), 3.0, pair[0], pair[1]);
    }
    assert!(places.len() > 30, "{}", places.len());
    check_life(&law, &cycles, increment, expected);
}

/// Lines of slope 2 up to ΔK = 30 and 4 beyond, K = 30 at a = (30/90)²/π = 0.0354.
#[test]
fn a_table_is_integrated_line_by_line() {
    let point = |stress_intensity_range, rate| TablePoint { stress_intensity_range, rate };
    let points = vec![point(10.0, 100.0 * C), point(30.0, 900.0 * C), point(60.0, 14400.0 * C)];
    let law = GrowthLaw::Tabulated { points, toughness: None };
    let kink = (30.0_f64 / STRESS).powi(2) / PI;
    let k_unit = STRESS * PI.sqrt();
    for (from, to) in [(0.01, 0.05), (0.0353, 0.4), (0.03, 0.03538)] {
        let expected = paris_life(k_unit, 2.0, from, kink) + 900.0 * paris_life(k_unit, 4.0, kink, to);
        check_life(&law, &constant(0.0), plate(from, to), expected);
    }
}
