//! `riss report`.

use crate::{BAD_CASE, DONE, STOPPED, desktop, results};
use clap::Args;
use riss::output::{RESULTS_FILE, write_report};
use std::path::PathBuf;

/// Arguments of `riss report`.
#[derive(Args)]
#[command(after_help = "Example: riss report strip.riss-out --open")]
pub struct ReportArguments {
    /// Folder of results
    pub dir: PathBuf,
    /// Opens the report in the browser of the desktop
    #[arg(long)]
    pub open: bool,
}

/// Makes the report again; returns the exit code.
pub fn write(arguments: &ReportArguments) -> u8 {
    let dir = &arguments.dir;
    if !dir.join(RESULTS_FILE).is_file() {
        eprintln!("error: {} is no folder of results: there is no {RESULTS_FILE}", dir.display());
        return BAD_CASE;
    }
    match write_report(dir) {
        Ok(path) => {
            crate::print(&format!("wrote {}\n", path.display()));
            if arguments.open {
                desktop::open(&path);
            }
            DONE
        }
        Err(e) => {
            eprintln!("error: cannot make the report of {}: {}", dir.display(), results::reason(&e));
            STOPPED
        }
    }
}
