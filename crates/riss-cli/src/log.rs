//! `--log` and `--log-file`: what happens in a run, line by line, for those who look for the reason later.
//!
//! The library itself knows no log: what is told comes through its observer.

use clap::{Args, ValueEnum};
use riss::analysis::{RunSize, SolidResult, StaticResult};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use tracing::level_filters::LevelFilter;

/// How much is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Level {
    /// Why a run has no result
    Error,
    /// Also results to look at twice
    Warn,
    /// Also stages with their times, solutions, steps
    Info,
    /// Also when stages begin
    Debug,
}

/// Arguments about the log.
#[derive(Args)]
pub struct LogArguments {
    /// Tells what happens, on stderr unless there is a --log-file
    #[arg(long = "log", value_name = "LEVEL", value_enum)]
    level: Option<Level>,
    /// Writes the log into a file, at level info unless --log says otherwise
    #[arg(long = "log-file", value_name = "FILE")]
    file: Option<PathBuf>,
}

impl LogArguments {
    /// Whether lines of the log appear where progress would.
    pub fn is_on_terminal(&self) -> bool {
        self.level.is_some() && self.file.is_none()
    }

    /// Begins the log, if one is asked for.
    ///
    /// # Errors
    /// Why the file cannot be written.
    pub fn start(&self) -> Result<(), String> {
        let level = match (self.level, &self.file) {
            (None, None) => return Ok(()),
            (None | Some(Level::Info), _) => LevelFilter::INFO,
            (Some(Level::Error), _) => LevelFilter::ERROR,
            (Some(Level::Warn), _) => LevelFilter::WARN,
            (Some(Level::Debug), _) => LevelFilter::DEBUG,
        };
        let lines = tracing_subscriber::fmt().with_max_level(level).with_target(false).with_ansi(false);
        match &self.file {
            None => lines.with_writer(std::io::stderr).init(),
            Some(path) => {
                let file = File::create(path).map_err(|e| {
                    format!("cannot write the log to {}: {}", path.display(), crate::results::reason(&e))
                })?;
                lines.with_writer(Mutex::new(file)).init();
            }
        }
        tracing::info!("riss {} with {} threads", env!("CARGO_PKG_VERSION"), rayon::current_num_threads());
        Ok(())
    }
}

/// A case is read.
pub fn begin(path: &Path, title: &str, method: &str, size: &RunSize) {
    let (nodes, megabytes) = (size.n_nodes, size.bytes / 1e6);
    tracing::info!("case {} ({title}), {method}: about {nodes:.0} nodes, {megabytes:.0} MB", path.display());
}

/// A step is solved.
pub fn solved(result: &StaticResult) {
    let (nodes, unknowns, points) = (result.n_nodes, result.n_unknowns, result.n_integration_points);
    let (step, residual) = (result.step.step, result.residual);
    tracing::info!(
        "step {step}: {nodes} nodes, {unknowns} unknowns, {points} integration points, residual {residual:.1e}"
    );
}

/// A solid is solved.
pub fn solved_solid(result: &SolidResult) {
    let (nodes, effort) = (result.n_nodes, &result.effort);
    let (method, iterations, residual) = (effort.method, effort.iterations, effort.residual);
    tracing::info!(
        "{nodes} nodes, {} unknowns, {method} with {iterations} products, residual {residual:.1e}",
        3 * nodes
    );
}
