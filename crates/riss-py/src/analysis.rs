//! A run in a thread of its own, so that Python can be interrupted and callbacks run where they belong.

use crate::case::Case;
use crate::error;
use crate::step::{State, Step};
use pyo3::prelude::*;
use riss::analysis::{
    GrowthEndKind, GrowthState, LoadPoint, Observer, Stage, StaticResult, Warning, crack_growth, linear_static,
    plane_loading,
};
use riss::output::load_curve::loading_json;
use riss::output::results::StepResults;
use riss::output::{OutputOptions, PlaneLoadingWriter, RunInfo, RunSource, RunStatus, RunWriter};
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// How often Ctrl-C is looked for.
const PATIENCE: Duration = Duration::from_millis(50);
/// The load curve is written anew after as many points.
const CURVE_PACE: usize = 100;

/// What the run says to Python.
pub enum Event<S> {
    /// A stage begins.
    Stage(&'static str),
    /// Something that deserves a second look.
    Warning(String),
    /// A step, and where the answer goes: whether to go on.
    Step(Box<S>, Sender<bool>),
}

/// Tells of a step and waits for what Python says to it: whether to go on.
pub fn ask<S>(send: &Sender<Event<S>>, step: S) -> bool {
    let (answer, wait) = channel();
    send.send(Event::Step(Box::new(step), answer)).is_ok() && wait.recv().unwrap_or(false)
}

/// What went wrong in the thread of the run.
pub enum Failure {
    /// In the analysis.
    Analysis(riss::error::Error),
    /// Of the files of a folder.
    Files(PathBuf, std::io::Error),
    /// In words.
    Said(String),
}

/// Runs a case to its end; steps go to `on_step`, which returns whether to go on.
///
/// Returns the load curve of cohesive cracks with what became of it, as JSON; none without.
///
/// Ctrl-C ends the run after the step at hand, a second one at once. Errors of the callbacks end it, too.
#[pyfunction]
#[pyo3(signature = (case, start, out, threads, on_stage, on_warning, on_step))]
#[allow(clippy::too_many_arguments)]
pub fn run(
    py: Python<'_>,
    case: &Case,
    start: Option<&State>,
    out: Option<PathBuf>,
    threads: Option<usize>,
    on_stage: Bound<'_, PyAny>,
    on_warning: Bound<'_, PyAny>,
    on_step: Bound<'_, PyAny>,
) -> PyResult<Option<String>> {
    let stop = Arc::new(AtomicBool::new(false));
    let (send, receive) = channel();
    let start = start.map(State::plane).transpose()?;
    let job = Job { case: case.case.clone(), start, out, threads };
    let stopped = stop.clone();
    let worker = std::thread::spawn(move || job.run(send, stopped));
    let answer_step = |step: Step| on_step.call1((step,)).and_then(|goes_on| goes_on.is_truthy());
    listen(py, receive, &stop, worker, [&on_stage, &on_warning], answer_step)
}

/// Passes on what a run says until it ends.
pub fn listen<T: Send, S: Send>(
    py: Python<'_>,
    receive: Receiver<Event<S>>,
    stop: &AtomicBool,
    worker: JoinHandle<Result<T, Failure>>,
    [on_stage, on_warning]: [&Bound<'_, PyAny>; 2],
    on_step: impl Fn(S) -> PyResult<bool>,
) -> PyResult<T> {
    let receive = Mutex::new(receive);
    let mut failure: Option<PyErr> = None;
    loop {
        let outcome = match py.detach(|| next(&receive)) {
            Err(RecvTimeoutError::Disconnected) => break,
            Err(RecvTimeoutError::Timeout) => Ok(()),
            Ok(Event::Stage(name)) => on_stage.call1((name,)).map(drop),
            Ok(Event::Warning(message)) => on_warning.call1((message,)).map(drop),
            Ok(Event::Step(step, answer)) => {
                let goes_on = on_step(*step);
                // A run that has ended does not wait for an answer.
                let _ = answer.send(failure.is_none() && *goes_on.as_ref().unwrap_or(&false));
                goes_on.map(drop)
            }
        };
        if let Err(e) = outcome.and_then(|()| py.check_signals()) {
            if failure.is_some() {
                return Err(e);
            }
            stop.store(true, Ordering::Relaxed);
            failure = Some(e);
        }
    }
    let outcome = py.detach(|| worker.join());
    match (failure, outcome) {
        (Some(e), _) => Err(e),
        (None, Ok(Ok(found))) => Ok(found),
        (None, Ok(Err(Failure::Analysis(e)))) => Err(error::of_analysis(&e)),
        (None, Ok(Err(Failure::Files(path, e)))) => Err(error::of_files(&path, &e)),
        (None, Ok(Err(Failure::Said(e)))) => Err(error::AnalysisError::new_err(e)),
        (None, Err(_)) => {
            Err(error::AnalysisError::new_err("this is a bug in riss, not in your case; please report it"))
        }
    }
}

fn next<S>(receive: &Mutex<Receiver<Event<S>>>) -> Result<Event<S>, RecvTimeoutError> {
    receive.lock().map_or(Err(RecvTimeoutError::Disconnected), |r| r.recv_timeout(PATIENCE))
}

struct Job {
    case: Arc<riss::case::Case>,
    start: Option<GrowthState>,
    out: Option<PathBuf>,
    threads: Option<usize>,
}

impl Job {
    fn run(self, send: Sender<Event<Step>>, stop: Arc<AtomicBool>) -> Result<Option<String>, Failure> {
        in_pool(self.threads, || self.run_here(send, stop))
    }

    fn run_here(self, send: Sender<Event<Step>>, stop: Arc<AtomicBool>) -> Result<Option<String>, Failure> {
        let Self { case, start, out, .. } = self;
        let files = |e: io::Error| Failure::Files(out.clone().unwrap_or_default(), e);
        let writer = out.as_deref().map(|dir| Writer::new(dir, &case, start.as_ref())).transpose().map_err(files)?;
        let mut listener =
            Listener { case: &case, send, stop, writer, clock: Clock::new(), is_heard: true, problem: None };
        let (model, settings) = (&case.model, &case.settings);
        let outcome = match (&case.loading, &case.growth) {
            (Some(loading), growth) => plane_loading(model, settings, loading, growth.as_ref(), start, &mut listener),
            (None, None) => linear_static(model, settings, &mut listener).map(|_| None),
            (None, Some(growth)) => crack_growth(model, settings, growth, start, &mut listener).map(|_| None),
        };
        if let Some(e) = listener.problem.take() {
            return Err(files(e));
        }
        let Some(record) = outcome.map_err(Failure::Analysis)? else { return Ok(None) };
        let is_done = record.end.kind != GrowthEndKind::Failed;
        let info = listener.info(if is_done { RunStatus::Done } else { RunStatus::Stopped });
        if let Some(Writer::Loading(writer)) = &listener.writer {
            writer.finish(&info, &record).map_err(files)?;
        }
        Ok(loading_json(&record))
    }
}

/// Does a task with a number of threads, or with all there are.
pub fn in_pool<T: Send>(
    n_threads: Option<usize>,
    task: impl FnOnce() -> Result<T, Failure> + Send,
) -> Result<T, Failure> {
    let pool = n_threads.map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build()).transpose();
    match pool.map_err(|e| Failure::Said(format!("cannot start the threads: {e}")))? {
        Some(pool) => pool.install(task),
        None => task(),
    }
}

/// What runs, as reports tell it.
pub const FROM_PYTHON: &str = ", from Python";

/// What is run, for the report.
fn source(case: &riss::case::Case) -> RunSource {
    RunSource::begun(&case.path, &case.text, &case.overrides, case.effective_settings(), FROM_PYTHON)
}

/// Times of the stages.
pub struct Clock {
    /// When the run began.
    pub start: Instant,
    current: Option<(Stage, Instant)>,
    /// Stages with their times [s].
    pub stages: Vec<(String, f64)>,
    n_taken: usize,
}

impl Clock {
    /// Starts it.
    pub fn new() -> Self {
        Self { start: Instant::now(), current: None, stages: vec![], n_taken: 0 }
    }

