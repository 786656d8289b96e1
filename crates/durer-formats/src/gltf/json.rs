//! Gives access to the JSON of a glTF file. Each value knows its JSON pointer, so that diagnostics
//! can state its line and column.
//!
//! Error codes are those of the Khronos glTF validator (see its ISSUES.md).

mod locate;

use crate::report::{Report, quoted};
use durer_diag::{Diagnostic, Severity, Span};
use serde_json::{Map, Value};
use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::ops::{Range, RangeBounds};

/// Collector for the diagnostics of a glTF file, which all parts of the reader share. The collector
/// also finds the byte ranges of JSON values.
pub(super) struct JsonReport<'a> {
    /// JSON text, which is the whole file or the JSON chunk of a binary file.
    text: &'a [u8],
    /// Byte offsets of the items of top-level lists, which are computed when they are first needed.
    starts: RefCell<HashMap<String, Vec<usize>>>,
    report: RefCell<Report>,
    /// True if an error has been reported.
    failed: Cell<bool>,
}

impl<'a> JsonReport<'a> {
    pub fn new(text: &'a [u8], report: Report) -> Self {
        JsonReport { text, starts: RefCell::default(), report: RefCell::new(report), failed: Cell::default() }
    }

    /// Returns the report with all diagnostics.
    pub fn finish(self) -> Report {
        self.report.into_inner()
    }

    /// Returns true if an error has been reported, even if the report dropped it.
    pub fn has_errors(&self) -> bool {
        self.failed.get() || self.report.borrow().has_errors()
    }

    /// Returns the byte range of a value in the file, or that of the closest enclosing value that
    /// exists.
    fn range(&self, pointer: &str) -> Range<usize> {
        self.in_list(pointer).unwrap_or_else(|| locate::locate(self.text, pointer))
    }

    /// Returns the range of a value inside a top-level list. Each list is scanned only once.
    fn in_list(&self, pointer: &str) -> Option<Range<usize>> {
        let (list, rest) = pointer.strip_prefix('/')?.split_once('/')?;
        let (number, rest) = rest.split_at(rest.find('/').unwrap_or(rest.len()));
        let mut starts = self.starts.borrow_mut();
        let starts = starts.entry(list.to_string()).or_insert_with(|| locate::items(self.text, list));
        let start = *starts.get(number.parse::<usize>().ok()?)?;
        let at = locate::locate(&self.text[start..], rest);
        Some(start + at.start..start + at.end)
    }

    /// Returns the span of the value at a JSON pointer.
    pub fn span(&self, pointer: &str) -> Span {
        self.report.borrow().span(self.range(pointer))
    }

    /// Returns the span of the node with this index, which is the span of its name if it has one.
    pub fn node(&self, number: usize) -> Span {
        self.span(&format!("/nodes/{number}/name"))
    }

    /// Reports an error, warning or note about the value at a JSON pointer. The message begins with
    /// the JSON pointer.
    pub fn report(&self, kind: fn(String) -> Diagnostic, code: &'static str, pointer: &str, message: &str) {
        let is_error = kind(String::new()).severity == Severity::Error;
        // Record that there was an error even if the report is full and drops the message.
        self.failed.set(self.failed.get() || is_error);
        // Skip the search for byte ranges if the report is full, because each search has to scan
        // the file.
        let (full, count) = (self.report.borrow().is_full(), self.report.borrow().count());
        if full || !is_error && count > 256 {
            return;
        }
        let prefix = if pointer.is_empty() { String::new() } else { format!("{pointer}: ") };
        let (range, diagnostic) = (self.range(pointer), kind(prefix + message).code(code));
        // Several parts of the reader can find the same problem.
        if !self.report.borrow().contains(&range, &diagnostic.message) {
            self.report.borrow_mut().add(range, diagnostic);
        }
    }
}

