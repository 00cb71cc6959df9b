//! Loads, supports and known solutions of a solid.

use super::body::BOUNDARY;
use super::exact::exact;
use super::schema::{SolidFile, SolidLoad, SolidStress, SolidSupport};
use crate::case::Problem;
use crate::case::build::report::Report;
use crate::case::expression::Expression;
use crate::case::schema::{Names, RigidMotion, Scalar};
use crate::exact::CrackFrontField;
use crate::geometry::surface::Surface;
use crate::material::Elasticity;
use crate::math::{Matrix, Vector3};
use crate::model::{DirectedDisplacement, SolidDirection, SurfaceConditions, SurfacePoint, VectorField};
use std::sync::Arc;

/// What acts on the body.
pub(super) struct Conditions {
    pub parts: Vec<SurfaceConditions<3>>,
    pub body_force: VectorField<3>,
    /// Whether anything but zero is prescribed.
    pub acts: bool,
}

/// A number that may depend on place and normal.
#[derive(Clone)]
enum Field {
    Constant(f64),
    Function(Expression),
}

impl Field {
    fn value(&self, at: &SurfacePoint<3>) -> f64 {
        match self {
            Self::Constant(v) => *v,
            Self::Function(f) => f.value_in_space(at.position, at.normal),
        }
    }

    fn is_zero(&self) -> bool {
        matches!(self, Self::Constant(0.0))
    }
}

struct Builder<'a> {
    body: &'a Surface,
    exact: Option<CrackFrontField>,
    material: Elasticity,
    parts: Vec<SurfaceConditions<3>>,
    /// Tractions on each part, to be added.
    tractions: Vec<Vec<VectorField<3>>>,
    acts: bool,
}

pub(super) fn conditions(file: &SolidFile, body: &Surface, material: &Elasticity, report: &mut Report) -> Conditions {
    let n = body.parts().len();
    let exact = file.exact.as_ref().and_then(|e| exact(e, report));
    let mut builder = Builder {
        body,
        exact,
        material: *material,
        parts: vec![SurfaceConditions::free(); n],
        tractions: vec![vec![]; n],
        acts: false,
    };
    for (index, load) in file.load.iter().enumerate() {
        builder.load(load, &format!("load[{index}]"), report);
    }
    if let Some(stress) = &file.remote_stress {
        let tensor = tensor(stress);
        let outer = builder.outer_parts();
        builder.acts |= tensor.norm() > 0.0;
        outer.iter().for_each(|p| builder.tractions[*p].push(traction_of(tensor)));
    }
    for (index, support) in file.support.iter().enumerate() {
        builder.support(support, &format!("support[{index}]"), report);
    }
    let held = builder.parts.iter().any(|p| !p.displacements.is_empty());
    check_held(file, held, report);
    let force = match &file.body_force {
        None => VectorField::zero(),
        Some(b) => builder.vector([b.x.as_ref(), b.y.as_ref(), b.z.as_ref()], ["x", "y", "z"], "body_force", report),
    };
    for (conditions, tractions) in builder.parts.iter_mut().zip(builder.tractions) {
        conditions.traction = sum(tractions);
    }
    Conditions { parts: builder.parts, body_force: force, acts: builder.acts }
}

fn check_held(file: &SolidFile, held: bool, report: &mut Report) {
    match file.rigid_motion {
        RigidMotion::Supported if !held => {
            let mut problem = Problem::new("support", "nothing holds the body");
            problem.suggest("add a [[support]], or rigid_motion = \"mean-is-zero\" if the loads balance");
            report.problems.push(problem);
        }
        // What supports hold stays held: a slab between planes of symmetry is free to move along them.
        RigidMotion::Supported | RigidMotion::MeanIsZero => {}
    }
}

