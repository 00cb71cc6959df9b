//! Tests of reading and comparing.

use super::*;
use serde_json::json;

fn results() -> Value {
    json!({
        "strain_energy": 2.02,
        "steps": [{
            "cracks": [{ "name": "crack-1", "tips": [
                { "end": "start", "K_I": null },
                { "end": "end", "K_I": 34.2, "K_II": 4.5, "K_uncertainty": 0.1, "J": 4e-5, "T": 2.7 },
            ] }],
            "reactions": { "bottom": [-7.0, 1e-9] },
        }],
    })
}

fn grown() -> Value {
    let crack =
        |path: Value, tips: Value| json!([{ "name": "c", "path": path, "ends": ["mouth", "tip"], "tips": tips }]);
    let reason = "its increment meets `bore` at (3.0, 0.1)";
    json!({
        "growth_end": { "kind": "no-tip-grows", "reason": "no crack tip is left" },
        "strain_energy": null,
        "steps": [
            { "cycles": 0.0, "strain_energy": 2.0, "cracks": crack(json!([[0, 0], [1, 0]]),
                json!([{ "end": "end", "K_I": 10.0, "status": "growing" }])) },
            { "cycles": 400.0, "strain_energy": 2.5, "cracks": crack(json!([[0, 0], [1, 0], [2, 0]]),
                json!([{ "end": "end", "K_I": 20.0, "status": "reached-hole", "reason": reason }])) },
            { "cycles": 500.0, "strain_energy": null, "cracks": crack(json!([[0, 0], [1, 0], [2, 0], [3, 0.1]]), json!([])) },
        ],
    })
}

fn parse(text: &str) -> Result<Expected, String> {
    Expected::parse(text, &|name| match name {
        "path.csv" => Ok("# by hand\nx,y\n-1,0\n3,0\n4,0\n".into()),
        _ => Err(format!("{name} is not there")),
    })
}

fn check_compare(results: &Value, expected: Value, passed: &[bool]) {
    let comparisons = parse(&expected.to_string()).unwrap().compare(results);
    assert_eq!(comparisons.iter().map(Comparison::passed).collect::<Vec<_>>(), passed, "{comparisons:?}");
}

#[test]
fn tips_scalars_and_reactions_are_compared() {
    check_compare(
        &results(),
        json!({ "source": "s", "tips": [{ "crack": "crack-1", "end": "end",
            "K_I": { "value": 34.0, "tolerance": 0.01 }, "T": { "value": 2.0, "absolute": 0.5 } }] }),
        &[true, false],
    );
    check_compare(
        &results(),
        json!({ "source": "s", "strain_energy": { "value": 2.0, "tolerance": 0.005 },
            "reactions": { "bottom": { "x": { "value": -7.1, "tolerance": 0.02 },
                                       "y": { "value": 0.0, "absolute": 1e-6 } } } }),
        &[false, true, true],
    );
    // Absent, null and unknown values do not pass.
    check_compare(
        &results(),
        json!({ "source": "s", "energy_error": { "value": 0.1, "absolute": 1.0 }, "tips": [
            { "crack": "crack-1", "end": "start", "K_I": { "value": 1.0, "tolerance": 1.0 } },
            { "crack": "crack-1", "end": "end", "step": 1, "K_I": { "value": 1.0, "tolerance": 1.0 } },
            { "crack": "nowhere", "end": "end", "K_I": { "value": 1.0, "tolerance": 1.0 } }] }),
        &[false, false, false, false],
    );
}

#[test]
fn steps_and_the_first_energy_are_compared() {
    let k =
        |step: usize| json!({ "crack": "c", "end": "end", "step": step, "K_I": { "value": 20, "tolerance": 0.01 } });
    check_compare(
        &grown(),
        json!({ "source": "s", "tips": [k(0), k(1), k(2)], "strain_energy": { "value": 2, "tolerance": 0.01 } }),
        &[false, true, false, true],
    );
}

#[test]
fn paths_are_compared_with_files() {
    let path = |crack: &str, distance: f64| json!({ "crack": crack, "file": "path.csv", "distance": distance });
    let within = json!({ "crack": "c", "file": "path.csv", "distance": 0.01, "within": { "x": [0, 2.05] } });
    check_compare(
        &grown(),
        json!({ "source": "s", "paths": [path("c", 0.101), path("c", 0.099), path("nowhere", 9.0), within] }),
        &[true, false, false, true],
    );
}

