//! `cargo xtask bench`: the benchmarks of the library.

use crate::{Outcome, cargo, run as run_command};

/// Runs all benchmarks; `rest` goes to `cargo bench`, so a name selects some of them.
pub fn run(rest: &[String]) -> Outcome {
    let mut command = cargo(&["bench", "--package", "riss", "--benches"]);
    run_command(command.args(rest))
}
