//! What the workspace is built on: every crate under a licence that `deny.toml` allows, from its registry, and every direct
//! dependency with a reason in the book.
//!
//! `cargo deny` asks more, but has to be installed; this needs cargo alone.

use super::Findings;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

const POLICY: &str = "deny.toml";
const REASONS: &str = "docs/src/reference/dependencies.md";
/// Workspaces of their own: only their manifests are looked at.
const OTHER_MANIFESTS: [&str; 2] = ["crates/riss-py/Cargo.toml", "fuzz/Cargo.toml"];

/// Reports what the policy or the book does not cover.
pub fn check(root: &Path, findings: &mut Findings) {
    let text = |file: &str| std::fs::read_to_string(root.join(file)).unwrap_or_default();
    let Ok(policy) = text(POLICY).parse::<toml::Table>() else {
        return findings.error(Path::new(POLICY), 1, "is missing, or no TOML".into());
    };
    match metadata(root) {
        Ok(metadata) => check_metadata(&metadata, &policy, &text(REASONS), findings),
        Err(reason) => findings.error(Path::new("Cargo.toml"), 1, format!("cargo metadata failed: {reason}")),
    }
    for manifest in OTHER_MANIFESTS {
        let Ok(table) = text(manifest).parse::<toml::Table>() else { continue };
        let names =
            table.get("dependencies").and_then(toml::Value::as_table).into_iter().flat_map(|t| t.keys().cloned());
        check_reasons(names.filter(|n| !n.starts_with("riss")).collect(), &text(REASONS), findings);
    }
}

/// What cargo knows about all crates that are built on this machine.
fn metadata(root: &Path) -> Result<Value, String> {
    let host = Command::new("rustc").args(["-vV"]).output().map_err(|e| e.to_string())?;
    let host = String::from_utf8_lossy(&host.stdout).lines().find_map(|l| l.strip_prefix("host: ").map(String::from));
    let host = host.ok_or("rustc names no host")?;
    let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
    let arguments = ["metadata", "--format-version", "1", "--locked", "--filter-platform", &host];
    let output = Command::new(cargo).args(arguments).current_dir(root).output().map_err(|e| e.to_string())?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).trim().into());
    }
    serde_json::from_slice(&output.stdout).map_err(|e| e.to_string())
}

fn check_metadata(metadata: &Value, policy: &toml::Table, reasons: &str, findings: &mut Findings) {
    let strings = |value: Option<&toml::Value>| -> BTreeSet<String> {
        let list = value.and_then(toml::Value::as_array).into_iter().flatten();
        list.filter_map(toml::Value::as_str).map(String::from).collect()
    };
    let section = |name: &str, key: &str| strings(policy.get(name).and_then(|s| s.get(key)));
    let (allowed, registries) = (section("licenses", "allow"), section("sources", "allow-registry"));
    let packages = || metadata["packages"].as_array().into_iter().flatten();
    for package in packages() {
        let name = package["name"].as_str().unwrap_or_default();
        let licence = package["license"].as_str().unwrap_or("none");
        if !is_allowed(licence, &allowed) {
            findings.error(Path::new(POLICY), 1, format!("`{name}` has the licence {licence}, which is not allowed"));
        }
        let source = package["source"].as_str();
        if source.is_some_and(|s| !registries.contains(s.trim_start_matches("registry+"))) {
            let source = source.unwrap_or_default();
            findings.error(Path::new(POLICY), 1, format!("`{name}` comes from {source}, which is not allowed"));
        }
    }
    let own = packages().filter(|p| p["source"].is_null());
    let direct = own.flat_map(|p| p["dependencies"].as_array().into_iter().flatten());
    let names = direct.filter(|d| !d["source"].is_null()).filter_map(|d| d["name"].as_str()).map(String::from);
    check_reasons(names.collect(), reasons, findings);
}

