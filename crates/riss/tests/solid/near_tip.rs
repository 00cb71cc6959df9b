//! The field of a crack tip in a square and of a crack front in a cuboid [C3D, section 3.1].
//!
//! The exact displacement is prescribed on the outside, the faces are free: the factors must come back.

use crate::boxes::{Box, Crack, HalfPlane, displacement_error, stress};
use riss::approximation::{EnrichedFront, FrontEnds, FrontFrame, FrontLine};
use riss::exact::{CrackFrontField, CrackTipField, ExactField};
use riss::fracture::{DiscCut, front_integrals};
use riss::material::{Elasticity, PlaneState};
use riss::math::{Vector, Vector2, axis};
use riss::model::{RigidMotion, Solid, SurfaceConditions, SurfacePoint, VectorField};
use riss::system::{Collocation, CollocationSettings};
use std::f64::consts::PI;
use std::sync::Arc;

fn material() -> Elasticity {
    Elasticity { young: 200e3, poisson: 0.3, plane: PlaneState::Strain }
}

fn solid<const D: usize>(displacement: VectorField<D>) -> Solid<D> {
    Solid {
        material: material(),
        parts: vec![SurfaceConditions::displacement(displacement); 2 * D],
        faces: vec![VectorField::zero()],
        body_force: VectorField::zero(),
        rigid_motion: RigidMotion::Supported,
    }
}

fn frame<const D: usize>(along: f64) -> FrontFrame<D> {
    let mut position = Vector::zeros();
    if D == 3 {
        position[1] = along;
    }
    FrontFrame { position, ahead: axis(0), normal: axis(D - 1), curvature: 0.0, normal_curvature: 0.0 }
}

/// Both modes in the square of half side 1 with `n` steps; errors are relative to the larger factor.
fn check_square(n: usize, seed: u64, allowed: f64) {
    let field = CrackTipField { tip: Vector2::zeros(), angle: 0.0, k1: 1.0, k2: 0.5, t_stress: 0.0 };
    let exact = move |at: &SurfacePoint<2>| {
        // The field is cut along the face.
        let height = if at.position.y == 0.0 { at.sight.y * 1e-9 } else { at.position.y };
        field.displacement(&material(), Vector2::new(at.position.x, height))
    };
    let line = FrontLine::new(vec![frame::<2>(0.0)], FrontEnds::Open);
    let body = Box { crack: Crack::HalfPlane, seed, ..Box::<2>::cube(n) };
    let front = EnrichedFront::new(line, body.spacing().max());
    let solid = solid(VectorField::Function(Arc::new(exact)));
    let collocation =
        Collocation::new(solid, &body.cloud(), Arc::new(HalfPlane), vec![front], CollocationSettings::default());
    let found = collocation.solve(&collocation.assemble().unwrap()).unwrap();
    let discs =
        front_integrals(&collocation, &found.displacements, &DiscCut::plane(&frame(0.0)), 0, &[0.3, 0.4, 0.6, 0.8])
            .unwrap();
    let j = 1.25 / material().effective_young();
    for disc in discs {
        let errors = [disc.factors[0] - 1.0, disc.factors[1] - 0.5, 0.5 * (disc.j / j - 1.0)];
        assert!(errors.iter().all(|e| e.abs() < allowed), "{n} steps: {errors:?} {disc:?}");
    }
}

/// 0.2 % with ten nodes to the half side and 0.04 % with twenty are asked for; mixed mode may have 0.1 %.
#[test]
fn square_with_enriched_basis() {
    for seed in [7, 8, 9] {
        check_square(20, seed, 0.002);
        check_square(40, seed, 0.001);
    }
}

/// The box of the paper: a = 10, b = 4; `n` steps along the sides of length 20.
fn cuboid(n: usize) -> Box<3> {
    let (a, b) = (10.0, 4.0);
    let steps = (b * n as f64 / (2.0 * a)).round() as usize;
    Box {
        lower: Vector::<3>::new(-a, 0.0, -a),
        upper: Vector::<3>::new(a, b, a),
        steps: [n, steps, n],
        crack: Crack::HalfPlane,
        ..Box::cube(1)
    }
}

