//! Enriched shape functions: they reproduce the field of the tip, their derivatives are those of finite differences, and
//! they are the plain ones outside the regions.

use crate::bodies::*;
use riss::analysis::{Settings, Silent, discretize};
use riss::approximation::moving_least_squares::Derivatives;
use riss::approximation::tip_functions::{TipCoordinates, TipFunctions};
use riss::approximation::{
    ApproximationSettings, Basis, CrackSmoothing, EnrichmentKind, EnrichmentSettings, MovingLeastSquares, Ramp,
    ShapeFunctions, SmoothingSettings, Surroundings,
};
use riss::crack::End;
use riss::crack::EndKind::{Mouth, Tip};
use riss::geometry::predicates::distance_to_segment;
use riss::material::PlaneState;
use riss::math::{Matrix2, Vector2};
use riss::model::Model;

/// A square with a straight and a twice kinked edge crack, whose regions take in the kinks.
fn square() -> Model {
    let mut model = body(rectangle((0.0, 0.0), (1.0, 1.0)), PlaneState::Strain);
    model.cracks.push(crack(&[(0.0, 0.25), (0.4, 0.3)], [Mouth, Tip]));
    model.cracks.push(crack(&[(0.0, 0.8), (0.3, 0.75), (0.45, 0.8), (0.52, 0.7)], [Mouth, Tip]));
    model
}

fn approximation(seed: u64, kind: EnrichmentKind, basis: Basis, r: [f64; 2], ramp: Ramp) -> MovingLeastSquares {
    let model = square();
    let approximation = ApproximationSettings {
        basis,
        smoothing: SmoothingSettings {
            cracks: Some(CrackSmoothing::Diffraction { lambda: 1.0 }),
            ..SmoothingSettings::default()
        },
        enrichment: EnrichmentSettings { kind, ramp, r1: Some(r[0]), r2: Some(r[1]), dilation: Some(3.5) },
        ..ApproximationSettings::default()
    };
    let settings = Settings { nodes: random_nodes(&model.domain, 20, seed), approximation, ..Settings::default() };
    discretize(&model, &settings, &mut Silent).expect("the nodes are dense enough").approximation
}

fn evaluate(mls: &MovingLeastSquares, at: Vector2) -> ShapeFunctions<2> {
    let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
    mls.evaluate(at, at, Derivatives::Second, &mut around, &mut shape).expect("the fit is regular");
    shape
}

/// Points at all distances from a tip up to `reach`, clear of the cracks.
fn points(tip: Vector2, reach: f64, seed: u64) -> Vec<Vector2> {
    let (model, mut random) = (square(), Random(seed));
    let all = (0..120).map(|_| {
        let r = reach * random.unit().powi(2);
        tip + riss::math::direction(random.between(0.0, 7.0)) * r
    });
    let clear = |p: &Vector2| {
        let segments = model.cracks.iter().flat_map(|c| c.segments());
        segments.map(|(a, b)| distance_to_segment(*p, a, b)).fold(f64::INFINITY, f64::min) > 1e-4
    };
    all.filter(|p| clear(p) && model.domain.contains(*p)).collect()
}

fn check_reproduction(kind: EnrichmentKind, functions: TipFunctions, basis: Basis) {
    let model = square();
    let mls = approximation(3, kind, basis, [0.15, 0.2], Ramp::Quintic);
    for path in &model.cracks {
        let coordinates = TipCoordinates::new(path, End::End, f64::INFINITY, 0.0);
        for at in points(coordinates.tip(), 0.15, 8) {
            let (shape, exact) = (evaluate(&mls, at), coordinates.jet(functions, at, at));
            for f in 0..functions.count() {
                let mut found = (0.0, Vector2::zeros(), Matrix2::zeros());
                let mut sizes = (0.0, 0.0, 0.0);
                for (k, &i) in shape.neighbors.iter().enumerate() {
                    let (p, sight) = (mls.nodes().positions[i as usize], mls.nodes().sights[i as usize]);
                    let q = coordinates.values(functions, p, sight)[f];
                    found.0 += shape.values[k] * q;
                    found.1 += shape.gradients[k] * q;
                    found.2 += shape.second_derivatives[k] * q;
                    sizes.0 += (shape.values[k] * q).abs();
                    sizes.1 += shape.gradients[k].norm() * q.abs();
                    sizes.2 += shape.second_derivatives[k].norm() * q.abs();
                }
                // Rounding, times the condition of the longer basis.
                let rounding = 1e-9;
                assert!((found.0 - exact.values[f]).abs() < rounding * sizes.0, "{kind:?} {f} at {at}: {found:?}");
                assert!((found.1 - exact.gradients[f]).norm() < rounding * sizes.1, "{kind:?} {f} at {at}: {found:?}");
                let second = exact.second_derivatives[f];
                assert!((found.2 - second).norm() < rounding * sizes.2, "{kind:?} {f} at {at}: {found:?} {second}");
            }
        }
    }
}

