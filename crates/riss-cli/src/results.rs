//! The one place where a run meets the library's output.

use riss::analysis::StaticResult;
use riss::case::Case;
use serde_json::{Value, json};
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

/// Writes all files of a run into `dir`; returns their paths.
pub fn write(dir: &Path, case: &Case, run: &RunRecord, result: &StaticResult) -> io::Result<Vec<PathBuf>> {
    std::fs::create_dir_all(dir)?;
    let path = dir.join("results.json");
    std::fs::write(&path, json(case, run, result))?;
    Ok(vec![path])
}

/// The results as JSON.
pub fn json(case: &Case, run: &RunRecord, result: &StaticResult) -> String {
    let tips: Vec<Value> = (result.step.cracks.iter())
        .flat_map(|c| {
            c.tips.iter().map(move |t| json!({ "crack": c.name, "K_I": t.k1, "K_II": t.k2, "J": t.j, "T": t.t_stress }))
        })
        .collect();
    let record = json!({
        "case": case.model.title,
        "nodes": result.n_nodes,
        "wall_time_s": run.wall_time_s,
        "stage_time_s": run.stage_time_s.iter().cloned().collect::<std::collections::BTreeMap<_, _>>(),
        "peak_memory_bytes": run.peak_memory_bytes,
        "tips": tips,
    });
    format!("{record:#}\n")
}
