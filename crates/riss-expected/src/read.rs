//! Reads `expected.json`.

use crate::path::{self, Window};
use crate::quantity::Along;
use crate::{Expected, Quantity, Reference, RunBy, Target, Tolerance};
use serde_json::{Map, Value};
use std::ops::RangeInclusive;
use std::path::Path;

const TIP_QUANTITIES: [&str; 7] = ["K_I", "K_II", "K_I_direct", "K_II_direct", "J", "T", "kink_angle_deg"];
const FRONT_QUANTITIES: [&str; 5] = ["K_I", "K_II", "K_III", "T", "J"];
const SCALARS: [&str; 3] = ["strain_energy", "energy_error", "crack_area"];
const LOADING_QUANTITIES: [&str; 4] = ["peak_load", "displacement_at_peak", "dissipated_energy", "stiffness"];

type Object = Map<String, Value>;

impl Expected {
    /// Reads `expected.json` of a case folder, and the paths that it names.
    ///
    /// # Errors
    /// Says what is missing or not understood, with its place.
    pub fn read(folder: &Path) -> Result<Self, String> {
        let file = |name: &str| {
            let path = folder.join(name);
            std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))
        };
        Self::parse(&file("expected.json")?, &file)
            .map_err(|e| format!("{}: {e}", folder.join("expected.json").display()))
    }

    /// Reads the text of an `expected.json`; `file` gives the texts of other files in its folder.
    ///
    /// # Errors
    /// Says what is missing or not understood, with its place.
    pub fn parse(text: &str, file: &dyn Fn(&str) -> Result<String, String>) -> Result<Self, String> {
        let root: Value = serde_json::from_str(text).map_err(|e| e.to_string())?;
        let root = object(&root, "the file")?;
        let known = [
            "source",
            "run",
            "tips",
            "fronts",
            "largest_principal_stress",
            "reactions",
            "paths",
            "end",
            "cycles",
            "loading",
        ]
        .into_iter()
        .chain(SCALARS);
        only_known(root, &known.collect::<Vec<_>>(), "the file")?;
        let source = root.get("source").and_then(Value::as_str).ok_or("`source` is missing")?;
        let run_by = match root.get("run").map(Value::as_str) {
            None => RunBy::Tests,
            Some(Some("verify")) => RunBy::Verify,
            Some(_) => return Err("`run` can only be \"verify\"".into()),
        };
        let mut reader = Reader { source, references: vec![] };
        for (place, tip) in list(root, "tips")? {
            reader.tip(tip, &place)?;
        }
        for (place, front) in list(root, "fronts")? {
            reader.front(front, &place)?;
        }
        if let Some(value) = root.get("largest_principal_stress") {
            reader.number(value, Quantity::LargestPrincipalStress, "largest_principal_stress", source)?;
        }
        for key in SCALARS {
            if let Some(value) = root.get(key) {
                reader.number(value, Quantity::Scalar(key.into()), key, source)?;
            }
        }
        if let Some(loading) = root.get("loading") {
            reader.loading(object(loading, "loading")?)?;
        }
        if let Some(reactions) = root.get("reactions") {
            reader.reactions(object(reactions, "reactions")?)?;
        }
        for (place, path) in list(root, "paths")? {
            reader.path(path, &place, file)?;
        }
        if let Some(end) = root.get("end") {
            reader.end(object(end, "end")?)?;
        }
        for (place, cycles) in list(root, "cycles")? {
            reader.cycles(cycles, &place)?;
        }
        let references = reader.references;
        if references.is_empty() { Err("there is no reference value".into()) } else { Ok(Self { run_by, references }) }
    }
}

/// Collects references.
struct Reader<'a> {
    source: &'a str,
    references: Vec<Reference>,
}

