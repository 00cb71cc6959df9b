//! `cargo xtask tidy`: the manners of the code that no compiler checks.
//!
//! [`layers`] reads which folders a file uses, [`citations`] looks up sources, [`words`] refuses empty names and open
//! ends, [`cases`] looks into the case folders, [`dependencies`] at what we build on. All work on text: [`source`] tells code from comments.

pub mod cases;
pub mod citations;
pub mod dependencies;
pub mod layers;
pub mod links;
pub mod source;
pub mod words;

use crate::Outcome;
use source::Source;
use std::collections::BTreeSet;
use std::fmt;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Longest file that passes, in lines.
const MOST_LINES: usize = 500;
/// Lines from which a file should be split.
const MANY_LINES: usize = 400;
/// Files whose text is checked.
const TEXT_FILES: [&str; 7] = ["rs", "toml", "md", "json", "bib", "yml", "yaml"];
/// Folders that are not ours to keep tidy.
const SKIPPED: [&str; 5] = ["target", ".git", "out", "book", "node_modules"];

/// Something that is not tidy.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// File, relative to the workspace.
    pub path: PathBuf,
    /// Line, from 1.
    pub line: usize,
    /// What is wrong.
    pub message: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.path.display(), self.line, self.message)
    }
}

/// All that was found.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// What must change.
    pub errors: Vec<Finding>,
    /// What should change soon.
    pub warnings: Vec<Finding>,
}

impl Findings {
    fn error(&mut self, path: &Path, line: usize, message: String) {
        self.errors.push(Finding { path: path.into(), line, message });
    }

    fn warning(&mut self, path: &Path, line: usize, message: String) {
        self.warnings.push(Finding { path: path.into(), line, message });
    }
}

/// Checks the workspace and prints what is wrong.
pub fn run() -> Outcome {
    let findings = check(&crate::root());
    for warning in &findings.warnings {
        println!("warning: {warning}");
    }
    for error in &findings.errors {
        eprintln!("{error}");
    }
    match findings.errors.len() {
        0 => Ok(()),
        n => Err(format!("{n} findings")),
    }
}

/// Checks all files below `root`.
pub fn check(root: &Path) -> Findings {
    let mut findings = Findings::default();
    let keys = match std::fs::read_to_string(root.join("REFERENCES.bib")) {
        Ok(bib) => citations::keys(&bib),
        Err(e) => {
            findings.error(Path::new("REFERENCES.bib"), 1, format!("cannot be read: {e}"));
            BTreeSet::new()
        }
    };
    let mut files = vec![];
    collect(root, &mut files);
    files.sort();
    for file in files {
        let path = file.strip_prefix(root).unwrap_or(&file);
        match std::fs::read_to_string(&file) {
            Ok(text) => check_text(path, &text, &keys, &mut findings),
            // Input of a test, wrong on purpose.
            Err(e) if e.kind() == ErrorKind::InvalidData && path.extension().is_none_or(|x| x != "rs") => {}
            Err(e) => findings.error(path, 1, format!("cannot be read: {e}")),
        }
    }
    cases::check(root, &mut findings);
    dependencies::check(root, &mut findings);
    links::check(root, &mut findings);
    findings
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let name = entry.file_name();
        if path.is_dir() {
            if !SKIPPED.iter().any(|s| name == *s) {
                collect(&path, files);
            }
        } else if path.extension().is_some_and(|e| TEXT_FILES.iter().any(|t| e == *t)) {
            files.push(path);
        }
    }
}

fn check_text(path: &Path, text: &str, keys: &BTreeSet<String>, findings: &mut Findings) {
    let lines = || text.lines().enumerate().map(|(i, l)| (i + 1, l));
    for (number, line) in lines() {
        if line.ends_with([' ', '\t', '\r']) {
            findings.error(path, number, "space at the end of the line".into());
        }
    }
    match path.extension().and_then(|e| e.to_str()) {
        Some("rs") => check_rust(path, text, keys, findings),
        Some("md") => {
            citations::check(path, lines(), keys, findings);
            words::check_open_ends(path, lines(), findings);
        }
        _ => {}
    }
}

fn check_rust(path: &Path, text: &str, keys: &BTreeSet<String>, findings: &mut Findings) {
    let source = Source::new(text);
    if !text.starts_with("//! ") {
        findings.error(path, 1, "the file needs a `//!` header that says what lives here".into());
    }
    match text.lines().count() {
        n if n > MOST_LINES => findings.error(path, n, format!("{n} lines, at most {MOST_LINES}: split the file")),
        n if n > MANY_LINES => findings.warning(path, n, format!("{n} lines: split it before it reaches {MOST_LINES}")),
        _ => {}
    }
    let comments = || source.comments.iter().map(|(n, c)| (*n, c.as_str()));
    citations::check(path, comments(), keys, findings);
    words::check_open_ends(path, comments(), findings);
    words::check_names(path, &source, findings);
    if let Ok(inside) = path.strip_prefix("crates/riss/src") {
        let mut of_layers = Findings::default();
        layers::check(inside, &source, &mut of_layers);
        findings.errors.extend(of_layers.errors.into_iter().map(|f| Finding { path: path.into(), ..f }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_file(path: &str, text: &str, expected: &[&str]) {
        let mut findings = Findings::default();
        check_text(Path::new(path), text, &BTreeSet::from(["EFG".to_string()]), &mut findings);
        let messages: Vec<_> = findings.errors.iter().map(|f| f.message.as_str()).collect();
        assert_eq!(messages.len(), expected.len(), "{path}: {messages:?}");
        for (message, part) in messages.iter().zip(expected) {
            assert!(message.contains(part), "{message} should contain {part}");
        }
    }

    #[test]
    fn the_workspace_is_tidy() {
        let findings = check(&crate::root());
        let list: Vec<String> = findings.errors.iter().map(Finding::to_string).collect();
        assert!(list.is_empty(), "\n{}", list.join("\n"));
    }

    #[test]
    fn headers_spaces_and_length() {
        check_file("xtask/src/a.rs", "//! Says what.\nfn f() {}\n", &[]);
        check_file("xtask/src/a.rs", "fn f() {}\n", &["header"]);
        check_file("a.toml", "a = 1 \n", &["space"]);
        check_file("xtask/src/a.rs", &format!("//! Long.\n{}", "\n".repeat(500)), &["501 lines"]);
        check_file("crates/riss/src/math/a.rs", "//! [EFG]\nuse crate::model::Model; // [ABC]\n", &["ABC", "below"]);
        check_file("docs/src/a.md", "see [EFG, Eq. 2] and [Nobody1900]\n", &["Nobody1900"]);
    }
}
