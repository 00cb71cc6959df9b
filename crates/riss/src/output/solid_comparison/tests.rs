//! Tests of the comparison of solids: fronts of closed form.

use super::*;
use crate::output::RunStatus;
use crate::output::solid_results::{SolidStepCrack, SolidStepResults, SolverResults, StressResults};
use std::f64::consts::{PI, TAU};

/// Points along an arc of a circle, from one angle to another; `K_I` is a function of the angle.
fn arc(radius: f64, n: usize, [from, to]: [f64; 2], k1: impl Fn(f64) -> f64) -> FrontResults {
    let closed = to - from == TAU;
    let point = |k: usize| {
        let angle = from + (to - from) * (k as f64 + if closed { 0.0 } else { 0.5 }) / n as f64;
        let (sin, cos) = angle.sin_cos();
        FrontPointResults {
            position: [Some(radius * cos), Some(radius * sin), Some(0.0)],
            s: Some(radius * (angle - from)),
            // ahead x normal goes counterclockwise.
            ahead: [Some(cos), Some(sin), Some(0.0)],
            normal: [Some(0.0), Some(0.0), Some(-1.0)],
            k1: Some(k1(angle)),
            k2: Some(0.0),
            k3: Some(0.0),
            k_uncertainty: Some(0.02),
            t_stress: None,
            t_uncertainty: None,
            j: None,
            j_uncertainty: None,
            disc_radius: None,
        }
    };
    let length = Some(radius * (to - from));
    FrontResults { crack: "c".into(), closed, length, points: (0..n).map(point).collect() }
}

fn results(fronts: Vec<FrontResults>) -> SolidResults {
    SolidResults {
        riss: String::new(),
        case: String::new(),
        method: "collocation".into(),
        units: None,
        status: RunStatus::Done,
        nodes: 0,
        unknowns: 0,
        wall_time_s: None,
        stage_time_s: Default::default(),
        peak_memory_bytes: None,
        solver: SolverResults { method: String::new(), iterations: 0, residual: None },
        warnings: vec![],
        files: vec![],
        stress: StressResults { largest_principal: Some(5.0), position: None },
        cracks: vec![],
        fronts,
        crack_area: None,
        growth_end: None,
        steps: vec![],
        loading: None,
        load_curve: vec![],
    }
}

fn grown(radii: &[f64]) -> SolidResults {
    let step = |(k, radius): (usize, &f64)| SolidStepResults {
        step: k,
        nodes: 0,
        load_factor: None,
        front_vertices: 0,
        moving_vertices: 0,
        cracks: vec![SolidStepCrack { name: "c".into(), area: Some(PI * radius * radius) }],
        fronts: vec![arc(*radius, 16, [0.0, TAU], |_| radius.sqrt())],
        warnings: vec![],
    };
    let steps: Vec<SolidStepResults> = radii.iter().enumerate().map(step).collect();
    let fronts = steps[steps.len() - 1].fronts.clone();
    SolidResults { steps, ..results(fronts) }
}

const WITHIN: Tolerances = Tolerances { path: 1e-3, k: 0.01, load: 0.01 };

#[test]
fn points_of_closed_fronts_need_not_coincide() {
    let k = |angle: f64| 10.0 + angle.cos();
    let (a, b) = (results(vec![arc(2.0, 16, [0.0, TAU], k)]), results(vec![arc(2.0, 40, [0.0, TAU], k)]));
    let found = SolidComparison::new(&a, &b);
    let front = &found.steps[0].fronts[0];
    assert_eq!((front.points, front.lengths), (16, [Some(2.0 * TAU); 2]));
    // Between the 40 points the cosine is replaced by chords: (2π/40)²/8 of it, and the circle by cubics.
    assert!(front.k_difference.unwrap() < 4e-4 && front.front_distance.unwrap() < 1e-4, "{front:?}");
    assert!(found.agrees(&WITHIN));
    let other = SolidComparison::new(&a, &results(vec![arc(2.1, 40, [0.0, TAU], |v| 1.05 * k(v))]));
    let front = &other.steps[0].fronts[0];
    assert!((front.front_distance.unwrap() - 0.1).abs() < 1e-3);
    // Five percent, largest where K is.
    assert!((front.k_difference.unwrap() - 0.05).abs() < 1e-3 && front.s == Some(0.0), "{front:?}");
    assert!((front.k_uncertainty.unwrap() - 0.02 / 11.0).abs() < 1e-12 && !other.agrees(&WITHIN));
}

#[test]
fn open_fronts_are_compared_as_far_as_both_go() {
    let a = results(vec![arc(1.0, 12, [0.0, PI], |v| 10.0 + v)]);
    let b = results(vec![arc(1.0, 6, [0.0, PI], |v| 10.0 + v)]);
    let front = &SolidComparison::new(&a, &b).steps[0].fronts[0];
    // The first and the last of the 12 lie outside of the 6.
    assert_eq!(front.points, 10);
    assert!(front.k_difference.unwrap() < 1e-3 && front.front_distance.unwrap() < 1e-3, "{front:?}");
}

#[test]
fn steps_of_growth_belong_together_by_area() {
    let (a, b) = (grown(&[1.0, 1.2, 1.4]), grown(&[1.0, 1.1, 1.2, 1.3, 1.4]));
    let found = SolidComparison::new(&a, &b);
    let pairs: Vec<[usize; 2]> = found.steps.iter().map(|s| s.steps).collect();
    assert_eq!((pairs, found.only_in_second.as_slice()), (vec![[0, 0], [1, 2], [2, 4]], &[1, 3][..]));
    assert!(found.steps.iter().all(|s| s.fronts[0].k_difference.unwrap() < 1e-9));
    // Not the same steps; with the same they agree.
    assert!(!found.agrees(&WITHIN) && SolidComparison::new(&a, &a).agrees(&WITHIN));
}

#[test]
fn what_only_one_has_is_told() {
    let a = results(vec![arc(1.0, 8, [0.0, TAU], |_| 1.0)]);
    let found = SolidComparison::new(&a, &results(vec![]));
    assert_eq!(found.unlike, ["a front of crack c only in A"]);
    assert!(!found.agrees(&WITHIN));
    let bare = SolidComparison::new(&results(vec![]), &results(vec![]));
    assert!(bare.agrees(&WITHIN));
    let mut loaded = results(vec![]);
    loaded.stress.largest_principal = Some(5.2);
    assert!(!SolidComparison::new(&results(vec![]), &loaded).agrees(&WITHIN));
}
