//! `riss compare` and `riss converge` of solids as their users run them.

use serde_json::Value;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const PENNY: &str = r#"title = "Penny"
method = "collocation"
rigid_motion = "mean-is-zero"
units = "mm, N, MPa"
material = { young = "1 GPa", poisson = 0.3 }
parameters = { a = 1 }
geometry.box = { lower = [-5, -5, -5], upper = [5, 5, 5] }
crack = [{ name = "penny", disc = { center = [0, 0, 0], normal = [0, 0, 1], radius = "a" } }]
remote_stress.zz = 1
nodes = { spacing = 2, front_spacing = 0.12, growth = 0.25 }
fracture.points = 4
"#;

const BAR: &str = r#"title = "Bar"
method = "collocation"
rigid_motion = "mean-is-zero"
material = { young = 1000, poisson = 0.2 }
geometry.box = { lower = [0, 0, -2], upper = [4, 1, 2] }
crack = [{ name = "edge", polygon = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]] }]
remote_stress.zz = 1
nodes = { spacing = 0.5, front_spacing = 0.25 }
fracture.points = 3
[growth]
steps = 1
increment = 0.4
criterion.largest-principal-stress = { tensile_strength = 0.5 }
"#;

const COHESIVE: &str = r#"title = "Bar that breaks"
method = "collocation"
material = { young = 30000, poisson = 0.2, cohesive = { strength = 3, fracture_energy = 0.1 } }
geometry.box = { lower = [0, 0, 0], upper = [10, 10, 40] }
crack = [{ name = "plane", cohesive = true, polygon = [[0, 0, 18], [10, 0, 18], [10, 10, 18], [0, 10, 18]] }]
support = [{ on = "z-min", z = 0 }, { on = "z-max", z = 0.01 }, { on = "x-min", normal = 0 }, { on = "y-min", normal = 0 }]
nodes.spacing = 4
"#;

fn riss(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_riss")).args(arguments).current_dir(folder).output().expect("riss runs")
}

