//! Checks a document against the JSON Schema of the case file: names, types, required keys and plain ranges.
//!
//! Reports everything that is wrong, where a deserializer would stop at the first mistake.

use super::document::{Content, Document, Node};
use super::problem::{MAX_PROBLEMS, Problem};
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};

/// Reports what contradicts `schema`; returns the top-level keys that are faulty or missing.
pub(super) fn check(document: &Document, schema: &Value, problems: &mut Vec<Problem>) -> BTreeSet<String> {
    let mut checker = Checker { document, root: schema, problems };
    let mut faulty = BTreeSet::new();
    let properties = schema["properties"].as_object().expect("the case is an object");
    for (key, node) in &document.root {
        let before = checker.problems.len();
        match properties.get(key) {
            Some(schema) => checker.node(node, schema, key),
            None => checker.unknown_key(key, key, node, properties),
        }
        if checker.problems.len() > before {
            faulty.insert(key.clone());
        }
    }
    for key in strings(&schema["required"]) {
        if !document.root.contains_key(key) {
            faulty.insert(key.into());
        }
        if !document.root.contains_key(key) && !checker.is_suggested(key, 0) {
            let mut problem = Problem::new(key, "missing");
            problem.suggest(checker.about(&properties[key]));
            checker.problems.push(problem);
        }
    }
    faulty
}

struct Checker<'a> {
    document: &'a Document,
    root: &'a Value,
    problems: &'a mut Vec<Problem>,
}

impl<'a> Checker<'a> {
    fn node(&mut self, node: &Node, schema: &'a Value, key: &str) {
        if self.problems.len() >= MAX_PROBLEMS {
            return;
        }
        let choices = self.choices(schema);
        let fitting: Vec<&'a Value> = choices.iter().copied().filter(|s| fits(node, s)).collect();
        if fitting.is_empty() {
            let message = format!("expected {}, found {}", expected(&choices), node.kind());
            let is_list_of_tables = choices.iter().any(|s| self.is_table(&s["items"]));
            let problem = self.report(key, node, message);
            if is_list_of_tables && matches!(node.content, Content::Table(_)) {
                problem.suggest(format!("write [[{key}]], there may be several"));
            }
            return;
        }
        match &node.content {
            Content::Table(table) if self.is_tagged(schema) => self.tagged(node, table, &fitting, key),
            Content::Table(table) => self.table(node, table, fitting[0], key),
            Content::List(list) => self.list(node, list, fitting[0], key),
            Content::Text(text) => self.text(node, text, &choices, key),
            Content::Integer(v) => self.number(node, *v as f64, fitting[0], key),
            Content::Float(v) => self.number(node, *v, fitting[0], key),
            Content::Boolean(_) | Content::Date(_) => {}
        }
    }

