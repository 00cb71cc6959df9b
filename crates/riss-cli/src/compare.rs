//! `riss compare`.

use crate::progress::{Progress, peak_memory_bytes};
use crate::results::RunRecord;
use crate::table::{aligned, number};
use crate::{BAD_CASE, DIFFERENT, DONE, STOPPED, diagnostics, solid_compare};
use clap::Args;
use riss::analysis::{
    GrowthState, Observer, RefinementRecord, Stage, StaticResult, Warning, crack_growth, linear_static, plane_loading,
};
use riss::case::{AnyCase, Case};
use riss::output::loading_comparison::Tolerances;
use riss::output::results::StepResults;
use riss::output::{AnyResults, Comparison, RESULTS_FILE, Results, RunStatus, SolidComparison, read_any_results};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Arguments of `riss compare`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  riss compare coarse.riss-out fine.riss-out\n  riss compare case.toml case.toml --set approximation.basis=quadratic\n  riss compare before.riss-out after.riss-out --K 0.5 --path 0.1 --json\n  riss compare penny.toml penny.toml --set nodes.front_spacing=0.06"
)]
pub struct CompareArguments {
    /// First run: a folder of results, or a case to run now
    #[arg(value_name = "A")]
    pub first: PathBuf,
    /// Second run: a folder of results, or a case to run now
    #[arg(value_name = "B")]
    pub second: PathBuf,
    /// Overrides a key of the second case; may be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<String>,
    /// Largest difference of K that still agrees [% of its magnitude]
    #[arg(long = "K", value_name = "PERCENT", default_value_t = 1.0)]
    pub k: f64,
    /// Largest distance of paths, or of fronts of solids, that still agrees [% of their length]
    #[arg(long, value_name = "PERCENT", default_value_t = 1.0)]
    pub path: f64,
    /// Largest difference of load curves that still agrees [% of the peak load]; of stress, where nothing is cracked
    #[arg(long, value_name = "PERCENT", default_value_t = 1.0)]
    pub load: f64,
    /// Prints the differences as JSON instead of a table
    #[arg(long)]
    pub json: bool,
    /// Shows no progress
    #[arg(long, short)]
    pub quiet: bool,
}

/// Compares two runs; returns the exit code.
pub fn compare(arguments: &CompareArguments) -> u8 {
    let read = |path: &Path, overrides: &[String]| match path.is_dir() {
        true => read_folder(path, overrides),
        false => run_case(path, overrides, arguments.quiet),
    };
    let (first, second) = match (read(&arguments.first, &[]), read(&arguments.second, &arguments.overrides)) {
        (Ok(first), Ok(second)) => (first, second),
        (Err(code), _) | (_, Err(code)) => return code,
    };
    let [path, k, load] = [arguments.path, arguments.k, arguments.load].map(|v| 0.01 * v);
    let allowed = Tolerances { path, k, load };
    let (text, json, agrees) = match (&first, &second) {
        (AnyResults::Plane(first), AnyResults::Plane(second)) => {
            let comparison = Comparison::new(first, second);
            let agrees = comparison.agrees(&allowed);
            (describe(&comparison), serde_json::to_string_pretty(&comparison), agrees)
        }
        (AnyResults::Solid(first), AnyResults::Solid(second)) => {
            let comparison = SolidComparison::new(first, second);
            let agrees = comparison.agrees(&allowed);
            (solid_compare::describe(&comparison), serde_json::to_string_pretty(&comparison), agrees)
        }
        (AnyResults::Plane(_), AnyResults::Solid(_)) => return unlike(&arguments.first, &arguments.second),
        (AnyResults::Solid(_), AnyResults::Plane(_)) => return unlike(&arguments.second, &arguments.first),
    };
    match arguments.json {
        true => crate::print(&format!("{}\n", json.expect("plain values"))),
        false => crate::print(&text),
    }
    if agrees { DONE } else { DIFFERENT }
}

fn unlike(plane: &Path, solid: &Path) -> u8 {
    eprintln!(
        "error: {} is a body in the plane and {} a solid: their cracks cannot be compared",
        plane.display(),
        solid.display()
    );
    BAD_CASE
}

fn read_folder(dir: &Path, overrides: &[String]) -> Result<AnyResults, u8> {
    if !overrides.is_empty() {
        eprintln!("error: {} holds results: there is nothing to override", dir.display());
        return Err(BAD_CASE);
    }
    read_any_results(dir).map_err(|e| {
        eprintln!("error: {} cannot be read: {e}", dir.join(RESULTS_FILE).display());
        BAD_CASE
    })
}