fn check_cuboid(n: usize, factors: [f64; 3], t_stress: f64, allowed: f64) {
    let (ahead, normal) = (axis(0), axis(2));
    let field = CrackFrontField { origin: Vector::zeros(), ahead, normal, factors, t_stress };
    let exact = move |at: &SurfacePoint<3>| field.evaluate(&material(), at.position, at.sight).0;
    let mut solid = solid(VectorField::Function(Arc::new(exact)));
    if factors[2] == 0.0 {
        solid.parts[2] = SurfaceConditions::symmetry();
        solid.parts[3] = SurfaceConditions::symmetry();
    }
    let body = cuboid(n);
    let line = FrontLine::new(vec![frame::<3>(0.0), frame(4.0)], FrontEnds::Open);
    let front = EnrichedFront::new(line, body.spacing().max());
    let collocation =
        Collocation::new(solid, &body.cloud(), Arc::new(HalfPlane), vec![front], CollocationSettings::default());
    let found = collocation.solve(&collocation.assemble().unwrap()).unwrap();
    assert!(displacement_error(&collocation, &found.displacements, exact) < 3.0 * allowed);
    for along in [0.0, 0.3, 1.0, 2.0, 3.3, 4.0] {
        let discs =
            front_integrals(&collocation, &found.displacements, &DiscCut::plane(&frame(along)), 0, &[3.0, 4.0, 6.0])
                .unwrap();
        for disc in discs {
            let errors: [f64; 3] = std::array::from_fn(|m| disc.factors[m] - factors[m]);
            assert!(errors.iter().all(|e| e.abs() < allowed), "at {along}: {errors:?}");
            // K/√r at the largest disc is the measure of stress.
            let error = disc.t_stress - t_stress;
            assert!(error.abs() < 5.0 * allowed, "T at {along} from {}: {error}", disc.radius);
        }
    }
    // The stress across the plane of the crack, from an eightieth of the spacing to near the boundary [C3D, Fig. 10].
    for y in [0.0, 1.7] {
        for x in [0.006, 0.03, 0.1, 0.3, 0.8, 1.5, 3.0, 5.0, 8.0] {
            let found = stress(&collocation, &found.displacements, Vector::<3>::new(x, y, 0.0))[(2, 2)];
            let expected = factors[0] / (2.0 * PI * x).sqrt();
            assert!((found / expected - 1.0).abs() < 10.0 * allowed, "at {x}, {y}: {found} {expected}");
        }
    }
}

/// 15,309 nodes; the paper has 0.94 % with its basis and 15,160.
#[test]
fn tanaka_cuboid_has_its_factor_along_the_whole_front() {
    check_cuboid(40, [1.0, 0.0, 0.0], 0.0, 0.001);
}

/// 48,000 nodes that are as close far from the front as at it: all within reach of its functions, up to forty spacings.
#[test]
fn many_nodes_in_reach_of_a_front_do_not_stop_the_solver() {
    let field = CrackFrontField {
        origin: Vector::zeros(),
        ahead: axis(0),
        normal: axis(2),
        factors: [1.0, 0.0, 0.0],
        t_stress: 0.0,
    };
    let exact = move |at: &SurfacePoint<3>| field.evaluate(&material(), at.position, at.sight).0;
    let mut solid = solid(VectorField::Function(Arc::new(exact)));
    solid.parts[2] = SurfaceConditions::symmetry();
    solid.parts[3] = SurfaceConditions::symmetry();
    let body = cuboid(60);
    let line = FrontLine::new(vec![frame::<3>(0.0), frame(4.0)], FrontEnds::Open);
    let mut front = EnrichedFront::new(line, body.spacing().max());
    front.reach = 40.0 * body.spacing().max();
    let collocation =
        Collocation::new(solid, &body.cloud(), Arc::new(HalfPlane), vec![front], CollocationSettings::default());
    let found = collocation.solve(&collocation.assemble().unwrap()).unwrap();
    assert!(found.effort.iterations < 60, "{:?}", found.effort);
    let error = displacement_error(&collocation, &found.displacements, exact);
    assert!(error < 1e-4, "{error}");
}

#[test]
fn cuboid_in_all_modes() {
    check_cuboid(20, [1.0, 0.5, -0.8], 0.4, 0.01);
}
