//! Development tasks: one entry, `cargo xtask`, no shell scripts.
//!
//! A library, so that integration tests can use the same rules: [`mod@reference`] turns the JSON schema of
//! the case file into a page of the book, [`tidy`] checks the manners of the code. How a run compares with its reference
//! values is in `riss-expected`, which the program uses too.

pub mod bench;
pub mod calibrate;
pub mod ci;
pub mod dist;
pub mod docs;
pub mod gallery;
pub mod instructions;
pub mod performance;
pub mod python;
pub mod reference;
pub mod tidy;
pub mod verify;
pub mod walk;

use std::path::{Path, PathBuf};
use std::process::Command;

/// What a task says: nothing, or why it failed.
pub type Outcome = Result<(), String>;

/// The root of the workspace.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the workspace").to_path_buf()
}

/// The folder of build artifacts.
pub fn target_dir() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), |dir| root().join(dir))
}

/// A `cargo` command in the root of the workspace.
pub fn cargo(args: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(args).current_dir(root());
    command
}

/// Runs a command to its end; its output goes to the terminal.
pub fn run(command: &mut Command) -> Outcome {
    let status = command.status().map_err(|e| format!("{command:?} did not start: {e}"))?;
    if status.success() { Ok(()) } else { Err(format!("{command:?} ended with {status}")) }
}

/// Builds the `riss` program in release and returns its path.
pub fn build_riss() -> Result<PathBuf, String> {
    run(&mut cargo(&["build", "--release", "--package", "riss-cli"]))?;
    Ok(target_dir().join("release").join(format!("riss{}", std::env::consts::EXE_SUFFIX)))
}

/// The case folders under `cases`, by name; none if the folder is not there.
pub fn case_folders(root: &Path) -> Vec<PathBuf> {
    let mut folders: Vec<PathBuf> = std::fs::read_dir(root.join("cases"))
        .map(|entries| entries.flatten().map(|e| e.path()).filter(|p| p.is_dir()).collect())
        .unwrap_or_default();
    folders.sort();
    folders
}
