//! `history.csv`: one row per step and tip, for spreadsheets and plots. Empty cells are unknown.

use super::results::StepResults;
use crate::analysis::TipStatus;
use crate::crack::End;
use serde::Serialize;
use std::io;

const HEADER: [&str; 19] = [
    "step",
    "load_factor",
    "cycles",
    "crack",
    "end",
    "x",
    "y",
    "angle_deg",
    "a",
    "K_I",
    "K_II",
    "K_uncertainty",
    "J",
    "T",
    "kink_angle_deg",
    "status",
    "K_equivalent",
    "increment",
    "growth_rate",
];

/// In the order of the header; `a` is the length of the path.
#[derive(Serialize)]
struct Row<'a>(
    usize,
    Option<f64>,
    Option<f64>,
    &'a str,
    End,
    [f64; 2],
    f64,
    f64,
    [Option<f64>; 5],
    Option<f64>,
    TipStatus,
    [Option<f64>; 3],
);

/// The rows of all steps.
///
/// # Errors
/// None that writing to memory can meet; the type is that of the `csv` crate.
pub fn history_csv(steps: &[StepResults]) -> io::Result<Vec<u8>> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(vec![]);
    writer.write_record(HEADER)?;
    for step in steps {
        for crack in &step.cracks {
            let length = crack.path.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum();
            for tip in &crack.tips {
                writer.serialize(Row(
                    step.step,
                    step.load_factor,
                    step.cycles,
                    &crack.name,
                    tip.end,
                    tip.position,
                    tip.angle_deg,
                    length,
                    [tip.k1, tip.k2, tip.k_uncertainty, tip.j, tip.t_stress],
                    tip.kink_angle_deg,
                    tip.status,
                    [tip.k_equivalent, tip.increment, tip.growth_rate],
                ))?;
            }
        }
    }
    writer.into_inner().map_err(|e| e.into_error())
}
