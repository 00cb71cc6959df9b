//! `riss selftest` from the program alone.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder without anything of the repository.
fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("made");
    folder
}

fn selftest(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_riss"));
    command.arg("selftest").args(arguments).current_dir(folder).env("TMPDIR", folder);
    command.output().expect("riss runs")
}

#[test]
fn documented_cases_of_all_methods_meet_their_references() {
    let folder = scratch("selftest");
    let output = selftest(&folder, &[]);
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    assert_eq!(output.status.code(), Some(0), "{text}");
    for method in [", element-free-galerkin,", ", cracking-particles,", ", collocation,"] {
        assert!(text.contains(method), "{method}: {text}");
    }
    for word in ["quantity", "reference", "computed", "error", "tolerance", "passed", "source", "Sneddon (1946)"] {
        assert!(text.contains(word), "{word}: {text}");
    }
    let last = text.lines().last().expect("a summary");
    let numbers: Vec<&str> = last.split_whitespace().collect();
    assert!(numbers[0] == numbers[2] && numbers[0].parse::<usize>().expect("a number") > 50, "{last}");
    // The path of growth is compared with a file that only the program holds.
    assert!(text.contains("path of crack, distance"), "{text}");
    assert_eq!(std::fs::read_dir(&folder).expect("there").count(), 0, "all scratch files are removed");
}

#[test]
fn what_cannot_run_does_not_pass() {
    let folder = scratch("selftest-failing");
    let output = selftest(&folder, &["disk", "no-such-case"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no case `no-such-case`"));
    // Files of more than 1 KB cannot be written: the case has no results.
    let script = format!("ulimit -f 1; trap '' XFSZ; exec '{}' selftest disk", env!("CARGO_BIN_EXE_riss"));
    let mut command = Command::new("sh");
    let output = command.args(["-c", &script]).env("TMPDIR", &folder).output().expect("sh runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("0 of 1 values of 1 cases passed"), "{text}");
}
