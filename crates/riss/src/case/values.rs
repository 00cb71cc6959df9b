//! Texts where numbers are due: quantities ("200 GPa"), parameters ("2*a") and both in one case file.
//!
//! Comes before the check of the schema, so that nothing after it knows of units or parameters.

use super::document::{Content, Document, Node};
use super::expression::{Expression, is_reserved};
use super::problem::{MAX_PROBLEMS, Problem};
use super::units::{self, Dimension, Unit, UnitSystem};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Expressions of parameters that refer to each other, at most so deep.
const MAX_CHAIN: usize = 32;

/// What was found on the way.
#[derive(Default)]
pub(super) struct Resolved {
    /// The units of the case.
    pub units: Option<UnitSystem>,
    /// Top-level keys with a problem; placeholders stand for their faulty numbers.
    pub faulty: BTreeSet<String>,
    /// Parameters that nothing uses.
    pub unused: Vec<String>,
}

/// Puts numbers in the place of quantities and of expressions of parameters.
pub(super) fn resolve(document: &mut Document, schema: &Value, problems: &mut Vec<Problem>) -> Resolved {
    let mut root = std::mem::take(&mut document.root);
    let mut resolver = Resolver {
        document,
        schema,
        system: None,
        parameters: BTreeMap::new(),
        used: BTreeSet::new(),
        problems,
        faulty: BTreeSet::new(),
        top: String::new(),
    };
    resolver.read_units(&root);
    resolver.read_parameters(&mut root);
    let properties = &schema["properties"];
    for (key, node) in root.iter_mut().filter(|(k, _)| *k != "parameters" && *k != "units") {
        resolver.top.clone_from(key);
        if let Some(schema) = properties.get(key) {
            resolver.node(node, schema, key, Meaning::Unknown);
        }
    }
    let unused = resolver.parameters.keys().filter(|p| !resolver.used.contains(*p)).cloned().collect();
    let resolved = Resolved { units: resolver.system, faulty: resolver.faulty, unused };
    document.root = root;
    resolved
}

/// What a number means, as far as its description says.
#[derive(Clone, Copy)]
enum Meaning {
    /// Nothing is said: a plain number.
    Unknown,
    /// Of this dimension.
    Of(Dimension),
    /// A coefficient whose dimension depends on an exponent.
    Any,
}

struct Resolver<'a> {
    document: &'a Document,
    schema: &'a Value,
    system: Option<UnitSystem>,
    parameters: BTreeMap<String, f64>,
    used: BTreeSet<String>,
    problems: &'a mut Vec<Problem>,
    faulty: BTreeSet<String>,
    /// The top-level key at hand.
    top: String,
}

impl<'a> Resolver<'a> {
    fn report(&mut self, key: &str, node: &Node, message: impl Into<String>) -> &mut Problem {
        self.faulty.insert(self.top.clone());
        let mut problem = Problem::new(key, message);
        problem.value = self.document.written(node);
        problem.place(node.origin, self.document.text_of(node.origin), node.span.clone());
        if self.problems.len() < MAX_PROBLEMS {
            self.problems.push(problem);
        }
        self.problems.last_mut().expect("there is one")
    }

    fn read_units(&mut self, root: &BTreeMap<String, Node>) {
        let Some(node) = root.get("units") else { return };
        self.top = "units".into();
        if let Content::Text(text) = &node.content {
            match UnitSystem::parse(text) {
                Ok(system) => self.system = Some(system),
                Err((message, hint)) => {
                    self.report("units", node, message).allow(units::ALLOWED).suggest(hint);
                }
            }
        }
    }

    fn read_parameters(&mut self, root: &mut BTreeMap<String, Node>) {
        self.top = "parameters".into();
        let Some(Content::Table(table)) = root.get_mut("parameters").map(|n| &mut n.content) else { return };
        let written = table.clone();
        for (name, node) in &written {
            let is_name =
                name.chars().enumerate().all(|(k, c)| c == '_' || c.is_alphabetic() || k > 0 && c.is_numeric());
            if name.is_empty() || !is_name || is_reserved(name) {
                let message = if is_name { "this name has a meaning already" } else { "no name for a parameter" };
                self.report(&format!("parameters.{name}"), node, message).allow("letters, digits and _");
            }
        }
        for (name, node) in table.iter_mut() {
            let mut chain = vec![];
            // A placeholder, so that what uses a faulty parameter is not reported too.
            let value = self.parameter(name, &written, &mut chain).unwrap_or(1.0);
            self.parameters.insert(name.clone(), value);
            if matches!(node.content, Content::Text(_) | Content::Integer(_) | Content::Float(_)) {
                node.content = Content::Float(value);
            }
        }
    }

