//! The field of a crack tip in a square.

use crate::boxes::{Box, Crack, HalfPlane};
use riss::approximation::{EnrichedFront, FrontEnds, FrontFrame, FrontLine};
use riss::exact::{CrackTipField, ExactField};
use riss::material::{Elasticity, PlaneState};
use riss::math::{Vector, Vector2, axis};
use riss::model::{RigidMotion, Solid, SurfaceConditions, VectorField};
use riss::system::{Collocation, CollocationSettings, CollocationSolver};
use std::sync::Arc;

fn material() -> Elasticity {
    Elasticity { young: 200e3, poisson: 0.3, plane: PlaneState::Strain }
}

#[test]
fn square() {
    for n in [20, 40] {
        for reach in [0.0, 0.2, 0.4] {
            let field = CrackTipField { tip: Vector2::zeros(), angle: 0.0, k1: 1.0, k2: 0.5, t_stress: 0.0 };
            let exact = move |x: Vector2, side: f64| {
                let x = if x.y == 0.0 { Vector2::new(x.x, side * 1e-14) } else { x };
                field.displacement(&material(), x)
            };
            let displacement = VectorField::Function(Arc::new(move |at: &riss::model::SurfacePoint<2>| exact(at.position, 1.0)));
            let solid = Solid {
                material: material(),
                parts: vec![SurfaceConditions::displacement(displacement); 4],
                faces: vec![VectorField::zero()],
                body_force: VectorField::zero(),
                rigid_motion: RigidMotion::Supported,
            };
            let frame = FrontFrame { position: Vector::zeros(), ahead: axis::<2>(0), normal: axis::<2>(1), curvature: 0.0 };
            let fronts = vec![EnrichedFront { line: FrontLine::new(vec![frame], FrontEnds::Open), reach }];
            let body = Box { crack: Crack::HalfPlane, ..Box::<2>::cube(n) };
            let settings = CollocationSettings { solver: CollocationSolver::Direct, ..Default::default() };
            let collocation = Collocation::new(solid, &body.cloud(), Arc::new(HalfPlane), fronts, settings);
            let found = collocation.solve(&collocation.assemble().unwrap()).unwrap();
            let error = collocation.cloud().positions.iter().zip(&found.displacements).zip(&collocation.cloud().sights).map(|((p, u), s)| (u - exact(*p, s.y)).norm()).fold(0.0, f64::max);
            let scale = exact(Vector2::new(-1.0, 1.0), 1.0).norm();
            eprintln!("n {n} reach {reach} error {:.2e} {:?}", error / scale, found.effort);
        }
    }
}
