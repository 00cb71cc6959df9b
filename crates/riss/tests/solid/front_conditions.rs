//! What each choice for nodes on crack fronts asks for, seen in the residual of known displacements.
//!
//! Where the basis holds the displacement, shape functions give its stress exactly. The right-hand side of a row is
//! what is prescribed, times the same scale as the left, so that the scale drops out.

use crate::boxes::{Box, Crack, HalfPlane};
use crate::patch::{Power, material};
use riss::math::{Vector, axis};
use riss::model::{RigidMotion, Solid, SurfaceConditions, VectorField};
use riss::nodes::cloud::{Cloud, Place};
use riss::system::{Collocation, CollocationSettings, FrontNodes};
use std::sync::Arc;

/// Traction on both faces, and body force.
fn prescribed<const D: usize>() -> [Vector<D>; 2] {
    [[0.3, -0.5, 0.7], [-0.2, 0.4, 0.6]].map(|v| Vector::from_fn(|d, _| v[d]))
}

/// A cube with a crack to its middle whose front nodes give their faces the angles `angles`.
fn cracked<const D: usize>(front_nodes: FrontNodes, angles: [f64; 2]) -> Collocation<D> {
    let mut cloud: Cloud<D> = Box { crack: Crack::HalfPlane, ..Box::cube(8) }.cloud();
    for place in &mut cloud.places {
        if let Place::Front { facets, .. } = place {
            let first = facets.len() - 2;
            (0..2).for_each(|k| facets[first + k].angle = angles[k]);
        }
    }
    let [traction, force] = prescribed();
    let solid = Solid {
        material: material(),
        parts: vec![SurfaceConditions::free(); 2 * D],
        faces: vec![VectorField::Constant(traction)],
        body_force: VectorField::Constant(force),
        rigid_motion: RigidMotion::MeanIsZero,
    };
    let settings = CollocationSettings { front_nodes, ..CollocationSettings::default() };
    Collocation::new(solid, &cloud, Arc::new(HalfPlane), vec![], settings)
}

/// Nodes on the front where nothing but the two faces meets.
fn front_nodes<const D: usize>(collocation: &Collocation<D>) -> Vec<usize> {
    let is_plain = |place: &Place<D>| matches!(place, Place::Front { facets, .. } if facets.len() == 2);
    let places = &collocation.cloud().places;
    (0..places.len()).filter(|k| is_plain(&places[*k])).collect()
}

/// Residual at nodes of the front and right-hand side there.
fn rows<const D: usize>(
    collocation: &Collocation<D>,
    displacement: impl Fn(Vector<D>, Vector<D>) -> Vector<D>,
) -> Vec<(Vector<D>, [Vector<D>; 2])> {
    let (system, cloud) = (collocation.assemble().unwrap(), collocation.cloud());
    let places = cloud.positions.iter().zip(&cloud.sights);
    let flat: Vec<f64> = places.flat_map(|(x, s)| displacement(*x, *s).iter().copied().collect::<Vec<_>>()).collect();
    let mut residual = vec![0.0; flat.len()];
    system.residual_into(&flat, &mut residual);
    let at = |values: &[f64], k: usize| Vector::<D>::from_column_slice(&values[k * D..(k + 1) * D]);
    let nodes = front_nodes(collocation);
    assert!(!nodes.is_empty());
    nodes.into_iter().map(|k| (cloud.positions[k], [at(&residual, k), at(&system.load, k)])).collect()
}

/// `residual = scale (expected - prescribed)` with the scale that the load tells.
fn check<const D: usize>(found: [Vector<D>; 2], expected: Vector<D>, prescribed: Vector<D>, what: &str) {
    let [residual, load] = found;
    let scale = load.dot(&prescribed) / prescribed.norm_squared();
    assert!(scale > 0.0 && (load - prescribed * scale).norm() < 1e-12 * load.norm(), "{what}: load {load}");
    let error = residual / scale - (expected - prescribed);
    assert!(
        error.norm() < 1e-8 * (1.0 + expected.norm()),
        "{what}: {} is not {}",
        residual / scale,
        expected - prescribed
    );
}

/// The faces meet at the front with outward normals down (face above) and up (face below), [C3D, Eqs. 44, 45].
fn check_averaged<const D: usize>() {
    let [traction, _] = prescribed::<D>();
    let smooth = Power::<D>::new(2);
    let up = axis::<D>(D - 1);
    for angles in [[1.0, 2.0], [3.0, 1.0]] {
        let collocation = cracked(FrontNodes::Averaged, angles);
        for (x, found) in rows(&collocation, |x, _| smooth.displacement(x)) {
            let share = (angles[1] - angles[0]) / (angles[0] + angles[1]);
            check(found, smooth.stress(x) * up * share, traction, "both faces");
        }
    }
    // The nodes behind the crack jump, which shape functions from the other side do not see.
    for (angles, own) in [([1.0, 0.0], 1.0), ([0.0, 1.0], -1.0)] {
        let collocation = cracked(FrontNodes::Averaged, angles);
        let jumping = |x: Vector<D>, sight: Vector<D>| {
            let is_hidden = x[0] < -1e-9 && (x[D - 1] + sight[D - 1]) * own < 0.0;
            smooth.displacement(x) + if is_hidden { Vector::repeat(5.0) } else { Vector::zeros() }
        };
        for (x, found) in rows(&collocation, jumping) {
            check(found, smooth.stress(x) * up * -own, traction, "one face");
        }
    }
}

#[test]
fn averaged_tractions_look_from_each_face() {
    check_averaged::<2>();
    check_averaged::<3>();
}

fn check_equilibrium<const D: usize>() {
    let [_, force] = prescribed::<D>();
    let smooth = Power::<D>::new(3);
    for (x, found) in rows(&cracked(FrontNodes::Equilibrium, [1.0; 2]), |x, _| smooth.displacement(x)) {
        check(found, smooth.body_force(x), force, "equilibrium");
    }
}

#[test]
fn equilibrium_at_the_front_is_that_inside() {
    check_equilibrium::<2>();
    check_equilibrium::<3>();
}

fn check_fitted<const D: usize>() {
    let smooth = Power::<D>::new(3);
    let collocation = cracked(FrontNodes::Fitted, [1.0; 2]);
    let alone = Vector::<D>::repeat(0.25);
    let on_front = |x: Vector<D>| x[0] == 0.0 && x[D - 1] == 0.0;
    // In space a neighbor on the front moves along, and the fit with it.
    let shift = |x: Vector<D>| if D == 2 && on_front(x) { alone } else { Vector::zeros() };
    for (x, [residual, load]) in rows(&collocation, |x, _| smooth.displacement(x) + shift(x)) {
        assert!((residual - shift(x)).norm() < 1e-10 && load.norm() == 0.0, "{residual} {load}");
    }
}

#[test]
fn fitted_nodes_take_the_value_of_the_others() {
    check_fitted::<2>();
    check_fitted::<3>();
}

#[test]
fn omitted_nodes_are_not_there() {
    let [with, without] = [FrontNodes::Fitted, FrontNodes::Omitted].map(|f| cracked::<3>(f, [1.0; 2]));
    let is_front = |p: &&Place<3>| matches!(p, Place::Front { .. });
    let n = with.cloud().places.iter().filter(is_front).count();
    assert_eq!(n, 9);
    assert_eq!(without.cloud().len(), with.cloud().len() - n);
    assert_eq!(without.cloud().places.iter().filter(is_front).count(), 0);
}
