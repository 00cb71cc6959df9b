//! Supports, foundations, and whether anything holds the body.

use super::loads::{Setting, field};
use super::outline::vector;
use super::report::Report;
use crate::case::schema::{RigidMotion, Scalar, Spring, Support};
use crate::math::Vector2;
use crate::model::{self, BoundarySupport, Direction, EdgeId, FieldPoint, PartId, PointSupport, PrescribedValue};
use std::collections::BTreeMap;

/// All supports of a case.
#[derive(Default)]
pub(super) struct Supports {
    pub boundary: Vec<BoundarySupport>,
    pub points: Vec<PointSupport>,
    pub springs: Vec<model::Spring>,
    /// Whether a displacement other than zero is prescribed.
    pub acts: bool,
    /// Directions already prescribed on each edge, and where.
    taken: BTreeMap<EdgeId, Vec<(Direction, usize)>>,
}

pub(super) fn supports(setting: &mut Setting, report: &mut Report) -> Supports {
    let mut supports = Supports::default();
    let file = setting.file;
    for (index, support) in file.support.iter().enumerate() {
        let key = format!("support[{index}]");
        match (&support.on, support.at) {
            (Some(_), None) => add_support(setting, support, index, &mut supports, report),
            (None, Some(at)) => add_point_support(setting, support, vector(at), &key, &mut supports, report),
            _ => {
                report.error(key, "a support is on parts or at a point").allow("either `on` or `at`");
            }
        }
    }
    for (index, spring) in file.spring.iter().enumerate() {
        add_spring(setting, spring, &format!("spring[{index}]"), &mut supports, report);
    }
    supports
}

/// Reports a body that nothing holds, or that is held twice.
pub(super) fn check_held(setting: &Setting, supports: &Supports, report: &mut Report) {
    let held = !supports.boundary.is_empty() || !supports.points.is_empty() || !supports.springs.is_empty();
    match setting.file.rigid_motion {
        RigidMotion::Supported if !held => {
            let mut problem = crate::case::Problem::new("support", "nothing holds the body");
            problem.suggest("add a [[support]], or rigid_motion = \"mean-is-zero\" if the loads balance");
            report.problems.push(problem);
        }
        RigidMotion::MeanIsZero if held => {
            report
                .error("rigid_motion", "the body is held twice, by supports or springs and by its mean motion")
                .suggest("remove one of them");
        }
        _ => {}
    }
}

/// The part with this index; the outline becomes a part when it is first supported.
fn concrete(setting: &mut Setting, part: Option<PartId>) -> PartId {
    let name = super::OUTLINE;
    let known = part.or_else(|| setting.domain.parts.iter().position(|p| p.name == name));
    known.unwrap_or_else(|| {
        let edges = setting.domain.outline().collect();
        setting.domain.add_part(name, edges)
    })
}

fn directions<'s>(
    x: &'s Option<Scalar>,
    y: &'s Option<Scalar>,
    normal: &'s Option<Scalar>,
) -> Vec<(Direction, &'static str, &'s Scalar)> {
    let all = [(Direction::X, "x", x), (Direction::Y, "y", y), (Direction::Normal, "normal", normal)];
    all.into_iter().filter_map(|(d, name, value)| value.as_ref().map(|v| (d, name, v))).collect()
}

fn add_support(setting: &mut Setting, support: &Support, index: usize, supports: &mut Supports, report: &mut Report) {
    let key = format!("support[{index}]");
    let Some(on) = &support.on else { return };
    let parts = setting.parts(on, &format!("{key}.on"), report);
    let given = directions(&support.x, &support.y, &support.normal);
    let is_exact = support.exact == Some(true);
    if given.is_empty() != is_exact {
        let message = if is_exact { "`exact` already gives both components" } else { "no direction is given" };
        report.error(key, message).allow("x, y, normal, or exact = true");
        return;
    }
    for part in parts {
        let edges = setting.edges(part);
        let part = concrete(setting, part);
        let mut push = |direction, value| supports.boundary.push(BoundarySupport { part, direction, value });
        let taken = if is_exact { vec![Direction::X, Direction::Y] } else { given.iter().map(|g| g.0).collect() };
        if is_exact {
            let Some(field) = setting.exact(support.exact, &key, report) else { return };
            push(Direction::X, PrescribedValue::Exact(field.clone()));
            push(Direction::Y, PrescribedValue::Exact(field));
            supports.acts = true;
        }
        for (direction, name, scalar) in &given {
            let Some(tried) = setting.field(scalar, &format!("{key}.{name}"), &edges, report) else { return };
            push(*direction, PrescribedValue::Field(tried.field));
            supports.acts |= tried.largest > 0.0;
        }
        claim(supports, &edges, &taken, index, report);
    }
}

