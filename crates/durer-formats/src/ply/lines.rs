//! Detects vertex rows of a text PLY file whose number of values differs from the header.

use super::header::{Encoding, Header};
use crate::report::{Report, count_text};
use std::ops::Range;

/// Reports the first vertex row that has more or fewer numbers than the header declares. Returns
/// false if there is none, or if the file does not have one row per line.
pub(super) fn report_wrong_row(bytes: &[u8], header: &Header, report: &mut Report) -> bool {
    let Some(element) = header.elements.first().filter(|element| &bytes[element.name.clone()] == b"vertex") else {
        return false;
    };
    if element.properties.iter().any(|property| property.length_type.is_some()) {
        return false;
    }
    let declared = element.properties.len();
    let rows = usize::try_from(element.rows).unwrap_or(usize::MAX);
    let wrong = lines(bytes, header.body).take(rows).enumerate().find(|(_, (_, numbers))| *numbers != declared);
    let Some((row, (at, numbers))) = wrong else { return report_more_rows(bytes, header, (rows, declared), report) };
    // Rows can be divided into lines in any way, so a wrong first line may not be a row.
    let all = header.elements.iter().fold(0u64, |sum, element| sum.saturating_add(element.rows));
    if row == 0 && lines(bytes, header.body).count() as u64 != all {
        return false;
    }
    let message = format!(
        "row {} of `vertex` has {}, but {} declared",
        row + 1,
        count_text(numbers, "number", "numbers"),
        if declared == 1 { "1 property is".to_string() } else { format!("{declared} properties are") },
    );
    let text = String::from_utf8_lossy(&bytes[at.clone()]);
    let length: Option<usize> = text.split_ascii_whitespace().next().and_then(|word| word.parse().ok());
    // A face consists of the number of its vertices and at least three indices.
    let is_face = numbers > 3 && length == Some(numbers - 1);
    let help = match row > 0 && is_face {
        true => format!("write `element vertex {row}` if this row is a face, or add the missing vertices"),
        false => "correct this row, or the properties of `vertex` in the header".to_string(),
    };
    let declaration = report.span(element.name.clone());
    let error = report.error(at, message);
    (error.help, error.related) = (Some(help), Some((declaration, "the rows are declared here".into())));
    true
}

/// Reports that more vertex rows follow than the header declares, if the rows are followed by faces
/// and the next lines are no faces, but have as many numbers as a vertex.
fn report_more_rows(bytes: &[u8], header: &Header, (rows, declared): (usize, usize), report: &mut Report) -> bool {
    let [vertex, face, ..] = &header.elements[..] else { return false };
    let is_list = matches!(&face.properties[..], [only] if only.length_type.is_some());
    if !is_list || &bytes[face.name.clone()] != b"face" {
        return false;
    }
    // A face consists of the number of its vertices and their indices.
    let is_face = |at: &Range<usize>, numbers: usize| {
        let text = String::from_utf8_lossy(&bytes[at.clone()]);
        numbers > 3 && text.split_ascii_whitespace().next().is_some_and(|word| word.parse() == Ok(numbers - 1))
    };
    let more: Vec<Range<usize>> = lines(bytes, header.body)
        .skip(rows)
        .take_while(|(at, numbers)| *numbers == declared && !is_face(at, *numbers))
        .map(|(at, _)| at)
        .collect();
    let Some(first) = more.first() else { return false };
    // The rows that follow must be more than the header declares in all.
    let declared_rows = header.elements.iter().fold(0u64, |sum, element| sum.saturating_add(element.rows));
    if lines(bytes, header.body).count() as u64 != declared_rows.saturating_add(more.len() as u64) {
        return false;
    }
    let message = format!(
        "the header declares {}, but {} of {} {}",
        count_text(rows, "row of `vertex`", "rows of `vertex`"),
        if more.len() == 1 { "one more row".to_string() } else { format!("{} more rows", more.len()) },
        count_text(declared, "number", "numbers"),
        if more.len() == 1 { "follows" } else { "follow" },
    );
    let declaration = report.span(vertex.name.clone());
    let error = report.error(first.clone(), message);
    error.code = "bad-file";
    error.help = Some(format!("write `element vertex {}`", rows + more.len()));
    error.related = Some((declaration, "the rows are declared here".into()));
    true
}

/// Number of bytes at the start of the body that show whether it is text.
const SAMPLE: usize = 256;

/// Reports a file whose header says that it is binary, although its body consists of numbers as
/// text.
pub(super) fn report_text_body(bytes: &[u8], header: &Header, report: &mut Report) -> bool {
    let body = &bytes[header.body..bytes.len().min(header.body + SAMPLE)];
    let is_text = |byte: &u8| byte.is_ascii_digit() || byte.is_ascii_whitespace() || b"+-.eE".contains(byte);
    let has = |wanted: fn(&u8) -> bool| body.iter().any(wanted);
    // A few bytes can look like text by chance.
    let is_long = body.len() >= 24 && has(u8::is_ascii_digit) && has(u8::is_ascii_whitespace);
    if header.encoding == Encoding::Ascii || !is_long || !body.iter().all(is_text) {
        return false;
    }
    let Some(at) = format_line(bytes, header.body) else { return false };
    let error = report.error(at, "the header says that the numbers are binary, but they are text");
    (error.code, error.help) = ("bad-file", Some("write `format ascii 1.0`".into()));
    true
}

/// Returns the byte range of the line of the header that states the encoding.
fn format_line(bytes: &[u8], body: usize) -> Option<Range<usize>> {
    let start = bytes[..body].windows(7).position(|word| word == b"format ")?;
    let length = bytes[start..].iter().take_while(|byte| !b"\r\n".contains(byte)).count();
    Some(start..start + length)
}

/// Returns the byte range, and the number of words, of each line that is not blank.
fn lines(bytes: &[u8], start: usize) -> impl Iterator<Item = (Range<usize>, usize)> {
    let mut next = start;
    bytes[start..].split(|&byte| byte == b'\n' || byte == b'\r').filter_map(move |line| {
        let (at, text) = (next, line.trim_ascii_end());
        next += line.len() + 1;
        let words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count();
        (words > 0).then(|| (at..at + text.len(), words))
    })
}
