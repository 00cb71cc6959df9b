//! The case file as a tree of values that know where they were written; overrides are set in it.

use super::problem::{MAX_PROBLEMS, Origin, Problem};
use serde::de::DeserializeOwned;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// Tables with one key, which names a kind: an override with another kind replaces it.
const CHOICES: [&str; 10] = [
    "geometry",
    "exact",
    "constraints",
    "nodes.layout",
    "integration.scheme",
    "growth.criterion",
    "growth.law",
    "growth.law.fatigue.rate",
    "growth.law.fatigue.spectrum",
    "growth.control",
];

/// A value with its place.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub content: Content,
    pub origin: Origin,
    /// Bytes of the value.
    pub span: Range<usize>,
    /// Bytes of its key; those of the value for list elements.
    pub key_span: Range<usize>,
}

#[derive(Clone, Debug)]
pub(super) enum Content {
    Table(BTreeMap<String, Node>),
    List(Vec<Node>),
    Text(String),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    Date(String),
}

impl Node {
    /// What it is, for messages.
    pub fn kind(&self) -> &'static str {
        match self.content {
            Content::Table(_) => "a table",
            Content::List(_) => "a list",
            Content::Text(_) => "text",
            Content::Integer(_) | Content::Float(_) => "a number",
            Content::Boolean(_) => "true or false",
            Content::Date(_) => "a date",
        }
    }

    fn to_toml(&self) -> toml::Value {
        match &self.content {
            Content::Table(t) => toml::Value::Table(t.iter().map(|(k, v)| (k.clone(), v.to_toml())).collect()),
            Content::List(l) => toml::Value::Array(l.iter().map(Self::to_toml).collect()),
            Content::Text(s) | Content::Date(s) => toml::Value::String(s.clone()),
            Content::Integer(i) => toml::Value::Integer(*i),
            Content::Float(v) => toml::Value::Float(*v),
            Content::Boolean(b) => toml::Value::Boolean(*b),
        }
    }
}

/// The whole case as written.
pub(super) struct Document {
    pub root: BTreeMap<String, Node>,
    pub text: String,
    pub overrides: Vec<String>,
}

impl Document {
    /// Parses a case and sets the overrides; what cannot be parsed is reported and left out.
    pub fn parse(text: &str, overrides: &[String], problems: &mut Vec<Problem>) -> Self {
        let (table, errors) = DeTable::parse_recoverable(text);
        for error in errors.into_iter().take(MAX_PROBLEMS) {
            let mut problem = Problem::new("", error.message().replace('\n', ", "));
            problem.place(Origin::File, text, error.span().unwrap_or(0..0));
            problems.push(problem);
        }
        let mut document = Self {
            root: convert_table(table.into_inner(), Origin::File),
            text: text.into(),
            overrides: overrides.to_vec(),
        };
        for (index, text) in overrides.iter().enumerate() {
            if let Err(mut problem) = document.set(index, text) {
                problem.origin = Origin::Override(index);
                problems.push(*problem);
            }
        }
        document
    }

    /// The value at a key path such as `crack[0].path[1]`, or the last one on the way to it.
    pub fn find(&self, key: &str) -> Option<&Node> {
        let mut steps = steps(key);
        let mut node = self.root.get(steps.next()?)?;
        for step in steps {
            let next = match &node.content {
                Content::Table(table) => table.get(step),
                Content::List(list) => index(list, step).map(|k| &list[k]),
                _ => None,
            };
            match next {
                Some(next) => node = next,
                None => return Some(node),
            }
        }
        Some(node)
    }

    /// Whether there is a value at a key path.
    pub fn says(&self, key: &str) -> bool {
        let mut steps = steps(key);
        let Some(first) = steps.next() else { return false };
        let mut node = self.root.get(first);
        for step in steps {
            node = match node.map(|n| &n.content) {
                Some(Content::Table(table)) => table.get(step),
                _ => None,
            };
        }
        node.is_some()
    }

    /// Puts a problem at the value of its key, or at the table that lacks it.
    pub fn locate(&self, problem: &mut Problem) {
        let Some(node) = self.find(&problem.key) else { return };
        let text = self.text_of(node.origin);
        let span = match node.content {
            Content::Table(_) => node.key_span.clone(),
            _ => node.span.clone(),
        };
        if problem.value.is_none() {
            problem.value = self.written(node);
        }
        problem.place(node.origin, text, span);
    }

