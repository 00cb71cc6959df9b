//! `riss run --resume`: growth that goes on where an earlier run stopped, or was stopped.

use crate::grow::Beginning;
use crate::results;
use riss::case::Case;
use riss::output::{RESULTS_FILE, RunWriter, read_results, restart_state, write_file};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

/// The case as the run began with it, in the folder of results.
pub const CASE_COPY: &str = "restart/case.json";

/// Why a run does not begin.
pub enum Obstacle {
    /// What is asked for makes no sense.
    Request(String),
    /// The folder cannot be written.
    Folder(String),
}

impl Obstacle {
    /// The reason.
    pub fn message(self) -> String {
        match self {
            Self::Request(message) | Self::Folder(message) => message,
        }
    }
}

/// What a run began with.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Resumed {
    /// The case file.
    pub case: PathBuf,
    /// Its text then.
    pub text: String,
    /// The overrides.
    pub overrides: Vec<String>,
}

/// Begins a run in a folder, and keeps there what is needed to go on with it.
pub fn begin(case: &Case, dir: &Path) -> Result<Beginning, Obstacle> {
    let failed = |e: std::io::Error| cannot_write(dir, &e);
    // Killed in between, the results of one case must not stand beside the text of another.
    match std::fs::remove_file(dir.join(CASE_COPY)) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(failed(e)),
        _ => {}
    }
    let writer = RunWriter::new(dir, results::options(case)).map_err(failed)?;
    Resumed::keep(&case.path, &case.text, &case.overrides, dir).map_err(failed)?;
    writer.describe(&results::source(case)).map_err(failed)?;
    Ok(Beginning { writer, state: None })
}

impl Resumed {
    /// Keeps a case in the folder of its results.
    ///
    /// # Errors
    /// What the system says.
    pub fn keep(case: &Path, text: &str, overrides: &[String], dir: &Path) -> io::Result<()> {
        let case = case.canonicalize().unwrap_or_else(|_| case.into());
        let copy = Self { case, text: text.into(), overrides: overrides.into() };
        write_file(dir, CASE_COPY, &serde_json::to_vec_pretty(&copy)?)
    }

    /// What stands in a folder of results.
    pub fn read(dir: &Path) -> Result<Self, String> {
        let path = dir.join(CASE_COPY);
        let text = std::fs::read(&path)
            .map_err(|_| format!("{} holds no growth to go on with: there is no {CASE_COPY}", dir.display()))?;
        serde_json::from_slice(&text).map_err(|e| format!("{}: {e}", path.display()))
    }

    /// Whether a case differs from that of the earlier run in its growth settings only.
    ///
    /// # Errors
    /// In what it differs.
    pub fn unchanged(&self, case: &Case, dir: &Path) -> Result<(), String> {
        let before = Case::parse(&self.text, &self.case, &self.overrides)
            .map_err(|_| format!("{CASE_COPY} in {} cannot be read any more", dir.display()))?;
        match before.differs_outside_growth(case) {
            None => Ok(()),
            Some(key) => Err(format!(
                "{} differs from the case of {} in `{key}`; only [growth] and [output] may change in between",
                case.path.display(),
                dir.display()
            )),
        }
    }

    /// The folder from a step on; the case may differ from that of the earlier run in its growth settings only.
    pub fn beginning(&self, case: &Case, dir: &Path, from_step: Option<usize>) -> Result<Beginning, Obstacle> {
        let refused = |message: String| Obstacle::Request(message);
        self.unchanged(case, dir).map_err(refused)?;
        if from_step.unwrap_or(0) == 0 && !dir.join(RESULTS_FILE).exists() {
            // Stopped before its first step was complete.
            return begin(case, dir);
        }
        let results =
            read_results(dir).map_err(|e| refused(format!("the results in {} cannot be read: {e}", dir.display())))?;
        let last = results.steps.last().map_or(0, |s| s.step);
        let step = from_step.unwrap_or(last);
        if step > last {
            return Err(refused(format!("step {step} is not in {}; the last one there is {last}", dir.display())));
        }
        let state = restart_state(dir, step)
            .map_err(|e| refused(format!("the state of step {step} in {} cannot be read: {e}", dir.display())))?;
        let writer = RunWriter::resume(dir, results::options(case), step).map_err(|e| match e.kind() {
            std::io::ErrorKind::InvalidData => {
                refused(format!("the results in {} cannot be continued: {}", dir.display(), results::reason(&e)))
            }
            _ => cannot_write(dir, &e),
        })?;
        writer.describe(&results::source(case)).map_err(|e| cannot_write(dir, &e))?;
        Ok(Beginning { writer, state: Some(state) })
    }
}

fn cannot_write(dir: &Path, error: &std::io::Error) -> Obstacle {
    Obstacle::Folder(format!("cannot write the results to {}: {}", dir.display(), results::reason(error)))
}
