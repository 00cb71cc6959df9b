//! Writes what a plane body with cohesive cracks does under load: the states with fields as they come, then the curve.

use super::load_curve::{LOAD_CURVE_FILE, load_curve, table};
use super::report::RunSource;
use super::run_writer::{RunWriter, write_file};
use super::whole_file::{read_if_there, remove_if_there, write_whole};
use super::{OutputOptions, RunInfo};
use crate::analysis::{GrowthState, LoadPoint, PlaneLoadingRecord, StaticResult};
use std::io;
use std::path::{Path, PathBuf};

/// Where growth stands from which a run can go on.
const WAYS_FILE: &str = "restart/ways.json";

/// The folder of a run with cohesive cracks in the plane.
#[derive(Debug)]
pub struct PlaneLoadingWriter {
    dir: PathBuf,
    writer: RunWriter,
}

/// Where the growth of an earlier run in a folder stands; none if it had not come so far.
///
/// # Errors
/// What the system says; `InvalidData` if the file is none of ours.
pub fn grown_ways(dir: &Path) -> io::Result<Option<GrowthState>> {
    read_if_there(&dir.join(WAYS_FILE))
}

impl PlaneLoadingWriter {
    /// Starts anew in `dir`, which is made if needed.
    ///
    /// - `source`: what is run, for the report
    ///
    /// # Errors
    /// What the system says.
    pub fn new(dir: &Path, options: OutputOptions, source: &RunSource) -> io::Result<Self> {
        let writer = RunWriter::new(dir, options)?;
        writer.describe(source)?;
        remove_if_there(&dir.join(WAYS_FILE))?;
        remove_if_there(&dir.join(LOAD_CURVE_FILE))?;
        Ok(Self { dir: dir.into(), writer })
    }

    /// Writes where growth stands, from which another run can go on.
    ///
    /// # Errors
    /// What the system says.
    pub fn write_ways(&self, state: &GrowthState) -> io::Result<()> {
        write_file(&self.dir, WAYS_FILE, &serde_json::to_vec(state)?)
    }

    /// Writes the load curve as far as it is known, so that a run that is killed leaves it.
    ///
    /// # Errors
    /// What the system says.
    pub fn write_curve(&self, curve: &[LoadPoint]) -> io::Result<()> {
        write_whole(&self.dir.join(LOAD_CURVE_FILE), &table(&load_curve(curve))?)
    }

    /// Writes the fields of a state.
    ///
    /// - `info`: of the run so far
    /// - `stage_time_s`: of this state
    ///
    /// # Errors
    /// What the system says.
    pub fn write_step(
        &mut self,
        info: &RunInfo,
        result: &StaticResult,
        stage_time_s: &[(String, f64)],
    ) -> io::Result<()> {
        self.writer.write_step(info, result, stage_time_s, None).map(drop)
    }

    /// Writes the curve and what became of the run; returns the paths, `results.json` last.
    ///
    /// # Errors
    /// What the system says; `NotFound` if no state was written.
    pub fn finish(&self, info: &RunInfo, record: &PlaneLoadingRecord) -> io::Result<Vec<PathBuf>> {
        self.writer.write_loading(info, record)
    }
}
