//! Tokens of ASCII files and numbers of binary files, with the place of each.

use super::{GmshError, Place};

/// Reads on through the bytes of a file.
pub(super) struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    /// Name of the section, for messages.
    pub section: String,
    /// Whether numbers are binary; `None` for ASCII.
    pub order: Option<ByteOrder>,
}

/// Byte order of binary numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ByteOrder {
    Little,
    Big,
}

impl<'a> Scanner<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, line: 1, section: String::new(), order: None }
    }

    /// Where the scanner stands.
    pub fn place(&self) -> Place {
        if self.order.is_some() { Place::Byte(self.at) } else { Place::Line(self.line) }
    }

    /// An error at this place.
    #[cold]
    pub fn error(&self, problem: impl Into<String>) -> GmshError {
        self.error_at(self.place(), problem)
    }

    /// An error at an earlier place.
    #[cold]
    pub fn error_at(&self, place: Place, problem: impl Into<String>) -> GmshError {
        GmshError::Content { place, section: self.section.clone(), problem: problem.into() }
    }

    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    fn advance(&mut self, n: usize) -> &'a [u8] {
        let taken = &self.rest()[..n];
        if self.order.is_none() {
            self.line += taken.iter().filter(|&&b| b == b'\n').count();
        }
        self.at += n;
        taken
    }

    /// The next word in text, or `None` at the end of the file.
    pub fn next_token(&mut self) -> Result<Option<&'a str>, GmshError> {
        let blank = self.rest().iter().take_while(|b| b.is_ascii_whitespace()).count();
        self.advance(blank);
        let length = self.rest().iter().take_while(|b| !b.is_ascii_whitespace()).count();
        let token =
            std::str::from_utf8(&self.rest()[..length]).map_err(|_| self.error("not text where text is due"))?;
        self.advance(length);
        Ok((!token.is_empty()).then_some(token))
    }

    /// The next word in text.
    pub fn token(&mut self, what: &str) -> Result<&'a str, GmshError> {
        self.next_token()?.ok_or_else(|| self.error(format!("the file ends where {what} is due")))
    }

    /// The rest of the line in text, without the line break.
    pub fn rest_of_line(&mut self) -> Result<&'a str, GmshError> {
        let length = self.rest().iter().take_while(|&&b| b != b'\n').count();
        let text = std::str::from_utf8(&self.rest()[..length]).map_err(|_| self.error("the line is not UTF-8"))?;
        self.advance((length + 1).min(self.rest().len()));
        Ok(text.trim())
    }

    /// Goes to the first binary byte: over the end of a line of text. Does nothing in ASCII files.
    pub fn begin_binary(&mut self) -> Result<(), GmshError> {
        if self.order.is_some() && !self.rest_of_line()?.is_empty() {
            return Err(self.error("a line break is due before binary numbers"));
        }
        Ok(())
    }

    /// A number in text, in binary files too.
    pub fn text_number<T: std::str::FromStr>(&mut self, what: &str) -> Result<T, GmshError> {
        let token = self.token(what)?;
        token.parse().map_err(|_| self.error(format!("`{}` is not {what}", shortened(token))))
    }

    /// Raw bytes of a binary file, in little-endian order.
    pub fn raw<const N: usize>(&mut self, what: &str) -> Result<[u8; N], GmshError> {
        if self.rest().len() < N {
            return Err(self.error(format!("the file ends where {what} is due")));
        }
        let mut raw: [u8; N] = self.advance(N).try_into().expect("N bytes were taken");
        if self.order == Some(ByteOrder::Big) {
            raw.reverse();
        }
        Ok(raw)
    }

    /// An `int` of the format.
    pub fn int(&mut self, what: &str) -> Result<i32, GmshError> {
        match self.order {
            None => self.text_number(what),
            Some(_) => Ok(i32::from_le_bytes(self.raw(what)?)),
        }
    }

    /// A `size_t` of the format.
    pub fn size(&mut self, what: &str) -> Result<u64, GmshError> {
        match self.order {
            None => self.text_number(what),
            Some(_) => Ok(u64::from_le_bytes(self.raw(what)?)),
        }
    }

    /// A finite `double`.
    pub fn double(&mut self, what: &str) -> Result<f64, GmshError> {
        let value: f64 = match self.order {
            None => self.text_number(what)?,
            Some(_) => f64::from_le_bytes(self.raw(what)?),
        };
        if value.is_finite() { Ok(value) } else { Err(self.error(format!("{what} is {value}, not a finite number"))) }
    }

    /// Checks that `count` items fit into what is left, each of at least `bytes` binary bytes or `numbers` in text.
    pub fn fitting(&self, count: u64, what: &str, bytes: u64, numbers: u64) -> Result<usize, GmshError> {
        let least = if self.order.is_some() { bytes } else { 2 * numbers };
        let left = self.rest().len() as u64;
        match count.checked_mul(least) {
            Some(needed) if needed <= left => Ok(count as usize),
            _ => Err(self.error(format!("{count} {what} are announced, but only {left} bytes are left"))),
        }
    }

    /// Goes to `text`, wherever it comes next.
    pub fn skip_to(&mut self, text: &str) -> Result<(), GmshError> {
        let found = self.rest().windows(text.len()).position(|w| w == text.as_bytes());
        let n = found.ok_or_else(|| self.error(format!("{text} is missing")))?;
        self.advance(n);
        Ok(())
    }
}

/// At most 30 characters, for messages.
pub(super) fn shortened(text: &str) -> String {
    if text.chars().count() <= 30 { text.into() } else { text.chars().take(30).collect::<String>() + "…" }
}
