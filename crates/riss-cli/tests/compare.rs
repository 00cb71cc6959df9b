//! `riss compare` as its users run it.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const CASE: &str = r#"title = "Sheared plate"
material = { young = 1e3, poisson = 0.3, plane = "strain" }
geometry.rectangle = { lower = [0, 0], upper = [4, 6] }
nodes.layout.graded = { spacing = 0.4, tip_spacing = 0.02 }

[[crack]]
path = [[0, 3], [1.5, 3]]

[[support]]
on = "bottom"
x = 0
y = 0

[[load]]
on = "top"
traction = [1, 0.2]

[growth]
increment = 0.2
steps = 2
"#;

fn riss(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_riss")).args(arguments).current_dir(folder).output().expect("riss runs")
}

fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("made");
    std::fs::write(folder.join("case.toml"), CASE).expect("written");
    folder
}

#[test]
fn a_case_agrees_with_its_own_results() {
    let folder = scratch("compare-same");
    assert_eq!(riss(&folder, &["run", "case.toml", "--out", "a", "-q"]).status.code(), Some(0));
    let output = riss(&folder, &["compare", "case.toml", "a", "--K", "1e-9", "--path", "1e-9", "-q"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(text.contains("path distance") && text.contains("crack-1  end      3"), "{text}");
    // Nothing is written beside the results that were there.
    assert_eq!(std::fs::read_dir(&folder).expect("there").count(), 2);
}

#[test]
fn another_increment_differs_and_says_by_how_much() {
    let folder = scratch("compare-increments");
    let increment = "growth.increment=0.1";
    let arguments = ["compare", "case.toml", "case.toml", "--set", increment, "-q", "--json", "--path", "0.01"];
    let output = riss(&folder, &arguments);
    assert_eq!(output.status.code(), Some(3), "{}", String::from_utf8_lossy(&output.stderr));
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let crack = &value["cracks"][0];
    let number = |v: &Value| v.as_f64().expect("a number");
    // The second turn comes after half the way; two increments make 0.4 and 0.2.
    let distance = number(&crack["path_distance"]);
    assert!(distance > 2e-4 && distance < 0.05, "{distance}");
    for (length, expected) in [(&crack["lengths"][0], 1.9), (&crack["lengths"][1], 1.7)] {
        assert!((number(length) - expected).abs() < 1e-9, "{length}");
    }
    // Where both have not grown at all, and by 0.2.
    assert_eq!(crack["tips"][0]["steps"], 2);
    assert!(number(&crack["tips"][0]["K_difference"]) < 0.05);
}

#[test]
fn what_cannot_be_read_is_said() {
    let folder = scratch("compare-missing");
    std::fs::create_dir_all(folder.join("empty")).expect("made");
    let output = riss(&folder, &["compare", "empty", "case.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("empty/results.json cannot be read"));
    assert_eq!(riss(&folder, &["compare", "nowhere.toml", "case.toml", "-q"]).status.code(), Some(2));
}

/// The same path and factors, along the same criterion: the methods differ in supports and domains.
#[test]
fn both_methods_agree() {
    let folder = scratch("compare-methods");
    let mut arguments = vec!["compare", "case.toml", "case.toml", "-q"];
    let fixed = [
        "method=\"cracking-particles\"",
        "growth.criterion=\"maximum-circumferential-stress\"",
        "growth.control=\"fixed\"",
    ];
    fixed.iter().for_each(|o| arguments.extend(["--set", o]));
    let output = riss(&folder, &arguments);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(text.contains("path distance") && text.contains("K difference"), "{text}");
    assert!(!text.contains("  0 %  "), "the runs differ: {text}");
    // Along the force, its own choice, the way is another one.
    let output = riss(&folder, &["compare", "case.toml", "case.toml", "-q", "--set", fixed[0], "--path", "0.01"]);
    assert_eq!(output.status.code(), Some(3), "{}", String::from_utf8_lossy(&output.stdout));
}
