//! What happens to a run that is interrupted, killed, or not alone; whose disk is full, folder read-only, or input changed.

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

/// A growth run of a second, with fields in every step.
const SHORT: &str = r#"material = { young = 1e3, poisson = 0.3, plane = "strain" }
geometry.rectangle = { lower = [0, 0], upper = [4, 6] }
nodes.layout.graded = { spacing = 0.4, tip_spacing = 0.02 }
rigid_motion = "mean-is-zero"
remote_stress = { yy = 1 }

[[crack]]
path = [[0, 3], [1, 3.1]]

[growth]
increment = 0.1
steps = 12
"#;

/// Names of what is in the folder of results and below, without the lock of a run that was killed.
fn names(folder: &Path) -> Vec<String> {
    let mut found = vec![];
    for dir in ["out", "out/restart", "out/report"] {
        for entry in std::fs::read_dir(folder.join(dir)).into_iter().flatten() {
            found.push(format!("{dir}/{}", entry.expect("readable").file_name().to_string_lossy()));
        }
    }
    found.sort();
    found
}

/// All that was computed, without times: steps, fields, states.
fn outcome(folder: &Path) -> (Vec<Value>, Vec<(String, Vec<u8>)>) {
    let kept = |name: &&String| name.ends_with(".vtu") || name.contains("restart/step_");
    let names = names(folder);
    let files = names.iter().filter(kept).map(|n| (n.clone(), std::fs::read(folder.join(n)).expect("readable")));
    (numbers(&steps(folder).expect("results")), files.collect())
}

/// A small generator of numbers [0, 1), always the same.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*state >> 33) as f64 / (1u64 << 31) as f64
}

