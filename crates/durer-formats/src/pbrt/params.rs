//! Reads parameter lists, such as `"float radius" [ 2 ]`.

use super::language::Language;
use super::lexer::{Lexer, SpannedToken, Token};
use crate::model::ReadInput;
use crate::report::count_text;
use crate::shared_report::{SharedReport, suggest};
use durer_diag::{Diagnostic, Span};
use durer_scene::math::{Vec2, Vec3};
use durer_scene::spectrum::space::RgbSpace;
use std::cell::{Cell, RefCell};
use std::rc::Rc;

/// Declared type of a pbrt parameter, such as `float` or `rgb`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Integer,
    Float,
    Bool,
    Text,
    Texture,
    /// Pairs of numbers.
    Vec2,
    /// Triples of numbers.
    Vec3,
    Rgb,
    Xyz,
    Blackbody,
    Spectrum,
}

/// Names of parameter types, and the type that each of them stands for. `color` and `xyz` come from
/// pbrt-v3.
const KINDS: [(&str, Kind); 18] = [
    ("integer", Kind::Integer),
    ("float", Kind::Float),
    ("bool", Kind::Bool),
    ("string", Kind::Text),
    ("texture", Kind::Texture),
    ("point2", Kind::Vec2),
    ("vector2", Kind::Vec2),
    ("point3", Kind::Vec3),
    ("vector3", Kind::Vec3),
    ("normal3", Kind::Vec3),
    ("point", Kind::Vec3),
    ("vector", Kind::Vec3),
    ("normal", Kind::Vec3),
    ("rgb", Kind::Rgb),
    ("blackbody", Kind::Blackbody),
    ("spectrum", Kind::Spectrum),
    ("color", Kind::Rgb),
    ("xyz", Kind::Xyz),
];

/// Values of a pbrt parameter: numbers, strings or booleans.
#[derive(Clone, Debug)]
pub(super) enum Values {
    Numbers(Vec<f64>),
    Texts(Vec<String>),
    Bools(Vec<bool>),
}

impl Values {
    /// Returns the number of values and their type as text for messages.
    fn counted(&self) -> String {
        let (one, many) = match self {
            Values::Numbers(_) => ("number", "numbers"),
            Values::Texts(_) => ("string", "strings"),
            Values::Bools(_) => ("boolean", "booleans"),
        };
        count_text(self.len(), one, many)
    }

    fn len(&self) -> usize {
        match self {
            Values::Numbers(all) => all.len(),
            Values::Texts(all) => all.len(),
            Values::Bools(all) => all.len(),
        }
    }
}

/// Parameter of a pbrt directive: its type, name and values.
#[derive(Debug)]
pub(super) struct Param {
    pub kind: Kind,
    pub name: String,
    pub values: Values,
    /// Span of the string that gives the type and name.
    pub at: Span,
    /// Span of the parameter's values.
    pub values_at: Span,
    used: Cell<bool>,
}

impl Param {
    /// Returns the first number, or 0 if there is none.
    pub fn number(&self) -> f32 {
        match &self.values {
            Values::Numbers(all) => all.first().copied().unwrap_or_default() as f32,
            _ => 0.0,
        }
    }

    /// Returns all numbers, or an empty list if the values are not numbers.
    pub fn numbers(&self) -> &[f64] {
        if let Values::Numbers(all) = &self.values { all } else { &[] }
    }

    /// Returns the first string, or an empty string if there is none.
    pub fn text(&self) -> &str {
        match &self.values {
            Values::Texts(all) => all.first().map_or("", String::as_str),
            _ => "",
        }
    }

    /// Returns the numbers as triples.
    pub fn triples(&self) -> Vec<Vec3> {
        self.numbers().chunks_exact(3).map(|p| Vec3::new(p[0] as f32, p[1] as f32, p[2] as f32)).collect()
    }
}

/// Parameters of a pbrt directive, followed by the parameters set by `Attribute`. Keeps track of
/// which parameters are used.
pub(super) struct Params<'s> {
    list: Vec<Rc<Param>>,
    /// Number of parameters that belong to the directive itself.
    own_count: usize,
    /// Span of the directive, or of the string after it.
    pub at: Span,
    pub report: &'s SharedReport,
    pub input: &'s ReadInput<'s>,
    /// Colour space of RGB parameters.
    pub space: RgbSpace,
    pub language: Language,
    known_names: RefCell<Vec<&'static str>>,
}

