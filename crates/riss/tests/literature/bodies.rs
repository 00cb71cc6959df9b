//! Bodies with cracks that several tests share.

use riss::analysis::{Settings, Silent, StaticResult, TipRecord, linear_static};
use riss::crack::{CrackPath, EndKind};
use riss::exact::CrackTipField;
use riss::geometry::curve::Curve;
use riss::math::Vector2;
use riss::model::{
    BoundaryLoad, BoundarySupport, Direction, Domain, Model, PrescribedValue, RigidMotion, TractionValue,
};
use std::sync::Arc;

/// Straight edges between the points, closed.
pub fn outline(points: &[[f64; 2]]) -> Vec<Curve> {
    let point = |k: usize| Vector2::from(points[k % points.len()]);
    (0..points.len()).map(|k| Curve::Line { start: point(k), end: point(k + 1) }).collect()
}

/// Bottom, right, top and left edge, each a part, and round holes `[x, y, radius]`.
pub fn rectangle(lower: [f64; 2], upper: [f64; 2], holes: &[[f64; 3]]) -> Domain {
    let corners = [lower, [upper[0], lower[1]], upper, [lower[0], upper[1]]];
    let holes = holes.iter().map(|&[x, y, r]| vec![Curve::circle(Vector2::new(x, y), r)]).collect();
    let mut domain = Domain::new(outline(&corners), holes);
    for (edge, name) in ["bottom", "right", "top", "left"].into_iter().enumerate() {
        domain.add_part(name, vec![edge]);
    }
    domain
}

/// A crack along the points, from a mouth on the boundary to a tip.
pub fn edge_crack(points: &[[f64; 2]]) -> CrackPath {
    CrackPath { ends: [EndKind::Mouth, EndKind::Tip], ..inner_crack(points) }
}

/// A crack along the points, with a tip at both ends.
pub fn inner_crack(points: &[[f64; 2]]) -> CrackPath {
    CrackPath {
        name: "crack".into(),
        vertices: points.iter().map(|p| Vector2::from(*p)).collect(),
        ends: [EndKind::Tip; 2],
    }
}

/// A free body under the traction of a uniform stress, tension in y.
pub fn pulled(domain: Domain, cracks: Vec<CrackPath>, tension: f64) -> Model {
    let mut model = Model { cracks, rigid_motion: RigidMotion::MeanIsZero, ..Model::plain(domain) };
    for (part, traction) in [(0, -tension), (2, tension)] {
        let value = TractionValue::Components([0.0.into(), traction.into()]);
        model.loads.push(BoundaryLoad { part: Some(part), value });
    }
    model
}

/// The square `[-1, 1]²` with the displacement of a crack-tip field on its whole boundary, and the field's crack.
///
/// `mouth` is where the straight crack behind the tip leaves the square.
pub fn near_tip_square(field: CrackTipField, mouth: [f64; 2]) -> Model {
    let mut domain = rectangle([-1.0, -1.0], [1.0, 1.0], &[]);
    let whole = domain.add_part("whole", vec![0, 1, 2, 3]);
    let crack = edge_crack(&[mouth, [field.tip.x, field.tip.y]]);
    let mut model = Model { cracks: vec![crack], exact: Some(Arc::new(field)), ..Model::plain(domain) };
    for direction in [Direction::X, Direction::Y] {
        let value = PrescribedValue::Exact(Arc::new(field));
        model.supports.push(BoundarySupport { part: whole, direction, value });
    }
    model
}

/// The result of a run.
pub fn solve(model: &Model, settings: &Settings) -> StaticResult {
    linear_static(model, settings, &mut Silent).unwrap_or_else(|e| panic!("{e}"))
}

/// All tips of a result.
pub fn tips(result: &StaticResult) -> Vec<&TipRecord> {
    result.step.cracks.iter().flat_map(|c| &c.tips).collect()
}
