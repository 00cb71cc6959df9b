//! Problems of a case, drawn into its text on a terminal, one plain line each elsewhere.

use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, Severity, SourceCode};
use riss::case::{Case, CaseErrors, Origin, Problem, SolidCase};
use std::ffi::OsStr;
use std::fmt;
use std::io::IsTerminal;
use std::path::Path;

/// Reports all problems on stderr.
pub fn report_errors(errors: &CaseErrors) {
    for problem in &errors.problems {
        let place = errors.place(problem);
        show(problem, &place, &errors.file, &errors.text, Severity::Error);
    }
    let n = errors.problems.len();
    let plural = if n == 1 { "problem" } else { "problems" };
    eprintln!("{}: {n} {plural}, nothing was run", errors.file.display());
}

/// Reports what the author of a valid case should know.
pub fn report_notes(case: &Case) {
    for note in &case.notes {
        show(note, &case.place(note), &case.path, &case.text, Severity::Warning);
    }
}

/// Reports what the author of a valid case of a solid should know.
pub fn report_solid_notes(case: &SolidCase) {
    for note in &case.notes {
        show(note, &case.place(note), &case.path, &case.text, Severity::Warning);
    }
}

fn show(problem: &Problem, place: &str, file: &Path, text: &str, severity: Severity) {
    let word = if severity == Severity::Error { "error" } else { "note" };
    let has_place = problem.origin == Origin::File && problem.span.is_some();
    if has_place && std::io::stderr().is_terminal() {
        let source = NamedSource::new(file.display().to_string(), text.to_string()).with_language("TOML");
        let drawn = Drawn { problem, source, severity };
        if let Some(page) = drawn.page(theme(std::env::var_os("NO_COLOR").as_deref())) {
            eprint!("{page}");
            return;
        }
    }
    eprintln!("{place}: {word}: {problem}");
}

/// Colors, unless `NO_COLOR` is set to anything (no-color.org); miette alone would take `NO_COLOR=0` for a wish for them.
fn theme(no_color: Option<&OsStr>) -> GraphicalTheme {
    if no_color.is_some_and(|v| !v.is_empty()) { GraphicalTheme::unicode_nocolor() } else { GraphicalTheme::unicode() }
}

/// A problem as miette draws it.
#[derive(Debug)]
struct Drawn<'a> {
    problem: &'a Problem,
    source: NamedSource<String>,
    severity: Severity,
}

impl Drawn<'_> {
    fn page(&self, theme: GraphicalTheme) -> Option<String> {
        let mut page = String::new();
        GraphicalReportHandler::new_themed(theme).render_report(&mut page, self).ok()?;
        Some(page)
    }
}

impl fmt::Display for Drawn<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.problem.key.as_str() {
            "" => write!(f, "{}", self.problem.message),
            key => write!(f, "{key}: {}", self.problem.message),
        }
    }
}

impl std::error::Error for Drawn<'_> {}

impl Diagnostic for Drawn<'_> {
    fn severity(&self) -> Option<Severity> {
        Some(self.severity)
    }
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let allowed = self.problem.allowed.as_ref().map(|a| format!("allowed: {a}"));
        let lines: Vec<String> = allowed.into_iter().chain(self.problem.suggestion.clone()).collect();
        (!lines.is_empty()).then(|| Box::new(lines.join("\n")) as Box<dyn fmt::Display>)
    }
    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.source)
    }
    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.problem.span.clone()?;
        Some(Box::new(std::iter::once(LabeledSpan::new(Some("here".into()), span.start, span.len()))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_give_way_to_no_color() {
        let errors = Case::parse("rigid_motion = 5\n", "case.toml".as_ref(), &[]).expect_err("a bad case");
        let problem = errors.problems.iter().find(|p| p.span.is_some()).expect("one has a place");
        let page = |no_color: Option<&str>| {
            let source = NamedSource::new("case.toml", errors.text.clone());
            let drawn = Drawn { problem, source, severity: Severity::Error };
            drawn.page(theme(no_color.map(OsStr::new))).expect("drawn")
        };
        let escape = '\u{1b}';
        assert!(page(None).contains(escape) && page(Some("")).contains(escape));
        assert!(!page(Some("1")).contains(escape) && !page(Some("0")).contains(escape));
        assert!(page(Some("1")).contains("rigid_motion"));
    }
}
