//! The field of a crack tip in a square.

use crate::boxes::{Box, Crack, HalfPlane};
use riss::approximation::{EnrichedFront, FrontEnds, FrontFrame, FrontLine};
use riss::exact::{CrackFrontField, CrackTipField, ExactField};
use riss::fracture::{FrontFactors, front_integrals};
use riss::material::{Elasticity, PlaneState};
use riss::math::{Vector, Vector2, axis};
use riss::model::{RigidMotion, Solid, SurfaceConditions, SurfacePoint, VectorField};
use riss::system::{Collocation, CollocationSettings, CollocationSolver, FrontNodes};
use std::sync::Arc;
use std::time::Instant;

fn material() -> Elasticity {
    Elasticity { young: 200e3, poisson: 0.3, plane: PlaneState::Strain }
}

fn env(name: &str, default: f64) -> f64 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}

fn experiment_settings() -> CollocationSettings {
    let mut settings = CollocationSettings { solver: CollocationSolver::Automatic, ..Default::default() };
    settings.approximation.order = env("ORDER", 3.0) as usize;
    let k = env("NEIGH", 0.0) as usize;
    settings.approximation.neighbors = (k > 0).then_some(k);
    settings.front_nodes = [FrontNodes::Omitted, FrontNodes::Averaged, FrontNodes::Equilibrium, FrontNodes::Fitted][env("FRONT", 0.0) as usize];
    settings
}

#[test]
fn square() {
    let n = env("N", 20.0) as usize;
    let reach = env("REACH", 0.4);
    let field = CrackTipField { tip: Vector2::zeros(), angle: 0.0, k1: 1.0, k2: 0.5, t_stress: 0.0 };
    let exact = move |x: Vector2, sight: Vector2| {
        let x = if x.y == 0.0 { Vector2::new(x.x, sight.y * 1e-9) } else { x };
        field.displacement(&material(), x)
    };
    let displacement = VectorField::Function(Arc::new(move |at: &SurfacePoint<2>| exact(at.position, at.sight)));
    let solid = Solid {
        material: material(),
        parts: vec![SurfaceConditions::displacement(displacement); 4],
        faces: vec![VectorField::zero()],
        body_force: VectorField::zero(),
        rigid_motion: RigidMotion::Supported,
    };
    let frame = FrontFrame { position: Vector::zeros(), ahead: axis::<2>(0), normal: axis::<2>(1), curvature: 0.0 };
    let fronts = vec![EnrichedFront { line: FrontLine::new(vec![frame], FrontEnds::Open), reach }];
    let body = Box { crack: Crack::HalfPlane, seed: env("SEED", 7.0) as u64, jitter: env("JITTER", 0.2), ..Box::<2>::cube(n) };
    let collocation = Collocation::new(solid, &body.cloud(), Arc::new(HalfPlane), fronts, experiment_settings());
    let start = Instant::now();
    let system = collocation.assemble().unwrap();
    let assembled = start.elapsed();
    let found = collocation.solve(&system).unwrap();
    let solved = start.elapsed();
    let error = collocation.cloud().positions.iter().zip(&found.displacements).zip(&collocation.cloud().sights).map(|((p, u), s)| (u - exact(*p, *s)).norm()).fold(0.0, f64::max);
    let scale = exact(Vector2::new(-1.0, 1.0), Vector2::new(-1.0, 1.0)).norm();
    eprintln!("n {n} reach {reach} error {:.2e} {:?} {assembled:?} {solved:?}", error / scale, found.effort);
    if env("DEBUG", 0.0) > 0.0 {
        let cloud = collocation.cloud();
        let u: Vec<f64> = (0..cloud.len()).flat_map(|i| { let v = exact(cloud.positions[i], cloud.sights[i]); [v.x, v.y] }).collect();
        let mut r = vec![0.0; u.len()];
        system.residual_into(&u, &mut r);
        let mut order: Vec<usize> = (0..cloud.len()).collect();
        let size = |i: usize| r[2 * i].hypot(r[2 * i + 1]);
        order.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
        for &i in order.iter().take(12) {
            let mut shape = riss::approximation::ShapeFunctions::default();
            let radius = collocation.approximation.at_node(i as u32, cloud.sights[i], &mut Default::default(), &mut shape).unwrap();
            let big = shape.second_derivatives.iter().map(|s| s.norm()).fold(0.0, f64::max);
            eprintln!("   {} {:.3e} at {:?} r {:.3} radius {radius} n {} big {big:.2e} {:?}", i, size(i) / scale, cloud.positions[i], cloud.positions[i].norm(), shape.neighbors.len(), matches!(cloud.places[i], riss::nodes::cloud::Place::Inside));
        }
        let mut near: Vec<usize> = (0..cloud.len()).collect();
        near.sort_by(|a, b| cloud.positions[*a].norm().total_cmp(&cloud.positions[*b].norm()));
        for &i in near.iter().take(12) {
            eprintln!("   near {:?} error {:.2e} residual {:.2e}", cloud.positions[i], (found.displacements[i] - exact(cloud.positions[i], cloud.sights[i])).norm() / scale, size(i) / scale);
        }
    }
    let discs = front_integrals(&collocation, &found.displacements, &frame, 0, &[0.2, 0.3, 0.4, 0.6, 0.8]).unwrap();
    for d in discs {
        eprintln!("  R {} K1 {:+.3}% K2 {:+.3}% J {:+.3}%", d.radius, 100.0 * (d.factors[0] - 1.0), 100.0 * (d.factors[1] / 0.5 - 1.0), 100.0 * (d.j / 1.25 * material().effective_young() - 1.0));
    }
}

