//! The case file: text in, checked [`Model`] and [`Settings`] out.
//!
//! Reading order: [`schema`] (what may be written), [`document`] (what was written), [`values`] with [`units`] and
//! [`expression`] (texts that stand for numbers), [`check`] (names and types), [`build`] (geometry and sense). All mistakes are reported together, each at its line.

mod abaqus;
mod build;
mod check;
mod document;
mod effective;
mod expression;
mod files;
pub mod gmsh;
mod problem;
mod schema;
mod solid;
mod units;
mod values;

use crate::analysis::{GrowthSettings, LoadingSettings, Settings};
use crate::model::{Model, UnitNames};
pub use abaqus::{import_abaqus, read_abaqus_as_case};
use build::Built;
use document::Document;
pub use problem::{CaseErrors, Origin, Problem};
pub use schema::OutputSettings;
pub use solid::{AnyCase, SolidCase, read_stl, solid_json_schema};
use std::path::{Path, PathBuf};

/// Larger files are refused.
const MAX_BYTES: u64 = 10_000_000;
/// The same for meshes and node lists.
const MAX_MESH_BYTES: u64 = 500_000_000;

/// A valid case.
///
/// ```
/// let text = "
/// rigid_motion = 'mean-is-zero'
/// material = { young = 210e3, poisson = 0.3, plane = 'strain' }
/// geometry.rectangle = { lower = [0, 0], upper = [100, 200] }
/// crack = [{ path = [[0, 100], [30, 100]] }]
/// remote_stress.yy = 80
/// ";
/// let case = riss::case::Case::parse(text, "case.toml".as_ref(), &[])?;
/// assert_eq!(case.model.cracks[0].length(), 30.0);
/// # Ok::<(), riss::case::CaseErrors>(())
/// ```
#[derive(Clone, Debug)]
pub struct Case {
    /// The problem.
    pub model: Model,
    /// Numerical choices.
    pub settings: Settings,
    /// Crack growth, if the cracks grow.
    pub growth: Option<GrowthSettings>,
    /// How far cohesive cracks are loaded, if there are some.
    pub loading: Option<LoadingSettings>,
    /// What to write.
    pub output: OutputSettings,
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

impl Case {
    /// Reads a case file; `overrides` are `key=value` with a dotted key path, and win over the file.
    ///
    /// # Errors
    /// All problems of the case, in the order of the file.
    pub fn read(path: &Path, overrides: &[String]) -> Result<Self, CaseErrors> {
        match read_text(path, MAX_BYTES) {
            Ok(text) => Self::parse(&text, path, overrides),
            Err(problem) => Err(CaseErrors {
                file: path.into(),
                text: String::new(),
                overrides: overrides.to_vec(),
                problems: vec![*problem],
            }),
        }
    }

    /// Like [`Case::read`] with the text at hand; files that it names are sought beside `path`.
    ///
    /// # Errors
    /// All problems of the case, in the order of the file.
    pub fn parse(text: &str, path: &Path, overrides: &[String]) -> Result<Self, CaseErrors> {
        let mut problems = vec![];
        let mut document = Document::parse(text, overrides, &mut problems);
        let built = if problems.is_empty() { build::build(&mut document, path, &mut problems) } else { None };
        match built {
            Some(Built { model, settings, growth, loading, output, units, notes }) if problems.is_empty() => Ok(Self {
                model,
                settings,
                growth,
                loading,
                output,
                units,
                path: path.into(),
                text: text.into(),
                overrides: overrides.to_vec(),
                notes,
            }),
            _ => {
                if problems.len() >= problem::MAX_PROBLEMS {
                    problems.push(Problem::new("", "there may be more problems; mend these first"));
                }
                problems.sort_by_key(|p| (p.origin, p.span.as_ref().map_or(usize::MAX, |s| s.start)));
                Err(CaseErrors { file: path.into(), text: text.into(), overrides: overrides.to_vec(), problems })
            }
        }
    }

