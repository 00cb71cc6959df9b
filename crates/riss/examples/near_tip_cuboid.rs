//! The near-tip cuboid of [C3D, section 3.1] at any size: factors along the front, time by stage and memory.
//!
//! `cargo run --release -p riss --example near_tip_cuboid -- STEPS [ORDER [NEIGHBORS [REACH [POISSON [SEED]]]]]` with the
//! number of steps along the long sides, 40, 76 and 112 for the nodes of the paper's table, and the reach of the
//! functions of the front over the spacing, 0 for none. The last lines hold the stress ahead of the front [C3D, Fig. 10].

#[path = "../tests/solid/boxes.rs"]
#[allow(dead_code)]
mod boxes;

use boxes::{Box, Crack, HalfPlane, displacement_error, stress};
use riss::approximation::{EnrichedFront, FrontEnds, FrontFrame, FrontLine};
use riss::exact::CrackFrontField;
use riss::fracture::{DiscCut, front_integrals};
use riss::material::{Elasticity, PlaneState};
use riss::math::{Vector, axis};
use riss::model::{RigidMotion, Solid, SurfaceConditions, SurfacePoint, VectorField};
use riss::system::{Collocation, CollocationSettings, CollocationSolver};
use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

fn main() -> Result<(), Failure> {
    let arguments: Vec<f64> = std::env::args().skip(1).map(|a| a.parse()).collect::<Result<_, _>>()?;
    let argument = |k: usize, default: f64| arguments.get(k).copied().unwrap_or(default);
    let (a, b, n) = (10.0, 4.0, argument(0, 40.0));
    let material = Elasticity { young: 200e3, poisson: argument(4, 0.3), plane: PlaneState::Strain };
    let (ahead, normal) = (axis::<3>(0), axis::<3>(2));
    let field = CrackFrontField { origin: Vector::zeros(), ahead, normal, factors: [1.0, 0.0, 0.0], t_stress: 0.0 };
    let exact = move |at: &SurfacePoint<3>| field.evaluate(&material, at.position, at.sight).0;
    let mut parts = vec![SurfaceConditions::displacement(VectorField::Function(Arc::new(exact))); 6];
    parts[2] = SurfaceConditions::symmetry();
    parts[3] = SurfaceConditions::symmetry();
    let solid = Solid {
        material,
        parts,
        faces: vec![VectorField::zero()],
        body_force: VectorField::zero(),
        rigid_motion: RigidMotion::Supported,
    };
    let body = Box {
        lower: Vector::<3>::new(-a, 0.0, -a),
        upper: Vector::<3>::new(a, b, a),
        steps: [n as usize, (b * n / (2.0 * a)).round() as usize, n as usize],
        crack: Crack::HalfPlane,
        seed: argument(5, 7.0) as u64,
        ..Box::cube(1)
    };
    let frame =
        |y: f64| FrontFrame { position: axis::<3>(1) * y, ahead, normal, curvature: 0.0, normal_curvature: 0.0 };
    let line = FrontLine::new(vec![frame(0.0), frame(b)], FrontEnds::Open);
    let reach = argument(3, -1.0);
    let mut front = EnrichedFront::new(line, body.spacing().max());
    if reach >= 0.0 {
        front.reach = reach * body.spacing().max();
    }
    let mut settings = CollocationSettings { solver: CollocationSolver::Iterative, ..Default::default() };
    settings.approximation.order = argument(1, 3.0) as usize;
    settings.approximation.neighbors = arguments.get(2).filter(|k| **k > 0.0).map(|k| *k as usize);
    let start = Instant::now();
    let collocation = Collocation::new(solid, &body.cloud(), Arc::new(HalfPlane), vec![front], settings);
    println!("{} nodes in {:.2} s", collocation.cloud().len(), start.elapsed().as_secs_f64());
    let (start, before) = (Instant::now(), processor());
    let system = collocation.assemble()?;
    let stage = |name: &str, start: Instant, before: f64| {
        let (clock, spent) = (start.elapsed().as_secs_f64(), processor() - before);
        println!("{name} in {clock:.2} s, {spent:.2} s of processors, peak {:.2} GB", peak());
    };
    stage("assembled", start, before);
    let (start, before) = (Instant::now(), processor());
    let found = collocation.solve(&system)?;
    stage("solved", start, before);
    println!("{:?}", found.effort);
    println!("largest error of the displacement {:.2e}", displacement_error(&collocation, &found.displacements, exact));
    let (start, before) = (Instant::now(), processor());
    for k in 0..=8 {
        let y = b * f64::from(k) / 8.0;
        let discs =
            front_integrals(&collocation, &found.displacements, &DiscCut::plane(&frame(y)), 0, &[2.0, 3.0, 4.0, 6.0])?;
        let errors: Vec<String> = discs.iter().map(|d| format!("{:+.4} %", 100.0 * (d.factors[0] - 1.0))).collect();
        println!("K_I at y = {y:.1}: {}", errors.join(" "));
    }
    stage("factors", start, before);
    println!("x, σ_zz, exact at y = z = 0");
    for k in 0..=40 {
        let x = 0.01 * 1000f64.powf(f64::from(k) / 40.0);
        let found = stress(&collocation, &found.displacements, ahead * x)[(2, 2)];
        println!("{x:.5}, {found:.6}, {:.6}", 1.0 / (std::f64::consts::TAU * x).sqrt());
    }
    Ok(())
}

type Failure = std::boxed::Box<dyn Error>;

/// Processor time of all threads so far in seconds, where the system tells; on a busy machine it says more than the clock.
fn processor() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let ticks: Vec<f64> = stat.split_whitespace().skip(13).take(2).filter_map(|t| t.parse().ok()).collect();
    ticks.iter().sum::<f64>() / 100.0
}

/// Largest memory so far in gigabytes, where the system tells.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmHWM"));
    line.and_then(|l| l.split_whitespace().nth(1)?.parse::<f64>().ok()).unwrap_or(0.0) / 1e6
}
