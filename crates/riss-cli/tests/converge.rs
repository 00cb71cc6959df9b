//! `riss converge` as its users run it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A random body of the calibration of error bars; its factors are those of an independent finite element program.
const BODY: &str = "../riss/tests/calibration/bodies/002.toml";
const FACTORS: [f64; 2] = [38.134839, 9.0377206];

fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("made");
    folder
}

fn riss(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_riss")).args(arguments).current_dir(folder).output().expect("riss runs")
}

#[test]
fn the_limit_is_that_of_another_program() {
    let folder = scratch("converge");
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join(BODY);
    let output = riss(&folder, &["converge", &case.to_string_lossy(), "--out", "study", "-q"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(text.contains("limit") && text.contains("order"), "{text}");
    let table = std::fs::read_to_string(folder.join("study/convergence.csv")).expect("written");
    let rows: Vec<Vec<&str>> = table.lines().skip(1).map(|l| l.split(',').collect()).collect();
    assert_eq!(rows.len(), 6, "{table}");
    let limit: Vec<f64> = rows[5][4..].iter().map(|c| c.parse().expect("a number")).collect();
    let size = FACTORS[0].hypot(FACTORS[1]);
    for mode in 0..2 {
        let error = (limit[mode] - FACTORS[mode]).abs();
        assert!(error < limit[2] && error < 2e-4 * size, "K_{}: {} against {}", mode + 1, limit[mode], FACTORS[mode]);
    }
    let picture = std::fs::read_to_string(folder.join("study/convergence.svg")).expect("written");
    assert!(picture.starts_with("<svg"));
}

#[test]
fn what_cannot_be_studied_is_said() {
    let folder = scratch("converge-bad");
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join(BODY);
    let case = case.to_string_lossy();
    for (factors, reason) in [("1,2", "at least three"), ("1,2,0", "from 0.05 to 20"), ("1,x,2", "from 0.05 to 20")] {
        let output = riss(&folder, &["converge", &case, "--factors", factors]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(reason), "{message}");
    }
    let output = riss(&folder, &["converge", &case, "--factors", "0.05,1,2", "--memory-limit", "100MB"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("100 MB are allowed"), "{message}");
    assert_eq!(std::fs::read_dir(&folder).expect("there").count(), 0);
}
