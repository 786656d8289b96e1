//! Pull parser for XML, which records the spans of elements and attributes.
//!
//! The parser rejects two features that scenes do not need. One is document type declarations, with
//! which a few bytes can expand to gigabytes or include another file. The other is entities other
//! than the five predefined ones.

use durer_diag::{Diagnostic, Span};
use quick_xml::events::attributes::{AttrError, Attributes};
use quick_xml::{Reader, escape, events};
use std::borrow::Cow;
use std::sync::Arc;

/// Maximum depth to which elements may be nested.
const MAX_DEPTH: usize = 128;

/// Pull parser for a single XML text.
pub(super) struct Xml<'a> {
    text: &'a str,
    file: u32,
    /// Number of bytes that were skipped before the text, which is the length of a byte order mark.
    skipped: usize,
    reader: Reader<&'a [u8]>,
    /// Spans of the elements that are open.
    open: Vec<Span>,
    /// True if the last element was self-closing.
    empty: bool,
    /// True once the first element has been read.
    has_root_element: bool,
}

/// Start tag of an XML element, together with its attributes.
pub(super) struct Tag<'a> {
    /// Local name of the element, without its namespace prefix.
    pub name: &'a str,
    pub at: Span,
    pub attributes: Vec<Attribute<'a>>,
}

/// Attribute of an XML element.
pub(super) struct Attribute<'a> {
    /// Local name of the attribute, without its namespace prefix.
    pub name: &'a str,
    pub value: Cow<'a, str>,
    /// Span of the attribute's value.
    pub at: Span,
}

/// Event that the XML parser returns when an element begins, an element ends, or the text ends.
pub(super) enum Event<'a> {
    Open(Tag<'a>),
    /// The innermost open element ends here.
    Close,
    /// The text ends here.
    End,
}

/// An [`Event`], or text inside an element.
pub(super) enum Content<'a> {
    Event(Event<'a>),
    /// Text with its entities replaced, and the span of its source.
    Text(Cow<'a, str>, Span),
}

impl<'a> Tag<'a> {
    /// Returns the attribute that has this name.
    pub fn get(&self, name: &str) -> Option<&Attribute<'a>> {
        self.attributes.iter().find(|attribute| attribute.name == name)
    }
}

/// Returns true if a file is XML and its root element has one of these names.
pub(super) fn has_root(bytes: &[u8], names: &[&str]) -> bool {
    let head = &bytes[..bytes.len().min(1 << 12)];
    let text = match std::str::from_utf8(head) {
        Ok(text) => text,
        Err(error) => std::str::from_utf8(&head[..error.valid_up_to()]).unwrap_or_default(),
    };
    let mut reader = Reader::from_str(text.strip_prefix('\u{feff}').unwrap_or(text));
    loop {
        match reader.read_event() {
            Ok(events::Event::Start(tag) | events::Event::Empty(tag)) => {
                return names.contains(&local(tag.name().0));
            }
            Ok(events::Event::Text(words)) if !words.trim().is_empty() => return false,
            Ok(events::Event::Eof) | Err(_) => return false,
            Ok(_) => {}
        }
    }
}

/// Removes the namespace prefix from a name.
fn local(name: &str) -> &str {
    name.rsplit(':').next().unwrap_or(name)
}

/// Converts UTF-16 text that has a byte order mark to UTF-8; returns other bytes unchanged.
pub(super) fn utf8(bytes: Arc<[u8]>) -> Arc<[u8]> {
    let number: fn([u8; 2]) -> u16 = match *bytes {
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ => return bytes,
    };
    let words = bytes[2..].as_chunks::<2>().0.iter().map(|pair| number(*pair));
    let text: String = char::decode_utf16(words).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    text.into_bytes().into()
}

