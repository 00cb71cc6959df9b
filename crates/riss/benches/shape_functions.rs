//! Shape functions with gradients, as assembly asks for them, cell by cell in batches and point by point; neighbors near a
//! tip with each smoothing.

mod plate;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use riss::analysis::{Settings, Silent, discretize};
use riss::approximation::enrichment::TipSpacing;
use riss::approximation::moving_least_squares::Derivatives;
use riss::approximation::point_batch::{PointBatch, Wanted};
use riss::approximation::{
    ApproximationSettings, Basis, CrackSmoothing, Enrichment, EnrichmentKind, EnrichmentSettings, MovingLeastSquares,
    ShapeFunctions, SmoothingSettings, Surroundings, WeightFunction,
};
use riss::crack::{CrackPath, EndKind};
use riss::geometry::aabb::Aabb;
use riss::geometry::curve::Curve;
use riss::geometry::obstacles::Obstacles;
use riss::integration::cells::as_usize;
use riss::math::Vector2;
use riss::model::{Domain, Model};
use riss::nodes::Nodes;
use riss::nodes::settings::{Layout, Structured};
use riss::system::Discretization;
use std::hint::black_box;

/// The regions of a crack whose tip lies among the points of the bench.
fn enrichment(kind: EnrichmentKind) -> Option<Enrichment> {
    let corners = [(0.0, 0.0), (40.0, 0.0), (40.0, 40.0), (0.0, 40.0)].map(|(x, y)| Vector2::new(x, y));
    let edges = (0..4).map(|i| Curve::Line { start: corners[i], end: corners[(i + 1) % 4] }).collect();
    let vertices = vec![Vector2::new(0.0, 20.3), Vector2::new(20.3, 20.3)];
    let path = CrackPath { name: "crack".into(), vertices, ends: [EndKind::Mouth, EndKind::Tip] };
    let model = Model { cracks: vec![path], ..Model::plain(Domain::new(edges, vec![])) };
    let spacing = TipSpacing { at_tip: 1.0, elsewhere: 1.0 };
    Enrichment::of_model(&model, &EnrichmentSettings { kind, ..EnrichmentSettings::default() }, &[spacing]).0
}

/// A jittered grid of unit spacing; a support radius of 2.5 gives 20 neighbors on average.
fn approximation(
    basis: Basis,
    kind: EnrichmentKind,
    weight_function: WeightFunction,
    radius: f64,
) -> MovingLeastSquares {
    let n = 40;
    let mut nodes = Nodes::default();
    for i in 0..n * n {
        let jitter = |k: usize| 0.2 * ((i * k) as f64 * 0.618).sin();
        nodes.positions.push(Vector2::new((i % n) as f64 + jitter(7), (i / n) as f64 + jitter(13)));
    }
    nodes.sights = nodes.positions.clone();
    nodes.support_radii = vec![Vector2::repeat(radius); n * n];
    let settings = ApproximationSettings { basis, weight_function, ..ApproximationSettings::default() };
    // Without the crack as an obstacle: what is measured is the basis.
    MovingLeastSquares::new(nodes, Obstacles::new(vec![]), settings).enriched(enrichment(kind))
}