    /// The text of a value as it stands in the file, if it is short.
    pub fn written(&self, node: &Node) -> Option<String> {
        let is_table = |n: &Node| matches!(n.content, Content::Table(_));
        if is_table(node) || matches!(&node.content, Content::List(list) if list.iter().any(is_table)) {
            return None;
        }
        let text = self.text_of(node.origin).get(node.span.clone())?;
        (!text.is_empty() && text.chars().count() <= 60 && !text.contains('\n')).then(|| text.to_string())
    }

    /// The text that an origin stands for.
    pub fn text_of(&self, origin: Origin) -> &str {
        match origin {
            Origin::File => &self.text,
            Origin::Override(index) => &self.overrides[index],
        }
    }

    /// One top-level value as plain TOML.
    pub fn to_toml(&self) -> toml::Table {
        self.root.iter().map(|(k, v)| (k.clone(), v.to_toml())).collect()
    }

    /// The case without its faulty sections; placeholders stand for required ones.
    pub fn without<T: DeserializeOwned>(
        &self,
        faulty: &BTreeSet<String>,
        placeholders: &[(&str, &str)],
        problems: &mut Vec<Problem>,
    ) -> Option<T> {
        let mut table = self.to_toml();
        for key in faulty {
            table.remove(key);
            if let Some((_, text)) = placeholders.iter().find(|(name, _)| name == key) {
                table.insert(key.clone(), toml::Value::Table(text.parse().expect("placeholders are TOML")));
            }
        }
        match table.try_into() {
            Ok(file) => Some(file),
            // The schema check has seen the same types, so this is a last resort.
            Err(e) => {
                problems.push(Problem::new("", e.to_string().trim_end().replace('\n', ", ")));
                None
            }
        }
    }

    /// Adds a value where there is none yet; in messages it stands at the value of `place`.
    pub fn add(&mut self, path: &[&str], value: &toml::Value, place: &str) {
        let (origin, at) = self.find(place).map_or((Origin::File, 0), |n| (n.origin, n.span.start));
        let is_there = match path {
            [section] => self.root.contains_key(*section),
            [section, key] => match self.root.get(*section).map(|n| &n.content) {
                Some(Content::Table(table)) => table.contains_key(*key),
                Some(_) => true,
                None => false,
            },
            _ => true,
        };
        if !is_there {
            // Whatever is in the way is reported by the check of the schema.
            let _ = insert(&mut self.root, path, added(value, origin, at));
        }
    }

    /// Removes the kinds that give way to the one in `path`.
    fn make_room(&mut self, path: &[&str]) {
        for choice in CHOICES {
            let n = choice.split('.').count();
            if path.len() > n
                && path[..n].join(".") == choice
                && let Some(table) = kinds(&mut self.root, choice)
            {
                table.retain(|name, _| name == path[n]);
            }
        }
    }

    fn set(&mut self, index: usize, text: &str) -> Result<(), Box<Problem>> {
        let bad = |message: &str| Box::new(Problem::new("", message));
        let Some((key, value)) = text.split_once('=') else {
            let mut problem = bad("an override has the form key=value");
            problem.suggest("for example --set material.young=210e9");
            return Err(problem);
        };
        let path: Vec<&str> = steps(key.trim()).collect();
        if path.is_empty() || path.len() > 20 || path.iter().any(|step| step.is_empty()) {
            return Err(bad("the key of an override is a dotted path such as material.young or crack[0].path"));
        }
        let offset = text.len() - value.len();
        let mut node = match DeValue::parse(value.trim()) {
            Ok(parsed) => convert(parsed.into_inner(), 0..0, Origin::Override(index)),
            // Whatever is no TOML value is text, so that names need no quotes.
            Err(_) => Node {
                content: Content::Text(value.trim().into()),
                origin: Origin::Override(index),
                span: 0..0,
                key_span: 0..0,
            },
        };
        place_all(&mut node, &(offset..text.len()), &(0..offset - 1));
        // A parameter by its name alone.
        let is_parameter = |name: &str| matches!(self.root.get("parameters").map(|n| &n.content), Some(Content::Table(t)) if t.contains_key(name));
        let path = if path.len() == 1 && is_parameter(path[0]) { vec!["parameters", path[0]] } else { path };
        self.make_room(&path);
        insert(&mut self.root, &path, node).map_err(|message| bad(&message))
    }
}

/// The table of one of the [`CHOICES`], if there is one.
fn kinds<'d>(table: &'d mut BTreeMap<String, Node>, choice: &str) -> Option<&'d mut BTreeMap<String, Node>> {
    let mut table = table;
    for step in choice.split('.') {
        match &mut table.get_mut(step)?.content {
            Content::Table(inner) => table = inner,
            _ => return None,
        }
    }
    Some(table)
}

