//! Point collocation of the near-tip cuboid stage by stage: nodes, stencils, matrix, preconditioner, solution, factors.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use riss::analysis::{SolidSettings, solid_collocation, solid_nodes};
use riss::approximation::{FitBuffer, FrontFrame, ShapeFunctions};
use riss::case::AnyCase;
use riss::fracture::{DiscCut, front_integrals};
use riss::math::axis;
use riss::model::SolidModel;
use riss::nodes::solid::solid_obstacles;
use riss::system::aggregates::Aggregates;
use riss::system::coarse_level::CoarseLevel;
use riss::system::dissection::Dissection;
use riss::system::incomplete_factor::IncompleteFactor;
use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;

/// The smallest of the cuboids, 15,129 nodes.
fn cuboid() -> (SolidModel, SolidSettings) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/near-tip-cuboid/case.toml");
    let text = std::fs::read_to_string(&path).expect("the case is there");
    let Ok(AnyCase::Solid(case)) = AnyCase::parse(&text, &path, &[]) else { panic!("the case is one of a solid") };
    (case.model, case.settings)
}

fn bench(c: &mut Criterion) {
    let (model, settings) = cuboid();
    let nodes = solid_nodes(&model, &settings).unwrap();
    let obstacles = Arc::new(solid_obstacles(&model.body, &model.cracks));
    let collocation = solid_collocation(&model, &nodes, obstacles, &settings);
    let n = collocation.cloud().len();
    let mut group = c.benchmark_group("collocation_15k");
    group.sample_size(10);
    group.throughput(Throughput::Elements(n as u64));
    group.bench_function("nodes", |b| b.iter(|| black_box(solid_nodes(&model, &settings).unwrap())));

    // One thread, nodes near the front and far from it alike.
    let some: Vec<u32> = (0..n as u32).step_by(16).collect();
    let (mut buffer, mut shape) = (FitBuffer::default(), ShapeFunctions::default());
    group.throughput(Throughput::Elements(some.len() as u64));
    group.bench_function("stencils", |b| {
        b.iter(|| {
            for &node in &some {
                let sight = collocation.cloud().sights[node as usize];
                collocation.approximation.at_node(node, sight, &mut buffer, &mut shape).unwrap();
                black_box(&shape);
            }
        });
    });

    group.throughput(Throughput::Elements(n as u64));
    group.bench_function("matrix", |b| b.iter(|| black_box(collocation.assemble().unwrap())));
    let system = collocation.assemble().unwrap();
    group.bench_function("incomplete_factor", |b| {
        b.iter(|| {
            let dissection = Dissection::new(&system.tangent, &collocation.cloud().positions);
            black_box(IncompleteFactor::new(&system.tangent, dissection, &vec![false; n]))
        });
    });
    let positions = &collocation.cloud().positions;
    group.bench_function("coarse_level", |b| {
        b.iter(|| {
            let groups = Aggregates::new(positions, &system.tangent, &system.fixed, 150);
            black_box(CoarseLevel::new(&system.tangent, positions, &system.fixed, groups, &[]).unwrap())
        });
    });
    group.bench_function("solve", |b| b.iter(|| black_box(collocation.solve(&system).unwrap())));

    let found = collocation.solve(&system).unwrap().displacements;
    let frame = FrontFrame {
        position: axis::<3>(1) * 2.0,
        ahead: axis(0),
        normal: axis(2),
        curvature: 0.0,
        normal_curvature: 0.0,
    };
    group.throughput(Throughput::Elements(1));
    group.bench_function("factors_of_a_disc", |b| {
        b.iter(|| black_box(front_integrals(&collocation, &found, &DiscCut::plane(&frame), 0, &[4.0]).unwrap()));
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
