//! Problems of a case, drawn into its text on a terminal, one plain line each elsewhere.

use miette::{Diagnostic, GraphicalReportHandler, LabeledSpan, NamedSource, Severity, SourceCode};
use riss::case::{Case, CaseErrors, Origin, Problem, SolidCase};
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
        let mut page = String::new();
        if GraphicalReportHandler::new().render_report(&mut page, &drawn).is_ok() {
            eprint!("{page}");
            return;
        }
    }
    eprintln!("{place}: {word}: {problem}");
}

/// A problem as miette draws it.
#[derive(Debug)]
struct Drawn<'a> {
    problem: &'a Problem,
    source: NamedSource<String>,
    severity: Severity,
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