impl<'a> Xml<'a> {
    /// Starts to parse a text, which must be UTF-8.
    pub fn new(bytes: &'a [u8], file: u32) -> Result<Self, Box<Diagnostic>> {
        let span = |start: usize, end: usize| Span { file, start: start as u32, end: end as u32 };
        if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
            let error = Diagnostic::error("the text is in UTF-16").help("save the file in UTF-8");
            return Err(error.code("bad-file").at(span(0, 2)).into());
        }
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let at = error.valid_up_to();
            let wrong = Diagnostic::error("these bytes are not UTF-8").help("save the file in UTF-8");
            wrong.code("bad-file").at(span(at, at + error.error_len().unwrap_or(1)))
        })?;
        let plain = text.strip_prefix('\u{feff}').unwrap_or(text);
        let skipped = text.len() - plain.len();
        let reader = Reader::from_str(plain);
        Ok(Xml { text: plain, file, skipped, reader, open: Vec::new(), empty: false, has_root_element: false })
    }

    fn span(&self, start: usize, end: usize) -> Span {
        let at = |place: usize| (place + self.skipped) as u32;
        Span { file: self.file, start: at(start), end: at(end.max(start)) }
    }

    /// Returns the span of a part of the text.
    fn span_of(&self, piece: &str) -> Span {
        let start = piece.as_ptr() as usize - self.text.as_ptr() as usize;
        self.span(start, start + piece.len())
    }

    fn wrong(&self, at: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic::error(message).code("bad-file").at(at)
    }

    /// Returns the next parser event, and skips text.
    pub fn next(&mut self) -> Result<Event<'a>, Box<Diagnostic>> {
        loop {
            if let Content::Event(event) = self.next_content()? {
                return Ok(event);
            }
        }
    }

    /// Returns the next parser event or text. Comments split a text.
    pub fn next_content(&mut self) -> Result<Content<'a>, Box<Diagnostic>> {
        if std::mem::take(&mut self.empty) {
            self.open.pop();
            return Ok(Content::Event(Event::Close));
        }
        loop {
            let start = self.reader.buffer_position() as usize;
            let event = match self.reader.read_event() {
                Ok(event) => event,
                Err(error) => return Err(self.broken(&error).into()),
            };
            let end = self.reader.buffer_position() as usize;
            match event {
                events::Event::Start(_) => {
                    return self.tag(start + 1, end - 1).map(|tag| Content::Event(Event::Open(tag)));
                }
                events::Event::Empty(_) => {
                    self.empty = true;
                    return self.tag(start + 1, end - 2).map(|tag| Content::Event(Event::Open(tag)));
                }
                events::Event::End(_) => {
                    self.open.pop();
                    return Ok(Content::Event(Event::Close));
                }
                events::Event::Text(_) => {
                    let raw = self.text.get(start..end).unwrap_or_default();
                    return Ok(Content::Text(Cow::Borrowed(raw), self.span(start, end)));
                }
                events::Event::CData(_) => {
                    let raw = self.text.get(start..end).unwrap_or_default();
                    let inner = raw.strip_prefix("<![CDATA[").and_then(|raw| raw.strip_suffix("]]>"));
                    return Ok(Content::Text(Cow::Borrowed(inner.unwrap_or_default()), self.span(start, end)));
                }
                events::Event::GeneralRef(_) => {
                    let raw = self.text.get(start..end).unwrap_or_default();
                    // An unknown entity in text stays as it is, since most texts are skipped.
                    let text = escape::unescape(raw).unwrap_or(Cow::Borrowed(raw));
                    return Ok(Content::Text(text, self.span(start, end)));
                }
                events::Event::DocType(_) => {
                    let what = "document type declarations (`<!DOCTYPE`) are not supported";
                    let help = "remove the declaration, and replace its entities with their text";
                    return Err(self.wrong(self.span(start, end), what).help(help).into());
                }
                events::Event::Eof => {
                    return match self.open.last() {
                        Some(open) => Err(self.wrong(*open, "this element is not closed").code("unclosed").into()),
                        None if !self.has_root_element => {
                            Err(self.wrong(self.span(0, 0), "the file has no elements").into())
                        }
                        None => Ok(Content::Event(Event::End)),
                    };
                }
                // Comments and processing instructions are skipped.
                _ => {}
            }
        }
    }

    /// Parses an element from the text between its angle brackets.
    fn tag(&mut self, start: usize, end: usize) -> Result<Tag<'a>, Box<Diagnostic>> {
        let inner = self.text.get(start..end).unwrap_or_default();
        let whole = inner.find(|c: char| c.is_ascii_whitespace()).map_or(inner, |length| &inner[..length]);
        let at = self.span_of(whole);
        if self.has_root_element && self.open.is_empty() {
            return Err(self.wrong(at, "a file can have only one root element, and this is the second").into());
        }
        if self.open.len() >= MAX_DEPTH {
            return Err(self.wrong(at, format!("elements are nested more than {MAX_DEPTH} levels deep")).into());
        }
        self.has_root_element = true;
        self.open.push(at);
        let mut attributes: Vec<Attribute> = Vec::new();
        for attribute in Attributes::new(inner, whole.len()) {
            let attribute = attribute.map_err(|error| self.wrong_attribute(start, &error))?;
            let Cow::Borrowed(raw) = attribute.value else { continue };
            let place = self.span_of(raw);
            let value = escape::unescape(raw).map_err(|_| {
                let help = "known entities are `&lt;`, `&gt;`, `&amp;`, `&apos;`, `&quot;` and character numbers";
                self.wrong(place, "`&` does not begin a known entity").help(help)
            })?;
            attributes.push(Attribute { name: local(attribute.key.0), value, at: place });
        }
        Ok(Tag { name: local(whole), at, attributes })
    }

    fn wrong_attribute(&self, start: usize, error: &AttrError) -> Diagnostic {
        let (at, what) = match *error {
            AttrError::ExpectedEq(at) => (at, "an attribute needs `=` and a value"),
            AttrError::ExpectedValue(at) => (at, "an attribute needs a value"),
            AttrError::UnquotedValue(at) => (at, "a value must be in quotes"),
            AttrError::ExpectedQuote(at, _) => (at, "a quote is missing"),
            AttrError::Duplicated(at, _) => (at, "this attribute is given twice"),
        };
        let place = (start + at).min(self.text.len());
        self.wrong(self.span(place, place), what)
    }

    fn broken(&self, error: &quick_xml::Error) -> Diagnostic {
        let at = (self.reader.error_position() as usize).min(self.text.len());
        let place = self.span(at, at);
        if let quick_xml::Error::IllFormed(events) = error
            && let quick_xml::errors::IllFormedError::MismatchedEndTag { expected, found } = events
        {
            let name =
                |span: &Span| self.text.get(span.start as usize - self.skipped..span.end as usize - self.skipped);
            let is_open = |span: &Span| name(span) == Some(found.as_str());
            let message = match self.open.iter().any(is_open) {
                true => format!("`</{found}>` comes before `</{expected}>`"),
                false => format!("`</{found}>` closes an element that is not open"),
            };
            let wrong = self.wrong(place, message).code("unclosed");
            return match self.open.last() {
                Some(open) => wrong
                    .related(*open, format!("`{expected}` is open here"))
                    .help(format!("close it with `</{expected}>`, or end its tag with `/>` if it has no content")),
                None => wrong,
            };
        }
        let mut message = error.to_string();
        if let Some(rest) = message.strip_prefix("syntax error: ").or(message.strip_prefix("ill-formed document: ")) {
            message = rest.to_string();
        }
        self.wrong(place, message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the elements in the form `name@offset[attribute=value@offset]`, and the error that
    /// ends parsing.
    fn diagnose(text: &str) -> (Vec<String>, Option<(String, u32)>) {
        let mut all = Vec::new();
        let mut xml = match Xml::new(text.as_bytes(), 0) {
            Ok(xml) => xml,
            Err(error) => return (all, Some((error.message, error.span.unwrap().start))),
        };
        loop {
            match xml.next() {
                Ok(Event::Open(tag)) => {
                    let more = tag.attributes.iter().map(|a| format!(" {}={}@{}", a.name, a.value, a.at.start));
                    all.push(format!("{}@{}{}", tag.name, tag.at.start, more.collect::<String>()));
                }
                Ok(Event::Close) => all.push("/".into()),
                Ok(Event::End) => return (all, None),
                Err(error) => {
                    let span = error.span.unwrap();
                    assert!(span.start <= span.end && span.end as usize <= text.len(), "{error:?}");
                    return (all, Some((error.message, span.start)));
                }
            }
        }
    }

    #[test]
    fn elements_and_attributes_have_byte_offsets() {
        let (all, error) = diagnose(
            "\u{feff}<?xml version='1.0'?>\n<!-- a --><s:a x='1'>\n text <b m:y = \"&lt;2&#65;\" z=''/></s:a>\n",
        );
        assert_eq!(error, None);
        assert_eq!(all, ["a@36 x=1@43", "b@54 y=<2A@63 z=@78", "/", "/"]);
    }

    #[test]
    fn error_has_byte_offset() {
        for (text, place, words) in [
            ("", 0, "no elements"),
            ("words", 0, "no elements"),
            ("<a><b></a>", 6, "`</a>` comes before `</b>`"),
            ("<ab><b></a>", 7, "`</a>` closes an element that is not open"),
            ("<a><b/>", 1, "not closed"),
            ("<a/><b/>", 5, "the second"),
            ("<a x=1/>", 5, "quotes"),
            ("<a x/>", 4, "`=`"),
            ("<a x='1' x='2'/>", 9, "twice"),
            ("<a x='&boom;'/>", 6, "a known entity"),
            ("<!DOCTYPE a [<!ENTITY b \"bbbb\">]><a x='&b;'/>", 0, "DOCTYPE"),
            ("<a", 0, "tag not closed"),
            ("<a><!-- </a>", 3, "comment"),
        ] {
            let (_, error) = diagnose(text);
            let (message, at) = error.unwrap_or_else(|| panic!("{text}"));
            assert!(message.contains(words) && at == place, "{text}: {message} at {at}");
        }
        assert!(diagnose(&"<a>".repeat(1000)).1.unwrap().0.contains("nested"));
    }

    #[test]
    fn a_head_is_recognised() {
        let names = ["scene", "bsdf"];
        assert!(has_root(b"<?xml version='1.0' encoding='utf-8'?>\n<!-- hi -->\n<scene version='3.0.0'>", &names));
        assert!(has_root(b"\xef\xbb\xbf<scene>", &names) && has_root(b"<m:bsdf/>", &names));
        assert!(!has_root(b"<svg/>", &names) && !has_root(b"scene", &names) && !has_root(b"", &names));
        assert!(!has_root(b"x <scene>", &names));
    }
}
