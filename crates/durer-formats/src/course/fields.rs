//! Reads the fields of any statement that has a description.

use super::lexer::TokenKind;
use super::reader::{Reader, names};
use super::words::{begins_block, is_reserved};
use crate::report::quoted;
use durer_diag::{Diagnostic, Span, did_you_mean};
use durer_scene::describe::{Constraint, DescribedKind, Field, FieldKind, FileName, Value};
use durer_scene::dialect::{Dialect, DialectSet, Quirk};
use durer_scene::light::PHOTOMETRIC_FIELDS;
use durer_scene::math::Vec3;

/// Lights of the course, whose programs need a `color`. In Dürer's own dialect, it is white by
/// default.
const LIGHTS: [&str; 2] = ["PointLight", "DirectionalLight"];

/// Order in which the fields of a statement must appear. The order can be free, or it can be the
/// listed order, which the course's parsers require.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Order {
    Listed,
    Any,
}

impl Reader<'_, '_> {
    /// Reads `{ field value ... }` into `item`. The function `extra` is called for words that are
    /// not fields, and returns true if it handled the word.
    pub(super) fn fields<T: DescribedKind>(
        &mut self,
        item: &mut T,
        keyword: Span,
        order: Order,
        mut extra: impl FnMut(&mut Self, &str, Span) -> bool,
    ) {
        let errors = self.errors();
        let name = self.text(keyword);
        if !self.open(keyword) {
            return;
        }
        // If the statement exists only in the Dürer dialect, report its keyword, but do not report
        // its fields as well.
        let ours = item.is_durer_only();
        let fields = item.fields();
        let mut given = vec![None; fields.len()];
        let mut last = 0;
        while let Some((word, span)) = self.word_before_close() {
            let Some(index) = self.field_of(fields, &given, &word) else {
                if extra(self, &word, span) {
                    if order == Order::Listed && given.iter().any(Option::is_some) && self.options.strict {
                        self.error(Diagnostic::error(format!("`{word}` must come first in `{name}`")).at(span));
                    }
                    continue;
                }
                let block = begins_block(&word) && (self.at_open() || self.at_named_block() || word == "MaterialIndex");
                if block && !self.block_continues_after(fields) {
                    self.step_back();
                    self.unclosed();
                    return;
                }
                let after_path = fields.get(last).is_some_and(|f| f.kind == FieldKind::Path) && given[last].is_some();
                self.unknown_field(fields, &name, &word, span, after_path);
                continue;
            };
            let field = &fields[index];
            if !ours && field.keyword(self.options.dialect) != Some(word.as_str()) {
                let set = field.keywords.iter().find(|(w, _)| *w == word).map_or(0, |s| s.1);
                let is_native = fields.iter().any(|field| field.keyword(self.options.dialect) == Some(word.as_str()));
                match is_native {
                    true => self.report_foreign_count(&word, span, set),
                    false => self.report_foreign_word(&word, span, set),
                }
            }
            if order == Order::Listed && index < last && self.options.strict {
                self.error(Diagnostic::error(format!("`{word}` must be written earlier in `{name}`")).at(span));
            }
            last = index;
            if let Some(first) = given[index] {
                let message = format!("`{word}` is given twice; the last one is used");
                let warning = Diagnostic::warning(message).code("repeated").at(span);
                self.diagnostics.push(warning.related(first, "first given here"));
            }
            given[index] = Some(span);
            if let Some(value) = self.value(item.keyword(Dialect::Durer), field, &word, span) {
                item.set(index, value);
            } else {
                self.skip_values();
            }
        }
        // A misspelt word may be the field that appears to be missing.
        if self.errors() > errors || ours && self.options.strict {
            return;
        }
        let dialect = if ours { Dialect::Durer } else { self.options.dialect };
        let has_unit = || fields.iter().zip(&given).any(|(f, g)| g.is_some() && PHOTOMETRIC_FIELDS.contains(&f.name));
        let is_required = |f: &Field| {
            let is_needed = || dialect != Dialect::Durer && f.name == "color" && LIGHTS.contains(&item.own_keyword());
            f.required || is_needed() && !has_unit()
        };
        for (field, _) in fields.iter().zip(&given).filter(|(f, g)| is_required(f) && g.is_none()) {
            // If this dialect has no word for a field, the field has a fixed value. For example,
            // the centre of a sphere in a node is fixed.
            let Some(word) = field.keyword(dialect) else { continue };
            let alike =
                || fields.iter().zip(&given).filter(|(f, _)| is_required(f) && f.keyword(dialect) == Some(word));
            let (wanted, found) = (alike().count(), alike().filter(|(_, place)| place.is_some()).count());
            let message = match found {
                0 => format!("`{name}` has no `{word}`"),
                _ => format!("`{name}` needs {wanted} `{word}` fields, but has {found}"),
            };
            let error = Diagnostic::error(message).code("missing-field").at(keyword);
            self.error(match example(word) {
                Some(value) => error.help(format!("add it to the block, for example `{word} {value}`")),
                None => error,
            });
        }
    }

