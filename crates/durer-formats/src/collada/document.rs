//! Tree of the elements of a COLLADA file.

use crate::growth::ResourceLimits;
use crate::number::{NumberError, parse_f32};
use crate::report::quoted;
use crate::shared_report::SharedReport;
use crate::xml::{Attribute, Content, Event, Xml};
use durer_diag::{Diagnostic, Span};
use std::borrow::Cow;
use std::collections::HashMap;

/// Element with its attributes, its text and the elements inside it.
pub(super) struct Element<'a> {
    pub name: &'a str,
    pub at: Span,
    attributes: Vec<Attribute<'a>>,
    /// Text directly inside the element, without that of its children.
    text: Cow<'a, str>,
    /// Span of the text.
    text_at: Span,
    pub children: Vec<Element<'a>>,
}

impl<'a> Element<'a> {
    /// Returns the value of an attribute.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|attribute| attribute.name == name).map(|attribute| &*attribute.value)
    }

    /// Returns the span of an attribute, or that of the element if it has no such attribute.
    pub fn span_of(&self, name: &str) -> Span {
        self.attributes.iter().find(|attribute| attribute.name == name).map_or(self.at, |attribute| attribute.at)
    }

    /// Returns the first child with a name.
    pub fn child(&self, name: &str) -> Option<&Element<'a>> {
        self.children.iter().find(|child| child.name == name)
    }

    /// Returns all children with a name.
    pub fn all<'s>(&'s self, name: &'s str) -> impl Iterator<Item = &'s Element<'a>> {
        self.children.iter().filter(move |child| child.name == name)
    }

    /// Returns the text without the white space around it.
    pub fn text(&self) -> &str {
        self.text.trim()
    }

    /// Returns the span of the text, or that of the element if it has no text.
    pub fn text_span(&self) -> Span {
        let lead = self.text.len() - self.text.trim_start().len();
        match self.text() {
            "" => self.at,
            text if matches!(self.text, Cow::Borrowed(_)) => {
                let start = self.text_at.start + lead as u32;
                Span { start, end: start + text.len() as u32, ..self.text_at }
            }
            _ => self.text_at,
        }
    }

    /// Calls `offer` for each word of the text, with its span.
    fn words(&self, mut offer: impl FnMut(&str, Span)) {
        let text = &*self.text;
        let is_borrowed = matches!(self.text, Cow::Borrowed(_));
        for word in text.split_ascii_whitespace() {
            let start = self.text_at.start + (word.as_ptr() as usize - text.as_ptr() as usize) as u32;
            let own = Span { start, end: start + word.len() as u32, ..self.text_at };
            offer(word, if is_borrowed { own } else { self.text_at });
        }
    }

    /// Returns the words of the text.
    pub fn names(&self) -> Vec<&str> {
        self.text.split_ascii_whitespace().collect()
    }

    /// Returns the numbers in the text. A number that is not finite becomes NaN, and a word that is
    /// not a number is an error.
    pub fn numbers(&self, report: &SharedReport, limits: &ResourceLimits) -> Vec<f32> {
        let mut numbers = Vec::new();
        if !limits.count_bytes_or_report(self.text.len() / 2 + 1, size_of::<f32>(), report, self.at) {
            return numbers;
        }
        let mut is_wrong = false;
        self.words(|word, at| match parse_f32(word.as_bytes()).or_else(|error| with_comma(word).ok_or(error)) {
            Ok(number) => {
                if word.contains(',') {
                    report.warn_once("decimal-comma", at, "numbers have a comma in place of a decimal point");
                }
                numbers.push(number);
            }
            Err(NumberError::NotFinite) => numbers.push(f32::NAN),
            Err(_) if matches!(word, "INF" | "-INF") => numbers.push(f32::NAN),
            Err(_) if !std::mem::replace(&mut is_wrong, true) => {
                report.error(at, format!("`{}` needs numbers, found {}", self.name, quoted(word.as_bytes())));
            }
            Err(_) => {}
        });
        numbers
    }

    /// Returns the integers in the text. Negative ones become `u32::MAX`, which no list has as an
    /// index.
    pub fn integers(&self, report: &SharedReport, limits: &ResourceLimits) -> Vec<u32> {
        let mut numbers = Vec::new();
        if !limits.count_bytes_or_report(self.text.len() / 2 + 1, size_of::<u32>(), report, self.at) {
            return numbers;
        }
        let mut is_wrong = false;
        self.words(|word, at| match word.parse::<i64>() {
            Ok(number) => numbers.push(u32::try_from(number).unwrap_or(u32::MAX)),
            Err(_) if !std::mem::replace(&mut is_wrong, true) => {
                report.error(at, format!("`{}` needs integers, found {}", self.name, quoted(word.as_bytes())));
            }
            Err(_) => {}
        });
        numbers
    }

    /// Returns exactly `N` finite numbers from the text, or reports an error.
    pub fn exactly<const N: usize>(&self, report: &SharedReport, limits: &ResourceLimits) -> Option<[f64; N]> {
        let numbers = self.numbers(report, limits);
        match <[f32; N]>::try_from(numbers.as_slice()) {
            Ok(numbers) if numbers.iter().all(|number| number.is_finite()) => Some(numbers.map(f64::from)),
            Ok(_) => {
                report.error(self.text_span(), format!("the numbers of `{}` must be finite", self.name));
                None
            }
            Err(_) => {
                if !report.has_errors() {
                    let found = numbers.len();
                    let message = format!("`{}` needs {N} numbers, found {found}", self.name);
                    report.error(self.text_span(), message);
                }
                None
            }
        }
    }

    /// Returns the number that the text consists of, if it is finite.
    pub fn number(&self, report: &SharedReport, limits: &ResourceLimits) -> Option<f64> {
        self.exactly::<1>(report, limits).map(|[number]| number)
    }
}