    /// The first top-level key, apart from `files`, `growth`, `output` and `title`, in which another case says something else.
    pub fn differs_outside_growth(&self, other: &Self) -> Option<String> {
        differing_key([(&self.text, &self.overrides), (&other.text, &other.overrides)])
    }

    /// Where a note stands, such as `case.toml:3:9`.
    pub fn place(&self, note: &Problem) -> String {
        problem::place(&self.path, &self.overrides, note)
    }

    /// Where a key stands, such as `case.toml:3:9`; where the case does not say it, the place of what it belongs to.
    pub fn place_of(&self, key: &str) -> String {
        let document = Document::parse(&self.text, &self.overrides, &mut vec![]);
        let mut problem = Problem::new(key, "");
        document.locate(&mut problem);
        self.place(&problem)
    }
}

/// The first key in which two cases with their overrides differ, besides those that may change within a run.
fn differing_key(cases: [(&String, &Vec<String>); 2]) -> Option<String> {
    let [mine, yours] = cases.map(|(text, overrides)| Document::parse(text, overrides, &mut vec![]).to_toml());
    let mut keys: Vec<&String> = mine.keys().chain(yours.keys()).collect();
    keys.sort();
    let may_change = |key: &str| ["files", "growth", "output", "title"].contains(&key);
    keys.into_iter().find(|k| !may_change(k) && mine.get(*k) != yours.get(*k)).cloned()
}

/// The JSON Schema of the case file.
pub fn json_schema() -> serde_json::Value {
    let mut schema = plain_schema();
    allow_texts(&mut schema);
    schema
}

/// The schema with numbers only.
fn plain_schema() -> serde_json::Value {
    schemars::schema_for!(schema::CaseFile).to_value()
}

/// Lets a text stand wherever a number may: a quantity, or an expression of parameters.
fn allow_texts(schema: &mut serde_json::Value) {
    use serde_json::{Value, json};
    match schema {
        Value::Array(list) => list.iter_mut().for_each(allow_texts),
        Value::Object(map) => {
            if let Some(kind) = map.get_mut("type") {
                if *kind == "number" {
                    *kind = json!(["number", "string"]);
                } else if let Value::Array(kinds) = kind
                    && kinds.contains(&json!("number"))
                {
                    kinds.push(json!("string"));
                }
            }
            map.values_mut().for_each(allow_texts);
        }
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {}
    }
}

/// The text of a file.
fn read_text(path: &Path, max_bytes: u64) -> Result<String, Box<Problem>> {
    text_of(read_bytes(path, max_bytes)?)
}

/// Bytes as text.
fn text_of(bytes: Vec<u8>) -> Result<String, Box<Problem>> {
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        Box::new(Problem::new("", format!("the file is not UTF-8 text (first bad byte: number {})", at + 1)))
    })
}

/// The bytes of a file.
fn read_bytes(path: &Path, max_bytes: u64) -> Result<Vec<u8>, Box<Problem>> {
    use std::io::Read;
    let bad = |e: std::io::Error| {
        let reason = match e.kind() {
            std::io::ErrorKind::NotFound => "there is no such file".to_string(),
            std::io::ErrorKind::IsADirectory => "this is a folder, not a file".into(),
            std::io::ErrorKind::PermissionDenied => "no permission to read it".into(),
            _ => e.to_string(),
        };
        Box::new(Problem::new("", format!("cannot read {}: {reason}", path.display())))
    };
    let file = std::fs::File::open(path).map_err(bad)?;
    let mut bytes = vec![];
    // Read through a limit instead of asking for the size, which devices and pipes do not have.
    file.take(max_bytes + 1).read_to_end(&mut bytes).map_err(bad)?;
    if bytes.len() as u64 > max_bytes {
        let message = format!("{} is larger than {} MB", path.display(), max_bytes / 1_000_000);
        return Err(Box::new(Problem::new("", message)));
    }
    Ok(bytes)
}
