//! Factorization and solution of the system of a cracked plate.

mod plate;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use plate::plate;
use riss::system::linear_solver::Factor;
use riss::system::multifrontal::EliminationTree;
use riss::system::{ConstraintMethod, assemble};
use std::hint::black_box;
use std::sync::Arc;

fn bench(c: &mut Criterion) {
    let (model, discrete) = plate(10_000);
    let system = assemble(&model, &discrete, &ConstraintMethod::default()).unwrap();
    let positions = &discrete.approximation.nodes().positions;
    let tree = Arc::new(EliminationTree::new(positions, &system.matrix));
    let mut group = c.benchmark_group("linear_solve");
    group.sample_size(10);
    group.throughput(Throughput::Elements(2 * discrete.n_nodes() as u64));
    group.bench_function("order_10k", |b| b.iter(|| black_box(EliminationTree::new(positions, &system.matrix))));
    group.bench_function("factor_double_10k", |b| b.iter(|| Factor::double(&system.matrix, tree.clone()).unwrap()));
    group.bench_function("factor_single_10k", |b| b.iter(|| Factor::single(&system.matrix, tree.clone()).unwrap()));
    let factor = Factor::double(&system.matrix, tree.clone()).unwrap();
    group.bench_function("solve_10k", |b| {
        b.iter(|| black_box(factor.solve(&system.matrix, &system.load).unwrap()));
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