/// Reads parameters for as long as strings follow.
pub(super) fn read(text: &mut Lexer, language: Language, report: &SharedReport) -> Vec<Rc<Param>> {
    let mut list: Vec<Rc<Param>> = Vec::new();
    while !report.is_full() {
        let Some(SpannedToken { token: Token::Text(_), .. }) = text.peek(report) else { break };
        let Some(SpannedToken { token: Token::Text(head), at }) = text.next(report) else { break };
        let Some((values, values_at)) = values(text, at, report) else { continue };
        let Some((kind, name)) = parse_declaration(&head, at, language, report) else { continue };
        if let Some(first) = list.iter().find(|param| param.name == name) {
            let error = Diagnostic::error(format!("`{name}` is given twice")).code("bad-value").at(at);
            report.push(error.related(first.at, "the first one is here"));
            continue;
        }
        if fits(kind, &name, &values, values_at, report) {
            list.push(Rc::new(Param { kind, name, values, at, values_at, used: Cell::new(false) }));
        }
    }
    list
}

/// Parses the type and name of a parameter, such as `"float radius"`.
fn parse_declaration(head: &str, at: Span, language: Language, report: &SharedReport) -> Option<(Kind, String)> {
    let mut words = head.split_ascii_whitespace();
    let (Some(kind), Some(name), None) = (words.next(), words.next(), words.next()) else {
        report.error_with_help(
            at,
            "expected the type and the name of a parameter",
            Some("for example `\"float radius\" [ 2 ]`".into()),
        );
        return None;
    };
    let row = KINDS.iter().find(|row| row.0 == kind);
    if row.is_none() {
        let help = suggest(kind, KINDS.iter().map(|row| row.0));
        report.error_with_help(at, format!("`{kind}` is not a parameter type"), help);
    }
    if kind == "xyz" && language == Language::V4 {
        report.error_with_help(at, "only pbrt-v3 has `xyz` colours", Some("write `rgb`".into()));
        return None;
    }
    Some((row?.1, name.to_string()))
}

/// Reads the values after the name of a parameter: one value, or several values in brackets.
fn values(text: &mut Lexer, head: Span, report: &SharedReport) -> Option<(Values, Span)> {
    let Some(first) = text.peek(report).cloned() else {
        report.error(head, "this parameter has no value");
        return None;
    };
    let (mut numbers, mut texts, mut bools) = (Vec::new(), Vec::new(), Vec::new());
    let (mut sound, mut kinds) = (true, 0);
    let mut add = |next: SpannedToken, text: &Lexer| match next.token {
        Token::Text(value) => {
            texts.push(value);
            true
        }
        Token::Word if matches!(text.bytes(next.at), b"true" | b"false") => {
            bools.push(text.bytes(next.at) == b"true");
            true
        }
        Token::Word => match number(text, next.at, report) {
            Some(value) => {
                numbers.push(value);
                true
            }
            None => false,
        },
        Token::Open | Token::Close => false,
    };
    let mut end = first.at;
    if first.token == Token::Open {
        text.next(report);
        loop {
            let Some(next) = text.next(report) else {
                let error = Diagnostic::error("these brackets are not closed").code("unclosed").at(first.at);
                report.push(error.help("add the missing `]`"));
                return None;
            };
            end = next.at;
            match next.token {
                Token::Close => break,
                Token::Open => {
                    report.error(next.at, "brackets cannot be nested: a `]` is missing before this `[`");
                    sound = false;
                }
                _ => sound &= add(next, text),
            }
            if report.is_full() {
                return None;
            }
        }
    } else {
        if first.token == Token::Close {
            report.error(first.at, "this `]` has no value before it");
            text.next(report);
            return None;
        }
        text.next(report);
        sound = add(first.clone(), text);
    }
    let at = first.at.join(end);
    for filled in [!numbers.is_empty(), !texts.is_empty(), !bools.is_empty()] {
        kinds += u32::from(filled);
    }
    if kinds > 1 {
        report.error(at, "numbers, strings and booleans cannot be mixed");
        return None;
    }
    sound.then_some(match (texts.is_empty(), bools.is_empty()) {
        (false, _) => (Values::Texts(texts), at),
        (_, false) => (Values::Bools(bools), at),
        _ => (Values::Numbers(numbers), at),
    })
}

