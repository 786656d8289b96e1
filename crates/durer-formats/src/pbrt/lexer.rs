//! Lexer for pbrt files, which splits them into words (directives and numbers), quoted strings and
//! brackets. `#` starts a comment.

use crate::report::quoted;
use crate::shared_report::SharedReport;
use durer_diag::{Diagnostic, Span};
use std::sync::Arc;

/// Token of a pbrt scene file: a word, a quoted string or a bracket.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token {
    /// Word: a directive, a number, `true` or `false`.
    Word,
    /// Quoted string, after its escape sequences have been replaced.
    Text(String),
    /// `[`
    Open,
    /// `]`
    Close,
}

/// Token of a pbrt scene file with its span.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SpannedToken {
    pub token: Token,
    pub at: Span,
}

/// Lexer for the tokens of one pbrt file, with one token of lookahead.
pub(super) struct Lexer {
    bytes: Arc<[u8]>,
    file: u32,
    at: usize,
    peeked: Option<SpannedToken>,
}

impl Lexer {
    /// Creates a lexer for a file, which must be smaller than 4 GiB. Skips a byte order mark.
    pub fn new(bytes: Arc<[u8]>, file: u32) -> Self {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Lexer { bytes, file, at, peeked: None }
    }

    /// Returns the bytes of a token.
    pub fn bytes(&self, at: Span) -> &[u8] {
        &self.bytes[at.start as usize..at.end as usize]
    }

    /// Returns the text of a token, or an empty string if it is not valid UTF-8.
    pub fn word(&self, at: Span) -> &str {
        std::str::from_utf8(self.bytes(at)).unwrap_or_default()
    }

    /// Returns the text of a token in quotes, for use in messages.
    pub fn quoted(&self, at: Span) -> String {
        quoted(self.bytes(at))
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span { file: self.file, start: start as u32, end: end as u32 }
    }

    /// Returns the next token without consuming it.
    pub fn peek(&mut self, report: &SharedReport) -> Option<&SpannedToken> {
        if self.peeked.is_none() {
            self.peeked = self.read(report);
        }
        self.peeked.as_ref()
    }

    /// Consumes and returns the next token.
    pub fn next(&mut self, report: &SharedReport) -> Option<SpannedToken> {
        self.peeked.take().or_else(|| self.read(report))
    }

    fn read(&mut self, report: &SharedReport) -> Option<SpannedToken> {
        loop {
            match *self.bytes.get(self.at)? {
                b' ' | b'\t' | b'\r' | b'\n' => self.at += 1,
                b'#' => self.at += self.bytes[self.at..].iter().take_while(|&&b| b != b'\n').count(),
                _ => break,
            }
        }
        let start = self.at;
        let token = match self.bytes[start] {
            b'[' => Token::Open,
            b']' => Token::Close,
            b'"' => return Some(self.text(start, report)),
            _ => {
                let ends = |b: &&u8| !matches!(b, b' ' | b'\t' | b'\r' | b'\n' | b'"' | b'[' | b']' | b'#');
                self.at += self.bytes[start..].iter().take_while(ends).count();
                return Some(SpannedToken { token: Token::Word, at: self.span(start, self.at) });
            }
        };
        self.at += 1;
        Some(SpannedToken { token, at: self.span(start, self.at) })
    }

    /// Reads a quoted string, which must end on the same line. The returned span excludes the
    /// quotes.
    fn text(&mut self, start: usize, report: &SharedReport) -> SpannedToken {
        let mut text = Vec::new();
        self.at = start + 1;
        loop {
            match self.bytes.get(self.at) {
                Some(b'"') => break,
                Some(b'\\') => {
                    let letter = self.bytes.get(self.at + 1).copied();
                    text.push(match letter {
                        Some(b'n') => b'\n',
                        Some(b't') => b'\t',
                        Some(b'r') => b'\r',
                        Some(b'b') => 8,
                        Some(b'f') => 12,
                        Some(letter @ (b'"' | b'\\' | b'\'')) => letter,
                        _ => {
                            let at = self.span(self.at, (self.at + 2).min(self.bytes.len()));
                            report.error(
                                at,
                                "unknown escape: `\\` must be followed by b, f, n, r, t, a quote or another `\\`",
                            );
                            b'\\'
                        }
                    });
                    // Skip the backslash and the byte after it, even if the escape sequence is
                    // unknown.
                    self.at = (self.at + 2).min(self.bytes.len());
                }
                Some(b'\n') | None => {
                    let error = Diagnostic::error("this string is not closed: add a `\"` on the same line");
                    report.push(error.code("unclosed").at(self.span(start, self.at)));
                    let at = self.span(start + 1, self.at);
                    return SpannedToken { token: Token::Text(String::from_utf8_lossy(&text).into_owned()), at };
                }
                Some(&letter) => {
                    text.push(letter);
                    self.at += 1;
                }
            }
        }
        let at = self.span(start + 1, self.at);
        self.at += 1;
        SpannedToken { token: Token::Text(String::from_utf8_lossy(&text).into_owned()), at }
    }
}
