//! `riss compare` of solids.

use crate::STOPPED;
use crate::progress::{Progress, peak_memory_bytes};
use crate::table::{aligned, number};
use riss::analysis::{
    GrowthEndKind, LoadingStep, Observer, SolidGrowthState, SolidResult, SolidStep, Stage, Warning, solid_growth,
    solid_loading, solid_static,
};
use riss::case::SolidCase;
use riss::model::SolidModel;
use riss::output::loading_comparison::LoadingComparison;
use riss::output::solid_comparison::FrontComparison;
use riss::output::solid_results::SolidStepResults;
use riss::output::{RunInfo, RunStatus, SolidComparison, SolidResults};
use std::ops::ControlFlow;

/// Runs a case without writing anything.
pub fn run_case(case: &SolidCase, is_quiet: bool) -> Result<SolidResults, u8> {
    let progress = Progress::new(is_quiet);
    let mut watch = Watch { progress, steps: vec![], last: None, at_peak: None };
    solve(case, &mut watch).map_err(|reason| {
        eprintln!("error: {}: {reason}", case.path.display());
        STOPPED
    })
}

fn solve(case: &SolidCase, watch: &mut Watch) -> Result<SolidResults, String> {
    let (model, settings) = (&case.model, &case.settings);
    if let (Some(growth), None) = (&case.growth, &model.cohesive) {
        let end = solid_growth(model, settings, growth, None, watch).map_err(|e| e.to_string())?;
        let (model, result) = watch.last.take().ok_or("there is no step")?;
        let is_done = end.as_ref().is_some_and(|e| e.kind != GrowthEndKind::Failed);
        let mut results = SolidResults::new(&model, &watch.info(case, is_done), &result, vec![]);
        results.grown(std::mem::take(&mut watch.steps), end);
        return Ok(results);
    }
    if let (Some(cohesive), Some(loading)) = (&model.cohesive, &case.loading) {
        let record = solid_loading(model, cohesive, settings, loading, case.growth.as_ref(), None, watch)
            .map_err(|e| e.to_string())?;
        let (record, result) = record.zip(watch.at_peak.take()).ok_or("the load curve has no peak")?;
        let info = watch.info(case, record.end.kind != GrowthEndKind::Failed);
        let mut results = SolidResults::new(&record.model, &info, &result, vec![]);
        results.loaded(&record);
        return Ok(results);
    }
    let result = solid_static(model, settings, watch).map_err(|e| e.to_string())?;
    Ok(SolidResults::new(model, &watch.info(case, true), &result, vec![]))
}

/// Keeps what the results are made of.
struct Watch {
    progress: Progress,
    steps: Vec<SolidStepResults>,
    last: Option<(SolidModel, SolidResult)>,
    at_peak: Option<SolidResult>,
}

impl Watch {
    fn info(&mut self, case: &SolidCase, is_done: bool) -> RunInfo {
        RunInfo {
            title: case.model.title.clone(),
            method: "collocation".into(),
            units: case.units.clone(),
            status: if is_done { RunStatus::Done } else { RunStatus::Stopped },
            wall_time_s: self.progress.finish(),
            stage_time_s: std::mem::take(&mut self.progress.stage_time_s),
            peak_memory_bytes: peak_memory_bytes(),
        }
    }
}

impl Observer for Watch {
    fn stage(&mut self, stage: Stage) {
        self.progress.stage(stage);
    }

    fn warning(&mut self, warning: &Warning) {
        self.progress.warning(warning);
    }

    fn solid_step(&mut self, step: &SolidStep, _state: &SolidGrowthState) -> ControlFlow<()> {
        self.progress.take_stages();
        self.steps.push(SolidStepResults::new(step));
        self.last = Some((step.model.clone(), step.result.clone()));
        ControlFlow::Continue(())
    }

