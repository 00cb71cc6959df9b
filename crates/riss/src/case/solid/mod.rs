//! Cases of solids: `method = "collocation"`.
//!
//! Reading order: [`schema`] (what may be written), [`body`] and [`stl`] (geometry), [`cracks`], [`exact`], [`conditions`], [`nodes`],
//! [`growth`], [`cohesive`].

mod body;
mod cohesive;
mod conditions;
mod cracks;
mod exact;
mod growth;
mod nodes;
pub(super) mod schema;
mod stl;
#[cfg(test)]
mod tests;

use super::build::plausibility::{check_load, check_young};
use super::build::report::Report;
use super::document::{Content, Document};
use super::files::Files;
use super::problem::{self, CaseErrors, Problem};
use super::schema::Scalar;
use super::units::UnitSystem;
use super::{Case, MAX_BYTES, read_text};
use crate::analysis::{LoadingSettings, SolidGrowthSettings, SolidSettings};
use crate::material::{Elasticity, PlaneState};
use crate::model::{RigidMotion, Solid, SolidModel, UnitNames};
use crate::system::collocation::LARGEST_POISSON;
use schema::{SolidFile, SolidStress};
use std::path::{Path, PathBuf};
pub use stl::read_stl;

/// A case of any method.
#[derive(Clone, Debug)]
pub enum AnyCase {
    /// A body in the plane.
    Plane(Box<Case>),
    /// A solid.
    Solid(Box<SolidCase>),
}

/// A valid case of a solid.
#[derive(Clone, Debug)]
pub struct SolidCase {
    /// The problem.
    pub model: SolidModel,
    /// Numerical choices.
    pub settings: SolidSettings,
    /// How its cracks grow, if they do.
    pub growth: Option<SolidGrowthSettings>,
    /// How far cohesive cracks are loaded, if there are some.
    pub loading: Option<LoadingSettings>,
    /// Units, if the case says them.
    pub units: Option<UnitNames>,
    /// The case file.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// The overrides as they were given.
    pub overrides: Vec<String>,
    /// What the author should know, although the case is valid.
    pub notes: Vec<Problem>,
}

impl AnyCase {
    /// Reads a case file of any method; see [`Case::read`].
    ///
    /// # Errors
    /// All problems of the case, in the order of the file.
    pub fn read(path: &Path, overrides: &[String]) -> Result<Self, CaseErrors> {
        let Ok(text) = read_text(path, MAX_BYTES) else {
            return Case::read(path, overrides).map(|c| Self::Plane(Box::new(c)));
        };
        Self::parse(&text, path, overrides)
    }

    /// Like [`AnyCase::read`] with the text at hand; files that it names are sought beside `path`.
    ///
    /// # Errors
    /// All problems of the case, in the order of the file.
    pub fn parse(text: &str, path: &Path, overrides: &[String]) -> Result<Self, CaseErrors> {
        let document = Document::parse(text, overrides, &mut vec![]);
        let is_solid = |n: &super::document::Node| matches!(&n.content, Content::Text(t) if t == "collocation");
        if document.root.get("method").is_some_and(is_solid) {
            SolidCase::parse(text, path, overrides).map(|c| Self::Solid(Box::new(c)))
        } else {
            Case::parse(text, path, overrides).map(|c| Self::Plane(Box::new(c)))
        }
    }
}

impl SolidCase {
    /// Reads the text of a case of a solid.
    ///
    /// # Errors
    /// All problems of the case, in the order of the file.
    pub fn parse(text: &str, path: &Path, overrides: &[String]) -> Result<Self, CaseErrors> {
        let mut problems = vec![];
        let mut document = Document::parse(text, overrides, &mut problems);
        let built = if problems.is_empty() { build(&mut document, path, &mut problems) } else { None };
        match built {
            Some(Built { model, settings, growth, loading, units, notes }) if problems.is_empty() => {
                let (path, text, overrides) = (path.into(), text.into(), overrides.to_vec());
                Ok(Self { model, settings, growth, loading, units, path, text, overrides, notes })
            }
            _ => {
                problems.sort_by_key(|p| (p.origin, p.span.as_ref().map_or(usize::MAX, |s| s.start)));
                Err(CaseErrors { file: path.into(), text: text.into(), overrides: overrides.to_vec(), problems })
            }
        }
    }

    /// The first key in which the cases differ, besides those of growth; see [`Case::differs_outside_growth`].
    pub fn differs_outside_growth(&self, other: &Self) -> Option<String> {
        super::differing_key([(&self.text, &self.overrides), (&other.text, &other.overrides)])
    }

    /// Where a note stands, such as `case.toml:3:9`.
    pub fn place(&self, note: &Problem) -> String {
        problem::place(&self.path, &self.overrides, note)
    }

    /// Where a key stands; see [`Case::place_of`].
    pub fn place_of(&self, key: &str) -> String {
        let document = Document::parse(&self.text, &self.overrides, &mut vec![]);
        let mut problem = Problem::new(key, "");
        document.locate(&mut problem);
        self.place(&problem)
    }
}

