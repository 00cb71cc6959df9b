//! The one place where a run meets the library's output.

use riss::analysis::StaticResult;
use riss::case::{Case, SolidCase};
use riss::model::Model;
use riss::output::{
    OutputOptions, RunInfo, RunSource, RunStatus, RunWriter, describe_run, results_json, write_model_picture,
};
use riss::system::Discretization;
use std::io;
use std::path::{Path, PathBuf};

/// What the run knows beside the result.
pub struct RunRecord {
    /// Time from start to end [s].
    pub wall_time_s: f64,
    /// Time of each stage by name [s].
    pub stage_time_s: Vec<(String, f64)>,
    /// Greatest memory use, where the system tells it.
    pub peak_memory_bytes: Option<u64>,
}

impl RunRecord {
    /// For the output of the library.
    pub fn info(&self, case: &Case, status: RunStatus) -> RunInfo {
        RunInfo {
            title: case.model.title.clone(),
            method: case.settings.method.name().into(),
            units: case.units.clone(),
            status,
            wall_time_s: self.wall_time_s,
            stage_time_s: self.stage_time_s.clone(),
            peak_memory_bytes: self.peak_memory_bytes,
        }
    }
}

/// What the system says, in words for the usual cases.
pub fn reason(error: &io::Error) -> String {
    // Errors of the library name their file already.
    if error.raw_os_error().is_none() {
        return error.to_string();
    }
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such folder".into(),
        io::ErrorKind::AlreadyExists | io::ErrorKind::NotADirectory => "a file is in the way".into(),
        io::ErrorKind::PermissionDenied => "no permission".into(),
        io::ErrorKind::ReadOnlyFilesystem => "the file system is read-only".into(),
        _ => error.to_string(),
    }
}

/// Written files, a line each.
pub fn listed(files: &[PathBuf]) -> String {
    files.iter().map(|f| format!("wrote {}\n", f.display())).collect()
}

/// Writes all files of a run into `dir`; returns their paths.
pub fn write(dir: &Path, case: &Case, run: &RunRecord, result: &StaticResult) -> io::Result<Vec<PathBuf>> {
    let mut writer = RunWriter::new(dir, options(case))?;
    writer.describe(&source(case))?;
    writer.write_step(&run.info(case, RunStatus::Done), result, &run.stage_time_s, None)
}

/// What is run, for the report.
pub fn source(case: &Case) -> RunSource {
    RunSource::begun(&case.path, &case.text, &case.overrides, case.effective_settings(), "")
}

/// Says in a folder what is run there, for the report of a solid.
pub fn describe_solid(case: &SolidCase, dir: &Path) -> io::Result<()> {
    describe_run(dir, &RunSource::begun(&case.path, &case.text, &case.overrides, case.effective_settings(), ""))
}

/// What a case wants to be written.
pub fn options(case: &Case) -> OutputOptions {
    let output = &case.output;
    OutputOptions { fields: output.fields, nodes: output.nodes, integration_points: output.integration_points }
}

/// Draws the body with its nodes and cells into `dir`; returns the path.
pub fn write_picture(dir: &Path, model: &Model, discrete: &Discretization) -> io::Result<PathBuf> {
    let path = dir.join("model.svg");
    write_model_picture(&path, model, &discrete.approximation.nodes().positions, &discrete.cells.corners)?;
    Ok(path)
}

/// The results as JSON.
pub fn json(case: &Case, run: &RunRecord, result: &StaticResult) -> String {
    results_json(&run.info(case, RunStatus::Done), result)
}

/// `NAME.riss-out` in the current folder.
pub fn default_folder(case: &Path) -> PathBuf {
    PathBuf::from(format!("{}.riss-out", name(case)))
}

/// Name of a case: the case file's, or its folder's if the file is just case.toml.
pub fn name(case: &Path) -> String {
    let path = case.canonicalize().unwrap_or_else(|_| case.to_path_buf());
    let stem = path.file_stem().map_or("case".into(), |s| s.to_string_lossy().into_owned());
    let folder = path.parent().and_then(Path::file_name).map(|s| s.to_string_lossy().into_owned());
    if stem == "case" { folder.unwrap_or(stem) } else { stem }
}