/// Reports directions that are prescribed twice on an edge.
fn claim(supports: &mut Supports, edges: &[EdgeId], directions: &[Direction], index: usize, report: &mut Report) {
    let clash = |a: Direction, b: Direction| a == b || a == Direction::Normal || b == Direction::Normal;
    let key = format!("support[{index}]");
    let normal = directions.contains(&Direction::Normal);
    if normal && directions.len() > 1 {
        report.error(key, "`normal` cannot be combined with x or y on the same part");
        return;
    }
    for edge in edges {
        let taken = supports.taken.entry(*edge).or_default();
        let other = taken.iter().find(|t| directions.iter().any(|d| clash(t.0, *d))).copied();
        if let Some((direction, by)) = other {
            let name = match direction {
                Direction::X => "x",
                Direction::Y => "y",
                Direction::Normal => "normal",
            };
            let what = if by == index {
                "this support names the same edge twice".into()
            } else {
                format!("support[{by}] already prescribes `{name}` on the same edge")
            };
            report.error(key, what);
            return;
        }
        taken.extend(directions.iter().map(|&d| (d, index)));
    }
}

fn add_point_support(
    setting: &Setting,
    support: &Support,
    at: Vector2,
    key: &str,
    supports: &mut Supports,
    report: &mut Report,
) {
    if !setting.check_point(at, &format!("{key}.at"), report) {
        return;
    }
    if support.normal.is_some() {
        report.error(format!("{key}.normal"), "a point has no normal").allow("x, y");
        return;
    }
    let is_exact = support.exact == Some(true);
    if (support.x.is_none() && support.y.is_none()) != is_exact {
        report.error(key, "no direction is given, or one twice").allow("x, y, or exact = true");
        return;
    }
    let mut displacement = [None; 2];
    if is_exact {
        let Some(field) = setting.exact(support.exact, key, report) else { return };
        let u = field.displacement(&setting.material, at);
        displacement = [Some(u.x), Some(u.y)];
    }
    let point = FieldPoint { position: at, normal: Vector2::zeros() };
    for (axis, name, scalar) in [(0, "x", &support.x), (1, "y", &support.y)] {
        let Some(scalar) = scalar else { continue };
        let key = format!("{key}.{name}");
        match field(scalar, &key, report).map(|f| f.value(&point)) {
            Some(value) if value.is_finite() => displacement[axis] = Some(value),
            Some(value) => {
                report.error(key, format!("is not finite: {value} at this point"));
            }
            None => {}
        }
    }
    supports.acts |= displacement.iter().flatten().any(|u| *u != 0.0);
    supports.points.push(PointSupport { at, displacement });
}

fn add_spring(setting: &mut Setting, spring: &Spring, key: &str, supports: &mut Supports, report: &mut Report) {
    let parts = setting.parts(&spring.on, &format!("{key}.on"), report);
    let given = directions(&spring.x, &spring.y, &spring.normal);
    if given.is_empty() {
        report.error(key, "no stiffness is given").allow("x, y, normal");
    }
    for part in parts {
        let edges = setting.edges(part);
        let part = concrete(setting, part);
        for (direction, name, scalar) in &given {
            let key = format!("{key}.{name}");
            let Some(tried) = setting.field(scalar, &key, &edges, report) else { return };
            if tried.least < 0.0 {
                report.error(key, "a stiffness is not negative");
                return;
            }
            supports.springs.push(model::Spring { part, direction: *direction, stiffness: tried.field });
        }
    }
}