#[test]
fn fields_of_the_tip_are_reproduced() {
    for basis in [Basis::Linear, Basis::Quadratic] {
        check_reproduction(EnrichmentKind::IntrinsicFull, TipFunctions::Full, basis);
        check_reproduction(EnrichmentKind::IntrinsicRadial, TipFunctions::Radial, basis);
    }
}

#[test]
fn linear_fields_are_reproduced_in_and_around_the_regions() {
    for kind in [
        EnrichmentKind::IntrinsicFull,
        EnrichmentKind::IntrinsicRadial,
        EnrichmentKind::ExtrinsicFull,
        EnrichmentKind::ExtrinsicMls,
    ] {
        for ramp in [Ramp::Linear, Ramp::Quintic, Ramp::Abrupt] {
            let mls = approximation(4, kind, Basis::Linear, [0.05, 0.15], ramp);
            for at in points(Vector2::new(0.4, 0.3), 0.22, 9) {
                let shape = evaluate(&mls, at);
                // Additional functions are no part of linear fields.
                let n = shape.neighbors.partition_point(|i| (*i as usize) < mls.nodes().len());
                let one: f64 = shape.values[..n].iter().sum();
                let position = |i: &u32| mls.nodes().positions[*i as usize];
                let pairs = || shape.neighbors[..n].iter().zip(&shape.gradients);
                let gradient = pairs().fold(Matrix2::zeros(), |s, (i, g)| s + position(i) * g.transpose());
                let size: f64 = shape.gradients.iter().map(|g| g.norm()).sum();
                assert!((one - 1.0).abs() < 1e-9, "{kind:?} {ramp:?} at {at}: {one}");
                assert!((gradient - Matrix2::identity()).norm() < 1e-9 * size, "{kind:?} {ramp:?} at {at}: {gradient}");
            }
        }
    }
}

#[test]
fn derivatives_are_those_of_finite_differences() {
    let mut compared = 0;
    let kinds = [
        (EnrichmentKind::IntrinsicFull, Ramp::Linear),
        (EnrichmentKind::IntrinsicFull, Ramp::Quintic),
        (EnrichmentKind::ExtrinsicFull, Ramp::Quintic),
        (EnrichmentKind::ExtrinsicMls, Ramp::Quintic),
    ];
    for (kind, ramp) in kinds {
        let mls = approximation(5, kind, Basis::Linear, [0.05, 0.15], ramp);
        for tip in [Vector2::new(0.4, 0.3), Vector2::new(0.52, 0.7)] {
            for at in points(tip, 0.2, 10).into_iter().filter(|p| (p - tip).norm() > 0.01) {
                let (shape, step) = (evaluate(&mls, at), 1e-6);
                for d in 0..2 {
                    let e = Vector2::ith(d, step);
                    let (ahead, behind) = (evaluate(&mls, at + e), evaluate(&mls, at - e));
                    if ahead.neighbors != shape.neighbors || behind.neighbors != shape.neighbors {
                        continue;
                    }
                    let slope = shape.gradients.iter().map(|g| g.norm()).fold(0.0, f64::max);
                    let bend = shape.second_derivatives.iter().map(|g| g.norm()).fold(0.0, f64::max);
                    let turns = |k: usize| (ahead.gradients[k] - behind.gradients[k]).norm() > 10.0 * step * bend;
                    // A way around a tip, a perpendicular at a kink or the end of a ramp lies between.
                    if (0..shape.neighbors.len()).any(turns) {
                        continue;
                    }
                    compared += 1;
                    for k in 0..shape.neighbors.len() {
                        let by = (ahead.values[k] - behind.values[k]) / (2.0 * step);
                        let found = shape.gradients[k][d];
                        assert!((by - found).abs() < 1e-5 * slope, "{kind:?} {ramp:?} at {at}: {by} {found}");
                        let by = (ahead.gradients[k] - behind.gradients[k]) / (2.0 * step);
                        let found = shape.second_derivatives[k].column(d).into_owned();
                        assert!((by - found).norm() < 1e-2 * bend, "{kind:?} {ramp:?} at {at}: {by} {found}");
                    }
                }
            }
        }
    }
    assert!(compared > 300, "only {compared} are smooth enough to compare");
}

#[test]
fn outside_the_regions_shape_functions_are_the_plain_ones() {
    let enriched = approximation(6, EnrichmentKind::IntrinsicFull, Basis::Linear, [0.05, 0.1], Ramp::Quintic);
    // The same nodes and supports without functions.
    let plain = enriched.clone().enriched(None);
    let tips: Vec<Vector2> = square().tips().iter().map(|t| t.1.position).collect();
    let (mut random, mut inside) = (Random(7), 0);
    for _ in 0..200 {
        let at = Vector2::new(random.between(0.01, 0.99), random.between(0.01, 0.99));
        let is_inside = tips.iter().any(|t| (at - t).norm() < 0.1);
        let (a, b) = (evaluate(&enriched, at), evaluate(&plain, at));
        assert_eq!(a.values == b.values, !is_inside, "{at}");
        inside += usize::from(is_inside);
    }
    assert!(inside > 3);
}