fn bench(c: &mut Criterion) {
    let mut group = c.benchmark_group("shape_functions");
    let cases = [
        ("linear_quartic_20", Basis::Linear, EnrichmentKind::None, WeightFunction::QuarticSpline, 2.52),
        ("linear_gaussian_20", Basis::Linear, EnrichmentKind::None, WeightFunction::Gaussian, 2.52),
        ("quadratic_quartic_30", Basis::Quadratic, EnrichmentKind::None, WeightFunction::QuarticSpline, 3.1),
        ("full_quartic_20", Basis::Linear, EnrichmentKind::IntrinsicFull, WeightFunction::QuarticSpline, 2.52),
        ("radial_quartic_20", Basis::Linear, EnrichmentKind::IntrinsicRadial, WeightFunction::QuarticSpline, 2.52),
        ("extrinsic_full_20", Basis::Linear, EnrichmentKind::ExtrinsicFull, WeightFunction::QuarticSpline, 2.52),
        ("extrinsic_radial_20", Basis::Linear, EnrichmentKind::ExtrinsicRadial, WeightFunction::QuarticSpline, 2.52),
        ("extrinsic_mls_20", Basis::Linear, EnrichmentKind::ExtrinsicMls, WeightFunction::QuarticSpline, 2.52),
    ];
    for (name, basis, kind, function, radius) in cases {
        let mls = approximation(basis, kind, function, radius);
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

/// All points of the cells of a plate that see no crack, as assembly asks for them: in batches, and one by one.
fn bench_cells(c: &mut Criterion) {
    let mut group = c.benchmark_group("cells");
    for (name, basis) in [("linear", Basis::Linear), ("quadratic", Basis::Quadratic)] {
        let mut settings = Settings::default();
        settings.approximation.basis = basis;
        let (_, discrete) = plate::plate_with(3_000, settings);
        let (cells, mls) = (&discrete.cells, &discrete.approximation);
        let plain: Vec<usize> = (0..cells.len()).filter(|i| discrete.plain_cells[*i]).collect();
        let points = |cell: usize| cells.points[as_usize(&cells.point_ranges[cell])].iter().map(|p| p.position);
        let n_points: usize = plain.iter().map(|i| points(*i).len()).sum();
        group.throughput(Throughput::Elements(n_points as u64));
        let mut batch = PointBatch::default();
        group.bench_function(format!("{name}_in_batches"), |b| {
            b.iter(|| {
                for &cell in &plain {
                    mls.fill_nodes(discrete.cell_nodes.get(cell).iter().copied(), &mut batch);
                    batch.set_points(points(cell).map(|p| (p, Vector2::zeros())));
                    assert!(mls.evaluate_batch(Wanted::Gradients, &mut batch));
                    black_box(&batch);
                }
            });
        });
        let (mut around, mut shape) = (Surroundings::default(), ShapeFunctions::default());
        let mut n_neighbors = 0;
        group.bench_function(format!("{name}_one_by_one"), |b| {
            b.iter(|| {
                n_neighbors = 0;
                for &cell in &plain {
                    mls.survey(&cells.bounds(cell), &mut around);
                    for at in points(cell) {
                        mls.evaluate_surveyed(at, at, Derivatives::First, &mut around, &mut shape).unwrap();
                        n_neighbors += shape.neighbors.len();
                        black_box(&shape);
                    }
                }
            });
        });
        println!("{name}: {:.1} neighbors a point", n_neighbors as f64 / n_points as f64);
    }
    group.finish();
}

/// A square with a crack to its middle, on a grid that the crack runs between.
fn near_tip(cracks: CrackSmoothing) -> Discretization {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(Vector2::from);
    let outline = (0..4).map(|k| Curve::Line { start: corners[k], end: corners[(k + 1) % 4] }).collect();
    let mut model = Model::plain(Domain::new(outline, vec![]));
    let vertices = vec![Vector2::new(-1.0, 0.0), Vector2::zeros()];
    model.cracks.push(CrackPath { name: "crack".into(), vertices, ends: [EndKind::Mouth, EndKind::Tip] });
    let mut settings = Settings::default();
    settings.nodes.layout = Layout::Structured(Structured { nx: 40, ny: 40 });
    settings.approximation.smoothing = SmoothingSettings { cracks: Some(cracks), holes: None };
    discretize(&model, &settings, &mut Silent).expect("the grid is dense enough")
}

/// Neighbors and weights of the points of the 8 x 8 cells around a tip, cell by cell.
fn bench_near_tip(c: &mut Criterion) {
    let mut group = c.benchmark_group("gather_near_tip");
    for (name, cracks) in [
        ("visibility", CrackSmoothing::Visibility),
        ("diffraction", CrackSmoothing::Diffraction { lambda: 2.0 }),
        ("transparency", CrackSmoothing::Transparency { kappa: 0.5, lambda: 2.0 }),
        ("see-through", CrackSmoothing::SeeThrough),
    ] {
        let discrete = near_tip(cracks);
        let cells: Vec<Vec<Vector2>> = (0..discrete.cells.len())
            .map(|i| {
                discrete.cells.points[as_usize(&discrete.cells.point_ranges[i])].iter().map(|p| p.position).collect()
            })
            .filter(|points: &Vec<Vector2>| points.iter().all(|p| p.amax() < 4.0 / 19.5))
            .collect();
        let mut around = Surroundings::default();
        group.throughput(Throughput::Elements(cells.iter().map(|c| c.len() as u64).sum()));
        group.bench_function(name, |b| {
            b.iter(|| {
                for cell in &cells {
                    discrete.approximation.survey(&Aabb::of_points(cell.iter().copied()), &mut around);
                    for &at in cell {
                        discrete.approximation.gather(at, at, Derivatives::First, &mut around);
                        black_box(&around.near);
                    }
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, bench, bench_cells, bench_near_tip);
criterion_main!(benches);