#[test]
fn the_end_is_compared_word_by_word() {
    let end = |status: &str, meets: &str| json!({ "crack": "c", "end": "end", "status": status, "meets": meets });
    check_compare(
        &grown(),
        json!({ "source": "s", "end": { "kind": "no-tip-grows", "tips": [end("reached-hole", "bore")] } }),
        &[true; 3],
    );
    check_compare(
        &grown(),
        json!({ "source": "s", "end": { "kind": "separated", "tips": [end("growing", "bolt")] } }),
        &[false; 3],
    );
    let comparison = &parse(r#"{"source": "s", "end": {"kind": "separated"}}"#).unwrap().compare(&grown())[0];
    assert_eq!(comparison.cells(), ["end of growth", "separated", "no-tip-grows", "", ""]);
}

#[test]
fn cycles_are_compared_at_the_end_and_at_a_length() {
    let until = |length: f64, value: f64| json!({ "crack": "c", "length": length, "value": value, "tolerance": 1e-6 });
    check_compare(
        &grown(),
        json!({ "source": "s", "cycles": [{ "value": 500, "tolerance": 1e-6 }, until(1.5, 200.0), until(2.0, 400.0),
            until(2.0, 300.0), until(5.0, 500.0)] }),
        &[true, true, true, false, false],
    );
}

fn check_refused(text: &str, part: &str) {
    let reason = parse(text).unwrap_err();
    assert!(reason.contains(part), "{reason} should contain {part}");
}

#[test]
fn what_is_wrong_is_said() {
    check_refused("{", "EOF");
    check_refused(r#"{"tips": []}"#, "`source`");
    check_refused(r#"{"source": "s"}"#, "no reference value");
    check_refused(r#"{"source": "s", "strain": {}}"#, "unknown key `strain`");
    check_refused(r#"{"source": "s", "run": "never"}"#, "`run`");
    check_refused(r#"{"source": "s", "tips": [{"crack": "c", "end": "tip"}]}"#, "tips[0]: `end`");
    check_refused(r#"{"source": "s", "tips": [{"crack": "c", "end": "end", "step": -1}]}"#, "`step`");
    check_refused(r#"{"source": "s", "strain_energy": {"value": 0, "tolerance": 0.1}}"#, "needs `absolute`");
    check_refused(r#"{"source": "s", "strain_energy": {"value": 1}}"#, "either `tolerance`");
    check_refused(
        r#"{"source": "s", "paths": [{"crack": "c", "file": "p.csv", "distance": 1}]}"#,
        "p.csv is not there",
    );
    check_refused(r#"{"source": "s", "paths": [{"crack": "c", "file": "path.csv"}]}"#, "`distance`");
    check_refused(r#"{"source": "s", "end": {"tips": [{"crack": "c", "end": "end"}]}}"#, "end.tips[0]: `status`");
    check_refused(
        r#"{"source": "s", "cycles": [{"length": 1, "value": 2, "tolerance": 0.1}]}"#,
        "`crack` and `length`",
    );
}

#[test]
fn long_cases_say_so() {
    let text = |run: &str| format!(r#"{{"source": "s"{run}, "strain_energy": {{"value": 1, "tolerance": 0.1}}}}"#);
    assert_eq!(parse(&text("")).unwrap().run_by, RunBy::Tests);
    assert_eq!(parse(&text(r#", "run": "verify""#)).unwrap().run_by, RunBy::Verify);
}

#[test]
fn numbers_are_short() {
    let cases = [(34.041, "34.041"), (4.5371, "4.5371"), (0.0, "0.000"), (2.41118e-5, "2.4112e-5"), (-0.5, "-0.50000")];
    for (value, text) in cases {
        assert_eq!(number(value), text);
    }
}

#[test]
fn fronts_are_compared_along_their_length() {
    let point = |k: f64, k2: f64| json!({ "K_I": k, "K_II": k2 });
    let results = json!({
        "stress": { "largest_principal": 2.04 },
        "fronts": [
            { "crack": "penny", "points": [point(1.12, 0.6), point(1.14, -0.6)] },
            { "crack": "other", "points": [{ "K_I": null }] },
        ],
    });
    check_compare(
        &results,
        json!({ "source": "s", "largest_principal_stress": { "value": 2.045, "tolerance": 0.01 },
            "fronts": [
                { "crack": "penny", "K_I": { "value": 1.128, "tolerance": 0.01 } },
                { "crack": "penny", "take": "greatest", "K_II": { "value": 0.6, "tolerance": 0.01 } },
                { "crack": "penny", "take": "mean", "K_II": { "value": 0.0, "absolute": 1e-9 } },
                { "crack": "other", "K_I": { "value": 1.0, "tolerance": 0.5 } } ] }),
        &[true, false, true, true, false, false, true],
    );
}

#[test]
fn fronts_are_compared_at_places() {
    let point = |x: f64, k: f64| json!({ "position": [x, 0.0, 0.5], "K_I": k, "T": null });
    let results = json!({ "fronts": [
        { "crack": "a", "length": 10.0, "points": [point(0.0, 1.0), point(1.0, 2.0), point(1.03, 3.0)] },
        { "crack": "b", "length": 10.0, "points": [point(1.0, 4.0)] },
    ] });
    let at = |x: f64, key: &str, value: f64| json!({ "crack": "a", "at": [x, 0.0, 0.5], (key): { "value": value, "tolerance": 1e-9 } });
    let fronts =
        [at(0.0, "K_I", 1.0), at(1.01, "K_I", 2.0), at(1.02, "K_I", 3.0), at(0.5, "K_I", 1.0), at(0.0, "T", 1.0)];
    check_compare(&results, json!({ "source": "s", "fronts": fronts }), &[true, true, true, false, false]);
}
