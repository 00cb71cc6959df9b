//! Warnings: results that stand, but deserve a second look.

use super::record::Observer;

/// A result that stands, but deserves a second look.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// Key of the case that it is about, such as `crack[0]`.
    pub key: Option<String>,
    /// What happened, with numbers, and what to do.
    pub message: String,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.key.iter().try_for_each(|key| write!(f, "{key}: "))?;
        f.write_str(&self.message)
    }
}

/// The key of a crack of a case.
pub(super) fn crack_key(crack: usize) -> String {
    format!("crack[{crack}]")
}

/// Tells the observer of warnings and keeps them.
pub(super) struct Warnings<'a> {
    pub observer: &'a mut dyn Observer,
    pub list: Vec<Warning>,
}

impl<'a> Warnings<'a> {
    pub fn new(observer: &'a mut dyn Observer) -> Self {
        Self { observer, list: vec![] }
    }

    pub fn add(&mut self, message: String) {
        self.keep(Warning { key: None, message });
    }

    /// A warning about a key of the case.
    pub fn about(&mut self, key: &str, message: String) {
        self.keep(Warning { key: Some(key.into()), message });
    }

    /// A warning about a crack, by its number.
    pub fn about_crack(&mut self, crack: usize, message: String) {
        self.about(&crack_key(crack), message);
    }

    fn keep(&mut self, warning: Warning) {
        self.observer.warning(&warning);
        self.list.push(warning);
    }
}
