//! Shape functions with gradients at one point, as assembly asks for them.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use riss::approximation::moving_least_squares::Derivatives;
use riss::approximation::{
    ApproximationSettings, Basis, MovingLeastSquares, ShapeFunctions, Surroundings, WeightFunction,
};
use riss::geometry::aabb::Aabb;
use riss::geometry::obstacles::Obstacles;
use riss::math::Vector2;
use riss::nodes::Nodes;
use std::hint::black_box;

/// A jittered grid of unit spacing; a support radius of 2.5 gives 20 neighbors on average.
fn approximation(basis: Basis, weight_function: WeightFunction, radius: f64) -> MovingLeastSquares {
    let n = 40;
    let mut nodes = Nodes::default();
    for i in 0..n * n {
        let jitter = |k: usize| 0.2 * ((i * k) as f64 * 0.618).sin();
        nodes.positions.push(Vector2::new((i % n) as f64 + jitter(7), (i / n) as f64 + jitter(13)));
    }
    nodes.sights = nodes.positions.clone();
    nodes.support_radii = vec![Vector2::repeat(radius); n * n];
    let settings = ApproximationSettings { basis, weight_function, ..ApproximationSettings::default() };
    MovingLeastSquares::new(nodes, Obstacles::new(vec![]), settings)
}

fn bench(c: &mut Criterion) {
    let mut group = c.benchmark_group("shape_functions");
    let cases = [
        ("linear_quartic_20", Basis::Linear, WeightFunction::QuarticSpline, 2.52),
        ("linear_gaussian_20", Basis::Linear, WeightFunction::Gaussian, 2.52),
        ("quadratic_quartic_30", Basis::Quadratic, WeightFunction::QuarticSpline, 3.1),
    ];
    for (name, basis, function, radius) in cases {
        let mls = approximation(basis, function, radius);
        let points: Vec<Vector2> =
            (0..64).map(|k| Vector2::new(20.0 + 0.125 * (k % 8) as f64, 20.0 + 0.125 * (k / 8) as f64)).collect();
        let (mut around, mut shape) = (Surroundings::default(), ShapeFunctions::default());
        // A cell of 4x4 points is looked up once.
        let cells: Vec<&[Vector2]> = points.chunks(16).collect();
        group.throughput(Throughput::Elements(points.len() as u64));
        group.bench_function(name, |b| {
            b.iter(|| {
                for cell in &cells {
                    mls.survey(&Aabb::of_points(cell.iter().copied()), &mut around);
                    for &at in *cell {
                        mls.evaluate_surveyed(at, at, Derivatives::First, &mut around, &mut shape).unwrap();
                        black_box(&shape);
                    }
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