    /// Returns the index of the field that has the given name. If two fields have the same name,
    /// returns the first one that has no value yet.
    fn field_of(&self, fields: &[Field], given: &[Option<Span>], word: &str) -> Option<usize> {
        let named = |f: &Field| f.keywords.iter().any(|(w, _)| *w == word);
        let native = |f: &Field| f.keyword(self.options.dialect) == Some(word);
        let free = |i: &usize| given[*i].is_none();
        let all =
            |test: &dyn Fn(&Field) -> bool| -> Vec<usize> { (0..fields.len()).filter(|&i| test(&fields[i])).collect() };
        let mut candidates = all(&native);
        // `attenuation` takes one number in 2020 and three numbers in 2004, so the number of values
        // decides which one is meant.
        let numbers = (0..3).take_while(|&i| self.number_ahead(i)).count();
        let fits = |f: &Field| match f.kind {
            FieldKind::Float => numbers == 1,
            FieldKind::Vec3 => numbers == 3,
            _ => true,
        };
        if !candidates.iter().any(|&i| fits(&fields[i])) {
            let other = all(&|f| named(f) && fits(f));
            candidates = if other.is_empty() { candidates } else { other };
        }
        if candidates.is_empty() {
            candidates = all(&named);
        }
        // Two fields can have the same name only if their names are the same in all dialects, as
        // for the two `materialIndex` fields.
        let first = *candidates.first()?;
        candidates.retain(|&i| fields[i].keywords == fields[first].keywords);
        candidates.iter().copied().find(free).or(candidates.last().copied())
    }

    /// Returns true if the token that is `count` positions ahead is a number.
    fn number_ahead(&self, count: usize) -> bool {
        let token = self.ahead(count).filter(|t| t.kind == TokenKind::Word);
        token.is_some_and(|t| {
            let text = self.text(t.span);
            text.parse::<f32>().is_ok() || hexadecimal(&text).is_some()
        })
    }

    /// Returns true if a name and the `{` of its block come next.
    fn at_named_block(&self) -> bool {
        self.peek_word().is_some_and(|word| !is_reserved(&word))
            && self.ahead(1).is_some_and(|next| next.kind == TokenKind::Open)
    }

    /// Returns true if the current block continues after the nested block or number that comes
    /// next.
    fn block_continues_after(&self, fields: &[Field]) -> bool {
        let mut depth = 0usize;
        let is_named = self.at_named_block();
        let is_block = is_named || self.at_open();
        for i in usize::from(is_named).. {
            match self.ahead(i).map(|t| t.kind) {
                Some(TokenKind::Open) => depth += 1,
                Some(TokenKind::Close) => depth = depth.saturating_sub(1),
                None => return false,
                _ => {}
            }
            if depth == 0 {
                let Some(next) = self.ahead(i + 1) else { return false };
                let word = self.text(next.span);
                let field = fields.iter().any(|f| f.keywords.iter().any(|(w, _)| *w == word));
                return field || !is_block && next.kind == TokenKind::Close;
            }
        }
        false
    }

