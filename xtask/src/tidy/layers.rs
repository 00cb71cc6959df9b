//! The layer rule: a file of the library may use only the folders below its own.

use super::{Findings, source::Source};
use std::path::Path;

/// Folders of the library, lowest first. The last two stand side by side and do not see each other.
pub const LAYERS: [&str; 15] = [
    "math",
    "geometry",
    "material",
    "exact",
    "crack",
    "model",
    "nodes",
    "approximation",
    "integration",
    "system",
    "fracture",
    "adaptivity",
    "analysis",
    "case",
    "output",
];

/// Names at the crate root that every folder may use.
const ERROR_NAMES: [&str; 3] = ["error", "Error", "Result"];

/// Checks one file; `path` is relative to the `src` folder of the library.
pub fn check(path: &Path, source: &Source, findings: &mut Findings) {
    let parts: Vec<String> = path.with_extension("").iter().map(|p| p.to_string_lossy().into_owned()).collect();
    let Some(own) = parts.first().map(String::as_str) else { return };
    if own == "lib" {
        return;
    }
    if own != "error" && !LAYERS.contains(&own) {
        findings.error(path, 1, format!("the folder `{own}` is not in the layer rule (xtask/src/tidy/layers.rs)"));
        return;
    }
    // Modules between the crate root and the file; `mod.rs` stands for its folder.
    let depth = if parts.last().is_some_and(|p| p == "mod") { parts.len() - 1 } else { parts.len() };
    for (line, target) in used_folders(&source.code_without_tests(), depth) {
        if let Some(reason) = objection(own, &target) {
            findings.error(path, line, reason);
        }
    }
}

/// Why `own` may not use `target`, if so.
fn objection(own: &str, target: &str) -> Option<String> {
    let level = |name: &str| LAYERS.iter().position(|l| *l == name);
    if own == target || ERROR_NAMES.contains(&target) {
        return None;
    }
    let Some(target_level) = level(target) else {
        return Some(format!("`crate::{target}` hides the folder it comes from: name the folder"));
    };
    if own == "error" {
        return (target != "math").then(|| format!("`error` uses only `math`, not `{target}`"));
    }
    let own_level = level(own)?;
    if own == "output" && target == "case" {
        return Some("`output` does not see `case`".into());
    }
    (target_level > own_level).then(|| format!("`{own}` lies below `{target}` and must not use it"))
}

/// Names right below the crate root that the code reaches by `crate::` or `super::`, with their lines.
fn used_folders(code: &str, depth: usize) -> Vec<(usize, String)> {
    let mut found = vec![];
    let line_of = |at: usize| code[..at].matches('\n').count() + 1;
    for prefix in ["crate", "super"] {
        for (at, _) in code.match_indices(prefix) {
            let before = code[..at].trim_end();
            if before.ends_with("::") || code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
                continue;
            }
            let mut rest = &code[at + prefix.len()..];
            let mut ups = usize::from(prefix == "super");
            let mut is_path = false;
            while let Some(tail) = rest.trim_start().strip_prefix("::") {
                is_path = true;
                rest = tail.trim_start();
                match rest.strip_prefix("super") {
                    Some(tail) if prefix == "super" && !tail.starts_with(|c: char| c.is_alphanumeric() || c == '_') => {
                        ups += 1;
                        rest = tail;
                    }
                    _ => break,
                }
            }
            if is_path && (prefix == "crate" || ups >= depth) {
                found.extend(first_names(rest).into_iter().map(|name| (line_of(at), name)));
            }
        }
    }
    found
}

/// The first name of a path, or of each path in a group `{a::b, c}`.
fn first_names(rest: &str) -> Vec<String> {
    let identifier =
        |s: &str| s.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let Some(group) = rest.strip_prefix('{') else { return vec![identifier(rest)] };
    let mut names = vec![];
    let (mut depth, mut start) = (0, 0);
    for (i, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                names.push(identifier(&group[start..i]));
                start = i + 1;
                if c == '}' {
                    break;
                }
            }
            _ => {}
        }
    }
    names.retain(|n| !n.is_empty());
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_layers(path: &str, code: &str, expected: &[&str]) {
        let mut findings = Findings::default();
        check(Path::new(path), &Source::new(code), &mut findings);
        let messages: Vec<_> = findings.errors.iter().map(|f| f.message.as_str()).collect();
        assert_eq!(messages.len(), expected.len(), "{path}: {code}: {messages:?}");
        for (message, part) in messages.iter().zip(expected) {
            assert!(message.contains(part), "{message} should contain {part}");
        }
    }

    #[test]
    fn a_folder_sees_only_what_lies_below() {
        check_layers("nodes/support.rs", "use crate::geometry::tree::BoxTree;", &[]);
        check_layers("nodes/support.rs", "use crate::nodes::Nodes; use super::Nodes;", &[]);
        check_layers("geometry/tree.rs", "use crate::crack::CrackPath;", &["`geometry` lies below `crack`"]);
        check_layers("geometry/tree.rs", "fn f() { crate::model::g() }", &["`geometry` lies below `model`"]);
        check_layers("exact/patch.rs", "use crate::{math::{Vector2, Matrix2}, model::Model};", &["below `model`"]);
        check_layers("output/vtu.rs", "use crate::case::Case;", &["does not see"]);
        check_layers("case/build.rs", "use crate::output::vtu;", &["lies below"]);
        check_layers("error.rs", "use crate::math::Vector2; use crate::crack::End;", &["uses only `math`"]);
        check_layers("crack/path.rs", "use crate::error::Result; use crate::Error;", &[]);
    }

    #[test]
    fn no_way_around() {
        check_layers("math/mod.rs", "use super::system::Dofs;", &["`math` lies below `system`"]);
        check_layers("math/cholesky.rs", "use super::super::system::Dofs;", &["`math` lies below `system`"]);
        check_layers("math/cholesky.rs", "use super::system;", &[]);
        check_layers("nodes/mod.rs", "use crate::Model;", &["name the folder"]);
        check_layers("helpers/mod.rs", "", &["not in the layer rule"]);
    }

    #[test]
    fn tests_comments_and_other_crates_are_exempt() {
        check_layers("math/mod.rs", "#[cfg(test)]\nmod tests { use crate::system::Dofs; }", &[]);
        check_layers("math/mod.rs", "// crate::system\nlet a = \"crate::system\"; pub(crate) fn f() {}", &[]);
        check_layers("math/mod.rs", "use other_crate::system; use a::crate_like;", &[]);
    }
}
