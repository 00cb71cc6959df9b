//! Shape functions on random nodes with random cracks: they reproduce their basis, their derivatives are those of
//! finite differences, and they see what no crack hides.

use crate::bodies::*;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use riss::analysis::{Settings, Silent, discretize};
use riss::approximation::moving_least_squares::Derivatives;
use riss::approximation::{
    ApproximationSettings, Basis, MovingLeastSquares, ShapeFunctions, SupportShape, Surroundings, WeightFunction,
};
use riss::crack::CrackPath;
use riss::crack::EndKind::Tip;
use riss::geometry::predicates::distance_to_segment;
use riss::material::PlaneState;
use riss::math::{Matrix2, Vector2, cross};
use riss::model::Model;

/// Cases of each property.
const CASES: u32 = 24;

/// The same cases in every run, and no files of failures.
fn config() -> Config {
    Config { cases: CASES, rng_seed: RngSeed::Fixed(20), failure_persistence: None, ..Config::default() }
}

/// A crack of two segments inside the unit square.
fn cracks() -> impl Strategy<Value = CrackPath> {
    let first = (0.2..0.4, 0.3..0.7);
    let middle = (0.45..0.55, 0.3..0.7);
    let last = (0.6..0.8, 0.3..0.7);
    (first, middle, last).prop_map(|(a, b, c)| crack(&[a, b, c], [Tip; 2]))
}

fn approximations() -> impl Strategy<Value = ApproximationSettings> {
    let bases = prop_oneof![Just(Basis::Linear), Just(Basis::Quadratic)];
    let weights = prop_oneof![
        Just(WeightFunction::Gaussian),
        Just(WeightFunction::QuarticSpline),
        Just(WeightFunction::CubicSpline)
    ];
    let supports = prop_oneof![Just(SupportShape::Circular), Just(SupportShape::Rectangular)];
    (bases, weights, supports).prop_map(|(basis, weight_function, support)| ApproximationSettings {
        basis,
        weight_function,
        support,
        ..ApproximationSettings::default()
    })
}

fn square_with(path: CrackPath) -> Model {
    let mut model = body(rectangle((0.0, 0.0), (1.0, 1.0)), PlaneState::Strain);
    model.cracks.push(path);
    model
}

fn shape_functions(path: CrackPath, seed: u64, approximation: ApproximationSettings) -> MovingLeastSquares {
    let model = square_with(path);
    let approximation = approximation.without_automatic_enrichment();
    let settings = Settings { nodes: random_nodes(&model.domain, 9, seed), approximation, ..Settings::default() };
    discretize(&model, &settings, &mut Silent).expect("the nodes are dense enough").approximation
}

fn evaluate(mls: &MovingLeastSquares, at: Vector2) -> ShapeFunctions<2> {
    let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
    mls.evaluate(at, at, Derivatives::Second, &mut around, &mut shape).expect("the fit is regular");
    shape
}

/// Random points in the square.
fn points(seed: u64) -> impl Iterator<Item = Vector2> {
    let mut random = Random(seed ^ 0xabcd);
    (0..20).map(move |_| Vector2::new(random.between(0.01, 0.99), random.between(0.01, 0.99)))
}

/// A polynomial of the basis, its gradient and its second derivatives.
fn polynomial(basis: Basis, x: Vector2) -> (f64, Vector2, Matrix2) {
    let linear = (1.0 + 2.0 * x.x - 0.7 * x.y, Vector2::new(2.0, -0.7));
    match basis {
        Basis::Linear => (linear.0, linear.1, Matrix2::zeros()),
        Basis::Quadratic => {
            let second = Matrix2::new(1.8, -0.4, -0.4, 3.0);
            (linear.0 + 0.5 * x.dot(&(second * x)), linear.1 + second * x, second)
        }
    }
}

