//! Splits text into words and commands.

use crate::number::parse_f32;
use crate::report::quoted;
use crate::shared_report::SharedReport;
use durer_diag::Span;

/// Word of a Radiance file without its quotes, and its span.
#[derive(Clone, Debug)]
pub(super) struct Word {
    pub text: String,
    pub at: Span,
}

impl Word {
    /// Returns the word in quotes, for use in messages.
    pub fn quoted(&self) -> String {
        quoted(self.text.as_bytes())
    }

    fn parsed(&self) -> Option<f64> {
        parse_f32(self.text.as_bytes()).ok().and_then(|_| self.text.parse::<f64>().ok())
    }

    /// Returns true if the word is a number.
    pub fn is_number(&self) -> bool {
        self.parsed().is_some()
    }

    /// Parses the word as a number, and reports an error if it is not a number.
    pub fn number(&self, report: &SharedReport) -> Option<f64> {
        let number = self.parsed();
        if number.is_none() {
            report.error(self.at, format!("expected a number, found {}", self.quoted()));
        }
        number
    }

    /// Parses the word as a non-negative integer, and reports an error if it is not one.
    pub fn count(&self, report: &SharedReport) -> Option<usize> {
        let count = self.text.parse().ok();
        if count.is_none() {
            report.error(self.at, format!("expected a whole number of 0 or more, found {}", self.quoted()));
        }
        count
    }
}

/// First word of a Radiance primitive, or a command that begins with `!`.
pub(super) enum PrimitiveStart {
    Word(Word),
    /// Range of bytes of a command without its `!`.
    Command(std::ops::Range<usize>),
}

/// Cursor that moves over the words of a Radiance text.
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    file: u32,
    at: usize,
    end: usize,
}

/// Returns true if a byte separates two words.
fn is_space(byte: u8) -> bool {
    byte.is_ascii_whitespace() || byte == 0x0b
}

impl<'a> Words<'a> {
    /// Creates a cursor at the beginning of a range of a file. The file must be smaller than 4 GiB.
    pub fn new(bytes: &'a [u8], file: u32, range: std::ops::Range<usize>) -> Self {
        Words { bytes, file, at: range.start, end: range.end }
    }

    /// Returns the span of a range of bytes.
    pub fn span(&self, start: usize, end: usize) -> Span {
        Span { file: self.file, start: start as u32, end: end as u32 }
    }

    /// Returns true if a word of the text is the first on its line.
    pub fn starts_line(&self, word: &Word) -> bool {
        let before = &self.bytes[..word.at.start as usize];
        before.iter().rev().find(|byte| !is_space(**byte) || **byte == b'\n').is_none_or(|byte| *byte == b'\n')
    }

    /// Returns the span of the position at the end of the text.
    pub fn end(&self) -> Span {
        self.span(self.end, self.end)
    }

    fn peek(&self) -> Option<u8> {
        (self.at < self.end).then(|| self.bytes[self.at])
    }

    /// Returns the next word. A word in single or double quotes can contain spaces. A backslash at
    /// the end of a line is skipped.
    pub fn next(&mut self) -> Option<Word> {
        loop {
            while self.peek().is_some_and(is_space) {
                self.at += 1;
            }
            match self.bytes[self.at..self.end] {
                [b'\\', b'\n', ..] | [b'\\', b'\r', b'\n', ..] => self.at += 2,
                _ => break,
            }
        }
        let first = self.peek()?;
        let quoted = matches!(first, b'"' | b'\'');
        let start = self.at + usize::from(quoted);
        self.at = start;
        while self.peek().is_some_and(|byte| if quoted { byte != first } else { !is_space(byte) }) {
            self.at += 1;
        }
        let word = &self.bytes[start..self.at];
        let at = self.span(start, self.at);
        self.at = (self.at + usize::from(quoted)).min(self.end);
        Some(Word { text: String::from_utf8_lossy(word).into_owned(), at })
    }

    /// Returns the next word or command, and skips comments before it.
    pub fn start(&mut self) -> Option<PrimitiveStart> {
        loop {
            while self.peek().is_some_and(is_space) {
                self.at += 1;
            }
            match self.peek()? {
                b'#' => self.line(),
                b'!' => {
                    let start = self.at + 1;
                    self.line();
                    while self.at < self.end && continued(&self.bytes[start..self.at]) {
                        self.at += 1;
                        self.line();
                    }
                    return Some(PrimitiveStart::Command(start..self.at));
                }
                _ => return self.next().map(PrimitiveStart::Word),
            }
        }
    }

    /// Moves the cursor to the end of the line.
    fn line(&mut self) {
        while self.peek().is_some_and(|byte| byte != b'\n') {
            self.at += 1;
        }
    }
}

/// Returns true if a line is continued on the next line.
fn continued(line: &[u8]) -> bool {
    line.ends_with(b"\\") || line.ends_with(b"\\\r")
}
