//! A run of a solid: static, with growing cracks, or with cohesive ones under load.

use crate::analysis::{Clock, Event, FROM_PYTHON, Failure, ask, in_pool, listen};
use crate::error::of_text;
use crate::solid::{SolidCase, SolidStep};
use crate::step::State;
use pyo3::prelude::*;
use riss::analysis::{
    GrowthEnd, GrowthEndKind, LoadPoint, LoadingStep, Observer, SolidGrowthState, SolidResult, Stage, Warning,
    solid_growth, solid_loading, solid_static,
};
use riss::model::{SolidModel, UnitNames};
use riss::output::solid_files::read_solid_results;
use riss::output::solid_results::SolidStepResults;
use riss::output::{
    LoadingWriter, RunInfo, RunSource, RunStatus, SolidResults, SolidWriter, describe_run, write_solid_results,
};
use std::io;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};

/// Solves a solid, and writes its files if `out` is given; returns its record as JSON.
///
/// After Ctrl-C the run ends with the step at hand; a second one does not wait for that.
#[pyfunction]
#[pyo3(signature = (case, start, out, threads, on_stage, on_warning, on_step))]
#[allow(clippy::too_many_arguments)]
pub fn run_solid(
    py: Python<'_>,
    case: &SolidCase,
    start: Option<&State>,
    out: Option<PathBuf>,
    threads: Option<usize>,
    on_stage: Bound<'_, PyAny>,
    on_warning: Bound<'_, PyAny>,
    on_step: Bound<'_, PyAny>,
) -> PyResult<String> {
    let start = start.map(|s| s.solid(case.case.model.cracks.len())).transpose()?;
    let stop = Arc::new(AtomicBool::new(false));
    let (send, receive) = channel();
    let (case, stopped) = (case.case.clone(), stop.clone());
    let worker = std::thread::spawn(move || in_pool(threads, || solve(&case, start, out, send, stopped)));
    let answer_step = |step: SolidStep| on_step.call1((step,)).and_then(|goes_on| goes_on.is_truthy());
    let record = listen(py, receive, &stop, worker, [&on_stage, &on_warning], answer_step)?;
    serde_json::to_string(&record).map_err(of_text)
}

fn solve(
    case: &riss::case::SolidCase,
    start: Option<SolidGrowthState>,
    out: Option<PathBuf>,
    send: Sender<Event<SolidStep>>,
    stop: Arc<AtomicBool>,
) -> Result<SolidResults, Failure> {
    let mut listener = Listener {
        model: &case.model,
        units: case.units.clone(),
        send,
        stop,
        clock: Clock::new(),
        is_heard: true,
        growth: None,
        loading: None,
        grown: Grown::default(),
        at_peak: None,
        problem: None,
    };
    let files = |e: io::Error| Failure::Files(out.clone().unwrap_or_default(), e);
    if let Some(dir) = &out {
        let settings = case.effective_settings();
        let source = RunSource::begun(&case.path, &case.text, &case.overrides, settings, FROM_PYTHON);
        describe_run(dir, &source).map_err(files)?;
    }
    if let (Some(growth), None) = (&case.growth, &case.model.cohesive) {
        if let Some(dir) = &out {
            let writer = match &start {
                Some(state) => SolidWriter::resume(dir, state.step),
                None => SolidWriter::new(dir),
            };
            listener.growth = Some(writer.map_err(files)?);
        }
        let outcome = solid_growth(&case.model, &case.settings, growth, start, &mut listener);
        return match (listener.problem.take(), outcome) {
            (Some(e), _) => Err(files(e)),
            (None, Err(e)) if listener.grown.steps.is_empty() => Err(Failure::Analysis(e)),
            (None, outcome) => listener.grown_record(outcome, &out),
        };
    }
    if let (Some(cohesive), Some(loading)) = (&case.model.cohesive, &case.loading) {
        listener.loading = out.as_deref().map(LoadingWriter::new).transpose().map_err(files)?;
        let outcome =
            solid_loading(&case.model, cohesive, &case.settings, loading, case.growth.as_ref(), None, &mut listener);
        if let Some(e) = listener.problem.take() {
            return Err(files(e));
        }
        let record = outcome.map_err(Failure::Analysis)?.ok_or_else(stopped)?;
        let result = listener.at_peak.take().ok_or_else(|| Failure::Said("the load curve has no peak".into()))?;
        let is_done = record.end.kind != GrowthEndKind::Failed;
        let info = listener.info(if is_done { RunStatus::Done } else { RunStatus::Stopped });
        let mut results = SolidResults::new(&record.model, &info, &result, vec![]);
        results.loaded(&record);
        if let Some(writer) = &listener.loading {
            writer.finish(results.clone()).map_err(files)?;
        }
        return written(&out, results);
    }
    let result = solid_static(&case.model, &case.settings, &mut listener).map_err(Failure::Analysis)?;
    if listener.stop.load(Ordering::Relaxed) {
        return Err(stopped());
    }
    let info = listener.info(RunStatus::Done);
    if let Some(dir) = &out {
        write_solid_results(dir, &case.model, &info, &result).map_err(files)?;
    }
    let results = SolidResults::new(&case.model, &info, &result, vec![]);
    let record = step_record(&case.model, &result, 0);
    ask(
        &listener.send,
        SolidStep {
            record,
            surfaces: surfaces(&case.model),
            tractions: vec![],
            point: None,
            state: None,
            end: None,
            result,
        },
    );
    written(&out, results)
}

fn stopped() -> Failure {
    Failure::Said("the run was stopped".into())
}

