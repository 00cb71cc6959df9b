//! `cargo xtask ci`: exactly what continuous integration runs.

use crate::{Outcome, cargo, root, run};
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::process::Stdio;

/// Format, clippy, tests (tidy and doc tests among them), documentation, tutorials, instructions, the Python package; stops at the first failure.
pub fn run_all() -> Outcome {
    step("format", || run(&mut cargo(&["fmt", "--all", "--check"])))?;
    step("tidy", crate::tidy::run)?;
    let clippy = ["clippy", "--release", "--workspace", "--all-targets", "--", "-D", "warnings"];
    step("clippy", || run(&mut cargo(&clippy)))?;
    let mut results = vec![];
    step("tests", || run_tests(&mut results))?;
    step("documentation", run_rustdoc)?;
    step("tutorials", || crate::walk::run(&crate::build_riss()?, crate::walk::Mode::Check))?;
    match crate::instructions::can_count() {
        true => step("instructions", || crate::instructions::run(crate::instructions::Counts::Check))?,
        false => println!("== instructions are not counted: valgrind is not installed"),
    }
    step("python", crate::python::test)?;
    println!("\nclosing lines of the tests");
    for line in &results {
        println!("{line}");
    }
    println!("all checks passed");
    Ok(())
}

fn step(name: &str, task: impl FnOnce() -> Outcome) -> Outcome {
    println!("== {name}");
    task().map_err(|reason| format!("{name} failed: {reason}"))
}

/// Runs the test command of the README, shows its output and keeps its closing lines.
fn run_tests(results: &mut Vec<String>) -> Outcome {
    let mut command = cargo(&["test", "--release", "--workspace"]);
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(|e| format!("cargo did not start: {e}"))?;
    for line in BufReader::new(child.stdout.take().expect("stdout is piped")).lines().map_while(Result::ok) {
        println!("{line}");
        if line.starts_with("test result:") {
            results.push(line);
        }
    }
    let status = child.wait().map_err(|e| e.to_string())?;
    if status.success() { Ok(()) } else { Err(format!("cargo test ended with {status}\n{}", results.join("\n"))) }
}

/// Builds the documentation; every warning is an error.
///
/// Units and citations in plain brackets look like links to rustdoc, so its link lint is off in the workspace.
/// Here it is forced on, and only links in backticks count.
fn run_rustdoc() -> Outcome {
    let mut command = cargo(&["doc", "--no-deps", "--release", "--workspace", "--quiet", "--message-format=json"]);
    command.env("RUSTDOCFLAGS", "-D warnings --force-warn rustdoc::broken-intra-doc-links");
    let output = command.stderr(Stdio::inherit()).output().map_err(|e| format!("cargo did not start: {e}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let messages: Vec<String> = text.lines().filter_map(|l| serde_json::from_str(l).ok()).filter_map(problem).collect();
    for message in &messages {
        eprintln!("{message}");
    }
    match (messages.len(), output.status.success()) {
        (0, true) => Ok(()),
        (0, false) => Err(format!("cargo doc ended with {} in {}", output.status, root().display())),
        (n, _) => Err(format!("rustdoc has {n} complaints")),
    }
}

/// The text of a compiler message that counts, if it does.
fn problem(line: Value) -> Option<String> {
    let message = line.get("message").filter(|_| line["reason"] == "compiler-message")?;
    let text = message["rendered"].as_str().unwrap_or_default().to_string();
    let is_link = message["code"]["code"] == "rustdoc::broken_intra_doc_links";
    (!is_link || spans_are_code(message)).then_some(text)
}

/// Whether the message points at text in backticks, or at a link with a target of its own.
fn spans_are_code(message: &Value) -> bool {
    let spans = message["spans"].as_array().map(Vec::as_slice).unwrap_or_default();
    let lines = spans.iter().flat_map(|s| s["text"].as_array().map(Vec::as_slice).unwrap_or_default());
    for line in lines {
        let chars: Vec<char> = line["text"].as_str().unwrap_or_default().chars().collect();
        let start = line["highlight_start"].as_u64().unwrap_or(1) as usize - 1;
        let before = &chars[..start.min(chars.len())];
        let at = chars.get(start).copied();
        if at == Some('`') || matches!(before.last(), Some('`' | '(')) {
            return true;
        }
    }
    // Without a place in the source nothing excuses the message.
    spans.is_empty()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn link(text: &str, start: usize) -> Value {
        json!({ "reason": "compiler-message", "message": {
            "rendered": "unresolved link", "code": { "code": "rustdoc::broken_intra_doc_links" },
            "spans": [{ "text": [{ "text": text, "highlight_start": start }] }],
        }})
    }

    #[test]
    fn units_and_citations_are_no_links() {
        assert_eq!(problem(link("/// Radius [length].", 13)), None);
        assert!(problem(link("/// See [`Nowhere`].", 10)).is_some());
        assert!(problem(link("/// See [here](Nowhere).", 16)).is_some());
        let other = json!({ "reason": "compiler-message", "message": { "rendered": "x", "code": null, "spans": [] } });
        assert!(problem(other).is_some());
        assert_eq!(problem(json!({ "reason": "build-finished" })), None);
    }
}
