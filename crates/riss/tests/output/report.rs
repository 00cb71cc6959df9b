//! `report.html`: what it holds, that it needs nothing else, and that nothing in it is taken for markup.
//!
//! What a browser makes of it is tested in `tests/browser`.

use crate::sample;
use riss::analysis::StaticResult;
use riss::model::UnitNames;
use riss::output::{OutputOptions, REPORT_FILE, RunInfo, RunSource, RunWriter, write_report, write_results};
use serde_json::Value;
use std::path::Path;

/// The JSON of a block of data.
fn block(page: &str, id: &str) -> Value {
    let start = format!("<script type=\"application/json\" id=\"{id}\">");
    let (_, rest) = page.split_once(&start).unwrap_or_else(|| panic!("no {id}"));
    serde_json::from_str(rest.split("</script>").next().unwrap()).unwrap()
}

fn written(info: &RunInfo, result: &StaticResult, options: &OutputOptions) -> (tempfile::TempDir, String) {
    let dir = tempfile::tempdir().unwrap();
    write_results(dir.path(), info, result, options).unwrap();
    let page = read(dir.path());
    (dir, page)
}

fn read(dir: &Path) -> String {
    std::fs::read_to_string(dir.join(REPORT_FILE)).unwrap()
}

#[test]
fn the_report_holds_the_results_and_can_be_made_again() {
    let (dir, page) = written(&sample::info(), &sample::result(4), &OutputOptions::default());
    let results: Value = serde_json::from_slice(&std::fs::read(dir.path().join("results.json")).unwrap()).unwrap();
    assert_eq!(block(&page, "results"), results);
    let files = results["files"].as_array().unwrap();
    assert!(files.contains(&"report.html".into()) && files.contains(&"report/fine_0000.json".into()), "{files:?}");
    for file in files {
        assert!(dir.path().join(file.as_str().unwrap()).is_file(), "{file}");
    }
    std::fs::remove_file(dir.path().join(REPORT_FILE)).unwrap();
    write_report(dir.path()).unwrap();
    assert_eq!(read(dir.path()), page);
}

#[test]
fn fields_are_there_with_the_ends_of_their_values() {
    let result = sample::result(4);
    let (_dir, page) = written(&sample::info(), &result, &OutputOptions::default());
    assert_eq!(block(&page, "run")["stepsWithFields"], serde_json::json!([0]));
    let fields = block(&page, "fields-0");
    assert_eq!(fields["n_vertices"], result.fields.positions.len());
    assert_eq!(fields["n_triangles"], result.fields.triangles.len());
    let greatest = result.fields.von_mises.iter().copied().fold(0.0, f64::max);
    assert_eq!(fields["ranges"]["von_mises"][3], greatest);
    // Plane strain: Poisson's ratio of the sample.
    assert!((fields["out_of_plane"].as_f64().unwrap() - sample::MATERIAL.poisson).abs() < 1e-12);
}

#[test]
fn a_run_without_fields_has_a_report_too() {
    let (dir, page) =
        written(&sample::info(), &sample::result(2), &OutputOptions { fields: false, ..OutputOptions::default() });
    assert_eq!(block(&page, "run")["stepsWithFields"], serde_json::json!([]));
    assert!(!page.contains("id=\"fields-0\""));
    assert!(!dir.path().join("report").exists());
    let mut unsolved = sample::result(2);
    unsolved.fields = Default::default();
    let (_dir, page) = written(&sample::info(), &unsolved, &OutputOptions::default());
    assert_eq!(block(&page, "run")["stepsWithFields"], serde_json::json!([]));
}

