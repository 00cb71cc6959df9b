//! A spherical cavity under tension [Timoshenko1970, section 137]: an eighth of a thick shell of nodes.

use crate::boxes::{Clear, Random};
use riss::material::{Elasticity, PlaneState};
use riss::math::{Matrix, Vector, axis};
use riss::model::{RigidMotion, Solid, SurfaceConditions, VectorField};
use riss::nodes::cloud::{Cloud, Facet, Place, SurfaceId};
use riss::system::{Collocation, CollocationSettings};
use std::sync::Arc;

/// Outer radius over that of the cavity; what is missing outside changes stresses by its cube, 0.2 %.
const OUTER: f64 = 8.0;

/// Parts 0 to 2 are the planes of symmetry, 3 is the cavity, 4 the outside.
fn cloud(n: usize) -> Cloud<3> {
    let mut cloud = Cloud::default();
    let mut random = Random::new(3);
    let step = std::f64::consts::FRAC_PI_2 / n as f64;
    let layers = (OUTER.ln() / step).round() as usize;
    for layer in 0..=layers {
        for i in 0..=n {
            for j in 0..=n - i {
                let corner = [i, j, n - i - j];
                let mut place = Vector::<3>::from_fn(|d, _| corner[d] as f64);
                let mut depth = layer as f64;
                for d in 0..3 {
                    let shift = 0.2 * random.next();
                    // Nodes stay in the planes and on the spheres.
                    place[d] += if corner[d] == 0 { 0.0 } else { shift };
                }
                let shift = 0.2 * random.next();
                depth += if layer == 0 || layer == layers { 0.0 } else { shift };
                let ray = place.normalize();
                let radius = OUTER.powf(depth / layers as f64);
                let mut facets: Vec<(u32, Vector<3>)> =
                    (0..3).filter(|d| corner[*d] == 0).map(|d| (d as u32, -axis::<3>(d))).collect();
                if layer == 0 {
                    facets.push((3, -ray));
                } else if layer == layers {
                    facets.push((4, ray));
                }
                let spacing = radius * step;
                let position = ray * radius;
                let sum = facets.iter().fold(Vector::<3>::zeros(), |s, f| s + f.1);
                let sight = position - sum * (1e-4 * spacing);
                let facet =
                    |f: &(u32, Vector<3>)| Facet { surface: SurfaceId::Part(f.0), normal: f.1, sight, angle: 1.0 };
                let facets: Vec<Facet<3>> = facets.iter().map(facet).collect();
                let place = if facets.is_empty() { Place::Inside } else { Place::Surface(facets) };
                cloud.push(position, sight, spacing, place);
            }
        }
    }
    cloud
}

/// Largest stress over the tension, (27 - 15 ν) / (2 (7 - 5 ν)), at the equator; at the poles -(3 + 15 ν) / (2 (7 - 5 ν)).
#[test]
fn spherical_cavity_concentrates_stress_as_goodier_found() {
    let material = Elasticity { young: 2.0, poisson: 0.3, plane: PlaneState::Strain };
    let tension = Matrix::<3>::from_diagonal(&Vector::<3>::new(0.0, 0.0, 1.0));
    let mut parts = vec![SurfaceConditions::symmetry(); 3];
    parts.push(SurfaceConditions::free());
    parts.push(SurfaceConditions::traction(VectorField::Function(Arc::new(move |at| tension * at.normal))));
    let solid =
        Solid { material, parts, faces: vec![], body_force: VectorField::zero(), rigid_motion: RigidMotion::Supported };
    let mut settings = CollocationSettings::default();
    settings.approximation.order = 4;
    let collocation = Collocation::new(solid, &cloud(24), Arc::new(Clear), vec![], settings);
    let found = collocation.solve(&collocation.assemble().unwrap()).unwrap();
    let gradients = collocation.gradients(&found.displacements).unwrap();
    let stress = |at: Vector<3>| {
        let positions = &collocation.cloud().positions;
        let i = (0..positions.len()).find(|i| (positions[*i] - at).norm() < 1e-9).expect("a node is there");
        let g = gradients[i];
        (g + g.transpose()) * material.shear() + Matrix::from_diagonal_element(material.lame() * g.trace())
    };
    let nu = material.poisson;
    let equator = (27.0 - 15.0 * nu) / (2.0 * (7.0 - 5.0 * nu));
    let pole = -(3.0 + 15.0 * nu) / (2.0 * (7.0 - 5.0 * nu));
    let at_equator = [axis::<3>(0), axis::<3>(1)].map(|at| stress(at)[(2, 2)]);
    let at_pole = [0, 1].map(|d| stress(axis::<3>(2))[(d, d)]);
    assert!(at_equator.iter().all(|s| (s / equator - 1.0).abs() < 0.02), "{at_equator:?} {equator}");
    assert!(at_pole.iter().all(|s| (s - pole).abs() < 0.02 * equator), "{at_pole:?} {pole}");
}
