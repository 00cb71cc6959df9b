//! How far an analysis is, and how long its stages take.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use riss::analysis::{Observer, RefinementRecord, Stage, Warning};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Runs shorter than this show nothing on a terminal.
const PATIENCE: Duration = Duration::from_secs(1);

/// Shows stages as they come and measures them.
pub struct Progress {
    display: Display,
    start: Instant,
    current: Option<(Stage, Instant)>,
    /// Time of each stage by name [s].
    pub stage_time_s: Vec<(String, f64)>,
    /// Stages whose time was taken already.
    taken: usize,
}

enum Display {
    Bar(ProgressBar),
    Lines,
    Nothing,
}

impl Progress {
    /// Starts the clock; a terminal gets a spinner, a file lines.
    pub fn new(is_quiet: bool) -> Self {
        let display = match (is_quiet, std::io::stderr().is_terminal()) {
            (true, _) => Display::Nothing,
            (false, true) => Display::Bar(spinner()),
            (false, false) => Display::Lines,
        };
        Self { display, start: Instant::now(), current: None, stage_time_s: vec![], taken: 0 }
    }

    /// Ends the last stage and clears the terminal; returns the time since the start [s].
    pub fn finish(&mut self) -> f64 {
        self.end_stage();
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
        self.start.elapsed().as_secs_f64()
    }

    /// Time since the start [s].
    pub fn elapsed_s(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Time of the stages since this was asked for last [s].
    pub fn take_stages(&mut self) -> Vec<(String, f64)> {
        self.end_stage();
        let new = self.stage_time_s[self.taken..].to_vec();
        self.taken = self.stage_time_s.len();
        new
    }

    /// Shows a line above the progress.
    pub fn line(&self, text: &str) {
        match &self.display {
            Display::Bar(bar) => bar.suspend(|| crate::print(&format!("{text}\n"))),
            Display::Lines | Display::Nothing => crate::print(&format!("{text}\n")),
        }
    }

    fn end_stage(&mut self) {
        if let Some((stage, since)) = self.current.take() {
            let time = since.elapsed().as_secs_f64();
            tracing::info!("{} took {time:.3} s", stage.name());
            self.stage_time_s.push((stage.name().into(), time));
        }
    }
}

impl Observer for Progress {
    fn stage(&mut self, stage: Stage) {
        self.end_stage();
        tracing::debug!("{} begins", stage.name());
        match &self.display {
            Display::Bar(bar) => bar.set_message(stage.name()),
            Display::Lines if self.taken == 0 => eprintln!("{}", stage.name()),
            Display::Lines => {}
            Display::Nothing => {}
        }
        self.current = Some((stage, Instant::now()));
    }

    fn refinement(&mut self, record: &RefinementRecord) {
        let text = crate::table::refinement_line(record);
        tracing::info!("refined: {text}");
        match &self.display {
            Display::Bar(bar) => bar.println(text),
            Display::Lines => eprintln!("{text}"),
            Display::Nothing => {}
        }
    }

    fn warning(&mut self, warning: &Warning) {
        tracing::warn!("{warning}");
        // Warnings return with the result; on a long run they are worth showing at once.
        if let Display::Bar(bar) = &self.display {
            bar.println(format!("warning: {warning}"));
        }
    }
}

fn spinner() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} ({elapsed})") {
        bar.set_style(style);
    }
    let shown = bar.clone();
    std::thread::spawn(move || {
        std::thread::sleep(PATIENCE);
        if !shown.is_finished() {
            shown.set_draw_target(ProgressDrawTarget::stderr());
            shown.enable_steady_tick(Duration::from_millis(100));
        }
    });
    bar
}

/// Greatest memory use of this process [bytes], where the system tells it.
pub fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(1024 * kilobytes)
}