    /// The value of a parameter, which may refer to others.
    fn parameter(&mut self, name: &str, all: &BTreeMap<String, Node>, chain: &mut Vec<String>) -> Option<f64> {
        if let Some(value) = self.parameters.get(name) {
            return Some(*value);
        }
        let node = &all[name];
        let key = format!("parameters.{name}");
        if chain.iter().any(|n| n == name) || chain.len() > MAX_CHAIN {
            self.report(&key, node, "refers to itself");
            return None;
        }
        let text = match &node.content {
            Content::Integer(v) => return Some(*v as f64),
            Content::Float(v) => return Some(*v),
            Content::Text(text) => text.clone(),
            // The check of the schema reports these.
            Content::Table(_) | Content::List(_) | Content::Boolean(_) | Content::Date(_) => return None,
        };
        if let Some((value, unit)) = quantity(&text) {
            return self.converted(&key, node, value, unit, Meaning::Any);
        }
        chain.push(name.into());
        let mut values = BTreeMap::new();
        for other in names(&text).into_iter().filter(|n| all.contains_key(*n)) {
            self.used.insert(other.into());
            values.insert(other.to_string(), self.parameter(other, all, chain)?);
        }
        chain.pop();
        let others: Vec<String> = all.keys().filter(|n| *n != name).cloned().collect();
        self.evaluated(&key, node, &replaced(&text, &values), &others)
    }

    fn node(&mut self, node: &mut Node, schema: &'a Value, key: &str, outer: Meaning) {
        let mut meaning = meaning(schema).unwrap_or(outer);
        let choices = self.choices(schema);
        if let [only] = choices[..]
            && !std::ptr::eq(only, schema)
        {
            meaning = self::meaning(schema).or(self::meaning(only)).unwrap_or(outer);
        }
        match &mut node.content {
            Content::Table(table) => {
                for (name, child) in table {
                    let below = choices.iter().find_map(|s| s["properties"].get(name));
                    if let Some(below) = below {
                        self.node(child, below, &format!("{key}.{name}"), meaning);
                    }
                }
            }
            Content::List(list) => {
                if let Some(items) = choices.iter().map(|s| &s["items"]).find(|s| s.is_object()) {
                    for (k, child) in list.iter_mut().enumerate() {
                        self.node(child, items, &format!("{key}[{k}]"), meaning);
                    }
                }
            }
            Content::Text(text) => {
                let text = text.clone();
                if let Some(content) = self.text(node, &text, &choices, key, meaning) {
                    node.content = content;
                }
            }
            Content::Integer(_) | Content::Float(_) | Content::Boolean(_) | Content::Date(_) => {}
        }
    }

    /// What stands for a text where a number may be; `None` leaves it.
    fn text(&mut self, node: &Node, text: &str, choices: &[&Value], key: &str, meaning: Meaning) -> Option<Content> {
        let has = |kind: &str| choices.iter().any(|s| types(s).any(|t| t == kind));
        let is_name = |s: &&Value| s["enum"].is_array() || s["const"].is_string();
        let is_number = has("number") || has("integer");
        if !is_number || text.trim().parse::<f64>().is_ok() {
            return None;
        }
        if let Some((value, unit)) = quantity(text) {
            return Some(Content::Float(self.converted(key, node, value, unit, meaning).unwrap_or(1.0)));
        }
        let used: Vec<String> =
            names(text).into_iter().filter(|n| self.parameters.contains_key(*n)).map(String::from).collect();
        let replaced = replaced(text, &self.parameters);
        self.used.extend(used.iter().cloned());
        if has("string") && !choices.iter().any(is_name) {
            // An expression in x and y; only the parameters are settled here.
            return (!used.is_empty()).then_some(Content::Text(replaced));
        }
        // A mere word is a slip of another kind, which the check of the schema explains.
        let is_expression = !used.is_empty() || text.contains(|c: char| "+-*/^()".contains(c) || c.is_ascii_digit());
        if !is_expression && self.parameters.is_empty() {
            return None;
        }
        let all: Vec<String> = self.parameters.keys().cloned().collect();
        let value = self.evaluated(key, node, &replaced, &all).unwrap_or(1.0);
        let is_whole = !has("number") && value.fract() == 0.0 && value.abs() < 1e15;
        Some(if is_whole { Content::Integer(value as i64) } else { Content::Float(value) })
    }

    fn converted(&mut self, key: &str, node: &Node, value: f64, unit: &str, meaning: Meaning) -> Option<f64> {
        let parsed = match Unit::parse(unit) {
            Ok(parsed) => parsed,
            Err(message) => {
                self.report(key, node, message).allow(units::ALLOWED);
                return None;
            }
        };
        match meaning {
            Meaning::Any => {}
            Meaning::Of(dimension) if dimension.is_same(parsed.dimension) => {}
            Meaning::Of(dimension) => {
                let message = format!("`{unit}` is the unit of {}", parsed.dimension.words());
                self.report(key, node, message).allow(format!("{}, or a plain number", dimension.words()));
                return None;
            }
            Meaning::Unknown => {
                self.report(key, node, "no unit is due here").allow("a plain number");
                return None;
            }
        }
        match &self.system {
            Some(system) => Some(system.convert(value, parsed)),
            None => {
                // A wrong list of units is reported already.
                if !self.faulty.contains("units") {
                    self.report(key, node, "the case does not say its units")
                        .suggest("add a line such as units = \"mm, N, MPa\" at the top");
                }
                None
            }
        }
    }

