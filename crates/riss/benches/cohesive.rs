//! Cohesive cracks in the plane: a notched beam is condensed onto its openings and broken.

use criterion::{Criterion, criterion_group, criterion_main};
use riss::analysis::{Silent, plane_loading};
use riss::case::Case;
use std::hint::black_box;

const BEAM: &str = "
rigid_motion = 'mean-is-zero'
geometry.rectangle = { lower = [-150, 0], upper = [150, 100] }
crack = [{ cohesive = true, path = [[0, 0], [0, 100]], notch = [{ lower = [-1, 0], upper = [1, 30] }] }]
load = [
    { on = 'top', traction = [0, '-max(0, 1 - (x/15)^2)'] },
    { on = 'bottom', traction = [0, '0.5*max(0, 1 - ((x - 125)/15)^2) + 0.5*max(0, 1 - ((x + 125)/15)^2)'] },
]
[loading]
[material]
young = 30000
poisson = 0.2
plane = 'stress'
cohesive = { strength = 3, fracture_energy = 0.1 }
";

fn bench(c: &mut Criterion) {
    let case = Case::parse(BEAM, "case.toml".as_ref(), &[]).unwrap();
    let loading = case.loading.unwrap();
    let mut group = c.benchmark_group("cohesive");
    group.sample_size(10);
    group.bench_function("beam", |b| {
        b.iter(|| black_box(plane_loading(&case.model, &case.settings, &loading, None, None, &mut Silent).unwrap()));
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
