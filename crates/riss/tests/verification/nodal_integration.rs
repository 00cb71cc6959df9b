//! Patch tests of nodal integration: linear fields on irregular nodes, with arcs, cracks and body forces.

use crate::bodies::*;
use riss::analysis::Settings;
use riss::crack::EndKind::{Mouth, Tip};
use riss::exact::LinearField;
use riss::geometry::curve::Curve;
use riss::integration::Scheme;
use riss::material::PlaneState;
use riss::math::{Matrix2, Vector2};
use riss::model::{BoundaryLoad, CrackFaceLoad, Domain, Model, RigidMotion, TractionValue};
use std::sync::Arc;

/// Error of the energy of a uniform stress that tractions make on the outline, and what else the model has.
fn error(mut model: Model, stress: Matrix2, spacing: f64, stabilization: f64) -> f64 {
    model.rigid_motion = RigidMotion::MeanIsZero;
    model.loads.push(BoundaryLoad { part: None, value: TractionValue::UniformStress(stress) });
    let gradient = model.material.strain(&stress);
    model.exact = Some(Arc::new(LinearField { constant: Vector2::zeros(), gradient }));
    let mut settings = Settings { nodes: graded(spacing), ..Settings::default() };
    settings.integration.scheme = Scheme::Nodal { stabilization };
    run(&model, &settings).energy_error.expect("the field is known")
}

#[test]
fn uniform_stress_on_irregular_nodes_to_roundoff() {
    let stress = Matrix2::new(1.0, 0.4, 0.4, -0.7);
    for plane in [PlaneState::Strain, PlaneState::Stress] {
        for stabilization in [0.1, 0.5, 1.0] {
            let square = body(rectangle((-1.0, -1.0), (1.0, 1.0)), plane);
            let found = error(square, stress, 0.2, stabilization);
            assert!(found < 1e-9, "{found:.1e} with {stabilization}");
        }
    }
}

/// Tension along a crack does not see it.
#[test]
fn tension_along_cracks_to_roundoff() {
    let mut model = body(rectangle((-1.0, -1.0), (1.0, 1.0)), PlaneState::Strain);
    model.cracks.push(crack(&[(-1.0, 0.13), (-0.2, 0.13)], [Mouth, Tip]));
    model.cracks.push(crack(&[(0.1, -0.4), (0.7, -0.4)], [Tip; 2]));
    let found = error(model, Matrix2::new(1.0, 0.0, 0.0, 0.0), 0.2, 1.0);
    assert!(found < 1e-9, "{found:.1e}");
}

/// With pressure in the hole the stress is uniform. Arcs take Gauss points, five of them on each half of an edge: what is
/// left is their error.
#[test]
fn pressure_inside_and_outside_of_a_ring_with_a_crack() {
    let circle = |r: f64| vec![Curve::circle(Vector2::zeros(), r)];
    let mut domain = Domain::new(circle(2.0), vec![circle(0.7)]);
    let hole = domain.add_part("hole", vec![1]);
    let mut model = body(domain, PlaneState::Strain);
    model.loads.push(BoundaryLoad { part: Some(hole), value: TractionValue::Pressure(1.0.into()) });
    model.cracks.push(crack(&[(1.0, 0.2), (1.5, 0.5)], [Tip; 2]));
    model.crack_face_loads.push(CrackFaceLoad { crack: 0, pressure: 1.0.into() });
    let found = error(model, -Matrix2::identity(), 0.3, 1.0);
    assert!(found < 1e-9, "{found:.1e}");
}
