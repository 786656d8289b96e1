//! Tokenizer for Wavefront files, which splits a file into statements and each statement into
//! words.

use crate::number::is_not_finite_tail;
use std::ops::Range;

/// Cursor that reads the words of a Wavefront file, one statement after another.
///
/// A statement ends at the end of its line, unless the line ends in a backslash. `#` starts a
/// comment, which always ends at the end of the line. Words are returned as byte ranges, so that no
/// text is copied.
#[derive(Clone)]
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Words<'a> {
    /// Creates a cursor at the start of a file, after a byte order mark if the file has one.
    pub fn new(bytes: &'a [u8]) -> Self {
        Words { bytes, at: if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 } }
    }

    /// Creates a cursor at the start of one of the [`parts`] of a file. Byte ranges are relative to
    /// the whole file.
    pub fn within(bytes: &'a [u8], part: Range<usize>) -> Self {
        let whole = Words::new(&bytes[..part.end]);
        Words { at: whole.at.max(part.start), ..whole }
    }

    /// Moves to the next statement and returns its first word, or `None` at the end of the file.
    pub fn next_statement(&mut self) -> Option<Range<usize>> {
        loop {
            match self.next_word() {
                Some(word) => return Some(word),
                // Skip the line break, if there is one.
                None if self.at < self.bytes.len() => self.at += 1,
                None => return None,
            }
        }
    }

    /// Returns the next word of the current statement.
    pub fn next_word(&mut self) -> Option<Range<usize>> {
        loop {
            match *self.bytes.get(self.at)? {
                b' ' | b'\t' | 0x0b | 0x0c => self.at += 1,
                b'\n' | b'\r' => return None,
                b'#' => {
                    let rest = &self.bytes[self.at..];
                    let length = rest.iter().position(|&byte| byte == b'\n' || byte == b'\r');
                    self.at += length.unwrap_or(rest.len());
                    return None;
                }
                b'\\' if self.continuation() > 0 => self.at += self.continuation(),
                _ => break,
            }
        }
        let start = self.at;
        while let Some(&byte) = self.bytes.get(self.at) {
            if byte > b' ' && byte != b'#' && byte != b'\\' {
                self.at += 1;
                continue;
            }
            let ends = match byte {
                b' ' | b'\t' | 0x0b | 0x0c | b'\n' | b'\r' => true,
                b'\\' => self.continuation() > 0,
                // `#` starts a comment, except in `1.#INF`.
                b'#' => !is_not_finite_tail(&self.bytes[self.at..]),
                _ => false,
            };
            if ends {
                break;
            }
            self.at += 1;
        }
        Some(start..self.at)
    }

    /// Skips the rest of the statement; if any words were left, returns the end of the last one.
    pub fn skip_rest(&mut self) -> Option<usize> {
        std::iter::from_fn(|| self.next_word()).last().map(|word| word.end)
    }

    /// Skips the rest of the statement.
    pub fn skip(&mut self) {
        let rest = &self.bytes[self.at.min(self.bytes.len())..];
        match rest.iter().position(|byte| matches!(byte, b'\n' | b'\r' | b'\\')) {
            Some(length) if rest[length] == b'\\' => _ = self.skip_rest(),
            Some(length) => self.at += length,
            None => self.at = self.bytes.len(),
        }
    }

    /// Returns the length in bytes of a line continuation at the cursor, or 0 if there is none.
    fn continuation(&self) -> usize {
        match self.bytes[self.at..] {
            [b'\\', b'\r', b'\n', ..] => 3,
            [b'\\', b'\n' | b'\r', ..] => 2,
            [b'\\'] => 1,
            _ => 0,
        }
    }
}

/// Splits a file into parts of about one megabyte for parallel reading; each part ends between two
/// statements. The result does not depend on the number of processors.
pub(super) fn parts(bytes: &[u8]) -> Vec<Range<usize>> {
    const SIZE: usize = 1 << 20;
    let mut all = Vec::new();
    let mut start = 0;
    while start < bytes.len() {
        let mut end = (start + SIZE).min(bytes.len());
        while end < bytes.len() {
            let line = bytes[end..].iter().position(|&byte| byte == b'\n');
            end = line.map_or(bytes.len(), |line| end + line + 1);
            let before = bytes[..end].strip_suffix(b"\n").unwrap_or(bytes);
            if !before.strip_suffix(b"\r").unwrap_or(before).ends_with(b"\\") {
                break;
            }
        }
        all.push(start..end);
        start = end;
    }
    all
}
