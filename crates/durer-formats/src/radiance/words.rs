//! Words of a text, and commands in it.

use crate::number::parse_f32;
use crate::report::shown;
use crate::said::Said;
use durer_diag::Span;

/// A word, without its quotes, and where it is.
#[derive(Clone, Debug)]
pub(super) struct Word {
    pub text: String,
    pub at: Span,
}

impl Word {
    /// As it is shown in messages.
    pub fn shown(&self) -> String {
        shown(self.text.as_bytes())
    }

    /// The number that it is; complains if it is none.
    pub fn number(&self, said: &Said) -> Option<f64> {
        let number = parse_f32(self.text.as_bytes()).ok().and_then(|_| self.text.parse::<f64>().ok());
        if number.is_none() {
            said.bad(self.at, format!("{} is not a number", self.shown()));
        }
        number
    }

    /// The whole number, 0 or more, that it is; complains if it is none.
    pub fn count(&self, said: &Said) -> Option<usize> {
        let count = self.text.parse().ok();
        if count.is_none() {
            said.bad(self.at, format!("{} is not a whole number, 0 or more", self.shown()));
        }
        count
    }
}

/// What stands where a thing may begin.
pub(super) enum Start {
    Word(Word),
    /// The range of a command, without its `!`.
    Command(std::ops::Range<usize>),
}

/// A text on its way to words.
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    file: u32,
    at: usize,
    end: usize,
}

/// Whether a byte parts words.
fn is_space(byte: u8) -> bool {
    byte.is_ascii_whitespace() || byte == 0x0b
}

impl<'a> Words<'a> {
    /// Of a part of a file's bytes; there are less than 2^32 of them.
    pub fn new(bytes: &'a [u8], file: u32, range: std::ops::Range<usize>) -> Self {
        Words { bytes, file, at: range.start, end: range.end }
    }

    pub fn span(&self, start: usize, end: usize) -> Span {
        Span { file: self.file, start: start as u32, end: end as u32 }
    }

    /// The place where the text ends.
    pub fn end(&self) -> Span {
        self.span(self.end, self.end)
    }

    fn peek(&self) -> Option<u8> {
        (self.at < self.end).then(|| self.bytes[self.at])
    }

    /// The next word; in quotes of either kind it may have spaces. A `\` at the end of a line is
    /// none.
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

    /// The next word or command, behind comments.
    pub fn start(&mut self) -> Option<Start> {
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
                    return Some(Start::Command(start..self.at));
                }
                _ => return self.next().map(Start::Word),
            }
        }
    }

    /// Goes to the end of the line.
    fn line(&mut self) {
        while self.peek().is_some_and(|byte| byte != b'\n') {
            self.at += 1;
        }
    }
}

/// Whether a line goes on in the next.
fn continued(line: &[u8]) -> bool {
    line.ends_with(b"\\") || line.ends_with(b"\\\r")
}