/// JSON value of a glTF file with its path, which is used to read the value and to report errors in
/// it.
#[derive(Clone, Copy)]
pub(super) struct JsonRef<'a> {
    pub value: &'a Value,
    pub report: &'a JsonReport<'a>,
    parent: Option<&'a JsonRef<'a>>,
    step: PathStep<'a>,
}

/// Last step of the path to a JSON value, which is a key of an object or an index in an array.
#[derive(Clone, Copy)]
enum PathStep<'a> {
    Key(&'a str),
    Index(usize),
}

impl<'a> JsonRef<'a> {
    /// Returns the root value of the document.
    pub fn root(value: &'a Value, report: &'a JsonReport<'a>) -> Self {
        JsonRef { value, report, parent: None, step: PathStep::Key("") }
    }

    /// Returns the JSON pointer (RFC 6901) of this value.
    pub fn pointer(&self) -> String {
        let Some(parent) = self.parent else { return String::new() };
        match self.step {
            PathStep::Key(key) => format!("{}/{}", parent.pointer(), key.replace('~', "~0").replace('/', "~1")),
            PathStep::Index(i) => format!("{}/{i}", parent.pointer()),
        }
    }

    /// Returns the span of this value.
    pub fn span(&self) -> Span {
        self.report.span(&self.pointer())
    }

    /// Returns the name of this value, or of the innermost enclosing value that has a name, for use
    /// after a noun. The text consists of a space and the name in backquotes. The text is empty if
    /// there is no name.
    pub fn name(&self) -> String {
        let own = self.value.get("name").and_then(Value::as_str).filter(|name| !name.is_empty());
        match (own, self.parent) {
            (Some(name), _) => format!(" {}", quoted(name.as_bytes())),
            (None, Some(parent)) => parent.name(),
            (None, None) => String::new(),
        }
    }

    /// Reports an error in this value.
    pub fn error(&self, code: &'static str, message: impl AsRef<str>) {
        self.report.report(Diagnostic::error, code, &self.pointer(), message.as_ref());
    }

    /// Reports a warning about this value.
    pub fn warning(&self, code: &'static str, message: impl AsRef<str>) {
        self.report.report(Diagnostic::warning, code, &self.pointer(), message.as_ref());
    }

    /// Reports a note about this value.
    pub fn note(&self, code: &'static str, message: impl AsRef<str>) {
        self.report.report(Diagnostic::note, code, &self.pointer(), message.as_ref());
    }

