//! Loads: tractions, pressures, uniform stress, body force and forces at points.

use super::outline::vector;
use super::report::Report;
use crate::case::expression::Expression;
use crate::case::schema::{BodyForce, CaseFile, Load, Names, Scalar, Stress};
use crate::exact::ExactField;
use crate::material::Elasticity;
use crate::math::{Matrix2, Vector2};
use crate::model::{self, BoundaryLoad, Domain, EdgeId, FieldPoint, PartId, PointLoad, ScalarField, TractionValue};
use std::sync::Arc;

/// Points per edge at which fields are tried.
const SAMPLES: usize = 9;
/// Most parts in one list.
const MAX_NAMES: usize = 1000;
/// A point this far outside the body, times its size, still belongs to it.
const OFF_BODY: f64 = 1e-6;

/// What conditions are built from.
pub(super) struct Setting<'a> {
    pub domain: Domain,
    pub material: Elasticity,
    pub exact: Option<Arc<dyn ExactField>>,
    pub file: &'a CaseFile,
}

/// A field and the largest absolute value met while trying it.
pub(super) struct Tried {
    pub field: ScalarField,
    pub largest: f64,
    pub least: f64,
}

impl Setting<'_> {
    /// Parts by name; `None` stands for the whole outline.
    pub fn parts(&self, names: &Names, key: &str, report: &mut Report) -> Vec<Option<PartId>> {
        let list: Vec<(&String, String)> = match names {
            Names::One(name) => vec![(name, key.to_string())],
            Names::Many(list) => list.iter().enumerate().map(|(k, n)| (n, format!("{key}[{k}]"))).collect(),
        };
        if list.is_empty() || list.len() > MAX_NAMES {
            report.error(key, format!("{} parts are named", list.len())).allow(format!("1 to {MAX_NAMES}"));
            return vec![];
        }
        let mut parts = vec![];
        for (name, key) in list {
            if name == super::OUTLINE {
                parts.push(None);
            } else if let Some(part) = self.domain.parts.iter().position(|p| p.name == *name) {
                parts.push(Some(part));
            } else {
                let names = self.domain.parts.iter().map(|p| p.name.as_str()).chain([super::OUTLINE]);
                report.error(key, "unknown part").one_of(name, names);
            }
        }
        parts
    }

    /// Edges of a part.
    pub fn edges(&self, part: Option<PartId>) -> Vec<EdgeId> {
        part.map_or(self.domain.outline().collect(), |p| self.domain.parts[p].edges.clone())
    }

    /// A field that is finite on the given edges.
    pub fn field(&self, scalar: &Scalar, key: &str, edges: &[EdgeId], report: &mut Report) -> Option<Tried> {
        let points = edges.iter().flat_map(|&e| {
            let curve = self.domain.edges[e];
            (0..SAMPLES).map(move |k| {
                let t = k as f64 / (SAMPLES - 1) as f64;
                FieldPoint { position: curve.point(t), normal: curve.right_normal(t) }
            })
        });
        try_field(scalar, key, points, report)
    }

    /// The exact field, if `wanted` says so.
    pub fn exact(&self, wanted: Option<bool>, key: &str, report: &mut Report) -> Option<Arc<dyn ExactField>> {
        if wanted == Some(true) && self.exact.is_none() && self.file.exact.is_none() {
            report.error(format!("{key}.exact"), "there is no [exact] section to take the values from");
        }
        self.exact.clone().filter(|_| wanted == Some(true))
    }

    /// Reports a point that is not in the body.
    pub fn check_point(&self, at: Vector2, key: &str, report: &mut Report) -> bool {
        let near = OFF_BODY * self.domain.aabb().size().norm();
        let inside = self.domain.contains(at) || self.domain.distance_to_boundary(at) <= near;
        if !inside {
            report.error(key, "this point lies outside the body");
        }
        inside
    }
}

/// The field that a number or expression stands for.
pub(super) fn field(scalar: &Scalar, key: &str, report: &mut Report) -> Option<ScalarField> {
    let text = match scalar {
        Scalar::Number(value) => return Some(ScalarField::Constant(*value)),
        Scalar::Expression(text) => text,
    };
    match Expression::parse(text) {
        Ok(expression) => Some(match expression.constant() {
            Some(value) => ScalarField::Constant(value),
            None => ScalarField::Function(Arc::new(move |at| expression.value(at))),
        }),
        Err(bad) => {
            let problem = report.error(key, bad.message);
            if let Some((name, names)) = bad.unknown {
                problem.one_of(&name, names);
            }
            None
        }
    }
}

