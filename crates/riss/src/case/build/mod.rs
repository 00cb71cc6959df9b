//! From what the case says to the checked model; every problem is reported, none is guessed away.

mod boundary;
pub(super) mod boxes;
mod cohesive;
mod cracks;
mod crossings;
mod exact;
mod growth;
mod import;
mod loads;
mod mesh;
mod method;
mod outline;
mod parts;
pub(super) mod plausibility;
pub(super) mod report;
mod settings;
pub(super) mod softening;
mod supports;

use super::abaqus::AbaqusModel;
use super::document::Document;
use super::files::Files;
use super::problem::Problem;
use super::schema::{self, CaseFile, OutputSettings};
use crate::analysis::{GrowthSettings, LoadingSettings, Settings};
use crate::material::Elasticity;
use crate::model::{Domain, Model, RigidMotion, UnitNames};
use boundary::Boundary;
use loads::Setting;
use report::Report;
use std::path::Path;

/// The name that stands for every outer edge.
const OUTLINE: &str = "outline";

/// What a case means.
pub(super) struct Built {
    pub model: Model,
    pub settings: Settings,
    pub growth: Option<GrowthSettings>,
    pub loading: Option<LoadingSettings>,
    pub output: OutputSettings,
    pub units: Option<UnitNames>,
    pub notes: Vec<Problem>,
}

/// What a case means; `None` or more problems if it is not valid.
pub(super) fn build(document: &mut Document, path: &Path, problems: &mut Vec<Problem>) -> Option<Built> {
    let schema = super::plain_schema();
    let values = super::values::resolve(document, &schema, problems);
    let files = Files::of(document, path);
    let imported = import::import(document, &files, problems)?;
    let document = &*document;
    let mut faulty = super::check::check(document, &schema, problems);
    faulty.extend(values.faulty);
    let mut file: CaseFile = document.without(&faulty, &PLACEHOLDERS, problems)?;
    let mut report = Report::new(document, problems);
    for remark in imported.iter().flat_map(|m| &m.remarks) {
        report.note(import::KEY, remark);
    }
    method::complete(&mut file, &mut report);
    let material = material(&file.material, &mut report);
    let exact = file.exact.as_ref().and_then(|e| exact::exact(e, &mut report));
    let mut settings = settings::settings(&file, &files, &mut report);
    if ["geometry", "hole", "part"].iter().any(|key| faulty.contains(*key)) {
        return None;
    }
    let domain = domain(&file, imported.as_ref(), &files, &mut report)?;
    settings::check_layout(&mut settings, &file, &domain, &mut report);
    let cracks = cracks::cracks(&file.crack, &domain, &mut report);
    if let Some(contact) = &file.contact {
        report.positive("contact.penalty", contact.penalty);
    }
    let (cohesive, loading) = cohesive::cohesive(&file, cracks.cohesive, &mut report).unzip();
    let mut setting = Setting { domain, material, exact, file: &file };
    let loads = loads::loads(&setting, &mut report);
    let supports = supports::supports(&mut setting, &mut report);
    // What a faulty section may have said is not held against the rest.
    let sound = |keys: &[&str]| keys.iter().all(|key| !faulty.contains(*key)) && report.problems.is_empty();
    if sound(&[]) {
        supports::check_held(&setting, &supports, &mut report);
        if !loads.acts && !supports.acts && !cracks.acts {
            let mut problem = Problem::new("load", "nothing loads the body");
            problem
                .suggest("add a [[load]], [remote_stress], [[point_load]], [body_force], a prescribed displacement or a pressure in a crack");
            report.problems.push(problem);
        }
    }
    let model = Model {
        title: file.title.clone().unwrap_or_else(|| default_title(path)),
        thickness: file.material.thickness.unwrap_or(1.0),
        thickness_is_given: file.material.thickness.is_some(),
        yield_stress: file.material.yield_stress,
        rigid_motion: match file.rigid_motion {
            schema::RigidMotion::Supported => RigidMotion::Supported,
            schema::RigidMotion::MeanIsZero => RigidMotion::MeanIsZero,
        },
        domain: setting.domain,
        material,
        cracks: cracks.paths,
        crack_face_loads: cracks.face_loads,
        cohesive,
        contact: file.contact,
        loads: loads.boundary,
        body_force: loads.body_force,
        point_loads: loads.points,
        supports: supports.boundary,
        point_supports: supports.points,
        springs: supports.springs,
        exact: setting.exact,
    };
    if let Some(growth) = &file.growth {
        growth::check(growth, &model, &mut report);
    }
    for name in values.unused {
        report.note(format!("parameters.{name}"), "nothing uses this parameter");
    }
    if let Some(units) = &values.units {
        plausibility::check(&file, units, &mut report);
    }
    let (output, notes) = (file.output, report.notes);
    Some(Built { model, settings, growth: file.growth, loading, output, units: values.units.map(|u| u.names), notes })
}

/// Name of the file, or of its folder if the file is just called case.toml.
pub(super) fn default_title(path: &Path) -> String {
    let stem = path.file_stem().map_or("case".into(), |s| s.to_string_lossy().into_owned());
    let folder = path.parent().and_then(Path::file_name).map(|s| s.to_string_lossy().into_owned());
    if stem == "case" { folder.unwrap_or(stem) } else { stem }
}

/// Stand for required sections that are faulty.
const PLACEHOLDERS: [(&str, &str); 2] = [
    ("material", "young = 1\npoisson = 0.3\nplane = 'strain'"),
    ("geometry", "rectangle = { lower = [0, 0], upper = [1, 1] }"),
];

fn material(m: &schema::Material, report: &mut Report) -> Elasticity {
    report.positive("material.young", m.young);
    if !(m.poisson > -1.0 && m.poisson < 0.5) {
        report.error("material.poisson", "out of range").allow("above -1 and below 0.5");
    }
    if let Some(thickness) = m.thickness {
        report.positive("material.thickness", thickness);
    }
    if let Some(yield_stress) = m.yield_stress {
        report.positive("material.yield_stress", yield_stress);
    }
    Elasticity { young: m.young, poisson: m.poisson, plane: m.plane }
}

fn domain(file: &CaseFile, imported: Option<&AbaqusModel>, files: &Files, report: &mut Report) -> Option<Domain> {
    let mut boundary = Boundary::default();
    let added = match imported {
        Some(model) => mesh::add_domain(&mut boundary, &model.domain, import::KEY, report),
        None => outline::add_outline(&mut boundary, &file.geometry, files, report),
    };
    let mut sound = added.is_some();
    for (index, hole) in file.hole.iter().enumerate() {
        sound &= outline::add_hole(&mut boundary, hole, index, report).is_some();
    }
    if !sound || !crossings::check_loops(&boundary, report) {
        return None;
    }
    for (index, part) in file.part.iter().enumerate() {
        sound &= parts::add_part(&mut boundary, part, index, report).is_some();
    }
    sound.then(|| boundary.into_domain())
}