/// What stands in the folder, which names its files; without one what is at hand.
fn written(out: &Option<PathBuf>, results: SolidResults) -> Result<SolidResults, Failure> {
    Ok(out.as_deref().and_then(read_solid_results).unwrap_or(results))
}

/// A state that is no step of growth, as a record of one.
fn step_record(model: &SolidModel, result: &SolidResult, number: usize) -> SolidStepResults {
    let areas: Vec<f64> = model.cracks.iter().map(|c| c.surface.area(None)).collect();
    let step = riss::analysis::SolidStep {
        step: number,
        model: model.clone(),
        result: result.clone(),
        areas_after: areas.clone(),
        areas,
        load_factor: None,
        n_vertices: model.cracks.iter().flat_map(|c| &c.fronts).map(|f| f.points.len()).sum(),
        n_moving: 0,
        end: None,
    };
    SolidStepResults::new(&step)
}

fn surfaces(model: &SolidModel) -> Vec<(Vec<riss::math::Vector3>, Vec<[u32; 3]>)> {
    model.cracks.iter().map(|c| (c.surface.vertices().to_vec(), c.surface.triangles().to_vec())).collect()
}

/// What is kept of growth for its record.
#[derive(Default)]
struct Grown {
    steps: Vec<SolidStepResults>,
    last: Option<(SolidModel, SolidResult)>,
}

/// Passes everything on to Python, and writes files.
struct Listener<'a> {
    model: &'a SolidModel,
    units: Option<UnitNames>,
    send: Sender<Event<SolidStep>>,
    stop: Arc<AtomicBool>,
    clock: Clock,
    /// Whether Python still wants to hear of states of loading.
    is_heard: bool,
    growth: Option<SolidWriter>,
    loading: Option<LoadingWriter>,
    grown: Grown,
    at_peak: Option<SolidResult>,
    problem: Option<io::Error>,
}

impl Listener<'_> {
    fn info(&mut self, status: RunStatus) -> RunInfo {
        self.clock.begin(None);
        RunInfo {
            title: self.model.title.clone(),
            method: "collocation".into(),
            units: self.units.clone(),
            status,
            wall_time_s: self.clock.start.elapsed().as_secs_f64(),
            stage_time_s: self.clock.stages.clone(),
            peak_memory_bytes: None,
        }
    }

    /// The record of growth; what could not be solved after the first step is why it ended.
    fn grown_record(
        &mut self,
        outcome: riss::error::Result<Option<GrowthEnd>>,
        out: &Option<PathBuf>,
    ) -> Result<SolidResults, Failure> {
        let end = outcome.unwrap_or_else(|e| Some(GrowthEnd { kind: GrowthEndKind::Failed, reason: e.to_string() }));
        let is_done = end.as_ref().is_some_and(|e| e.kind != GrowthEndKind::Failed);
        let info = self.info(if is_done { RunStatus::Done } else { RunStatus::Stopped });
        let (model, result) = self.grown.last.take().ok_or_else(|| match &end {
            Some(end) => Failure::Said(end.reason.clone()),
            None => stopped(),
        })?;
        let mut results = SolidResults::new(&model, &info, &result, vec![]);
        results.grown(std::mem::take(&mut self.grown.steps), end.clone());
        let mut results = written(out, results)?;
        results.growth_end = end;
        Ok(results)
    }

    fn goes_on(&self, answer: bool) -> ControlFlow<()> {
        if answer && !self.stop.load(Ordering::Relaxed) { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

impl Observer for Listener<'_> {
    fn stage(&mut self, stage: Stage) {
        self.clock.begin(Some(stage));
        // Nobody listens after a second Ctrl-C.
        let _ = self.send.send(Event::Stage(stage.name()));
    }

    fn warning(&mut self, warning: &Warning) {
        let _ = self.send.send(Event::Warning(warning.to_string()));
    }

    fn solid_step(&mut self, step: &riss::analysis::SolidStep, state: &SolidGrowthState) -> ControlFlow<()> {
        let is_done = step.end.as_ref().is_some_and(|e| e.kind != GrowthEndKind::Failed);
        let info = self.info(if is_done { RunStatus::Done } else { RunStatus::Stopped });
        if let Some(writer) = &mut self.growth
            && let Err(e) = writer.write_step(&info, step, state)
        {
            self.problem = Some(e);
            return ControlFlow::Break(());
        }
        let record = SolidStepResults::new(step);
        self.grown.steps.push(record.clone());
        self.grown.last = Some((step.model.clone(), step.result.clone()));
        let step = SolidStep {
            result: step.result.clone(),
            record,
            surfaces: state.cracks.iter().map(|c| (c.vertices().to_vec(), c.triangles().to_vec())).collect(),
            tractions: vec![],
            point: None,
            state: Some(state.clone()),
            end: step.end.clone(),
        };
        let answer = ask(&self.send, step);
        self.goes_on(answer)
    }

    fn load_curve(&mut self, _curve: &[LoadPoint]) -> ControlFlow<()> {
        self.goes_on(true)
    }

    fn loading_step(&mut self, step: &LoadingStep) -> ControlFlow<()> {
        if let Some(writer) = &mut self.loading
            && let Err(e) = writer.write_step(step)
        {
            self.problem = Some(e);
            return ControlFlow::Break(());
        }
        if step.is_peak {
            self.at_peak = Some(step.result.clone());
        }
        if self.is_heard {
            let told = SolidStep {
                result: step.result.clone(),
                record: step_record(self.model, &step.result, step.point),
                surfaces: surfaces(self.model),
                tractions: step.tractions.clone(),
                point: Some(step.values),
                state: None,
                end: None,
            };
            self.is_heard = ask(&self.send, told);
        }
        self.goes_on(true)
    }
}
