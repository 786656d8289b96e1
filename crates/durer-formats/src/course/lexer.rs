//! Splits the scene language into words, braces and comments.

use durer_diag::Span;

/// Kind of a token of the scene language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// Sequence of characters other than whitespace and braces, which is a keyword, a number or a
    /// path.
    Word,
    /// `{`
    Open,
    /// `}`
    Close,
    /// Comment, which extends to the end of its line.
    Comment,
}

/// Token of a scene file, with its kind and its span.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token {
    pub kind: TokenKind,
    pub span: Span,
    /// True if there is no space between the token and the one before it, as for `{` in `Group{`.
    pub touches: bool,
}

/// Splits a file into tokens. A comment begins with `#` or `//` at the start of a word.
pub(super) fn tokens(bytes: &[u8], file: u32) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut at = 0;
    // Editors on Windows may put a byte order mark at the beginning.
    if bytes.starts_with(b"\xef\xbb\xbf") {
        at = 3;
    }
    let mut last_end = usize::MAX;
    while at < bytes.len() {
        let start = at;
        let kind = match bytes[at] {
            b if is_blank(b) => {
                at += 1;
                continue;
            }
            b'{' => TokenKind::Open,
            b'}' => TokenKind::Close,
            b'#' => TokenKind::Comment,
            b'/' if bytes.get(at + 1) == Some(&b'/') => TokenKind::Comment,
            _ => TokenKind::Word,
        };
        at += match kind {
            TokenKind::Open | TokenKind::Close => 1,
            TokenKind::Comment => length(&bytes[at..], |b| b == b'\n' || b == b'\r'),
            TokenKind::Word => length(&bytes[at..], |b| is_blank(b) || b == b'{' || b == b'}'),
        };
        let span = Span { file, start: start as u32, end: at as u32 };
        tokens.push(Token { kind, span, touches: last_end == start });
        last_end = at;
    }
    tokens
}

/// Returns true if a text is a single word, which is required of paths.
pub(crate) fn is_word(text: &str) -> bool {
    let whole = |token: &Token| token.kind == TokenKind::Word && token.span.end as usize == text.len();
    matches!(tokens(text.as_bytes(), 0).as_slice(), [token] if whole(token) && token.span.start == 0)
}

fn is_blank(b: u8) -> bool {
    b.is_ascii_whitespace() || b == 0x0b || b == 0
}

fn length(bytes: &[u8], ends: impl Fn(u8) -> bool) -> usize {
    bytes.iter().position(|&b| ends(b)).unwrap_or(bytes.len())
}
