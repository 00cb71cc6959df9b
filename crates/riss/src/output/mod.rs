//! Files that an analysis leaves behind: results, history, fields and pictures.
//!
//! Only this folder writes. Knows no case files. Reading order: [`run_writer`] (step by step), [`results`] (the
//! contract), [`load_curve`] and [`plane_loading_writer`] (of cohesive cracks), [`comparison`] and [`loading_comparison`] (of two of them), [`history`], [`fields`] with `vtk` below it, [`model_picture`],
//! [`field_picture`] and [`shape_picture`] with `svg` and `contours` below them, [`report`], [`exports`],
//! [`convergence`], [`run_table`] (of several runs), [`whole_file`]; for solids [`solid_results`], [`solid_files`],
//! [`solid_writer`] (step by step), [`loading_writer`] (of cohesive cracks), [`solid_report`], [`solid_picture()`],
//! [`solid_comparison`], [`solid_convergence`], [`solid_exports`].

mod color_map;
pub mod comparison;
mod contours;
pub mod convergence;
pub mod exports;
pub mod field_picture;
pub mod fields;
pub mod history;
pub mod load_curve;
pub mod loading_comparison;
pub mod loading_writer;
pub mod model_picture;
pub mod plane_loading_writer;
pub mod report;
pub mod results;
pub mod run_table;
pub mod run_writer;
pub mod shape_picture;
pub mod solid_comparison;
pub mod solid_convergence;
pub mod solid_exports;
pub mod solid_files;
pub mod solid_picture;
pub mod solid_report;
pub mod solid_results;
pub mod solid_writer;
mod svg;
mod vtk;
pub mod whole_file;

pub use comparison::Comparison;
pub use convergence::write_convergence;
pub use field_picture::{FieldQuantity, write_field_picture};
pub use load_curve::LOAD_CURVE_FILE;
pub use loading_writer::{LoadingWriter, grown_surfaces};
pub use model_picture::write_model_picture;
pub use plane_loading_writer::{PlaneLoadingWriter, grown_ways};
pub use report::{REPORT_FILE, RunSource, describe_run, write_report};
pub use results::{Results, RunStatus, results_json, results_schema};
pub use run_writer::{RunWriter, read_results, restart_state, write_file};
pub use shape_picture::write_shape_pictures;
pub use solid_comparison::SolidComparison;
pub use solid_convergence::write_solid_convergence;
pub use solid_files::{AnyResults, read_any_results, write_solid_cloud, write_solid_results};
pub use solid_picture::solid_picture;
pub use solid_results::{SolidResults, solid_results_schema};
pub use solid_writer::{SolidWriter, solid_restart_state};

use crate::analysis::StaticResult;
use crate::model::UnitNames;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

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
    /// Units, if the case says them.
    pub units: Option<UnitNames>,
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
    let mut writer = RunWriter::new(dir, *options)?;
    writer.write_step(info, result, &info.stage_time_s, None)
}
