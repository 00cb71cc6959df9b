//! Bodies, settings and measures that several test programs share.

#![allow(dead_code, reason = "no test program uses all of it")]

use riss::analysis::{Settings, Silent, StaticResult, discretize, linear_static};
use riss::approximation::moving_least_squares::Derivatives;
use riss::approximation::{ShapeFunctions, Surroundings};
use riss::crack::{CrackPath, EndKind};
use riss::exact::ExactField;
use riss::geometry::curve::Curve;
use riss::material::{Elasticity, PlaneState};
use riss::math::{Matrix2, Vector2};
use riss::model::{BoundarySupport, Direction, Domain, Model, PartId, PrescribedValue, ScalarField};
use riss::nodes::NodeSettings;
use riss::nodes::settings::{Graded, Layout, Listed, Structured};
use std::sync::Arc;

/// Random numbers that repeat (SplitMix64, Steele et al. 2014).
pub struct Random(pub u64);

impl Random {
    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// A closed polygon.
pub fn polygon(corners: &[(f64, f64)]) -> Vec<Curve> {
    let at = |k: usize| Vector2::new(corners[k % corners.len()].0, corners[k % corners.len()].1);
    (0..corners.len()).map(|k| Curve::Line { start: at(k), end: at(k + 1) }).collect()
}

/// The rectangle between two corners with the parts bottom (0), right (1), top (2), left (3) and all (4).
pub fn rectangle(lower: (f64, f64), upper: (f64, f64)) -> Domain {
    let outline = polygon(&[lower, (upper.0, lower.1), upper, (lower.0, upper.1)]);
    with_parts(Domain::new(outline, vec![]), &["bottom", "right", "top", "left"])
}

pub const BOTTOM: PartId = 0;
pub const RIGHT: PartId = 1;
pub const TOP: PartId = 2;
pub const LEFT: PartId = 3;

/// Names the edges one by one; the part after the last is the whole boundary.
pub fn with_parts(mut domain: Domain, names: &[&str]) -> Domain {
    for (edge, name) in names.iter().enumerate() {
        domain.add_part(name, vec![edge]);
    }
    domain.add_part("all", (0..domain.edges.len()).collect());
    domain
}

/// The part that is the whole boundary.
pub fn all(domain: &Domain) -> PartId {
    domain.parts.len() - 1
}

/// A body of modulus 1000 and Poisson's ratio 0.3.
pub fn body(domain: Domain, plane: PlaneState) -> Model {
    Model { material: Elasticity { young: 1000.0, poisson: 0.3, plane }, ..Model::plain(domain) }
}

/// A crack that starts and ends as said.
pub fn crack(vertices: &[(f64, f64)], ends: [EndKind; 2]) -> CrackPath {
    let vertices = vertices.iter().map(|v| Vector2::new(v.0, v.1)).collect();
    CrackPath { name: "crack".into(), vertices, ends }
}

/// Prescribes one component on a part.
pub fn hold(model: &mut Model, part: PartId, direction: Direction, value: f64) {
    let value = PrescribedValue::Field(ScalarField::Constant(value));
    model.supports.push(BoundarySupport { part, direction, value });
}

/// Prescribes the displacement of an exact field on a part.
pub fn hold_exactly(model: &mut Model, part: PartId, directions: &[Direction], field: &Arc<dyn ExactField>) {
    for &direction in directions {
        model.supports.push(BoundarySupport { part, direction, value: PrescribedValue::Exact(field.clone()) });
    }
}

pub const BOTH: [Direction; 2] = [Direction::X, Direction::Y];

/// Graded nodes of a largest spacing.
pub fn graded(spacing: f64) -> NodeSettings {
    let graded = Graded { spacing: Some(spacing), ..Graded::default() };
    NodeSettings { layout: Layout::Graded(graded), star: None }
}

/// Graded nodes, coarser at crack tips than the default.
pub fn graded_to(spacing: f64, tip_spacing: f64) -> NodeSettings {
    let graded = Graded { spacing: Some(spacing), tip_spacing: Some(tip_spacing), growth: Some(0.3) };
    NodeSettings { layout: Layout::Graded(graded), star: None }
}

/// A regular grid.
pub fn structured(nx: usize, ny: usize) -> NodeSettings {
    NodeSettings { layout: Layout::Structured(Structured { nx, ny }), star: None }
}

/// Given nodes.
pub fn listed(positions: Vec<[f64; 2]>) -> NodeSettings {
    NodeSettings { layout: Layout::Listed(Listed { positions }), star: None }
}

/// Random nodes in the box of a body: a jittered grid of `n`×`n`, each node moved by up to 0.45 of the step.
pub fn random_nodes(domain: &Domain, n: usize, seed: u64) -> NodeSettings {
    let (bounds, mut random) = (domain.aabb(), Random(seed));
    let step = bounds.size() / n as f64;
    let mut positions = vec![];
    for i in 0..n {
        for j in 0..n {
            let x = bounds.lower.x + step.x * (i as f64 + 0.5 + random.between(-0.45, 0.45));
            let y = bounds.lower.y + step.y * (j as f64 + 0.5 + random.between(-0.45, 0.45));
            positions.push([x, y]);
        }
    }
    listed(positions)
}

/// The default with given nodes.
pub fn with_nodes(nodes: NodeSettings) -> Settings {
    Settings { nodes, ..Settings::default() }
}

/// Runs a static analysis that must succeed.
pub fn run(model: &Model, settings: &Settings) -> StaticResult {
    linear_static(model, settings, &mut Silent).unwrap_or_else(|e| panic!("{e} with {settings:?}"))
}

/// Largest difference of displacement and stress from an exact field over the vertices of the result.
pub fn differences(model: &Model, field: &dyn ExactField, result: &StaticResult) -> (f64, f64) {
    let f = &result.fields;
    let mut worst = (0.0f64, 0.0f64);
    for ((p, u), s) in f.positions.iter().zip(&f.displacement).zip(&f.stress) {
        worst.0 = worst.0.max((u - field.displacement(&model.material, *p)).norm());
        worst.1 = worst.1.max((s - field.stress(&model.material, *p)).norm());
    }
    worst
}

/// L2 norm of the displacement error over that of the exact displacement; `model.exact` must be known.
pub fn displacement_error(model: &Model, settings: &Settings, result: &StaticResult) -> f64 {
    let exact = model.exact.as_ref().expect("the field is known");
    let discrete = discretize(model, settings, &mut Silent).expect("it was solved on this");
    let parameters = parameters(result);
    let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
    let (mut error, mut size) = (0.0, 0.0);
    for point in &discrete.cells.points {
        let at = point.position;
        let found = discrete.approximation.evaluate(at, at, Derivatives::First, &mut around, &mut shape);
        found.expect("it was solved on this");
        let u = exact.displacement(&model.material, at);
        error += point.weight * (shape.value(&parameters) - u).norm_squared();
        size += point.weight * u.norm_squared();
    }
    (error / size).sqrt()
}

/// Slope of the least squares line through `(ln h, ln error)`.
pub fn rate(table: &[(f64, f64)]) -> f64 {
    let n = table.len() as f64;
    let points: Vec<(f64, f64)> = table.iter().map(|(h, e)| (h.ln(), e.ln())).collect();
    let (sx, sy) = points.iter().fold((0.0, 0.0), |s, p| (s.0 + p.0, s.1 + p.1));
    let (mx, my) = (sx / n, sy / n);
    let (xy, xx) = points.iter().fold((0.0, 0.0), |s, p| (s.0 + (p.0 - mx) * (p.1 - my), s.1 + (p.0 - mx).powi(2)));
    xy / xx
}

/// Sum of the reactions of all parts and points.
pub fn total_reaction(result: &StaticResult) -> Vector2 {
    result.step.reactions.iter().map(|r| r.1).sum()
}

/// Reaction of a part.
pub fn reaction(result: &StaticResult, name: &str) -> Vector2 {
    result.step.reactions.iter().find(|r| r.0 == name).unwrap_or_else(|| panic!("no reaction of {name}")).1
}

/// Displacement at any point, from the nodal parameters.
pub fn displacement_at(model: &Model, settings: &Settings, result: &StaticResult, at: Vector2) -> Vector2 {
    let discrete = discretize(model, settings, &mut Silent).expect("it was solved on this");
    let parameters = parameters(result);
    let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
    let sight = discrete.sight_at(model, at);
    let found = discrete.approximation.evaluate(at, sight, Derivatives::First, &mut around, &mut shape);
    found.expect("it was solved on this");
    shape.value(&parameters)
}

/// Displacement of the vertex of the result nearest to a point.
pub fn displacement_near(result: &StaticResult, at: (f64, f64)) -> Vector2 {
    result.fields.displacement[nearest(result, at)]
}

/// Stress of the vertex of the result nearest to a point.
pub fn stress_near(result: &StaticResult, at: (f64, f64)) -> Matrix2 {
    result.fields.stress[nearest(result, at)]
}

fn nearest(result: &StaticResult, at: (f64, f64)) -> usize {
    let p = Vector2::new(at.0, at.1);
    let positions = &result.fields.positions;
    let distance = |k: &usize| (positions[*k] - p).norm();
    (0..positions.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("there are vertices")
}

/// Nodal parameters, then those of additional functions.
fn parameters(result: &StaticResult) -> Vec<Vector2> {
    result.nodes.iter().map(|n| n.parameters).chain(result.extra_parameters.iter().copied()).collect()
}
