//! Writes a run step by step: after each step the folder is complete, whatever happens next.

use super::fields::{STEP_FILE_KINDS, step_file_name, step_files};
use super::history::history_csv;
use super::load_curve::{LOAD_CURVE_FILE, table};
use super::report::{self, REPORT_FILE, REPORT_FOLDER, RunSource};
use super::results::{Results, RunStatus, StepResults};
use super::vtk::collection;
use super::whole_file::{remove_if_there, remove_leftovers, write_whole};
use super::{FieldQuantity, OutputOptions, PICTURE_FILE, RESULTS_FILE, RunInfo, field_picture};
use crate::analysis::{GrowthState, PlaneLoadingRecord, StaticResult};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Folder of the states from which growth can go on, one file a step.
pub const RESTART_FOLDER: &str = "restart";

/// Beginnings of the names of what goes on with a run, and of what its report is made of.
const OTHER_STEP_FILES: [&str; 3] = ["step", "fine", "coarse"];

/// The folder of a run.
#[derive(Clone, Debug)]
pub struct RunWriter {
    dir: PathBuf,
    options: OutputOptions,
    steps: Vec<StepResults>,
    /// Kind and step of the files that are there, in order.
    step_files: Vec<(&'static str, usize)>,
}

impl RunWriter {
    /// Starts anew in `dir`, which is made if needed; results of an earlier run are removed.
    ///
    /// # Errors
    /// What the system says.
    pub fn new(dir: &Path, options: OutputOptions) -> io::Result<Self> {
        fs::create_dir_all(dir)?;
        remove_all_leftovers(dir)?;
        remove_if_there(&dir.join(RESULTS_FILE))?;
        remove_if_there(&dir.join(REPORT_FILE))?;
        report::write_source(dir, None)?;
        remove_steps_from(dir, 0)?;
        Ok(Self { dir: dir.into(), options, steps: vec![], step_files: vec![] })
    }

    /// Goes on in the folder of an earlier run with the step `first`, which is made again: its steps before stay, and
    /// `first` itself until it is replaced; the others are removed.
    ///
    /// # Errors
    /// What the system says; `InvalidData` if the results there are no results or lack one of those steps.
    pub fn resume(dir: &Path, options: OutputOptions, first: usize) -> io::Result<Self> {
        let results = read_results(dir)?;
        let mut steps = results.steps.clone();
        steps.retain(|s| s.step < first);
        if steps.iter().map(|s| s.step).ne(0..first) {
            return Err(io::Error::new(
                io::ErrorKind::InvalidData,
                format!("there are no results of all steps before {first}"),
            ));
        }
        remove_all_leftovers(dir)?;
        // Before their files go, so that a run that is killed in between leaves no results without them.
        forget_steps_after(dir, results, first)?;
        remove_steps_from(dir, first + 1)?;
        let there = |kind: &'static str| {
            (0..first).filter(move |k| dir.join(step_file_name(kind, *k)).is_file()).map(move |k| (kind, k))
        };
        let step_files = STEP_FILE_KINDS.into_iter().flat_map(there).collect();
        Ok(Self { dir: dir.into(), options, steps, step_files })
    }

    /// Keeps in the folder what is run, for the report.
    ///
    /// # Errors
    /// What the system says.
    pub fn describe(&self, source: &RunSource) -> io::Result<()> {
        report::write_source(&self.dir, Some(source))
    }

    /// Writes the files of a step and brings those of the run up to date; returns the paths, `results.json` last.
    ///
    /// - `info`: of the run so far; its stage times are those of all steps together
    /// - `stage_time_s`: of this step
    /// - `state`: from which the step can be repeated
    ///
    /// # Errors
    /// What the system says.
    pub fn write_step(
        &mut self,
        info: &RunInfo,
        result: &StaticResult,
        stage_time_s: &[(String, f64)],
        state: Option<&GrowthState>,
    ) -> io::Result<Vec<PathBuf>> {
        self.steps.push(StepResults::new(result, stage_time_s));
        let step = result.step.step;
        let mut files: Vec<(String, Vec<u8>)> = vec![("history.csv".into(), history_csv(&self.steps)?)];
        // What takes time is made side by side.
        let has_picture = self.options.fields && !result.fields.positions.is_empty();
        let has_report = self.options.fields && result.n_nodes > 0;
        let picture = || has_picture.then(|| field_picture::field_picture(result, FieldQuantity::VonMises)).transpose();
        let of_report = || has_report.then(|| report::step_files(step, &result.fields));
        let ((of_step, picture), of_report) =
            rayon::join(|| rayon::join(|| step_files(result, &self.options), picture), of_report);
        for file in of_step? {
            self.step_files.push((file.kind, step));
            files.push((file.name, file.content));
        }
        files.extend(self.collections());
        files.extend(picture?.map(|picture| (PICTURE_FILE.into(), picture.into_bytes())));
        if let Some(state) = state {
            fs::create_dir_all(self.dir.join(RESTART_FOLDER))?;
            files.push((restart_name(step), serde_json::to_vec(state)?));
        }
        files.extend(of_report.into_iter().flatten());
        let mut results = Results::of_steps(info, result, self.steps.clone());
        results.files = files.iter().map(|f| f.0.clone()).collect();
        // Those of earlier steps are part of the run, too.
        let earlier = self.step_files.iter().filter(|f| f.1 < step).map(|f| step_file_name(f.0, f.1));
        let mut earlier: Vec<String> = earlier.collect();
        earlier.sort();
        results.files.extend(earlier);
        if state.is_some() {
            results.files.extend((0..step).map(restart_name));
        }
        results.files.push(REPORT_FILE.into());
        results.files.extend(report::files_before(&self.dir, step));
        let mut written = self.write_all(files)?;
        // The report is made of files of all steps, this one among them.
        let report = report::report(&self.dir, &results)?.into_bytes();
        let last = vec![(REPORT_FILE.into(), report), (RESULTS_FILE.into(), results.to_json().into_bytes())];
        written.extend(self.write_all(last)?);
        Ok(written)
    }