/// Nodes that a naive test of all segments leaves visible.
fn visible_by_all_segments(mls: &MovingLeastSquares, cracks: &[CrackPath], at: Vector2) -> Vec<u32> {
    let nodes = mls.nodes();
    let hidden = |to: Vector2| {
        cracks.iter().flat_map(CrackPath::segments).any(|(a, b)| {
            let side = |p: Vector2, q: Vector2, r: Vector2| cross(q - p, r - p) > 0.0;
            side(a, b, at) != side(a, b, to) && side(at, to, a) != side(at, to, b)
        })
    };
    let reaches = |i: &u32| {
        WeightFunction::reaches(
            mls.settings().support,
            &(nodes.positions[*i as usize] - at),
            &nodes.support_radii[*i as usize],
        )
    };
    (0..nodes.len() as u32).filter(reaches).filter(|i| !hidden(nodes.sights[*i as usize])).collect()
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn basis_is_reproduced_with_both_derivatives(path in cracks(), seed in 0..1000u64, settings in approximations()) {
        let mls = shape_functions(path, seed, settings);
        for at in points(seed) {
            let shape = evaluate(&mls, at);
            let (value, gradient, second) = polynomial(settings.basis, at);
            let mut found = (0.0, Vector2::zeros(), Matrix2::zeros());
            let mut sizes = (0.0, 0.0, 0.0);
            for (k, &i) in shape.neighbors.iter().enumerate() {
                let p = polynomial(settings.basis, mls.nodes().positions[i as usize]).0;
                found.0 += shape.values[k] * p;
                found.1 += shape.gradients[k] * p;
                found.2 += shape.second_derivatives[k] * p;
                sizes.0 += shape.values[k].abs() * p.abs();
                sizes.1 += shape.gradients[k].norm() * p.abs();
                sizes.2 += shape.second_derivatives[k].norm() * p.abs();
            }
            // Rounding of the sums themselves, times the condition of a fit (pivots are above 0.02).
            let rounding = 1e-12;
            let one: f64 = shape.values.iter().sum();
            prop_assert!((one - 1.0).abs() < rounding * sizes.0.max(1.0), "partition of unity: {one}");
            prop_assert!((found.0 - value).abs() < rounding * sizes.0, "value {} of {value}", found.0);
            prop_assert!((found.1 - gradient).norm() < rounding * sizes.1, "gradient {} of {gradient}", found.1);
            prop_assert!((found.2 - second).norm() < rounding * sizes.2, "second {} of {second}", found.2);
        }
    }

    #[test]
    fn derivatives_are_those_of_finite_differences(path in cracks(), seed in 0..1000u64, settings in approximations()) {
        let mls = shape_functions(path, seed, settings);
        for at in points(seed) {
            let shape = evaluate(&mls, at);
            for d in 0..2 {
                let step = Vector2::ith(d, 1e-6);
                let (ahead, behind) = (evaluate(&mls, at + step), evaluate(&mls, at - step));
                // A sight line that passes a tip, or a rim of a support in between: the functions jump or kink there.
                if ahead.neighbors != shape.neighbors || behind.neighbors != shape.neighbors {
                    continue;
                }
                // Differences of rounding (1e-16 / 1e-6) and of third derivatives, over the size of each row.
                let slope = shape.gradients.iter().map(|g| g.norm()).fold(0.0, f64::max);
                let bend = shape.second_derivatives.iter().map(|g| g.norm()).fold(0.0, f64::max);
                for k in 0..shape.neighbors.len() {
                    let by = (ahead.values[k] - behind.values[k]) / 2e-6;
                    prop_assert!((by - shape.gradients[k][d]).abs() < 1e-6 * slope, "{by} {}", shape.gradients[k][d]);
                    let by = (ahead.gradients[k] - behind.gradients[k]) / 2e-6;
                    let found = shape.second_derivatives[k].column(d).into_owned();
                    // The cubic spline bends abruptly at half its radius, the quartic at its center: one step wide.
                    prop_assert!((by - found).norm() < 1e-3 * bend, "{by} {found}");
                }
            }
        }
    }

    #[test]
    fn neighbors_are_those_that_no_segment_hides(path in cracks(), seed in 0..1000u64, settings in approximations()) {
        let mls = shape_functions(path.clone(), seed, settings);
        for at in points(seed) {
            // On the crack itself sight is asked from one side.
            if path.segments().any(|(a, b)| distance_to_segment(at, a, b) < 1e-9) {
                continue;
            }
            let expected = visible_by_all_segments(&mls, std::slice::from_ref(&path), at);
            prop_assert_eq!(evaluate(&mls, at).neighbors, expected, "at {}", at);
        }
    }
}
