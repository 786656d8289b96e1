//! Finds the spans of field values in a scene file. Programs that edit the file use these spans.

use super::lexer::{Token, TokenKind, tokens};
use durer_diag::Span;

/// Returns the tokens that are directly inside the block of a keyword, and the byte offset of the
/// end of the block. Tokens of nested blocks are left out.
fn inside(bytes: &[u8], keyword: Span) -> Option<(Vec<Token>, u32)> {
    let rest = bytes.get(keyword.start as usize..)?;
    // Blocks are short, so do not split the rest of a long file into tokens for each of them.
    let mut reach = 1 << 10;
    loop {
        let part = &rest[..rest.len().min(reach)];
        match block_of(part, keyword) {
            None if part.len() < rest.len() => reach *= 8,
            found => return found,
        }
    }
}

/// Returns the tokens of a block as [`inside`] does, for a text that begins with the keyword.
/// Returns `None` if the block does not end within the text.
fn block_of(text: &[u8], keyword: Span) -> Option<(Vec<Token>, u32)> {
    let moved = |token: Token| {
        let Span { file, start, end } = token.span;
        Token { span: Span { file, start: start + keyword.start, end: end + keyword.start }, ..token }
    };
    let mut rest = tokens(text, keyword.file).into_iter().filter(|token| token.kind != TokenKind::Comment).map(moved);
    rest.next()?;
    // A name can come before the block.
    let next = rest.next()?;
    let open = if next.kind == TokenKind::Word { rest.next()? } else { next };
    if open.kind != TokenKind::Open {
        return None;
    }
    let (mut depth, mut own) = (1, Vec::new());
    for token in rest {
        match token.kind {
            TokenKind::Open => depth += 1,
            TokenKind::Close => depth -= 1,
            _ if depth == 1 => own.push(token),
            _ => {}
        }
        if depth == 0 {
            return Some((own, token.span.end));
        }
    }
    None
}

/// Returns the span of the value of a field, which consists of its numbers or of the single word
/// after the field. If the field is repeated, returns the span of its last value, which takes
/// effect.
pub fn value(bytes: &[u8], keyword: Span, field: &str) -> Option<Span> {
    let text = |span: Span| std::str::from_utf8(&bytes[span.start as usize..span.end as usize]).unwrap_or_default();
    let (own, _) = inside(bytes, keyword)?;
    let at = own.iter().rposition(|token| text(token.span) == field)?;
    let values = &own[at + 1..];
    let numbers = values.iter().take_while(|token| text(token.span).parse::<f32>().is_ok()).count();
    let first = values.first()?.span;
    Some(first.join(values[numbers.max(1) - 1].span))
}

/// Returns the span of the name between the keyword of a block and its opening brace, if the block
/// has a name.
pub fn name(bytes: &[u8], keyword: Span) -> Option<Span> {
    let rest = bytes.get(keyword.end as usize..)?;
    let all = tokens(&rest[..rest.len().min(1 << 10)], keyword.file);
    let mut words = all.into_iter().filter(|token| token.kind != TokenKind::Comment);
    let (name, open) = (words.next()?, words.next()?);
    let Span { file, start, end } = name.span;
    let is_named = name.kind == TokenKind::Word && open.kind == TokenKind::Open;
    is_named.then_some(Span { file, start: start + keyword.end, end: end + keyword.end })
}

/// Returns the span of a complete block, from the keyword to the closing brace.
pub fn block(bytes: &[u8], keyword: Span) -> Option<Span> {
    inside(bytes, keyword).map(|(_, end)| Span { end, ..keyword })
}

/// Returns the span of the keyword of a top-level section. If there are several such sections,
/// returns the span of the last one, which takes effect. Returns `None` if there is no such
/// section.
pub fn section(bytes: &[u8], file: u32, keyword: &str) -> Option<Span> {
    let (mut depth, mut found) = (0, None);
    for token in tokens(bytes, file) {
        match token.kind {
            TokenKind::Open => depth += 1,
            TokenKind::Close => depth -= 1,
            TokenKind::Word
                if depth == 0 && &bytes[token.span.start as usize..token.span.end as usize] == keyword.as_bytes() =>
            {
                found = Some(token.span);
            }
            _ => {}
        }
    }
    found
}

/// Returns the spans of the words that follow each occurrence of a word.
pub fn values(bytes: &[u8], file: u32, word: &str) -> Vec<Span> {
    let tokens: Vec<Token> = tokens(bytes, file).into_iter().filter(|token| token.kind != TokenKind::Comment).collect();
    let is_word = |token: &Token| &bytes[token.span.start as usize..token.span.end as usize] == word.as_bytes();
    tokens
        .windows(2)
        .filter(|pair| is_word(&pair[0]) && pair[1].kind == TokenKind::Word)
        .map(|pair| pair[1].span)
        .collect()
}
