//! Header of a PLY file, which describes the rows that follow it.

use crate::number::{parse_f32, parse_integer};
use crate::report::{Report, quoted};
use durer_diag::did_you_mean;
use std::ops::Range;

/// Encoding of the rows in a PLY file, which is text or binary in either byte order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

const ENCODINGS: [(&str, Encoding); 3] = [
    ("ascii", Encoding::Ascii),
    ("binary_little_endian", Encoding::LittleEndian),
    ("binary_big_endian", Encoding::BigEndian),
];

/// Number type of a single value in a PLY file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// Old name and new name of each number type.
const SCALARS: [(&str, &str, NumberType); 8] = [
    ("char", "int8", NumberType::I8),
    ("uchar", "uint8", NumberType::U8),
    ("short", "int16", NumberType::I16),
    ("ushort", "uint16", NumberType::U16),
    ("int", "int32", NumberType::I32),
    ("uint", "uint32", NumberType::U32),
    ("float", "float32", NumberType::F32),
    ("double", "float64", NumberType::F64),
];

impl NumberType {
    /// Size in bytes in a binary file.
    pub fn size(self) -> usize {
        match self {
            NumberType::I8 | NumberType::U8 => 1,
            NumberType::I16 | NumberType::U16 => 2,
            NumberType::I32 | NumberType::U32 | NumberType::F32 => 4,
            NumberType::F64 => 8,
        }
    }

    /// Value that stands for full intensity in a colour of this type: the maximum of an integer
    /// type, or 1 for floating-point types.
    pub fn full_intensity(self) -> f32 {
        match self {
            NumberType::I8 => 127.0,
            NumberType::U8 => 255.0,
            NumberType::I16 => 32767.0,
            NumberType::U16 => 65535.0,
            NumberType::I32 => i32::MAX as f32,
            NumberType::U32 => u32::MAX as f32,
            NumberType::F32 | NumberType::F64 => 1.0,
        }
    }

    /// Returns true if the type is an integer type.
    pub fn is_integer(self) -> bool {
        !matches!(self, NumberType::F32 | NumberType::F64)
    }
}

/// Property of a PLY element: the name and type of one column of its rows.
pub(super) struct Property {
    /// Byte range of the property's name.
    pub name: Range<usize>,
    /// Type of the value, or of the values in a list.
    pub number_type: NumberType,
    /// Type of the length if the property is a list.
    pub length_type: Option<NumberType>,
}

/// Element that a PLY header declares, such as `vertex` or `face`. An element is a table with a
/// number of rows.
pub(super) struct Element {
    /// Byte range of the element's name.
    pub name: Range<usize>,
    /// Number of rows that the header promises.
    pub rows: u64,
    pub properties: Vec<Property>,
}

/// Header of a PLY file after parsing.
pub(super) struct Header {
    pub encoding: Encoding,
    /// Byte range of the word for the encoding.
    pub encoding_at: Range<usize>,
    pub elements: Vec<Element>,
    /// True if triangles without normals are shaded flat, whatever the default is. The flag is a
    /// Dürer extension of the format.
    pub flat: bool,
    /// Byte offset of the first row.
    pub body: usize,
}

const KEYWORDS: [&str; 6] = ["format", "element", "property", "comment", "obj_info", "end_header"];

/// Value of `obj_info` that sets [`Header::flat`].
pub(super) const FLAT: &[u8] = b"flat";

/// Reads the header of a PLY file. Returns `None` if there are errors, after reporting them.
pub(super) fn read_header(bytes: &[u8], report: &mut Report) -> Option<Header> {
    let mut lines = Lines { bytes, at: 0 };
    let first = lines.next_line().unwrap_or(0..0);
    if &bytes[first.clone()] != b"ply" {
        let message = format!("expected `ply` in the first line, found {}", quoted(&bytes[first.clone()]));
        report.error(first, message);
        return None;
    }
    let mut reader = HeaderReader { bytes, report, encoding: None, elements: Vec::new(), flat: false };
    while let Some(line) = lines.next_line() {
        let words: Vec<Range<usize>> = split_words(bytes, line).take(6).collect();
        let Some(keyword) = words.first().cloned() else { continue };
        match &bytes[keyword.clone()] {
            b"obj_info" if words.get(1).is_some_and(|word| &bytes[word.clone()] == FLAT) => reader.flat = true,
            b"comment" | b"obj_info" => {}
            b"format" => reader.format(&words),
            b"element" => reader.element(&words),
            b"property" => reader.property(&words),
            b"end_header" => return reader.finish(keyword, lines.at),
            word if is_data(word) => {
                let message = "the header has no `end_header` before the first row";
                reader.report.error(keyword, message).help = Some("add the line `end_header` before this line".into());
                return None;
            }
            word => {
                let ends = did_you_mean(&String::from_utf8_lossy(word), KEYWORDS) == Some("end_header");
                reader.unknown("a header line", keyword, KEYWORDS);
                if ends {
                    return None;
                }
            }
        }
        if reader.report.is_full() {
            return None;
        }
    }
    reader.report.error(bytes.len()..bytes.len(), "the file ends within the header, because `end_header` is missing");
    None
}

/// Returns true if a word is a number or binary data, which can only be part of a row.
fn is_data(word: &[u8]) -> bool {
    parse_f32(word).is_ok() || !word.iter().all(u8::is_ascii_graphic)
}

/// Parser for a PLY header, which stores the elements found so far.
struct HeaderReader<'a, 'r> {
    bytes: &'a [u8],
    report: &'r mut Report,
    encoding: Option<(Encoding, Range<usize>)>,
    elements: Vec<Element>,
    flat: bool,
}

