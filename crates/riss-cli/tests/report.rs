//! `riss report`, `riss run --open` and `riss export`, as their users see them.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A strip of width 4 whose edge crack of length 1 grows straight ahead.
const CASE: &str = r#"title = "Strip"
rigid_motion = "mean-is-zero"
material = { young = 1e3, poisson = 0.3, plane = "strain" }
geometry.rectangle = { lower = [0, -6], upper = [4, 6] }

[[crack]]
path = [[0, 0], [1, 0]]

[[load]]
on = "top"
traction = [0, 10]

[[load]]
on = "bottom"
traction = [0, -10]

[growth]
increment = 0.2
steps = 2
"#;

fn riss(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_riss")).args(arguments).current_dir(folder).output().expect("riss runs")
}

fn stdout(folder: &Path, arguments: &[&str]) -> String {
    let output = riss(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

fn check_refused(folder: &Path, arguments: &[&str], reason: &str) {
    let output = riss(folder, arguments);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(message.contains(reason), "{message}");
}

/// A fresh folder with the case.
fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("made");
    std::fs::write(folder.join("case.toml"), CASE).expect("written");
    folder
}

fn read(path: PathBuf) -> String {
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

#[test]
fn a_report_is_made_again_and_a_resumed_run_keeps_all_its_steps() {
    let folder = scratch("report-again");
    stdout(&folder, &["run", "case.toml", "--out", "out", "--quiet"]);
    stdout(&folder, &["run", "--resume", "out", "--quiet", "--set", "growth.steps=3"]);
    let page = read(folder.join("out/report.html"));
    let results: Value = serde_json::from_str(&read(folder.join("out/results.json"))).expect("JSON");
    let steps = results["steps"].as_array().expect("steps").len();
    assert!(steps >= 4);
    for step in 0..steps {
        assert!(page.contains(&format!("id=\"fields-{step}\"")), "no fields of step {step}");
    }
    assert!(page.contains("growth.steps=3") && page.contains("rigid_motion"));
    std::fs::remove_file(folder.join("out/report.html")).expect("removed");
    assert_eq!(stdout(&folder, &["report", "out"]), "wrote out/report.html\n");
    assert_eq!(read(folder.join("out/report.html")), page);
    check_refused(&folder, &["report", "."], "is no folder of results");
}

#[cfg(target_os = "linux")]
#[test]
fn a_report_is_opened_as_a_double_click_does() {
    use std::os::unix::fs::PermissionsExt;
    let folder = scratch("report-open");
    let opener = folder.join("bin/xdg-open");
    std::fs::create_dir(folder.join("bin")).expect("made");
    std::fs::write(&opener, "#!/bin/sh\nprintf '%s' \"$1\" > \"$OPENED.part\" && mv \"$OPENED.part\" \"$OPENED\"\n")
        .expect("written");
    std::fs::set_permissions(&opener, std::fs::Permissions::from_mode(0o755)).expect("set");
    let opened = |arguments: &[&str], path: &str| {
        let seen = folder.join("opened");
        let _ = std::fs::remove_file(&seen);
        let mut command = Command::new(env!("CARGO_BIN_EXE_riss"));
        command.args(arguments).current_dir(&folder).env("PATH", path).env("OPENED", &seen);
        let output = command.output().expect("riss runs");
        assert!(output.status.success());
        // The opener is not waited for.
        let patience = std::time::Instant::now();
        while !seen.exists() && output.stderr.is_empty() && patience.elapsed().as_secs() < 20 {
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        (std::fs::read_to_string(&seen).unwrap_or_default(), String::from_utf8(output.stderr).expect("UTF-8"))
    };
    let path = format!("{}:/usr/bin:/bin", folder.join("bin").display());
    let run = ["run", "case.toml", "--out", "out", "--quiet", "--open", "--set", "growth.steps=1"];
    let report = folder.join("out/report.html").canonicalize();
    assert!(report.is_err());
    let (seen, _) = opened(&run, &path);
    let report = folder.join("out/report.html").canonicalize().expect("there").display().to_string();
    assert_eq!(seen, report);
    assert_eq!(opened(&["report", "out", "--open"], &path).0, report);
    // A machine without a desktop: a note, no failure.
    let (seen, message) = opened(&["report", "out", "--open"], "/nowhere");
    assert!(seen.is_empty() && message.starts_with("note: "), "{message}");
}

#[test]
fn cracks_and_beta_factors_go_to_other_programs() {
    let folder = scratch("export");
    stdout(&folder, &["run", "case.toml", "--out", "out", "--quiet"]);
    assert_eq!(stdout(&folder, &["export", "out", "--format", "csv"]), "wrote out/cracks.csv\n");
    let rows = read(folder.join("out/cracks.csv"));
    let last: Vec<&str> = rows.lines().last().expect("rows").split(',').collect();
    assert!(last[2].parse::<f64>().expect("x") > 1.3, "{rows}");
    stdout(&folder, &["export", "out", "--format", "csv", "--step", "0", "--out", "first"]);
    assert!(read(folder.join("first/cracks.csv")).ends_with("crack-1,1,1.0,0.0,1.0\n"));
    stdout(&folder, &["export", "out", "--format", "vtp"]);
    assert!(read(folder.join("out/cracks.vtp")).contains("PolyData"));
    stdout(&folder, &["export", "out", "--format", "stl", "--thickness", "3"]);
    assert!(read(folder.join("out/cracks.stl")).contains("vertex 1e0 0e0 3e0"));
    stdout(&folder, &["export", "out", "--format", "easigrow", "--stress", "10", "--distance", "4"]);
    let table = read(folder.join("out/beta_crack-1_end.txt"));
    let first = table.lines().find(|l| !l.starts_with('#')).expect("a row");
    let (length, beta) = first.split_once(' ').expect("two numbers");
    assert_eq!(length, "0.25");
    // Edge crack of a quarter of the width in tension [Tada]: 1.12 - 0.231 r + 10.55 r² - 21.72 r³ + 30.39 r⁴ = 1.501.
    let beta: f64 = beta.parse().expect("a number");
    assert!((beta - 1.501).abs() < 0.015, "{table}");
    check_refused(&folder, &["export", "out", "--format", "easigrow"], "--stress");
    stdout(&folder, &["export", "out", "--format", "afgrow", "--stress", "10"]);
    assert!(read(folder.join("out/beta_crack-1_end.tsv")).starts_with(&format!("1\t{beta}\n")));
    check_refused(&folder, &["export", "out", "--format", "afgrow"], "--stress");
    check_refused(&folder, &["export", "out", "--format", "stl", "--thickness", "0"], "above 0");
    check_refused(&folder, &["export", "out", "--format", "csv", "--step", "9"], "step 9 is not in out");
    check_refused(&folder, &["export", ".", "--format", "csv"], "cannot be read");
}
