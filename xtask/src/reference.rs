//! The reference page of the case file, made from its JSON schema.
//!
//! Every object of the schema becomes a section with a table of its keys. Choices (`oneOf`) of plain words are listed in
//! the table; choices that carry keys of their own get a section too.

use serde_json::Value;
use std::collections::{BTreeMap, VecDeque};
use std::fmt::Write;

/// The page for the text of a schema, below its `head`.
///
/// # Errors
/// Says what is wrong with the schema.
pub fn page_of_schema_text(text: &str, head: &str) -> Result<String, String> {
    let schema: Value = serde_json::from_str(text).map_err(|e| format!("`riss schema` printed no JSON: {e}"))?;
    if schema["properties"].as_object().is_none() {
        return Err("the schema has no `properties`".into());
    }
    Ok(page(&schema, head))
}

/// The page for a schema, below its `head`.
pub fn page(schema: &Value, head: &str) -> String {
    let mut page = head.to_string();
    // Sections in the order in which a reader meets them, named by the first key that leads there.
    let mut sections: Vec<(String, String)> = vec![];
    let mut queue = VecDeque::from([(schema, String::new())]);
    while let Some((schema_here, path)) = queue.pop_front() {
        for (name, path) in references(schema_here, &path) {
            if sections.iter().all(|(known, _)| *known != name) {
                queue.push_back((&schema["$defs"][&name], path.clone()));
                sections.push((name, path));
            }
        }
    }
    let writer = Writer { root: schema, paths: sections.iter().cloned().collect() };
    writer.section(&mut page, "Top level", schema);
    for (name, path) in &sections {
        let definition = &schema["$defs"][name];
        if writer.needs_section(definition) {
            writer.section(&mut page, path, definition);
        }
    }
    page.replace("\n\n\n", "\n\n")
}

/// Names of the definitions that a schema refers to, each with the path of keys that leads there.
fn references(schema: &Value, path: &str) -> Vec<(String, String)> {
    if let Some(name) = definition_name(schema) {
        return vec![(name.into(), path.into())];
    }
    let mut found = vec![];
    for key in sorted_keys(schema) {
        let below = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        found.extend(references(&schema["properties"][key], &below));
    }
    for part in ["oneOf", "anyOf", "allOf", "prefixItems"] {
        found.extend(schema[part].as_array().into_iter().flatten().flat_map(|v| references(v, path)));
    }
    for part in ["items", "additionalProperties"] {
        found.extend(schema.get(part).into_iter().flat_map(|v| references(v, path)));
    }
    found
}

fn definition_name(schema: &Value) -> Option<&str> {
    schema["$ref"].as_str().and_then(|r| r.strip_prefix("#/$defs/"))
}

/// The keys of an object, required ones first, otherwise by the alphabet.
fn sorted_keys(schema: &Value) -> Vec<&String> {
    let mut keys: Vec<&String> = schema["properties"].as_object().into_iter().flat_map(|m| m.keys()).collect();
    keys.sort_by_key(|k| (!is_required(schema, k), k.as_str()));
    keys
}

fn is_required(schema: &Value, key: &str) -> bool {
    schema["required"].as_array().is_some_and(|r| r.iter().any(|v| v == key))
}

struct Writer<'a> {
    root: &'a Value,
    /// Path of keys of each definition.
    paths: BTreeMap<String, String>,
}

impl<'a> Writer<'a> {
    /// The schema that a reference points to, and the name of its definition.
    fn resolve(&self, schema: &'a Value) -> (&'a Value, Option<&'a str>) {
        match definition_name(schema) {
            Some(name) => (&self.root["$defs"][name], Some(name)),
            None => (schema, None),
        }
    }

    /// Whether a definition holds keys, so that one cell of a table cannot show it.
    fn needs_section(&self, schema: &Value) -> bool {
        schema["properties"].is_object() || variants(schema).iter().any(|v| !is_word(v) && holds_keys(v))
    }

    fn section(&self, page: &mut String, title: &str, schema: &'a Value) {
        write!(page, "\n## {title}\n").expect("a string takes all");
        let text = description(schema);
        if !text.is_empty() && title != "Top level" {
            write!(page, "\n{text}\n").expect("a string takes all");
        }
        if schema["properties"].is_object() {
            self.table(page, schema);
        }
        for variant in variants(schema).iter().filter(|_| self.needs_section(schema)) {
            self.variant(page, variant);
        }
    }

