use super::*;
use crate::case::{AnyCase, SolidCase};
use std::f64::consts::PI;
use std::ops::ControlFlow;

/// Keeps every step.
#[derive(Default)]
struct Kept {
    steps: Vec<SolidStep>,
    states: Vec<SolidGrowthState>,
    last: usize,
}

impl Observer for Kept {
    fn solid_step(&mut self, step: &SolidStep, state: &SolidGrowthState) -> ControlFlow<()> {
        self.steps.push(step.clone());
        self.states.push(state.clone());
        if self.steps.len() == self.last { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

fn parse(text: &str) -> Box<SolidCase> {
    let AnyCase::Solid(case) = AnyCase::parse(text, "case.toml".as_ref(), &[]).map_err(|e| e.to_string()).unwrap()
    else {
        panic!()
    };
    case
}

fn grow(case: &SolidCase) -> (Kept, GrowthEnd) {
    let mut kept = Kept::default();
    let growth = case.growth.as_ref().unwrap();
    let end = solid_growth(&case.model, &case.settings, growth, None, &mut kept).unwrap().unwrap();
    (kept, end)
}

const PENNY: &str = "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = { young = 1000, poisson = 0.3 }\n\
    geometry.box = { lower = [-5, -5, -5], upper = [5, 5, 5] }\n\
    nodes = { spacing = 2, front_spacing = 0.11, growth = 0.25 }\nfracture.points = 6\n";

/// A circle stays one, with `K_I = 2 σ √(a/π)` at each radius [Sneddon1946].
#[test]
fn a_penny_in_tension_grows_as_a_circle() {
    let case = parse(&format!(
        "{PENNY}remote_stress.zz = 1\ncrack = [{{ disc = {{ center = [0, 0, 0], normal = [0, 0, 1], radius = 1 }} }}]\n\
         growth = {{ steps = 1, increment = 0.25, criterion.stress-intensity-factors = {{ exponent = 3 }} }}"
    ));
    let (kept, end) = grow(&case);
    assert_eq!((end.kind, kept.steps.len()), (GrowthEndKind::StepsDone, 2));
    for (n, (step, state)) in kept.steps.iter().zip(&kept.states).enumerate() {
        let radius = 1.0 + 0.25 * n as f64;
        for p in &state.cracks[0].fronts()[0].line.points {
            assert!((p.position.norm() / radius - 1.0).abs() < 0.01, "{n}: {}", p.position);
        }
        let exact = 2.0 * (radius / PI).sqrt();
        for p in &step.result.fronts[0].points {
            let [k1, k2, k3] = p.factors.unwrap().factors;
            assert!(
                (k1 / exact - 1.0).abs() < 0.02 && k2.abs() < 0.02 * exact && k3.abs() < 0.02 * exact,
                "{n} {k1} {k2} {k3} {exact}"
            );
        }
        assert!((step.areas[0] / (PI * radius * radius) - 1.0).abs() < 0.02);
    }
}

/// Going on from a state gives the same bits as going through.
#[test]
fn growth_goes_on_from_any_step() {
    let case = parse(
        "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = { young = 1000, poisson = 0.2 }\n\
         geometry.box = { lower = [0, 0, -2], upper = [4, 1, 2] }\nnodes = { spacing = 0.5, front_spacing = 0.25 }\n\
         fracture.points = 3\nremote_stress.zz = 1\ncrack = [{ polygon = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]] }]\n\
         growth = { steps = 2, increment = 0.4, criterion.largest-principal-stress = { tensile_strength = 0.5 } }",
    );
    let (through, _) = grow(&case);
    let mut first = Kept { last: 2, ..Kept::default() };
    let growth = case.growth.as_ref().unwrap();
    assert!(solid_growth(&case.model, &case.settings, growth, None, &mut first).unwrap().is_none());
    let text = serde_json::to_string(&through.states[1]).unwrap();
    let mut second = Kept::default();
    let state = serde_json::from_str(&text).unwrap();
    solid_growth(&case.model, &case.settings, growth, Some(state), &mut second).unwrap();
    assert_eq!(second.states, through.states[1..]);
    for (a, b) in second.steps.iter().zip(&through.steps[1..]) {
        assert_eq!((&a.result.displacements, &a.areas), (&b.result.displacements, &b.areas));
    }
    assert!(through.steps.windows(2).all(|w| w[1].areas[0] > w[0].areas[0] && w[1].areas == w[0].areas_after));
}

/// The mean stress ahead of a penny in tension is the same all around, and sends the front straight on.
#[test]
fn the_strength_is_reached_all_around_a_penny() {
    let case = parse(&format!(
        "{PENNY}remote_stress.zz = 1\ncrack = [{{ disc = {{ center = [0, 0, 0], normal = [0, 0, 1], radius = 1 }} }}]\n\
         growth = {{ steps = 1, increment = 0.25, criterion.largest-principal-stress = {{ tensile_strength = 1 }} }}"
    ));
    let solved = Solved::of(&case.model, &case.settings, &mut super::super::record::Silent).unwrap();
    let cracks = SolidGrowthState::first(&case.model).unwrap().cracks;
    let of = |strength: f64| drive::by_strength(&case.model, &solved, &cracks, 0.25, strength).unwrap();
    let most = of(1.0).largest.unwrap();
    // Of the front field alone, the mean of K_I/√(2πr) over the places straight ahead would be 1.8.
    assert!(most > 1.2 && most < 2.4, "{most}");
    let (all, none) = (of(0.95 * most), of(1.001 * most));
    assert_eq!((all.n_moving(), none.n_moving()), (cracks[0].fronts()[0].vertices.len(), 0));
    for (step, p) in all.steps[0][0].iter().zip(&cracks[0].fronts()[0].line.points) {
        assert_eq!((step.direction, step.length), (p.ahead, 0.25));
    }
}

/// Below the strength nothing moves.
#[test]
fn a_strong_solid_holds() {
    let case = parse(
        "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = { young = 1000, poisson = 0.2 }\n\
         geometry.box = { lower = [0, 0, -2], upper = [4, 1, 2] }\nnodes = { spacing = 0.5, front_spacing = 0.25 }\n\
         fracture.points = 3\nremote_stress.zz = 1\ncrack = [{ polygon = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]] }]\n\
         growth = { steps = 3, increment = 0.4, criterion.largest-principal-stress = { tensile_strength = 50 } }",
    );
    let (kept, end) = grow(&case);
    assert_eq!((end.kind, kept.steps.len(), kept.steps[0].n_moving), (GrowthEndKind::NoTipGrows, 1, 0));
    assert!(kept.steps[0].load_factor.unwrap() > 1.0);
}
