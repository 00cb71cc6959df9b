//! A run in a thread of its own, so that Python can be interrupted and callbacks run where they belong.

use crate::case::Case;
use crate::error;
use crate::step::{State, Step};
use pyo3::prelude::*;
use riss::analysis::{GrowthEndKind, GrowthState, Observer, Stage, StaticResult, Warning, crack_growth, linear_static};
use riss::output::results::StepResults;
use riss::output::{OutputOptions, RunInfo, RunSource, RunStatus, RunWriter};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// How often Ctrl-C is looked for.
const PATIENCE: Duration = Duration::from_millis(50);

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
) -> PyResult<()> {
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
    fn run(self, send: Sender<Event<Step>>, stop: Arc<AtomicBool>) -> Result<(), Failure> {
        in_pool(self.threads, || self.run_here(send, stop))
    }

    fn run_here(self, send: Sender<Event<Step>>, stop: Arc<AtomicBool>) -> Result<(), Failure> {
        let Self { case, start, out, .. } = self;
        let output = &case.output;
        let options =
            OutputOptions { fields: output.fields, nodes: output.nodes, integration_points: output.integration_points };
        let writer = match &out {
            None => None,
            Some(dir) => {
                let writer = match &start {
                    Some(state) => RunWriter::resume(dir, options, state.step),
                    None => RunWriter::new(dir, options),
                };
                let writer = writer.map_err(|e| Failure::Files(dir.clone(), e))?;
                writer.describe(&source(&case)).map_err(|e| Failure::Files(dir.clone(), e))?;
                Some(writer)
            }
        };
        let mut listener = Listener { case: &case, send, stop, writer, clock: Clock::new(), problem: None };
        let outcome = match &case.growth {
            None => linear_static(&case.model, &case.settings, &mut listener).map(drop),
            Some(growth) => crack_growth(&case.model, &case.settings, growth, start, &mut listener).map(drop),
        };
        match (listener.problem, outcome) {
            (Some(e), _) => Err(Failure::Files(out.unwrap_or_default(), e)),
            (None, outcome) => outcome.map_err(Failure::Analysis),
        }
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
    writer: Option<RunWriter>,
    clock: Clock,
    problem: Option<std::io::Error>,
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

    fn step(&mut self, result: &StaticResult, state: Option<&GrowthState>) -> ControlFlow<()> {
        self.clock.begin(None);
        let times = self.clock.stages[self.clock.n_taken..].to_vec();
        self.clock.n_taken = self.clock.stages.len();
        if let Some(writer) = &mut self.writer {
            let status = match (&self.case.growth, &result.step.end) {
                (None, _) => RunStatus::Done,
                (Some(_), Some(end)) if end.kind != GrowthEndKind::Failed => RunStatus::Done,
                (Some(_), Some(_) | None) => RunStatus::Stopped,
            };
            let info = RunInfo {
                title: self.case.model.title.clone(),
                method: self.case.settings.method.name().into(),
                units: self.case.units.clone(),
                status,
                wall_time_s: self.clock.start.elapsed().as_secs_f64(),
                stage_time_s: self.clock.stages.clone(),
                peak_memory_bytes: None,
            };
            if let Err(e) = writer.write_step(&info, result, &times, state) {
                self.problem = Some(e);
                return ControlFlow::Break(());
            }
        }
        let mut model = self.case.model.clone();
        if let Some(state) = state {
            model.cracks = state.cracks.clone();
        }
        let step = Step {
            record: StepResults::new(result, &times),
            result: Arc::new(result.clone()),
            model: Arc::new(model),
            settings: Arc::new(self.case.settings.clone()),
            state: state.cloned(),
        };
        let goes_on = ask(&self.send, step) && !self.stop.load(Ordering::Relaxed);
        if goes_on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}
