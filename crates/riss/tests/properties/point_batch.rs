//! Points in batches have the shape functions that they have one by one.

use crate::bodies::*;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use riss::analysis::{Settings, Silent, discretize};
use riss::approximation::moving_least_squares::{Derivatives, POOR_PIVOT};
use riss::approximation::point_batch::{PointBatch, Wanted};
use riss::approximation::{
    ApproximationSettings, Basis, MovingLeastSquares, ShapeFunctions, Surroundings, WeightFunction,
};
use riss::crack::EndKind::{Mouth, Tip};
use riss::geometry::aabb::Aabb;
use riss::geometry::obstacles::Obstacles;
use riss::integration::cells::as_usize;
use riss::integration::{IntegrationSettings, Scheme};
use riss::material::PlaneState;
use riss::math::Vector2;
use riss::nodes::Nodes;
use riss::nodes::settings::{Graded, Layout};
use riss::system::assemble;
use riss::system::discretization::NodeLists;

/// Difference between both ways over the size of the functions: fits with pivots above 0.02 keep this many digits.
const ROUNDING: f64 = 1e-12;

/// The same cases in every run, and no files of failures.
fn config() -> Config {
    Config { cases: 48, rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..Config::default() }
}

fn settings() -> impl Strategy<Value = ApproximationSettings> {
    let bases = prop_oneof![Just(Basis::Linear), Just(Basis::Quadratic)];
    let weights = prop_oneof![
        Just(WeightFunction::Gaussian),
        Just(WeightFunction::QuarticSpline),
        Just(WeightFunction::CubicSpline)
    ];
    (bases, weights).prop_map(|(basis, weight_function)| ApproximationSettings {
        basis,
        weight_function,
        ..ApproximationSettings::default()
    })
}

/// Nodes in a square of the given side that crowd towards a corner, with supports of uneven size; at the end one more
/// that repeats a node, and one far away. Some points of [`points`] stand on nodes and on rims of supports.
fn cloud(seed: u64, side: f64, grading: f64, reach: f64, settings: ApproximationSettings) -> MovingLeastSquares {
    let mut random = Random(seed);
    let mut nodes = Nodes::default();
    let n = 14;
    for k in 0..n * n {
        let [x, y] = [k % n, k / n].map(|i| (i as f64 + random.between(0.15, 0.85)) / n as f64);
        nodes.positions.push(Vector2::new(x.powf(grading), y.powf(grading)) * side);
        let step = grading / n as f64 * x.max(y).powf(grading - 1.0) * side;
        nodes.support_radii.push(Vector2::repeat(step * reach * random.between(0.8, 1.25)));
    }
    nodes.positions.extend([nodes.positions[n * n / 2], Vector2::repeat(9.0 * side)]);
    nodes.support_radii.extend([nodes.support_radii[3], Vector2::repeat(side)]);
    nodes.sights = nodes.positions.clone();
    MovingLeastSquares::new(nodes, Obstacles::new(vec![]), settings)
}

