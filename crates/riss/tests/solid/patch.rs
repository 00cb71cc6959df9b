//! Polynomial displacements are found exactly on irregular nodes.

use crate::boxes::{Box, Clear, Crack, HalfPlane, displacement_error};
use riss::material::{Elasticity, PlaneState};
use riss::math::{Matrix, Vector, axis};
use riss::model::{DirectedDisplacement, RigidMotion, Solid, SolidDirection, SurfaceConditions, VectorField};
use riss::system::{Collocation, CollocationSettings, CollocationSolver};
use std::sync::Arc;

pub fn material() -> Elasticity {
    Elasticity { young: 3.0, poisson: 0.3, plane: PlaneState::Strain }
}

/// `u = a (d·x + c)^m` with its gradient and the body force that keeps it in equilibrium.
#[derive(Clone, Copy)]
pub struct Power<const D: usize> {
    pub amplitude: Vector<D>,
    pub direction: Vector<D>,
    pub order: i32,
}

impl<const D: usize> Power<D> {
    pub fn new(order: i32) -> Self {
        let of = |v: [f64; 3]| Vector::<D>::from_fn(|d, _| v[d]);
        Self { amplitude: of([1.0, -0.7, 0.4]), direction: of([0.6, 0.5, -0.8]), order }
    }

    fn along(&self, x: Vector<D>) -> f64 {
        self.direction.dot(&x) + 0.3
    }

    pub fn displacement(&self, x: Vector<D>) -> Vector<D> {
        self.amplitude * self.along(x).powi(self.order)
    }

    pub fn stress(&self, x: Vector<D>) -> Matrix<D> {
        let slope = f64::from(self.order) * self.along(x).powi(self.order - 1);
        let gradient = self.amplitude * self.direction.transpose() * slope;
        let material = material();
        (gradient + gradient.transpose()) * material.shear()
            + Matrix::from_diagonal_element(material.lame() * gradient.trace())
    }

    pub fn body_force(&self, x: Vector<D>) -> Vector<D> {
        if self.order < 2 {
            return Vector::zeros();
        }
        let m = f64::from(self.order);
        let bend = m * (m - 1.0) * self.along(x).powi(self.order - 2);
        let (a, d, material) = (self.amplitude, self.direction, material());
        let (lambda, mu) = (material.lame(), material.shear());
        (d * (lambda + mu) * a.dot(&d) + a * mu * d.norm_squared()) * -bend
    }
}

/// One face held, symmetry-like on another, tractions on the rest.
fn mixed<const D: usize>(field: Power<D>) -> Vec<SurfaceConditions<D>> {
    let displacement = VectorField::of_position(move |x| field.displacement(x));
    let traction = VectorField::Function(Arc::new(move |at| field.stress(at.position) * at.normal));
    let mut parts = vec![SurfaceConditions::traction(traction.clone()); 2 * D];
    parts[0] = SurfaceConditions::displacement(displacement.clone());
    let normal = DirectedDisplacement { direction: SolidDirection::Normal, value: displacement };
    parts[2] = SurfaceConditions { displacements: vec![normal], traction };
    parts
}

fn settings(order: usize) -> CollocationSettings {
    let mut settings = CollocationSettings { solver: CollocationSolver::Direct, ..Default::default() };
    settings.approximation.order = order;
    settings
}

fn check_mixed<const D: usize>(n: usize, basis: usize, order: i32, allowed: f64) {
    let field = Power::<D>::new(order);
    let solid = Solid {
        material: material(),
        parts: mixed(field),
        faces: vec![],
        body_force: VectorField::of_position(move |x| field.body_force(x)),
        rigid_motion: RigidMotion::Supported,
    };
    let collocation = Collocation::new(solid, &Box::cube(n).cloud(), Arc::new(Clear), vec![], settings(basis));
    let solution = collocation.solve(&collocation.assemble().unwrap()).unwrap();
    let found = displacement_error(&collocation, &solution.displacements, |at| field.displacement(at.position));
    assert!(found < allowed, "basis of order {basis}, field of order {order} in {D} dimensions: {found:e}");
}

/// Round-off of 1e-16 is amplified by the condition of the system, 1e3 to 1e5 here.
const ROUND_OFF: f64 = 1e-11;

#[test]
fn mixed_conditions_in_the_plane() {
    for basis in 2..=4 {
        for order in 1..=basis {
            check_mixed::<2>(12, basis, order as i32, ROUND_OFF);
        }
    }
}

#[test]
fn mixed_conditions_in_space() {
    for order in 1..=3 {
        check_mixed::<3>(7, 3, order, ROUND_OFF);
    }
    check_mixed::<3>(7, 2, 2, ROUND_OFF);
    check_mixed::<3>(7, 4, 4, ROUND_OFF);
}

/// The stress of `x_0` and `x_1` only has no traction on the crack plane in the last direction.
fn check_crack<const D: usize>(n: usize) {
    let young = material();
    // Uniaxial tension along the crack.
    let exact = move |x: Vector<D>| {
        let nu = if D == 2 { young.poisson / (1.0 - young.poisson) } else { young.poisson };
        Vector::<D>::from_fn(|d, _| if d == 0 { x[0] } else { -nu * x[d] })
    };
    let stress = if D == 2 { young.effective_young() } else { young.young };
    let mut parts = vec![SurfaceConditions::free(); 2 * D];
    parts[0] = SurfaceConditions::traction(VectorField::Constant(axis::<D>(0) * -stress));
    parts[1] = SurfaceConditions::traction(VectorField::Constant(axis::<D>(0) * stress));
    let solid = Solid {
        material: young,
        parts,
        faces: vec![VectorField::zero()],
        body_force: VectorField::zero(),
        rigid_motion: RigidMotion::MeanIsZero,
    };
    let body = Box { crack: Crack::HalfPlane, ..Box::cube(n) };
    let cloud = body.cloud();
    let collocation = Collocation::new(solid, &cloud, Arc::new(HalfPlane), vec![], settings(3));
    let found = collocation.solve(&collocation.assemble().unwrap()).unwrap();
    // Up to a rigid motion, which strains do not know.
    let gradients = collocation.gradients(&found.displacements).unwrap();
    for (p, g) in collocation.cloud().positions.iter().zip(gradients) {
        let expected = Matrix::<D>::from_fn(|i, j| if i == j { exact(axis::<D>(i))[i] } else { 0.0 });
        let strain = (g + g.transpose()) * 0.5;
        assert!((strain - expected).norm() < 1e-9, "{p} {strain}");
    }
}

#[test]
fn crack_parallel_to_the_field_changes_nothing() {
    check_crack::<2>(12);
    check_crack::<3>(8);
}