impl Reader<'_> {
    fn tip(&mut self, tip: &Value, place: &str) -> Result<(), String> {
        let tip = object(tip, place)?;
        let known: Vec<&str> = ["crack", "end", "step", "source"].into_iter().chain(TIP_QUANTITIES).collect();
        only_known(tip, &known, place)?;
        let (crack, end) = which_tip(tip, place)?;
        let step = match tip.get("step") {
            None => 0,
            Some(step) => step.as_u64().ok_or_else(|| format!("{place}: `step` must be a whole number"))? as usize,
        };
        for key in TIP_QUANTITIES {
            if let Some(value) = tip.get(key) {
                let quantity = Quantity::Tip { crack: crack.clone(), end: end.clone(), key: key.into(), step };
                let source = text(tip, "source").unwrap_or(self.source);
                self.number(value, quantity, &format!("{place}.{key}"), source)?;
            }
        }
        Ok(())
    }

    /// Without `take` and `at`, the least and the greatest value must both be near the reference.
    fn front(&mut self, front: &Value, place: &str) -> Result<(), String> {
        let front = object(front, place)?;
        let known: Vec<&str> = ["crack", "take", "at", "source"].into_iter().chain(FRONT_QUANTITIES).collect();
        only_known(front, &known, place)?;
        let crack = text(front, "crack").ok_or_else(|| format!("{place}: `crack` is missing"))?;
        let which = match (front.get("take").map(Value::as_str), front.get("at")) {
            (None, None) => vec![Along::Least, Along::Greatest],
            (None, Some(at)) => vec![Along::At(triple(at).ok_or_else(|| format!("{place}: `at` must be [x, y, z]"))?)],
            (Some(Some("least")), None) => vec![Along::Least],
            (Some(Some("greatest")), None) => vec![Along::Greatest],
            (Some(Some("mean")), None) => vec![Along::Mean],
            (Some(_), None) => return Err(format!("{place}: `take` must be \"least\", \"greatest\" or \"mean\"")),
            (Some(_), Some(_)) => return Err(format!("{place}: give either `take` or `at`")),
        };
        for key in FRONT_QUANTITIES {
            let Some(value) = front.get(key) else { continue };
            for along in &which {
                let quantity = Quantity::Front { crack: crack.into(), key: key.into(), along: *along };
                let source = text(front, "source").unwrap_or(self.source);
                self.number(value, quantity, &format!("{place}.{key}"), source)?;
            }
        }
        Ok(())
    }

    fn loading(&mut self, loading: &Object) -> Result<(), String> {
        let known: Vec<&str> = ["end", "source"].into_iter().chain(LOADING_QUANTITIES).collect();
        only_known(loading, &known, "loading")?;
        let source = text(loading, "source").unwrap_or(self.source);
        for key in LOADING_QUANTITIES {
            if let Some(value) = loading.get(key) {
                self.number(value, Quantity::Loading(key.into()), &format!("loading.{key}"), source)?;
            }
        }
        if let Some(end) = loading.get("end") {
            let word = end.as_str().ok_or("loading.end must be a word")?;
            let (quantity, target) = (Quantity::LoadingEnd, Target::Word(word.into()));
            self.references.push(Reference { quantity, target, source: source.into() });
        }
        Ok(())
    }

    fn reactions(&mut self, reactions: &Object) -> Result<(), String> {
        for (part, axes) in reactions {
            let place = format!("reactions.{part}");
            let axes = object(axes, &place)?;
            only_known(axes, &["x", "y"], &place)?;
            for (axis, value) in axes {
                let quantity = Quantity::Reaction { part: part.clone(), axis: axis.clone() };
                self.number(value, quantity, &format!("{place}.{axis}"), self.source)?;
            }
        }
        Ok(())
    }

    fn path(&mut self, path: &Value, place: &str, file: &dyn Fn(&str) -> Result<String, String>) -> Result<(), String> {
        let path = object(path, place)?;
        only_known(path, &["crack", "file", "distance", "within", "source"], place)?;
        let crack = text(path, "crack").ok_or_else(|| format!("{place}: `crack` is missing"))?.to_string();
        let name = text(path, "file").ok_or_else(|| format!("{place}: `file` is missing"))?;
        let reference = path::parse(&file(name)?).map_err(|e| format!("{name}: {e}"))?;
        let window = match path.get("within") {
            None => Window::default(),
            Some(window) => read_window(window, &format!("{place}.within"))?,
        };
        let distance = path.get("distance").and_then(Value::as_f64).filter(|d| *d > 0.0);
        let distance = distance.ok_or_else(|| format!("{place}: `distance` must be positive"))?;
        self.push(
            Quantity::Path { crack, reference, window },
            Target::Number(0.0, Tolerance::Absolute(distance)),
            text(path, "source"),
        );
        Ok(())
    }

    fn end(&mut self, end: &Object) -> Result<(), String> {
        only_known(end, &["kind", "tips", "source"], "end")?;
        let source = text(end, "source");
        if let Some(kind) = text(end, "kind") {
            self.push(Quantity::EndKind, Target::Word(kind.into()), source);
        }
        for (place, tip) in list(end, "tips")? {
            let place = format!("end.{place}");
            let tip = object(tip, &place)?;
            only_known(tip, &["crack", "end", "status", "meets"], &place)?;
            let (crack, end) = which_tip(tip, &place)?;
            let status = text(tip, "status").ok_or_else(|| format!("{place}: `status` is missing"))?;
            let quantity = Quantity::TipStatus { crack: crack.clone(), end: end.clone() };
            self.push(quantity, Target::Word(status.into()), source);
            if let Some(name) = text(tip, "meets") {
                self.push(Quantity::Meets { crack, end }, Target::Word(name.into()), source);
            }
        }
        Ok(())
    }

    fn cycles(&mut self, cycles: &Value, place: &str) -> Result<(), String> {
        let mut cycles = object(cycles, place)?.clone();
        let until = match (cycles.remove("crack"), cycles.remove("length")) {
            (None, None) => None,
            (Some(Value::String(crack)), Some(Value::Number(length))) => length.as_f64().map(|l| (crack, l)),
            _ => return Err(format!("{place}: give both `crack` and `length`, or none")),
        };
        self.number(&Value::Object(cycles), Quantity::Cycles { until }, place, self.source)
    }

    /// A number with its tolerance.
    fn number(&mut self, value: &Value, quantity: Quantity, place: &str, source: &str) -> Result<(), String> {
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
        self.push(quantity, Target::Number(value, tolerance), Some(text(map, "source").unwrap_or(source)));
        Ok(())
    }

    fn push(&mut self, quantity: Quantity, target: Target, source: Option<&str>) {
        let source = source.unwrap_or(self.source).to_string();
        self.references.push(Reference { quantity, target, source });
    }
}