fn scratch(name: &str, case: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("made");
    std::fs::write(folder.join("case.toml"), case).expect("written");
    folder
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

#[test]
fn a_solid_agrees_with_its_own_results_and_not_with_more_load() {
    let folder = scratch("solid-compare", PENNY);
    let run = riss(&folder, &["run", "case.toml", "--out", "a", "-q"]);
    assert_eq!(run.status.code(), Some(0), "{}", said(&run));
    assert!(said(&run).contains("in mm, N, MPa; K in MPa√mm"), "{}", said(&run));
    let same = riss(&folder, &["compare", "case.toml", "a", "--K", "1e-9", "--path", "1e-9", "-q"]);
    assert_eq!(same.status.code(), Some(0), "{}", said(&same));
    assert!(said(&same).contains("K difference") && said(&same).contains("penny"), "{}", said(&same));
    let more = riss(&folder, &["compare", "a", "case.toml", "--set", "remote_stress.zz=1.1", "-q", "--json"]);
    assert_eq!(more.status.code(), Some(3), "{}", said(&more));
    let value: Value = serde_json::from_slice(&more.stdout).expect("JSON");
    let front = &value["steps"][0]["fronts"][0];
    assert_eq!(front["points"], 4);
    assert!((front["K_difference"].as_f64().expect("known") - 0.1).abs() < 1e-3, "{front}");
}

#[test]
fn grown_steps_are_compared() {
    let folder = scratch("solid-compare-growth", BAR);
    assert_eq!(riss(&folder, &["run", "case.toml", "--out", "a", "-q"]).status.code(), Some(0));
    let same = riss(&folder, &["compare", "case.toml", "a", "-q", "--json"]);
    assert_eq!(same.status.code(), Some(0), "{}", said(&same));
    let value: Value = serde_json::from_slice(&same.stdout).expect("JSON");
    assert_eq!(value["steps"].as_array().expect("steps").len(), 2);
    let shorter = riss(&folder, &["compare", "a", "case.toml", "--set", "growth.increment=0.3", "-q"]);
    assert_eq!(shorter.status.code(), Some(3), "{}", said(&shorter));
    assert!(said(&shorter).contains("crack area A") && said(&shorter).contains("front distance"), "{}", said(&shorter));
}

#[test]
fn load_curves_are_compared_and_studied() {
    let folder = scratch("solid-compare-loading", COHESIVE);
    let stronger = ["compare", "case.toml", "case.toml", "--set", "material.cohesive.strength=3.3", "-q", "--json"];
    let output = riss(&folder, &stronger);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    // The strength over the cross section, a tenth more of it.
    let difference = value["loading"]["peak_load_difference"].as_f64().expect("known");
    assert!((difference - 0.1).abs() < 1e-4, "{difference}");
    let study = riss(&folder, &["converge", "case.toml", "--out", "study", "-q"]);
    assert_eq!(study.status.code(), Some(0), "{}", said(&study));
    let table = std::fs::read_to_string(folder.join("study/convergence.csv")).expect("written");
    assert_eq!(table.lines().next(), Some("factor,nodes,peak_load,displacement_at_peak,dissipated_energy"));
    let limit: Vec<&str> = table.lines().last().expect("a row").split(',').collect();
    assert!((limit[2].parse::<f64>().expect("a number") / 300.0 - 1.0).abs() < 1e-3, "{table}");
}

#[test]
fn factors_along_a_front_go_to_those_of_the_closed_form() {
    let finer = PENNY.replace("front_spacing = 0.12, growth = 0.25", "front_spacing = 0.1, growth = 0.2");
    let folder = scratch("solid-converge", &finer);
    let output = riss(&folder, &["converge", "case.toml", "--factors", "1.2,1.1,1", "--out", "study", "-q"]);
    let text = said(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(text.contains("crack penny, front 0 of length 6.28") && text.contains("order"), "{text}");
    assert!(text.contains(": K_I\n"), "{text}");
    let table = std::fs::read_to_string(folder.join("study/convergence.csv")).expect("written");
    let rows: Vec<Vec<&str>> = table.lines().skip(1).map(|l| l.split(',').collect()).collect();
    assert_eq!(rows.len(), 4 * 4, "{table}");
    // 2 σ √(a/π) in an infinite body [Sneddon1946]; the box is five times as wide and adds less than half a percent.
    let exact = 2.0 / PI.sqrt();
    for limit in rows.iter().filter(|r| r[6] == "0") {
        let [k1, bar] = [8, 11].map(|column| limit[column].parse::<f64>().expect("a number"));
        assert!((k1 - exact).abs() < bar + 0.005 * exact && bar < 0.1 * exact, "{k1} +- {bar} against {exact}");
    }
    let picture = std::fs::read_to_string(folder.join("study/convergence.svg")).expect("written");
    assert!(picture.starts_with("<svg") && picture.contains("penny, front 0"));
}

#[test]
fn bodies_of_unlike_kind_are_refused() {
    let folder = scratch("solid-compare-unlike", PENNY);
    let plane = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/edge-crack-shear/case.toml");
    std::fs::create_dir_all(folder.join("solid")).expect("made");
    assert_eq!(riss(&folder, &["run", "case.toml", "--out", "solid", "-q"]).status.code(), Some(0));
    let output = riss(&folder, &["compare", "solid", &plane.to_string_lossy(), "-q"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("solid a solid: their cracks cannot be compared"), "{}", said(&output));
    std::fs::write(folder.join("solid/results.json"), "{\"method\": \"collocation\"}").expect("written");
    let output = riss(&folder, &["compare", "solid", "solid"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("missing field"), "{}", said(&output));
    let output = riss(&folder, &["converge", "case.toml", "--factors", "1,2"]);
    assert!(said(&output).contains("at least three"), "{}", said(&output));
}

#[test]
fn units_of_solids_are_checked() {
    let folder = scratch("solid-units", &PENNY.replace("1 GPa", "1 mm"));
    let output = riss(&folder, &["check", "case.toml"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("`mm` is the unit of a length"), "{}", said(&output));
    let folder = scratch("solid-units-strange", &PENNY.replace("1 GPa", "200 MPa").replace("a = 1", "a = 1, b = 2"));
    let output = riss(&folder, &["check", "case.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(said(&output).contains("200 MPa are 0.2 GPa"), "{}", said(&output));
    assert!(said(&output).contains("nothing uses this parameter"), "{}", said(&output));
}

/// The triangles of an STL file.
fn stl_area(text: &str) -> f64 {
    let numbers =
        |line: &str| line.split_whitespace().skip(1).map(|v| v.parse().expect("a number")).collect::<Vec<f64>>();
    let corners: Vec<Vec<f64>> = text.lines().filter(|l| l.starts_with("vertex")).map(numbers).collect();
    let area = |t: &[Vec<f64>]| {
        let [u, v] = [1, 2].map(|k| [0, 1, 2].map(|i| t[k][i] - t[0][i]));
        let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        0.5 * n.iter().map(|c| c * c).sum::<f64>().sqrt()
    };
    corners.chunks(3).map(area).sum()
}

#[test]
fn cracks_of_solids_go_to_other_programs() {
    let folder = scratch("solid-export", BAR);
    assert_eq!(riss(&folder, &["run", "case.toml", "--out", "a", "-q"]).status.code(), Some(0));
    let read = |name: &str| std::fs::read_to_string(folder.join("a").join(name)).expect("written");
    let results: Value = serde_json::from_str(&read("results.json")).expect("JSON");
    for step in 0..2 {
        let output = riss(&folder, &["export", "a", "--format", "stl", "--step", &step.to_string()]);
        assert_eq!(said(&output), "wrote a/cracks.stl\n");
        let area = results["steps"][step]["cracks"][0]["area"].as_f64().expect("known");
        let found = stl_area(&read("cracks.stl"));
        assert!((found / area - 1.0).abs() < 1e-9, "{found} is not {area}");
    }
    riss(&folder, &["export", "a", "--format", "csv"]);
    let table = read("cracks.csv");
    let row: Vec<&str> = table.lines().nth(1).expect("a row").split(',').collect();
    let point = &results["fronts"][0]["points"][0];
    assert_eq!((row[0], row[6].parse().ok()), ("edge", point["K_I"].as_f64()), "{table}");
    riss(&folder, &["export", "a", "--format", "vtp"]);
    assert!(read("cracks.vtp").contains("NumberOfPolys"));
    for (arguments, reason) in [
        (vec!["--format", "stl", "--step", "7"], "step 7 is not in a"),
        (vec!["--format", "afgrow", "--stress", "1"], "but a is a solid"),
    ] {
        let output = riss(&folder, &[vec!["export", "a"], arguments].concat());
        assert_eq!(output.status.code(), Some(2));
        assert!(said(&output).contains(reason), "{}", said(&output));
    }
}
