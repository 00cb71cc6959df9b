//! Files of a solid, read back.

use riss::analysis::{Silent, SolidResult, solid_static};
use riss::case::{AnyCase, SolidCase};
use riss::output::report::solid_scene::Scenes;
use riss::output::solid_report::solid_report;
use riss::output::{RunInfo, RunStatus, SolidResults, solid_results_schema, write_report, write_solid_results};
use serde_json::Value;
use std::path::Path;
use std::sync::OnceLock;

/// A small block with a crack from one side; the second crack is so small and near to a side that not every point of its
/// front has room for a disc.
const CASE: &str = "title = 'block'\nmethod = 'collocation'\nrigid_motion = 'mean-is-zero'\n\
    material = { young = 1000, poisson = 0.3 }\n\
    geometry.box = { lower = [0, 0, 0], upper = [4, 2, 4] }\nremote_stress.zz = 1\n\
    nodes = { spacing = 0.4, front_spacing = 0.2 }\nfracture.points = 3\n\
    crack = [{ name = 'edge', polygon = [[-1, -1, 2], [1.5, -1, 2], [1.5, 3, 2], [-1, 3, 2]] },\n\
             { name = 'small', disc = { center = [3.4, 1, 1], normal = [0, 0, 1], radius = 0.25 } }]";

fn info() -> RunInfo {
    RunInfo {
        title: "block".into(),
        method: "collocation".into(),
        units: None,
        status: RunStatus::Done,
        wall_time_s: 2.5,
        stage_time_s: vec![("solve".into(), 0.5), ("solve".into(), 0.25)],
        peak_memory_bytes: None,
    }
}

fn solved() -> &'static (Box<SolidCase>, SolidResult) {
    static SOLVED: OnceLock<(Box<SolidCase>, SolidResult)> = OnceLock::new();
    SOLVED.get_or_init(|| {
        let Ok(AnyCase::Solid(case)) = AnyCase::parse(CASE, "case.toml".as_ref(), &[]) else { panic!("a bad case") };
        let result = solid_static(&case.model, &case.settings, &mut Silent).unwrap();
        (case, result)
    })
}

#[test]
fn results_of_solids_come_back_as_they_were() {
    let (case, result) = solved();
    let dir = tempfile::tempdir().unwrap();
    let files = write_solid_results(dir.path(), &case.model, &info(), result).unwrap();
    let names: Vec<&str> = files.iter().map(|f| f.file_name().unwrap().to_str().unwrap()).collect();
    let vtk = ["nodes-0000.vtu", "nodes.pvd", "boundary-0000.vtu", "boundary.pvd", "cracks-0000.vtu", "cracks.pvd"];
    assert_eq!(names[..6], vtk);
    assert_eq!(names[6..], ["report.html", "results.json"]);
    let text = std::fs::read_to_string(&files[7]).unwrap();
    let read: SolidResults = serde_json::from_str(&text).unwrap();
    assert_eq!(read.files[..6], names[..6]);
    assert_eq!(read.files[6..], ["report/body.json", "report/scene_0000.json", "report.html"]);
    assert!(read.files.iter().all(|name| dir.path().join(name).is_file()));
    assert_eq!(read, SolidResults::new(&case.model, &info(), result, read.files.clone()));
    assert_eq!((read.nodes, read.unknowns), (result.n_nodes, 3 * result.n_nodes));
    assert_eq!(read.stage_time_s["solve"], 0.75);
    assert_eq!(read.cracks.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["edge", "small"]);
    let front = &read.fronts[0];
    assert_eq!((front.crack.as_str(), front.closed, front.points.len()), ("edge", false, 3));
    assert!((front.length.unwrap() - 2.0).abs() < 1e-9);
    for (point, record) in front.points.iter().zip(&result.fronts[0].points) {
        let found = record.factors.expect("a disc fits");
        assert_eq!([point.k1, point.k2, point.k3], found.factors.map(Some));
        assert_eq!((point.t_stress, point.j), (Some(found.t_stress), Some(found.j)));
        assert!((point.position[0].unwrap() - 1.5).abs() < 1e-9 && (point.ahead[0].unwrap() - 1.0).abs() < 1e-9);
    }
    assert!(serde_json::from_str::<SolidResults>(&text.replace("\"K_III\"", "\"k3\"")).is_err());
}

#[test]
fn what_is_unknown_of_a_front_is_null_and_present() {
    let (case, result) = solved();
    let results = SolidResults::new(&case.model, &info(), result, vec![]);
    let value: Value = serde_json::to_value(&results).unwrap();
    assert_eq!(value.get("peak_memory_bytes"), Some(&Value::Null));
    let point = &value["fronts"][1]["points"][0];
    assert_eq!(value["fronts"][1]["crack"], "small");
    for key in ["K_I", "K_II", "K_III", "K_uncertainty", "T", "T_uncertainty", "J", "disc_radius"] {
        assert_eq!(point.get(key), Some(&Value::Null), "{key}");
    }
}

