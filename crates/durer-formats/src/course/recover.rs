//! Recovers from errors, so that one mistake causes only one error message.

use super::lexer::TokenKind;
use super::reader::{Reader, names};
use super::suggestions::{common_mistake, counterpart, misplaced};
use super::words::{block_of, dialects_of};
use crate::report::quoted;
use durer_diag::{Diagnostic, Span, did_you_mean};
use durer_scene::dialect::Dialect;

impl Reader<'_, '_> {
    /// Ends the innermost block before the next token, because that token is not allowed in it.
    pub(super) fn unclosed(&mut self) {
        let Some(block) = self.blocks.pop() else { return };
        if self.unclosed_at != Some(self.at) {
            self.unclosed_at = Some(self.at);
            let span = self.peek().map_or(self.end_span(), |t| t.span);
            let message = format!("`{}` is not allowed in `{}`", self.text(span), self.text(block));
            self.report_unclosed(block, span, message);
        }
    }

    /// Reports that the `}` of a block is probably missing before a word. `message` says why the
    /// word cannot be in the block.
    fn report_unclosed(&mut self, block: Span, word: Span, message: impl Into<String>) {
        let error = Diagnostic::error(message).code("unclosed-block").at(word);
        let error = error.label("a `}` is probably missing before this word");
        self.error(error.fix(Span { end: word.start, ..word }, "}\n").related(block, "opened here"));
    }

    /// Ends the innermost block before the word that was read last, if that word begins a line with
    /// the same indentation as the block. `message` states why the word cannot be in the block.
    pub(super) fn unclosed_by_indentation(&mut self, message: &str) -> bool {
        let (Some(&block), span) = (self.blocks.last(), self.last_span()) else { return false };
        if self.indentation(span).is_none() || self.indentation(span) != self.indentation(block) {
            return false;
        }
        self.blocks.pop();
        self.report_unclosed(block, span, message);
        self.step_back();
        true
    }

    /// Returns the number of blanks before a word that is the first one on its line.
    fn indentation(&self, span: Span) -> Option<usize> {
        let before = self.text(Span { start: 0, end: span.start, ..span });
        let line = before.rsplit('\n').next().unwrap_or_default();
        line.trim().is_empty().then(|| line.chars().count())
    }

    /// Reopens the block that the last `}` closed, because that brace was superfluous.
    pub(super) fn reopen_block(&mut self, keyword: Span, found: u32) {
        let message =
            format!("this `}}` ends `{}` after {found} of its elements, but more elements follow", self.text(keyword));
        let brace = self.last_span();
        let error = Diagnostic::error(message).code("extra-brace").at(brace).fix(brace, "");
        self.error(error.label("this `}` is probably superfluous"));
        self.blocks.push(keyword);
    }

    /// Skips `{ ... }` including all nested blocks.
    pub(super) fn skip_block(&mut self) {
        let mut depth = 0usize;
        while let Some(token) = self.peek() {
            match token.kind {
                TokenKind::Open => depth += 1,
                TokenKind::Close => depth = depth.saturating_sub(1),
                _ => {}
            }
            self.advance();
            if depth == 0 {
                return;
            }
        }
    }

    /// Skips the rest of an invalid value until the next word of the language.
    pub(super) fn skip_values(&mut self) {
        while self.peek_word().is_some_and(|word| dialects_of(&word).is_none()) {
            self.advance();
        }
    }

    /// Skips the value of an unknown word, which can be a word, numbers or a block.
    pub(super) fn skip_value(&mut self) {
        if self.at_open() {
            return self.skip_block();
        }
        let mut first = true;
        while let Some(word) = self.peek_word() {
            let number = word.bytes().next().is_some_and(|b| b.is_ascii_digit() || b"+-.,(".contains(&b));
            if dialects_of(&word).is_some() || !number && !first {
                return;
            }
            self.advance();
            if !number {
                return;
            }
            first = false;
        }
    }

    /// Reports an unknown word, and skips its values or its block.
    pub(super) fn unknown(&mut self, word: &str, span: Span, place: &str, known: &[&str]) {
        let message = match word.parse::<f32>() {
            Ok(_) => format!("unexpected number {} {place}", quoted(word.as_bytes())),
            Err(_) => format!("unknown word {} {place}", quoted(word.as_bytes())),
        };
        let list = || format!("the words allowed here are {}", known.join(", "));
        let help = misplaced(word, place).map(String::from);
        let help = help.or_else(|| self.advice(word, known.iter().copied())).unwrap_or_else(list);
        let error = Diagnostic::error(message).code("unknown-word").at(span).label("not allowed here").help(help);
        self.error(self.with_suggestion(error, word, span, known.iter().copied()));
        while let Some(token) = self.peek() {
            match token.kind {
                TokenKind::Close => return,
                TokenKind::Open => return self.skip_block(),
                _ if known.contains(&self.text(token.span).as_str()) => return,
                _ => {
                    self.advance();
                }
            }
        }
    }

    /// Returns the valid word that was probably intended when an unknown word was written. A word
    /// that exists in the language is replaced only if the two words differ only in case.
    fn suggest<'w>(&self, word: &str, known: impl IntoIterator<Item = &'w str>) -> Option<&'w str> {
        let known: Vec<&str> = known.into_iter().collect();
        let there = counterpart(word, self.options.dialect);
        if let Some(there) = known.iter().find(|known| there == Some(*known)) {
            return Some(there);
        }
        if let Some((suggestion, _)) = common_mistake(word, known.iter().copied()) {
            return Some(suggestion);
        }
        let near = did_you_mean(word, known).filter(|near| *near != word)?;
        // A word with another case, or in the plural, is meant even if it is a word elsewhere.
        let is_form = near.eq_ignore_ascii_case(word) || near.strip_suffix('s') == Some(word);
        (dialects_of(word).is_none() || is_form).then_some(near)
    }

    /// Adds a fix to an error about a word. The fix replaces the word with the one that was
    /// probably intended, if there is one.
    pub(super) fn with_suggestion<'w>(
        &self,
        error: Diagnostic,
        word: &str,
        span: Span,
        known: impl IntoIterator<Item = &'w str>,
    ) -> Diagnostic {
        let suggestion = self.suggest(word, known);
        error.fix_at(suggestion.map(|_| span), suggestion.unwrap_or_default())
    }

    /// Returns help for a word that is not allowed where it appears.
    pub(super) fn advice<'w>(&self, word: &str, known: impl IntoIterator<Item = &'w str>) -> Option<String> {
        let known: Vec<&str> = known.into_iter().collect();
        let year = self.options.dialect.name();
        if let Some(near) = self.suggest(word, known.iter().copied()) {
            let remark =
                common_mistake(word, known.iter().copied()).map(|slip| slip.1).filter(|remark| !remark.is_empty());
            return Some(match (counterpart(word, self.options.dialect), remark) {
                (Some(there), _) if there == near => format!("write `{near}` in {year}"),
                (_, Some(remark)) => format!("did you mean `{near}`? {remark}"),
                _ => format!("did you mean `{near}`?"),
            });
        }
        let set = dialects_of(word)?;
        let nodes = self.options.dialect == Dialect::F23;
        if let Some(there) = counterpart(word, self.options.dialect) {
            return Some(format!("`{word}` is a word of {}; write `{there}` in {year}", names(set)));
        }
        if nodes && !Dialect::F23.is_in(set) || !nodes && set == Dialect::F23 as u8 {
            return Some(format!("`{word}` is a word of {}", names(set)));
        }
        block_of(word).map(|home| format!("`{word}` belongs in a `{home}` block"))
    }
}
