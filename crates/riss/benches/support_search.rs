//! Neighbor search: support radii from the third visible neighbor, and neighbor lists of all cells.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use riss::geometry::aabb::Aabb;
use riss::geometry::tree::BoxTree;
use riss::math::Vector2;
use std::hint::black_box;

fn bench(c: &mut Criterion) {
    let n = 300;
    let points: Vec<Vector2> = (0..n * n)
        .map(|i| {
            let jitter = |k: usize| 0.2 * ((i * k) as f64 * 0.618).sin();
            Vector2::new((i % n) as f64 + jitter(7), (i / n) as f64 + jitter(13))
        })
        .collect();
    let boxes: Vec<Aabb<2>> = points.iter().map(|p| Aabb::around(*p, Vector2::repeat(2.5))).collect();
    let mut group = c.benchmark_group("support_search");
    group.sample_size(20);
    group.throughput(Throughput::Elements(points.len() as u64));
    group.bench_function("build_90k", |b| b.iter(|| black_box(BoxTree::new(&boxes))));
    let tree = BoxTree::new(&boxes);
    group.bench_function("query_90k", |b| {
        b.iter(|| {
            let mut count = 0;
            for p in &points {
                tree.visit(&Aabb { lower: *p, upper: *p }, |_| count += 1);
            }
            black_box(count)
        });
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
