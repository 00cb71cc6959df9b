//! `riss run`.

use crate::claim::Claim;
use crate::grow::{self, Speech};
use crate::log::{self, LogArguments};
use crate::memory::MemoryLimit;
use crate::progress::{Progress, peak_memory_bytes};
use crate::results::{self, RunRecord};
use crate::resume::{self, Obstacle, Resumed};
use crate::sweep::Sweep;
use crate::{BAD_CASE, DONE, batch, desktop, diagnostics, interrupt, plane_loading, solid, table};
use clap::Args;
use riss::analysis::{RunSize, StaticResult, linear_static};
use riss::case::{AnyCase, Case};
use std::io;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "Examples:
  riss run case.toml
  riss run case.toml --set material.young=70e3 --open
  riss run left.toml right.toml --out both
  riss run case.toml --sweep 'crack[0].path[1][0]=10..50:10'
  riss run case.toml --sweep a=10..50:10 --sweep approximation.basis=linear,quadratic
  riss run --resume case.riss-out --set growth.steps=20";

/// Arguments of `riss run`.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct RunArguments {
    /// Case files; several run side by side. Not needed with --resume
    #[arg(required_unless_present = "resume", value_name = "CASE")]
    pub cases: Vec<PathBuf>,
    /// Runs once for each value of a key or a parameter: FROM..TO:STEP or a list; several make all combinations
    #[arg(long = "sweep", value_name = "KEY=VALUES", conflicts_with = "resume", value_parser = Sweep::parse)]
    pub sweeps: Vec<Sweep>,
    /// Goes on with the growth in a folder of results, with the growth settings that the case has now
    #[arg(long, value_name = "DIR", conflicts_with = "out")]
    pub resume: Option<PathBuf>,
    /// Step to go on from [default: the last that is finished]
    #[arg(long, value_name = "N", requires = "resume")]
    pub from_step: Option<usize>,
    /// Folder for the results [default: NAME.riss-out in the current folder; NAME.riss-sweep for a sweep, riss-out for
    /// several cases, with a folder for each run]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Overrides a key of the case, such as material.young=70e9; may be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<String>,
    /// Number of threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Prints the results as JSON instead of a table
    #[arg(long)]
    pub json: bool,
    /// Opens the report in the browser of the desktop; not for several runs
    #[arg(long, conflicts_with = "sweeps")]
    pub open: bool,
    /// Refuses a run that needs more memory, such as 12GB: `free` is what the machine has, `none` is no limit
    #[arg(long, value_name = "SIZE", default_value = "free", value_parser = MemoryLimit::parse)]
    pub memory_limit: MemoryLimit,
    #[command(flatten)]
    pub log: LogArguments,
    /// Shows no progress and no notes
    #[arg(long, short)]
    pub quiet: bool,
}

/// Runs a case; returns the exit code.
pub fn run(arguments: &RunArguments) -> u8 {
    if let Some(n) = arguments.threads
        && let Err(e) = rayon::ThreadPoolBuilder::new().num_threads(n.into()).build_global()
    {
        return refuse(&format!("cannot start {n} threads: {e}"));
    }
    if let Err(e) = arguments.log.start() {
        return crate::fail(&e);
    }
    let code = run_all(arguments);
    tracing::info!("exit code {code}");
    code
}

fn run_all(arguments: &RunArguments) -> u8 {
    match arguments.cases.len() {
        0 | 1 if arguments.sweeps.is_empty() => run_one(arguments),
        0 | 1 => batch::run(arguments),
        _ if arguments.resume.is_some() => refuse("--resume goes on with one case"),
        _ if arguments.open => refuse("--open shows one run; open the report in the folder of the run that you want"),
        _ => batch::run(arguments),
    }
}

