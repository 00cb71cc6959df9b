//! The same case gives the same bits, for any number of threads and from run to run, by every method.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// A crack that grows along a curve past a hole.
const GALERKIN: &str = r#"rigid_motion = "mean-is-zero"
material = { young = 1e3, poisson = 0.3, plane = "strain" }
geometry.rectangle = { lower = [0, 0], upper = [4, 6] }
hole = [{ circle = { center = [2.4, 3.9], radius = 0.4 } }]
nodes.layout.graded = { spacing = 0.5, tip_spacing = 0.05 }
remote_stress = { yy = 1 }
crack = [{ path = [[0, 3], [1, 3.1]] }]
growth = { increment = 0.2, steps = 3 }
"#;

/// A solid with a crack through its side, solved iteratively.
const COLLOCATION: &str = r#"method = "collocation"
rigid_motion = "mean-is-zero"
material = { young = 1000, poisson = 0.3 }
geometry.box = { lower = [0, 0, 0], upper = [4, 2, 4] }
remote_stress.zz = 1
nodes = { spacing = 0.5, front_spacing = 0.25 }
fracture.points = 3
crack = [{ polygon = [[-1, -1, 2], [1.5, -1, 2], [1.5, 3, 2], [-1, 3, 2]] }]
"#;

/// `results.json` without the times and the memory that the run took.
fn results(folder: &Path, out: &str, threads: &str, settings: &[&str]) -> Value {
    let mut riss = Command::new(env!("CARGO_BIN_EXE_riss"));
    riss.args(["run", "case.toml", "-q", "--out", out, "--threads", threads]).current_dir(folder);
    for setting in settings {
        riss.args(["--set", setting]);
    }
    let run = riss.output().expect("riss runs");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let text = std::fs::read_to_string(folder.join(out).join("results.json")).expect("results are written");
    let mut value: Value = serde_json::from_str(&text).expect("JSON");
    forget_times(&mut value);
    value
}

fn forget_times(value: &mut Value) {
    match value {
        Value::Object(map) => {
            ["wall_time_s", "stage_time_s", "peak_memory_bytes"].iter().for_each(|key| drop(map.remove(*key)));
            map.values_mut().for_each(forget_times);
        }
        Value::Array(list) => list.iter_mut().for_each(forget_times),
        _ => {}
    }
}

/// Runs with one, two and eight threads, and once more, and compares the texts, which tell every bit of every number.
fn check_bits(name: &str, case: &str, settings: &[&str]) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("determinism").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("made");
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let first = results(&folder, "one", "1", settings).to_string();
    assert!(first.contains("\"K_I\":") && !first.contains("\"K_I\":null"), "{first}");
    for (out, threads) in [("two", "2"), ("eight", "8"), ("again", "8")] {
        let other = results(&folder, out, threads, settings).to_string();
        assert!(other == first, "{name} with {threads} threads differs:\n{first}\n{other}");
    }
}

#[test]
fn galerkin_growth_has_the_same_bits() {
    check_bits("galerkin", GALERKIN, &[]);
}

#[test]
fn cracking_particles_have_the_same_bits() {
    let coarse = ["method=cracking-particles", "nodes.layout.graded.tip_spacing=0.1", "growth.steps=2"];
    check_bits("particles", GALERKIN, &coarse);
}

#[test]
fn collocation_has_the_same_bits() {
    check_bits("collocation", COLLOCATION, &["collocation.solver=iterative"]);
}
