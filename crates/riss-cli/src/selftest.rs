//! `riss selftest`: documented cases, run by the program on the spot and compared with their reference values.

use crate::cases::{self, GalleryCase};
use crate::table::aligned;
use crate::{BAD_CASE, DONE, STOPPED, results};
use clap::Args;
use riss_expected::{CaseRun, run_case};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What runs if no case is asked for: all three methods, static and growing cracks, in less than a minute on two cores.
const CASES: [&str; 12] = [
    "slanted-edge-crack",
    "pressurized-crack",
    "crack-near-hole",
    "disk-edge-crack",
    "center-crack-enriched",
    "edge-crack-shear",
    "fatigue-center-crack",
    "half-central-crack-particles",
    "edge-crack-growth-particles",
    "near-tip-cuboid",
    "spherical-cavity",
    "penny-shaped-crack",
];

/// Arguments of `riss selftest`.
#[derive(Args)]
#[command(after_help = "Examples:\n  riss selftest\n  riss selftest penny-shaped-crack disk\n\n\
        Exit codes: 0 all values are within their tolerances, 1 some are not, 2 no such case.")]
pub struct SelftestArguments {
    /// Cases of the gallery to run [default: some of all methods that take about a minute]
    #[arg(value_name = "CASE")]
    pub names: Vec<String>,
}

/// Values that are compared, and how many are within their tolerances.
#[derive(Clone, Copy, Default)]
struct Tally {
    passed: usize,
    all: usize,
}

/// Runs the cases and prints a table; returns the exit code.
pub fn run(arguments: &SelftestArguments) -> u8 {
    let chosen = match chosen(&arguments.names) {
        Ok(chosen) => chosen,
        Err(name) => {
            eprintln!("error: there is no case `{name}`; `riss cases` lists all");
            return BAD_CASE;
        }
    };
    let scratch = match Scratch::new() {
        Ok(scratch) => scratch,
        Err(message) => {
            eprintln!("error: {message}");
            return STOPPED;
        }
    };
    let start = Instant::now();
    let mut tally = Tally::default();
    for case in &chosen {
        match run_one(case, &scratch.dir) {
            Ok(run) => {
                crate::print(&described(case.name, &run));
                tally.all += run.comparisons.len();
                tally.passed += run.comparisons.iter().filter(|c| c.passed()).count();
            }
            Err(reason) => {
                crate::print(&format!("{}\nnot run: {reason}\n\n", case.name));
                tally.all += 1;
            }
        }
    }
    let Tally { passed, all } = tally;
    let seconds = start.elapsed().as_secs_f64();
    crate::print(&format!("{passed} of {all} values of {} cases passed, {seconds:.1} s\n", chosen.len()));
    if passed == all { DONE } else { STOPPED }
}

/// The cases with these names, or the usual ones.
fn chosen(names: &[String]) -> Result<Vec<&'static GalleryCase>, String> {
    let find = |name: &str| cases::gallery().iter().find(|c| c.name == name).ok_or_else(|| name.to_string());
    if names.is_empty() { CASES.into_iter().map(find).collect() } else { names.iter().map(|n| find(n)).collect() }
}

/// By the program itself, so that a case that fails badly does not end the others.
fn run_one(case: &GalleryCase, scratch: &Path) -> Result<CaseRun, String> {
    let expected = case.expected()?;
    let folder = scratch.join(case.name);
    cases::write(case, &folder).map_err(|e| format!("{}: {}", folder.display(), results::reason(&e)))?;
    let riss = std::env::current_exe().map_err(|e| format!("the program does not know where it is: {e}"))?;
    run_case(&riss, &folder, &expected, &folder.join("out"))
}

/// A table of the values of a case.
fn described(name: &str, run: &CaseRun) -> String {
    let head = ["quantity", "reference", "computed", "error", "tolerance", "passed", "source"];
    let row = |c: &riss_expected::Comparison| {
        let passed = if c.passed() { "yes" } else { "NO" };
        let cells = c.cells().into_iter();
        cells.chain([passed.to_string(), c.reference.source.clone()]).collect()
    };
    let rows: Vec<Vec<String>> = run.comparisons.iter().map(row).collect();
    let method = run.results["method"].as_str().unwrap_or("");
    let seconds = run.time.as_secs_f64();
    format!("{name}, {method}, {seconds:.1} s\n{}\n", aligned(&head, &rows, &[0, 5, 6]))
}

/// A folder that is removed at the end.
struct Scratch {
    dir: PathBuf,
}

impl Scratch {
    fn new() -> Result<Self, String> {
        let dir = std::env::temp_dir().join(format!("riss-selftest-{}", std::process::id()));
        // Not one that somebody else has put there.
        std::fs::create_dir(&dir).map_err(|e| format!("cannot make {}: {}", dir.display(), results::reason(&e)))?;
        Ok(Self { dir })
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.dir);
    }
}