/// Parses a number with a comma in place of the decimal point, as some programs write it.
pub(super) fn with_comma(word: &str) -> Option<f32> {
    (word.matches(',').count() == 1).then(|| parse_f32(word.replace(',', ".").as_bytes()).ok()).flatten()
}

/// Parses a file.
pub(super) fn parse<'a>(
    bytes: &'a [u8],
    file: u32,
    limits: &ResourceLimits,
    report: &SharedReport,
) -> Result<Element<'a>, Box<Diagnostic>> {
    let mut xml = Xml::new(bytes, file)?;
    let mut open: Vec<Element> = Vec::new();
    loop {
        match xml.next_content()? {
            Content::Event(Event::Open(tag)) => {
                let size = size_of::<Element>() + tag.attributes.len() * size_of::<Attribute>();
                if !limits.count_bytes_or_report(2, size, report, tag.at) {
                    return Err(Diagnostic::error("the file has too many elements").code("bad-file").at(tag.at).into());
                }
                open.push(Element {
                    name: tag.name,
                    at: tag.at,
                    attributes: tag.attributes,
                    text: Cow::Borrowed(""),
                    text_at: tag.at,
                    children: Vec::new(),
                });
            }
            Content::Event(Event::Close) => {
                let Some(element) = open.pop() else { continue };
                match open.last_mut() {
                    Some(parent) => parent.children.push(element),
                    None => {
                        // Only comments may follow the root element.
                        while !matches!(xml.next_content()?, Content::Event(Event::End)) {}
                        return Ok(element);
                    }
                }
            }
            Content::Event(Event::End) => {
                return Err(Diagnostic::error("the file has no elements").code("bad-file").into());
            }
            Content::Text(text, at) => {
                let Some(element) = open.last_mut() else { continue };
                match element.text.trim() {
                    "" => (element.text, element.text_at) = (text, at),
                    _ if text.trim().is_empty() => {}
                    _ => {
                        element.text.to_mut().push_str(&text);
                        element.text_at = element.text_at.join(at);
                    }
                }
            }
        }
    }
}

/// Returns all elements that have an `id`. If an id occurs twice, the first element counts.
pub(super) fn by_id<'e, 'a>(root: &'e Element<'a>) -> HashMap<&'e str, &'e Element<'a>> {
    let mut ids = HashMap::new();
    let mut left = vec![root];
    while let Some(element) = left.pop() {
        if let Some(id) = element.get("id") {
            ids.entry(id).or_insert(element);
        }
        left.extend(element.children.iter().rev());
    }
    ids
}