    fn unknown_field(&mut self, fields: &[Field], name: &str, word: &str, span: Span, after_path: bool) {
        let known = || fields.iter().flat_map(|f| f.keywords.iter().map(|s| s.0));
        let help = self.advice(word, known()).unwrap_or_else(|| {
            let mut words: Vec<&str> = fields.iter().filter_map(|f| f.keyword(self.options.dialect)).collect();
            words.dedup();
            // A list of seventy words would not be helpful to the user.
            let many = words.len() > 24;
            words.retain(|word| !many || !word.ends_with("Texture"));
            match after_path {
                true => "a path cannot contain spaces".into(),
                false if many => {
                    format!("`{name}` has the fields {}; most have a `...Texture` field too", words.join(", "))
                }
                false => format!("`{name}` has the fields {}", words.join(", ")),
            }
        });
        let help = super::suggestions::misplaced(word, name).map_or(help, String::from);
        let message = match word.parse::<f32>() {
            Ok(_) => format!("unexpected number {} in `{name}`", quoted(word.as_bytes())),
            Err(_) => format!("`{name}` has no field {}", quoted(word.as_bytes())),
        };
        let error = Diagnostic::error(message).code("unknown-word").at(span).label("not allowed here").help(help);
        self.error(self.with_suggestion(error, word, span, known()));
        self.skip_value();
    }

    /// Reads a value that has the type of a field, and checks that it satisfies the field's
    /// constraint.
    fn value(&mut self, item: &str, field: &Field, word: &str, keyword: Span) -> Option<Value> {
        let start = self.peek().map_or(keyword, |t| t.span);
        let value = match field.kind {
            FieldKind::Float => Value::Float(self.number(word, 1, 1)?),
            FieldKind::Int if word == "materialIndex" => {
                let number = self.material_number(word)?;
                self.index_spans.push((number, self.last_span()));
                Value::Int(number)
            }
            FieldKind::Int => Value::Int(self.integer(word)?),
            FieldKind::Vec3 => Value::Vec3(self.vec3(word)?),
            FieldKind::Path => {
                let token = self.peek().filter(|t| t.kind == TokenKind::Word);
                let Some(token) = token else {
                    self.expected("a path", word);
                    return None;
                };
                self.advance();
                Value::Path(FileName { path: self.text(token.span), span: token.span })
            }
            FieldKind::Word(words) => Value::Word(self.one_of(word, words)?),
            FieldKind::Rows(width) => Value::Rows(self.rows(word, keyword, width)?),
        };
        if field.constraint != Constraint::Any
            && let Err(violation) = field.constraint.validate(&value)
        {
            let span = start.join(self.last_span());
            if let Some(drawn) = self.accepts_any_values().then(|| field.quirk_value(item, &value)).flatten() {
                let warning = Diagnostic::warning(format!("`{word}` {violation}")).code("bad-value").at(span);
                self.diagnostics.push(warning.effect("the scene is rendered anyway, as in the official program"));
                return Some(drawn);
            }
            let error = Diagnostic::error(format!("`{word}` {violation}")).code("bad-value").at(span);
            // If only the sign is wrong, it is clear which value was intended.
            self.error(match value {
                Value::Float(x) if x < 0.0 => error.fix(span, self.text(span).trim_start_matches('-')),
                Value::Vec3(v) if word == "direction" && v == Vec3::ZERO => error.help(
                    "the `direction` of a light is the direction in which the light shines, and the `direction` of a \
                     camera is the point to look at minus the eye point",
                ),
                _ => error,
            });
        }
        Some(value)
    }

    /// Reads a word that must be one of `words`.
    fn one_of(&mut self, field: &str, words: &[&str]) -> Option<String> {
        let text = self.peek_word().unwrap_or_default();
        if words.contains(&text.as_str()) {
            self.advance();
            return Some(text);
        }
        let list = words.join(", ");
        let Some(token) = self.peek().filter(|t| t.kind == TokenKind::Word) else {
            self.expected(&format!("one of {list}"), field);
            return None;
        };
        self.advance();
        let message = format!("`{field}` cannot be {}", quoted(text.as_bytes()));
        let help = match did_you_mean(&text, words.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("`{field}` must be one of {list}"),
        };
        self.error(Diagnostic::error(message).at(token.span).help(help));
        None
    }