    fn resolve(&self, reference: &str) -> &'a Value {
        self.root.pointer(reference.trim_start_matches('#')).expect("the schema is closed")
    }

    /// Whether tables are written as one key that names the kind.
    fn is_tagged(&self, schema: &'a Value) -> bool {
        match (schema["$ref"].as_str(), schema["anyOf"].as_array()) {
            (Some(reference), _) => self.is_tagged(self.resolve(reference)),
            (None, Some(list)) => list.iter().any(|s| self.is_tagged(s)),
            (None, None) => schema["oneOf"].is_array(),
        }
    }

    fn is_table(&self, schema: &'a Value) -> bool {
        schema.is_object() && self.choices(schema).iter().any(|s| s["type"] == "object")
    }

    /// The schemas one of which must hold, references resolved and `null` left out.
    fn choices(&self, schema: &'a Value) -> Vec<&'a Value> {
        if let Some(reference) = schema["$ref"].as_str() {
            return self.choices(self.resolve(reference));
        }
        for word in ["anyOf", "oneOf"] {
            if let Some(list) = schema[word].as_array() {
                return list.iter().filter(|s| s["type"] != "null").flat_map(|s| self.choices(s)).collect();
            }
        }
        vec![schema]
    }

    fn table(&mut self, node: &Node, table: &BTreeMap<String, Node>, schema: &'a Value, key: &str) {
        let Some(properties) = schema["properties"].as_object() else {
            // A table of values under names that the author chooses.
            for (name, child) in table.iter().filter(|_| schema["additionalProperties"].is_object()) {
                self.node(child, &schema["additionalProperties"], &join(key, name));
            }
            return;
        };
        let start = self.problems.len();
        for (name, child) in table {
            let path = join(key, name);
            match properties.get(name) {
                Some(schema) => self.node(child, schema, &path),
                None => self.unknown_key(&path, name, child, properties),
            }
        }
        for name in strings(&schema["required"]) {
            if !table.contains_key(name) && !self.is_suggested(name, start) {
                let about = self.about(&properties[name]);
                let mut problem = Problem::new(join(key, name), "missing");
                problem.suggest(about);
                problem.place(node.origin, self.document.text_of(node.origin), node.key_span.clone());
                self.problems.push(problem);
            }
        }
    }

    /// A choice written as a table with one key.
    fn tagged(&mut self, node: &Node, table: &BTreeMap<String, Node>, choices: &[&'a Value], key: &str) {
        let tag = |s: &&'a Value| strings(&s["required"]).next();
        let names: Vec<&str> = choices.iter().filter_map(tag).collect();
        let mut known = vec![];
        for (name, child) in table {
            match choices.iter().find(|s| tag(s) == Some(name)) {
                Some(choice) => {
                    known.push(format!("`{name}`"));
                    self.node(child, &choice["properties"][name], &join(key, name));
                }
                None => {
                    let message = format!("unknown kind of {}", last(key));
                    self.place_key(&join(key, name), child, message).one_of(name, names.iter().copied());
                }
            }
        }
        if known.len() > 1 {
            let message = format!("takes one of {}, found {}", names.join(", "), known.join(" and "));
            self.place_key(key, node, message);
        } else if table.is_empty() {
            self.place_key(key, node, "missing".into()).one_of("", names.iter().copied());
        }
    }

    fn list(&mut self, node: &Node, list: &[Node], schema: &'a Value, key: &str) {
        let (least, most) = (schema["minItems"].as_u64(), schema["maxItems"].as_u64());
        let n = list.len() as u64;
        if least.is_some_and(|least| n < least) || most.is_some_and(|most| n > most) {
            let message = format!("expected {}, found {n}", expected(&[schema]));
            self.report(key, node, message);
            return;
        }
        if schema["items"].is_object() {
            for (k, child) in list.iter().enumerate() {
                self.node(child, &schema["items"], &format!("{key}[{k}]"));
            }
        }
    }

    fn text(&mut self, node: &Node, text: &str, choices: &[&'a Value], key: &str) {
        let names: Vec<&str> = choices.iter().flat_map(|s| names_of(s)).collect();
        if names.is_empty() || names.contains(&text) {
            return;
        }
        let tables: Vec<&str> = choices.iter().flat_map(|s| strings(&s["required"])).collect();
        if tables.contains(&text) {
            self.report(key, node, "a table, not a name".into()).suggest(format!("write [{key}.{text}]"));
            return;
        }
        let is_solid = key == "method" && text == "collocation";
        let message = if is_solid { "only `riss run` and `riss check` take solids" } else { "unknown name" };
        self.report(key, node, message.into()).one_of(text, names.into_iter().chain(tables));
    }

    fn number(&mut self, node: &Node, value: f64, schema: &'a Value, key: &str) {
        if !value.is_finite() {
            self.report(key, node, "must be a finite number".into());
            return;
        }
        let (least, most) = (schema["minimum"].as_f64(), schema["maximum"].as_f64());
        if least.is_some_and(|least| value < least) || most.is_some_and(|most| value > most) {
            let allowed = match (least, most) {
                (Some(least), Some(most)) => format!("{least} to {most}"),
                (Some(least), None) => format!("{least} or more"),
                (None, most) => format!("{} or less", most.unwrap_or(0.0)),
            };
            self.report(key, node, "out of range".into()).allow(allowed);
        }
    }

    fn unknown_key(&mut self, path: &str, name: &str, node: &Node, properties: &Map<String, Value>) {
        if self.problems.len() >= MAX_PROBLEMS {
            return;
        }
        let names = properties.keys().map(String::as_str);
        self.place_key(path, node, "unknown key".into()).one_of(name, names);
    }

    /// Whether an unknown key among the problems from `start` should have been `name`.
    fn is_suggested(&self, name: &str, start: usize) -> bool {
        let suggestion = Some(format!("did you mean `{name}`?"));
        self.problems[start..].iter().any(|p| p.suggestion == suggestion)
    }

    fn report(&mut self, key: &str, node: &Node, message: String) -> &mut Problem {
        let value = self.document.written(node);
        let span = if value.is_some() { node.span.clone() } else { node.key_span.clone() };
        let mut problem = Problem::new(key, message);
        problem.value = value;
        problem.place(node.origin, self.document.text_of(node.origin), span);
        self.problems.push(problem);
        self.problems.last_mut().expect("pushed above")
    }

    fn place_key(&mut self, key: &str, node: &Node, message: String) -> &mut Problem {
        let mut problem = Problem::new(key, message);
        problem.place(node.origin, self.document.text_of(node.origin), node.key_span.clone());
        self.problems.push(problem);
        self.problems.last_mut().expect("pushed above")
    }

    /// What a key is for: the first line of its description, and the names of a choice.
    fn about(&self, schema: &'a Value) -> String {
        let choices = self.choices(schema);
        let names: Vec<&str> =
            choices.iter().flat_map(|s| names_of(s).into_iter().chain(strings(&s["required"]))).collect();
        let line = schema["description"].as_str().unwrap_or("").lines().next().unwrap_or("").to_string();
        if choices.len() > 1 { format!("{line} One of {}.", names.join(", ")) } else { line }
    }
}

/// Whether a value has the type that a schema asks for.
fn fits(node: &Node, schema: &Value) -> bool {
    let kind = |name: &str| match &schema["type"] {
        Value::String(t) => t == name,
        Value::Array(list) => list.iter().any(|t| t == name),
        _ => false,
    };
    match &node.content {
        Content::Table(_) => kind("object"),
        Content::List(_) => kind("array"),
        Content::Text(_) => kind("string"),
        Content::Integer(_) => kind("number") || kind("integer"),
        Content::Float(_) => kind("number"),
        Content::Boolean(_) => kind("boolean"),
        Content::Date(_) => false,
    }
}

/// The fixed texts a schema allows.
fn names_of(schema: &Value) -> Vec<&str> {
    strings(&schema["enum"]).chain(schema["const"].as_str()).collect()
}

fn strings(value: &Value) -> impl Iterator<Item = &str> {
    value.as_array().into_iter().flatten().filter_map(Value::as_str)
}

/// What any of the schemas asks for, in words.
fn expected(choices: &[&Value]) -> String {
    let mut words: Vec<String> = vec![];
    for schema in choices {
        let kind = match &schema["type"] {
            Value::Array(list) => list.iter().find(|t| *t != "null").and_then(Value::as_str),
            other => other.as_str(),
        };
        let word = match kind.unwrap_or("") {
            "number" => "a number".to_string(),
            "integer" => "a whole number".into(),
            "boolean" => "true or false".into(),
            "object" => "a table".into(),
            "array" => match (schema["minItems"].as_u64(), schema["maxItems"].as_u64()) {
                (Some(a), Some(b)) if a == b => format!("a list of {a}{}", plural(&schema["items"])),
                (None, Some(most)) => format!("a list of up to {most}"),
                _ => "a list".into(),
            },
            _ if !names_of(schema).is_empty() => "a name".into(),
            _ => "text".into(),
        };
        if !words.contains(&word) {
            words.push(word);
        }
    }
    words.join(" or ")
}

fn plural(items: &Value) -> &'static str {
    match items["type"].as_str() {
        Some("number") => " numbers",
        Some("array") => " lists",
        _ => "",
    }
}

fn join(key: &str, name: &str) -> String {
    let is_bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if is_bare { format!("{key}.{name}") } else { format!("{key}.{name:?}") }
}

fn last(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or(key)
}