/// Runs a case without writing anything.
fn run_case(path: &Path, overrides: &[String], is_quiet: bool) -> Result<AnyResults, u8> {
    let case = AnyCase::read(path, overrides).map_err(|errors| {
        diagnostics::report_errors(&errors);
        BAD_CASE
    })?;
    match case {
        AnyCase::Plane(case) => run_plane(&case, is_quiet).map(|r| AnyResults::Plane(Box::new(r))),
        AnyCase::Solid(case) => solid_compare::run_case(&case, is_quiet).map(|r| AnyResults::Solid(Box::new(r))),
    }
}

fn run_plane(case: &Case, is_quiet: bool) -> Result<Results, u8> {
    let mut watch = Watch { progress: Progress::new(is_quiet), steps: vec![], last: None };
    let (model, settings) = (&case.model, &case.settings);
    let outcome = match (&case.loading, &case.growth) {
        (Some(loading), growth) => plane_loading(model, settings, loading, growth.as_ref(), None, &mut watch),
        (None, Some(growth)) => crack_growth(model, settings, growth, None, &mut watch).map(|_| None),
        (None, None) => linear_static(model, settings, &mut watch).map(|_| None),
    };
    let wall_time_s = watch.progress.finish();
    let record = outcome.map_err(|error| {
        eprintln!("error: {}: {error}", case.path.display());
        STOPPED
    })?;
    let stage_time_s = std::mem::take(&mut watch.progress.stage_time_s);
    let run = RunRecord { wall_time_s, stage_time_s, peak_memory_bytes: peak_memory_bytes() };
    let info = run.info(case, RunStatus::Done);
    let Some(last) = watch.last else {
        eprintln!("error: {}: the load curve has no peak", case.path.display());
        return Err(STOPPED);
    };
    let mut results = Results::of_steps(&info, &last, watch.steps);
    record.iter().for_each(|record| results.loaded(record));
    Ok(results)
}

/// Keeps every step.
struct Watch {
    progress: Progress,
    steps: Vec<StepResults>,
    last: Option<StaticResult>,
}

impl Observer for Watch {
    fn stage(&mut self, stage: Stage) {
        self.progress.stage(stage);
    }

    fn refinement(&mut self, record: &RefinementRecord) {
        self.progress.refinement(record);
    }

    fn warning(&mut self, warning: &Warning) {
        self.progress.warning(warning);
    }

    fn wants_fields(&self, _step: usize) -> bool {
        false
    }

    fn step(&mut self, result: &StaticResult, _state: Option<&GrowthState>) -> ControlFlow<()> {
        self.steps.push(StepResults::new(result, &[]));
        self.last = Some(result.clone());
        ControlFlow::Continue(())
    }
}

fn describe(comparison: &Comparison) -> String {
    let percent = |v: f64| format!("{} %", number(100.0 * v));
    let known = |v: Option<f64>, show: &dyn Fn(f64) -> String| v.map_or("-".to_string(), show);
    let paths: Vec<Vec<String>> = (comparison.cracks.iter())
        .map(|c| {
            let [a, b] = c.lengths.map(number);
            vec![c.name.clone(), a, b, number(c.path_distance), percent(c.path_distance_relative)]
        })
        .collect();
    let mut text = aligned(&["crack", "length A", "length B", "path distance", "of length A"], &paths, &[0]);
    let tips: Vec<Vec<String>> = (comparison.cracks.iter())
        .flat_map(|c| c.tips.iter().map(move |t| (c, t)))
        .map(|(c, t)| {
            vec![
                c.name.clone(),
                if t.end.index() == 0 { "start" } else { "end" }.into(),
                t.steps.to_string(),
                known(t.k_difference, &percent),
                known(t.grown, &number),
                known(t.k_difference_mean, &percent),
                known(t.k_uncertainty, &percent),
            ]
        })
        .collect();
    if !tips.is_empty() {
        let head = ["crack", "end", "steps", "K difference", "when grown by", "mean", "error bar there"];
        text += &format!("\n{}", aligned(&head, &tips, &[0, 1]));
    }
    if let Some(loading) = &comparison.loading {
        text += &format!("\n{}", solid_compare::loading_table(loading));
    } else if comparison.one_load_curve {
        text += "\nonly one of them has a load curve\n";
    }
    for (names, which) in [(&comparison.only_in_first, "A"), (&comparison.only_in_second, "B")] {
        if !names.is_empty() {
            text += &format!("\nonly in {which}: {}\n", names.join(", "));
        }
    }
    text
}
