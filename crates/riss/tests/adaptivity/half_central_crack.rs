//! x
use crate::bodies::*;
use crate::problems::*;
use riss::adaptivity::AccuracySettings;
use riss::analysis::{RefinementRecord, Settings, Silent, solve_refined, Refined};
use riss::crack::EndKind;
use riss::exact::CrackTipField;
use riss::fracture::*;
use riss::material::{Elasticity, PlaneState};
use riss::math::Vector2;
use riss::model::Model;
use std::sync::Arc;

const STEEL: Elasticity = Elasticity { young: 200e3, poisson: 0.3, plane: PlaneState::Stress };
const A: f64 = 50.0;
fn k0() -> f64 { (A * std::f64::consts::PI).sqrt() }

fn plate(k1: f64, k2: f64) -> Model {
    let field = CrackTipField { tip: Vector2::zeros(), angle: 0.0, k1: k1 * k0(), k2: k2 * k0(), t_stress: 0.0 };
    let mut model = pulled_by(Arc::new(field), rectangle((-A, -A), (A, A)), STEEL);
    model.cracks.push(crack(&[(-A, 0.0), (0.0, 0.0)], [EndKind::Mouth, EndKind::Tip]));
    model
}

fn adapt(model: &Model, percent: f64, refinements: usize, growth: f64) -> Refined {
    let settings = with_nodes(structured(21, 21));
    let accuracy = AccuracySettings { energy_percent: Some(percent), refinements, growth, nodes: 60_000, ..AccuracySettings::default() };
    solve_refined(model, &settings, &accuracy, &mut Silent).unwrap_or_else(|e| panic!("{e}"))
}

fn show(records: &[RefinementRecord]) {
    for r in records {
        let k = r.factors[0].map(|k| k / k0());
        eprintln!("{:7} est {:.4e} err {:.4e} K {k:?} kerr {:?}", r.n_nodes, r.error_estimate, r.energy_error.unwrap(), r.k_error);
    }
}

fn tables(model: &Model, refined: &Refined) {
    let field = SolutionField { discrete: &refined.discrete, solution: &refined.solution };
    let (id, _) = model.tips()[0];
    let view = TipView::new(model, id);
    let unit = k0() * k0() / STEEL.effective_young();
    for c in [0.5, 0.1, 0.01, 0.001] {
        for j_integral in [JIntegral::Contour, JIntegral::Domain] {
            let settings = FractureSettings { domain: TipDomainShape::Square, j_integral, ..FractureSettings::default() };
            let f = &configurational_forces(&view, &[c * A], &settings, &STEEL, None, &field).unwrap()[0];
            let t = &tip_integrals(&view, &[c * A], &settings, &STEEL, None, &field).unwrap()[0];
            let round = |v: f64| (v * 1e4).round() / 1e4;
            eprintln!("{c} {j_integral:?} around {:?} faces {:?} K {} {} J {}", [f.around.x, f.around.y].map(|v| round(v / unit)), [f.faces.x, f.faces.y].map(|v| round(v / unit)), round(t.k1 / k0()), round(t.k2 / k0()), round(t.j / unit));
        }
    }
}

#[test]
fn explore() {
    for (k1, k2) in [(1.0, 0.0), (1.0, 1.0)] {
        let model = plate(k1, k2);
        for percent in [1.0, 0.5] {
            eprintln!("== {k1} {k2} percent {percent}");
            let start = std::time::Instant::now();
            let refined = adapt(&model, percent, 12, 0.4);
            show(&refined.refinements);
            eprintln!("{:?}", start.elapsed());
            tables(&model, &refined);
        }
    }
    eprintln!("== K");
    for percent in [1.0, 0.1] {
        let accuracy = AccuracySettings { k_percent: Some(percent), ..AccuracySettings::default() };
        show(&solve_refined(&plate(1.0, 1.0), &Settings::default(), &accuracy, &mut Silent).unwrap().refinements);
    }
    eprintln!("== uniform");
    let uniform: Vec<_> = [21, 41, 81, 161].iter().map(|n| run(&plate(1.0, 0.0), &with_nodes(structured(*n, *n)))).map(|r| (r.n_nodes as f64, r.energy_error.unwrap())).collect();
    eprintln!("{uniform:?} {}", rate(&uniform));
}
