//! `cargo xtask python`: builds the wheel, installs it into an environment of its own and runs the tests in Python.

use crate::{Outcome, cargo, root, run, target_dir};
use std::path::{Path, PathBuf};
use std::process::Command;

/// What builds and checks the package; its own needs follow from `pyproject.toml`.
const TOOLS: [&str; 2] = ["pip>=23", "maturin>=1.9,<2"];

/// Format, lints, types and tests, notebooks among them.
pub fn test() -> Outcome {
    let package = root().join("crates").join("riss-py");
    let python = environment()?;
    let environment = target_dir().join("python");
    let manifest = package.join("Cargo.toml");
    let build = target_dir().join("python-build");
    let cargo_in = |args: &[&str]| {
        let mut command = cargo(args);
        command.arg("--manifest-path").arg(&manifest).env("CARGO_TARGET_DIR", &build);
        command
    };
    run(&mut cargo_in(&["fmt", "--check"]))?;
    let develop = ["-m", "maturin", "develop", "--release", "--quiet", "--extras", "test"];
    run(in_package(&python, &package).env("VIRTUAL_ENV", &environment).env("CARGO_TARGET_DIR", &build).args(develop))?;
    run(cargo_in(&["clippy", "--release"]).args(["--", "-D", "warnings"]).env("PYO3_PYTHON", &python))?;
    run(in_package(&python, &package).args(["-m", "ruff", "format", "--check", "--quiet", "python", "tests"]))?;
    run(in_package(&python, &package).args(["-m", "ruff", "check", "--quiet", "python", "tests"]))?;
    run(in_package(&python, &package).args(["-m", "mypy", "python/riss"]))?;
    run(in_package(&python, &package).args(["-m", "pytest", "--quiet"]))
}

/// The Python of an environment under `target` that has the tools.
pub(crate) fn environment() -> Result<PathBuf, String> {
    let environment = target_dir().join("python");
    if !environment.exists() {
        run(Command::new(interpreter()).args(["-m", "venv"]).arg(&environment))?;
    }
    let python = environment.join(if cfg!(windows) { "Scripts" } else { "bin" }).join("python");
    run(Command::new(&python).args(["-m", "pip", "install", "--quiet"]).args(TOOLS))?;
    Ok(python)
}

fn in_package(python: &Path, package: &Path) -> Command {
    let mut command = Command::new(python);
    command.current_dir(package);
    command
}

/// Python's name on this system, or what `PYTHON` says.
fn interpreter() -> String {
    std::env::var("PYTHON").unwrap_or_else(|_| if cfg!(windows) { "python" } else { "python3" }.into())
}
