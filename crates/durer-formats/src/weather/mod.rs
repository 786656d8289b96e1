//! Readers of weather files: EnergyPlus weather (`.epw`) and Radiance's `.wea`.
//!
//! Sources: *EnergyPlus Auxiliary Programs*, chapter *Weather Converter Program*; the manual page
//! of Radiance's `gendaymtx`.

mod epw;
mod wea;

use durer_diag::{Diagnostic, Diagnostics, Span};
use durer_scene::weather::Weather;
use std::ops::Range;

/// Maximum number of rows: a leap year with a row per minute.
const MAX_ROWS: usize = 366 * 24 * 60;

/// Irradiance above which a value is not a measurement, in W/m^2.
const MAX_IRRADIANCE: f32 = 2000.0;

/// Reads a weather file. The first word determines the format: `LOCATION` begins an EPW file, and
/// `place` a `.wea` file. If there is an error, adds it to the diagnostics with its span and
/// returns `None`.
pub fn read(bytes: &[u8], file: u32, diagnostics: &mut Diagnostics) -> Option<Weather> {
    // Names of places can be in any encoding, but all numbers are ASCII. Replacing single bytes
    // keeps all offsets valid.
    let text: String = bytes.iter().map(|&b| if b.is_ascii() { char::from(b) } else { '?' }).collect();
    let mut lines = Lines { text: &text, next: if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 } };
    let first = lines.clone().next().unwrap_or(Line { text: "", start: 0 });
    let word = first.text.split([',', ' ', '\t']).next().unwrap_or_default();
    let read = match word.to_ascii_lowercase().as_str() {
        "location" => epw::parse(&mut lines),
        "place" => wea::parse(&mut lines),
        _ => Err(first.error("a weather file must begin with `LOCATION` (.epw) or `place` (.wea)")),
    };
    let report = |ParseError { at, message }: ParseError| {
        let span = Span { file, start: at.start as u32, end: at.end as u32 };
        diagnostics.push(Diagnostic::error(message).code("bad-file").at(span));
    };
    read.map_err(report).ok()
}

/// Error with the bytes that caused it.
struct ParseError {
    at: Range<usize>,
    message: String,
}

/// Iterator over the lines of a file that are not empty.
#[derive(Clone)]
struct Lines<'a> {
    text: &'a str,
    /// Offset of the next line.
    next: usize,
}

/// Line of a file without surrounding spaces, and its offset.
#[derive(Clone, Copy)]
struct Line<'a> {
    text: &'a str,
    start: usize,
}

/// Field of a line without surrounding spaces, and its offset.
#[derive(Clone, Copy)]
struct Field<'a> {
    text: &'a str,
    start: usize,
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        while self.next < self.text.len() {
            let start = self.next;
            // Old Macintosh files end lines with a carriage return alone.
            let length = self.text[start..].find(['\n', '\r']).unwrap_or(self.text.len() - start);
            self.next = start + length + 1;
            let line = trimmed(&self.text[start..start + length], start);
            if !line.0.is_empty() {
                return Some(Line { text: line.0, start: line.1 });
            }
        }
        None
    }
}

impl Lines<'_> {
    /// Returns an error at the end of the file.
    fn end_error(&self, message: impl Into<String>) -> ParseError {
        let end = self.text.len();
        ParseError { at: end..end, message: message.into() }
    }
}

impl<'a> Line<'a> {
    fn error(&self, message: impl Into<String>) -> ParseError {
        ParseError { at: self.start..self.start + self.text.len(), message: message.into() }
    }

    /// Returns the fields between separators.
    fn fields(&self, separator: impl Fn(char) -> bool) -> Vec<Field<'a>> {
        let mut start = self.start;
        let field = |text: &'a str| {
            let (inner, at) = trimmed(text, start);
            start += text.len() + 1;
            Field { text: inner, start: at }
        };
        self.text.split(separator).map(field).collect()
    }
}

impl Field<'_> {
    fn error(&self, message: impl Into<String>) -> ParseError {
        ParseError { at: self.start..self.start + self.text.len(), message: message.into() }
    }

    /// Returns the number in the field, which must be in a range.
    fn number(&self, name: &str, range: std::ops::RangeInclusive<f64>) -> Result<f64, ParseError> {
        let found = self.text.parse::<f64>().ok().filter(|number| range.contains(number));
        let (low, high) = (range.start(), range.end());
        found.ok_or_else(|| {
            self.error(format!("`{}` is not a valid {name}: it must be from {low} to {high}", self.text))
        })
    }

    /// Returns the irradiance in the field. Values below 0 and values from 9999 are missing.
    fn irradiance(&self, name: &str) -> Result<Option<f32>, ParseError> {
        let found = self.text.parse::<f32>().ok().filter(|number| number.is_finite());
        let value = found.ok_or_else(|| self.error(format!("`{}` is not a valid {name} in W/m^2", self.text)))?;
        if !(0.0..9999.0).contains(&value) {
            return Ok(None);
        }
        match value <= MAX_IRRADIANCE {
            true => Ok(Some(value)),
            false => Err(self.error(format!("a {name} of {value} W/m^2 is more than sunlight above the atmosphere"))),
        }
    }
}

/// Removes surrounding spaces from a text, and returns the offset of the rest.
fn trimmed(text: &str, start: usize) -> (&str, usize) {
    let rest = text.trim_start();
    (rest.trim_end(), start + text.len() - rest.len())
}

/// Returns true if a day of a month exists. 29 February exists in any year, because typical years
/// consist of months of several years.
fn is_day(month: i32, day: i32) -> bool {
    let days = match month {
        2 => 29,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    };
    (1..=12).contains(&month) && (1..=days).contains(&day)
}

#[cfg(test)]
mod tests;
