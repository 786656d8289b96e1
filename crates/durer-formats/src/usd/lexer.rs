//! Tokens of USD text files.

use durer_diag::Span;
use std::fmt;

/// Error in a text file, with its position.
pub(super) struct SyntaxError {
    pub at: Span,
    pub message: String,
}

/// Token of a text file. Names can contain `:` and `.`.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token<'a> {
    Word(&'a str),
    Number(f64),
    /// String in quotes, without the quotes and with escapes replaced.
    Text(String),
    /// File name between `@`.
    Asset(String),
    /// Path between `<` and `>`.
    Path(String),
    Symbol(char),
    End,
}

impl fmt::Display for Token<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Token::Word(word) => write!(f, "`{word}`"),
            Token::Number(number) => write!(f, "the number {number}"),
            Token::Text(_) => f.write_str("a string"),
            Token::Asset(name) => write!(f, "the file `@{}@`", name.escape_debug()),
            Token::Path(path) => write!(f, "the path `<{}>`", path.escape_debug()),
            Token::Symbol(symbol) => write!(f, "`{}`", symbol.escape_debug()),
            Token::End => f.write_str("the end of the file"),
        }
    }
}

/// Splits a text into tokens, with one token of look-ahead.
pub(super) struct Lexer<'a> {
    text: &'a str,
    file: u32,
    at: usize,
    /// Span of the last token that was taken.
    last: Span,
    /// Next token and its span, if it has been looked at.
    ahead: Option<(Token<'a>, Span)>,
}

type Lexed<T> = Result<T, SyntaxError>;

impl<'a> Lexer<'a> {
    /// Creates a lexer for a text; `file` is its number, for spans.
    pub fn new(text: &'a str, file: u32) -> Self {
        Lexer { text, file, at: 0, last: Span { file, start: 0, end: 0 }, ahead: None }
    }

    /// Returns the span of the last token that was taken.
    pub fn last(&self) -> Span {
        self.last
    }

    /// Returns the next token without taking it.
    pub fn peek(&mut self) -> Lexed<Token<'a>> {
        if self.ahead.is_none() {
            self.ahead = Some(self.scan()?);
        }
        Ok(self.ahead.as_ref().map_or(Token::End, |(token, _)| token.clone()))
    }

    /// Takes the next token.
    pub fn next(&mut self) -> Lexed<Token<'a>> {
        let (token, span) = match self.ahead.take() {
            Some(ahead) => ahead,
            None => self.scan()?,
        };
        self.last = span;
        Ok(token)
    }

    /// Takes the next token if it is this symbol.
    pub fn accept(&mut self, symbol: &str) -> Lexed<bool> {
        let found = matches!(self.peek()?, Token::Symbol(c) if symbol.starts_with(c));
        if found {
            self.next()?;
        }
        Ok(found)
    }

    /// Takes the next token, which must be this symbol.
    pub fn expect(&mut self, symbol: &str) -> Lexed<()> {
        let token = self.next()?;
        match token {
            Token::Symbol(c) if symbol.starts_with(c) => Ok(()),
            other => Err(SyntaxError { at: self.last, message: format!("expected `{symbol}`, found {other}") }),
        }
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span { file: self.file, start: start as u32, end: end as u32 }
    }

    fn scan(&mut self) -> Lexed<(Token<'a>, Span)> {
        self.skip_space();
        let (start, rest) = (self.at, &self.text[self.at..]);
        let Some(first) = rest.chars().next() else { return Ok((Token::End, self.span(start, start))) };
        let token = match first {
            '"' | '\'' => self.quoted(first)?,
            '@' => self.asset()?,
            '<' => {
                let Some(length) = rest.find(['>', '\n']).filter(|i| rest.as_bytes()[*i] == b'>') else {
                    return Err(SyntaxError { at: self.span(start, start + 1), message: "a `>` is missing".into() });
                };
                self.at += length + 1;
                Token::Path(rest[1..length].to_string())
            }
            '0'..='9' | '-' | '+' | '.' => self.number()?,
            c if c.is_alphabetic() || c == '_' => {
                let part = |c: char| c.is_alphanumeric() || matches!(c, '_' | ':' | '.' | '|');
                let length = rest.find(|c| !part(c)).unwrap_or(rest.len());
                self.at += length;
                match &rest[..length] {
                    "inf" => Token::Number(f64::INFINITY),
                    "nan" => Token::Number(f64::NAN),
                    word => Token::Word(word),
                }
            }
            symbol => {
                self.at += symbol.len_utf8();
                Token::Symbol(symbol)
            }
        };
        Ok((token, self.span(start, self.at)))
    }

    /// Skips white space and comments.
    fn skip_space(&mut self) {
        loop {
            let rest = &self.text[self.at..];
            self.at += rest.len() - rest.trim_start().len();
            let rest = &self.text[self.at..];
            if rest.starts_with('#') || rest.starts_with("//") {
                self.at += rest.find('\n').unwrap_or(rest.len());
            } else if rest.starts_with("/*") {
                self.at += rest.find("*/").map_or(rest.len(), |end| end + 2);
            } else {
                return;
            }
        }
    }

    fn number(&mut self) -> Lexed<Token<'a>> {
        let rest = &self.text[self.at..];
        let part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.');
        let length = rest.find(|c| !part(c)).unwrap_or(rest.len());
        let word = &rest[..length];
        let number = word.parse::<f64>();
        self.at += length;
        number.map(Token::Number).map_err(|_| SyntaxError {
            at: self.span(self.at - length, self.at),
            message: format!("`{word}` is not a number"),
        })
    }

    fn quoted(&mut self, quote: char) -> Lexed<Token<'a>> {
        let rest = &self.text[self.at..];
        let triple: String = [quote; 3].iter().collect();
        let (open, close) = match rest.starts_with(&triple) {
            true => (3, triple.as_str()),
            false => (1, &triple[..1]),
        };
        let (mut text, mut at) = (String::new(), open);
        loop {
            let tail = &rest[at..];
            if tail.starts_with(close) {
                self.at += at + open;
                return Ok(Token::Text(text));
            }
            let mut chars = tail.chars();
            match chars.next() {
                None => break,
                Some('\n') if open == 1 => break,
                Some('\\') => {
                    let Some(escaped) = chars.next() else { break };
                    text.push(match escaped {
                        'n' => '\n',
                        't' => '\t',
                        'r' => '\r',
                        other => other,
                    });
                    at += 1 + escaped.len_utf8();
                }
                Some(c) => {
                    text.push(c);
                    at += c.len_utf8();
                }
            }
        }
        let message = format!("the string does not end: a `{close}` is missing");
        Err(SyntaxError { at: self.span(self.at, self.at + open), message })
    }

    fn asset(&mut self) -> Lexed<Token<'a>> {
        let rest = &self.text[self.at..];
        let close = if rest.starts_with("@@@") { "@@@" } else { "@" };
        let Some(length) = rest[close.len()..].find(close) else {
            let message = format!("the file name does not end: a `{close}` is missing");
            return Err(SyntaxError { at: self.span(self.at, self.at + 1), message });
        };
        self.at += length + 2 * close.len();
        Ok(Token::Asset(rest[close.len()..close.len() + length].to_string()))
    }
}
