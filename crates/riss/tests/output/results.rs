//! `results.json`, `history.csv` and the folder as a whole.

use crate::sample;
use riss::analysis::TipStatus;
use riss::output::{OutputOptions, Results, results_json, results_schema, write_results};
use std::path::Path;

#[test]
fn results_come_back_as_they_were() {
    let (info, result) = (sample::info(), sample::result(2));
    let read: Results = serde_json::from_str(&results_json(&info, &result)).unwrap();
    assert_eq!(read, Results::new(&info, &result));
    assert_eq!(read.riss, env!("CARGO_PKG_VERSION"));
    assert_eq!(read.stage_time_s["solve"], 0.75);
    assert_eq!(read.steps[0].reactions["bottom"], Some([0.0, -2.0]));
    let tip = &read.steps[0].cracks[0].tips[0];
    assert_eq!((tip.k1, tip.status, tip.end), (Some(3.0), TipStatus::Stationary, riss::crack::End::End));
    assert!((tip.kink_angle_deg.unwrap() + 45.0).abs() < 1e-13);
}

#[test]
fn what_is_unknown_or_not_finite_is_null_and_present() {
    let value: serde_json::Value = serde_json::from_str(&results_json(&sample::info(), &sample::result(2))).unwrap();
    let tip = &value["steps"][0]["cracks"][0]["tips"][0];
    for (object, key) in [
        (&value, "energy_error"),
        (&value, "peak_memory_bytes"),
        (&value["steps"][0], "cycles"),
        (tip, "K_II"),
        (tip, "T"),
        (tip, "configurational_force"),
    ] {
        assert_eq!(object.get(key), Some(&serde_json::Value::Null), "{key}");
    }
}

#[test]
fn unknown_keys_are_refused() {
    let text = results_json(&sample::info(), &sample::result(2)).replace("\"K_I\"", "\"k1\"");
    assert!(serde_json::from_str::<Results>(&text).is_err());
}

#[test]
fn stored_schema_is_current_and_requires_every_key() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/results.schema.json");
    let schema = results_schema();
    if std::env::var_os("RISS_UPDATE").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, &schema).unwrap();
    }
    let stored = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(stored == schema, "{} is out of date; run the tests with RISS_UPDATE=1", path.display());
    let value: serde_json::Value = serde_json::from_str(&schema).unwrap();
    let objects = value["$defs"].as_object().unwrap().values().chain([&value]).filter(|d| d["type"] == "object");
    for object in objects {
        let keys = object["properties"].as_object().unwrap().len();
        assert_eq!(object["required"].as_array().unwrap().len(), keys, "{object}");
    }
}

#[test]
fn history_has_one_row_per_tip_and_a_header_without_tips() {
    let dir = tempfile::tempdir().unwrap();
    let mut result = sample::result(2);
    let history = |result: &_| {
        write_results(dir.path(), &sample::info(), result, &OutputOptions::default()).unwrap();
        std::fs::read_to_string(dir.path().join("history.csv")).unwrap()
    };
    let expected = "\
step,load_factor,cycles,crack,end,x,y,angle_deg,a,K_I,K_II,K_uncertainty,J,T,kink_angle_deg,status,K_equivalent,increment,growth_rate
0,1.0,,crack-1,end,0.0,0.0,0.0,1.0,3.0,,0.01,0.125,,-45.0,stationary,,,
";
    assert_eq!(history(&result), expected);
    result.step.cracks.clear();
    assert_eq!(history(&result).lines().count(), 1);
}

#[test]
fn results_are_written_last_and_name_the_other_files() {
    let dir = tempfile::tempdir().unwrap();
    let options = OutputOptions { fields: true, nodes: true, integration_points: true };
    let (info, result) = (sample::info(), sample::result(2));
    let dir = dir.path().join("made/on/the/way");
    let names = |options| -> Vec<String> {
        let paths = write_results(&dir, &info, &result, &options).unwrap();
        paths.iter().map(|p| p.strip_prefix(&dir).unwrap().to_str().unwrap().into()).collect()
    };
    let mut all = names(options);
    assert_eq!(all.pop().unwrap(), "results.json");
    let results: Results = serde_json::from_slice(&std::fs::read(dir.join("results.json")).unwrap()).unwrap();
    assert_eq!(results.files, all);
    let few = names(OutputOptions { fields: false, nodes: false, integration_points: false });
    assert_eq!(few, ["history.csv", "report.html", "results.json"]);
}

#[test]
fn fields_of_wrong_length_are_an_error() {
    let dir = tempfile::tempdir().unwrap();
    let mut result = sample::result(2);
    result.fields.out_of_plane_strain.pop();
    let error = write_results(dir.path(), &sample::info(), &result, &OutputOptions::default()).unwrap_err();
    assert!(error.to_string().contains("out_of_plane_strain"), "{error}");
    assert!(!dir.path().join("results.json").exists());
}
