//! Runs the case of a folder and compares it with its references.

use crate::{Comparison, Expected};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A case that ran.
#[derive(Clone, Debug)]
pub struct CaseRun {
    /// The content of `results.json`.
    pub results: Value,
    /// Every reference beside its computed value.
    pub comparisons: Vec<Comparison>,
    /// Wall time of the program.
    pub time: Duration,
}

/// Runs `case.toml` of a folder with the `riss` program and compares it with its reference values.
///
/// # Errors
/// Says why the run failed; values out of tolerance are no error here.
pub fn run_case(riss: &Path, folder: &Path, expected: &Expected, out: &Path) -> Result<CaseRun, String> {
    let path = out.join("results.json");
    // What an earlier run left must not pass for this one.
    if path.exists() {
        std::fs::remove_file(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    let start = Instant::now();
    let mut command = Command::new(riss);
    command.arg("run").arg(folder.join("case.toml")).arg("--out").arg(out).stdin(Stdio::null());
    let output = command.output().map_err(|e| format!("{} did not start: {e}", riss.display()))?;
    let time = start.elapsed();
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        return Err(format!("riss ended with {}\n{}", output.status, text.trim_end()));
    }
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let results: Value = serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok(CaseRun { comparisons: expected.compare(&results), results, time })
}