    /// Reads `{ numbers }` as rows that contain `width` numbers each.
    fn rows(&mut self, field: &str, keyword: Span, width: usize) -> Option<Vec<Vec<f32>>> {
        if !self.at_open() {
            self.expected("`{`", field);
            return None;
        }
        let open = self.advance();
        let mut numbers = Vec::new();
        while self.peek().is_some_and(|token| token.kind == TokenKind::Word) {
            match self.number(field, numbers.len() % width + 1, width) {
                Some(number) => numbers.push(number),
                None => {
                    // Errors in the block are reported as a single error.
                    while self.peek().is_some_and(|token| token.kind == TokenKind::Word) {
                        self.advance();
                    }
                    if self.peek().is_some_and(|token| token.kind == TokenKind::Close) {
                        self.advance();
                    }
                    return None;
                }
            }
        }
        match self.peek().map(|token| token.kind) {
            Some(TokenKind::Close) => self.advance(),
            _ => {
                self.expected("`}`", field);
                return None;
            }
        };
        if numbers.len() % width != 0 {
            let message =
                format!("`{field}` needs rows of {width} numbers, but has {} numbers in total", numbers.len());
            self.error(Diagnostic::error(message).at(open.join(self.last_span())).related(keyword, "in this block"));
            return None;
        }
        Some(numbers.chunks_exact(width).map(<[f32]>::to_vec).collect())
    }

    /// Reads three finite numbers.
    pub(super) fn vec3(&mut self, word: &str) -> Option<Vec3> {
        let x = self.number(word, 1, 3)?;
        let y = self.number(word, 2, 3)?;
        let z = self.number(word, 3, 3)?;
        Some(Vec3::new(x, y, z))
    }

    /// Reads an integer that is 0 or more.
    pub(super) fn integer(&mut self, word: &str) -> Option<u32> {
        let value = self.peek_word().and_then(|text| text.parse().ok());
        match value {
            Some(_) => {
                self.advance();
            }
            None => self.expected("a whole number", word),
        }
        value
    }

    /// Returns true if the quirk `any-values` is set, which accepts invalid values.
    pub(super) fn accepts_any_values(&self) -> bool {
        self.options.compat & Quirk::AnyValues.bit() != 0
    }

    /// Reads one finite number, which is the `i`-th of `count` numbers.
    pub(super) fn number(&mut self, word: &str, i: usize, count: usize) -> Option<f32> {
        let text = self.peek_word().unwrap_or_default();
        // Rust also parses words such as `inf` and `nan`, so require that the number begins with a
        // digit.
        let numeric = text.trim_start_matches(['+', '-', '.']).starts_with(|c: char| c.is_ascii_digit());
        // The function `scanf` of C, which is used in all years before 2020, accepts hexadecimal
        // numbers.
        if let Some(value) =
            hexadecimal(&text).filter(|_| self.accepts_any_values() && self.options.dialect != Dialect::F23)
        {
            let span = self.advance();
            let warning = Diagnostic::warning(format!("{} is a hexadecimal number", quoted(text.as_bytes()))).at(span);
            self.diagnostics.push(warning.effect(format!("the number is read as {value}, as in the official program")));
            return Some(value);
        }
        match text.parse::<f32>() {
            Ok(value) if numeric && value.is_finite() => {
                self.advance();
                Some(value)
            }
            Ok(_) if numeric => {
                let span = self.advance();
                let error = Diagnostic::error(format!("{} is too large a number", quoted(text.as_bytes()))).at(span);
                let error = error.code("bad-value");
                self.error(error.help("numbers must be within about ±3.4e38"));
                None
            }
            _ => {
                let what = if count == 1 { "a number".into() } else { format!("number {i} of {count}") };
                self.expected(&what, word);
                None
            }
        }
    }

    /// Reports that the next token is not the value that was expected.
    pub(super) fn expected(&mut self, what: &str, after: &str) {
        let Some(token) = self.peek() else {
            let message = format!("`{after}` needs {what}, but the file ends");
            self.error(Diagnostic::error(message).at(self.end_span()).label(format!("{what} expected")));
            return self.stop();
        };
        if what.contains("number")
            && let Some(error) = self.commented_color(what, after, token.span)
        {
            return self.error(error);
        }
        let text = self.text(token.span);
        let message = format!("`{after}` needs {what}, but found {}", quoted(text.as_bytes()));
        let error = Diagnostic::error(message).code("syntax").at(token.span).label(format!("{what} expected"));
        let Some((help, suggestion)) = number_help(&text).filter(|_| what.contains("number")) else {
            return self.error(error);
        };
        let mut error = error.help(help);
        // The numbers that follow probably contain the same mistake.
        let following = (self.at..).map_while(|i| self.ahead(i - self.at)).map_while(|t| {
            let text = self.text(t.span);
            let suggestion = number_help(&text).and_then(|(_, suggestion)| suggestion);
            (suggestion.is_some() || text.parse::<f32>().is_ok()).then_some((t.span, suggestion))
        });
        if suggestion.is_some() {
            let edits: Vec<_> = following.take(16).filter_map(|(span, suggestion)| Some((span, suggestion?))).collect();
            error = edits.into_iter().fold(error, |error, (span, suggestion)| error.fix(span, suggestion));
        }
        self.error(error);
    }

