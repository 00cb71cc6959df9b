//! `cargo xtask calibrate`: the error bars of stress intensity factors against the true errors in many bodies.

use crate::{Outcome, cargo, run as run_command};

/// Runs the whole study, which prints its table.
pub fn run() -> Outcome {
    let test = ["test", "--release", "--package", "riss", "--test", "calibration", "--", "--nocapture"];
    run_command(cargo(&test).env("RISS_CALIBRATION", "all"))
}
