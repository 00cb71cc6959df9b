//! Where the builders put what they find.

use crate::case::document::Document;
use crate::case::problem::Problem;

/// Problems and notes, placed in the document by their key.
pub(super) struct Report<'a> {
    pub document: &'a Document,
    pub problems: &'a mut Vec<Problem>,
    pub notes: Vec<Problem>,
}

impl Report<'_> {
    /// Adds a problem with the value at `key`.
    pub fn error(&mut self, key: impl Into<String>, message: impl Into<String>) -> &mut Problem {
        let mut problem = Problem::new(key, message);
        self.document.locate(&mut problem);
        self.problems.push(problem);
        self.problems.last_mut().expect("pushed above")
    }

    /// Adds a note with the value at `key`.
    pub fn note(&mut self, key: impl Into<String>, message: impl Into<String>) {
        let mut problem = Problem::new(key, message);
        self.document.locate(&mut problem);
        self.notes.push(problem);
    }

    /// Demands a positive number.
    pub fn positive(&mut self, key: impl Into<String>, value: f64) -> bool {
        if value <= 0.0 {
            self.error(key, "must be positive");
        }
        value > 0.0
    }
}
