//! All settings of a case with their defaults, for the reader of a report.

use super::{Case, SolidCase};
use crate::analysis::{SolidGrowthSettings, SolidSettings};
use serde_json::{Value, json};

impl Case {
    /// Key and value of every setting, defaults filled in; `automatic` is what the analysis chooses itself.
    pub fn effective_settings(&self) -> Vec<[String; 2]> {
        let s = &self.settings;
        let mut groups = vec![
            ("material.thickness", json!(self.model.thickness)),
            ("nodes", json!(s.nodes)),
            ("approximation", json!(s.approximation)),
            ("integration", json!(s.integration)),
            ("constraints", json!(s.constraints)),
            ("solver", json!(s.solver)),
            ("fracture", json!(s.fracture)),
        ];
        groups.extend(s.accuracy.as_ref().map(|accuracy| ("accuracy", json!(accuracy))));
        groups.extend(self.growth.as_ref().map(|growth| ("growth", json!(growth))));
        groups.extend(self.loading.as_ref().map(|loading| ("loading", json!(loading))));
        groups.push(("output", json!(self.output)));
        let mut rows = vec![];
        groups.iter().for_each(|(key, value)| add_rows(key, value, &mut rows));
        rows
    }
}

impl SolidCase {
    /// Key and value of every setting, defaults filled in.
    pub fn effective_settings(&self) -> Vec<[String; 2]> {
        let SolidSettings { spacing, nodes_on_fronts, collocation, points_on_front } = &self.settings;
        let mut groups = vec![
            ("nodes.spacing", json!(spacing.largest())),
            ("nodes.growth", json!(spacing.growth())),
            ("nodes.on_fronts", json!(nodes_on_fronts)),
            ("collocation", json!(collocation)),
            ("fracture.points", json!(points_on_front)),
        ];
        if let Some(SolidGrowthSettings { steps, increment, criterion, spacing: _ }) = &self.growth {
            groups.push(("growth", json!({ "steps": steps, "increment": increment, "criterion": criterion })));
        }
        groups.extend(self.loading.as_ref().map(|loading| ("loading", json!(loading))));
        let mut rows = vec![];
        groups.iter().for_each(|(key, value)| add_rows(key, value, &mut rows));
        rows
    }
}

fn add_rows(key: &str, value: &Value, rows: &mut Vec<[String; 2]>) {
    let mut push = |text: String| rows.push([key.to_string(), text]);
    match value {
        Value::Object(table) if !table.is_empty() => {
            table.iter().for_each(|(name, value)| add_rows(&format!("{key}.{name}"), value, rows));
        }
        Value::Null => push("automatic".into()),
        Value::String(text) => push(text.clone()),
        // Long lists stand in the case file.
        Value::Array(list) if list.len() > 20 => push(format!("{} values", list.len())),
        Value::Object(_) | Value::Array(_) | Value::Bool(_) | Value::Number(_) => push(value.to_string()),
    }
}
