//! Every class of wrong input gets the message its author needs: one file, one snapshot.

use std::path::{Path, PathBuf};
use std::process::Command;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad-cases")
}

/// Exit code and stderr of `riss check`.
fn check(arguments: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_riss"));
    let output = command.arg("check").args(arguments).current_dir(folder()).output().expect("riss runs");
    assert!(output.stdout.is_empty(), "{arguments:?} passed: {}", String::from_utf8_lossy(&output.stdout));
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    String::from_utf8(output.stderr).expect("messages are UTF-8")
}

#[test]
fn every_bad_case_is_explained() {
    let mut files: Vec<String> = std::fs::read_dir(folder())
        .expect("the folder is there")
        .map(|entry| entry.expect("readable").file_name().into_string().expect("plain names"))
        .filter(|name| name.ends_with(".toml"))
        .collect();
    files.sort();
    assert!(files.len() > 100);
    for file in files {
        insta::assert_snapshot!(file.trim_end_matches(".toml"), check(&[&file]));
    }
}

#[test]
fn files_that_cannot_be_read() {
    insta::assert_snapshot!("missing-file", check(&["no-such.toml"]));
    insta::assert_snapshot!("folder-for-file", check(&["."]));
}

#[test]
fn files_that_are_too_large() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("large.toml");
    std::fs::write(&path, "#".repeat(10_000_001)).expect("written");
    assert!(check(&[path.to_str().expect("plain path")]).contains("larger than 10 MB"));
}

#[test]
fn bad_overrides_are_named() {
    let good = "../../../../cases/shear-edge-crack/case.toml";
    for (name, set) in [
        ("override-without-value", "material.young"),
        ("override-unknown-key", "material.yuong=1"),
        ("override-wrong-type", "material.young=steel"),
        ("override-out-of-range", "material.poisson=0.5"),
        ("override-bad-index", "crack[3].path=[[0, 8], [1, 8]]"),
        ("override-bad-path", "material..young=1"),
    ] {
        insta::assert_snapshot!(name, check(&[good, "--set", set]));
    }
}
