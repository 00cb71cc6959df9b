//! Cohesive cracks in the plane as their users load them.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

const BEAM: &str = r#"title = "Beam"
rigid_motion = "mean-is-zero"
units = "mm, N, MPa"
geometry.rectangle = { lower = [-170, 0], upper = [170, 75] }
load = [
    { on = "top", traction = [0, "-max(0, 1 - (x/10)^2)"] },
    { on = "bottom", traction = [0, "0.5*max(0, 1 - ((x - 150)/10)^2) + 0.5*max(0, 1 - ((x + 150)/10)^2)"] },
]
growth = { increment = 6, steps = 4 }
loading.largest_displacement = 0.05

[[crack]]
name = "crack"
cohesive = true
path = [[-60, 0], [-60, 37.5]]
notch = [{ lower = [-61, -1], upper = [-59, 37.5] }]

[material]
young = 38000
poisson = 0.2
plane = "stress"
thickness = 50
cohesive = { strength = 3, fracture_energy = "0.069 N/mm" }
"#;

fn riss(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_riss")).args(arguments).current_dir(folder).output().expect("riss runs")
}

fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("made");
    fs::write(folder.join("case.toml"), BEAM).expect("written");
    folder
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

fn results(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("results.json")).expect("written")).expect("JSON")
}

#[test]
fn a_beam_has_a_load_curve_in_all_its_files() {
    let folder = scratch("plane-loading");
    let run = riss(&folder, &["run", "case.toml", "--out", "a", "-q"]);
    assert_eq!(run.status.code(), Some(0), "{}", said(&run));
    assert!(said(&run).contains("first crack: load") && said(&run).contains("peak:        load"), "{}", said(&run));
    let a = folder.join("a");
    let found = results(&a);
    assert_eq!((&found["status"], &found["loading"]["end"]["kind"]), (&"done".into(), &"limit-reached".into()));
    assert_eq!(found["growth_end"]["kind"], "steps-done");
    let curve = found["load_curve"].as_array().expect("a curve");
    let table = fs::read_to_string(a.join("load_curve.csv")).expect("written");
    assert_eq!(table.lines().count(), curve.len() + 1);
    assert!(
        table.starts_with(
            "step,load_factor,displacement,load,dissipated_energy,elastic_energy,external_work,crack_area\n"
        )
    );
    // Steps are points of the curve, with the load that their fields are for.
    let steps = found["steps"].as_array().expect("steps");
    assert!(steps.len() > 8 && steps.iter().any(|s| s["step"] == found["loading"]["peak"]["step"]));
    for step in steps {
        let point = &curve[step["step"].as_u64().expect("a number") as usize];
        assert_eq!(step["load_factor"], point["load_factor"]);
        assert_eq!(step["cracks"][0]["path"].as_array().expect("a path").len(), 6);
        assert!(a.join(format!("cracks_{:04}.vtu", step["step"].as_u64().expect("a number"))).is_file());
    }
    for file in found["files"].as_array().expect("files") {
        assert!(a.join(file.as_str().expect("a name")).is_file(), "{file}");
    }
    let report = fs::read_to_string(a.join("report.html")).expect("written");
    assert!(report.contains("<h2>Load curve</h2>") && report.contains("load over displacement"));

    let same = riss(&folder, &["compare", "case.toml", "a", "--path", "1e-9", "--load", "1e-9", "-q"]);
    assert_eq!(same.status.code(), Some(0), "{}", said(&same));
    let stronger = ["compare", "a", "case.toml", "--set", "material.cohesive.strength=3.1", "-q"];
    let output = riss(&folder, &stronger);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert!(said(&output).contains("peak load") && said(&output).contains("dissipated energy"), "{}", said(&output));
    let study = riss(&folder, &["converge", "case.toml", "-q"]);
    assert_eq!(study.status.code(), Some(2), "{}", said(&study));
    assert!(said(&study).contains("riss compare shows"), "{}", said(&study));
}

#[test]
fn a_run_goes_on_with_the_growth_of_an_earlier_one() {
    let folder = scratch("plane-loading-resume");
    for (out, steps) in [("whole", "growth.steps=4"), ("a", "growth.steps=2")] {
        let run = riss(&folder, &["run", "case.toml", "--set", steps, "--out", out, "-q"]);
        assert_eq!(run.status.code(), Some(0), "{}", said(&run));
    }
    let on = riss(&folder, &["run", "--resume", "a", "--set", "growth.steps=4", "-q"]);
    assert_eq!(on.status.code(), Some(0), "{}", said(&on));
    let [a, whole] = ["a", "whole"].map(|out| fs::read(folder.join(out).join("load_curve.csv")).expect("written"));
    assert!(a == whole, "another curve");
    let [a, whole] = ["a", "whole"].map(|out| results(&folder.join(out)));
    assert_eq!(a["steps"][0]["cracks"][0]["path"], whole["steps"][0]["cracks"][0]["path"]);
    let other = riss(&folder, &["run", "--resume", "a", "--set", "material.young=1", "-q"]);
    assert!(other.status.code() == Some(2) && said(&other).contains("in `material`"), "{}", said(&other));
    let step = riss(&folder, &["run", "--resume", "a", "--from-step", "1", "-q"]);
    assert!(step.status.code() == Some(2) && said(&step).contains("leave out --from-step"), "{}", said(&step));
}

#[test]
fn sweeps_have_load_curves_too() {
    let folder = scratch("plane-loading-sweep");
    let sweep =
        ["run", "case.toml", "--sweep", "material.thickness=50,100", "--set", "growth.steps=1", "--out", "s", "-q"];
    let run = riss(&folder, &sweep);
    assert_eq!(run.status.code(), Some(0), "{}", said(&run));
    let mut peaks: Vec<f64> = fs::read_dir(folder.join("s"))
        .expect("written")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.is_dir())
        .map(|path| results(&path)["loading"]["peak"]["load"].as_f64().expect("a load"))
        .collect();
    peaks.sort_by(f64::total_cmp);
    assert!(peaks.len() == 2 && (peaks[1] / peaks[0] - 2.0).abs() < 1e-9, "{peaks:?}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_says_how_to_go_on_and_does() {
    let folder = scratch("plane-loading-interrupted");
    let steps = ["--set", "growth.increment=1.5", "--set", "growth.steps=12", "-q"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_riss"));
    command.args(["run", "case.toml", "--out", "a"]).args(steps).current_dir(&folder);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("riss starts");
    let ways = folder.join("a/restart/ways.json");
    let start = Instant::now();
    while !ways.is_file() {
        assert!(start.elapsed() < Duration::from_secs(60), "it does not grow");
        std::thread::sleep(Duration::from_millis(5));
    }
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(killed.success());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(said(&output).contains("riss run --resume a goes on"), "{}", said(&output));
    assert!(!folder.join("a/results.json").exists());
    let on = riss(&folder, &["run", "--resume", "a", "-q"]);
    assert_eq!(on.status.code(), Some(0), "{}", said(&on));
    let whole = riss(&folder, &[&["run", "case.toml", "--out", "whole"], &steps[..]].concat());
    assert_eq!(whole.status.code(), Some(0), "{}", said(&whole));
    let [a, whole] = ["a", "whole"].map(|out| fs::read(folder.join(out).join("load_curve.csv")).expect("written"));
    assert!(a == whole, "another curve");
}
