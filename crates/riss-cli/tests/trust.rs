//! What a run may read, how much memory it may ask for, and what it tells in its log.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const CASE: &str = r#"rigid_motion = "mean-is-zero"
remote_stress = { yy = 400 }

[material]
young = 1e3
poisson = 0.3
plane = "strain"
yield_stress = 500

[geometry.rectangle]
lower = [0, 0]
upper = [4, 6]

[nodes.layout.graded]
spacing = 0.5
tip_spacing = 0.1

[[crack]]
path = [[0, 3], [1, 3]]

[growth]
increment = 0.1
steps = 1
"#;

const SOLID: &str = r#"method = "collocation"
rigid_motion = "mean-is-zero"
material = { young = 1000, poisson = 0.3 }
geometry.box = { lower = [0, 0, 0], upper = [1, 1, 1] }
remote_stress.zz = 1
nodes.spacing = 0.25
"#;

fn scratch(name: &str, case: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("trust").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("made");
    std::fs::write(folder.join("case.toml"), case).expect("written");
    folder
}

fn riss(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_riss")).args(arguments).current_dir(folder).output().expect("riss runs")
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn files_outside_the_folder_of_the_case_are_read_only_where_that_is_allowed() {
    let place = scratch("files", "");
    let folder = place.join("case");
    std::fs::create_dir_all(&folder).expect("made");
    let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/msh/square-22.msh");
    std::fs::copy(&mesh, place.join("square.msh")).expect("copied");
    let case = "rigid_motion = 'mean-is-zero'\nmaterial = { young = 1, poisson = 0.3, plane = 'strain' }\n\
                remote_stress.yy = 1\ngeometry.gmsh.file = '../square.msh'\n";
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let refused = riss(&folder, &["check", "case.toml"]);
    assert_eq!(refused.status.code(), Some(2));
    let words = message(&refused);
    assert!(words.contains("case.toml:4:22: error: geometry.gmsh.file = '../square.msh'"), "{words}");
    assert!(words.contains("outside the folder of the case") && words.contains("--set files=anywhere"), "{words}");
    let allowed = riss(&folder, &["check", "case.toml", "--set", "files=anywhere"]);
    assert_eq!(allowed.status.code(), Some(0), "{}", message(&allowed));
    std::fs::write(folder.join("case.toml"), format!("files = 'anywhere'\n{case}")).expect("written");
    assert_eq!(riss(&folder, &["check", "case.toml"]).status.code(), Some(0));
    // The command line has the last word.
    assert_eq!(riss(&folder, &["check", "case.toml", "--set", "files=beside"]).status.code(), Some(2));
    std::fs::rename(place.join("square.msh"), folder.join("square.msh")).expect("moved");
    std::fs::write(folder.join("case.toml"), case.replace("../", "")).expect("written");
    assert_eq!(riss(&place, &["check", "case/case.toml"]).status.code(), Some(0));
}

#[test]
fn runs_that_need_more_memory_than_there_is_are_refused_with_the_number() {
    let folder = scratch("memory", CASE);
    // 24 / 0.0035² = 2 million nodes, 32 kB each.
    let many = ["run", "case.toml", "--set", "nodes.layout.graded={spacing=3.5e-3}", "--memory-limit", "20GB"];
    let output = riss(&folder, &many);
    let words = message(&output);
    assert_eq!(output.status.code(), Some(2), "{words}");
    assert!(
        words.contains("about 2.0e6 nodes, which need about 62.7 GB of memory, and 20.0 GB are allowed"),
        "{words}"
    );
    assert!(!folder.join("case.riss-out").exists() && !folder.join("memory.riss-out").exists());
    // 0.1 mm everywhere are 2400 nodes, 32 kB each and 30 MB.
    let coarse =
        ["run", "case.toml", "--set", "nodes.layout.graded={spacing=0.1,tip_spacing=0.1}", "-q", "--memory-limit"];
    let output = riss(&folder, &[&coarse[..], &["100MB"]].concat());
    let words = message(&output);
    assert_eq!(output.status.code(), Some(2), "{words}");
    assert!(
        words.contains("about 2400 nodes") && words.contains("107 MB") && words.contains("100 MB are allowed"),
        "{words}"
    );
    for limit in ["300MB", "none"] {
        let output = riss(&folder, &[&coarse[..], &[limit]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", message(&output));
    }
    assert_eq!(riss(&folder, &[&coarse[..], &["much"]].concat()).status.code(), Some(2));
    let sweep = [
        "run",
        "case.toml",
        "--memory-limit",
        "20GB",
        "--sweep",
        "nodes.layout.graded.spacing=0.5,3.5e-3",
        "--set",
        "nodes.layout.graded.tip_spacing=3.5e-3",
    ];
    let output = riss(&folder, &sweep);
    assert_eq!(output.status.code(), Some(2), "{}", message(&output));
    let solid = scratch("memory-solid", SOLID);
    let output = riss(&solid, &["run", "case.toml", "--set", "nodes.spacing=0.01", "--memory-limit", "1GB"]);
    let words = message(&output);
    assert_eq!(output.status.code(), Some(2), "{words}");
    assert!(words.contains("GB of memory, and 1.0 GB are allowed"), "{words}");
}

#[test]
fn the_log_tells_stages_steps_and_warnings_which_are_in_results_too() {
    let folder = scratch("log", CASE);
    let output = riss(&folder, &["run", "case.toml", "--out", "out", "-q", "--log", "debug", "--log-file", "run.log"]);
    assert_eq!(output.status.code(), Some(0), "{}", message(&output));
    let log = std::fs::read_to_string(folder.join("run.log")).expect("a log");
    for words in [
        "INFO riss ",
        "INFO case case.toml (",
        "DEBUG solve begins",
        "INFO solve took ",
        "INFO step 0: ",
        " unknowns, ",
        "INFO growth ended: ",
        "INFO exit code 0",
    ] {
        assert!(log.contains(words), "{words}\n{log}");
    }
    let results = std::fs::read_to_string(folder.join("out/results.json")).expect("results");
    let report = std::fs::read_to_string(folder.join("out/report.html")).expect("a report");
    let results: Value = serde_json::from_str(&results).expect("JSON");
    let warnings: Vec<&str> =
        results["warnings"].as_array().expect("a list").iter().filter_map(Value::as_str).collect();
    assert!(warnings.iter().any(|w| w.contains("linear elastic fracture mechanics is doubtful")), "{warnings:?}");
    for warning in warnings {
        assert_eq!(log.matches(&format!("WARN {warning}")).count(), 1, "{warning}\n{log}");
        assert!(report.contains(&warning[..40]), "{warning}");
    }
    // Only what is asked for, on stderr where no file is.
    let output = riss(&folder, &["run", "case.toml", "--out", "out", "--log", "warn"]);
    let words = message(&output);
    assert!(words.contains("WARN ") && !words.contains("INFO ") && !words.contains("DEBUG "), "{words}");
    let output = riss(&folder, &["run", "case.toml", "--out", "out", "--log-file", "no/such/folder.log"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(message(&output).contains("cannot write the log to no/such/folder.log"), "{}", message(&output));
}

#[test]
fn the_log_says_why_there_is_no_result() {
    let folder = scratch("log-error", CASE);
    let far = "nodes.layout.graded={spacing=2,tip_spacing=2}";
    let output =
        riss(&folder, &["run", "case.toml", "-q", "--memory-limit", "1MB", "--set", far, "--log-file", "run.log"]);
    assert_eq!(output.status.code(), Some(2), "{}", message(&output));
    let log = std::fs::read_to_string(folder.join("run.log")).expect("a log");
    assert!(log.contains("ERROR the case asks for about") && log.contains("INFO exit code 2"), "{log}");
}

#[test]
fn the_log_of_a_solid_tells_its_iterations() {
    let folder = scratch("log-solid", SOLID);
    let output = riss(&folder, &["run", "case.toml", "-q", "--log-file", "run.log"]);
    assert_eq!(output.status.code(), Some(0), "{}", message(&output));
    let log = std::fs::read_to_string(folder.join("run.log")).expect("a log");
    assert!(log.contains("products, residual ") && log.contains("INFO assembly took "), "{log}");
}