    fn loading_step(&mut self, step: &LoadingStep) -> ControlFlow<()> {
        if step.is_peak {
            self.at_peak = Some(step.result.clone());
        }
        ControlFlow::Continue(())
    }
}

fn percent(v: f64) -> String {
    format!("{} %", number(100.0 * v))
}

fn known(v: Option<f64>, show: fn(f64) -> String) -> String {
    v.map_or("-".to_string(), show)
}

/// The differences as tables.
pub fn describe(comparison: &SolidComparison) -> String {
    let grows = comparison.steps.iter().any(|s| s.crack_areas.iter().any(Option::is_some));
    let mut parts = vec![];
    if grows {
        let by_strength = comparison.steps.iter().any(|s| s.load_factors.iter().any(Option::is_some));
        let rows: Vec<Vec<String>> = (comparison.steps.iter())
            .map(|s| {
                let mut row: Vec<String> = s.steps.map(|n| n.to_string()).into();
                row.extend(s.crack_areas.map(|v| known(v, number)));
                if by_strength {
                    row.extend(s.load_factors.map(|v| known(v, number)));
                }
                row
            })
            .collect();
        let mut head = vec!["step A", "step B", "crack area A", "crack area B"];
        if by_strength {
            head.extend(["load factor A", "load factor B"]);
        }
        parts.push(aligned(&head, &rows, &[]));
    }
    let fronts: Vec<Vec<String>> = (comparison.steps.iter())
        .flat_map(|s| s.fronts.iter().map(move |f| (s.steps[0], f)))
        .map(|(step, f)| front_row(grows.then_some(step), f))
        .collect();
    if !fronts.is_empty() {
        let mut head = if grows { vec!["step A"] } else { vec![] };
        head.extend(["crack", "front", "length A", "length B", "front distance", "points", "K difference"]);
        head.extend(["at s", "mean", "error bar there"]);
        parts.push(aligned(&head, &fronts, &[usize::from(grows)]));
    }
    parts.extend(comparison.loading.as_ref().map(loading_table));
    if parts.is_empty() {
        let row: Vec<String> = comparison.largest_principal.map(|v| known(v, number)).into();
        parts.push(aligned(&["largest principal stress A", "B"], &[row], &[]));
    }
    let mut text = parts.join("\n");
    let steps = |of: &[usize]| of.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    for (numbers, which) in [(&comparison.only_in_first, "A"), (&comparison.only_in_second, "B")] {
        if !numbers.is_empty() {
            text += &format!("\nsteps only in {which}: {}\n", steps(numbers));
        }
    }
    for line in &comparison.unlike {
        text += &format!("\n{line}\n");
    }
    text
}

fn front_row(step: Option<usize>, f: &FrontComparison) -> Vec<String> {
    let mut row: Vec<String> = step.map(|s| s.to_string()).into_iter().collect();
    row.extend([f.crack.clone(), f.front.to_string()]);
    row.extend(f.lengths.map(|v| known(v, number)));
    row.extend([known(f.front_distance, number), f.points.to_string(), known(f.k_difference, percent)]);
    row.extend([known(f.s, number), known(f.k_difference_mean, percent), known(f.k_uncertainty, percent)]);
    row
}

/// Differences of load curves.
pub fn loading_table(l: &LoadingComparison) -> String {
    let row = |name: &str, values: [Option<f64>; 2]| {
        let difference = values[0].zip(values[1]).filter(|(a, _)| *a != 0.0).map(|(a, b)| (b - a) / a.abs());
        let [a, b] = values.map(|v| known(v, number));
        vec![name.to_string(), a, b, known(difference, percent)]
    };
    let rows = [
        row("peak load", l.peak_loads),
        row("displacement at peak", l.peak_displacements),
        row("dissipated energy", l.dissipated_energies),
    ];
    let table = aligned(&["load curve", "A", "B", "difference"], &rows, &[0]);
    format!("{table}the curves are {} of their size apart\n", percent(l.curve_distance))
}