impl Builder<'_> {
    /// Indices of parts by name.
    fn named(&self, names: &Names, key: &str, report: &mut Report) -> Vec<usize> {
        let names = match names {
            Names::One(name) => vec![name],
            Names::Many(names) => names.iter().collect(),
        };
        let mut found = vec![];
        for name in names {
            // Parts of a void share a name.
            let known: Vec<usize> =
                (0..self.parts.len()).filter(|k| name == BOUNDARY || self.body.parts()[*k].name == *name).collect();
            if known.is_empty() {
                let mut all: Vec<&str> = self.body.parts().iter().map(|p| p.name.as_str()).chain([BOUNDARY]).collect();
                all.dedup();
                report.error(key, "unknown part").one_of(name, all);
            }
            found.extend(known);
        }
        found
    }

    /// Parts of the outermost shell: those with a triangle at the side of the box around the body.
    fn outer_parts(&self) -> Vec<usize> {
        let (body, bounds) = (self.body, self.body.bounds());
        let n = body.triangles().len();
        let mut is_outer = vec![false; n];
        let touches = |t: usize| {
            let at_side = |p: Vector3| (0..3).any(|d| p[d] == bounds.lower[d] || p[d] == bounds.upper[d]);
            body.corners(t as u32).into_iter().any(at_side)
        };
        let mut stack: Vec<usize> = (0..n).filter(|t| touches(*t)).collect();
        while let Some(t) = stack.pop() {
            if !std::mem::replace(&mut is_outer[t], true) {
                stack.extend((0..3).filter_map(|k| body.across(t as u32, k)).map(|t| t as usize));
            }
        }
        let on_part = |p: &usize| (0..n).any(|t| is_outer[t] && body.part_of(t as u32) as usize == *p);
        (0..self.parts.len()).filter(on_part).collect()
    }

    fn load(&mut self, load: &SolidLoad, key: &str, report: &mut Report) {
        let parts = self.named(&load.on, &format!("{key}.on"), report);
        let traction = match (&load.traction, &load.pressure, &load.stress, load.exact) {
            (Some(t), None, None, None) => {
                self.vector([Some(&t[0]), Some(&t[1]), Some(&t[2])], ["traction"; 3], key, report)
            }
            (None, Some(p), None, None) => {
                let Some(pressure) = field(p, &format!("{key}.pressure"), report) else { return };
                self.acts |= !pressure.is_zero();
                VectorField::Function(Arc::new(move |at| at.normal * -pressure.value(at)))
            }
            (None, None, Some(stress), None) => {
                let stress = tensor(stress);
                self.acts |= stress.norm() > 0.0;
                traction_of(stress)
            }
            (None, None, None, Some(true)) => {
                let Some(exact) = self.known(key, report) else { return };
                let material = self.material;
                VectorField::Function(Arc::new(move |at| {
                    let gradient = exact.evaluate(&material, at.position, at.sight).1;
                    (gradient + gradient.transpose()) * material.shear() * at.normal
                        + at.normal * (material.lame() * gradient.trace())
                }))
            }
            _ => {
                report
                    .error(key, "a load is one of several kinds")
                    .allow("one of `traction`, `pressure`, `stress`, `exact = true`");
                return;
            }
        };
        parts.iter().for_each(|p| self.tractions[*p].push(traction.clone()));
    }

    fn support(&mut self, support: &SolidSupport, key: &str, report: &mut Report) {
        let parts = self.named(&support.on, &format!("{key}.on"), report);
        let axes = [(&support.x, "x"), (&support.y, "y"), (&support.z, "z")];
        let mut found = vec![];
        for (d, (scalar, name)) in axes.into_iter().enumerate() {
            let Some(scalar) = scalar else { continue };
            let Some(value) = field(scalar, &format!("{key}.{name}"), report) else { return };
            self.acts |= !value.is_zero();
            let direction = Vector3::ith(d, 1.0);
            let value = VectorField::Function(Arc::new(move |at: &SurfacePoint<3>| direction * value.value(at)));
            found.push(DirectedDisplacement { direction: SolidDirection::Fixed(direction), value });
        }
        if let Some(scalar) = &support.normal {
            let Some(value) = field(scalar, &format!("{key}.normal"), report) else { return };
            self.acts |= !value.is_zero();
            let value = VectorField::Function(Arc::new(move |at: &SurfacePoint<3>| at.normal * value.value(at)));
            found.push(DirectedDisplacement { direction: SolidDirection::Normal, value });
        }
        if found.is_empty() != (support.exact == Some(true)) {
            let message =
                if found.is_empty() { "no direction is given" } else { "`exact` already gives all components" };
            report.error(key, message).allow("x, y, z, normal, or exact = true");
            return;
        }
        if support.exact == Some(true) {
            let Some(exact) = self.known(key, report) else { return };
            let material = self.material;
            let value = VectorField::Function(Arc::new(move |at: &SurfacePoint<3>| {
                exact.evaluate(&material, at.position, at.sight).0
            }));
            found = SurfaceConditions::displacement(value).displacements;
        }
        for part in parts {
            if !self.parts[part].displacements.is_empty() {
                let name = &self.body.parts()[part].name;
                report
                    .error(format!("{key}.on"), format!("part `{name}` already has a support"))
                    .suggest("join them in one");
                return;
            }
            self.parts[part].displacements = found.clone();
        }
    }

    /// The known solution.
    fn known(&mut self, key: &str, report: &mut Report) -> Option<CrackFrontField> {
        if self.exact.is_none() {
            report.error(format!("{key}.exact"), "there is no sound [exact] section to take the values from");
        }
        self.acts = true;
        self.exact
    }

    fn vector(
        &mut self,
        scalars: [Option<&Scalar>; 3],
        names: [&str; 3],
        key: &str,
        report: &mut Report,
    ) -> VectorField<3> {
        let mut fields = [const { Field::Constant(0.0) }; 3];
        for d in 0..3 {
            let Some(scalar) = scalars[d] else { continue };
            if let Some(found) = field(scalar, &format!("{key}.{}", names[d]), report) {
                self.acts |= !found.is_zero();
                fields[d] = found;
            }
        }
        if let [Field::Constant(x), Field::Constant(y), Field::Constant(z)] = fields {
            return VectorField::Constant(Vector3::new(x, y, z));
        }
        VectorField::Function(Arc::new(move |at| Vector3::from_fn(|d, _| fields[d].value(at))))
    }
}

fn field(scalar: &Scalar, key: &str, report: &mut Report) -> Option<Field> {
    let text = match scalar {
        Scalar::Number(value) => return Some(Field::Constant(*value)),
        Scalar::Expression(text) => text,
    };
    match Expression::parse_in_space(text) {
        Ok(expression) => Some(expression.constant().map_or(Field::Function(expression), Field::Constant)),
        Err(bad) => {
            let problem = report.error(key, bad.message);
            if let Some((name, names)) = bad.unknown {
                problem.one_of(&name, names);
            }
            None
        }
    }
}

fn tensor(s: &SolidStress) -> Matrix<3> {
    Matrix::<3>::new(s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz)
}

fn traction_of(stress: Matrix<3>) -> VectorField<3> {
    VectorField::Function(Arc::new(move |at| stress * at.normal))
}

fn sum(mut tractions: Vec<VectorField<3>>) -> VectorField<3> {
    match tractions.len() {
        0 => VectorField::zero(),
        1 => tractions.remove(0),
        _ => VectorField::Function(Arc::new(move |at| tractions.iter().map(|t| t.value(at)).sum())),
    }
}
