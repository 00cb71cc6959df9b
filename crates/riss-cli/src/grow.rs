//! `riss run` of a case whose cracks grow.

use crate::progress::{Progress, peak_memory_bytes};
use crate::results::{self, RunRecord};
use crate::table::{self, number};
use crate::{DONE, STOPPED, interrupt};
use riss::analysis::{
    GrowthEnd, GrowthEndKind, GrowthSettings, GrowthState, Observer, RefinementRecord, Stage, StaticResult, StepRecord,
    TipStatus, Warning, crack_growth,
};
use riss::case::Case;
use riss::output::{RunStatus, RunWriter};
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Where growth begins, and where its results go.
pub struct Beginning {
    /// The folder of results.
    pub writer: RunWriter,
    /// The state to go on from.
    pub state: Option<GrowthState>,
}

/// How much is said while cracks grow.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Speech {
    /// One line a step, then the results.
    Table,
    /// The results as JSON.
    Json,
    /// Nothing; errors return.
    Nothing,
}

/// What growth came to.
pub struct Followed {
    end: GrowthEnd,
    last: Option<StaticResult>,
    files: Vec<PathBuf>,
}

/// Grows the cracks of a case and says how; returns the exit code.
pub fn grow(
    case: &Case,
    growth: &GrowthSettings,
    beginning: Beginning,
    dir: &Path,
    progress: Progress,
    speech: Speech,
) -> u8 {
    let followed = match follow(case, growth, beginning, dir, progress, speech) {
        Ok(followed) => followed,
        Err(message) => {
            return crate::fail(&message);
        }
    };
    match speech {
        Speech::Table => {
            let last = followed.last.as_ref().map_or(String::new(), table::summary);
            let files = results::listed(&followed.files);
            crate::print(&format!("\n{last}\ngrowth ended: {}\n\n{files}", followed.end.reason));
        }
        Speech::Json => {
            let text = std::fs::read_to_string(dir.join(riss::output::RESULTS_FILE)).unwrap_or_default();
            crate::print(&text);
        }
        Speech::Nothing => {}
    }
    exit_code(&followed.end)
}

/// Grows the cracks of a case, writing every step.
///
/// # Errors
/// Why there is no end.
pub fn follow(
    case: &Case,
    growth: &GrowthSettings,
    beginning: Beginning,
    dir: &Path,
    progress: Progress,
    speech: Speech,
) -> Result<Followed, String> {
    let Beginning { writer, state } = beginning;
    let fields = case.output.fields;
    let mut watch = Watch { case, writer, progress, speech, fields, last: None, error: None, files: vec![] };
    if speech == Speech::Table {
        crate::print(&format!("{}\n{}", case.model.title, table::units_line(case.units.as_ref())));
    }
    let outcome = crack_growth(&case.model, &case.settings, growth, state, &mut watch);
    watch.progress.finish();
    if let Some(e) = watch.error {
        return Err(format!("cannot write the results to {}: {}", dir.display(), results::reason(&e)));
    }
    match outcome {
        Ok(Some(end)) => Ok(Followed { end, last: watch.last, files: watch.files }),
        Ok(None) => {
            let step = watch.last.map_or(0, |l| l.step.step);
            Err(format!("stopped after step {step}, which is written; riss run --resume {} goes on", dir.display()))
        }
        Err(e) => Err(e.to_string()),
    }
}

fn exit_code(end: &GrowthEnd) -> u8 {
    match end.kind {
        GrowthEndKind::Failed => STOPPED,
        GrowthEndKind::StepsDone
        | GrowthEndKind::NoTipGrows
        | GrowthEndKind::Separated
        | GrowthEndKind::ToughnessReached
        | GrowthEndKind::LimitReached => DONE,
    }
}

/// Shows and writes every step.
struct Watch<'a> {
    case: &'a Case,
    writer: RunWriter,
    progress: Progress,
    speech: Speech,
    fields: bool,
    last: Option<StaticResult>,
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

    fn refinement(&mut self, record: &RefinementRecord) {
        self.progress.refinement(record);
    }

    fn wants_fields(&self, _step: usize) -> bool {
        self.fields
    }

    fn step(&mut self, result: &StaticResult, state: Option<&GrowthState>) -> ControlFlow<()> {
        let times = self.progress.take_stages();
        crate::log::solved(result);
        step_lines(&result.step).iter().for_each(|line| tracing::info!("{}", line.trim()));
        if let Some(end) = &result.step.end {
            tracing::info!("growth ended: {}", end.reason);
        }
        if self.speech == Speech::Table {
            step_lines(&result.step).iter().for_each(|line| self.progress.line(line));
            table::warnings(self.case, result).lines().for_each(|line| self.progress.line(line));
        }
        let status = match &result.step.end {
            Some(end) if exit_code(end) == DONE => RunStatus::Done,
            Some(_) | None => RunStatus::Stopped,
        };
        let run = RunRecord {
            wall_time_s: self.progress.elapsed_s(),
            stage_time_s: self.progress.stage_time_s.clone(),
            peak_memory_bytes: peak_memory_bytes(),
        };
        let written = self.writer.write_step(&run.info(self.case, status), result, &times, state);
        self.last = Some(result.clone());
        match written {
            Ok(files) => {
                self.files = files;
                let is_asked = interrupt::is_asked() && result.step.end.is_none();
                if is_asked { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            }
            Err(e) => {
                self.error = Some(e);
                ControlFlow::Break(())
            }
        }
    }
}

/// One line for the step, or one for each tip that does something if there are several.
fn step_lines(step: &StepRecord) -> Vec<String> {
    let mut head = format!("step {}", step.step);
    if let Some(cycles) = step.cycles {
        head += &format!(", {} cycles", number(cycles));
    }
    if step.load_factor != 1.0 {
        head += &format!(", load factor {}", number(step.load_factor));
    }
    let mut tips = vec![];
    for crack in &step.cracks {
        for tip in &crack.tips {
            let known = |v: Option<f64>| v.map_or("-".into(), number);
            let does = match tip.status {
                TipStatus::Growing => {
                    let turn = tip.kink_angle.unwrap_or(0.0).to_degrees();
                    format!("turns {turn:+.2}°, grows {}", known(tip.increment))
                }
                status => status.name().to_string(),
            };
            let end = if tip.end.index() == 0 { "start" } else { "end" };
            let at = format!("({}, {})", number(tip.position.x), number(tip.position.y));
            tips.push(format!("{} {end} at {at}: K_I {}, K_II {}: {does}", crack.name, known(tip.k1), known(tip.k2)));
        }
    }
    match tips.len() {
        0 => vec![head + ": no tip"],
        1 => vec![format!("{head}: {}", tips[0])],
        _ => std::iter::once(head).chain(tips.into_iter().map(|t| format!("  {t}"))).collect(),
    }
}
