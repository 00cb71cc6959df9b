//! Discretization and assembly of a cracked plate.

mod plate;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use plate::plate;
use riss::analysis::{Settings, Silent, discretize};
use riss::nodes::settings::{Graded, Layout};
use riss::system::{ConstraintMethod, assemble};
use std::hint::black_box;

fn bench(c: &mut Criterion) {
    let (model, discrete) = plate(10_000);
    let mut group = c.benchmark_group("assembly");
    group.sample_size(10);
    group.throughput(Throughput::Elements(discrete.n_nodes() as u64));
    group.bench_function("assemble_10k", |b| {
        b.iter(|| black_box(assemble(&model, &discrete, &ConstraintMethod::default()).unwrap()));
    });
    // Finite elements along the support and away from the crack.
    let mut coupled = Settings { constraints: ConstraintMethod::FiniteElementCoupled, ..Settings::default() };
    let spacing = Some((112.0f64 / 10_000.0).sqrt());
    coupled.nodes.layout = Layout::Graded(Graded { spacing, ..Graded::default() });
    coupled.approximation.finite_elements_beyond = Some(3.0);
    let elements = discretize(&model, &coupled, &mut Silent).unwrap();
    group.bench_function("assemble_10k_coupled", |b| {
        b.iter(|| black_box(assemble(&model, &elements, &coupled.constraints).unwrap()));
    });
    let mut settings = Settings::default();
    settings.nodes.layout = Layout::Graded(Graded { spacing: Some((112.0f64 / 10_000.0).sqrt()), ..Graded::default() });
    group.bench_function("discretize_10k", |b| {
        b.iter(|| black_box(discretize(&model, &settings, &mut Silent).unwrap()));
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
