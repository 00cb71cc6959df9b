//! Names that say nothing, and open ends without an issue.

use super::{Findings, source::Source};
use std::path::Path;

/// Words that a name of ours must not hold.
const BANNED: [&str; 8] = ["util", "utils", "common", "helper", "helpers", "manager", "managers", "handler"];

const DEFINING: [&str; 11] = ["fn", "struct", "enum", "trait", "mod", "type", "const", "static", "union", "let", "mut"];

/// Checks the path of a file and the names that it defines.
pub fn check_names(path: &Path, source: &Source, findings: &mut Findings) {
    for part in path.with_extension("").iter() {
        report(path, 1, &part.to_string_lossy(), findings);
    }
    for (number, line) in source.code.lines().enumerate() {
        for name in defined_names(line) {
            report(path, number + 1, name, findings);
        }
    }
}

fn report(path: &Path, line: usize, name: &str, findings: &mut Findings) {
    if let Some(word) = words(name).into_iter().find(|w| BANNED.contains(&w.as_str())) {
        findings.error(path, line, format!("`{name}` says nothing: name it without `{word}`"));
    }
}

/// Names after a defining keyword or before a colon.
fn defined_names(line: &str) -> Vec<&str> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let mut names = vec![];
    let mut previous = "";
    let mut start = None;
    for (i, c) in line.char_indices().chain([(line.len(), ' ')]) {
        match (start, is_part(c)) {
            (None, true) => start = Some(i),
            (Some(s), false) => {
                let name = &line[s..i];
                let rest = line[i..].trim_start();
                let has_type = rest.starts_with(':') && !rest.starts_with("::");
                if DEFINING.contains(&previous) || has_type {
                    names.push(name);
                }
                previous = name;
                start = None;
            }
            _ => {}
        }
    }
    names
}

/// The words of a name in snake, kebab or camel case.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    for c in name.chars() {
        if !c.is_alphanumeric() || c.is_uppercase() {
            words.push(String::new());
        }
        if c.is_alphanumeric() {
            words.last_mut().expect("never empty").extend(c.to_lowercase());
        }
    }
    words
}

/// Checks that an open end names its issue, as in `TODO(#12)`.
pub fn check_open_ends<'a>(path: &Path, lines: impl IntoIterator<Item = (usize, &'a str)>, findings: &mut Findings) {
    for (number, line) in lines {
        for mark in ["TODO", "FIXME", "XXX"] {
            for (at, _) in line.match_indices(mark) {
                let after = line[at + mark.len()..].trim_start_matches([' ', '(', ':']);
                let is_issue = after.strip_prefix('#').is_some_and(|n| n.starts_with(|c: char| c.is_ascii_digit()));
                let is_quoted = line[..at].ends_with(['`', '"']);
                if !is_issue && !is_quoted {
                    findings.error(path, number, format!("`{mark}` without the number of an issue"));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_findings(path: &str, text: &str, expected: usize) {
        let mut findings = Findings::default();
        check_names(Path::new(path), &Source::new(text), &mut findings);
        assert_eq!(findings.errors.len(), expected, "{path}: {text}: {:?}", findings.errors);
    }

    #[test]
    fn empty_names_are_refused() {
        check_findings("math/utils.rs", "", 1);
        check_findings("math/mod.rs", "struct NodeManager; fn common_part() {} fn f(helper: u8) {}", 3);
        check_findings("math/mod.rs", "let utility = commonly(set_handler()); use a::util::b; // helper", 0);
    }

    #[test]
    fn open_ends_need_an_issue() {
        let mut findings = Findings::default();
        let lines = ["// TODO(#12): more", "// TODO #3", "// TODO later", "// in the form `TODO(#1)`"];
        check_open_ends(Path::new("a.rs"), lines.iter().enumerate().map(|(i, l)| (i + 1, *l)), &mut findings);
        assert_eq!(findings.errors.iter().map(|f| f.line).collect::<Vec<_>>(), [3]);
    }
}
