//! Citations such as `[EFG, Eq. 4]` must name an entry of `REFERENCES.bib`.
//!
//! ```text
//! citation = "[" item { ";" item } "]"       not followed by "(", "[" or ":"
//! item     = key [ "," place ]
//! key      = name with a year | capitals     Kfouri1986, SlakKosec2019; EFG, C3D
//! ```
//!
//! A bracket counts as a citation if its first word has the form of a key, or if its place begins with a word such as
//! `Eq.` or `section`. Text in backticks, code blocks and formulas is not searched, so links to items, units such as
//! `[length]` and matrices do not trip.

use super::Findings;
use std::collections::BTreeSet;
use std::path::Path;

const PLACES: [&str; 15] = [
    "Eq.", "Eqs.", "after", "Table", "Tables", "Fig.", "Figs.", "section", "Section", "chapter", "Appendix", "p.",
    "pp.", "page", "§",
];

/// The keys of a BibTeX file.
pub fn keys(bib: &str) -> BTreeSet<String> {
    let entries = bib.lines().filter_map(|l| l.trim_start().strip_prefix('@')?.split_once('{'));
    entries.map(|(_, key)| key.trim_end().trim_end_matches(',').to_string()).collect()
}

/// Checks the citations in lines of prose.
pub fn check<'a>(
    path: &Path,
    lines: impl IntoIterator<Item = (usize, &'a str)>,
    keys: &BTreeSet<String>,
    findings: &mut Findings,
) {
    let mut in_code = false;
    for (number, line) in lines {
        let text = line.trim_start().trim_start_matches(['/', '!']).trim_start();
        if text.starts_with("```") || text.starts_with("$$") && text.matches("$$").count() == 1 {
            in_code = !in_code;
            continue;
        }
        if in_code {
            continue;
        }
        for key in cited(&prose(line)) {
            if !keys.contains(&key) {
                findings.error(path, number, format!("`{key}` is cited, but not in REFERENCES.bib"));
            }
        }
    }
}

/// The line with text in backticks and formulas blanked.
fn prose(line: &str) -> String {
    let mut quote = None;
    line.chars()
        .map(|c| {
            let in_quote = quote.is_some();
            if c == '`' || c == '$' {
                match quote {
                    None => quote = Some(c),
                    Some(q) if q == c => quote = None,
                    _ => {}
                }
            }
            // The quotes stay, so that a bracket around one is no longer a plain word.
            if in_quote && quote.is_some() { '_' } else { c }
        })
        .collect()
}

/// Keys that a line of prose cites.
fn cited(line: &str) -> Vec<String> {
    let mut found = vec![];
    for (open, _) in line.match_indices('[') {
        let rest = &line[open + 1..];
        let Some(close) = rest.find(']') else { continue };
        let inside = &rest[..close];
        if inside.contains('[') || rest[close + 1..].starts_with(['(', '[', ':']) {
            continue;
        }
        for item in inside.split(';') {
            let (key, place) = item.split_once(',').unwrap_or((item, ""));
            let (key, place) = (key.trim(), place.split_whitespace().next().unwrap_or_default());
            if looks_like_key(key) || (is_word(key) && PLACES.contains(&place)) {
                found.push(key.to_string());
            }
        }
    }
    found
}

fn is_word(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_alphanumeric())
}

fn looks_like_key(word: &str) -> bool {
    let is_capitals = |s: &str| s.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit());
    let with_year = || {
        let name = word.trim_end_matches(|c: char| c.is_ascii_lowercase());
        let digits = name.chars().rev().take_while(char::is_ascii_digit).count();
        digits == 4 && name.len() > 4 && word.len() - name.len() <= 1
    };
    is_word(word)
        && word.len() >= 2
        && word.starts_with(|c: char| c.is_ascii_uppercase())
        && (is_capitals(word) || with_year())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_cited(line: &str, expected: &[&str]) {
        assert_eq!(cited(&prose(line)), expected, "{line}");
    }

    #[test]
    fn citations_are_found() {
        check_cited("/// Polynomial basis [EFG, Eq. 5].", &["EFG"]);
        check_cited("/// T-stress [Kfouri1986].", &["Kfouri1986"]);
        check_cited("// See [SlakKosec2019; C3D, Table 1].", &["SlakKosec2019", "C3D"]);
        check_cited("//! [Tada, section 2.1] and [Wilson1969a]", &["Tada", "Wilson1969a"]);
    }

    #[test]
    fn links_units_code_and_formulas_are_not() {
        for line in [
            "/// See [`Model`] and [`crate::math`].",
            "/// Radius [length] or [rad] or [stress·√length].",
            "/// Not `[EFG, Eq. 5]` in code.",
            "[MIT](LICENSE-MIT), [DOI]: https://example.org, [KEY][link]",
            "The matrix $[K, Eq. 1] [KIJ]$ is no source.",
            "## [0.1.0] - 2025-01-01 and [Unreleased]",
            "let a = [N, M]; // an array type [f64; 2]",
        ] {
            check_cited(line, &[]);
        }
    }

    #[test]
    fn unknown_keys_are_reported_with_their_line() {
        let keys = keys("@article{EFG,\n title = {x}\n}\n@book{Tada,\n");
        let mut findings = Findings::default();
        let lines = ["[EFG, Eq. 1]", "```", "[ABC]", "```", "[Nobody1900]"];
        check(Path::new("x.md"), lines.iter().enumerate().map(|(i, l)| (i + 1, *l)), &keys, &mut findings);
        assert_eq!(findings.errors.len(), 1);
        assert_eq!(findings.errors[0].line, 5);
    }
}