/// The JSON Schema of the case file of a solid.
pub fn solid_json_schema() -> serde_json::Value {
    let mut schema = plain_schema();
    super::allow_texts(&mut schema);
    schema
}

/// The schema with numbers only.
fn plain_schema() -> serde_json::Value {
    schemars::schema_for!(SolidFile).to_value()
}

/// What the file means.
struct Built {
    model: SolidModel,
    settings: SolidSettings,
    growth: Option<SolidGrowthSettings>,
    loading: Option<LoadingSettings>,
    units: Option<UnitNames>,
    notes: Vec<Problem>,
}

fn build(document: &mut Document, path: &Path, problems: &mut Vec<Problem>) -> Option<Built> {
    let schema = plain_schema();
    let values = super::values::resolve(document, &schema, problems);
    let document = &*document;
    let mut faulty = super::check::check(document, &schema, problems);
    faulty.extend(values.faulty);
    let file: SolidFile = document.without(&faulty, &PLACEHOLDERS, problems)?;
    let files = Files::of(document, path);
    let mut report = Report::new(document, problems);
    let material = material(&file, &mut report);
    if ["geometry", "void", "part"].iter().any(|key| faulty.contains(*key)) {
        return None;
    }
    let body = body::body(&file, &files, &mut report)?;
    let cracks = cracks::cracks(&file, &body, &files, &mut report);
    let conditions = conditions::conditions(&file, &body, &material, &mut report);
    let settings = nodes::settings(&file, &body, &cracks, &conditions.parts, &mut report);
    if report.problems.is_empty() && !conditions.acts && !cracks.acts {
        let mut problem = Problem::new("load", "nothing loads the body");
        problem.suggest(
            "add a [[load]], [remote_stress], [body_force], a prescribed displacement or a pressure in a crack",
        );
        report.problems.push(problem);
    }
    let rigid_motion = match file.rigid_motion {
        super::schema::RigidMotion::Supported => RigidMotion::Supported,
        super::schema::RigidMotion::MeanIsZero => RigidMotion::MeanIsZero,
    };
    let solid = Solid {
        material,
        parts: conditions.parts,
        faces: cracks.faces,
        body_force: conditions.body_force,
        rigid_motion,
    };
    let title = file.title.clone().unwrap_or_else(|| super::build::default_title(path));
    let (cohesive, loading) = cohesive::cohesive(&file, cracks.cohesive, &mut report).unzip();
    let mut model = SolidModel {
        title,
        body,
        crack_names: cracks.names,
        cracks: cracks.surfaces,
        yield_stress: file.material.yield_stress,
        solid,
        cohesive,
    };
    let (settings, plan) = settings?;
    nodes::spread_loads(&mut model, &settings.spacing);
    let growth = growth::growth(&file, &model.body, plan, &mut report);
    for name in values.unused {
        report.note(format!("parameters.{name}"), "nothing uses this parameter");
    }
    if let Some(units) = &values.units {
        plausibility(&file, units, &mut report);
    }
    Some(Built { model, settings, growth, loading, units: values.units.map(|u| u.names), notes: report.notes })
}

/// Stand for required sections that are faulty.
const PLACEHOLDERS: [(&str, &str); 2] =
    [("material", "young = 1\npoisson = 0.3"), ("geometry", "box = { lower = [0, 0, 0], upper = [1, 1, 1] }")];

/// Notes what does not look like the units that the case says.
fn plausibility(file: &SolidFile, units: &UnitSystem, report: &mut Report) {
    let young = file.material.young;
    check_young(young, units, report);
    let number = |s: &Scalar| s.number().unwrap_or(0.0).abs();
    let largest = |s: &SolidStress| [s.xx, s.yy, s.zz, s.xy, s.yz, s.xz].map(f64::abs).into_iter().fold(0.0, f64::max);
    for (index, load) in file.load.iter().enumerate() {
        let traction = load.traction.iter().flatten().chain(&load.pressure).map(number).fold(0.0, f64::max);
        let most = load.stress.as_ref().map_or(0.0, largest).max(traction);
        check_load(&format!("load[{index}]"), most, young, &units.names.stress, report);
    }
    let remote = file.remote_stress.as_ref().map_or(0.0, largest);
    check_load("remote_stress", remote, young, &units.names.stress, report);
}

fn material(file: &SolidFile, report: &mut Report) -> Elasticity {
    let m = &file.material;
    report.positive("material.young", m.young);
    if let Some(yield_stress) = m.yield_stress {
        report.positive("material.yield_stress", yield_stress);
    }
    if !(m.poisson > -1.0 && m.poisson <= LARGEST_POISSON) {
        report.error("material.poisson", "out of range").allow(format!("above -1 and up to {LARGEST_POISSON}"));
    }
    Elasticity { young: m.young, poisson: m.poisson, plane: PlaneState::Strain }
}
