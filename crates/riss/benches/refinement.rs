//! Adaptive nodes: the spacing of many squares, the error estimate, the split of a quadtree, a whole refined solution.

mod plate;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use plate::plate;
use riss::adaptivity::{AccuracySettings, Quadtree, estimate_error, mark};
use riss::analysis::{Settings, Silent, solve_refined};
use riss::math::Vector2;
use riss::nodes::spacing::SpacingField;
use riss::system::galerkin::displacement_gradients;
use riss::system::{ConstraintMethod, LinearSolver, assemble, solve::solve};
use std::hint::black_box;

fn bench(c: &mut Criterion) {
    let (model, discrete) = plate(10_000);
    let method = ConstraintMethod::default();
    let system = assemble(&model, &discrete, &method).unwrap();
    let solution = solve(&model, &discrete, system, &method, LinearSolver::default()).unwrap();
    let gradients = displacement_gradients(&discrete, &solution.parameters).unwrap();
    let tip = Vector2::new(3.5, 8.0);
    let mut tree = Quadtree::uniform(&model.domain.aabb(), 0.5);
    tree.fit(|p| 1e-3 + 0.05 * (p - tip).norm());
    let squares: Vec<_> = tree.leaves().into_iter().map(|s| (tree.bounds(s), tree.size(s))).collect();
    let field = SpacingField::of_rectangles(&squares, 0.4);
    let mut group = c.benchmark_group("refinement");
    group.sample_size(10);
    group.throughput(Throughput::Elements(squares.len() as u64));
    group.bench_function(format!("spacing_at_{}_squares", squares.len()), |b| {
        b.iter(|| squares.iter().map(|s| field.at(s.0.center())).sum::<f64>());
    });
    group.throughput(Throughput::Elements(discrete.n_nodes() as u64));
    group.bench_function("estimate_10k", |b| {
        b.iter(|| black_box(estimate_error(&model, &discrete, &solution, &gradients).unwrap()));
    });
    let estimate = estimate_error(&model, &discrete, &solution, &gradients).unwrap();
    group.bench_function("mark_and_split", |b| {
        b.iter(|| {
            let mut finer = tree.clone();
            let marks = mark(&tree, &estimate, &discrete.cells.points, 0.5 * estimate.relative());
            finer.refine(&marks.refine);
            finer.coarsen(&marks.coarsen);
            black_box(finer.len())
        });
    });
    let accuracy = AccuracySettings { k_percent: Some(0.5), ..AccuracySettings::default() };
    group.bench_function("solve_for_half_a_percent", |b| {
        b.iter(|| black_box(solve_refined(&model, &Settings::default(), &accuracy, &mut Silent).unwrap()));
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
