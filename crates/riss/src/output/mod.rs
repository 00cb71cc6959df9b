//! Files that an analysis leaves behind: results, history, fields and pictures.
//!
//! Only this folder writes. Knows no case files. Reading order: [`results`] (the contract), [`history`], [`fields`]
//! with `vtk` below it, [`model_picture`] and [`field_picture`] with `svg` and `contours` below them, [`whole_file`].

mod color_map;
mod contours;
pub mod field_picture;
pub mod fields;
pub mod history;
pub mod model_picture;
pub mod results;
mod svg;
mod vtk;
pub mod whole_file;

pub use field_picture::{FieldQuantity, write_field_picture};
pub use model_picture::write_model_picture;
pub use results::{Results, RunStatus, results_json, results_schema};

use crate::analysis::StaticResult;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use whole_file::write_whole;

/// Name of the file that is written last: where it stands, all others are complete.
pub const RESULTS_FILE: &str = "results.json";

/// Name of the picture of the von Mises stress on the deformed body.
pub const PICTURE_FILE: &str = "deformed.svg";

/// What the run knows beside the result.
#[derive(Clone, Debug, PartialEq)]
pub struct RunInfo {
    /// Title of the case.
    pub title: String,
    /// Name of the method.
    pub method: String,
    /// How the run ended.
    pub status: RunStatus,
    /// Time from start to end [s].
    pub wall_time_s: f64,
    /// Time of each stage by name [s]; stages that ran several times may appear several times.
    pub stage_time_s: Vec<(String, f64)>,
    /// Greatest memory use, where the system tells it.
    pub peak_memory_bytes: Option<u64>,
}

/// Which files to write beside `results.json` and `history.csv`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OutputOptions {
    /// Displacement, stress and strain over the body, and the crack faces, for ParaView; a picture of them.
    pub fields: bool,
    /// Nodes with support radius and nodal parameters, for ParaView.
    pub nodes: bool,
    /// Integration points with integration weights, for ParaView.
    pub integration_points: bool,
}

impl Default for OutputOptions {
    fn default() -> Self {
        Self { fields: true, nodes: false, integration_points: false }
    }
}

/// Writes all files of a static run into `dir`, which is made if needed; returns their paths, `results.json` last.
///
/// Files appear whole or not at all. An older `results.json` is removed first.
pub fn write_results(
    dir: &Path,
    info: &RunInfo,
    result: &StaticResult,
    options: &OutputOptions,
) -> io::Result<Vec<PathBuf>> {
    fs::create_dir_all(dir)?;
    match fs::remove_file(dir.join(RESULTS_FILE)) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(e),
        _ => {}
    }
    let mut files = vec![("history.csv".to_string(), history::history_csv(std::slice::from_ref(&result.step))?)];
    files.extend(fields::field_files(result, options)?);
    if options.fields {
        let picture = field_picture::field_picture(result, FieldQuantity::VonMises)?;
        files.push((PICTURE_FILE.into(), picture.into_bytes()));
    }
    let mut results = Results::new(info, result);
    results.files = files.iter().map(|f| f.0.clone()).collect();
    files.push((RESULTS_FILE.into(), results.to_json().into_bytes()));
    files
        .into_iter()
        .map(|(name, content)| {
            let path = dir.join(name);
            write_whole(&path, &content)?;
            Ok(path)
        })
        .collect()
}
