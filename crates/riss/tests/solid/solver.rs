//! The iterative solver against the direct one.

use crate::boxes::{Box, Crack, HalfPlane};
use riss::error::Error;
use riss::material::{Elasticity, PlaneState};
use riss::math::{Vector, axis};
use riss::model::{RigidMotion, Solid, SurfaceConditions, VectorField};
use riss::system::{Collocation, CollocationSettings, CollocationSolver};
use std::sync::Arc;

/// A cube with a crack that tension opens, held at one end.
fn cracked(poisson: f64, solver: CollocationSolver, motion: RigidMotion) -> Collocation<3> {
    let mut parts = vec![SurfaceConditions::free(); 6];
    let pull = |d: usize, sign: f64| SurfaceConditions::traction(VectorField::Constant(axis::<3>(d) * sign));
    parts[4] = match motion {
        RigidMotion::Supported => SurfaceConditions::displacement(VectorField::zero()),
        RigidMotion::MeanIsZero => pull(2, -1.0),
    };
    parts[5] = pull(2, 1.0);
    let solid = Solid {
        material: Elasticity { young: 1.0, poisson, plane: PlaneState::Strain },
        parts,
        faces: vec![VectorField::zero()],
        body_force: VectorField::zero(),
        rigid_motion: motion,
    };
    let body = Box { crack: Crack::HalfPlane, ..Box::<3>::cube(10) };
    let settings = CollocationSettings { solver, ..Default::default() };
    Collocation::new(solid, &body.cloud(), Arc::new(HalfPlane), vec![], settings)
}

fn solve(collocation: &Collocation<3>) -> Vec<Vector<3>> {
    let found = collocation.solve(&collocation.assemble().unwrap()).unwrap();
    found.displacements
}

fn check_same(poisson: f64, motion: RigidMotion) {
    let [direct, iterative] = [CollocationSolver::Direct, CollocationSolver::Iterative]
        .map(|solver| solve(&cracked(poisson, solver, motion)));
    let largest = direct.iter().map(|u| u.norm()).fold(0.0, f64::max);
    let error = direct.iter().zip(&iterative).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(error < 1e-6 * largest, "{poisson} {motion:?}: {error:e} of {largest}");
}

#[test]
fn iterations_come_to_the_direct_solution() {
    for poisson in [0.0, 0.3, 0.45] {
        check_same(poisson, RigidMotion::Supported);
    }
    check_same(0.3, RigidMotion::MeanIsZero);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let collocation = cracked(0.3, CollocationSolver::Iterative, RigidMotion::Supported);
    let [one, three] = [1, 3].map(|n| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
        pool.install(|| solve(&collocation))
    });
    assert_eq!(one, three);
}

#[test]
fn a_body_that_nothing_holds_is_refused() {
    let mut collocation = cracked(0.3, CollocationSolver::Iterative, RigidMotion::MeanIsZero);
    collocation.solid.rigid_motion = RigidMotion::Supported;
    let found = collocation.solve(&collocation.assemble().unwrap());
    assert!(matches!(found, Err(Error::FreeRigidMotion { .. })), "{:?}", found.map(|f| f.effort));
}

#[test]
fn a_nearly_incompressible_body_is_refused() {
    for solver in [CollocationSolver::Iterative, CollocationSolver::Direct] {
        let error = cracked(0.46, solver, RigidMotion::Supported).assemble().unwrap_err();
        assert!(matches!(error, Error::NearlyIncompressible { .. }), "{error}");
        assert!(error.to_string().contains("0.46 is above 0.45"), "{error}");
    }
}