#[test]
fn the_report_is_one_file() {
    let (_dir, page) = written(&sample::info(), &sample::result(2), &OutputOptions::default());
    // The page forbids the browser all loads; nothing tries any, either.
    assert!(page.contains("content=\"default-src 'none'; "));
    for load in
        ["src=\"", "src='", "@import", "url(", "fetch(", "XMLHttpRequest", "import(", "<link", "<iframe", "<img"]
    {
        assert!(!page.contains(load), "{load}");
    }
    let links: Vec<&str> = page.split("href=\"").skip(1).map(|l| l.split('"').next().unwrap()).collect();
    assert!(links.iter().all(|l| l.starts_with('#')), "{links:?}");
}

#[test]
fn what_the_user_wrote_is_never_markup() {
    const ATTACK: &str = "</script><script>alert(1)</script><!-- \"'&\u{2028}\u{2029}";
    let mut result = sample::result(2);
    result.step.cracks[0].name = ATTACK.into();
    result.step.reactions[0].0 = ATTACK.into();
    result.warnings[0].message = ATTACK.into();
    let units = UnitNames { length: ATTACK.into(), force: ATTACK.into(), stress: ATTACK.into() };
    let info = RunInfo { title: ATTACK.into(), units: Some(units), ..sample::info() };
    let dir = tempfile::tempdir().unwrap();
    let mut writer = RunWriter::new(dir.path(), OutputOptions::default()).unwrap();
    let source = RunSource {
        case_file: ATTACK.into(),
        case_text: ATTACK.into(),
        overrides: vec![ATTACK.into()],
        platform: ATTACK.into(),
        settings: vec![[ATTACK.into(), ATTACK.into()]],
        ..RunSource::default()
    };
    writer.describe(&source).unwrap();
    writer.write_step(&info, &result, &[], None).unwrap();
    let page = read(dir.path());
    assert!(!page.contains("alert(1)</script>") && !page.contains("<script>alert"));
    assert!(!page.contains(['\u{2028}', '\u{2029}']));
    // As many scripts as a page without it has.
    let (_other, plain) = written(&sample::info(), &sample::result(2), &OutputOptions::default());
    assert_eq!(page.matches("<script").count(), plain.matches("<script").count());
    assert_eq!(page.matches("</script").count(), plain.matches("</script").count());
    assert_eq!(block(&page, "results")["case"], ATTACK);
    assert_eq!(block(&page, "results")["steps"][0]["cracks"][0]["name"], ATTACK);
    assert_eq!(block(&page, "run")["source"]["case_text"], ATTACK);
    assert_eq!(block(&page, "run")["source"]["settings"][0][1], ATTACK);
    assert_eq!(block(&page, "units")["stress"], ATTACK);
}

#[test]
fn a_new_run_forgets_the_report_of_the_old_one() {
    let (dir, _) = written(&sample::info(), &sample::result(2), &OutputOptions::default());
    RunWriter::new(dir.path(), OutputOptions::default()).unwrap();
    assert!(!dir.path().join(REPORT_FILE).exists());
    assert_eq!(std::fs::read_dir(dir.path().join("report")).unwrap().count(), 0);
    assert!(write_report(dir.path()).is_err());
}

#[test]
fn a_hundred_steps_of_a_hundred_thousand_points_stay_below_20_mb() {
    // One step is enough to know the size of all: each has a file of its own, and the coarse ones are taken if all fine
    // ones are too large.
    let result = sample::result(158);
    assert!(result.fields.positions.len() > 100_000);
    let dir = tempfile::tempdir().unwrap();
    let mut writer = RunWriter::new(dir.path(), OutputOptions::default()).unwrap();
    writer.write_step(&sample::info(), &result, &[], None).unwrap();
    let size = |name: &str| std::fs::metadata(dir.path().join(name)).unwrap().len();
    let coarse = size("report/coarse_0000.json");
    assert!(100 * coarse + size("report/fine_0000.json") < 18_000_000, "{coarse} bytes a step");
    let frame = size(REPORT_FILE) - size("report/fine_0000.json");
    assert!(frame < 300_000, "{frame} bytes without fields");
    let fields = block(&read(dir.path()), "fields-0");
    assert_eq!(fields["n_vertices"], 60_000);
}
