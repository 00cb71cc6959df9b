//! `riss run` of a solid with cohesive cracks.

use crate::load_curve::{Pace, stopped, summary};
use crate::progress::{Progress, peak_memory_bytes};
use crate::resume::Resumed;
use crate::run::RunArguments;
use crate::table::units_line;
use crate::{BAD_CASE, DONE, STOPPED, desktop, interrupt, results, solid_grow};
use riss::analysis::{
    CohesiveSurfaces, GrowthEndKind, LoadPoint, LoadingRecord, LoadingSettings, LoadingStep, Observer, Stage, Warning,
    solid_loading,
};
use riss::case::SolidCase;
use riss::model::CohesiveModel;
use riss::output::{LoadingWriter, REPORT_FILE, RunInfo, RunStatus, SolidResults, grown_surfaces};
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Loads a solid and says how it broke; returns the exit code.
pub fn load(
    arguments: &RunArguments,
    case: &SolidCase,
    cohesive: &CohesiveModel<3>,
    loading: &LoadingSettings,
    dir: &Path,
    progress: Progress,
) -> u8 {
    let from = match arguments.resume {
        Some(_) => resumed(case, dir),
        None => Ok(None),
    };
    let from = match from {
        Ok(from) => from,
        Err(message) => {
            crate::fail(&message);
            return BAD_CASE;
        }
    };
    let followed = match follow(case, cohesive, loading, from, dir, progress) {
        Ok(Some(followed)) => followed,
        Ok(None) => return crate::fail(&stopped(case.growth.is_some(), dir)),
        Err(message) => return crate::fail(&message),
    };
    if arguments.json {
        let text = serde_json::to_string_pretty(&followed.results);
        crate::print(&format!("{}\n", text.unwrap_or_default()));
    } else {
        crate::print(&format!(
            "{}\n{}{}\n{}",
            case.model.title,
            units_line(case.units.as_ref()),
            summary(&followed.record.curve, followed.record.peak, &followed.record.end),
            results::listed(&followed.files)
        ));
    }
    if arguments.open {
        desktop::open(&dir.join(REPORT_FILE));
    }
    if followed.record.end.kind == GrowthEndKind::Failed { STOPPED } else { DONE }
}

/// The surfaces that a run in this folder had grown; nothing but `[growth]` of the case may have changed.
fn resumed(case: &SolidCase, dir: &Path) -> Result<Option<CohesiveSurfaces>, String> {
    solid_grow::unchanged(case, dir)?;
    grown_surfaces(dir).map_err(|e| format!("the surfaces in {} cannot be gone on from: {e}", dir.display()))
}

/// A load curve that was written.
pub struct Followed {
    record: LoadingRecord,
    /// What stands in `results.json`.
    pub results: SolidResults,
    files: Vec<PathBuf>,
}

/// Loads a solid and writes what it does; none if Ctrl-C came before the end.
///
/// - `from`: surfaces that an earlier run had grown, to go on with
///
/// # Errors
/// Why there are no results.
pub fn follow(
    case: &SolidCase,
    cohesive: &CohesiveModel<3>,
    loading: &LoadingSettings,
    from: Option<CohesiveSurfaces>,
    dir: &Path,
    progress: Progress,
) -> Result<Option<Followed>, String> {
    let unwritten = |e: &io::Error| format!("cannot write the results to {}: {}", dir.display(), results::reason(e));
    let writer = LoadingWriter::new(dir).map_err(|e| unwritten(&e))?;
    if case.growth.is_some() {
        Resumed::keep(&case.path, &case.text, &case.overrides, dir).map_err(|e| unwritten(&e))?;
    }
    if let Some(from) = &from {
        writer.write_surfaces(from).map_err(|e| unwritten(&e))?;
    }
    let mut watch = Watch { writer, progress, error: None, pace: Pace::default() };
    let outcome = solid_loading(&case.model, cohesive, &case.settings, loading, case.growth.as_ref(), from, &mut watch);
    let wall_time_s = watch.progress.finish();
    if let Some(e) = &watch.error {
        return Err(unwritten(e));
    }
    let Some(record) = outcome.map_err(|e| e.to_string())? else { return Ok(None) };
    let is_done = record.end.kind != GrowthEndKind::Failed;
    let info = RunInfo {
        title: case.model.title.clone(),
        method: "collocation".into(),
        units: case.units.clone(),
        status: if is_done { RunStatus::Done } else { RunStatus::Stopped },
        wall_time_s,
        stage_time_s: std::mem::take(&mut watch.progress.stage_time_s),
        peak_memory_bytes: peak_memory_bytes(),
    };
    let results = watch.writer.results(&info, &record).ok_or("the load curve has no peak")?;
    let files = watch.writer.finish(results.clone()).map_err(|e| unwritten(&e))?;
    Ok(Some(Followed { record, results, files }))
}

/// Writes the steps with fields.
struct Watch {
    writer: LoadingWriter,
    progress: Progress,
    error: Option<io::Error>,
    pace: Pace,
}

impl Watch {
    /// Keeps why nothing could be written; goes on unless that is so or Ctrl-C came.
    fn after(&mut self, written: io::Result<()>) -> ControlFlow<()> {
        self.error = written.err();
        if self.error.is_some() || interrupt::is_asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Observer for Watch {
    fn stage(&mut self, stage: Stage) {
        self.progress.stage(stage);
    }

    fn warning(&mut self, warning: &Warning) {
        self.progress.warning(warning);
    }

    fn load_curve(&mut self, curve: &[LoadPoint]) -> ControlFlow<()> {
        let written = if self.pace.is_due() { self.writer.write_curve(curve) } else { Ok(()) };
        self.after(written)
    }

    fn surfaces_grown(&mut self, surfaces: &CohesiveSurfaces) -> ControlFlow<()> {
        let written = self.writer.write_surfaces(surfaces);
        self.after(written)
    }

    fn loading_step(&mut self, step: &LoadingStep) -> ControlFlow<()> {
        let written = self.writer.write_step(step);
        self.after(written)
    }
}