fn which_tip(tip: &Object, place: &str) -> Result<(String, String), String> {
    let crack = text(tip, "crack").ok_or_else(|| format!("{place}: `crack` is missing"))?;
    let end = text(tip, "end").filter(|e| ["start", "end"].contains(e));
    let end = end.ok_or_else(|| format!("{place}: `end` must be \"start\" or \"end\""))?;
    Ok((crack.into(), end.into()))
}

fn triple(value: &Value) -> Option<[f64; 3]> {
    let [x, y, z] = value.as_array()?.as_slice() else { return None };
    Some([x.as_f64()?, y.as_f64()?, z.as_f64()?])
}

fn read_window(window: &Value, place: &str) -> Result<Window, String> {
    let window = object(window, place)?;
    only_known(window, &["x", "y"], place)?;
    let range = |key: &str| -> Result<RangeInclusive<f64>, String> {
        let Some(value) = window.get(key) else { return Ok(f64::NEG_INFINITY..=f64::INFINITY) };
        match (value[0].as_f64(), value[1].as_f64()) {
            (Some(low), Some(high)) if low < high => Ok(low..=high),
            _ => Err(format!("{place}.{key} must be [low, high]")),
        }
    };
    Ok(Window { x: range("x")?, y: range("y")? })
}

/// The items of a list with their places; none if it is absent.
fn list<'a>(map: &'a Object, key: &str) -> Result<Vec<(String, &'a Value)>, String> {
    let Some(value) = map.get(key) else { return Ok(vec![]) };
    let items = value.as_array().ok_or_else(|| format!("`{key}` is no list"))?;
    Ok(items.iter().enumerate().map(|(i, item)| (format!("{key}[{i}]"), item)).collect())
}

fn text<'a>(map: &'a Object, key: &str) -> Option<&'a str> {
    map.get(key).and_then(Value::as_str)
}

fn object<'a>(value: &'a Value, place: &str) -> Result<&'a Object, String> {
    value.as_object().ok_or_else(|| format!("{place} must be an object"))
}

fn only_known(map: &Object, known: &[&str], place: &str) -> Result<(), String> {
    match map.keys().find(|k| !known.contains(&k.as_str())) {
        Some(key) => Err(format!("{place}: unknown key `{key}`; known are {}", known.join(", "))),
        None => Ok(()),
    }
}