fn run_one(arguments: &RunArguments) -> u8 {
    let known = match arguments.resume.as_deref().map(Resumed::read).transpose() {
        Ok(known) => known,
        Err(message) => return refuse(&message),
    };
    let overrides = known.as_ref().map_or(vec![], |k| k.overrides.clone());
    let overrides: Vec<String> = overrides.into_iter().chain(arguments.overrides.iter().cloned()).collect();
    let path = arguments.cases.first().cloned().or_else(|| known.as_ref().map(|k| k.case.clone())).unwrap_or_default();
    let case = match AnyCase::read(&path, &overrides) {
        Ok(AnyCase::Plane(case)) => *case,
        Ok(AnyCase::Solid(case)) if arguments.from_step.is_some() && case.model.cohesive.is_some() => {
            return refuse(
                "runs with cohesive cracks go on with the last surfaces, not from a step: leave out --from-step",
            );
        }
        Ok(AnyCase::Solid(case)) if arguments.resume.is_some() && case.growth.is_none() => {
            return refuse("the case has no [growth]: there is nothing to go on with");
        }
        Ok(AnyCase::Solid(case)) => {
            let dir = arguments.resume.as_ref().or(arguments.out.as_ref()).cloned();
            let dir = dir.unwrap_or_else(|| results::default_folder(&path));
            return solid::run(arguments, &case, &dir);
        }
        Err(errors) => {
            diagnostics::report_errors(&errors);
            return BAD_CASE;
        }
    };
    if !arguments.quiet {
        diagnostics::report_notes(&case);
    }
    let size = RunSize::of_plane(&case.model, &case.settings, case.growth.as_ref());
    log::begin(&path, &case.model.title, case.settings.method.name(), &size);
    case.notes.iter().for_each(|n| tracing::warn!("{}: {n}", case.place(n)));
    if let Some(reason) = arguments.memory_limit.refusal(&size) {
        return refuse(&reason);
    }
    let dir = match &arguments.resume {
        Some(dir) => dir.clone(),
        None => arguments.out.clone().unwrap_or_else(|| results::default_folder(&path)),
    };
    // Before hours of work, not after.
    let _claim = match Claim::of(&dir) {
        Ok(claim) => claim,
        Err(e) => return cannot_write(&dir, &e),
    };
    interrupt::listen();
    let code = analyze(arguments, &case, known, &dir);
    if arguments.open && dir.join(riss::output::REPORT_FILE).is_file() {
        desktop::open(&dir.join(riss::output::REPORT_FILE));
    }
    code
}

fn analyze(arguments: &RunArguments, case: &Case, known: Option<Resumed>, dir: &Path) -> u8 {
    let progress = Progress::new(arguments.quiet || arguments.log.is_on_terminal());
    if let Some(loading) = &case.loading {
        return match (&case.growth, &known) {
            (None, Some(_)) => refuse("the case has no [growth]: there is nothing to go on with"),
            (Some(_), Some(_)) if arguments.from_step.is_some() => {
                refuse("runs with cohesive cracks go on where they were, not from a step: leave out --from-step")
            }
            (_, known) => plane_loading::load(arguments, case, loading, known.as_ref(), dir, progress),
        };
    }
    match (&case.growth, known) {
        (None, None) => run_static(arguments, case, dir, progress),
        (None, Some(_)) => refuse("the case has no [growth]: there is nothing to go on with"),
        (Some(growth), known) => {
            let beginning = match &known {
                Some(known) => known.beginning(case, dir, arguments.from_step),
                None => resume::begin(case, dir),
            };
            let speech = if arguments.json { Speech::Json } else { Speech::Table };
            match beginning {
                Ok(beginning) => grow::grow(case, growth, beginning, dir, progress, speech),
                Err(Obstacle::Request(message)) => refuse(&message),
                Err(Obstacle::Folder(message)) => crate::fail(&message),
            }
        }
    }
}

fn refuse(message: &str) -> u8 {
    crate::fail(message);
    BAD_CASE
}

fn run_static(arguments: &RunArguments, case: &Case, dir: &Path, mut progress: Progress) -> u8 {
    let outcome = linear_static(&case.model, &case.settings, &mut progress);
    let wall_time_s = progress.finish();
    match outcome {
        Ok(result) => {
            log::solved(&result);
            let stage_time_s = std::mem::take(&mut progress.stage_time_s);
            let run = RunRecord { wall_time_s, stage_time_s, peak_memory_bytes: peak_memory_bytes() };
            deliver(arguments, dir, case, &run, &result)
        }
        Err(error) => crate::fail(&error.to_string()),
    }
}

/// Writes files and prints the results.
fn deliver(arguments: &RunArguments, dir: &Path, case: &Case, run: &RunRecord, result: &StaticResult) -> u8 {
    let written = results::write(dir, case, run, result);
    if arguments.json {
        crate::print(&results::json(case, run, result));
    } else {
        let size = format!("{} nodes, {} unknowns, {:.2} s", result.n_nodes, result.n_unknowns, run.wall_time_s);
        let (title, units) = (&case.model.title, table::units_line(case.units.as_ref()));
        let warnings = table::warnings(case, result);
        let gap = if warnings.is_empty() { "" } else { "\n" };
        crate::print(&format!("{title}\n{size}\n{units}\n{}{gap}{warnings}", table::summary(result)));
    }
    match written {
        Ok(files) => {
            if !arguments.json {
                crate::print(&format!("\n{}", results::listed(&files)));
            }
            DONE
        }
        Err(e) => cannot_write(dir, &e),
    }
}

fn cannot_write(dir: &Path, error: &io::Error) -> u8 {
    crate::fail(&format!("cannot write the results to {}: {}", dir.display(), results::reason(error)))
}
