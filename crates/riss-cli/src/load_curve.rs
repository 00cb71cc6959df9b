//! What runs with cohesive cracks say of their load curve, in the plane and in space.

use crate::table::number;
use riss::analysis::{GrowthEnd, LoadPoint};
use std::path::Path;
use std::time::{Duration, Instant};

/// The load curve is written as often as this while it is followed.
const BETWEEN_CURVES: Duration = Duration::from_secs(1);

/// When the load curve is due to be written.
#[derive(Default)]
pub struct Pace {
    last: Option<Instant>,
}

impl Pace {
    /// Whether it is due now; then it is not again for a while.
    pub fn is_due(&mut self) -> bool {
        let is_due = self.last.is_none_or(|time| time.elapsed() >= BETWEEN_CURVES);
        if is_due {
            self.last = Some(Instant::now());
        }
        is_due
    }
}

/// What to say of a run that was ended before its time.
///
/// - `grows`: whether its cracks grow, so that it can be gone on with
pub fn stopped(grows: bool, dir: &Path) -> String {
    let found = "stopped; load_curve.csv has what was found until then";
    match grows {
        true => format!("{found}, and riss run --resume {} goes on with the cracks as they have grown", dir.display()),
        false => found.into(),
    }
}

/// What happened, in words.
pub fn summary(curve: &[LoadPoint], peak: usize, end: &GrowthEnd) -> String {
    let say = |p: &LoadPoint| {
        format!(
            "load {} at displacement {}, {} dissipated, {} of crack",
            number(p.load),
            number(p.displacement),
            number(p.dissipated_energy),
            number(p.crack_area)
        )
    };
    let last = curve.len() - 1;
    format!(
        "first crack: {}\npeak:        {}\nend:         {}\nloading ended after {last} steps: {}\n",
        say(&curve[1.min(last)]),
        say(&curve[peak]),
        say(&curve[last]),
        end.reason
    )
}