    /// Returns an error if a web colour such as `#b38033` replaces the numbers before `next`,
    /// because a web colour is a comment in this language.
    fn commented_color(&self, what: &str, after: &str, next: Span) -> Option<Diagnostic> {
        let last = self.last_span();
        let gap = self.text(Span { start: last.end, end: next.start.max(last.end), ..last });
        let hash = gap.find('#').filter(|at| !gap[..*at].contains('\n'))?;
        let digits = gap[hash + 1..].bytes().take_while(u8::is_ascii_hexdigit).count();
        let (start, text) = (last.end + hash as u32, &gap[hash..=hash + digits]);
        let wide = match digits {
            3 => 1,
            6 | 8 => 2,
            _ => return None,
        };
        let channel = |i: usize| {
            let part = &text[1 + i * wide..1 + (i + 1) * wide];
            let value = u32::from_str_radix(part, 16).unwrap_or_default();
            f64::from(if wide == 1 { 17 * value } else { value }) / 255.0
        };
        let numbers = [0, 1, 2].map(|i| ((channel(i) * 1000.0).round() / 1000.0).to_string()).join(" ");
        let span = Span { start, end: start + text.len() as u32, ..last };
        let message = format!("`{after}` needs {what}, but `{text}` begins a comment");
        let error = Diagnostic::error(message).code("syntax").at(span).label(format!("{what} expected"));
        Some(error.help(format!("colours are three numbers from 0 to 1: `{numbers}`")).fix(span, numbers))
    }

    /// Reports a field that takes one number in some dialects and three in others, and has the
    /// wrong number of values for this dialect.
    fn report_foreign_count(&mut self, word: &str, span: Span, set: DialectSet) {
        let dialect = self.options.dialect;
        if self.options.strict || dialect == Dialect::Durer {
            return self.report_foreign_word(word, span, set);
        }
        let numbers: Vec<Span> =
            (0..3).take_while(|&i| self.number_ahead(i)).filter_map(|i| Some(self.ahead(i)?.span)).collect();
        let name = dialect.name();
        let [first, _, last] = numbers[..] else {
            let message = format!("`{word}` takes three numbers in {name}, not one: this value has no effect");
            return self.diagnostics.push(Diagnostic::warning(message).code("foreign-word").at(span));
        };
        let square = self.text(last);
        let message = format!("`{word}` takes one number in {name}, not three: these values have no effect");
        let warning = Diagnostic::warning(message).code("foreign-word").at(first.join(last));
        let help = format!("write only the coefficient of the squared distance: `{word} {square}`");
        self.diagnostics.push(warning.help(help).fix(first.join(last), square));
    }

    /// Reports a word that this dialect does not have. In strict mode this is an error, and
    /// otherwise there is one warning for each word.
    pub(super) fn report_foreign_word(&mut self, word: &str, span: Span, set: DialectSet) {
        let dialect = self.options.dialect;
        if self.options.strict && set == Dialect::Durer as u8 {
            let message = format!("`{word}` is a Dürer extension, not a word of the course's language");
            self.error(Diagnostic::error(message).at(span));
            return;
        }
        if dialect.is_in(set) || dialect == Dialect::Durer && !self.options.strict {
            return;
        }
        if !self.options.strict && !self.reported_words.insert(word.to_string()) {
            return;
        }
        let message = format!("`{word}` is not a word of {}, but of {}", dialect.name(), names(set));
        if self.options.strict {
            self.error(Diagnostic::error(message).at(span));
        } else {
            let warning = Diagnostic::warning(message).code("foreign-word").at(span);
            self.diagnostics.push(match super::suggestions::word_in_dialect(word, dialect) {
                Some(here) => warning.help(format!("write `{here}` in {}", dialect.name())),
                None => warning,
            });
        }
    }
}