    /// One choice: a word, or an object that the choice names or describes.
    fn variant(&self, page: &mut String, variant: &'a Value) {
        let (resolved, name) = self.resolve(variant);
        let text =
            [description(variant), description(resolved)].into_iter().find(|t| !t.is_empty()).unwrap_or_default();
        if is_word(variant) {
            let words: Vec<String> = words_of(variant).iter().map(|w| format!("`{w}`")).collect();
            write!(page, "\n- {}", with_text(&words.join(", "), &text)).expect("a string takes all");
        } else if let Some(key) = only_key(variant) {
            write!(page, "\n- {}", with_text(&format!("`{key}`"), &text)).expect("a string takes all");
            let inner = &variant["properties"][key];
            let (content, content_name) = self.resolve(inner);
            match content_name {
                Some(name) if self.needs_section(content) => {
                    write!(page, ": see {}", self.link(name)).expect("a string takes all");
                }
                Some(_) if !self.allowed(inner).is_empty() => {
                    write!(page, ": {}", self.allowed(inner)).expect("a string takes all");
                }
                _ if content["properties"].is_object() => {
                    page.push_str(", with the keys\n");
                    self.table(page, content);
                }
                _ => write!(page, " (`{}`)", self.kind(inner)).expect("a string takes all"),
            }
        } else if let Some(name) = name {
            write!(page, "\n- {}", with_text(&self.link(name), &text)).expect("a string takes all");
        } else {
            write!(page, "\n- {}", with_text(&self.kind(variant), &text)).expect("a string takes all");
            if variant["properties"].is_object() {
                page.push('\n');
                self.table(page, variant);
            }
        }
        page.push('\n');
    }

    fn table(&self, page: &mut String, schema: &'a Value) {
        page.push_str("\n| key | type | default | allowed | description |\n| --- | --- | --- | --- | --- |\n");
        let properties = schema["properties"].as_object().expect("asked before");
        for key in sorted_keys(schema) {
            let property = &properties[key];
            let default = match (is_required(schema, key), property.get("default")) {
                (true, _) => "required".into(),
                (false, None | Some(Value::Null)) => String::new(),
                (false, Some(value)) => self.default_text(value, property),
            };
            let cells = [format!("`{key}`"), self.kind(property), default, self.allowed(property), self.text(property)];
            let cells: Vec<String> = cells.iter().map(|c| c.replace('|', "\\|").replace('\n', " ")).collect();
            writeln!(page, "| {} |", cells.join(" | ")).expect("a string takes all");
        }
    }

    /// A default; for a table of its own the section shows it.
    fn default_text(&self, value: &Value, property: &'a Value) -> String {
        let is_table = value.is_object() && self.resolve(without_null(property)).0["properties"].is_object();
        if is_table { "see there".into() } else { format!("`{}`", inline(value)) }
    }

    fn text(&self, property: &'a Value) -> String {
        let inner = without_null(property);
        let texts = [description(property), description(inner), description(self.resolve(inner).0)];
        texts.into_iter().find(|t| !t.is_empty()).unwrap_or_default()
    }

    /// The type of a value in words.
    fn kind(&self, schema: &'a Value) -> String {
        let schema = without_null(schema);
        let (resolved, name) = self.resolve(schema);
        if let Some(name) = name.filter(|_| self.needs_section(resolved)) {
            return self.link(name);
        }
        let list = variants(resolved);
        if !list.is_empty() {
            let mut kinds: Vec<String> = vec![];
            for kind in list.iter().map(|v| if is_word(v) { "word".into() } else { self.kind(v) }) {
                if !kinds.contains(&kind) {
                    kinds.push(kind);
                }
            }
            return kinds.join(" or ");
        }
        if !words_of(resolved).is_empty() {
            return "word".into();
        }
        match type_name(resolved) {
            Some("array") => self.list_kind(resolved),
            Some("object") => match resolved["additionalProperties"].as_object() {
                Some(_) => format!("table of {}", self.kind(&resolved["additionalProperties"])),
                None => "table".into(),
            },
            Some("string") => "text".into(),
            Some("boolean") => "true or false".into(),
            Some(name) => name.into(),
            None => "any".into(),
        }
    }

