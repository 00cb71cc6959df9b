//! What is wrong with a case, in the words of its author.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;

/// More problems than this are not sought: their author has enough to do.
pub(super) const MAX_PROBLEMS: usize = 100;

/// Where the text of a problem stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Origin {
    /// In the case file.
    File,
    /// In an override, by its index.
    Override(usize),
}

/// One mistake in a case, or a note about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// What is wrong.
    pub message: String,
    /// Key path such as `load[0].traction`; empty if the whole file is meant.
    pub key: String,
    /// Which text `span`, `line` and `column` refer to.
    pub origin: Origin,
    /// Bytes of that text, if the problem has a place.
    pub span: Option<Range<usize>>,
    /// Line from 1, or 0 without a place.
    pub line: usize,
    /// Column from 1 in characters, or 0 without a place.
    pub column: usize,
    /// What is written there, if it is short.
    pub value: Option<String>,
    /// Allowed range or names.
    pub allowed: Option<String>,
    /// What was probably meant, or what to do.
    pub suggestion: Option<String>,
}

impl Problem {
    /// A problem without a place.
    pub(super) fn new(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            key: key.into(),
            origin: Origin::File,
            span: None,
            line: 0,
            column: 0,
            value: None,
            allowed: None,
            suggestion: None,
        }
    }

    pub(super) fn allow(&mut self, allowed: impl Into<String>) -> &mut Self {
        self.allowed = Some(allowed.into());
        self
    }

    pub(super) fn suggest(&mut self, suggestion: impl Into<String>) -> &mut Self {
        self.suggestion = Some(suggestion.into());
        self
    }

    /// Lists the allowed names, and asks for the one that is closest to `written`.
    pub(super) fn one_of<'n>(&mut self, written: &str, names: impl IntoIterator<Item = &'n str>) -> &mut Self {
        let names: Vec<&str> = names.into_iter().collect();
        if let Some(name) = closest(written, &names) {
            self.suggestion = Some(format!("did you mean `{name}`?"));
        }
        self.allowed = Some(if names.is_empty() { "nothing here".into() } else { names.join(", ") });
        self
    }

    /// Puts the problem at bytes of the text of its origin.
    pub(super) fn place(&mut self, origin: Origin, text: &str, span: Range<usize>) -> &mut Self {
        let before = text.get(..span.start).unwrap_or("");
        self.origin = origin;
        self.line = before.matches('\n').count() + 1;
        self.column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        self.span = Some(span);
        self
    }
}

/// Key, value and message on one line; allowed values and the suggestion on lines of their own.
impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.value, self.key.is_empty()) {
            (_, true) => write!(f, "{}", self.message)?,
            (Some(value), _) => write!(f, "{} = {value}: {}", self.key, self.message)?,
            (None, _) => write!(f, "{}: {}", self.key, self.message)?,
        }
        if let Some(allowed) = &self.allowed {
            write!(f, "\n    allowed: {allowed}")?;
        }
        if let Some(suggestion) = &self.suggestion {
            write!(f, "\n    {suggestion}")?;
        }
        Ok(())
    }
}

/// Everything that is wrong with a case, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseErrors {
    /// The case file as it was named.
    pub file: PathBuf,
    /// Its text; empty if it could not be read.
    pub text: String,
    /// The overrides as they were given.
    pub overrides: Vec<String>,
    /// At least one.
    pub problems: Vec<Problem>,
}

impl CaseErrors {
    /// Where a problem stands, such as `case.toml:3:9` or `--set nodes.star=1`.
    pub fn place(&self, problem: &Problem) -> String {
        place(&self.file, &self.overrides, problem)
    }
}

/// See [`CaseErrors::place`].
pub(super) fn place(file: &std::path::Path, overrides: &[String], problem: &Problem) -> String {
    match problem.origin {
        Origin::Override(index) => format!("--set {}", overrides.get(index).map_or("", String::as_str)),
        Origin::File if problem.line == 0 => file.display().to_string(),
        Origin::File => format!("{}:{}:{}", file.display(), problem.line, problem.column),
    }
}

impl fmt::Display for CaseErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, problem) in self.problems.iter().enumerate() {
            write!(f, "{}{}: {problem}", if k > 0 { "\n" } else { "" }, self.place(problem))?;
        }
        Ok(())
    }
}

impl std::error::Error for CaseErrors {}

/// The name closest to `written`, if one is close enough to be a slip.
fn closest<'n>(written: &str, names: &[&'n str]) -> Option<&'n str> {
    // Long texts are no misspelt names, and the distance takes time quadratic in the length.
    if written.len() > 100 {
        return None;
    }
    let lower = written.to_lowercase().replace('_', "-");
    let distance = |name: &str| strsim::damerau_levenshtein(&lower, &name.to_lowercase().replace('_', "-"));
    let best = names.iter().copied().min_by_key(|name| distance(name))?;
    let slack = 1 + best.chars().count().min(written.chars().count()) / 4;
    (distance(best) <= slack).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_recognized_and_strangers_are_not() {
        let names = ["young", "poisson", "remote_stress"];
        assert_eq!(closest("Yuong", &names), Some("young"));
        assert_eq!(closest("poison", &names), Some("poisson"));
        assert_eq!(closest("remote-stres", &names), Some("remote_stress"));
        assert_eq!(closest("temperature", &names), None);
    }

    #[test]
    fn columns_count_characters() {
        let text = "a = 1\n\"é\" = 2";
        let mut problem = Problem::new("k", "m");
        problem.place(Origin::File, text, 12..13);
        assert_eq!((problem.line, problem.column), (2, 6));
    }
}