/// Random points near a random place, one on a node, and one on the rim of a support.
fn points(seed: u64, side: f64, mls: &MovingLeastSquares) -> Vec<Vector2> {
    let mut random = Random(seed ^ 0x5555);
    let middle = [random.unit(), random.unit()].map(|x| x * side);
    let n = 1 + (random.unit() * 20.0) as usize;
    let mut result: Vec<Vector2> = (0..n)
        .map(|_| Vector2::from(middle.map(|x| (x + 0.1 * side * random.between(-1.0, 1.0)).clamp(0.0, side))))
        .collect();
    let nodes = mls.nodes();
    let nearest = |p: Vector2| {
        let distance = |i: &usize| (nodes.positions[*i] - p).norm();
        (0..nodes.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("there are nodes")
    };
    let i = nearest(result[0]);
    result.push(nodes.positions[i]);
    result.push(nodes.positions[i] + Vector2::new(nodes.support_radii[i].x, 0.0));
    result
}

/// Functions of all nodes at one point, and how good the fit is, by the path for single points.
fn one_by_one(mls: &MovingLeastSquares, at: Vector2) -> (Option<ShapeFunctions<2>>, f64) {
    let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
    mls.survey(&Aabb::of_points([at]), &mut around);
    mls.gather(at, at, Derivatives::First, &mut around);
    let quality = mls.quality(at, at, &mut around, &mut ShapeFunctions::default());
    let fits = mls.evaluate_surveyed(at, at, Derivatives::First, &mut around, &mut shape).is_ok();
    (fits.then_some(shape), quality)
}

/// Checks the functions at all points against those one by one.
fn check(mls: &MovingLeastSquares, nodes: &[u32], points: &[Vector2], batch: &PointBatch) -> Result<(), TestCaseError> {
    let stride = batch.stride();
    for (q, &at) in points.iter().enumerate() {
        let shape = one_by_one(mls, at).0.expect("the fit is good");
        let sizes =
            [shape.values.iter().map(|v| v.abs()).sum::<f64>(), shape.gradients.iter().map(|g| g.norm()).sum::<f64>()];
        for (a, i) in nodes.iter().enumerate() {
            let place = shape.neighbors.iter().position(|j| i == j);
            let (value, gradient) = place.map_or((0.0, Vector2::zeros()), |k| (shape.values[k], shape.gradients[k]));
            let found = Vector2::from([0, 1].map(|d| batch.gradients[d][a * stride + q]));
            let by = [(batch.values[a * stride + q] - value).abs(), (found - gradient).norm()];
            prop_assert!(by[0] <= ROUNDING * sizes[0] && by[1] <= ROUNDING * sizes[1], "{by:?} of {sizes:?}");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn batches_equal_single_points(
        seed in 0..10_000u64,
        side in prop_oneof![Just(1e-6), Just(1.0), Just(3e5)],
        grading in 1.0..2.0f64,
        reach in 1.8..4.0f64,
        settings in settings(),
    ) {
        let mls = cloud(seed, side, grading, reach, settings);
        let points = points(seed, side, &mls);
        // All nodes, most of them out of reach.
        let nodes: Vec<u32> = (0..mls.nodes().len() as u32).collect();
        let mut batch = PointBatch::default();
        mls.fill_nodes(nodes.iter().copied(), &mut batch);
        let singles: Vec<_> = points.iter().map(|at| one_by_one(&mls, *at)).collect();
        // Who is poor, and how many nodes are in reach, is the same on both ways.
        batch.set_points(points.iter().map(|p| (*p, Vector2::zeros())));
        mls.evaluate_batch(Wanted::Quality, &mut batch);
        for (q, ((shape, quality), at)) in singles.iter().zip(&points).enumerate() {
            let n = shape.as_ref().map_or(0, |s| s.neighbors.len());
            prop_assert!(shape.is_none() || batch.quality[1][q] == n as f64, "{} of {n}", batch.quality[1][q]);
            let is_far = batch.quality[1][q] < if settings.basis == Basis::Linear { 3.0 } else { 6.0 };
            prop_assert!(is_far || (batch.quality[0][q] - quality).abs() < 1e-9, "{} {quality} {at}", batch.quality[0][q]);
        }
        let is_good = |(shape, quality): &(Option<ShapeFunctions<2>>, f64)| shape.is_some() && *quality >= POOR_PIVOT;
        let all_good = singles.iter().all(is_good);
        prop_assert_eq!(mls.evaluate_batch(Wanted::Gradients, &mut batch), all_good);
        // The good ones alone.
        let good: Vec<Vector2> =
            points.iter().zip(&singles).filter(|(_, single)| is_good(single)).map(|(p, _)| *p).collect();
        let normal = |q: usize| Vector2::new(1.0 + q as f64, 0.5 - q as f64);
        batch.set_points(good.iter().enumerate().map(|(q, p)| (*p, normal(q))));
        prop_assert!(mls.evaluate_batch(Wanted::Gradients, &mut batch));
        check(&mls, &nodes, &good, &batch)?;
        // Sums of values times normals.
        let (stride, values) = (batch.stride(), batch.values.clone());
        prop_assert!(mls.evaluate_batch(Wanted::Fluxes, &mut batch));
        for a in 0..nodes.len() {
            for d in 0..2 {
                let terms = (0..good.len()).map(|q| values[a * stride + q] * normal(q)[d]);
                let (sum, size) = terms.fold((0.0, 0.0), |(s, z), t| (s + t, z + t.abs()));
                prop_assert!((batch.fluxes[d][a] - sum).abs() <= ROUNDING * size);
            }
        }
    }

    #[test]
    fn points_do_not_mix(seed in 0..10_000u64, settings in settings()) {
        let mls = cloud(seed, 1.0, 1.3, 3.2, settings);
        let points = points(seed, 1.0, &mls);
        let nodes: Vec<u32> = (0..mls.nodes().len() as u32).collect();
        let mut batch = PointBatch::default();
        mls.fill_nodes(nodes.iter().copied(), &mut batch);
        batch.set_points(points.iter().map(|p| (*p, Vector2::zeros())));
        mls.evaluate_batch(Wanted::Gradients, &mut batch);
        let mut other = PointBatch::default();
        // In the opposite order, and without nodes out of reach.
        let close: Vec<u32> = nodes.iter().copied().filter(|i| *i as usize != mls.nodes().len() - 1).collect();
        mls.fill_nodes(close.iter().copied(), &mut other);
        other.set_points(points.iter().rev().map(|p| (*p, Vector2::zeros())));
        mls.evaluate_batch(Wanted::Gradients, &mut other);
        for a in 0..close.len() {
            for q in 0..points.len() {
                let places = [a * batch.stride() + q, a * other.stride() + points.len() - 1 - q];
                prop_assert_eq!(batch.values[places[0]].to_bits(), other.values[places[1]].to_bits());
                for d in 0..2 {
                    let [one, two] = [batch.gradients[d][places[0]], other.gradients[d][places[1]]];
                    prop_assert_eq!(one.to_bits(), two.to_bits());
                }
            }
        }
    }

}

proptest! {
    #![proptest_config(Config { cases: 8, ..config() })]

    #[test]
    fn plain_cells_of_a_cracked_plate_equal_single_points(n in 20..30usize, y in 0.3..0.7f64, basis in settings()) {
        let mut model = body(rectangle((0.0, 0.0), (1.0, 1.0)), PlaneState::Strain);
        model.cracks.push(crack(&[(0.0, y), (0.5, 0.5)], [Mouth, Tip]));
        let mut settings = Settings { approximation: basis, ..Settings::default() };
        settings.nodes.layout = Layout::Graded(Graded { spacing: Some(1.0 / n as f64), ..Graded::default() });
        let discrete = discretize(&model, &settings, &mut Silent).expect("the nodes are dense enough");
        let plain: Vec<usize> = (0..discrete.cells.len()).filter(|i| discrete.plain_cells[*i]).collect();
        prop_assert!(!plain.is_empty() && plain.len() < discrete.cells.len());
        let mut batch = PointBatch::default();
        for cell in plain.into_iter().step_by(7) {
            let (nodes, cells) = (discrete.cell_nodes.get(cell), &discrete.cells);
            let inner = cells.points[as_usize(&cells.point_ranges[cell])].iter().map(|p| p.position);
            let outline = cells.edge_points[as_usize(&cells.edge_ranges[cell])].iter().map(|p| p.position);
            let points: Vec<Vector2> = inner.chain(outline).collect();
            discrete.approximation.fill_nodes(nodes.iter().copied(), &mut batch);
            batch.set_points(points.iter().map(|p| (*p, Vector2::zeros())));
            prop_assert!(discrete.approximation.evaluate_batch(Wanted::Gradients, &mut batch));
            check(&discrete.approximation, nodes, &points, &batch)?;
        }
    }
}

/// Appends a cell without points, with and without neighbors, and checks that the matrix stays what it was.
fn check_empty_cells(integration: IntegrationSettings, neighbors: &[u32]) {
    let mut model = body(rectangle((0.0, 0.0), (1.0, 1.0)), PlaneState::Strain);
    model.cracks.push(crack(&[(0.0, 0.4), (0.5, 0.5)], [Mouth, Tip]));
    let mut settings = Settings { integration, ..Settings::default() };
    settings.nodes.layout = Layout::Graded(Graded { spacing: Some(0.08), ..Graded::default() });
    let mut discrete = discretize(&model, &settings, &mut Silent).expect("the nodes are dense enough");
    let before = assemble(&model, &discrete, &settings.constraints).expect("all fits are regular").matrix;
    for is_plain in [true, false] {
        let (points, edges) = (discrete.cells.points.len() as u32, discrete.cells.edge_points.len() as u32);
        discrete.cells.point_ranges.push(points..points);
        discrete.cells.edge_ranges.push(edges..edges);
        discrete.cells.corners.push(vec![]);
        let mut lists: Vec<Vec<u32>> = discrete.cell_nodes.iter().map(<[u32]>::to_vec).collect();
        lists.push(neighbors.to_vec());
        discrete.cell_nodes = NodeLists::from_lists(&lists);
        discrete.plain_cells.push(is_plain);
        let after = assemble(&model, &discrete, &settings.constraints).expect("all fits are regular").matrix;
        assert_eq!(before.columns, after.columns);
        let size = before.blocks.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
        for (a, b) in before.blocks.iter().flatten().zip(after.blocks.iter().flatten()) {
            assert!((a - b).abs() <= 1e-14 * size, "{a} {b}");
        }
    }
}

#[test]
fn cells_without_points_add_nothing() {
    for neighbors in [&[][..], &[0]] {
        check_empty_cells(IntegrationSettings::default(), neighbors);
        let nodal =
            IntegrationSettings { scheme: Scheme::Nodal { stabilization: 0.5 }, ..IntegrationSettings::default() };
        check_empty_cells(nodal, neighbors);
    }
}