fn check_reasons(names: BTreeSet<String>, reasons: &str, findings: &mut Findings) {
    for name in names {
        let has_reason = reasons.lines().any(|l| {
            let reason = l.strip_prefix(&format!("| `{name}` | ")).map(|r| r.trim_end_matches(['|', ' ']));
            reason.is_some_and(|r| !r.is_empty())
        });
        if !has_reason {
            findings.error(Path::new(REASONS), 1, format!("says no reason for `{name}`"));
        }
    }
}

/// Whether an SPDX expression can be met with the licences allowed: one side of every OR, both of every AND.
fn is_allowed(expression: &str, allowed: &BTreeSet<String>) -> bool {
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut at = 0;
    any_of(&words, &mut at, allowed) && at == words.len()
}

fn any_of(words: &[&str], at: &mut usize, allowed: &BTreeSet<String>) -> bool {
    let mut met = all_of(words, at, allowed);
    while words.get(*at) == Some(&"OR") {
        *at += 1;
        met |= all_of(words, at, allowed);
    }
    met
}

fn all_of(words: &[&str], at: &mut usize, allowed: &BTreeSet<String>) -> bool {
    let mut met = one(words, at, allowed);
    while words.get(*at) == Some(&"AND") {
        *at += 1;
        met &= one(words, at, allowed);
    }
    met
}

fn one(words: &[&str], at: &mut usize, allowed: &BTreeSet<String>) -> bool {
    let Some(word) = words.get(*at) else { return false };
    *at += 1;
    if *word == "(" {
        let met = any_of(words, at, allowed);
        let is_closed = words.get(*at) == Some(&")");
        *at += 1;
        return met && is_closed;
    }
    if words.get(*at) == Some(&"WITH") {
        let name = format!("{word} WITH {}", words.get(*at + 1).unwrap_or(&""));
        *at += 2;
        return allowed.contains(&name);
    }
    allowed.contains(*word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn licences_are_read_as_expressions() {
        let allowed = BTreeSet::from(["MIT", "Unicode-3.0", "Apache-2.0 WITH LLVM-exception"].map(String::from));
        for good in [
            "MIT",
            "GPL-3.0 OR MIT",
            "MIT/Apache-2.0",
            "Apache-2.0 / MIT",
            "(MIT OR Apache-2.0) AND Unicode-3.0",
            "Apache-2.0 WITH LLVM-exception",
        ] {
            assert!(is_allowed(good, &allowed), "{good}");
        }
        for bad in ["GPL-3.0", "MIT AND GPL-3.0", "none", "", "(MIT", "Apache-2.0", "MIT GPL-3.0", "GPL-3.0 WITH MIT"] {
            assert!(!is_allowed(bad, &allowed), "{bad}");
        }
    }

    #[test]
    fn strangers_are_found() {
        let metadata = json!({ "packages": [
            { "name": "riss", "license": "MIT", "source": null, "dependencies": [
                { "name": "serde", "source": "registry+here" }, { "name": "riss-expected", "source": null },
                { "name": "odd", "source": "registry+here" } ] },
            { "name": "serde", "license": "MIT", "source": "registry+here", "dependencies": [] },
            { "name": "odd", "license": "SSPL-1.0", "source": "git+there", "dependencies": [] },
        ]});
        let policy = "licenses.allow = ['MIT']\nsources.allow-registry = ['here']".parse().unwrap();
        let mut findings = Findings::default();
        check_metadata(&metadata, &policy, "| `serde` | reads |\n| `odd` |  |\n", &mut findings);
        let messages: Vec<&str> = findings.errors.iter().map(|f| f.message.as_str()).collect();
        let parts = ["`odd` has the licence SSPL-1.0", "`odd` comes from git+there", "no reason for `odd`"];
        assert_eq!(messages.len(), parts.len(), "{messages:?}");
        assert!(messages.iter().zip(parts).all(|(m, p)| m.contains(p)), "{messages:?}");
    }
}
