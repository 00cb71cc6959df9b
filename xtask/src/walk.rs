//! Walks through pages as their readers do: writes the files that they show, runs what they run, compares what is printed.
//!
//! A comment before a block of a page says what it is: `<!-- file NAME -->` (a file with that text),
//! `<!-- file NAME after the first -->` (the first file of the page, then that text), `<!-- prints: COMMAND -->` (what a
//! command prints, or some of its lines; `...` stands for those left out; `cases/` is the folder of the repository).

use crate::{Outcome, root, target_dir};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Pages with something to do in them, from the root of the workspace.
const PAGES: [&str; 4] = [
    "README.md",
    "docs/src/tutorials/first-case.md",
    "docs/src/tutorials/crack-growth.md",
    "docs/src/how-to/grow-cracks.md",
];
/// Pages are written anew where a number differs by this share, and where it is more than that of the greatest one in its line.
const AS_PRINTED: Closeness = Closeness { share: 1e-3, least: 0.005 };
/// Processors round differently, and another rounding may place a node elsewhere.
const ELSEWHERE: Closeness = Closeness { share: 0.01, least: 0.02 };
/// Numbers below this share of the greatest one in their part of a page are round-off.
const NOISE: f64 = 1e-8;
/// Where a page leaves lines out.
const LEFT_OUT: &str = "...";

/// What to do where a page shows something else than what is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Complain.
    Check,
    /// Write what is printed into the page.
    Update,
}

/// When numbers count as the same.
#[derive(Clone, Copy)]
struct Closeness {
    share: f64,
    least: f64,
}

/// Walks through all pages with the program at `riss`.
///
/// # Errors
/// What a reader would stumble over.
pub fn run(riss: &Path, mode: Mode) -> Outcome {
    let mut findings = vec![];
    for page in PAGES {
        let path = root().join(page);
        let text = fs::read_to_string(&path).map_err(|e| format!("{page}: {e}"))?;
        let scratch = target_dir().join("walk").join(page.replace('/', "-"));
        let closeness = match mode {
            Mode::Check => ELSEWHERE,
            Mode::Update => AS_PRINTED,
        };
        let walked = Walk::new(riss, &scratch, closeness)?.through(&text);
        match mode {
            Mode::Update if walked.text != text => {
                fs::write(&path, &walked.text).map_err(|e| format!("{page}: {e}"))?;
                println!("wrote {page}");
            }
            Mode::Update => {}
            Mode::Check => findings.extend(walked.differences.iter().map(|d| format!("{page}: {d}"))),
        }
        findings.extend(walked.stumbles.iter().map(|s| format!("{page}: {s}")));
    }
    if findings.is_empty() { Ok(()) } else { Err(findings.join("\n")) }
}

/// A reader in a folder of their own.
struct Walk<'a> {
    riss: &'a Path,
    scratch: &'a Path,
    closeness: Closeness,
    first: Option<String>,
    walked: Walked,
}

/// A page after the walk.
#[derive(Default)]
struct Walked {
    /// The page with what is printed today.
    text: String,
    /// Lines that the page shows otherwise.
    differences: Vec<String>,
    /// What cannot be mended by writing the page anew.
    stumbles: Vec<String>,
}

impl<'a> Walk<'a> {
    fn new(riss: &'a Path, scratch: &'a Path, closeness: Closeness) -> Result<Self, String> {
        let told = |e: std::io::Error| format!("{}: {e}", scratch.display());
        if scratch.exists() {
            fs::remove_dir_all(scratch).map_err(told)?;
        }
        fs::create_dir_all(scratch).map_err(told)?;
        Ok(Self { riss, scratch, closeness, first: None, walked: Walked::default() })
    }