impl<'a> HeaderReader<'a, '_> {
    fn text(&self, at: &Range<usize>) -> &'a str {
        std::str::from_utf8(&self.bytes[at.clone()]).unwrap_or("\u{fffd}")
    }

    fn unknown<'c>(&mut self, what: &str, at: Range<usize>, known: impl IntoIterator<Item = &'c str>) {
        let help = did_you_mean(self.text(&at), known).map(|suggestion| format!("did you mean `{suggestion}`?"));
        self.report.error(at.clone(), format!("expected {what}, found {}", quoted(&self.bytes[at]))).help = help;
    }

    /// Reports a line in which words are missing or that has too many words.
    fn incomplete(&mut self, words: &[Range<usize>], form: &str) {
        let line = words[0].start..words[words.len() - 1].end;
        self.report.error(line, format!("expected `{form}`"));
    }

    fn format(&mut self, words: &[Range<usize>]) {
        let [_, encoding, version] = words else {
            return self.incomplete(words, "format ascii|binary_little_endian|binary_big_endian 1.0");
        };
        match ENCODINGS.iter().find(|(name, _)| *name == self.text(encoding)) {
            Some(&(_, known)) => self.encoding = Some((known, encoding.clone())),
            None => {
                // Continue, so that later errors are reported as well.
                self.encoding = Some((Encoding::Ascii, encoding.clone()));
                let names = ENCODINGS.map(|(name, _)| name);
                self.unknown(&format!("one of `{}`", names.join("`, `")), encoding.clone(), names);
            }
        }
        if self.text(version) != "1.0" {
            let message = format!("expected version 1.0, found {}", quoted(&self.bytes[version.clone()]));
            self.report.error(version.clone(), message);
        }
    }

    fn element(&mut self, words: &[Range<usize>]) {
        let [_, name, rows] = words else {
            self.incomplete(words, "element <name> <number of rows>");
            // Keep the element, so that its properties are checked as well.
            return self.elements.push(Element { name: words[0].clone(), rows: 0, properties: Vec::new() });
        };
        let number_type = parse_integer(&self.bytes[rows.clone()]).filter(|&rows| rows >= 0);
        if number_type.is_none() {
            let message = format!("expected a number of rows, found {}", quoted(&self.bytes[rows.clone()]));
            self.report.error(rows.clone(), message);
        }
        let rows = number_type.unwrap_or(0) as u64;
        self.elements.push(Element { name: name.clone(), rows, properties: Vec::new() });
    }

    fn property(&mut self, words: &[Range<usize>]) {
        let (count, number_type, name) = match words {
            [_, list, count, number_type, name] if self.text(list) == "list" => (Some(count), number_type, name),
            [_, number_type, name] if self.text(number_type) != "list" => (None, number_type, name),
            _ => return self.incomplete(words, "property <type> <name>` or `property list <type> <type> <name>"),
        };
        let (count, number_type) = (count.map(|count| self.scalar(count)), self.scalar(number_type));
        let (Some(number_type), Some(count)) = (number_type, count.map_or(Some(None), |c| c.map(Some))) else { return };
        if count.is_some_and(|count| !count.is_integer()) {
            self.report.error(words[2].clone(), "the length of a list must have an integer type");
        }
        match self.elements.last_mut() {
            Some(element) => element.properties.push(Property { name: name.clone(), number_type, length_type: count }),
            None => _ = self.report.error(words[0].clone(), "a `property` line must come after an `element` line"),
        }
    }

    fn scalar(&mut self, at: &Range<usize>) -> Option<NumberType> {
        let text = self.text(at);
        let number_type =
            SCALARS.iter().find(|(old, new, _)| *old == text || *new == text).map(|&(_, _, scalar)| scalar);
        if number_type.is_none() {
            let names = SCALARS.iter().flat_map(|&(old, new, _)| [old, new]);
            self.unknown("a type such as `float` or `int`", at.clone(), names);
        }
        number_type
    }

    fn finish(self, end: Range<usize>, body: usize) -> Option<Header> {
        if self.encoding.is_none() && !self.report.has_errors() {
            self.report.error(end, "the header has no `format` line").help =
                Some("add a second line such as `format ascii 1.0`".into());
        }
        let (encoding, encoding_at) = self.encoding.filter(|_| !self.report.has_errors())?;
        Some(Header { encoding, encoding_at, elements: self.elements, flat: self.flat, body })
    }
}

/// Iterator over the lines of a PLY header, without their line breaks.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Lines<'_> {
    fn next_line(&mut self) -> Option<Range<usize>> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|&byte| byte == b'\n' || byte == b'\r').unwrap_or(rest.len());
        let line = self.at..self.at + length;
        // A lone carriage return ends a line only if it also ends the first line, because binary
        // rows may begin with any byte.
        let ending = match rest[length..] {
            [b'\r', b'\n', ..] if !self.ends_with_return_alone() => 2,
            [] => 0,
            _ => 1,
        };
        self.at = line.end + ending;
        Some(line)
    }

    fn ends_with_return_alone(&self) -> bool {
        self.bytes.starts_with(b"ply\r") && !self.bytes.starts_with(b"ply\r\n")
    }
}

fn split_words(bytes: &[u8], line: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let base = line.start;
    let words = bytes[line].split(|byte| byte.is_ascii_whitespace());
    let mut at = base;
    words.filter_map(move |word| {
        let range = at..at + word.len();
        at = range.end + 1;
        (!range.is_empty()).then_some(range)
    })
}
