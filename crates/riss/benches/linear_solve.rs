//! Factorization and solution of the system of a cracked plate.

mod plate;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use plate::plate;
use riss::system::linear_solver::Factor;
use riss::system::ordering::nested_dissection;
use riss::system::{ConstraintMethod, assemble};
use std::hint::black_box;

fn bench(c: &mut Criterion) {
    let (model, discrete) = plate(10_000);
    let system = assemble(&model, &discrete, &ConstraintMethod::default()).unwrap();
    let positions = &discrete.approximation.nodes().positions;
    let order = nested_dissection(positions, &system.matrix);
    let mut group = c.benchmark_group("linear_solve");
    group.sample_size(10);
    group.throughput(Throughput::Elements(2 * discrete.n_nodes() as u64));
    group.bench_function("order_10k", |b| b.iter(|| black_box(nested_dissection(positions, &system.matrix))));
    group.bench_function("factor_double_10k", |b| b.iter(|| Factor::double(&system.matrix, &order).unwrap()));
    group.bench_function("factor_single_10k", |b| b.iter(|| Factor::single(&system.matrix, &order).unwrap()));
    let factor = Factor::double(&system.matrix, &order).unwrap();
    group.bench_function("solve_10k", |b| {
        b.iter(|| black_box(factor.solve(&system.matrix, &system.load).unwrap()));
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
