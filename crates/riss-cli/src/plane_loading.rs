//! `riss run` of a plane body with cohesive cracks.

use crate::load_curve::{Pace, stopped, summary};
use crate::progress::{Progress, peak_memory_bytes};
use crate::results::{self, RunRecord};
use crate::resume::Resumed;
use crate::run::RunArguments;
use crate::table::units_line;
use crate::{BAD_CASE, DONE, STOPPED, interrupt};
use riss::analysis::{
    GrowthEndKind, GrowthState, LoadPoint, LoadingSettings, Observer, PlaneLoadingRecord, Stage, StaticResult, Warning,
    plane_loading,
};
use riss::case::Case;
use riss::output::{PlaneLoadingWriter, RESULTS_FILE, RunStatus, grown_ways};
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Loads a plane body and says how it broke; returns the exit code.
pub fn load(
    arguments: &RunArguments,
    case: &Case,
    loading: &LoadingSettings,
    known: Option<&Resumed>,
    dir: &Path,
    progress: Progress,
) -> u8 {
    let from = known.map_or(Ok(None), |known| {
        known.unchanged(case, dir)?;
        grown_ways(dir).map_err(|e| format!("the growth in {} cannot be gone on from: {e}", dir.display()))
    });
    let from = match from {
        Ok(from) => from,
        Err(message) => {
            crate::fail(&message);
            return BAD_CASE;
        }
    };
    let (record, files) = match follow(case, loading, from, dir, progress) {
        Ok(Some(followed)) => followed,
        Ok(None) => return crate::fail(&stopped(case.growth.is_some(), dir)),
        Err(message) => return crate::fail(&message),
    };
    if arguments.json {
        crate::print(&std::fs::read_to_string(dir.join(RESULTS_FILE)).unwrap_or_default());
    } else {
        crate::print(&format!(
            "{}\n{}{}\n{}",
            case.model.title,
            units_line(case.units.as_ref()),
            summary(&record.curve, record.peak, &record.end),
            results::listed(&files)
        ));
    }
    if record.end.kind == GrowthEndKind::Failed { STOPPED } else { DONE }
}

/// Loads a plane body and writes what it does; none if Ctrl-C came before the end.
///
/// - `from`: where growth goes on that an earlier run began
///
/// # Errors
/// Why there are no results.
pub fn follow(
    case: &Case,
    loading: &LoadingSettings,
    from: Option<GrowthState>,
    dir: &Path,
    progress: Progress,
) -> Result<Option<(PlaneLoadingRecord, Vec<PathBuf>)>, String> {
    let unwritten = |e: &io::Error| format!("cannot write the results to {}: {}", dir.display(), results::reason(e));
    let writer = PlaneLoadingWriter::new(dir, results::options(case), &results::source(case));
    let writer = writer.map_err(|e| unwritten(&e))?;
    if case.growth.is_some() {
        Resumed::keep(&case.path, &case.text, &case.overrides, dir).map_err(|e| unwritten(&e))?;
    }
    if let Some(from) = &from {
        writer.write_ways(from).map_err(|e| unwritten(&e))?;
    }
    let mut watch = Watch { case, writer, progress, error: None, pace: Pace::default() };
    let outcome = plane_loading(&case.model, &case.settings, loading, case.growth.as_ref(), from, &mut watch);
    watch.progress.finish();
    if let Some(e) = &watch.error {
        return Err(unwritten(e));
    }
    let Some(record) = outcome.map_err(|e| e.to_string())? else { return Ok(None) };
    let status = if record.end.kind == GrowthEndKind::Failed { RunStatus::Stopped } else { RunStatus::Done };
    let info = watch.record().info(case, status);
    let files = watch.writer.finish(&info, &record).map_err(|e| unwritten(&e))?;
    Ok(Some((record, files)))
}

/// Writes the states with fields.
struct Watch<'a> {
    case: &'a Case,
    writer: PlaneLoadingWriter,
    progress: Progress,
    error: Option<io::Error>,
    pace: Pace,
}

impl Watch<'_> {
    fn record(&self) -> RunRecord {
        RunRecord {
            wall_time_s: self.progress.elapsed_s(),
            stage_time_s: self.progress.stage_time_s.clone(),
            peak_memory_bytes: peak_memory_bytes(),
        }
    }

    /// Keeps why nothing could be written; goes on unless that is so or Ctrl-C came.
    fn after(&mut self, written: io::Result<()>) -> ControlFlow<()> {
        self.error = written.err();
        if self.error.is_some() || interrupt::is_asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Observer for Watch<'_> {
    fn stage(&mut self, stage: Stage) {
        self.progress.stage(stage);
    }

    fn warning(&mut self, warning: &Warning) {
        self.progress.warning(warning);
    }

    fn wants_fields(&self, _step: usize) -> bool {
        self.case.output.fields
    }

    fn load_curve(&mut self, curve: &[LoadPoint]) -> ControlFlow<()> {
        let written = if self.pace.is_due() { self.writer.write_curve(curve) } else { Ok(()) };
        self.after(written)
    }

    fn ways_grown(&mut self, state: &GrowthState) -> ControlFlow<()> {
        let written = self.writer.write_ways(state);
        self.after(written)
    }

    fn step(&mut self, result: &StaticResult, _state: Option<&GrowthState>) -> ControlFlow<()> {
        let times = self.progress.take_stages();
        crate::log::solved(result);
        let info = self.record().info(self.case, RunStatus::Stopped);
        let written = self.writer.write_step(&info, result, &times);
        self.after(written)
    }
}