    fn through(mut self, page: &str) -> Walked {
        let mut lines = page.lines();
        while let Some(line) = lines.next() {
            self.push(line);
            let Some(order) = line.strip_prefix("<!-- ").and_then(|l| l.strip_suffix(" -->")) else { continue };
            let is_order = order.starts_with("file ") || order.starts_with("prints: ");
            if !is_order {
                continue;
            }
            let opening = lines.by_ref().inspect(|l| self.push(l)).find(|l| l.starts_with("```"));
            if opening.is_none() {
                self.walked.stumbles.push(format!("no block after `{order}`"));
                break;
            }
            let block: Vec<&str> = lines.by_ref().take_while(|l| *l != "```").collect();
            match order.strip_prefix("prints: ") {
                Some(command) => self.compare(command, &block),
                None => self.write(order, &block),
            }
            self.push("```");
        }
        self.walked
    }

    fn push(&mut self, line: &str) {
        self.walked.text.push_str(line);
        self.walked.text.push('\n');
    }

    fn write(&mut self, order: &str, block: &[&str]) {
        block.iter().for_each(|l| self.push(l));
        let name = order.trim_start_matches("file ").trim_end_matches(" after the first");
        let mut text = block.join("\n") + "\n";
        if order.ends_with(" after the first") {
            text = self.first.clone().unwrap_or_default() + "\n" + &text;
        }
        self.first.get_or_insert_with(|| text.clone());
        if let Err(e) = fs::write(self.scratch.join(name), text) {
            self.walked.stumbles.push(format!("{name}: {e}"));
        }
        self.printed(&format!("riss check {name}"));
    }

    /// What a command prints; a stumble if it fails.
    fn printed(&mut self, command: &str) -> Vec<String> {
        let folder = self.riss.parent().unwrap_or(self.riss).to_path_buf();
        let paths = std::env::var_os("PATH").unwrap_or_default();
        let joined = std::env::join_paths(std::iter::once(folder).chain(std::env::split_paths(&paths)));
        let mut shell = Command::new("sh");
        // Readers are in the root of the workspace.
        let here = command.replace(" cases/", &format!(" {}/cases/", root().display()));
        shell.args(["-c", &here]).current_dir(self.scratch);
        let output = shell.env("PATH", joined.unwrap_or(paths)).output();
        match output {
            Ok(output) if output.status.success() => {
                String::from_utf8_lossy(&output.stdout).lines().map(|l| l.trim_end().to_string()).collect()
            }
            Ok(output) => {
                let told = String::from_utf8_lossy(&output.stderr).into_owned();
                self.walked.stumbles.push(format!("`{command}` ended with {}:\n{told}", output.status));
                vec![]
            }
            Err(e) => {
                self.walked.stumbles.push(format!("`{command}`: {e}"));
                vec![]
            }
        }
    }

    /// Compares what a page shows with what a command prints, and writes the latter.
    fn compare(&mut self, command: &str, block: &[&str]) {
        let printed = self.printed(command);
        let mut from = 0;
        for (k, part) in block.split(|l| *l == LEFT_OUT).enumerate() {
            if k > 0 {
                self.push(LEFT_OUT);
            }
            let is_here = |at: &usize| part.iter().zip(&printed[*at..]).all(|(a, b)| key(a) == key(b));
            let last = (printed.len() + 1).saturating_sub(part.len());
            let Some(at) = (from..last).find(is_here) else {
                let shown = part.join("\n");
                self.walked.stumbles.push(format!("`{command}` does not print lines such as\n{shown}"));
                part.iter().for_each(|l| self.push(l));
                continue;
            };
            from = at + part.len();
            let noise = NOISE * part.iter().map(|l| greatest(l)).fold(0.0, f64::max);
            let same = |a: &str, b: &str| is_close(a, b, noise, self.closeness);
            let differing: Vec<bool> = part.iter().zip(&printed[at..]).map(|(a, b)| !same(a, b)).collect();
            for (k, (shown, now)) in part.iter().zip(&printed[at..]).enumerate() {
                if differing[k] {
                    self.walked.differences.push(format!("`{command}` prints\n{now}\nin place of\n{shown}"));
                }
                self.push(if differing.contains(&true) { now } else { shown });
            }
        }
    }
}

/// What tells a line from others: its words up to the first number with decimals, counts of many digits left out.
fn key(line: &str) -> Vec<String> {
    let words = line.split_whitespace().take_while(|w| number(w).is_none_or(|_| !w.contains('.')));
    let masked = |w: &str| match w.chars().filter(char::is_ascii_digit).count() {
        0..3 => w.to_string(),
        _ => "#".into(),
    };
    words.map(masked).collect()
}

