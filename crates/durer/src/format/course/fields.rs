//! Reading the fields of any described thing.

use super::lexer::TokenKind;
use super::reader::Reader;
use crate::describe::{DescribedList, Field, FileName, Kind, Rule, Value};
use crate::diag::{Diagnostic, Span, did_you_mean};
use crate::dialect::DialectSet;
use crate::math::Vec3;

/// Whether the old parsers wanted the fields in the order in which they are listed.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Order {
    Listed,
    Any,
}

impl Reader<'_, '_> {
    /// Reads `{ field value ... }` into a thing. `extra` may take words that are no fields; it says whether it did.
    pub(super) fn fields<T: DescribedList>(
        &mut self,
        thing: &mut T,
        keyword: Span,
        order: Order,
        mut extra: impl FnMut(&mut Self, &str, Span) -> bool,
    ) {
        let name = self.text(keyword);
        if !self.open(&name) {
            return;
        }
        let fields = thing.fields();
        let mut given = vec![None; fields.len()];
        let mut last = 0;
        while let Some((word, span)) = self.word_before_close(&name) {
            let Some(index) = self.field_of(fields, &given, &word) else {
                if !extra(self, &word, span) {
                    self.unknown_field(fields, &name, &word, span);
                }
                continue;
            };
            let field = &fields[index];
            if field.spelling(self.options.dialect) != Some(word.as_str()) {
                let set = field.spellings.iter().find(|(w, _)| *w == word).map_or(0, |s| s.1);
                self.foreign(&word, span, set);
            }
            if order == Order::Listed && index < last && self.options.strict {
                self.error(Diagnostic::error(format!("`{word}` must be written earlier in `{name}`")).at(span));
            }
            last = index;
            if let Some(first) = given[index] {
                let message = format!("`{word}` is given twice; the last counts");
                self.diagnostics.push(Diagnostic::warning(message).at(span).related(first, "first given here"));
            }
            given[index] = Some(span);
            if let Some(value) = self.value(field, &word, span) {
                thing.set(index, value);
            } else {
                self.skip_values(fields);
            }
        }
        let dialect = self.options.dialect;
        for (field, _) in fields.iter().zip(&given).filter(|(f, g)| f.required && g.is_none()) {
            // A field without a word here has a fixed value: the centre of a sphere in a node, say.
            let Some(word) = field.spelling(dialect) else { continue };
            self.error(Diagnostic::error(format!("`{name}` has no `{word}`")).at(keyword));
        }
    }

    /// The field that a word names; where two fields share it, the first that is not given yet.
    fn field_of(&self, fields: &[Field], given: &[Option<Span>], word: &str) -> Option<usize> {
        let named = |f: &Field| f.spellings.iter().any(|(w, _)| *w == word);
        let native = |f: &Field| f.spelling(self.options.dialect) == Some(word);
        let free = |i: &usize| given[*i].is_none();
        let all =
            |test: &dyn Fn(&Field) -> bool| -> Vec<usize> { (0..fields.len()).filter(|&i| test(&fields[i])).collect() };
        let mut candidates = all(&native);
        if candidates.is_empty() {
            candidates = all(&named);
        }
        candidates.iter().copied().find(free).or(candidates.last().copied())
    }

