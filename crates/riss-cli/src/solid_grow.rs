//! `riss run` of a solid whose cracks grow.

use crate::grow::Speech;
use crate::progress::{Progress, peak_memory_bytes};
use crate::resume::{CASE_COPY, Resumed};
use crate::run::RunArguments;
use crate::table::{number, units_line};
use crate::{BAD_CASE, DONE, STOPPED, desktop, interrupt, log, results};
use riss::analysis::{
    GrowthEnd, GrowthEndKind, Observer, SolidGrowthSettings, SolidGrowthState, SolidStep, Stage, Warning, solid_growth,
};
use riss::case::SolidCase;
use riss::output::{REPORT_FILE, RESULTS_FILE, RunInfo, RunStatus, SolidWriter, solid_restart_state};
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Grows the cracks of a solid and says how; returns the exit code.
pub fn grow(
    arguments: &RunArguments,
    case: &SolidCase,
    growth: &SolidGrowthSettings,
    dir: &Path,
    progress: Progress,
    speech: Speech,
) -> u8 {
    let beginning = match arguments.resume {
        Some(_) => resumed(case, dir, arguments.from_step),
        None => begin(case, dir),
    };
    let (writer, state) = match beginning {
        Ok(beginning) => beginning,
        Err(message) => {
            crate::fail(&message);
            return BAD_CASE;
        }
    };
    let followed = follow(case, growth, writer, state, progress, speech);
    let (end, files) = match followed {
        Ok((Some(end), files)) => (end, files),
        Ok((None, _)) => {
            return crate::fail(&format!(
                "stopped, but what is done is written; riss run --resume {} goes on",
                dir.display()
            ));
        }
        Err(message) => return crate::fail(&message),
    };
    match speech {
        Speech::Table => crate::print(&format!("\ngrowth ended: {}\n\n{}", end.reason, results::listed(&files))),
        Speech::Json => crate::print(&std::fs::read_to_string(dir.join(RESULTS_FILE)).unwrap_or_default()),
        Speech::Nothing => {}
    }
    if arguments.open && dir.join(REPORT_FILE).is_file() {
        desktop::open(&dir.join(REPORT_FILE));
    }
    if end.kind == GrowthEndKind::Failed { STOPPED } else { DONE }
}

/// Begins in a folder, and keeps there what is needed to go on.
pub fn begin(case: &SolidCase, dir: &Path) -> Result<(SolidWriter, Option<SolidGrowthState>), String> {
    let failed = |e: io::Error| format!("cannot write the results to {}: {}", dir.display(), results::reason(&e));
    let writer = SolidWriter::new(dir).map_err(failed)?;
    Resumed::keep(&case.path, &case.text, &case.overrides, dir).map_err(failed)?;
    Ok((writer, None))
}

/// Refuses to go on in a folder if more than `[growth]` of the case has changed.
///
/// # Errors
/// What has changed, or that the folder has no case.
pub fn unchanged(case: &SolidCase, dir: &Path) -> Result<(), String> {
    let known = Resumed::read(dir)?;
    let before = SolidCase::parse(&known.text, &known.case, &known.overrides)
        .map_err(|_| format!("{CASE_COPY} in {} cannot be read any more", dir.display()))?;
    let Some(key) = before.differs_outside_growth(case) else { return Ok(()) };
    Err(format!(
        "{} differs from the case of {} in `{key}`; only [growth] may change in between",
        case.path.display(),
        dir.display()
    ))
}

/// Goes on in a folder; nothing but `[growth]` of the case may have changed.
fn resumed(
    case: &SolidCase,
    dir: &Path,
    from_step: Option<usize>,
) -> Result<(SolidWriter, Option<SolidGrowthState>), String> {
    unchanged(case, dir)?;
    let last = riss::output::solid_files::read_solid_results(dir).and_then(|r| r.steps.last().map(|s| s.step));
    let Some(last) = last else { return begin(case, dir) };
    let step = from_step.unwrap_or(last);
    if step > last {
        return Err(format!("step {step} is not in {}; the last one there is {last}", dir.display()));
    }
    let unread = |e: io::Error| format!("step {step} in {} cannot be gone on from: {e}", dir.display());
    let state = solid_restart_state(dir, step).map_err(unread)?;
    Ok((SolidWriter::resume(dir, step).map_err(unread)?, Some(state)))
}

/// Grows the cracks of a solid, writing every step; the end is none if Ctrl-C came before it.
///
/// # Errors
/// Why there is no end.
pub fn follow(
    case: &SolidCase,
    growth: &SolidGrowthSettings,
    writer: SolidWriter,
    state: Option<SolidGrowthState>,
    progress: Progress,
    speech: Speech,
) -> Result<(Option<GrowthEnd>, Vec<PathBuf>), String> {
    if speech == Speech::Table {
        crate::print(&format!("{}\n{}", case.model.title, units_line(case.units.as_ref())));
    }
    let mut watch = Watch { case, writer, progress, speech, error: None, files: vec![] };
    let outcome = solid_growth(&case.model, &case.settings, growth, state, &mut watch);
    watch.progress.finish();
    if let Some(e) = watch.error {
        return Err(format!("cannot write the results: {}", results::reason(&e)));
    }
    outcome.map(|end| (end, watch.files)).map_err(|e| e.to_string())
}

/// Shows and writes every step.
struct Watch<'a> {
    case: &'a SolidCase,
    writer: SolidWriter,
    progress: Progress,
    speech: Speech,
    error: Option<io::Error>,
    files: Vec<PathBuf>,
}

impl Observer for Watch<'_> {
    fn stage(&mut self, stage: Stage) {
        self.progress.stage(stage);
    }

    fn warning(&mut self, warning: &Warning) {
        self.progress.warning(warning);
    }

    fn solid_step(&mut self, step: &SolidStep, state: &SolidGrowthState) -> ControlFlow<()> {
        self.progress.take_stages();
        log::solved_solid(&step.result);
        let line = line(step);
        tracing::info!("{line}");
        if self.speech == Speech::Table {
            self.progress.line(&line);
        }
        let is_done = step.end.as_ref().is_some_and(|e| e.kind != GrowthEndKind::Failed);
        let info = RunInfo {
            title: self.case.model.title.clone(),
            method: "collocation".into(),
            units: self.case.units.clone(),
            status: if is_done { RunStatus::Done } else { RunStatus::Stopped },
            wall_time_s: self.progress.elapsed_s(),
            stage_time_s: self.progress.stage_time_s.clone(),
            peak_memory_bytes: peak_memory_bytes(),
        };
        match self.writer.write_step(&info, step, state) {
            Ok(files) => {
                self.files = files;
                let is_asked = interrupt::is_asked() && step.end.is_none();
                if is_asked { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            }
            Err(e) => {
                self.error = Some(e);
                ControlFlow::Break(())
            }
        }
    }
}

/// What happened in a step.
fn line(step: &SolidStep) -> String {
    let area: f64 = step.areas.iter().sum();
    let mut text = format!("step {}: {} nodes, crack area {}", step.step, step.result.n_nodes, number(area));
    if let Some(factor) = step.load_factor {
        text += &format!(", grows at {} of the load", number(factor));
    }
    let factors = || step.result.fronts.iter().flat_map(|f| &f.points).filter_map(|p| Some(p.factors?.factors[0]));
    if let (Some(least), Some(most)) = (factors().reduce(f64::min), factors().reduce(f64::max)) {
        text += &format!(", K_I from {} to {}", number(least), number(most));
    }
    text + &format!(", {} of {} vertices move", step.n_moving, step.n_vertices)
}
