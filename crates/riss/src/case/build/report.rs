//! Where the builders put what they find.

use crate::case::document::Document;
use crate::case::problem::{MAX_PROBLEMS, Problem};

/// Problems and notes, placed in the document by their key.
pub(in crate::case) struct Report<'a> {
    pub document: &'a Document,
    pub problems: &'a mut Vec<Problem>,
    pub notes: Vec<Problem>,
    /// Takes what is beyond the limit.
    overflow: Problem,
}

impl<'a> Report<'a> {
    /// An empty report on top of known problems.
    pub fn new(document: &'a Document, problems: &'a mut Vec<Problem>) -> Self {
        Self { document, problems, notes: vec![], overflow: Problem::new("", "") }
    }

    /// Adds a problem with the value at `key`.
    pub fn error(&mut self, key: impl Into<String>, message: impl Into<String>) -> &mut Problem {
        if self.problems.len() >= MAX_PROBLEMS {
            return &mut self.overflow;
        }
        let mut problem = Problem::new(key, message);
        self.document.locate(&mut problem);
        self.problems.push(problem);
        self.problems.last_mut().expect("pushed above")
    }

    /// What is known, or else its problem with the value at `key`.
    pub fn known<T>(&mut self, key: &str, found: Result<T, Box<Problem>>) -> Option<T> {
        found.map_err(|bad| self.error(key, bad.message).suggestion = bad.suggestion).ok()
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
