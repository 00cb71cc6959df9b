//! Writes what a solid with cohesive cracks does under load: the states with fields as they come, then curve and results.

use super::load_curve::{LOAD_CURVE_FILE, load_curve, table};
use super::report::REPORT_FILE;
use super::report::solid_scene::{Scenes, clear_scenes, scene_files, write_scene};
use super::run_writer::write_file;
use super::solid_files::{boundary, cracks_with, nodes};
use super::solid_report::solid_report;
use super::solid_results::SolidResults;
use super::vtk::collection;
use super::whole_file::{read_if_there, remove_if_there, write_all, write_whole};
use super::{RESULTS_FILE, RunInfo};
use crate::analysis::{CohesiveSurfaces, LoadPoint, LoadingRecord, LoadingStep, SolidResult};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Kinds of files of a state.
const KINDS: [&str; 3] = ["nodes", "boundary", "cracks"];
/// Where the surfaces stand from which a run can go on.
const SURFACES_FILE: &str = "restart/surfaces.json";

/// The folder of a run with cohesive cracks.
#[derive(Debug)]
pub struct LoadingWriter {
    dir: PathBuf,
    steps: Vec<usize>,
    at_peak: Option<SolidResult>,
}

/// The surfaces that an earlier run in a folder had grown; none if it had not come so far.
///
/// # Errors
/// What the system says; `InvalidData` if the file is none of ours.
pub fn grown_surfaces(dir: &Path) -> io::Result<Option<CohesiveSurfaces>> {
    read_if_there(&dir.join(SURFACES_FILE))
}

impl LoadingWriter {
    /// Starts anew in `dir`, which is made if needed.
    ///
    /// # Errors
    /// What the system says.
    pub fn new(dir: &Path) -> io::Result<Self> {
        fs::create_dir_all(dir)?;
        remove_if_there(&dir.join(RESULTS_FILE))?;
        remove_if_there(&dir.join(SURFACES_FILE))?;
        clear_scenes(dir, 0)?;
        Ok(Self { dir: dir.into(), steps: vec![], at_peak: None })
    }

    /// Writes the surfaces that have grown, from which another run can go on.
    ///
    /// # Errors
    /// What the system says.
    pub fn write_surfaces(&self, surfaces: &CohesiveSurfaces) -> io::Result<()> {
        write_file(&self.dir, SURFACES_FILE, &serde_json::to_vec(surfaces)?)
    }

    /// Writes the load curve as far as it is known, so that a run that is killed leaves it.
    ///
    /// # Errors
    /// What the system says.
    pub fn write_curve(&self, curve: &[LoadPoint]) -> io::Result<()> {
        write_whole(&self.dir.join(LOAD_CURVE_FILE), &table(&load_curve(curve))?)
    }

    /// Writes the fields of a step.
    ///
    /// # Errors
    /// What the system says.
    pub fn write_step(&mut self, step: &LoadingStep) -> io::Result<()> {
        write_scene(&self.dir, step.point, &step.model, &step.result)?;
        write_whole(&self.dir.join(file_name("nodes", step.point)), &nodes(&step.result))?;
        write_whole(&self.dir.join(file_name("boundary", step.point)), &boundary(&step.result))?;
        let surfaces = cracks_with(&step.result, Some(&step.tractions));
        write_whole(&self.dir.join(file_name("cracks", step.point)), &surfaces)?;
        self.steps.push(step.point);
        if step.is_peak {
            self.at_peak = Some(step.result.clone());
        }
        Ok(())
    }

    /// The results of the whole run, if its peak was written.
    pub fn results(&self, info: &RunInfo, record: &LoadingRecord) -> Option<SolidResults> {
        let mut results = SolidResults::new(&record.model, info, self.at_peak.as_ref()?, vec![]);
        results.loaded(record);
        Some(results)
    }

    /// Writes load curve, report and results; returns the paths, `results.json` last.
    ///
    /// # Errors
    /// What the system says.
    pub fn finish(&self, mut results: SolidResults) -> io::Result<Vec<PathBuf>> {
        let mut files = vec![];
        for kind in KINDS {
            let all: Vec<(usize, String)> = self.steps.iter().map(|s| (*s, file_name(kind, *s))).collect();
            files.push((format!("{kind}.pvd"), collection(&all)));
        }
        files.push((LOAD_CURVE_FILE.into(), table(&results.load_curve)?));
        results.files =
            KINDS.into_iter().flat_map(|kind| self.steps.iter().map(move |s| file_name(kind, *s))).collect();
        results
            .files
            .extend(files.iter().map(|f| f.0.clone()).chain(scene_files(&self.dir)).chain([REPORT_FILE.to_string()]));
        files.push((REPORT_FILE.into(), solid_report(&results, &Scenes::read(&self.dir)?).into_bytes()));
        files.push((RESULTS_FILE.into(), (serde_json::to_string_pretty(&results)? + "\n").into_bytes()));
        write_all(&self.dir, &files)
    }
}

fn file_name(kind: &str, step: usize) -> String {
    format!("{kind}-{step:04}.vtu")
}
