//! Reference values of a case and their comparison with a run.
//!
//! `expected.json` holds `source`, and any of `tips`, `strain_energy`, `energy_error` and `reactions`. A reference is
//! `{"value": 1.0, "tolerance": 0.01}` with a relative tolerance, or `"absolute"` in its place, and may name its own
//! `source`:
//!
//! ```json
//! {
//!   "source": "Wilson (1969)",
//!   "tips": [{ "crack": "crack-1", "end": "end", "K_I": { "value": 34.0, "tolerance": 0.01 } }],
//!   "reactions": { "bottom": { "x": { "value": 0.0, "absolute": 1e-6 } } }
//! }
//! ```

use serde_json::{Map, Value};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const TIP_QUANTITIES: [&str; 4] = ["K_I", "K_II", "J", "T"];
const SCALARS: [&str; 2] = ["strain_energy", "energy_error"];

/// How far a computed value may lie from its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// As a part of the reference.
    Relative(f64),
    /// In the unit of the reference.
    Absolute(f64),
}

/// Which number of the results is meant.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// A number at a crack tip.
    Tip {
        /// Name of the crack.
        crack: String,
        /// `start` or `end`.
        end: String,
        /// `K_I`, `K_II`, `J` or `T`.
        key: String,
    },
    /// A number of the whole body.
    Scalar(String),
    /// A component of the force on a supported part.
    Reaction {
        /// Name of the part.
        part: String,
        /// `x` or `y`.
        axis: String,
    },
}

impl Quantity {
    /// Name in tables.
    pub fn name(&self) -> String {
        match self {
            Self::Tip { crack, end, key } => format!("{key} at {crack}, {end}"),
            Self::Scalar(key) => key.replace('_', " "),
            Self::Reaction { part, axis } => format!("reaction {axis} of {part}"),
        }
    }

    /// The number in the results of a static run.
    pub fn find_in(&self, results: &Value) -> Option<f64> {
        let step = &results["steps"][0];
        match self {
            Self::Tip { crack, end, key } => {
                let crack = step["cracks"].as_array()?.iter().find(|c| c["name"] == *crack)?;
                crack["tips"].as_array()?.iter().find(|t| t["end"] == *end)?[key].as_f64()
            }
            Self::Scalar(key) => results[key].as_f64(),
            Self::Reaction { part, axis } => step["reactions"][part][usize::from(axis == "y")].as_f64(),
        }
    }
}

/// One reference value.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// What it is.
    pub quantity: Quantity,
    /// The reference.
    pub value: f64,
    /// What passes.
    pub tolerance: Tolerance,
    /// Where it comes from.
    pub source: String,
}

/// All reference values of a case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Expected {
    /// In the order of tips, scalars, reactions.
    pub references: Vec<Reference>,
}

impl Expected {
    /// Reads the text of an `expected.json`.
    ///
    /// # Errors
    /// Says what is missing or not understood, with its place.
    pub fn parse(text: &str) -> Result<Self, String> {
        let root: Value = serde_json::from_str(text).map_err(|e| e.to_string())?;
        let root = object(&root, "the file")?;
        let known = ["source", "tips", "reactions"].into_iter().chain(SCALARS);
        only_known(root, &known.collect::<Vec<_>>(), "the file")?;
        let source = root.get("source").and_then(Value::as_str).ok_or("`source` is missing")?;
        let mut references = vec![];
        let tips = root.get("tips").map_or(Ok(&[][..]), |t| t.as_array().map(Vec::as_slice).ok_or("`tips` is no list"));
        for (i, tip) in tips?.iter().enumerate() {
            read_tip(tip, &format!("tips[{i}]"), source, &mut references)?;
        }
        for key in SCALARS {
            if let Some(value) = root.get(key) {
                references.push(read_reference(value, Quantity::Scalar(key.into()), key, source)?);
            }
        }
        for (part, axes) in root.get("reactions").map_or(Ok(&Map::new()), |r| object(r, "reactions"))? {
            let place = format!("reactions.{part}");
            let axes = object(axes, &place)?;
            only_known(axes, &["x", "y"], &place)?;
            for (axis, value) in axes {
                let quantity = Quantity::Reaction { part: part.clone(), axis: axis.clone() };
                references.push(read_reference(value, quantity, &format!("{place}.{axis}"), source)?);
            }
        }
        if references.is_empty() { Err("there is no reference value".into()) } else { Ok(Self { references }) }
    }

