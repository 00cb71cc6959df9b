//! The one place where a run meets the library's output.

use riss::analysis::StaticResult;
use riss::case::Case;
use riss::output::{OutputOptions, RunInfo, RunStatus, results_json, write_results};
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
    fn info(&self, case: &Case) -> RunInfo {
        RunInfo {
            title: case.model.title.clone(),
            method: "element-free-galerkin".into(),
            status: RunStatus::Done,
            wall_time_s: self.wall_time_s,
            stage_time_s: self.stage_time_s.clone(),
            peak_memory_bytes: self.peak_memory_bytes,
        }
    }
}

/// Writes all files of a run into `dir`; returns their paths.
pub fn write(dir: &Path, case: &Case, run: &RunRecord, result: &StaticResult) -> io::Result<Vec<PathBuf>> {
    let output = &case.output;
    let options = OutputOptions {
        fields: output.fields,
        nodes: output.nodes,
        integration_points: output.integration_points,
    };
    write_results(dir, &run.info(case), result, &options)
}

/// The results as JSON.
pub fn json(case: &Case, run: &RunRecord, result: &StaticResult) -> String {
    results_json(&run.info(case), result)
}
