//! What an input file of Abaqus or CalculiX adds to a case that does not say it itself.

use crate::case::abaqus::{AbaqusError, AbaqusModel, read_abaqus};
use crate::case::document::{Content, Document};
use crate::case::files::Files;
use crate::case::problem::Problem;

/// Key of the file.
pub(super) const KEY: &str = "geometry.abaqus.file";
/// Sections of which the case's own hold alone if it has any.
const GROUPS: [(&str, &[&str]); 2] = [
    ("supports", &["support", "spring", "rigid_motion"]),
    ("loads", &["load", "point_load", "body_force", "remote_stress"]),
];

/// The model of the file that the case names, if it names one; its tables are put into the document.
pub(super) fn import(
    document: &mut Document,
    files: &Files,
    problems: &mut Vec<Problem>,
) -> Option<Option<AbaqusModel>> {
    let is_wanted =
        document.find("geometry").is_some_and(|n| matches!(&n.content, Content::Table(t) if t.contains_key("abaqus")));
    let Some(Content::Text(file)) = document.find(KEY).map(|n| n.content.clone()).filter(|_| is_wanted) else {
        return Some(None);
    };
    let unread = |e: AbaqusError| Box::new(Problem::new("", e.to_string()));
    match files.bytes(&file).and_then(|bytes| read_abaqus(&bytes).map_err(unread)) {
        Ok(mut model) => {
            let left = add_tables(document, &mut model);
            model.remarks.extend(left);
            Some(Some(model))
        }
        Err(mut problem) => {
            problem.key = KEY.into();
            document.locate(&mut problem);
            problems.push(*problem);
            None
        }
    }
}

/// Adds the tables; says which are left out.
fn add_tables(document: &mut Document, model: &mut AbaqusModel) -> Vec<String> {
    let mut remarks = vec![];
    for (name, keys) in GROUPS {
        let own: Vec<&str> = keys.iter().copied().filter(|k| document.root.contains_key(*k)).collect();
        let given: Vec<&str> = keys.iter().copied().filter(|k| model.tables.contains_key(*k)).collect();
        if let (Some(own), false) = (own.first(), given.is_empty()) {
            remarks.push(format!("the {name} of the file are not taken, because the case has `{own}`"));
            given.into_iter().for_each(|k| drop(model.tables.remove(k)));
        }
    }
    for (key, value) in &model.tables {
        match value {
            // Key by key: a case may name the plane state alone.
            toml::Value::Table(inner) if key == "material" => {
                inner.iter().for_each(|(name, value)| document.add(&[key, name], value, KEY));
            }
            _ => document.add(&[key], value, KEY),
        }
    }
    remarks
}
