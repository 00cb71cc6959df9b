//! `cargo xtask instructions`: what runs cost in instructions, against what they cost before.
//!
//! Unlike times, instructions do not depend on what else the machine does: a change of a percent is seen. Callgrind counts
//! them, as on a processor with AVX2.

use crate::{Outcome, build_riss, root, target_dir};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// Millions of instructions of each job, as stored.
const STORED: &str = "xtask/instructions.json";
/// A job may take this part more than stored: compilers and system libraries differ a little.
const ALLOWED: f64 = 0.05;

/// Runs that stand for what users do: name and words after `riss run`.
const JOBS: [(&str, &[&str]); 3] = [
    ("geometry to K", &["cases/shear-edge-crack/case.toml"]),
    (
        "growth, three steps",
        &["cases/shear-edge-crack/case.toml", "--set", "growth.increment=0.3", "--set", "growth.steps=3"],
    ),
    ("enriched grid", &["cases/shear-edge-crack/case.toml", "--set", "nodes.layout.structured={nx=11,ny=29}"]),
];

/// What to do with the counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counts {
    /// None may be above what is stored.
    Check,
    /// They are stored.
    Store,
}

/// Counts the instructions of all jobs.
///
/// # Errors
/// A job that takes more than it did, or a program that does not run.
pub fn run(counts: Counts) -> Outcome {
    if !can_count() {
        return Err("valgrind is not installed; it counts the instructions".into());
    }
    let program = build_riss()?;
    let mut found = BTreeMap::new();
    for (name, words) in JOBS {
        let words: Vec<&str> = ["run", "--threads", "1", "--quiet"].iter().chain(words).copied().collect();
        let count = count(&program, &words, &target_dir().join("instructions.callgrind"))?;
        found.insert(name.to_string(), (count / 1e6).round());
    }
    let path = root().join(STORED);
    if counts == Counts::Store {
        let text = serde_json::to_string_pretty(&found).map_err(|e| e.to_string())?;
        return std::fs::write(&path, text + "\n").map_err(|e| format!("{STORED}: {e}"));
    }
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{STORED}: {e}"))?;
    let stored = serde_json::from_str(&text).map_err(|e| format!("{STORED}: {e}"))?;
    let (table, more) = compare(&found, &stored);
    print!("{table}");
    match more.as_slice() {
        [] => Ok(()),
        more => Err(format!(
            "more instructions than stored in {STORED}: {}; if that is meant, `cargo xtask instructions --store`",
            more.join(", ")
        )),
    }
}

/// A table of all jobs, and those that take more than allowed or are not stored.
fn compare(found: &BTreeMap<String, f64>, stored: &BTreeMap<String, f64>) -> (String, Vec<String>) {
    let mut table = String::from("| job | million instructions | stored | change |\n| --- | ---: | ---: | ---: |\n");
    let mut more = vec![];
    for (name, count) in found {
        let before = stored.get(name).copied().unwrap_or(0.0);
        let change = count / before - 1.0;
        table += &format!("| {name} | {count} | {before} | {:+.1} % |\n", 100.0 * change);
        if !(change <= ALLOWED) {
            more.push(name.clone());
        }
    }
    (table, more)
}

/// Whether callgrind is there.
pub fn can_count() -> bool {
    Command::new("valgrind").arg("--version").output().is_ok()
}

/// Number of instructions of a run of the program in the root of the repository; the profile goes to `file`.
///
/// # Errors
/// A program that does not run, or a profile without a sum.
pub fn count(program: &Path, words: &[&str], file: &Path) -> Result<f64, String> {
    let mut command = Command::new("valgrind");
    command.current_dir(root()).args(["--tool=callgrind", &format!("--callgrind-out-file={}", file.display())]);
    command.arg(program).args(words).arg("--out").arg(target_dir().join("instructions.riss-out"));
    let output = command.output().map_err(|e| format!("{command:?}: {e}"))?;
    if !output.status.success() {
        return Err(format!("{command:?}: {}", String::from_utf8_lossy(&output.stderr)));
    }
    let profile = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    sum_of(&profile).ok_or(format!("{} holds no sum", file.display()))
}

/// The sum of a profile, from lines such as `totals: 1045000000`.
fn sum_of(profile: &str) -> Option<f64> {
    profile.lines().filter_map(|line| line.strip_prefix("totals:")?.trim().parse().ok()).next_back()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_of_a_profile_is_found() {
        assert_eq!(sum_of("version: 1\nevents: Ir\n\nfn=(1) main\n3 12\n\ntotals: 1045\n"), Some(1045.0));
        assert_eq!(sum_of("events: Ir\n"), None);
    }

    #[test]
    fn more_instructions_are_told() {
        let counts = |numbers: &[(&str, f64)]| numbers.iter().map(|(n, c)| (n.to_string(), *c)).collect();
        let stored = counts(&[("a", 100.0), ("b", 100.0), ("c", 100.0)]);
        let (table, more) = compare(&counts(&[("a", 90.0), ("b", 104.9), ("c", 105.1), ("d", 1.0)]), &stored);
        assert_eq!(more, ["c", "d"]);
        assert!(table.contains("| a | 90 | 100 | -10.0 % |"), "{table}");
    }
}