    fn unknown_field(&mut self, fields: &[Field], name: &str, word: &str, span: Span) {
        let known: Vec<&str> = fields.iter().flat_map(|f| f.spellings.iter().map(|s| s.0)).collect();
        let mut error = Diagnostic::error(format!("`{name}` has no field `{word}`")).at(span).label("not known here");
        error = match did_you_mean(word, known.iter().copied()) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => {
                let mut words: Vec<&str> = Vec::new();
                for field in fields {
                    if let Some(word) = field.spelling(self.options.dialect)
                        && !words.contains(&word)
                    {
                        words.push(word);
                    }
                }
                error.help(format!("its fields are {}", words.join(", ")))
            }
        };
        self.error(error);
        self.skip_values(fields);
    }

    /// After an error: passes over what cannot be a field, and over a whole block.
    fn skip_values(&mut self, fields: &[Field]) {
        while let Some(token) = self.peek() {
            match token.kind {
                TokenKind::Close => return,
                TokenKind::Open => self.skip_block(),
                _ => {
                    let word = self.text(token.span);
                    let field = fields.iter().any(|f| f.spellings.iter().any(|s| s.0 == word));
                    let number = word.bytes().next().is_some_and(|b| !b.is_ascii_alphabetic());
                    if field || !number {
                        return;
                    }
                    self.advance();
                }
            }
        }
    }

    /// Reads a value of a field's kind and checks its rule.
    fn value(&mut self, field: &Field, word: &str, keyword: Span) -> Option<Value> {
        let start = self.peek().map(|t| t.span);
        let value = match field.kind {
            Kind::Float => Value::Float(self.number(word, 1, 1)?),
            Kind::Int => Value::Int(self.whole(word)?),
            Kind::Vec3 => Value::Vec3(self.vec3(word)?),
            Kind::Path => {
                let token = self.peek().filter(|t| t.kind == TokenKind::Word);
                let Some(token) = token else {
                    self.expected("a path", word);
                    return None;
                };
                self.advance();
                Value::Path(FileName { path: self.text(token.span), span: token.span })
            }
        };
        if field.rule != Rule::Any
            && let Some(violation) = field.rule.violation(&value)
        {
            let span = start.unwrap_or(keyword).to(self.last_span());
            self.error(Diagnostic::error(format!("`{word}` {violation}")).at(span));
        }
        Some(value)
    }

    /// Three numbers.
    pub(super) fn vec3(&mut self, word: &str) -> Option<Vec3> {
        let x = self.number(word, 1, 3)?;
        let y = self.number(word, 2, 3)?;
        let z = self.number(word, 3, 3)?;
        Some(Vec3::new(x, y, z))
    }

    /// A whole number, zero or more.
    pub(super) fn whole(&mut self, word: &str) -> Option<u32> {
        let token = self.peek().filter(|t| t.kind == TokenKind::Word);
        let text = token.map(|t| self.text(t.span)).unwrap_or_default();
        match text.parse::<u32>() {
            Ok(value) => {
                self.advance();
                Some(value)
            }
            Err(_) => {
                self.expected("a whole number", word);
                None
            }
        }
    }

    /// The i-th of `count` finite numbers.
    pub(super) fn number(&mut self, word: &str, i: usize, count: usize) -> Option<f32> {
        let token = self.peek().filter(|t| t.kind == TokenKind::Word);
        let text = token.map(|t| self.text(t.span)).unwrap_or_default();
        // Rust also parses words such as `inf` and `nan`: a number has a digit first.
        let numeric = text.trim_start_matches(['+', '-', '.']).starts_with(|c: char| c.is_ascii_digit());
        match text.parse::<f32>() {
            Ok(value) if numeric && value.is_finite() => {
                self.advance();
                Some(value)
            }
            Ok(_) if numeric => {
                let span = self.advance();
                self.error(Diagnostic::error(format!("`{text}` is too large a number")).at(span));
                Some(0.0)
            }
            _ => {
                let what = if count == 1 { "a number".into() } else { format!("number {i} of {count}") };
                self.expected(&what, word);
                None
            }
        }
    }

    /// Reports that something else stands where a value should.
    pub(super) fn expected(&mut self, what: &str, after: &str) {
        let (found, span) = match self.peek() {
            Some(token) => (format!("found `{}`", self.text(token.span)), token.span),
            None => ("the file ends".into(), self.end_span()),
        };
        let message = format!("`{after}` needs {what}, but {found}");
        self.error(Diagnostic::error(message).at(span).label(format!("{what} expected")));
    }

    /// A word that this dialect does not have: refused if strict, else taken with a warning, once.
    pub(super) fn foreign(&mut self, word: &str, span: Span, set: DialectSet) {
        let dialect = self.options.dialect;
        if dialect.is_in(set) || dialect == crate::dialect::Dialect::Durer && !self.options.strict {
            return;
        }
        let years: Vec<&str> = crate::dialect::Dialect::ALL.iter().filter(|d| d.is_in(set)).map(|d| d.name()).collect();
        let years = if years.is_empty() { "no dialect".to_string() } else { years.join(", ") };
        let message = format!("`{word}` is not a word of {}, but of {years}", dialect.name());
        if self.options.strict {
            self.error(Diagnostic::error(message).at(span));
        } else if self.foreign_seen.insert(word.to_string()) {
            self.diagnostics.push(Diagnostic::warning(message).at(span));
        }
    }
}
