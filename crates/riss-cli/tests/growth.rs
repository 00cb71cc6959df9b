//! Growth as its users run it: lines on the terminal, files after every step, killed and resumed runs.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

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
steps = 6
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

/// The results without what differs from run to run: times.
fn results(folder: &Path, name: &str) -> Value {
    let text = std::fs::read_to_string(folder.join(name).join("results.json")).expect("there are results");
    let mut value: Value = serde_json::from_str(&text).expect("JSON");
    for key in ["wall_time_s", "stage_time_s", "peak_memory_bytes"] {
        value.as_object_mut().expect("an object").remove(key);
    }
    for step in value["steps"].as_array_mut().expect("steps") {
        step.as_object_mut().expect("an object").remove("stage_time_s");
    }
    value
}

fn n_steps(folder: &Path, name: &str) -> usize {
    let text = std::fs::read_to_string(folder.join(name).join("results.json")).unwrap_or_default();
    serde_json::from_str(&text).map_or(0, |v: Value| v["steps"].as_array().map_or(0, Vec::len))
}

#[test]
fn a_step_is_a_line_and_a_row_and_a_file() {
    let folder = scratch("growth-lines");
    let output = riss(&folder, &["run", "case.toml", "--out", "whole", "--quiet"]);
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(output.status.success(), "{text}");
    assert_eq!(text.lines().filter(|l| l.starts_with("step ")).count(), 7, "{text}");
    assert!(text.contains("grows 0.200000") && text.contains("growth ended: 6 steps are done"), "{text}");
    let history = std::fs::read_to_string(folder.join("whole/history.csv")).expect("there is a history");
    assert_eq!(history.lines().count(), 8);
    let results = results(&folder, "whole");
    assert_eq!(
        (results["status"].as_str(), results["growth_end"]["kind"].as_str()),
        (Some("done"), Some("steps-done"))
    );
    let files = results["files"].as_array().expect("a list");
    for file in files {
        let name = file.as_str().expect("a name");
        assert!(folder.join("whole").join(name).is_file(), "{name}");
    }
    assert!((0..7).all(|k| files.iter().any(|f| f == &format!("fields_{k:04}.vtu"))));
    let collection = std::fs::read_to_string(folder.join("whole/fields.pvd")).expect("there is a collection");
    assert_eq!(collection.matches("<DataSet").count(), 7);
}

#[test]
fn a_killed_run_goes_on_as_if_nothing_had_happened() {
    let folder = scratch("growth-killed");
    assert!(riss(&folder, &["run", "case.toml", "--out", "whole", "--quiet"]).status.success());
    let mut child = Command::new(env!("CARGO_BIN_EXE_riss"))
        .args(["run", "case.toml", "--out", "killed", "--quiet"])
        .current_dir(&folder)
        .stdout(Stdio::null())
        .spawn()
        .expect("riss runs");
    let patience = Instant::now();
    while n_steps(&folder, "killed") < 2 && patience.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    assert!(n_steps(&folder, "killed") >= 2);
    let output = riss(&folder, &["run", "--resume", "killed", "--quiet"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(results(&folder, "killed"), results(&folder, "whole"));
    // From an earlier step on, what was after it is made again.
    assert!(riss(&folder, &["run", "--resume", "killed", "--from-step", "2", "--quiet"]).status.success());
    assert_eq!(results(&folder, "killed"), results(&folder, "whole"));
}

#[test]
fn growth_settings_may_change_in_between_but_nothing_else() {
    let folder = scratch("growth-changed");
    assert!(
        riss(&folder, &["run", "case.toml", "--quiet", "--set", "growth.steps=2", "--out", "run"]).status.success()
    );
    let more = ["run", "--resume", "run", "--quiet", "--set", "growth.steps=3", "--set", "growth.increment=0.1"];
    let output = riss(&folder, &more);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let changed = results(&folder, "run");
    assert_eq!(changed["steps"].as_array().map(Vec::len), Some(4));
    assert_eq!(changed["steps"][2]["cracks"][0]["tips"][0]["increment"].as_f64(), Some(0.1));
    std::fs::write(folder.join("case.toml"), CASE.replace("young = 1e3", "young = 2e3")).expect("written");
    check_refused(&folder, &["run", "--resume", "run"], "`material`");
}

fn check_refused(folder: &Path, arguments: &[&str], part: &str) {
    let output = riss(folder, arguments);
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains(part), "{text}");
}

#[test]
fn what_cannot_be_resumed_is_said() {
    let folder = scratch("growth-refused");
    check_refused(&folder, &["run", "--resume", "nowhere"], "no growth to go on with");
    check_refused(&folder, &["run", "case.toml", "--from-step", "2"], "--resume");
    assert!(
        riss(&folder, &["run", "case.toml", "--quiet", "--set", "growth.steps=1", "--out", "run"]).status.success()
    );
    check_refused(
        &folder,
        &["run", "--resume", "run", "--from-step", "5"],
        "step 5 is not in run; the last one there is 1",
    );
    std::fs::write(folder.join("run/restart/step_0001.json"), "{}").expect("written");
    check_refused(&folder, &["run", "--resume", "run"], "the state of step 1");
    std::fs::write(folder.join("run/results.json"), "half").expect("written");
    check_refused(&folder, &["run", "--resume", "run"], "the results in run cannot be read");
}
