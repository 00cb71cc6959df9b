//! Lines of an input file to keywords with their parameters and data lines.

use super::AbaqusError;

/// A keyword with what belongs to it.
pub(super) struct Block<'t> {
    /// In capitals with single blanks, such as `SOLID SECTION`.
    pub keyword: String,
    /// Names in capitals; values as written, empty without one.
    pub parameters: Vec<(String, String)>,
    /// Line of the keyword, from 1.
    pub line: usize,
    /// Data lines with their numbers.
    pub data: Vec<(usize, &'t str)>,
}

impl<'t> Block<'t> {
    /// The value of a parameter.
    pub fn parameter(&self, name: &str) -> Option<&str> {
        self.parameters.iter().find(|p| p.0 == name).map(|p| p.1.as_str())
    }

    /// The value of a parameter that must be there.
    pub fn required(&self, name: &str) -> Result<&str, AbaqusError> {
        let value = self.parameter(name).filter(|v| !v.is_empty());
        value.ok_or_else(|| self.error(self.line, format!("{name}= is missing")))
    }

    /// An error in this block.
    #[cold]
    pub fn error(&self, line: usize, problem: impl Into<String>) -> AbaqusError {
        AbaqusError::Line { line, keyword: self.keyword.clone(), problem: problem.into() }
    }

    /// Fields of all data lines with the number of the line.
    pub fn rows(&self) -> impl Iterator<Item = (usize, Vec<&'t str>)> + '_ {
        self.data.iter().map(|&(line, text)| (line, fields(text)))
    }

    /// A whole number of at least 1.
    pub fn label(&self, line: usize, text: &str, what: &str) -> Result<u64, AbaqusError> {
        let label = text.parse().ok().filter(|n| *n > 0);
        label.ok_or_else(|| self.error(line, format!("`{}` is not {what}", shortened(text))))
    }

    /// A finite number; exponents may be written with a D, as in Fortran.
    pub fn number(&self, line: usize, text: &str, what: &str) -> Result<f64, AbaqusError> {
        let value: Option<f64> = text.replace(['d', 'D'], "e").parse().ok();
        let finite = value.filter(|v| v.is_finite());
        finite.ok_or_else(|| self.error(line, format!("`{}` is not {what}", shortened(text))))
    }
}

/// Fields between commas without blanks; a comma at the end adds none.
fn fields(text: &str) -> Vec<&str> {
    let mut fields: Vec<&str> = text.split(',').map(str::trim).collect();
    if fields.last() == Some(&"") {
        fields.pop();
    }
    fields
}

/// At most 30 characters, for messages.
pub(super) fn shortened(text: &str) -> String {
    if text.chars().count() <= 30 { text.into() } else { text.chars().take(30).collect::<String>() + "…" }
}

/// All blocks of a file, in order.
pub(super) fn blocks(text: &str) -> Result<Vec<Block<'_>>, AbaqusError> {
    let mut blocks: Vec<Block> = vec![];
    let mut continues = false;
    for (index, line) in text.lines().enumerate() {
        let (number, line) = (index + 1, line.trim());
        if line.is_empty() || line.starts_with("**") {
            continue;
        }
        if let Some(keyword) = line.strip_prefix('*') {
            let mut parts = keyword.split(',');
            let name = parts.next().unwrap_or("").split_whitespace().collect::<Vec<_>>().join(" ").to_uppercase();
            let parameters = parts.filter_map(parameter).collect();
            blocks.push(Block { keyword: name, parameters, line: number, data: vec![] });
            continues = line.ends_with(',');
            continue;
        }
        let Some(block) = blocks.last_mut() else {
            let problem = "the file does not begin with a keyword such as *HEADING or *NODE".to_string();
            return Err(AbaqusError::Line { line: number, keyword: String::new(), problem });
        };
        if continues && block.data.is_empty() {
            block.parameters.extend(line.split(',').filter_map(parameter));
            continues = line.ends_with(',');
        } else {
            block.data.push((number, line));
        }
    }
    Ok(blocks)
}

fn parameter(text: &str) -> Option<(String, String)> {
    let (name, value) = text.split_once('=').unwrap_or((text, ""));
    let name = name.split_whitespace().collect::<Vec<_>>().join(" ").to_uppercase();
    (!name.is_empty()).then(|| (name, value.trim().trim_matches('"').to_string()))
}
