//! `cargo xtask verify`: every case against its reference values, as a table; and two hundred random plates.

use crate::{Outcome, build_riss, cargo, case_folders, root, run as run_command, target_dir};
use riss_expected::{CaseRun, Comparison, Expected, run_case};
use std::fmt::Write;
use std::path::Path;

/// What the random plates are called among the cases.
const RANDOM_PLATES: &str = "random-plates";
/// How many of them are grown to the end.
const N_RANDOM_PLATES: &str = "200";

/// Runs all cases and the random plates, or those whose name holds one of `names`; prints the table and writes it to
/// `target/verify/verification.md`.
pub fn run(names: &[String]) -> Outcome {
    let is_asked = |case: &str| names.is_empty() || names.iter().any(|n| case.contains(n.as_str()));
    let riss = build_riss()?;
    let folder_of_runs = target_dir().join("verify");
    let mut table = String::from(
        "| case | quantity | reference | computed | error | tolerance | nodes | time | passed |\n\
         | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | --- |\n",
    );
    let mut failures = vec![];
    let mut n_cases = 0;
    print!("{table}");
    for folder in case_folders(&root()) {
        let case = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if !is_asked(&case) {
            continue;
        }
        n_cases += 1;
        let run = Expected::read(&folder).and_then(|e| run_case(&riss, &folder, &e, &folder_of_runs.join(&case)));
        let rows = match run {
            Ok(run) => {
                failures.extend(run.comparisons.iter().filter(|c| !c.passed()).map(|c| failure(&case, c)));
                rows(&case, &run)
            }
            Err(reason) => {
                failures.push(format!("{case}: {reason}"));
                format!("| {case} | run | | | | | | | no |\n")
            }
        };
        print!("{rows}");
        table += &rows;
    }
    let path = folder_of_runs.join("verification.md");
    write_table(&path, &table)?;
    println!("\nwrote {}", path.display());
    if is_asked(RANDOM_PLATES) {
        n_cases += 1;
        failures.extend(random_plates().err());
    }
    match (n_cases, failures.len()) {
        (0, _) => Err("no case was run".into()),
        (_, 0) => Ok(()),
        (_, n) => Err(format!("{n} failures\n{}", failures.join("\n"))),
    }
}

/// Grows random cracks in random plates until nothing grows; the test says what went wrong.
fn random_plates() -> Outcome {
    println!("growing {N_RANDOM_PLATES} random plates to the end");
    let test = ["test", "--release", "--package", "riss", "--test", "growth", "random_plates", "--", "--nocapture"];
    run_command(cargo(&test).env("RISS_PLATES", N_RANDOM_PLATES)).map_err(|reason| format!("{RANDOM_PLATES}: {reason}"))
}

/// What does not fit, in one line.
pub fn failure(case: &str, comparison: &Comparison) -> String {
    let [quantity, reference, computed, error, tolerance] = comparison.cells();
    if error.is_empty() {
        return format!("{case}: {quantity} is {computed}, reference {reference}");
    }
    format!("{case}: {quantity} is {computed}, reference {reference}, error {error}, allowed {tolerance}")
}

fn rows(case: &str, run: &CaseRun) -> String {
    let nodes = run.results["steps"][0]["nodes"]
        .as_u64()
        .or_else(|| run.results["nodes"].as_u64())
        .map_or(String::new(), |n| n.to_string());
    let mut rows = String::new();
    for comparison in &run.comparisons {
        let passed = if comparison.passed() { "yes" } else { "no" };
        let cells = comparison.cells().join(" | ");
        let time = run.time.as_secs_f64();
        writeln!(rows, "| {case} | {cells} | {nodes} | {time:.2} s | {passed} |").expect("a string takes all");
    }
    rows
}

fn write_table(path: &Path, table: &str) -> Outcome {
    let folder = path.parent().expect("the table has a folder");
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(path, table))
        .map_err(|e| format!("{}: {e}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_row_shows_everything() {
        let expected = r#"{"source": "s", "strain_energy": {"value": 2.0, "tolerance": 0.005}}"#;
        let results = json!({ "strain_energy": 2.02, "nodes": 57 });
        let comparisons = Expected::parse(expected, &|name| Err(name.into())).unwrap().compare(&results);
        assert_eq!(
            failure("bar", &comparisons[0]),
            "bar: strain energy is 2.0200, reference 2.0000, error +1.00 %, allowed 0.50 %"
        );
        let run = CaseRun { results, comparisons, time: std::time::Duration::from_millis(1500) };
        assert_eq!(
            rows("bar", &run),
            "| bar | strain energy | 2.0000 | 2.0200 | +1.00 % | 0.50 % | 57 | 1.50 s | no |\n"
        );
    }
}
