//! `riss run --resume`: growth that goes on where an earlier run stopped, or was stopped.

use crate::grow::Beginning;
use crate::results;
use riss::case::Case;
use riss::output::{RESULTS_FILE, RunWriter, read_results, restart_state, write_file};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The case as the run began with it, in the folder of results.
const CASE_COPY: &str = "restart/case.json";

/// What a run began with.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Resumed {
    /// The case file.
    pub case: PathBuf,
    /// Its text then.
    text: String,
    /// The overrides.
    pub overrides: Vec<String>,
}

/// Begins a run in a folder, and keeps there what is needed to go on with it.
pub fn begin(case: &Case, dir: &Path) -> Result<Beginning, String> {
    let failed = |e: std::io::Error| format!("cannot write the results to {}: {}", dir.display(), results::reason(&e));
    // Killed in between, the results of one case must not stand beside the text of another.
    match std::fs::remove_file(dir.join(CASE_COPY)) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(failed(e)),
        _ => {}
    }
    let writer = RunWriter::new(dir, results::options(case)).map_err(failed)?;
    let path = case.path.canonicalize().unwrap_or_else(|_| case.path.clone());
    let copy = Resumed { case: path, text: case.text.clone(), overrides: case.overrides.clone() };
    let text = serde_json::to_vec_pretty(&copy).map_err(|e| e.to_string())?;
    write_file(dir, CASE_COPY, &text).map_err(failed)?;
    writer.describe(&results::source(case)).map_err(failed)?;
    Ok(Beginning { writer, state: None })
}

impl Resumed {
    /// What stands in a folder of results.
    pub fn read(dir: &Path) -> Result<Self, String> {
        let path = dir.join(CASE_COPY);
        let text = std::fs::read(&path)
            .map_err(|_| format!("{} holds no growth to go on with: there is no {CASE_COPY}", dir.display()))?;
        serde_json::from_slice(&text).map_err(|e| format!("{}: {e}", path.display()))
    }

    /// The folder from a step on; the case may differ from that of the earlier run in its growth settings only.
    pub fn beginning(&self, case: &Case, dir: &Path, from_step: Option<usize>) -> Result<Beginning, String> {
        let before = Case::parse(&self.text, &self.case, &self.overrides)
            .map_err(|_| format!("{CASE_COPY} in {} cannot be read any more", dir.display()))?;
        if let Some(key) = before.differs_outside_growth(case) {
            return Err(format!(
                "{} differs from the case of {} in `{key}`; only [growth] and [output] may change in between",
                case.path.display(),
                dir.display()
            ));
        }
        if from_step.unwrap_or(0) == 0 && !dir.join(RESULTS_FILE).exists() {
            // Stopped before its first step was complete.
            return begin(case, dir);
        }
        let results = read_results(dir).map_err(|e| format!("the results in {} cannot be read: {e}", dir.display()))?;
        let last = results.steps.last().map_or(0, |s| s.step);
        let step = from_step.unwrap_or(last);
        if step > last {
            return Err(format!("step {step} is not in {}; the last one there is {last}", dir.display()));
        }
        let state = restart_state(dir, step)
            .map_err(|e| format!("the state of step {step} in {} cannot be read: {e}", dir.display()))?;
        let writer = RunWriter::resume(dir, results::options(case), step)
            .map_err(|e| format!("the results in {} cannot be continued: {}", dir.display(), results::reason(&e)))?;
        writer.describe(&results::source(case)).map_err(|e| results::reason(&e))?;
        Ok(Beginning { writer, state: Some(state) })
    }
}