/// A field that is finite at the given points.
pub(super) fn try_field(
    scalar: &Scalar,
    key: &str,
    points: impl Iterator<Item = FieldPoint>,
    report: &mut Report,
) -> Option<Tried> {
    let field = field(scalar, key, report)?;
    let mut tried = Tried { field, largest: 0.0, least: f64::INFINITY };
    for at in points {
        let value = tried.field.value(&at);
        if !value.is_finite() {
            let p = at.position;
            report.error(key, format!("is not finite: {value} at ({:.6}, {:.6})", p.x, p.y));
            return None;
        }
        tried.largest = tried.largest.max(value.abs());
        tried.least = tried.least.min(value);
    }
    Some(tried)
}

/// All loads of a case.
#[derive(Default)]
pub(super) struct Loads {
    pub boundary: Vec<BoundaryLoad>,
    pub body_force: Option<model::BodyForce>,
    pub points: Vec<PointLoad>,
    /// Whether any of them differs from zero.
    pub acts: bool,
}

pub(super) fn loads(setting: &Setting, report: &mut Report) -> Loads {
    let file = setting.file;
    let mut loads = Loads::default();
    for (index, load) in file.load.iter().enumerate() {
        add_load(setting, load, &format!("load[{index}]"), &mut loads, report);
    }
    if let Some(stress) = &file.remote_stress {
        loads.acts |= tensor(stress).amax() > 0.0;
        loads.boundary.push(BoundaryLoad { part: None, value: TractionValue::UniformStress(tensor(stress)) });
    }
    if let Some(force) = &file.body_force {
        add_body_force(setting, force, &mut loads, report);
    }
    for (index, load) in file.point_load.iter().enumerate() {
        let at = vector(load.at);
        setting.check_point(at, &format!("point_load[{index}].at"), report);
        loads.acts |= vector(load.force).amax() > 0.0;
        loads.points.push(PointLoad { at, force: vector(load.force) });
    }
    loads
}

fn tensor(s: &Stress) -> Matrix2 {
    Matrix2::new(s.xx, s.xy, s.xy, s.yy)
}

fn add_load(setting: &Setting, load: &Load, key: &str, loads: &mut Loads, report: &mut Report) {
    let given = [
        ("traction", load.traction.is_some()),
        ("pressure", load.pressure.is_some()),
        ("stress", load.stress.is_some()),
        ("exact", load.exact == Some(true)),
    ];
    let names: Vec<&str> = given.iter().filter(|g| g.1).map(|g| g.0).collect();
    let parts = setting.parts(&load.on, &format!("{key}.on"), report);
    if names.len() != 1 {
        let found = if names.is_empty() { "nothing".to_string() } else { names.join(" and ") };
        report
            .error(key, format!("a load says one thing, this one gives {found}"))
            .allow("traction, pressure, stress or exact = true");
        return;
    }
    for part in parts {
        let edges = setting.edges(part);
        if let Some(value) = traction(setting, load, key, &edges, loads, report) {
            loads.boundary.push(BoundaryLoad { part, value });
        } else {
            // The same mistake once, not once for each part.
            break;
        }
    }
}

fn traction(
    setting: &Setting,
    load: &Load,
    key: &str,
    edges: &[EdgeId],
    loads: &mut Loads,
    report: &mut Report,
) -> Option<TractionValue> {
    if let Some([x, y]) = &load.traction {
        let x = setting.field(x, &format!("{key}.traction[0]"), edges, report);
        let y = setting.field(y, &format!("{key}.traction[1]"), edges, report);
        let (x, y) = (x?, y?);
        loads.acts |= x.largest.max(y.largest) > 0.0;
        return Some(TractionValue::Components([x.field, y.field]));
    }
    if let Some(pressure) = &load.pressure {
        let p = setting.field(pressure, &format!("{key}.pressure"), edges, report)?;
        loads.acts |= p.largest > 0.0;
        return Some(TractionValue::Pressure(p.field));
    }
    if let Some(stress) = &load.stress {
        loads.acts |= tensor(stress).amax() > 0.0;
        return Some(TractionValue::UniformStress(tensor(stress)));
    }
    loads.acts = true;
    setting.exact(load.exact, key, report).map(TractionValue::Exact)
}

fn add_body_force(setting: &Setting, force: &BodyForce, loads: &mut Loads, report: &mut Report) {
    // Tried on the boundary; `nx` and `ny` are zero inside the body.
    let points = || {
        let edges = setting.domain.edges.iter();
        edges.map(|c| FieldPoint { position: c.point(0.5), normal: Vector2::zeros() })
    };
    let mut component = |scalar: &Option<Scalar>, key: &str| {
        let scalar = scalar.clone().unwrap_or(Scalar::Number(0.0));
        try_field(&scalar, &format!("body_force.{key}"), points(), report)
    };
    let (x, y) = (component(&force.x, "x"), component(&force.y, "y"));
    if let (Some(x), Some(y)) = (x, y) {
        loads.acts |= x.largest.max(y.largest) > 0.0;
        loads.body_force = Some(model::BodyForce([x.field, y.field]));
    }
}
