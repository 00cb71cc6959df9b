//! `check`, `new`, `schema` and the help texts, as their users see them.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn riss(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_riss")).args(arguments).current_dir(folder).output().expect("riss runs")
}

fn stdout(folder: &Path, arguments: &[&str]) -> String {
    let output = riss(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A fresh folder for one test.
fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("made");
    folder
}

#[test]
fn help() {
    insta::assert_snapshot!("help", stdout(&root(), &["--help"]));
    insta::assert_snapshot!("help-run", stdout(&root(), &["run", "--help"]));
    insta::assert_snapshot!("help-report", stdout(&root(), &["report", "--help"]));
    insta::assert_snapshot!("help-export", stdout(&root(), &["export", "--help"]));
    insta::assert_snapshot!("help-compare", stdout(&root(), &["compare", "--help"]));
    assert_eq!(riss(&root(), &["walk"]).status.code(), Some(2));
    assert_eq!(riss(&root(), &["run", "cases/shear-edge-crack/case.toml", "--threads", "0"]).status.code(), Some(2));
    // So many would take all memory.
    assert_eq!(
        riss(&root(), &["run", "cases/shear-edge-crack/case.toml", "--threads", "100000"]).status.code(),
        Some(2)
    );
}

/// The reference case, as an absolute path.
fn shear_case() -> String {
    root().join("cases/shear-edge-crack/case.toml").canonicalize().expect("there").display().to_string()
}

/// Numbers that follow from node placement, not from the program around it.
const NUMBERS: [(&str, &str); 2] =
    [(r"nodes    \d+", "nodes    [n]"), (r"cells    \d+ with \d+", "cells    [n] with [n]")];

#[test]
fn check_says_what_a_case_holds_and_draws_it() {
    let folder = scratch("check");
    let text = stdout(&folder, &["check", &shear_case()]);
    insta::with_settings!({ filters => NUMBERS }, { insta::assert_snapshot!("check", text) });
    assert!(folder.join("shear-edge-crack.riss-out/model.svg").exists());
}

#[test]
fn shape_draws_the_functions_of_a_node() {
    let folder = scratch("shape");
    let text = stdout(&folder, &["shape", &shear_case(), "--at", "3.4,8.1"]);
    assert!(text.starts_with("node ") && text.lines().count() == 5, "{text}");
    for line in text.lines().skip(1) {
        let path = line.strip_prefix("wrote ").expect("a path");
        assert!(path.contains("shear-edge-crack.riss-out") && folder.join(path).exists(), "{line}");
    }
    let refused = |arguments: &[&str]| {
        let output = riss(&folder, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        String::from_utf8(output.stderr).expect("UTF-8")
    };
    assert!(refused(&["shape", &shear_case(), "--node", "1000000"]).contains("there is no node 1000000"));
    assert!(refused(&["shape", &shear_case(), "--at", "3.4"]).contains("expected two numbers, such as 3.5,8"));
    assert!(refused(&["shape", &shear_case()]).contains("--node"));
}

#[test]
fn run_prints_a_table_and_writes_files() {
    let folder = scratch("run");
    let text = stdout(&folder, &["run", &shear_case(), "--out", "out", "--quiet"]);
    let row = text.lines().find(|l| l.starts_with("crack-1")).expect("a row of the table");
    let k1: f64 = row.split_whitespace().nth(4).expect("K_I").parse().expect("a number");
    // Wilson (1969): 34.0; the case's own test is sharper.
    assert!((k1 - 34.0).abs() < 0.5, "{text}");
    assert!(text.contains("wrote out/results.json") && folder.join("out/results.json").exists());
}

#[test]
fn run_prints_json_alone() {
    let output =
        riss(&scratch("json"), &["run", &shear_case(), "--json", "--set", "output.fields=false", "--threads", "2"]);
    let results: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert!(results["steps"][0]["cracks"][0]["tips"][0]["K_I"].is_number());
    let stages = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(stages.starts_with("nodes\ndiscretization\n"), "{stages}");
}

#[test]
fn every_run_draws_the_deformed_body() {
    let folder = scratch("picture");
    stdout(&folder, &["run", &shear_case(), "--out", "out", "--quiet", "--threads", "1"]);
    assert!(std::fs::read_to_string(folder.join("out/deformed.svg")).expect("there").ends_with("</svg>\n"));
    let results = std::fs::read_to_string(folder.join("out/results.json")).expect("there");
    assert!(results.contains("\"deformed.svg\""));
}

#[test]
fn a_folder_that_cannot_be_written_is_refused_before_the_run() {
    let folder = scratch("unwritable");
    std::fs::write(folder.join("file"), "mine").expect("written");
    for (command, out) in [("run", "file"), ("run", "file/below"), ("check", "file")] {
        let output = riss(&folder, &[command, &shear_case(), "--out", out]);
        assert_eq!(output.status.code(), Some(1));
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.ends_with(&format!("to {out}: a file is in the way\n")), "{message}");
        assert!(command == "check" || output.stdout.is_empty());
    }
    assert_eq!(std::fs::read_to_string(folder.join("file")).expect("read"), "mine");
    let missing = riss(&folder, &["new", "no/such/case.toml"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&missing.stderr).contains("there is no such folder"));
}

#[test]
fn starting_over_replaces_all_files_and_leaves_no_others() {
    let folder = scratch("twice");
    let files = || {
        let entries = std::fs::read_dir(folder.join("out")).expect("there");
        let mut names: Vec<_> = entries.map(|e| e.expect("readable").file_name()).collect();
        names.sort();
        names
    };
    stdout(&folder, &["run", &shear_case(), "--out", "out", "--quiet"]);
    let first = files();
    stdout(&folder, &["run", &shear_case(), "--out", "out", "--quiet"]);
    assert_eq!((files(), first.len()), (first.clone(), 9));
}

#[test]
fn a_failed_analysis_has_its_own_exit_code() {
    // Held along y only: free to slide along x.
    let output =
        riss(&scratch("failed"), &["run", &shear_case(), "--quiet", "--set", "support=[{ on = 'bottom', y = 0 }]"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).starts_with("error: "));
}

#[test]
fn new_writes_a_valid_case_and_never_overwrites() {
    let folder = scratch("new");
    stdout(&folder, &["new"]);
    stdout(&folder, &["check", "case.toml"]);
    let text = stdout(&folder, &["run", "case.toml", "--quiet", "--out", "out"]);
    let row = text.lines().find(|l| l.starts_with("crack-1")).expect("a row of the table");
    let k1: f64 = row.split_whitespace().nth(4).expect("K_I").parse().expect("a number");
    // Edge crack of 0.3 of the width in tension [Tada]: 1.66 σ √(π a).
    assert!((k1 / (80.0 * (30.0 * std::f64::consts::PI).sqrt()) - 1.66).abs() < 0.01, "{text}");
    std::fs::write(folder.join("case.toml"), "mine").expect("written");
    let again = riss(&folder, &["new", "case.toml"]);
    assert_eq!(again.status.code(), Some(2));
    assert_eq!(std::fs::read_to_string(folder.join("case.toml")).expect("read"), "mine");
}

#[test]
fn what_the_starter_case_comments_out_is_valid_too() {
    let folder = scratch("starter");
    stdout(&folder, &["new"]);
    let text = std::fs::read_to_string(folder.join("case.toml")).expect("read");
    let mut tried = 0;
    for section in [
        "[[hole]]",
        "[[part]]",
        "[remote_stress]",
        "[[point_load]]",
        "[approximation]",
        "[nodes.layout.graded]",
        "[output]",
    ] {
        let start = text.find(&format!("# {section}")).unwrap_or_else(|| panic!("no {section}"));
        let lines: Vec<&str> = text[start..].lines().take_while(|l| l.starts_with("# ")).collect();
        let end = lines.iter().skip(1).position(|l| l.starts_with("# [")).map_or(lines.len(), |k| k + 1);
        let body: String = lines[..end].iter().map(|l| format!("{}\n", &l[2..])).collect();
        std::fs::write(folder.join("more.toml"), format!("{text}\n{body}")).expect("written");
        stdout(&folder, &["check", "more.toml"]);
        tried += 1;
    }
    assert_eq!(tried, 7);
}

#[test]
fn schema_is_json() {
    let schema: serde_json::Value = serde_json::from_str(&stdout(&root(), &["schema"])).expect("JSON");
    assert_eq!(schema["title"], "riss case");
    assert!(schema["properties"]["fracture"].is_object());
}