/// The steps of a key path: names and list indices.
fn steps(key: &str) -> impl Iterator<Item = &str> {
    key.split(['.', '[']).map(|step| step.trim_end_matches(']'))
}

fn insert(table: &mut BTreeMap<String, Node>, path: &[&str], value: Node) -> Result<(), String> {
    let (first, rest) = (path[0], &path[1..]);
    if rest.is_empty() {
        table.insert(first.into(), value);
        return Ok(());
    }
    let blank = Node { content: Content::Table(BTreeMap::new()), ..value.clone() };
    insert_below(table.entry(first.into()).or_insert(blank), first, rest, value)
}

fn insert_below(node: &mut Node, name: &str, rest: &[&str], value: Node) -> Result<(), String> {
    match &mut node.content {
        Content::Table(table) => insert(table, rest, value),
        Content::List(list) => {
            let n = list.len();
            let Some(element) = index(list, rest[0]).map(|k| &mut list[k]) else {
                return Err(format!(
                    "`{name}` is a list of {n}; the step after it is an index from 0 or the `name` of an element, not `{}`",
                    rest[0]
                ));
            };
            if rest.len() == 1 {
                *element = value;
                return Ok(());
            }
            insert_below(element, rest[0], &rest[1..], value)
        }
        // A value such as "lagrange-multipliers" gives way to a table such as penalty.factor.
        _ => {
            let mut table = BTreeMap::new();
            insert(&mut table, rest, value.clone())?;
            *node = Node { content: Content::Table(table), ..value };
            Ok(())
        }
    }
}

/// Which element of a list a step of a key path means: by index, or by its `name`.
fn index(list: &[Node], step: &str) -> Option<usize> {
    if let Ok(k) = step.parse::<usize>() {
        return (k < list.len()).then_some(k);
    }
    let is_meant = |node: &Node| match &node.content {
        Content::Table(table) => {
            matches!(table.get("name").map(|n| &n.content), Some(Content::Text(name)) if name == step)
        }
        _ => false,
    };
    list.iter().position(is_meant)
}

/// A value that stands nowhere in the text, placed at one byte of it.
fn added(value: &toml::Value, origin: Origin, at: usize) -> Node {
    let content = match value {
        toml::Value::String(s) => Content::Text(s.clone()),
        toml::Value::Integer(i) => Content::Integer(*i),
        toml::Value::Float(v) => Content::Float(*v),
        toml::Value::Boolean(b) => Content::Boolean(*b),
        toml::Value::Datetime(d) => Content::Date(d.to_string()),
        toml::Value::Array(list) => Content::List(list.iter().map(|v| added(v, origin, at)).collect()),
        toml::Value::Table(table) => {
            Content::Table(table.iter().map(|(k, v)| (k.clone(), added(v, origin, at))).collect())
        }
    };
    Node { content, origin, span: at..at, key_span: at..at }
}

fn place_all(node: &mut Node, span: &Range<usize>, key_span: &Range<usize>) {
    node.span = span.clone();
    node.key_span = key_span.clone();
    match &mut node.content {
        Content::Table(table) => table.values_mut().for_each(|n| place_all(n, span, key_span)),
        Content::List(list) => list.iter_mut().for_each(|n| place_all(n, span, span)),
        _ => {}
    }
}

fn convert_table(table: DeTable<'_>, origin: Origin) -> BTreeMap<String, Node> {
    let mut nodes = BTreeMap::new();
    for (key, value) in table {
        let key_span = key.span();
        let span = value.span();
        let mut node = convert(value.into_inner(), span, origin);
        node.key_span = key_span;
        nodes.insert(key.into_inner().into_owned(), node);
    }
    nodes
}

fn convert(value: DeValue<'_>, span: Range<usize>, origin: Origin) -> Node {
    let content = match value {
        DeValue::String(s) => Content::Text(s.into_owned()),
        DeValue::Integer(i) => match i64::from_str_radix(i.as_str(), i.radix()) {
            Ok(value) => Content::Integer(value),
            // Too long for an integer, but still a number.
            Err(_) => Content::Float(i.as_str().parse().unwrap_or(f64::NAN)),
        },
        DeValue::Float(v) => Content::Float(v.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(b) => Content::Boolean(b),
        DeValue::Datetime(d) => Content::Date(d.to_string()),
        DeValue::Array(list) => Content::List(
            list.into_iter()
                .map(|v| {
                    let span = v.span();
                    convert(v.into_inner(), span, origin)
                })
                .collect(),
        ),
        DeValue::Table(table) => Content::Table(convert_table(table, origin)),
    };
    Node { content, origin, key_span: span.clone(), span }
}

#[cfg(test)]
mod tests;
