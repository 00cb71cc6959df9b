//! `cargo xtask <task>`.

use std::process::ExitCode;
use xtask::instructions::Counts;
use xtask::performance::Benchmarks;
use xtask::{bench, calibrate, ci, dist, docs, instructions, performance, python, tidy, verify};

const TASKS: &str = "usage: cargo xtask <task>

  ci      everything that continuous integration runs: format, clippy, tests, documentation, Python
  tidy    layers, headers, citations, names, file length, case folders
  verify  runs every case and compares it with its reference values; writes a table; grows random plates
  calibrate  compares the error bars of stress intensity factors with the errors in many bodies
  dist    builds one static program for Linux and a Python wheel into `target/dist`
  docs    writes the generated pages of the book, and builds the book where mdbook is installed
  python  builds the Python package and tests it, in an environment under `target`
  bench   runs the benchmarks; further words go to `cargo bench`
  performance  measures speed and memory, and writes the page of the book about them; with --stored from the last\n          run of the benchmarks
  instructions  counts the instructions of some runs, which may not be more than stored; with --store stores them";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (task, rest) = match args.split_first() {
        Some((task, rest)) => (task.as_str(), rest),
        None => ("", &[][..]),
    };
    let outcome = match (task, rest) {
        ("ci", []) => ci::run_all(),
        ("tidy", []) => tidy::run(),
        ("verify", names) => verify::run(names),
        ("calibrate", []) => calibrate::run(),
        ("dist", []) => dist::run_all(),
        ("docs", []) => docs::run(),
        ("bench", rest) => bench::run(rest),
        ("performance", []) => performance::run(Benchmarks::Run),
        ("performance", [flag]) if flag == "--stored" => performance::run(Benchmarks::Stored),
        ("instructions", []) => instructions::run(Counts::Check),
        ("instructions", [flag]) if flag == "--store" => instructions::run(Counts::Store),
        ("python", []) => python::test(),
        _ => Err(TASKS.into()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::FAILURE
        }
    }
}
