//! Integrals around a front where body force and tractions on the crack faces act, and the T-stress.
//!
//! A polynomial displacement solves elasticity with the body force and face tractions that belong to it, adds nothing to
//! the factors, and makes T what its stress along x is at the front. The basis holds it, so that nothing but round-off
//! and quadrature is left; together with the field of a crack, the errors are those of the latter.

use crate::boxes::{Box, Crack, HalfPlane, displacement_error};
use crate::patch::{Power, material};
use riss::approximation::{EnrichedFront, FrontEnds, FrontFrame, FrontLine};
use riss::exact::CrackFrontField;
use riss::fracture::{DiscCut, FrontIntegrals, front_integrals};
use riss::math::{Matrix, Vector, axis};
use riss::model::{RigidMotion, Solid, SurfaceConditions, SurfacePoint, VectorField};
use riss::system::{Collocation, CollocationSettings};
use std::sync::Arc;

fn frame(along: f64) -> FrontFrame<3> {
    FrontFrame {
        position: axis::<3>(1) * along,
        ahead: axis(0),
        normal: axis(2),
        curvature: 0.0,
        normal_curvature: 0.0,
    }
}

fn crack(factors: [f64; 3], t_stress: f64) -> CrackFrontField {
    CrackFrontField { origin: Vector::zeros(), ahead: axis(0), normal: axis(2), factors, t_stress }
}

/// The sum of both fields prescribed around a cube with `n` steps along its edges of length 2: discs at some points of
/// the front with the place of each along it.
fn solve(n: usize, crack: CrackFrontField, smooth: Power<3>) -> Vec<(f64, FrontIntegrals)> {
    let exact = move |at: &SurfacePoint<3>| {
        crack.evaluate(&material(), at.position, at.sight).0 + smooth.displacement(at.position)
    };
    let solid = Solid {
        material: material(),
        parts: vec![SurfaceConditions::displacement(VectorField::Function(Arc::new(exact))); 6],
        faces: vec![VectorField::Function(Arc::new(move |at| smooth.stress(at.position) * at.normal))],
        body_force: VectorField::of_position(move |x| smooth.body_force(x)),
        rigid_motion: RigidMotion::Supported,
    };
    let body = Box { crack: Crack::HalfPlane, ..Box::<3>::cube(n) };
    let front = EnrichedFront::new(FrontLine::new(vec![frame(-1.0), frame(1.0)], FrontEnds::Open), 2.0 / n as f64);
    let settings = CollocationSettings::default();
    let collocation = Collocation::new(solid, &body.cloud(), Arc::new(HalfPlane), vec![front], settings);
    let found = collocation.solve(&collocation.assemble().unwrap()).unwrap();
    assert!(displacement_error(&collocation, &found.displacements, exact) < 0.01);
    let at = |along: f64| {
        let discs =
            front_integrals(&collocation, &found.displacements, &DiscCut::plane(&frame(along)), 0, &[0.3, 0.5, 0.8])
                .unwrap();
        discs.into_iter().map(move |d| (along, d))
    };
    [-0.9, -0.3, 0.0, 0.4, 0.8].into_iter().flat_map(at).collect()
}

fn stress_ahead(smooth: Power<3>, along: f64) -> f64 {
    let stress: Matrix<3> = smooth.stress(axis::<3>(1) * along);
    stress[(0, 0)]
}

/// Uniform, linear and quadratic stress: the face and body force terms take out all that the polynomial puts in.
#[test]
fn smooth_fields_have_no_factors_and_their_own_t_stress() {
    for order in [1, 2, 3] {
        let smooth = Power::<3>::new(order);
        let scale = smooth.stress(Vector::repeat(0.5)).norm();
        for (along, disc) in solve(8, crack([0.0; 3], 0.0), smooth) {
            assert!(disc.factors.iter().all(|k| k.abs() < 1e-7 * scale), "order {order} at {along}: {disc:?}");
            assert!(disc.j.abs() < 1e-7 * scale * scale / material().young, "order {order} at {along}: {disc:?}");
            let error = disc.t_stress - stress_ahead(smooth, along);
            assert!(error.abs() < 1e-5 * scale, "order {order} at {along}: {error} in {disc:?}");
        }
    }
}

/// Factors, J and T of a crack are found beside body force and loaded faces as well as without.
#[test]
fn factors_beside_body_force_and_loaded_faces() {
    let (factors, t) = ([1.0, 0.5, -0.8], 0.6);
    let smooth = Power { amplitude: Vector::<3>::new(0.3, -0.2, 0.1), ..Power::new(2) };
    let j = (factors[0] * factors[0] + factors[1] * factors[1]) / material().effective_young()
        + factors[2] * factors[2] / (2.0 * material().shear());
    for (along, disc) in solve(12, crack(factors, t), smooth) {
        for m in 0..3 {
            assert!((disc.factors[m] - factors[m]).abs() < 0.01, "at {along}: {disc:?}");
        }
        assert!((disc.j / j - 1.0).abs() < 0.02, "J {j} at {along}: {disc:?}");
        let expected = t + stress_ahead(smooth, along);
        assert!((disc.t_stress - expected).abs() < 0.03, "T {expected} at {along}: {disc:?}");
    }
}