/// Parses a word as a finite number.
pub(super) fn number(text: &Lexer, at: Span, report: &SharedReport) -> Option<f64> {
    let word = text.word(at);
    match word.parse::<f64>() {
        Ok(value) if value.abs() <= f64::from(f32::MAX) => return Some(value),
        Ok(_) => report.error_with_help(
            at,
            format!("expected a finite number, found {}", text.quoted(at)),
            Some("numbers must lie within the range of 32-bit floating point, about ±3.4e38".into()),
        ),
        Err(_) => {
            let point = word.replace(',', ".");
            let help = (point != word && point.parse::<f32>().is_ok())
                .then(|| format!("write decimals with a point: `{point}`"));
            report.error_with_help(at, format!("expected a number, found {}", text.quoted(at)), help);
        }
    }
    None
}

/// Checks that the values match the declared type.
fn fits(kind: Kind, name: &str, values: &Values, at: Span, report: &SharedReport) -> bool {
    let complain = |wanted: &str| {
        let actual = match values.len() {
            0 => "nothing".to_string(),
            _ => values.counted(),
        };
        report.error(at, format!("`{name}` needs {wanted}, found {actual}"));
        false
    };
    let rows = |size: usize| match values {
        Values::Numbers(all) => all.len() % size == 0,
        _ => false,
    };
    match (kind, values) {
        (Kind::Bool, Values::Bools(_)) => true,
        // In pbrt-v3, booleans are written as strings.
        (Kind::Bool, Values::Texts(all)) if all.iter().all(|word| word == "true" || word == "false") => true,
        (Kind::Bool, _) => complain("`true` or `false`"),
        (Kind::Text | Kind::Texture, Values::Texts(_)) => true,
        (Kind::Text | Kind::Texture, _) => complain("a string in quotes"),
        (Kind::Spectrum, Values::Texts(_)) => true,
        (Kind::Spectrum, Values::Numbers(all)) if all.len() % 2 == 0 && !all.is_empty() => true,
        (Kind::Spectrum, _) => complain("pairs of wavelength and value, or a name"),
        (Kind::Vec2, _) if !rows(2) => complain("pairs of numbers"),
        (Kind::Vec3, _) if !rows(3) => complain("triples of numbers"),
        (Kind::Rgb | Kind::Xyz, _) if !rows(3) || values.len() == 0 => complain("three numbers"),
        (Kind::Integer, Values::Numbers(all)) => {
            let whole = all.iter().all(|x| x.fract() == 0.0 && x.abs() < f64::from(i32::MAX));
            whole || complain("32-bit integers")
        }
        (Kind::Float | Kind::Integer | Kind::Blackbody, Values::Texts(_) | Values::Bools(_)) => complain("numbers"),
        _ => true,
    }
}