#[test]
fn a_run_that_is_killed_at_any_moment_goes_on_with_the_same_bits() {
    let whole = scratch("kill-none");
    std::fs::write(whole.join("case.toml"), SHORT).expect("written");
    let begin = Instant::now();
    assert!(riss(&whole, &["run", "case.toml", "--out", "out", "-q"]).status.success());
    let time = begin.elapsed().as_secs_f64();
    let folder = scratch("kill-random");
    std::fs::write(folder.join("case.toml"), SHORT).expect("written");
    let mut state = 7;
    let mut n_kills = 0;
    let mut arguments = vec!["run", "case.toml", "--out", "out", "-q"];
    for _ in 0..12 {
        let mut command = Command::new(env!("CARGO_BIN_EXE_riss"));
        command.args(&arguments).current_dir(&folder).stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = command.spawn().expect("riss runs");
        std::thread::sleep(Duration::from_secs_f64(0.4 * time * random(&mut state)));
        child.kill().expect("it can be killed");
        n_kills += usize::from(!child.wait().expect("it ends").success());
        let before = n_steps(&folder);
        // Whatever results name is there and whole.
        if before > 0 {
            let text = std::fs::read(folder.join("out/results.json")).expect("results");
            let results: Value = serde_json::from_slice(&text).expect("whole");
            for file in results["files"].as_array().expect("a list") {
                let path = folder.join("out").join(file.as_str().expect("a name"));
                assert!(path.is_file(), "{}", path.display());
                if path.extension().is_some_and(|e| e == "json") {
                    let text = std::fs::read(&path).expect("readable");
                    assert!(serde_json::from_slice::<Value>(&text).is_ok(), "{}", path.display());
                }
            }
        }
        if folder.join("out/restart/case.json").exists() {
            arguments = vec!["run", "--resume", "out", "-q"];
        }
        // Nothing of finished steps is lost.
        assert!(n_steps(&folder) >= before);
    }
    assert!(n_kills >= 6, "{n_kills} runs were killed");
    let output = riss(&folder, &arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(outcome(&folder) == outcome(&whole), "the bits differ");
    assert_eq!(names(&folder), names(&whole));
}

#[test]
fn going_back_keeps_the_step_that_is_gone_back_to() {
    let folder = scratch("back");
    std::fs::write(folder.join("case.toml"), SHORT).expect("written");
    assert!(riss(&folder, &["run", "case.toml", "--out", "out", "-q"]).status.success());
    let whole = outcome(&folder);
    // Killed before the first step of the new run is done.
    let mut command = Command::new(env!("CARGO_BIN_EXE_riss"));
    command.args(["run", "--resume", "out", "--from-step", "4", "-q"]).current_dir(&folder).stdout(Stdio::null());
    let mut child = command.spawn().expect("riss runs");
    let begin = Instant::now();
    while n_steps(&folder) != 5 && begin.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    assert!(n_steps(&folder) >= 5);
    let text = std::fs::read_to_string(folder.join("out/results.json")).expect("results");
    assert!(!text.contains("step_0011.json") && text.contains("step_0004.json"));
    assert!(riss(&folder, &["run", "--resume", "out", "-q"]).status.success());
    assert!(outcome(&folder) == whole, "the bits differ");
}

/// Runs with files limited to so many blocks of 512 or 1024 bytes, as if the disk were full; writing then fails.
fn run_with_little_disk(folder: &Path, blocks: usize, arguments: &str) -> Output {
    let riss = env!("CARGO_BIN_EXE_riss");
    let script = format!("ulimit -f {blocks}; trap '' XFSZ; exec '{riss}' {arguments}");
    Command::new("sh").args(["-c", &script]).current_dir(folder).output().expect("sh runs")
}

#[test]
fn a_full_disk_leaves_the_steps_before_and_no_half_files() {
    let folder = scratch("full");
    std::fs::write(folder.join("case.toml"), SHORT).expect("written");
    assert!(riss(&folder, &["run", "case.toml", "--out", "out", "-q"]).status.success());
    let whole = outcome(&folder);
    let sizes: Vec<u64> = std::fs::read_dir(folder.join("out"))
        .expect("there")
        .map(|e| e.expect("readable").metadata().expect("there").len())
        .collect();
    assert!(sizes.iter().any(|s| *s > 200_000), "the report is large: {sizes:?}");
    // A new run cannot write its first step.
    let fresh = scratch("full-fresh");
    std::fs::write(fresh.join("case.toml"), SHORT).expect("written");
    let output = run_with_little_disk(&fresh, 8, "run case.toml --out out -q");
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("cannot write the results to out: cannot write out/"), "{message}");
    assert!(names(&fresh).iter().all(|n| !n.ends_with(".tmp") && !n.ends_with("results.json")), "{:?}", names(&fresh));
    let output = riss(&fresh, &["run", "--resume", "out", "-q"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(outcome(&fresh) == whole, "the bits differ");
    // One that goes on cannot write the next; what it had stays.
    let until = ["run", "case.toml", "--out", "out", "-q", "--set", "growth.steps=5"];
    assert!(riss(&fresh, &until).status.success());
    let before = steps(&fresh).expect("results");
    let output = run_with_little_disk(&fresh, 40, "run --resume out -q --set growth.steps=12");
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("cannot write out/"), "{message}");
    assert_eq!(numbers(&steps(&fresh).expect("results")), numbers(&before));
    assert!(names(&fresh).iter().all(|n| !n.ends_with(".tmp")), "{:?}", names(&fresh));
    assert!(riss(&fresh, &["run", "--resume", "out", "-q", "--set", "growth.steps=12"]).status.success());
    assert!(outcome(&fresh) == whole, "the bits differ");
}

#[test]
fn output_that_nobody_can_take_is_no_panic() {
    let folder = scratch("dev-full");
    std::fs::write(folder.join("case.toml"), SHORT).expect("written");
    let riss = env!("CARGO_BIN_EXE_riss");
    // The table and the notes are lost, the files are not.
    let script = format!("exec '{riss}' run case.toml --out out --set growth.steps=1 >/dev/full 2>/dev/full");
    let status = Command::new("sh").args(["-c", &script]).current_dir(&folder).status().expect("sh runs");
    assert_eq!((status.code(), n_steps(&folder)), (Some(0), 2));
}

#[test]
fn a_read_only_folder_is_refused_before_the_run() {
    use std::os::unix::fs::PermissionsExt;
    let folder = scratch("read-only");
    let out = folder.join("out");
    std::fs::create_dir(&out).expect("made");
    let set = |mode: u32| std::fs::set_permissions(&out, std::fs::Permissions::from_mode(mode)).expect("set");
    set(0o555);
    // Permissions do not hold back root, who has other folders in which nothing can be made.
    let is_root = std::fs::write(out.join("probe"), "").is_ok();
    let dir = if is_root { "/proc/sys/riss" } else { "out" };
    let output = riss(&folder, &["run", "case.toml", "--out", dir]);
    set(0o755);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains(&format!("cannot write the results to {dir}: ")), "{message}");
    assert!(output.stdout.is_empty());
}

#[test]
fn input_that_changes_while_it_runs_changes_nothing() {
    let folder = scratch("changed");
    std::fs::write(folder.join("case.toml"), SHORT).expect("written");
    let mut command = Command::new(env!("CARGO_BIN_EXE_riss"));
    command.args(["run", "case.toml", "--out", "out", "-q"]).current_dir(&folder).stdout(Stdio::null());
    let mut child = command.spawn().expect("riss runs");
    while !folder.join("out/restart/case.json").exists() {
        assert!(child.try_wait().expect("known").is_none(), "it still runs");
        std::thread::sleep(Duration::from_millis(1));
    }
    std::fs::write(folder.join("case.toml"), "young = ").expect("written");
    assert!(child.wait().expect("it ends").success());
    let fields = std::fs::read_to_string(folder.join("out/report/run.json")).expect("there");
    assert!(fields.contains("increment = 0.1"), "the report shows what was run");
    let other = scratch("changed-not");
    std::fs::write(other.join("case.toml"), SHORT).expect("written");
    assert!(riss(&other, &["run", "case.toml", "--out", "out", "-q"]).status.success());
    assert!(outcome(&folder) == outcome(&other), "the bits differ");
    // Going on with it is refused, not guessed.
    let output = riss(&folder, &["run", "--resume", "out"]);
    assert_eq!(output.status.code(), Some(2));
}