    fn list_kind(&self, schema: &'a Value) -> String {
        if let Some(items) = schema["prefixItems"].as_array() {
            let kinds: Vec<String> = items.iter().map(|i| self.kind(i)).collect();
            return format!("[{}]", kinds.join(", "));
        }
        match (schema["minItems"].as_u64(), schema["maxItems"].as_u64()) {
            (Some(n), Some(m)) if n == m => format!("{n} × {}", self.kind(&schema["items"])),
            _ => format!("list of {}", self.kind(&schema["items"])),
        }
    }

    /// A link to the section of a definition.
    fn link(&self, name: &str) -> String {
        let path = self.paths.get(name).map_or(name, String::as_str);
        format!("[{path}](#{})", path.to_lowercase().replace('.', ""))
    }

    /// Words, ranges and lengths that are allowed.
    fn allowed(&self, schema: &'a Value) -> String {
        let (resolved, _) = self.resolve(without_null(schema));
        let choices = variants(resolved);
        let words = words_of(resolved).into_iter().chain(choices.iter().flat_map(|v| words_of(v)));
        let choices = words.chain(choices.iter().filter_map(|v| only_key(v)).map(String::from));
        let mut parts: Vec<String> = choices.map(|w| format!("`{w}`")).collect();
        // A range may stand beside the reference or within it, and so may that of each item of a list.
        for (place, prefix) in [(schema, ""), (without_null(schema), ""), (resolved, ""), (&resolved["items"], "each ")]
        {
            parts.extend(
                bounds(place).map(|b| format!("{prefix}{b}")).filter(|b| !parts.contains(b)).collect::<Vec<_>>(),
            );
        }
        parts.join(", ")
    }
}

/// The range of a number or of the length of a list.
fn bounds(schema: &Value) -> impl Iterator<Item = String> + '_ {
    let keys = [
        ("minimum", "≥ ", ""),
        ("exclusiveMinimum", "> ", ""),
        ("maximum", "≤ ", ""),
        ("exclusiveMaximum", "< ", ""),
        ("minItems", "at least ", " items"),
        ("maxItems", "at most ", " items"),
    ];
    // A fixed length is part of the type.
    let is_fixed = schema["minItems"] == schema["maxItems"];
    keys.into_iter().filter_map(move |(key, before, after)| {
        let bound = schema.get(key).filter(|_| !(is_fixed && key.ends_with("Items")))?;
        Some(format!("{before}{}{after}", inline(bound)))
    })
}

/// The choices of a schema, without "nothing".
fn variants(schema: &Value) -> Vec<&Value> {
    let list = schema["oneOf"].as_array().or_else(|| schema["anyOf"].as_array());
    list.map(|l| l.iter().filter(|v| v["type"] != "null").collect()).unwrap_or_default()
}

/// The schema itself, or the only choice beside "nothing".
fn without_null(schema: &Value) -> &Value {
    match (schema.get("anyOf"), schema.get("allOf"), &variants(schema)[..]) {
        (Some(_), _, [only]) => only,
        (_, Some(all), _) if all.as_array().is_some_and(|a| a.len() == 1) => &all[0],
        _ => schema,
    }
}

/// Words that a schema allows by `const` or `enum`.
fn words_of(schema: &Value) -> Vec<String> {
    let words = schema["const"].as_str().into_iter();
    words.chain(schema["enum"].as_array().into_iter().flatten().filter_map(Value::as_str)).map(String::from).collect()
}

fn is_word(schema: &Value) -> bool {
    !words_of(schema).is_empty()
}

fn holds_keys(schema: &Value) -> bool {
    schema["properties"].is_object() || schema["$ref"].is_string()
}

/// The key of an object with exactly one key, which names the choice.
fn only_key(schema: &Value) -> Option<&str> {
    let mut keys = schema["properties"].as_object().filter(|_| schema["required"].is_array())?.keys();
    keys.next().filter(|_| keys.next().is_none()).map(String::as_str)
}

