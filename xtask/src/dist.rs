//! `cargo xtask dist`: one static program and one Python wheel, for those who have no Rust.

use crate::{Outcome, cargo, root, run, target_dir};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Linked with its own C library: runs on any Linux of this processor.
const STATIC_TARGET: &str = "x86_64-unknown-linux-musl";

/// Builds both into `target/dist`.
pub fn run_all() -> Outcome {
    let folder = target_dir().join("dist");
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let program = program(&folder)?;
    println!("wrote {}", program.display());
    wheel(&folder)?;
    println!("wrote a wheel to {}", folder.display());
    Ok(())
}

fn program(folder: &Path) -> Result<PathBuf, String> {
    if !has_target() {
        return Err(format!(
            "the Rust target {STATIC_TARGET} is not installed: run `rustup target add {STATIC_TARGET}` with a network, \
             or install the package of your system that holds its standard library"
        ));
    }
    // Without the lines of the source, which only a backtrace shows.
    run(cargo(&["build", "--release", "--package", "riss-cli", "--target", STATIC_TARGET])
        .env("CARGO_PROFILE_RELEASE_DEBUG", "false")
        .env("CARGO_PROFILE_RELEASE_STRIP", "symbols"))?;
    let built = target_dir().join(STATIC_TARGET).join("release/riss");
    check_static(&built)?;
    let path = folder.join(format!("riss-{}-{STATIC_TARGET}", env!("CARGO_PKG_VERSION")));
    std::fs::copy(&built, &path).map_err(|e| format!("{}: {e}", path.display()))?;
    let version = Command::new(&path).arg("--version").output().map_err(|e| format!("{}: {e}", path.display()))?;
    if version.status.success() { Ok(path) } else { Err(format!("{} does not run", path.display())) }
}

/// Whether the standard library of the target is there; asks the compiler, since not everyone has rustup.
fn has_target() -> bool {
    let asked = Command::new("rustc").args(["--print", "target-libdir", "--target", STATIC_TARGET]).output();
    let folder = asked.map(|o| String::from_utf8_lossy(&o.stdout).trim().to_string()).unwrap_or_default();
    !folder.is_empty() && Path::new(&folder).is_dir()
}

/// A static program asks for no interpreter: it has no program header of that type.
fn check_static(path: &Path) -> Outcome {
    let bytes = std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
    match asks_for_interpreter(&bytes) {
        Some(false) => Ok(()),
        Some(true) => Err(format!("{} needs libraries of the system", path.display())),
        None => Err(format!("{} is no ELF file of 64 bits", path.display())),
    }
}

/// Whether an ELF file of 64 bits, little-endian, has a `PT_INTERP` header.
fn asks_for_interpreter(bytes: &[u8]) -> Option<bool> {
    const PT_INTERP: u32 = 3;
    let number = |at: usize, n: usize| -> Option<usize> {
        let bytes = bytes.get(at..at.checked_add(n)?)?;
        Some(bytes.iter().rev().fold(0, |sum, b| (sum << 8) | usize::from(*b)))
    };
    if bytes.get(..6)? != b"\x7fELF\x02\x01" {
        return None;
    }
    // Offset, size and number of the program headers.
    let (start, size, count) = (number(0x20, 8)?, number(0x36, 2)?, number(0x38, 2)?);
    let kinds: Option<Vec<usize>> = (0..count).map(|k| number(start + k * size, 4)).collect();
    Some(kinds?.contains(&(PT_INTERP as usize)))
}

fn wheel(folder: &Path) -> Outcome {
    let python = crate::python::environment()?;
    let package = root().join("crates").join("riss-py");
    let mut command = Command::new(python);
    command.current_dir(&package).args(["-m", "maturin", "build", "--release", "--quiet", "--out"]).arg(folder);
    run(command.env("CARGO_TARGET_DIR", target_dir().join("python-build")))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A header and program headers of these types.
    fn elf(kinds: &[u8]) -> Vec<u8> {
        let mut bytes = vec![0; 0x40 + 56 * kinds.len()];
        bytes[..6].copy_from_slice(b"\x7fELF\x02\x01");
        (bytes[0x20], bytes[0x36], bytes[0x38]) = (0x40, 56, kinds.len() as u8);
        kinds.iter().enumerate().for_each(|(k, kind)| bytes[0x40 + 56 * k] = *kind);
        bytes
    }

    #[test]
    fn programs_that_need_a_loader_are_recognized() {
        assert_eq!(asks_for_interpreter(&elf(&[6, 1, 2])), Some(false));
        assert_eq!(asks_for_interpreter(&elf(&[6, 3, 1])), Some(true));
        assert_eq!(asks_for_interpreter(b"#!/bin/sh"), None);
        assert_eq!(asks_for_interpreter(&elf(&[6, 3, 1])[..0x50]), None);
    }
}
