//! What happens to a run that is interrupted, killed, or not alone.

#![cfg(unix)]

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// More steps than are waited for.
const CASE: &str = r#"material = { young = 1e3, poisson = 0.3, plane = "strain" }
geometry.rectangle = { lower = [0, 0], upper = [40, 60] }
nodes.layout.graded = { spacing = 4, tip_spacing = 0.2 }
rigid_motion = "mean-is-zero"
remote_stress = { yy = 1 }
output.fields = false

[[crack]]
path = [[0, 30], [5, 30.5]]

[growth]
increment = 0.05
steps = 600
"#;

fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("made");
    std::fs::write(folder.join("case.toml"), CASE).expect("written");
    folder
}

fn riss(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_riss")).args(arguments).current_dir(folder).output().expect("riss runs")
}

/// Starts a run that goes on for long, and waits until it has written some steps.
fn start(folder: &Path) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_riss"));
    let child = command.args(["run", "case.toml", "--out", "out"]).current_dir(folder);
    let child = child.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("riss runs");
    let start = Instant::now();
    while n_steps(folder) < 2 {
        assert!(start.elapsed() < Duration::from_secs(120), "no steps are written");
        std::thread::sleep(Duration::from_millis(20));
    }
    child
}

fn steps(folder: &Path) -> Option<Vec<Value>> {
    let text = std::fs::read_to_string(folder.join("out/results.json")).ok()?;
    let value: Value = serde_json::from_str(&text).expect("whole files only");
    value["steps"].as_array().cloned()
}

fn n_steps(folder: &Path) -> usize {
    steps(folder).map_or(0, |s| s.len())
}

fn send(signal: &str, child: &Child) {
    let status = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill runs");
    assert!(status.success());
}

/// Steps without the times that they took.
fn numbers(steps: &[Value]) -> Vec<Value> {
    let mut steps = steps.to_vec();
    for step in &mut steps {
        step.as_object_mut().expect("an object").remove("stage_time_s");
    }
    steps
}

#[test]
fn an_interrupted_run_finishes_its_step_and_says_how_to_go_on() {
    let folder = scratch("interrupted");
    let child = start(&folder);
    send("-INT", &child);
    let output = child.wait_with_output().expect("it ends");
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{message}");
    let before = steps(&folder).expect("results");
    assert!(message.contains(&format!("stopped after step {}", before.len() - 1)), "{message}");
    assert!(message.contains("riss run --resume out"), "{message}");
    let until = format!("growth.steps={}", before.len() + 1);
    let output = riss(&folder, &["run", "--resume", "out", "--set", &until, "-q"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let after = steps(&folder).expect("results");
    assert!(after.len() > before.len());
    // The last step was the last of a run then.
    let n = before.len() - 1;
    assert_eq!(numbers(&after[..n]), numbers(&before[..n]));
    assert!(!folder.join("out/.riss.lock").exists());
}

#[test]
fn two_runs_do_not_write_into_one_folder() {
    let folder = scratch("twice");
    let mut child = start(&folder);
    let second = riss(&folder, &["run", "case.toml", "--out", "out", "-q"]);
    let message = String::from_utf8_lossy(&second.stderr).into_owned();
    assert_eq!(second.status.code(), Some(1), "{message}");
    assert!(message.contains("another run is writing there"), "{message}");
    // However the first one ends, the folder is free then, and what was written can be read.
    child.kill().expect("it runs");
    child.wait().expect("it ends");
    let n = n_steps(&folder);
    assert!(n >= 2);
    let until = format!("growth.steps={n}");
    let third = riss(&folder, &["run", "--resume", "out", "--set", &until, "-q"]);
    assert_eq!(third.status.code(), Some(0), "{}", String::from_utf8_lossy(&third.stderr));
}