/// The number in a word with its brackets and units around it.
fn number(word: &str) -> Option<f64> {
    word.trim_matches(|c: char| !c.is_ascii_digit() && c != '-').parse().ok()
}

/// The greatest number with decimals in a line.
fn greatest(line: &str) -> f64 {
    let decimals = line.split_whitespace().filter(|w| w.contains('.')).filter_map(number);
    decimals.map(f64::abs).fold(0.0, f64::max)
}

/// Whether two lines have the same words, and numbers that are the same but for their last digits.
///
/// - `noise`: numbers below this are round-off
fn is_close(a: &str, b: &str, noise: f64, closeness: Closeness) -> bool {
    let least = noise.max(closeness.least * greatest(a));
    let [a, b]: [Vec<&str>; 2] = [a, b].map(|l| l.split_whitespace().collect());
    let same = |(a, b): (&&str, &&str)| match (number(a), number(b)) {
        (Some(x), Some(y)) => {
            let size = x.abs().max(y.abs());
            (x - y).abs() <= closeness.share * size || (a.contains('.') && size < least)
        }
        (None, None) => a == b,
        (Some(_), None) | (None, Some(_)) => false,
    };
    a.len() == b.len() && a.iter().zip(&b).all(same)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Walks through a page whose commands are those of the shell.
    fn walk(page: &str, name: &str) -> Walked {
        let scratch = target_dir().join("walk").join(name);
        Walk::new(Path::new("/bin/true"), &scratch, AS_PRINTED).unwrap().through(page)
    }

    fn page(command: &str, shown: &str) -> String {
        format!("Text\n<!-- prints: {command} -->\n```text\n{shown}\n```\nmore\n")
    }

    #[test]
    fn other_last_digits_are_no_difference_and_other_numbers_are_written() {
        let rows = "printf 'K 34.0484 0.0112\\nstep 1: at (3.790, 7.9)\\nstep 2: at (4.1, 7.8)\\nend\\n'";
        for (shown, differences) in [
            ("K 34.0485 0.0300\n...\nstep 2: at (4.1, 7.8)", 0),
            ("K 34.1485 0.0300\n...\nstep 2: at (4.1, 7.8)", 1),
            ("step 1: at (3.80, 7.9)\nstep 2: at (4.2, 7.8)\nend", 2),
        ] {
            let walked = walk(&page(rows, shown), "digits");
            assert_eq!((walked.differences.len(), walked.stumbles.len()), (differences, 0), "{shown}");
            assert_eq!(walked.text == page(rows, shown), differences == 0, "{}", walked.text);
            assert!(walk(&walked.text, "digits").differences.is_empty());
        }
        let noise = page("printf 'bottom -8000.00\\npoint 5.1e-11 0\\n'", "bottom -8000.00\npoint 6.5e-11 0");
        assert_eq!(walk(&noise, "digits").differences, Vec::<String>::new());
    }

    #[test]
    fn lines_that_are_not_printed_and_commands_that_fail_are_stumbles() {
        let walked = walk(&page("echo step 1", "step 2"), "lines");
        assert!(walked.stumbles[0].contains("does not print"), "{:?}", walked.stumbles);
        assert!(walk(&page("exit 3", "x"), "fails").stumbles[0].contains("ended with"));
    }

    #[test]
    fn files_are_written_one_after_another() {
        let page = "<!-- file a.toml -->\n```toml\nx = 1\n```\n<!-- file b.toml after the first -->\n```toml\ny = 2\n```\n\
                    <!-- prints: cat b.toml -->\n```text\nx = 1\n\ny = 2\n```\n";
        let scratch = target_dir().join("walk/files");
        let _ = fs::remove_dir_all(&scratch);
        let walked = walk(page, "files");
        assert_eq!(walked.text, page);
        assert_eq!(fs::read_to_string(scratch.join("b.toml")).unwrap(), "x = 1\n\ny = 2\n");
    }
}
