//! `riss run` of several cases and sweeps, as their users see them.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A strip of width 4 with an edge crack in tension.
const CASE: &str = r#"title = "Strip"
rigid_motion = "mean-is-zero"
material = { young = 1e3, poisson = 0.3, plane = "strain" }
geometry.rectangle = { lower = [0, -6], upper = [4, 6] }
remote_stress.yy = 10

[[crack]]
name = "left"
path = [[0, 0], [1, 0]]

[output]
fields = false
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
    assert!(!folder.join("strip.riss-sweep").exists(), "nothing was run");
}

/// A fresh folder with the case.
fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("made");
    std::fs::write(folder.join("strip.toml"), CASE).expect("written");
    folder
}

fn read(path: PathBuf) -> String {
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Columns of a CSV file without quotes, by name.
fn column(table: &str, name: &str) -> Vec<String> {
    let mut rows = table.lines().map(|l| l.split(',').collect::<Vec<_>>());
    let head = rows.next().expect("a head");
    let index = head.iter().position(|h| *h == name).unwrap_or_else(|| panic!("no {name} in {head:?}"));
    rows.map(|r| r[index].to_string()).collect()
}

#[test]
fn a_sweep_follows_the_handbook_and_equals_single_runs() {
    let folder = scratch("sweep");
    let arguments = ["run", "strip.toml", "--sweep", "crack.left.path[1][0]=1..2:0.5", "--quiet"];
    let text = stdout(&folder, &arguments);
    let table = read(folder.join("strip.riss-sweep/table.csv"));
    assert_eq!(column(&table, "crack.left.path[1][0]"), ["1", "1.5", "2"]);
    assert_eq!(column(&table, "status"), ["done"; 3]);
    let k1: Vec<f64> = column(&table, "left.end.K_I").iter().map(|v| v.parse().expect("a number")).collect();
    for (a, k1) in [1.0, 1.5, 2.0].iter().zip(&k1) {
        // Edge crack in a strip of width 4 [Tada, section 2.11]: within 0.5 % for any a/W.
        let z: f64 = std::f64::consts::PI * a / 8.0;
        let shape = 0.752 + 2.02 * a / 4.0 + 0.37 * (1.0 - z.sin()).powi(3);
        let handbook = 10.0 * (std::f64::consts::PI * a).sqrt() * (z.tan() / z).sqrt() * shape / z.cos();
        assert!((k1 / handbook - 1.0).abs() < 0.015, "{a}: {k1}, handbook {handbook}");
    }
    assert_eq!(text.lines().filter(|l| l.contains("done")).count(), 3, "{text}");
    // The same bits as a run on its own.
    let folders = column(&table, "folder");
    assert_eq!(folders[1], "strip.riss-sweep/crack.left.path_1__0_=1.5");
    stdout(&folder, &["run", "strip.toml", "--set", "crack[0].path[1][0]=1.5", "--out", "single", "--quiet"]);
    let steps = |dir: &str| {
        let results: Value = serde_json::from_str(&read(folder.join(dir).join("results.json"))).expect("JSON");
        results["steps"][0]["cracks"].clone()
    };
    assert_eq!(steps(&folders[1]), steps("single"));
}

#[test]
fn sweeps_combine_and_cases_run_side_by_side() {
    let folder = scratch("combine");
    let second = CASE.replace("name = \"left\"", "name = \"other\"").replace("yy = 10", "yy = 20");
    std::fs::write(folder.join("second.toml"), second).expect("written");
    let arguments = ["run", "strip.toml", "second.toml", "--sweep", "remote_stress.yy=5,10", "--json", "--quiet"];
    let rows: Value = serde_json::from_str(&stdout(&folder, &arguments)).expect("JSON");
    let rows = rows.as_array().expect("a list");
    let of = |k: usize| (rows[k]["case"].as_str().expect("a name"), rows[k]["set"][0][1].as_str().expect("a value"));
    assert_eq!([0, 1, 2, 3].map(of), [("strip", "5"), ("strip", "10"), ("second", "5"), ("second", "10")]);
    let k1 = |k: usize| rows[k]["tips"][0]["K_I"].as_f64().expect("a number");
    // Linear in the load.
    assert!((k1(1) / k1(0) - 2.0).abs() < 1e-9);
    assert!(folder.join("riss-out/second/remote_stress.yy=5/results.json").is_file());
    let table = read(folder.join("riss-out/table.csv"));
    assert_eq!(column(&table, "case"), ["strip", "strip", "second", "second"]);
    assert_eq!(column(&table, "left.end.K_I")[2], "");
}

#[test]
fn one_failed_run_does_not_stop_the_others() {
    let folder = scratch("failing");
    // Held along y only: the body slides along x.
    let arguments = [
        "run",
        "strip.toml",
        "--set",
        "rigid_motion=supported",
        "--sweep",
        "support=[{on='bottom',y=0}],[{on='bottom',y=0,x=0}]",
    ];
    let output = riss(&folder, &arguments);
    assert_eq!(output.status.code(), Some(1));
    let table = read(folder.join("strip.riss-sweep/table.csv"));
    assert!(table.contains(",failed,") && table.contains(",done,"), "{table}");
    let progress = String::from_utf8_lossy(&output.stderr);
    assert!(progress.contains("1 of 2: ") && progress.contains("2 of 2: "), "{progress}");
}

#[test]
fn mistakes_are_found_before_anything_runs() {
    let folder = scratch("refused");
    let sweep = |text: &str, reason: &str| check_refused(&folder, &["run", "strip.toml", "--sweep", text], reason);
    sweep("crack.left.path[1][0]=1..9", "a range ends with its step");
    sweep("crack.left.path[1][0]=1..9:-1", "do not lead from 1 to 9");
    sweep("crack.right.path[1][0]=1,2", "`crack` is a list of 1");
    sweep("crack.left.path[1][0]=1,9", "crack");
    sweep("material.yuong=1,2", "did you mean `young`?");
    check_refused(&folder, &["run", "strip.toml", "strip.toml", "--open"], "--open");
    check_refused(&folder, &["run", "strip.toml", "missing.toml"], "there is no such file");
}

const PENNY: &str = "method = 'collocation'
rigid_motion = 'mean-is-zero'
material = { young = 1000, poisson = 0.3 }
geometry.box = { lower = [-6, -6, -6], upper = [6, 6, 6] }
crack = [{ name = 'penny', disc = { center = [0, 0, 0], normal = [0, 0, 1], radius = 1 } }]
remote_stress.zz = 1
nodes = { spacing = 1.5, front_spacing = 0.12, growth = 0.3 }
";

#[test]
fn a_sweep_of_a_solid_has_its_fronts_in_the_table() {
    let folder = scratch("solid");
    std::fs::write(folder.join("penny.toml"), PENNY).expect("a file");
    let text = stdout(&folder, &["run", "penny.toml", "--quiet", "--sweep", "crack.penny.disc.radius=1,1.2"]);
    assert!(text.contains("K_I min") && text.contains("K_I max"), "{text}");
    let table = read(folder.join("penny.riss-sweep/table.csv"));
    let rows: Vec<Vec<&str>> = table.lines().map(|l| l.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|h| *h == name).expect("a column");
    for (row, radius) in rows[1..].iter().zip([1.0_f64, 1.2]) {
        // Sneddon 1946: 2 σ √(a/π) in an infinite body; the nodes are coarse.
        let exact = 2.0 * (radius / std::f64::consts::PI).sqrt();
        for name in ["penny.K_I_min", "penny.K_I_max"] {
            let k: f64 = row[column(name)].parse().expect("a number");
            assert!((k / exact - 1.0).abs() < 0.04, "{table}");
        }
    }
    assert_eq!(rows.len(), 3);
}
