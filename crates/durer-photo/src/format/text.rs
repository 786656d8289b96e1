//! Tokenizer for text files that tracks lines and columns.

use crate::Error;
use std::fmt::Display;
use std::str::FromStr;

/// Reader of the whitespace-separated words of a text file, which tracks the line and column for
/// error messages.
pub struct TokenReader<'t> {
    file: &'t str,
    text: &'t str,
    /// Byte offset at which the search for the next word begins.
    at: usize,
    line: usize,
    /// Byte offset at which the current line begins.
    start: usize,
    /// True if each line of the file is a row.
    rows: bool,
}

impl<'t> TokenReader<'t> {
    /// Creates a reader of the words of a file.
    pub fn new(file: &'t str, bytes: &'t [u8]) -> Result<Self, Error> {
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let before = &bytes[..error.valid_up_to()];
            let line = 1 + before.iter().filter(|b| **b == b'\n').count();
            let column = 1 + before.len() - before.iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
            Error::at(file, (line, column), "the file is not a text file")
        })?;
        Ok(TokenReader { file, text, at: 0, line: 1, start: 0, rows: false })
    }

    /// Creates a reader of a file in which each line is a row. If a word is missing from a row,
    /// this is an error, and the word is not taken from the next line.
    pub fn in_rows(file: &'t str, bytes: &'t [u8]) -> Result<Self, Error> {
        Ok(TokenReader { rows: true, ..TokenReader::new(file, bytes)? })
    }

    fn position(&self) -> (usize, usize) {
        (self.line, 1 + self.text[self.start..self.at].chars().count())
    }

    /// Returns the line and column of the next word.
    pub fn next_position(&mut self) -> (usize, usize) {
        self.advance(true);
        self.position()
    }

    /// Creates an error at the position of the next word.
    pub fn error(&self, message: impl Into<String>) -> Error {
        Error::at(self.file, self.position(), message)
    }

    /// Skips to the next word, and continues on following lines if `over_lines` is true. Returns
    /// false if there is no next word.
    fn advance(&mut self, over_lines: bool) -> bool {
        for byte in self.text.as_bytes()[self.at..].iter() {
            match byte {
                b'\n' if !over_lines => return false,
                b'\n' => {
                    self.line += 1;
                    self.start = self.at + 1;
                }
                byte if !byte.is_ascii_whitespace() => return true,
                _ => {}
            }
            self.at += 1;
        }
        false
    }

    /// Returns true if no words are left.
    pub fn is_at_end(&mut self) -> bool {
        !self.advance(true)
    }

    /// Returns true if no words are left in the current line.
    pub fn is_at_end_of_line(&mut self) -> bool {
        !self.advance(false)
    }

    /// Returns the rest of the current line without surrounding spaces.
    pub fn rest_of_line(&mut self) -> &'t str {
        let rest = self.text[self.at..].split('\n').next().unwrap_or_default();
        self.at += rest.len();
        rest.trim()
    }

    /// Skips the end of the current line if all its words have been read.
    pub fn skip_line_end(&mut self) {
        if !self.advance(false) && self.text[self.at..].starts_with('\n') {
            self.at += 1;
            self.line += 1;
            self.start = self.at;
        }
    }

    /// Skips to the next line that is neither empty nor a comment. Comments begin with the
    /// character `comment`.
    pub fn next_line(&mut self, comment: char) -> bool {
        while self.advance(true) {
            if !self.text[self.at..].starts_with(comment) {
                return true;
            }
            self.rest_of_line();
        }
        false
    }

    /// Returns the next word and its position.
    pub fn word(&mut self, what: &str) -> Result<(&'t str, (usize, usize)), Error> {
        if !self.advance(!self.rows) {
            let end = if self.rows { "row" } else { "file" };
            return Err(self.error(format!("the {end} ends where {what} should follow")));
        }
        let place = self.position();
        let word = self.text[self.at..].split_ascii_whitespace().next().unwrap_or_default();
        self.at += word.len();
        Ok((word, place))
    }

    /// Parses the next word.
    pub fn parse<T: FromStr>(&mut self, what: &str) -> Result<T, Error> {
        let (word, place) = self.word(what)?;
        word.parse().map_err(|_| Error::at(self.file, place, format!("expected {what}, found `{word}`")))
    }

    /// Parses the next word as a finite number.
    pub fn number(&mut self, what: &str) -> Result<f64, Error> {
        let (word, place) = self.word(what)?;
        let number: Option<f64> = word.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| Error::at(self.file, place, format!("expected {what}, found `{word}`")))
    }

    /// Parses the next `N` words as finite numbers.
    pub fn numbers<const N: usize>(&mut self, what: &str) -> Result<[f64; N], Error> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.number(what)?;
        }
        Ok(numbers)
    }

    /// Parses the number of entries in a list, where each entry takes at least `bytes` bytes of
    /// text. A number is rejected before memory is allocated if the rest of the file cannot contain
    /// that many entries.
    pub fn count(&mut self, what: &str, bytes: usize) -> Result<usize, Error> {
        let (word, place) = self.word(what)?;
        let fail = |why: String| Error::at(self.file, place, why);
        let count: usize = word.parse().map_err(|_| fail(format!("expected {what}, found `{word}`")))?;
        if count > self.text.len() / bytes + 1 {
            return Err(fail(format!("{what} is {count}, but the file is too short for that")));
        }
        Ok(count)
    }

    /// Parses the next word as an index below `end`.
    pub fn index(&mut self, what: &str, end: usize) -> Result<usize, Error> {
        let (word, place) = self.word(what)?;
        let index: Option<usize> = word.parse().ok().filter(|index| *index < end);
        index.ok_or_else(|| Error::at(self.file, place, format!("expected {what} less than {end}, found `{word}`")))
    }

    /// Returns an error if any words are left in the current row.
    pub fn end_of_row(&mut self, row: &str) -> Result<(), Error> {
        match self.is_at_end_of_line() {
            true => Ok(()),
            false => Err(self.error(format!("the row should end here, after {row}"))),
        }
    }

    /// Returns an error if any words are left in the file.
    pub fn end(&mut self) -> Result<(), Error> {
        if self.is_at_end() { Ok(()) } else { Err(self.error("the file should end here")) }
    }
}

/// Joins values with spaces.
pub fn join<T: Display>(values: impl IntoIterator<Item = T>) -> String {
    values.into_iter().map(|value| value.to_string()).collect::<Vec<_>>().join(" ")
}
