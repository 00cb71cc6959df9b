//! No text makes the reader panic or hang.

use proptest::prelude::*;
use riss::case::Case;
use std::path::Path;

/// A case that uses everything.
const RICH: &str = include_str!("rich.toml");

fn read(text: &str) {
    if let Err(errors) = Case::parse(text, Path::new("case.toml"), &[]) {
        assert!(!errors.problems.is_empty());
        for problem in &errors.problems {
            assert!(!problem.message.is_empty());
            let span = problem.span.clone().unwrap_or(0..0);
            assert!(span.start <= span.end && span.end <= text.len().max(1));
        }
        assert!(!errors.to_string().is_empty());
    }
}

#[test]
fn the_rich_case_is_good() {
    let case = Case::parse(RICH, Path::new("case.toml"), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    assert!(case.notes.is_empty());
    assert_eq!(case.model.cracks.len(), 3);
}

#[test]
fn deep_nesting_is_refused() {
    for text in ["[".repeat(100_000), "a=".to_string() + &"[".repeat(100_000), "a.".repeat(100_000) + "b=1"] {
        read(&text);
    }
    read(&format!("title = 'a'\n[material]\nx = {}1{}", "{a=".repeat(5000), "}".repeat(5000)));
}

#[test]
fn long_files_of_mistakes_end_soon() {
    read(&"[[load]]\n".repeat(100_000));
    read(&(0..100_000).map(|k| format!("key{k} = 1\n")).collect::<String>());
    let corners: String = (0..50_000).map(|k| format!("[{}, {}],", k % 77, k % 101)).collect();
    read(&RICH.replace("[0, 20]]", &format!("[0, 20], {corners}]")));
}

/// What a number may become.
const NUMBERS: [&str; 14] =
    ["0", "-1", "1e308", "-1e308", "1e-320", "nan", "inf", "7", "1e-9", "1e300", "true", "[]", "{}", "'x'"];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn random_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        read(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn random_toml_letters(text in "[\\[\\]{}=\"'.,a-z0-9 \n#-]{0,200}") {
        read(&text);
    }

    #[test]
    fn a_number_is_replaced(
        which in any::<prop::sample::Index>(),
        by in 0..NUMBERS.len(),
        again in any::<prop::sample::Index>(),
    ) {
        let text = replace_number(RICH, which, NUMBERS[by]);
        read(&text);
        read(&replace_number(&text, again, NUMBERS[by]));
    }

    #[test]
    fn numbers_are_swapped(a in any::<prop::sample::Index>(), value in -20.0..20.0f64) {
        read(&replace_number(RICH, a, &value.to_string()));
    }

    #[test]
    fn lines_are_dropped_and_doubled(drop in any::<prop::sample::Index>(), double in any::<prop::sample::Index>()) {
        let mut lines: Vec<&str> = RICH.lines().collect();
        lines.remove(drop.index(lines.len()));
        lines.insert(0, lines[double.index(lines.len())]);
        read(&lines.join("\n"));
        lines.remove(0);
        read(&lines.join("\n"));
    }

    #[test]
    fn characters_are_replaced(at in any::<prop::sample::Index>(), by in any::<char>()) {
        let mut chars: Vec<char> = RICH.chars().collect();
        let at = at.index(chars.len());
        chars[at] = by;
        read(&chars.into_iter().collect::<String>());
    }

    #[test]
    fn expressions_of_any_letters(text in "[-+*/^()a-z0-9 .,{}π!<>|&]{0,60}") {
        read(&RICH.replace("0.5*y", &text));
    }

    #[test]
    fn overrides_of_any_letters(text in "[a-z_\\[\\]0-9.]{0,30}=[\\[\\]{}a-z0-9.,= -]{0,30}") {
        let _ = Case::parse(RICH, Path::new("case.toml"), &[text]);
    }
}

/// Replaces one number outside of keys.
fn replace_number(text: &str, which: prop::sample::Index, by: &str) -> String {
    let bytes = text.as_bytes();
    let is_digit = |k: usize| bytes[k].is_ascii_digit() || bytes[k] == b'.';
    let starts: Vec<usize> = (1..bytes.len())
        .filter(|&k| bytes[k].is_ascii_digit() && matches!(bytes[k - 1], b' ' | b'[' | b'*' | b'-'))
        .collect();
    let start = starts[which.index(starts.len())];
    let end = (start..bytes.len()).find(|&k| !is_digit(k)).unwrap_or(bytes.len());
    format!("{}{by}{}", &text[..start], &text[end..])
}