    /// Compares all references with the results of a run.
    pub fn compare(&self, results: &Value) -> Vec<Comparison> {
        let with_value = |r: &Reference| Comparison { computed: r.quantity.find_in(results), reference: r.clone() };
        self.references.iter().map(with_value).collect()
    }
}

fn read_tip(tip: &Value, place: &str, source: &str, references: &mut Vec<Reference>) -> Result<(), String> {
    let tip = object(tip, place)?;
    let known: Vec<&str> = ["crack", "end", "source"].into_iter().chain(TIP_QUANTITIES).collect();
    only_known(tip, &known, place)?;
    let text = |key: &str| tip.get(key).and_then(Value::as_str);
    let crack = text("crack").ok_or_else(|| format!("{place}: `crack` is missing"))?;
    let end = text("end").filter(|e| ["start", "end"].contains(e));
    let end = end.ok_or_else(|| format!("{place}: `end` must be \"start\" or \"end\""))?;
    for key in TIP_QUANTITIES {
        if let Some(value) = tip.get(key) {
            let quantity = Quantity::Tip { crack: crack.into(), end: end.into(), key: key.into() };
            let source = text("source").unwrap_or(source);
            references.push(read_reference(value, quantity, &format!("{place}.{key}"), source)?);
        }
    }
    Ok(())
}

fn read_reference(value: &Value, quantity: Quantity, place: &str, source: &str) -> Result<Reference, String> {
    let map = object(value, place)?;
    only_known(map, &["value", "tolerance", "absolute", "source"], place)?;
    let number = |key: &str| map.get(key).and_then(Value::as_f64).filter(|v| v.is_finite());
    let value = number("value").ok_or_else(|| format!("{place}: `value` must be a number"))?;
    let tolerance = match (number("tolerance"), number("absolute")) {
        (Some(t), None) if t > 0.0 && value != 0.0 => Tolerance::Relative(t),
        (None, Some(t)) if t > 0.0 => Tolerance::Absolute(t),
        (Some(_), None) if value == 0.0 => return Err(format!("{place}: a reference of 0 needs `absolute`")),
        _ => return Err(format!("{place}: give either `tolerance` (relative) or `absolute`, positive")),
    };
    let source = map.get("source").and_then(Value::as_str).unwrap_or(source).to_string();
    Ok(Reference { quantity, value, tolerance, source })
}

fn object<'a>(value: &'a Value, place: &str) -> Result<&'a Map<String, Value>, String> {
    value.as_object().ok_or_else(|| format!("{place} must be an object"))
}

fn only_known(map: &Map<String, Value>, known: &[&str], place: &str) -> Result<(), String> {
    match map.keys().find(|k| !known.contains(&k.as_str())) {
        Some(key) => Err(format!("{place}: unknown key `{key}`; known are {}", known.join(", "))),
        None => Ok(()),
    }
}

/// A reference beside what was computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The reference.
    pub reference: Reference,
    /// What the run says, if it says anything.
    pub computed: Option<f64>,
}

impl Comparison {
    /// The error, in the same measure as the tolerance; signed.
    pub fn error(&self) -> Option<f64> {
        let difference = self.computed? - self.reference.value;
        Some(match self.reference.tolerance {
            Tolerance::Relative(_) => difference / self.reference.value.abs(),
            Tolerance::Absolute(_) => difference,
        })
    }

    /// Whether the computed value is there and near enough.
    pub fn passed(&self) -> bool {
        let (Tolerance::Relative(most) | Tolerance::Absolute(most)) = self.reference.tolerance;
        self.error().is_some_and(|e| e.abs() <= most)
    }

    /// The cells of a table row: quantity, reference, computed, error, tolerance.
    pub fn cells(&self) -> [String; 5] {
        let measure = |v: f64| match self.reference.tolerance {
            Tolerance::Relative(_) => format!("{:.2} %", 100.0 * v),
            Tolerance::Absolute(_) => number(v),
        };
        let (Tolerance::Relative(most) | Tolerance::Absolute(most)) = self.reference.tolerance;
        [
            self.reference.quantity.name(),
            number(self.reference.value),
            self.computed.map_or("missing".into(), number),
            self.error().map_or(String::new(), |e| format!("{}{}", if e < 0.0 { "-" } else { "+" }, measure(e.abs()))),
            measure(most),
        ]
    }
}

