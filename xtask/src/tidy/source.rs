//! Rust source as plain text, with code and comments told apart.

/// A file split into what the compiler reads and what people read; both keep the line structure of the file.
#[derive(Debug, Default)]
pub struct Source {
    /// Code; comments, strings and characters are blank.
    pub code: String,
    /// The text of each comment with its line, counted from 1.
    pub comments: Vec<(usize, String)>,
}

impl Source {
    /// Splits the text of a file.
    pub fn new(text: &str) -> Self {
        let mut scanner =
            Scanner { chars: text.chars().collect(), at: 0, line: 1, code: String::new(), comments: vec![] };
        while scanner.at < scanner.chars.len() {
            scanner.step();
        }
        Self { code: scanner.code, comments: scanner.comments }
    }

    /// The code with the bodies of `#[cfg(test)] mod` blocks blanked.
    pub fn code_without_tests(&self) -> String {
        let mut chars: Vec<char> = self.code.chars().collect();
        let text: String = self.code.clone();
        let starts: Vec<usize> = text.match_indices("#[cfg(test)]").map(|(i, _)| text[..i].chars().count()).collect();
        for start in starts {
            let after: String = chars[start + "#[cfg(test)]".len()..].iter().collect();
            if after.trim_start().starts_with("mod ") {
                blank_block(&mut chars, start);
            }
        }
        chars.into_iter().collect()
    }
}

/// Blanks everything from `start` to the end of the first block in braces, or to the semicolon before it.
fn blank_block(chars: &mut [char], start: usize) {
    let mut depth = 0;
    for c in chars[start..].iter_mut() {
        let end = match *c {
            '{' => {
                depth += 1;
                false
            }
            '}' => {
                depth -= 1;
                depth == 0
            }
            ';' => depth == 0,
            _ => false,
        };
        if *c != '\n' {
            *c = ' ';
        }
        if end {
            return;
        }
    }
}

struct Scanner {
    chars: Vec<char>,
    at: usize,
    line: usize,
    code: String,
    comments: Vec<(usize, String)>,
}

impl Scanner {
    fn peek(&self, ahead: usize) -> char {
        self.chars.get(self.at + ahead).copied().unwrap_or('\0')
    }

    /// Moves on by one character, which counts as code if `is_code`.
    fn take(&mut self, is_code: bool) -> char {
        let c = self.chars[self.at];
        self.at += 1;
        if c == '\n' {
            self.line += 1;
        }
        self.code.push(if is_code || c == '\n' { c } else { ' ' });
        c
    }

    fn step(&mut self) {
        match (self.peek(0), self.peek(1)) {
            ('/', '/') => self.line_comment(),
            ('/', '*') => self.block_comment(),
            ('"', _) => self.string(),
            ('r', '"' | '#') | ('b', 'r') if !self.follows_identifier() => self.raw_string(),
            ('\'', _) => self.character_or_lifetime(),
            _ => {
                self.take(true);
            }
        }
    }

    fn follows_identifier(&self) -> bool {
        self.code.chars().next_back().is_some_and(|c| c.is_alphanumeric() || c == '_')
    }

    fn line_comment(&mut self) {
        let line = self.line;
        let mut text = String::new();
        while self.at < self.chars.len() && self.peek(0) != '\n' {
            text.push(self.take(false));
        }
        self.comments.push((line, text));
    }

    fn block_comment(&mut self) {
        let mut depth = 0;
        let mut text = String::new();
        let mut line = self.line;
        while self.at < self.chars.len() {
            let pair = (self.peek(0), self.peek(1));
            let step = if pair == ('/', '*') {
                depth += 1;
                2
            } else if pair == ('*', '/') {
                depth -= 1;
                2
            } else {
                1
            };
            for _ in 0..step {
                let c = self.take(false);
                if c == '\n' {
                    self.comments.push((line, std::mem::take(&mut text)));
                    line = self.line;
                } else {
                    text.push(c);
                }
            }
            if depth == 0 {
                break;
            }
        }
        self.comments.push((line, text));
    }

    fn string(&mut self) {
        self.take(false);
        while self.at < self.chars.len() {
            match self.take(false) {
                '\\' if self.at < self.chars.len() => {
                    self.take(false);
                }
                '"' => return,
                _ => {}
            }
        }
    }

    fn raw_string(&mut self) {
        let mut hashes = 0;
        let mut ahead = if self.peek(0) == 'b' { 2 } else { 1 };
        while self.peek(ahead) == '#' {
            hashes += 1;
            ahead += 1;
        }
        if self.peek(ahead) != '"' {
            // A raw identifier, or an ordinary name.
            self.take(true);
            return;
        }
        for _ in 0..=ahead {
            self.take(false);
        }
        while self.at < self.chars.len() {
            if self.take(false) == '"' && (0..hashes).all(|k| self.peek(k) == '#') {
                for _ in 0..hashes {
                    self.take(false);
                }
                return;
            }
        }
    }

    fn character_or_lifetime(&mut self) {
        let is_character = self.peek(1) == '\\' || self.peek(2) == '\'';
        self.take(true);
        if !is_character {
            return;
        }
        while self.at < self.chars.len() {
            match self.take(false) {
                '\\' if self.at < self.chars.len() => {
                    self.take(false);
                }
                '\'' => return,
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_characters_and_comments_are_not_code() {
        let text = "let a = \"x // \\\" y\"; // one\nlet b = r#\"crate::z\"#; /* two\n/* three */ */ let c = '\\''; fn f<'a>() {}";
        let source = Source::new(text);
        assert!(!source.code.contains("crate") && !source.code.contains("one") && !source.code.contains("three"));
        assert!(source.code.contains("let c = ") && source.code.contains("fn f<'a>() {}"));
        let comments: Vec<_> = source.comments.iter().map(|(l, t)| (*l, t.as_str())).collect();
        assert_eq!(comments, [(1, "// one"), (2, "/* two"), (3, "/* three */ */")]);
        assert_eq!(source.code.lines().count(), text.lines().count());
    }

    #[test]
    fn test_modules_are_blanked() {
        let source = Source::new("use a;\n#[cfg(test)]\nmod tests { fn f() { use b; } }\nuse c;");
        let code = source.code_without_tests();
        assert!(code.contains("use a") && code.contains("use c") && !code.contains("use b"));
    }
}
