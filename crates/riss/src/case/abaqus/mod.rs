//! Input files of Abaqus and CalculiX as bodies: plane elements, sets, surfaces, and an elastic material with supports
//! and loads.
//!
//! Reads what the manuals of both describe as keywords and data lines [Dhondt2004, Abaqus2016]. No maintained crate reads
//! sets, surfaces and loads of `.inp` files; those that exist stop at nodes and elements. Reading order: `keywords` (lines
//! to blocks), `deck` (what they say), `mesh` (boundary loops and parts), `outline` (lines and arcs), `conditions` (tables
//! of a case).

mod conditions;
mod deck;
mod keywords;
mod mesh;
mod outline;

use crate::model::Domain;
use std::collections::HashSet;
use std::path::Path;

/// What an input file gives to a case.
#[derive(Clone, Debug)]
pub(super) struct AbaqusModel {
    /// The body; its parts are surfaces, sets of nodes and sets of line elements on the boundary.
    pub domain: Domain,
    /// `title`, `material`, `support`, `load`, `point_load` and `body_force`, as far as the file has them.
    pub tables: toml::Table,
    /// What is not read, and what is read otherwise than one might think.
    pub remarks: Vec<String>,
}

/// An input file that cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum AbaqusError {
    /// A line that breaks the format, or says something that has no meaning here.
    #[error("line {line}{}: {problem}", of_keyword(.keyword))]
    Line {
        /// From 1.
        line: usize,
        /// Without its star; empty before the first.
        keyword: String,
        /// What is wrong.
        problem: String,
    },
    /// The file as a whole.
    #[error("{0}")]
    Whole(String),
}

fn of_keyword(keyword: &str) -> String {
    if keyword.is_empty() { String::new() } else { format!(", *{}", keywords::shortened(keyword)) }
}

/// Reads the bytes of an input file; those that are not UTF-8 may stand in comments and names only.
pub(super) fn read_abaqus(bytes: &[u8]) -> Result<AbaqusModel, AbaqusError> {
    let text = String::from_utf8_lossy(bytes);
    let deck = deck::read(&text)?;
    let faces = mesh::Faces::new(&deck);
    let parts = mesh::parts(&deck, &faces)?;
    let model = mesh::model(&deck, &parts)?;
    let domain = into_domain(&model);
    let names: HashSet<String> = domain.parts.iter().map(|p| deck::key(&p.name)).collect();
    let conditions::Imported { tables, mut remarks } = conditions::tables(&deck, &faces, &names)?;
    if !deck.ignored.is_empty() {
        remarks.insert(0, format!("ignored: {}", summary(&deck.ignored)));
    }
    Ok(AbaqusModel { domain, tables, remarks })
}

/// At most 20 of a list.
fn summary(list: &[String]) -> String {
    let shown = list.iter().take(20).cloned().collect::<Vec<_>>().join(", ");
    if list.len() > 20 { format!("{shown} and {} more", list.len() - 20) } else { shown }
}

fn into_domain(model: &super::gmsh::GmshModel) -> Domain {
    let loops = outline::sides(model);
    let curves = |sides: &Vec<outline::Side>| sides.iter().map(|s| s.curve).collect::<Vec<_>>();
    let mut all = loops.iter().map(curves);
    // The loops already have the body to their left, so that their edges keep this order.
    let mut domain = Domain::new(all.next().unwrap_or_default(), all.collect());
    let mut edges = vec![vec![]; model.parts.len()];
    for (edge, side) in loops.iter().flatten().enumerate() {
        side.parts.iter().for_each(|&part| edges[part].push(edge));
    }
    for (name, edges) in model.parts.iter().zip(edges) {
        domain.add_part(name, edges);
    }
    domain
}

/// The text of a case with all that an input file says.
///
/// # Errors
/// What is wrong with the file.
pub fn import_abaqus(path: &Path) -> Result<(String, Vec<String>), String> {
    read_abaqus_as_case(&super::read_bytes(path, super::MAX_MESH_BYTES).map_err(|problem| problem.message)?, path)
}

/// The same with the bytes of the file at hand.
///
/// # Errors
/// What is wrong with them. No bytes make it panic.
pub fn read_abaqus_as_case(bytes: &[u8], path: &Path) -> Result<(String, Vec<String>), String> {
    let mut model = read_abaqus(bytes).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut text = String::new();
    if let Some(title) = model.tables.remove("title") {
        text += &format!("title = {title}\n");
    }
    let file = toml::Value::from(path.display().to_string());
    if !super::files::is_below(path) {
        text += "files = \"anywhere\"\n";
    }
    text += "# Units are those of the input file; name them: units = \"mm, N, MPa\"\n";
    // A comment ends at a line break, and TOML allows no other control characters in it.
    let parts: Vec<String> = model.domain.parts.iter().map(|p| p.name.replace(char::is_control, "?")).collect();
    text += &format!("\n# Parts: {}\n", parts.join(", "));
    text += &format!("[geometry.abaqus]\nfile = {file}\n\n");
    text += &toml::to_string(&model.tables).map_err(|e| e.to_string())?;
    text += "\n# Cracks are drawn on the uncracked body.\n# [[crack]]\n# path = [[0, 0], [1, 0]]\n";
    Ok((text, model.remarks))
}