fn type_name(schema: &Value) -> Option<&str> {
    let list = schema["type"].as_array();
    schema["type"].as_str().or_else(|| list?.iter().filter_map(Value::as_str).find(|t| *t != "null"))
}

/// The description; lines of a paragraph are joined.
fn description(schema: &Value) -> String {
    let text = schema["description"].as_str().unwrap_or_default();
    let paragraphs: Vec<String> =
        text.split("\n\n").map(|p| p.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    paragraphs.join("\n\n").replace("[`", "`").replace("`]", "`")
}

fn with_text(head: &str, text: &str) -> String {
    if text.is_empty() { head.into() } else { format!("{head}: {}", text.trim_end_matches('.')) }
}

/// A value as it stands in a TOML file, on one line.
fn inline(value: &Value) -> String {
    match value {
        Value::Object(map) => {
            let given = map.iter().filter(|(_, v)| !v.is_null());
            let mut pairs: Vec<String> = given.map(|(k, v)| format!("{k} = {}", inline(v))).collect();
            pairs.sort();
            if pairs.is_empty() { "{}".into() } else { format!("{{ {} }}", pairs.join(", ")) }
        }
        Value::Array(items) => format!("[{}]", items.iter().map(inline).collect::<Vec<_>>().join(", ")),
        Value::Number(n) => match n.as_f64() {
            Some(v) if v.fract() == 0.0 && v.abs() < 1e15 => format!("{v}"),
            _ => n.to_string(),
        },
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn schema() -> Value {
        json!({
            "type": "object",
            "required": ["title"],
            "properties": {
                "approximation": { "$ref": "#/$defs/Approximation", "description": "Shape functions." },
                "constraints": { "$ref": "#/$defs/Constraints", "default": { "nitsche": { "factor": 10.0 } } },
                "radii": { "type": ["array", "null"], "items": { "type": "number", "exclusiveMinimum": 0.0 }, "minItems": 3 },
                "title": { "type": "string", "description": "Name of\nthe case." },
            },
            "$defs": {
                "Approximation": { "type": "object", "description": "Moving least squares.", "properties": {
                    "basis": { "$ref": "#/$defs/Basis", "default": "linear" },
                    "dilation": { "type": ["number", "null"], "minimum": 1.0, "maximum": 10.0, "default": null },
                } },
                "Basis": { "oneOf": [{ "const": "linear", "description": "`[1, x, y]`." }, { "const": "quadratic" }] },
                "Constraints": { "oneOf": [
                    { "type": "object", "description": "Nitsche's method.", "required": ["nitsche"], "properties": {
                        "nitsche": { "type": "object", "properties": {
                            "factor": { "type": "number", "minimum": 0.0, "default": 10.0 } } } } },
                    { "type": "string", "const": "lagrange-multipliers", "description": "Multipliers." },
                ] },
            },
        })
    }

    #[test]
    fn every_key_has_its_row() {
        let page = page(&schema(), "# Keys\n");
        for row in [
            "| `title` | text | required |  | Name of the case. |",
            "| `approximation` | [approximation](#approximation) |  |  | Shape functions. |",
            "| `basis` | word | `\"linear\"` | `linear`, `quadratic` |  |",
            "| `dilation` | number |  | ≥ 1, ≤ 10 |  |",
            "| `radii` | list of number |  | at least 3 items, each > 0 |  |",
            "| `factor` | number | `10` | ≥ 0 |  |",
            "| `constraints` | [constraints](#constraints) | `{ nitsche = { factor = 10 } }` | \
             `lagrange-multipliers`, `nitsche` |  |",
            "- `nitsche`: Nitsche's method, with the keys",
            "- `lagrange-multipliers`: Multipliers",
        ] {
            assert!(page.contains(row), "{row} is missing in\n{page}");
        }
        let order: Vec<_> =
            ["## Top level", "## approximation", "## constraints"].iter().map(|t| page.find(t)).collect();
        assert!(order.is_sorted() && order[0].is_some());
    }

    #[test]
    fn a_schema_without_keys_is_refused() {
        assert!(page_of_schema_text("", "").is_err() && page_of_schema_text("{}", "").is_err());
    }
}