impl<'s> Params<'s> {
    /// Combines the parameters of a directive with those set by `Attribute`. The directive's own
    /// parameters come first.
    pub fn new(
        own: Vec<Rc<Param>>,
        others: &[Rc<Param>],
        at: Span,
        (input, report): (&'s ReadInput<'s>, &'s SharedReport),
        (language, space): (Language, RgbSpace),
    ) -> Self {
        let count = own.len();
        let list = own.into_iter().chain(others.iter().cloned()).collect();
        Params { list, own_count: count, at, report, input, space, language, known_names: RefCell::default() }
    }

    /// Finds a parameter by name, marks it as used and returns it.
    pub fn get(&self, name: &'static str) -> Option<&Param> {
        self.known_names.borrow_mut().push(name);
        let found = self.list.iter().find(|param| param.name == name)?;
        found.used.set(true);
        Some(found)
    }

    /// Returns a parameter if it has at least one value. Reports an error if its type is not in
    /// `kinds`.
    pub(super) fn typed(&self, name: &'static str, kinds: &[Kind], wanted: &str) -> Option<&Param> {
        let param = self.get(name)?;
        if !kinds.contains(&param.kind) {
            self.report.error(param.at, format!("`{name}` must be {wanted}"));
            return None;
        }
        if param.values.len() == 0 {
            self.report.error(param.values_at, format!("`{name}` has no value"));
            return None;
        }
        Some(param)
    }

    /// Returns the span of a parameter, or the span of the directive if the parameter is missing.
    pub fn span(&self, name: &'static str) -> Span {
        self.get(name).map_or(self.at, |param| param.at)
    }

    /// Returns a `float` parameter.
    pub fn float(&self, name: &'static str) -> Option<f32> {
        self.typed(name, &[Kind::Float, Kind::Integer], "a float").map(Param::number)
    }

    /// Returns a `float` parameter, which must be greater than 0.
    pub fn positive(&self, name: &'static str) -> Option<f32> {
        let value = self.float(name)?;
        if value <= 0.0 {
            self.report.error(self.span(name), format!("`{name}` must be more than 0"));
            return None;
        }
        Some(value)
    }

    /// Returns an `integer` parameter.
    pub fn integer(&self, name: &'static str) -> Option<i64> {
        self.typed(name, &[Kind::Integer], "an integer").map(|param| param.numbers()[0] as i64)
    }

    /// Returns all values of an `integer` parameter.
    pub fn integers(&self, name: &'static str) -> Option<Vec<i64>> {
        let param = self.typed(name, &[Kind::Integer], "integers")?;
        Some(param.numbers().iter().map(|&x| x as i64).collect())
    }

    /// Returns all values of a `float` parameter.
    pub fn floats(&self, name: &'static str) -> Option<&[f64]> {
        self.typed(name, &[Kind::Float, Kind::Integer], "floats").map(Param::numbers)
    }

    /// Returns a `bool` parameter.
    pub fn boolean(&self, name: &'static str) -> Option<bool> {
        self.typed(name, &[Kind::Bool], "`true` or `false`").map(|param| match &param.values {
            Values::Bools(all) => all[0],
            _ => param.text() == "true",
        })
    }

    /// Returns a `string` parameter.
    pub fn text(&self, name: &'static str) -> Option<&str> {
        self.typed(name, &[Kind::Text], "a string").map(Param::text)
    }

    /// Returns a parameter that consists of pairs of numbers.
    pub fn pairs(&self, name: &'static str) -> Option<Vec<Vec2>> {
        let param = self.typed(name, &[Kind::Vec2, Kind::Float], "a list of pairs of numbers")?;
        Some(param.numbers().chunks_exact(2).map(|p| Vec2::new(p[0] as f32, p[1] as f32)).collect())
    }

    /// Returns a parameter that consists of triples of numbers.
    pub fn triples(&self, name: &'static str) -> Option<Vec<Vec3>> {
        self.typed(name, &[Kind::Vec3], "a list of triples of numbers").map(Param::triples)
    }

    /// Returns the first three numbers of a parameter.
    pub fn triple(&self, name: &'static str) -> Option<Vec3> {
        self.triples(name).map(|all| all[0])
    }

    /// Marks parameters that have no counterpart in Dürer as known, so that no warning is reported
    /// for them.
    pub fn mark_known(&self, names: &[&'static str]) {
        names.iter().for_each(|name| _ = self.get(name));
    }

    /// Marks all parameters as used, if it is not known which parameters are allowed.
    pub fn mark_all_used(&self) {
        self.list.iter().for_each(|param| param.used.set(true));
    }

    /// Marks parameters as known, and warns about those that are present. `what` says what is used
    /// instead.
    pub fn warn_unsupported(&self, names: &[&'static str], what: &str) {
        for name in names {
            if let Some(param) = self.get(name) {
                self.report.unsupported_once(param.at, format!("`{name}` has no counterpart: {what}"));
            }
        }
    }

    /// Warns about unknown parameters. `what` is the name of the directive.
    pub fn warn_unused(&self, what: &str) {
        for param in self.list[..self.own_count].iter().filter(|param| !param.used.get()) {
            let warning = Diagnostic::warning(format!("{what} has no parameter `{}`: it is ignored", param.name));
            let help = suggest(&param.name, self.known_names.borrow().iter().copied());
            self.report.push(Diagnostic { help, ..warning.code("unknown-word").at(param.at) });
        }
    }
}