    /// Ends the stage at hand and begins another.
    pub fn begin(&mut self, stage: Option<Stage>) {
        if let Some((stage, since)) = self.current.take() {
            self.stages.push((stage.name().into(), since.elapsed().as_secs_f64()));
        }
        self.current = stage.map(|stage| (stage, Instant::now()));
    }
}

/// Passes everything on to Python, and writes files.
struct Listener<'a> {
    case: &'a riss::case::Case,
    send: Sender<Event<Step>>,
    stop: Arc<AtomicBool>,
    writer: Option<Writer>,
    clock: Clock,
    /// Whether Python still wants to hear of states of loading.
    is_heard: bool,
    problem: Option<io::Error>,
}

/// What writes the files of a run.
enum Writer {
    Steps(RunWriter),
    Loading(PlaneLoadingWriter),
}

impl Writer {
    fn new(dir: &Path, case: &riss::case::Case, start: Option<&GrowthState>) -> io::Result<Self> {
        let output = &case.output;
        let options =
            OutputOptions { fields: output.fields, nodes: output.nodes, integration_points: output.integration_points };
        if case.loading.is_some() {
            return PlaneLoadingWriter::new(dir, options, &source(case)).map(Self::Loading);
        }
        let writer = match start {
            Some(state) => RunWriter::resume(dir, options, state.step),
            None => RunWriter::new(dir, options),
        }?;
        writer.describe(&source(case))?;
        Ok(Self::Steps(writer))
    }
}

