//! `cargo xtask verify`: every case against its reference values, as a table; and two hundred random plates.

use crate::{Outcome, build_riss, cargo, case_folders, root, run as run_command, target_dir};
use riss_expected::{CaseRun, Comparison, Expected, run_case};
use std::collections::BTreeMap;
use std::fmt::Write;

/// What the random plates are called among the cases.
const RANDOM_PLATES: &str = "random-plates";
/// How many of them are grown to the end.
const N_RANDOM_PLATES: &str = "200";

/// The page of the book with the last run of every case, from the root of the workspace.
const PAGE: &str = "docs/src/reference/verification-manual.md";
const PAGE_HEAD: &str = "<!-- Written by `cargo xtask verify`, case by case as they were run last. -->

# Verification manual

Every documented case against its references, as `cargo xtask verify` ran it last: on two cores that other work shared, so that the
times say little. Drawing, parameters and the source of each reference stand in the [gallery](gallery.md). `cargo xtask verify NAME` runs the
case NAME, or those whose name holds it, and brings their rows up to date; `riss selftest` runs a part of them from the installed program.

";
const TABLE_HEAD: &str = "| case | quantity | reference | computed | error | tolerance | nodes | time | passed |\n\
    | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | --- |\n";

/// Runs all cases and the random plates, or those that have one of `names`, or hold it if no case has it; prints the table, and brings the
/// page of the book up to date.
pub fn run(names: &[String]) -> Outcome {
    let is_case = |name: &str| root().join("cases").join(name).is_dir();
    let fits = |case: &str, name: &str| if is_case(name) { case == name } else { case.contains(name) };
    let is_asked = |case: &str| names.is_empty() || names.iter().any(|n| fits(case, n));
    let riss = build_riss()?;
    let folder_of_runs = target_dir().join("verify");
    let page = root().join(PAGE);
    let mut known = rows_by_case(&std::fs::read_to_string(&page).unwrap_or_default());
    known.retain(|case, _| root().join("cases").join(case).is_dir());
    let mut failures = vec![];
    let mut n_cases = 0;
    print!("{TABLE_HEAD}");
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
                format!("| [{case}](gallery.md#{case}) | run | | | | | | | no |\n")
            }
        };
        print!("{rows}");
        known.insert(case, rows);
        let table: String = known.values().map(String::as_str).collect();
        std::fs::write(&page, format!("{PAGE_HEAD}{TABLE_HEAD}{table}")).map_err(|e| format!("{PAGE}: {e}"))?;
    }
    println!("\nwrote {PAGE}");
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
        writeln!(rows, "| [{case}](gallery.md#{case}) | {cells} | {nodes} | {time:.2} s | {passed} |")
            .expect("a string takes all");
    }
    rows
}

/// The rows of a page, by case.
fn rows_by_case(page: &str) -> BTreeMap<String, String> {
    let mut rows: BTreeMap<String, String> = BTreeMap::new();
    for line in page.lines() {
        if let Some((case, _)) = line.strip_prefix("| [").and_then(|l| l.split_once(']')) {
            *rows.entry(case.into()).or_default() += &format!("{line}\n");
        }
    }
    rows
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
            "| [bar](gallery.md#bar) | strain energy | 2.0000 | 2.0200 | +1.00 % | 0.50 % | 57 | 1.50 s | no |\n"
        );
        let page = format!("{PAGE_HEAD}{TABLE_HEAD}{0}{0}| [beam](gallery.md#beam) | x |\n", rows("bar", &run));
        let known = rows_by_case(&page);
        assert_eq!(known.keys().collect::<Vec<_>>(), ["bar", "beam"]);
        assert_eq!(known["bar"], rows("bar", &run).repeat(2));
    }
}