    /// Returns a member of this object, if it is present.
    pub fn get(&'a self, key: &'a str) -> Option<JsonRef<'a>> {
        let value = self.value.as_object()?.get(key)?;
        Some(JsonRef { value, report: self.report, parent: Some(self), step: PathStep::Key(key) })
    }

    /// Returns a required member, and reports an error if it is missing.
    pub fn required(&'a self, key: &'a str) -> Option<JsonRef<'a>> {
        let count = self.get(key);
        if count.is_none() && self.value.is_object() {
            self.error("UNDEFINED_PROPERTY", format!("property `{key}` must be defined"));
        }
        count
    }

    fn mismatch(&self, wanted: &str) {
        let text = self.value.to_string();
        self.error("TYPE_MISMATCH", format!("expected {wanted}, found {}", quoted(text.as_bytes())));
    }

    /// Returns this value if it is an object, and otherwise reports an error.
    pub fn object(&self) -> Option<&'a Map<String, Value>> {
        let object = self.value.as_object();
        if object.is_none() {
            self.mismatch("an object");
        }
        object
    }

    /// Returns the items of this array, which must not be empty. Reports an error for any other
    /// value.
    pub fn items(&'a self) -> impl ExactSizeIterator<Item = JsonRef<'a>> {
        let items = match self.value {
            Value::Array(items) => {
                if items.is_empty() {
                    self.error("EMPTY_ENTITY", "the array must not be empty");
                }
                items.as_slice()
            }
            _ => {
                self.mismatch("an array");
                &[]
            }
        };
        items.iter().enumerate().map(|(i, value)| JsonRef {
            value,
            report: self.report,
            parent: Some(self),
            step: PathStep::Index(i),
        })
    }

    /// Reads each item of an array member. The result is empty if the member is missing.
    pub fn list<T>(&'a self, key: &'a str, mut read: impl FnMut(&JsonRef) -> T) -> Vec<T> {
        match self.get(key) {
            Some(array) => array.items().map(|item| read(&item)).collect(),
            None => Vec::new(),
        }
    }

    /// Returns this value if it is a string, and otherwise reports an error.
    pub fn string(&self) -> Option<&'a str> {
        let text = self.value.as_str();
        if text.is_none() {
            self.mismatch("a string");
        }
        text
    }

    /// Returns this value if it is a boolean, and otherwise reports an error.
    pub fn boolean(&self) -> Option<bool> {
        let value = self.value.as_bool();
        if value.is_none() {
            self.mismatch("`true` or `false`");
        }
        value
    }

    /// Returns this value as an `f32` if it is a number, and otherwise reports an error.
    pub fn number(&self) -> Option<f32> {
        match self.value.as_f64() {
            Some(x) if (x as f32).is_finite() => Some(x as f32),
            Some(_) => {
                self.error("VALUE_NOT_IN_RANGE", "the number is beyond the range of 32-bit floating point");
                None
            }
            None => {
                self.mismatch("a number");
                None
            }
        }
    }

    /// Returns this value as a number, which must be in the given range.
    pub fn number_in(&self, range: impl RangeBounds<f32>) -> Option<f32> {
        let number = self.number()?;
        if range.contains(&number) {
            return Some(number);
        }
        self.error("VALUE_NOT_IN_RANGE", format!("value {number} is out of range"));
        None
    }

    /// Returns this value as an integer, which must be in the given range. An integer can also be
    /// written as 4.0, for example.
    pub fn integer(&self, range: impl RangeBounds<u64>) -> Option<u64> {
        let exact = |x: f64| (x.fract() == 0.0 && (0.0..9.0e15).contains(&x)).then_some(x as u64);
        match self.value.as_u64().or_else(|| self.value.as_f64().and_then(exact)) {
            Some(n) if range.contains(&n) => Some(n),
            Some(n) => {
                self.error("VALUE_NOT_IN_RANGE", format!("value {n} is out of range"));
                None
            }
            None => {
                match self.value.as_f64() {
                    Some(x) if x < 0.0 => self.error("VALUE_NOT_IN_RANGE", format!("value {x} is out of range")),
                    _ => self.mismatch("a whole number"),
                }
                None
            }
        }
    }

    /// Returns this value as an index into a list of `count` items.
    pub fn index(&self, count: usize) -> Option<usize> {
        let number = self.integer(..)?;
        if number < count as u64 {
            return Some(number as usize);
        }
        self.error("UNRESOLVED_REFERENCE", format!("index {number} refers to an item that does not exist"));
        None
    }

    /// Returns the numbers of this array, which must have exactly `N` items.
    pub fn numbers<const N: usize>(&'a self) -> Option<[f32; N]> {
        let items = self.items();
        if self.value.is_array() && items.len() != N {
            let count = items.len();
            self.error("ARRAY_LENGTH_NOT_IN_LIST", format!("expected {N} numbers, found {count}"));
            return None;
        }
        items.map(|item| item.number()).collect::<Option<Vec<_>>>()?.try_into().ok()
    }

    /// Returns the meaning of this string, which must be one of the given words.
    pub fn word<T: Copy>(&self, words: &[(&str, T)]) -> Option<T> {
        let text = self.string()?;
        let count = words.iter().find(|(word, _)| *word == text).map(|&(_, meaning)| meaning);
        if count.is_none() {
            let all: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
            self.error("VALUE_NOT_IN_LIST", format!("invalid value `{text}`, valid values are `{}`", all.join("`, `")));
        }
        count
    }
}