    /// The value of an expression without variables.
    fn evaluated(&mut self, key: &str, node: &Node, text: &str, parameters: &[String]) -> Option<f64> {
        match Expression::parse(text).map(|e| e.constant()) {
            Ok(Some(value)) if value.is_finite() => Some(value),
            Ok(Some(value)) => {
                self.report(key, node, format!("is not finite: {value}"));
                None
            }
            Ok(None) => {
                self.report(key, node, "this number cannot depend on x, y, nx or ny");
                None
            }
            Err(bad) => {
                let problem = self.report(key, node, bad.message);
                if let Some((name, known)) = bad.unknown {
                    let known = known.into_iter().filter(|n| !["x", "y", "nx", "ny"].contains(n));
                    problem.one_of(&name, parameters.iter().map(String::as_str).chain(known));
                }
                None
            }
        }
    }

    /// The schemas one of which must hold, references resolved and `null` left out.
    fn choices(&self, schema: &'a Value) -> Vec<&'a Value> {
        if let Some(reference) = schema["$ref"].as_str() {
            let target = self.schema.pointer(reference.trim_start_matches('#'));
            return target.map_or(vec![], |s| self.choices(s));
        }
        for word in ["anyOf", "oneOf"] {
            if let Some(list) = schema[word].as_array() {
                return list.iter().filter(|s| s["type"] != "null").flat_map(|s| self.choices(s)).collect();
            }
        }
        vec![schema]
    }
}

/// What the description of a key says in brackets, such as `[stress/length]`.
fn meaning(schema: &Value) -> Option<Meaning> {
    let text = schema["description"].as_str()?;
    text.split('[').skip(1).filter_map(|s| s.split_once(']')).find_map(|(name, _)| {
        let name = name.replace('\n', " ");
        let any = name.starts_with("length per cycle /").then_some(Meaning::Any);
        any.or_else(|| Dimension::named(&name).map(Meaning::Of))
    })
}

fn types(schema: &Value) -> impl Iterator<Item = &str> {
    let list = schema["type"].as_array().into_iter().flatten().filter_map(Value::as_str);
    schema["type"].as_str().into_iter().chain(list)
}

/// A number and the unit behind it.
fn quantity(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let digits = |s: &str| s.bytes().take_while(u8::is_ascii_digit).count();
    let mut end = usize::from(text.starts_with(['+', '-']));
    let whole = digits(&text[end..]);
    end += whole;
    let mut fraction = 0;
    if text[end..].starts_with('.') {
        fraction = digits(&text[end + 1..]);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return None;
    }
    if text[end..].starts_with(['e', 'E']) {
        let sign = usize::from(text[end + 1..].starts_with(['+', '-']));
        let power = digits(&text[end + 1 + sign..]);
        end += if power > 0 { 1 + sign + power } else { 0 };
    }
    let unit = text[end..].trim_start();
    let is_unit = unit.starts_with(|c: char| c.is_alphabetic() || c == '√' || c == '(');
    // `2(a + 1)` is a slip of an expression, not of a unit.
    (is_unit && !unit.starts_with('(')).then(|| text[..end].parse().ok().map(|value| (value, unit)))?
}

/// The names in an expression, with the bytes where they stand.
fn spans(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut spans: Vec<std::ops::Range<usize>> = vec![];
    let mut is_inside = false;
    let mut before = ' ';
    for (at, c) in text.char_indices() {
        let continues = c.is_alphanumeric() || c == '_';
        if is_inside && continues {
            if let Some(span) = spans.last_mut() {
                span.end = at + c.len_utf8();
            }
        } else if (c.is_alphabetic() || c == '_') && !before.is_alphanumeric() && before != '.' {
            spans.push(at..at + c.len_utf8());
            is_inside = true;
        } else {
            is_inside = false;
        }
        before = c;
    }
    spans
}

fn names(text: &str) -> Vec<&str> {
    spans(text).into_iter().map(|s| &text[s]).collect()
}

/// The expression with values in the place of names.
fn replaced(text: &str, values: &BTreeMap<String, f64>) -> String {
    let mut result = String::new();
    let mut at = 0;
    for span in spans(text) {
        if let Some(value) = values.get(&text[span.clone()]) {
            result += &text[at..span.start];
            // The exponent keeps very large and very small numbers short.
            result += &format!("({value:e})");
            at = span.end;
        }
    }
    result + &text[at..]
}