    /// Puts the load curve beside its steps; returns the paths, `results.json` last.
    ///
    /// # Errors
    /// What the system says; `NotFound` if no step was written.
    pub(super) fn write_loading(&self, info: &RunInfo, record: &PlaneLoadingRecord) -> io::Result<Vec<PathBuf>> {
        let mut results = read_results(&self.dir)?;
        results.told(info);
        results.loaded(record);
        results.files.insert(0, LOAD_CURVE_FILE.into());
        let table = table(&results.load_curve)?;
        let report = report::report(&self.dir, &results)?.into_bytes();
        let json = results.to_json().into_bytes();
        self.write_all(vec![(LOAD_CURVE_FILE.into(), table), (REPORT_FILE.into(), report), (RESULTS_FILE.into(), json)])
    }

    fn write_all(&self, files: Vec<(String, Vec<u8>)>) -> io::Result<Vec<PathBuf>> {
        let write = |(name, content): (String, Vec<u8>)| {
            write_file(&self.dir, &name, &content)?;
            Ok(self.dir.join(name))
        };
        files.into_iter().map(write).collect()
    }

    /// One collection for each kind of file, over all steps.
    fn collections(&self) -> Vec<(String, Vec<u8>)> {
        let of_kind = |kind: &&'static str| {
            let files: Vec<(usize, String)> =
                self.step_files.iter().filter(|f| f.0 == *kind).map(|f| (f.1, step_file_name(kind, f.1))).collect();
            (!files.is_empty()).then(|| (format!("{kind}.pvd"), collection(&files)))
        };
        STEP_FILE_KINDS.iter().filter_map(of_kind).collect()
    }
}

/// Writes a file of a run whole or not at all; folders in its name are made.
///
/// # Errors
/// What the system says.
pub fn write_file(dir: &Path, name: &str, content: &[u8]) -> io::Result<()> {
    let path = dir.join(name);
    fs::create_dir_all(path.parent().unwrap_or(dir))?;
    write_whole(&path, content)
}

/// The state from which a step can be repeated.
///
/// # Errors
/// What the system says; `InvalidData` if the file is none of ours.
pub fn restart_state(dir: &Path, step: usize) -> io::Result<GrowthState> {
    Ok(serde_json::from_slice(&fs::read(dir.join(restart_name(step)))?)?)
}

/// The results in a folder.
///
/// # Errors
/// What the system says; `InvalidData` if the file is none of ours.
pub fn read_results(dir: &Path) -> io::Result<Results> {
    Ok(serde_json::from_slice(&fs::read(dir.join(RESULTS_FILE))?)?)
}

pub(super) fn restart_name(step: usize) -> String {
    format!("{RESTART_FOLDER}/step_{step:04}.json")
}

fn remove_all_leftovers(dir: &Path) -> io::Result<()> {
    folders(dir).iter().try_for_each(|folder| remove_leftovers(folder))
}

/// All folders of a run.
fn folders(dir: &Path) -> [PathBuf; 3] {
    [dir.to_path_buf(), dir.join(RESTART_FOLDER), dir.join(REPORT_FOLDER)]
}

/// Takes the steps after `last` out of the results in a folder, and what they came to.
fn forget_steps_after(dir: &Path, mut results: Results, last: usize) -> io::Result<()> {
    if results.growth_end.is_none() && results.steps.last().is_none_or(|s| s.step <= last) {
        return Ok(());
    }
    results.steps.retain(|s| s.step <= last);
    results.files.retain(|name| step_of(name).is_none_or(|step| step <= last));
    results.growth_end = None;
    results.status = RunStatus::Stopped;
    results.warnings = results.steps.iter().flat_map(|s| s.warnings.iter().cloned()).collect();
    if let Some(step) = results.steps.last() {
        results.nodes = step.nodes.unwrap_or(0);
        results.strain_energy = step.strain_energy;
    }
    write_whole(&dir.join(RESULTS_FILE), results.to_json().as_bytes())?;
    write_whole(&dir.join(REPORT_FILE), report::report(dir, &results)?.as_bytes())
}

/// The step whose file has this name, such as `restart/step_0012.json`.
fn step_of(name: &str) -> Option<usize> {
    let (kind, rest) = name.rsplit('/').next()?.rsplit_once('_')?;
    let step: usize = rest.split_once('.')?.0.parse().ok()?;
    let is_field = STEP_FILE_KINDS.contains(&kind) && name == step_file_name(kind, step);
    (is_field || OTHER_STEP_FILES.contains(&kind)).then_some(step)
}

/// Removes the files of steps from `first` on, so that none of an earlier run passes for one of this.
fn remove_steps_from(dir: &Path, first: usize) -> io::Result<()> {
    for folder in folders(dir) {
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        for entry in entries {
            let entry = entry?;
            if step_of(&entry.file_name().to_string_lossy()).is_some_and(|step| step >= first) {
                remove_if_there(&entry.path())?;
            }
        }
    }
    Ok(())
}