#[test]
fn cuboid() {
    let n = env("N3", 14.0) as usize;
    let reach = env("REACH3", 4.0);
    let (a, b) = (10.0, 4.0);
    let z = Vector::<3>::z();
    let field = CrackFrontField { origin: Vector::<3>::zeros(), ahead: Vector::<3>::x(), normal: z, factors: [1.0, env("K2", 0.0), 0.0] };
    let exact = move |at: &SurfacePoint<3>| field.evaluate(&material(), at.position, at.sight).0;
    let displacement = VectorField::Function(Arc::new(exact));
    let held = SurfaceConditions::displacement(displacement);
    let mut parts = vec![held; 6];
    parts[2] = SurfaceConditions::symmetry();
    parts[3] = SurfaceConditions::symmetry();
    let solid = Solid { material: material(), parts, faces: vec![VectorField::zero()], body_force: VectorField::zero(), rigid_motion: RigidMotion::Supported };
    let frame = |y: f64| FrontFrame { position: Vector::<3>::new(0.0, y, 0.0), ahead: Vector::<3>::x(), normal: z, curvature: 0.0 };
    let line = FrontLine::new(vec![frame(0.0), frame(b)], FrontEnds::Open);
    let ny = ((b / (2.0 * a / n as f64)).round() as usize).max(3);
    let body = Box { lower: Vector::<3>::new(-a, 0.0, -a), upper: Vector::<3>::new(a, b, a), steps: [n, ny, n], seed: env("SEED", 7.0) as u64, jitter: env("JITTER", 0.2), crack: Crack::HalfPlane };
    let start = Instant::now();
    let collocation = Collocation::new(solid, &body.cloud(), Arc::new(HalfPlane), vec![EnrichedFront { line, reach }], experiment_settings());
    let system = collocation.assemble().unwrap();
    eprintln!("n {n} {ny} nodes {} reach {reach} assembled {:?}", collocation.cloud().len(), start.elapsed());
    let found = collocation.solve(&system).unwrap();
    let cloud = collocation.cloud();
    let error = (0..cloud.len()).map(|i| (found.displacements[i] - exact(&SurfacePoint { position: cloud.positions[i], normal: z, sight: cloud.sights[i] })).norm()).fold(0.0, f64::max);
    let scale = exact(&SurfacePoint::inside(Vector::<3>::new(-a, 0.0, a))).norm();
    eprintln!("  error {:.2e} {:?} {:?}", error / scale, found.effort, start.elapsed());
    for y in [0.0, 0.5, 1.0, 2.0, 3.0, 4.0] {
        let discs = front_integrals(&collocation, &found.displacements, &frame(y), 0, &[2.0, 3.0, 4.0, 6.0, 8.0]).unwrap();
        let text: Vec<String> = discs.iter().map(|d| format!("{:+.3}/{:+.3}/{:+.3}", 100.0 * (d.factors[0] - 1.0), 100.0 * d.factors[1], 100.0 * d.factors[2])).collect();
        eprintln!("  y {y}: {} | {:?}", text.join("  "), FrontFactors::of(&discs).uncertainty);
    }
    eprintln!("  {:?}", start.elapsed());
}
