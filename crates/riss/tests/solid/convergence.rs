//! Rates of convergence on a smooth solution with mixed conditions.

use crate::boxes::{Box, Clear, displacement_error};
use riss::material::{Elasticity, PlaneState};
use riss::math::{Matrix, Vector};
use riss::model::{DirectedDisplacement, RigidMotion, Solid, SolidDirection, SurfaceConditions, SurfacePoint, VectorField};
use riss::system::{Collocation, CollocationSettings};
use std::sync::Arc;

fn material() -> Elasticity {
    Elasticity { young: 3.0, poisson: 0.3, plane: PlaneState::Strain }
}

/// Sum of `a sin(d·x + c)`.
const WAVES: [([f64; 3], [f64; 3], f64); 2] =
    [([1.0, -0.7, 0.4], [0.7, 0.6, -0.9], 0.3), ([-0.3, 0.5, 0.8], [-0.4, 1.0, 0.7], 1.1)];

fn waves<const D: usize>() -> [(Vector<D>, Vector<D>, f64); 2] {
    let of = |v: [f64; 3]| Vector::<D>::from_fn(|d, _| v[d]);
    WAVES.map(|(a, d, c)| (of(a), of(d), c))
}

fn displacement<const D: usize>(x: Vector<D>) -> Vector<D> {
    waves::<D>().iter().map(|(a, d, c)| a * (d.dot(&x) + c).sin()).sum()
}

fn stress<const D: usize>(x: Vector<D>) -> Matrix<D> {
    let gradient: Matrix<D> = waves::<D>().iter().map(|(a, d, c)| a * d.transpose() * (d.dot(&x) + c).cos()).sum();
    let material = material();
    (gradient + gradient.transpose()) * material.shear()
        + Matrix::from_diagonal_element(material.lame() * gradient.trace())
}

/// `-div σ` with `∂²u = -a d d sin`.
fn body_force<const D: usize>(x: Vector<D>) -> Vector<D> {
    let (lambda, mu) = (material().lame(), material().shear());
    let of = |a: &Vector<D>, d: &Vector<D>| d * ((lambda + mu) * a.dot(d)) + a * (mu * d.norm_squared());
    waves::<D>().iter().map(|(a, d, c)| of(a, d) * (d.dot(&x) + c).sin()).sum()
}

fn error<const D: usize>(n: usize, order: usize) -> f64 {
    let traction = VectorField::Function(Arc::new(|at: &SurfacePoint<D>| stress(at.position) * at.normal));
    let mut parts = vec![SurfaceConditions::traction(traction.clone()); 2 * D];
    let held = VectorField::of_position(displacement);
    parts[0] = SurfaceConditions::displacement(held.clone());
    let normal = DirectedDisplacement { direction: SolidDirection::Normal, value: held };
    parts[2] = SurfaceConditions { displacements: vec![normal], traction };
    let solid = Solid {
        material: material(),
        parts,
        faces: vec![],
        body_force: VectorField::of_position(body_force),
        rigid_motion: RigidMotion::Supported,
    };
    let mut settings = CollocationSettings::default();
    settings.approximation.order = order;
    if let Ok(k) = std::env::var("NEIGH") { settings.approximation.neighbors = Some(k.parse().unwrap()); }
    let collocation = Collocation::new(solid, &Box::cube(n).cloud(), Arc::new(Clear), vec![], settings);
    let found = collocation.solve(&collocation.assemble().unwrap()).unwrap();
    displacement_error(&collocation, &found.displacements, |at| displacement(at.position))
}

/// Second derivatives of a fit of order m are right up to h^(m-1), and displacements follow; even orders gain one by
/// symmetry on regular nodes and most of it on irregular ones.
fn check_rate<const D: usize>(order: usize, [coarse, fine]: [usize; 2]) {
    let errors = [coarse, fine].map(|n| error::<D>(n, order));
    let rate = (errors[0] / errors[1]).ln() / (fine as f64 / coarse as f64).ln();
    eprintln!("D {D} order {order}: {errors:?} rate {rate:.2}");
    assert!(rate > order as f64 - 1.1, "order {order} in {D} dimensions: {errors:?} give the rate {rate:.2}");
}

#[test]
fn rates_in_the_plane() {
    for order in 2..=4 {
        check_rate::<2>(order, [16, 48]);
    }
}

#[test]
fn rates_in_space() {
    for order in 2..=4 {
        check_rate::<3>(order, [8, 16]);
    }
}

#[test]
fn experiment() {
    let var = |n: &str, d: usize| std::env::var(n).ok().map_or(d, |v| v.parse().unwrap());
    let (o, a, b) = (var("ORDER", 2), var("A", 8), var("B", 8));
    if var("DIM", 2) == 2 {
        let e = [error::<2>(a, o), error::<2>(b, o)];
        eprintln!("D 2 order {o} {e:?} rate {:.2}", (e[0] / e[1]).ln() / (b as f64 / a as f64).ln());
    } else {
        let e = [error::<3>(a, o), error::<3>(b, o)];
        eprintln!("D 3 order {o} {e:?} rate {:.2}", (e[0] / e[1]).ln() / (b as f64 / a as f64).ln());
    }
}