/// Five digits, with an exponent where that is shorter.
fn number(v: f64) -> String {
    if v == 0.0 || (1e-3..1e5).contains(&v.abs()) {
        let digits = if v == 0.0 { 1.0 } else { v.abs().log10().floor() };
        format!("{v:.*}", (4.0 - digits).clamp(0.0, 7.0) as usize)
    } else {
        format!("{v:.4e}")
    }
}

/// A case that ran.
#[derive(Clone, Debug)]
pub struct CaseRun {
    /// The content of `results.json`.
    pub results: Value,
    /// Every reference beside its computed value.
    pub comparisons: Vec<Comparison>,
    /// Wall time of the program.
    pub time: Duration,
}

/// Runs `case.toml` of a folder with the `riss` program and compares it with the `expected.json` beside it.
///
/// # Errors
/// Says why the run or the reading failed; values out of tolerance are no error here.
pub fn run_case(riss: &Path, folder: &Path, out: &Path) -> Result<CaseRun, String> {
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()));
    let expected = folder.join("expected.json");
    let expected = Expected::parse(&read(&expected)?).map_err(|e| format!("{}: {e}", expected.display()))?;
    let path = out.join("results.json");
    // What an earlier run left must not pass for this one.
    if path.exists() {
        std::fs::remove_file(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    let start = Instant::now();
    let mut command = Command::new(riss);
    command.arg("run").arg(folder.join("case.toml")).arg("--out").arg(out).stdin(Stdio::null());
    let output = command.output().map_err(|e| format!("{} did not start: {e}", riss.display()))?;
    let time = start.elapsed();
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        return Err(format!("riss ended with {}\n{}", output.status, text.trim_end()));
    }
    let results: Value = serde_json::from_str(&read(&path)?).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok(CaseRun { comparisons: expected.compare(&results), results, time })
}

#[cfg(test)]
mod tests {
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

    fn check_compare(expected: Value, passed: &[bool]) {
        let expected = Expected::parse(&expected.to_string()).unwrap();
        let comparisons = expected.compare(&results());
        assert_eq!(comparisons.iter().map(Comparison::passed).collect::<Vec<_>>(), passed, "{comparisons:?}");
    }

    #[test]
    fn tips_scalars_and_reactions_are_compared() {
        check_compare(
            json!({ "source": "s", "tips": [{ "crack": "crack-1", "end": "end",
                "K_I": { "value": 34.0, "tolerance": 0.01 }, "T": { "value": 2.0, "absolute": 0.5 } }] }),
            &[true, false],
        );
        check_compare(
            json!({ "source": "s", "strain_energy": { "value": 2.0, "tolerance": 0.005 },
                "reactions": { "bottom": { "x": { "value": -7.1, "tolerance": 0.02 },
                                           "y": { "value": 0.0, "absolute": 1e-6 } } } }),
            &[false, true, true],
        );
        // Absent, null and unknown values do not pass.
        check_compare(
            json!({ "source": "s", "energy_error": { "value": 0.1, "absolute": 1.0 }, "tips": [
                { "crack": "crack-1", "end": "start", "K_I": { "value": 1.0, "tolerance": 1.0 } },
                { "crack": "nowhere", "end": "end", "K_I": { "value": 1.0, "tolerance": 1.0 } }] }),
            &[false, false, false],
        );
    }

    fn check_refused(text: &str, part: &str) {
        let reason = Expected::parse(text).unwrap_err();
        assert!(reason.contains(part), "{reason} should contain {part}");
    }

    #[test]
    fn what_is_wrong_is_said() {
        check_refused("{", "EOF");
        check_refused(r#"{"tips": []}"#, "`source`");
        check_refused(r#"{"source": "s"}"#, "no reference value");
        check_refused(r#"{"source": "s", "strain": {}}"#, "unknown key `strain`");
        check_refused(r#"{"source": "s", "tips": [{"crack": "c", "end": "tip"}]}"#, "tips[0]: `end`");
        check_refused(r#"{"source": "s", "strain_energy": {"value": 0, "tolerance": 0.1}}"#, "needs `absolute`");
        check_refused(r#"{"source": "s", "strain_energy": {"value": 1}}"#, "either `tolerance`");
    }

    #[test]
    fn numbers_are_short() {
        let cases =
            [(34.041, "34.041"), (4.5371, "4.5371"), (0.0, "0.000"), (2.41118e-5, "2.4112e-5"), (-0.5, "-0.50000")];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
    }
}