/// Returns help for a word that appears in the place of a number, and the corrected number if it is
/// clear.
fn number_help(text: &str) -> Option<(String, Option<String>)> {
    let is_number = |text: &str| !text.is_empty() && text.parse::<f32>().is_ok();
    let bare = text.trim_matches(['(', ')', ',', ';', '<', '>', '[', ']', 'f', 'F']);
    let point = bare.replace(',', ".");
    // Text editors and web pages replace the minus sign by dashes.
    let dash = text.replace(['\u{2212}', '\u{2013}', '\u{2014}'], "-");
    if dash != text && is_number(&dash) {
        let found = text.chars().find(|c| !c.is_ascii()).unwrap_or('-');
        let help = format!("`{found}` (U+{:04X}) is not the minus sign of a number: write `-`", u32::from(found));
        return Some((help, Some(dash)));
    }
    if is_number(&point) && bare.contains(',') && !bare.contains('.') {
        let help = "write decimals with a point, and separate numbers with spaces only";
        Some((help.into(), Some(point).filter(|_| bare == text)))
    } else if bare.contains(',') || bare != text && is_number(bare) {
        let parts: Vec<&str> = bare.split(',').filter(|part| !part.is_empty()).collect();
        let clear = parts.iter().all(|part| is_number(part)).then(|| parts.join(" "));
        Some(("separate numbers with spaces only: `1 0.5 0`".into(), clear))
    } else if text.starts_with("0x") || text.starts_with("0X") {
        Some(("write numbers in decimal".into(), None))
    } else if text == "=" || text == ":" {
        let help = format!("separate a word and its value with spaces only: remove the `{text}`");
        Some((help, Some(String::new())))
    } else if is_number(&text.replace(['O', 'o'], "0")) && text.contains(['O', 'o']) {
        Some(("write the digit 0 in place of the letter O".into(), Some(text.replace(['O', 'o'], "0"))))
    } else {
        let number = text.trim_end_matches(|c: char| c.is_alphabetic() || c == '°' || c == '%');
        let unit = &text[number.len()..];
        let help = || match unit {
            "rad" => "write angles in degrees, without a unit".into(),
            "deg" | "°" => "write angles in degrees, without a unit".into(),
            _ => format!("numbers have no units: remove `{unit}`"),
        };
        let same = ["deg", "°", "px", "m"].contains(&unit);
        // An exponent without digits must not be taken for a unit.
        let is_unit = !unit.is_empty() && !unit.eq_ignore_ascii_case("e");
        (is_number(number) && is_unit).then(|| (help(), same.then(|| number.to_string())))
    }
}

/// Returns an example of a field's value, for use in help texts.
fn example(field: &str) -> Option<&'static str> {
    Some(match field {
        "radius" => "1",
        "offset" => "0",
        "normal" | "up" => "0 1 0",
        "center" | "position" => "0 0 5",
        "direction" => "0 0 -1",
        "angle" | "fov" => "30",
        "size" => "5",
        "color" => "1 1 1",
        "vertex0" => "-1 0 0",
        "vertex1" => "1 0 0",
        "vertex2" => "0 1 0",
        "obj_file" => "cube.obj",
        _ => return None,
    })
}

/// Parses a finite hexadecimal number that can end with `p` and a power of two, such as `0x1.8p-3`.
fn hexadecimal(text: &str) -> Option<f32> {
    let (sign, rest) = match text.strip_prefix(['-', '+']) {
        Some(rest) => (if text.starts_with('-') { -1.0 } else { 1.0 }, rest),
        None => (1.0, text),
    };
    let digits = rest.strip_prefix("0x").or_else(|| rest.strip_prefix("0X"))?;
    let (digits, power) = match digits.split_once(['p', 'P']) {
        Some((digits, power)) => (digits, power.parse::<i32>().ok()?),
        None => (digits, 0),
    };
    let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
    if whole.len() + part.len() == 0 || whole.len() + part.len() > 12 {
        return None;
    }
    let mut value = 0.0_f64;
    for digit in whole.chars().chain(part.chars()) {
        value = 16.0 * value + f64::from(digit.to_digit(16)?);
    }
    let power = power.clamp(-1100, 1000) - 4 * part.len() as i32;
    let factor = if power < 0 { 0.5 } else { 2.0 };
    let value = (0..power.abs()).fold(sign * value, |value, _| value * factor) as f32;
    value.is_finite().then_some(value)
}