#[test]
fn stored_schema_of_solids_is_current_and_requires_every_key() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/solid-results.schema.json");
    let schema = solid_results_schema();
    if std::env::var_os("RISS_UPDATE").is_some() {
        std::fs::write(&path, &schema).unwrap();
    }
    let stored = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(stored == schema, "{} is out of date; run the tests with RISS_UPDATE=1", path.display());
    let value: Value = serde_json::from_str(&schema).unwrap();
    let objects = value["$defs"].as_object().unwrap().values().chain([&value]).filter(|d| d["type"] == "object");
    for object in objects {
        let keys = object["properties"].as_object().unwrap().len();
        assert_eq!(object["required"].as_array().unwrap().len(), keys, "{object}");
    }
}

#[test]
fn the_report_of_a_solid_has_its_numbers_and_escapes_names() {
    let (case, result) = solved();
    let mut results = SolidResults::new(&case.model, &info(), result, vec![]);
    results.case = "<b>block</b>".into();
    results.fronts[0].crack = "a & b".into();
    let page = solid_report(&results, &Scenes::default());
    assert!(page.contains("&lt;b&gt;block&lt;/b&gt;") && !page.contains("<b>") && page.contains("a &amp; b"));
    assert!(!page.contains("<script") && !page.contains("http:") && !page.contains("https:"));
    // Two charts for a front, K_I, K_II, K_III and T at every point that has them.
    let known = results.fronts.iter().flat_map(|f| &f.points).filter(|p| p.k1.is_some()).count();
    assert!((4..6).contains(&known), "some points of the small crack have no disc");
    assert_eq!((page.matches("<svg").count(), page.matches("<circle").count()), (4, 4 * known));
    results.fronts[1].points.iter_mut().for_each(|p| (p.k1, p.k2, p.k3, p.t_stress) = (None, None, None, None));
    assert_eq!(solid_report(&results, &Scenes::default()).matches("<svg").count(), 2);
    assert_eq!(page.matches("<svg").count(), page.matches("</svg>").count());
    let k = format!("<td>{:.4}", results.fronts[0].points[1].k1.unwrap());
    assert!(page.contains(&k), "{k}");
}

#[test]
fn what_the_user_wrote_is_never_markup_in_reports_of_solids() {
    const ATTACK: &str = "</script></title><img src=x onerror=\"alert(1)\"> ' & <!--";
    let (case, result) = solved();
    let mut model = case.model.clone();
    model.crack_names = vec![ATTACK.into(); 2];
    let mut result = result.clone();
    result.warnings = vec![riss::analysis::Warning { key: Some("crack[0]".into()), message: ATTACK.into() }];
    let info =
        RunInfo { title: ATTACK.into(), method: ATTACK.into(), stage_time_s: vec![(ATTACK.into(), 1.0)], ..info() };
    let dir = tempfile::tempdir().unwrap();
    write_solid_results(dir.path(), &model, &info, &result).unwrap();
    let read = |name: &str| std::fs::read_to_string(dir.path().join(name)).unwrap();
    let page = read("report.html");
    assert!(!page.contains("<img") && !page.contains("<!--") && !page.contains("onerror=\""));
    // Those that the page has itself: three blocks of data, a library and what calls it.
    assert_eq!((page.matches("<script").count(), page.matches("</script").count()), (5, 5));
    // The title twice, the names of fronts and cracks, the warning, and the stage are there as text.
    assert!(page.matches("&lt;img src=x onerror=&quot;alert(1)&quot;&gt;").count() >= 8, "{page}");
    assert_eq!(page.matches("</title>").count(), 1);
    let results: Value = serde_json::from_str(&read("results.json")).unwrap();
    assert_eq!((&results["case"], &results["fronts"][0]["crack"]), (&ATTACK.into(), &ATTACK.into()));
    // Files for ParaView stay XML.
    for name in ["boundary.pvd", "cracks.pvd", "nodes.pvd"] {
        assert!(!read(name).contains("<img"));
    }
}

#[test]
fn the_report_is_made_again_from_the_folder() {
    let (case, result) = solved();
    let dir = tempfile::tempdir().unwrap();
    write_solid_results(dir.path(), &case.model, &info(), result).unwrap();
    let path = dir.path().join("report.html");
    let first = std::fs::read_to_string(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    assert_eq!(write_report(dir.path()).unwrap(), path);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), first);
}
