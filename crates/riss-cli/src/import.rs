//! `riss import`.

use crate::{BAD_CASE, DONE};
use clap::Args;
use std::path::PathBuf;

/// Arguments of `riss import`.
#[derive(Args)]
#[command(after_help = "Examples:\n  riss import plate.inp\n  riss import plate.inp > case.toml")]
pub struct ImportArguments {
    /// Input file of Abaqus or CalculiX
    pub file: PathBuf,
}

/// Prints a case with all that the file says; returns the exit code.
pub fn import(arguments: &ImportArguments) -> u8 {
    match riss::case::import_abaqus(&arguments.file) {
        Ok((text, remarks)) => {
            remarks.iter().for_each(|r| eprintln!("note: {}: {r}", arguments.file.display()));
            crate::print(&text);
            DONE
        }
        Err(message) => {
            eprintln!("error: {message}");
            BAD_CASE
        }
    }
}