impl Listener<'_> {
    fn info(&self, status: RunStatus) -> RunInfo {
        RunInfo {
            title: self.case.model.title.clone(),
            method: self.case.settings.method.name().into(),
            units: self.case.units.clone(),
            status,
            wall_time_s: self.clock.start.elapsed().as_secs_f64(),
            stage_time_s: self.clock.stages.clone(),
            peak_memory_bytes: None,
        }
    }

    /// Goes on unless something could not be written or Python wants no more.
    fn after(&mut self, written: io::Result<()>) -> ControlFlow<()> {
        self.problem = written.err();
        let stops = self.problem.is_some() || self.stop.load(Ordering::Relaxed);
        if stops { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Observer for Listener<'_> {
    fn load_curve(&mut self, curve: &[LoadPoint]) -> ControlFlow<()> {
        let written = match &self.writer {
            Some(Writer::Loading(writer)) if curve.len().is_multiple_of(CURVE_PACE) => writer.write_curve(curve),
            _ => Ok(()),
        };
        self.after(written)
    }

    fn ways_grown(&mut self, state: &GrowthState) -> ControlFlow<()> {
        let written = match &self.writer {
            Some(Writer::Loading(writer)) => writer.write_ways(state),
            _ => Ok(()),
        };
        self.after(written)
    }

    fn stage(&mut self, stage: Stage) {
        self.clock.begin(Some(stage));
        // Nobody listens after a second Ctrl-C.
        let _ = self.send.send(Event::Stage(stage.name()));
    }

    fn warning(&mut self, warning: &Warning) {
        let _ = self.send.send(Event::Warning(warning.to_string()));
    }

    fn step(&mut self, result: &StaticResult, state: Option<&GrowthState>) -> ControlFlow<()> {
        self.clock.begin(None);
        let times = self.clock.stages[self.clock.n_taken..].to_vec();
        self.clock.n_taken = self.clock.stages.len();
        let status = match (&self.case.growth, &result.step.end) {
            (None, _) => RunStatus::Done,
            (Some(_), Some(end)) if end.kind != GrowthEndKind::Failed => RunStatus::Done,
            (Some(_), Some(_) | None) => RunStatus::Stopped,
        };
        let info = self.info(status);
        let written = match &mut self.writer {
            Some(Writer::Steps(writer)) => writer.write_step(&info, result, &times, state).map(drop),
            Some(Writer::Loading(writer)) => writer.write_step(&info, result, &times),
            None => Ok(()),
        };
        if let Err(e) = written {
            self.problem = Some(e);
            return ControlFlow::Break(());
        }
        let mut model = self.case.model.clone();
        if let Some(state) = state {
            model.cracks = state.cracks.clone();
        } else {
            // Cohesive cracks may have grown before.
            model.cracks.iter_mut().zip(&result.step.cracks).for_each(|(crack, record)| {
                crack.vertices.clone_from(&record.path);
                crack.ends = record.ends;
            });
        }
        let step = Step {
            record: StepResults::new(result, &times),
            result: Arc::new(result.clone()),
            model: Arc::new(model),
            settings: Arc::new(self.case.settings.clone()),
            state: state.cloned(),
        };
        if self.case.loading.is_some() {
            // The curve is there already, and is kept.
            self.is_heard = self.is_heard && ask(&self.send, step);
            return self.after(Ok(()));
        }
        match ask(&self.send, step) && !self.stop.load(Ordering::Relaxed) {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    }
}
