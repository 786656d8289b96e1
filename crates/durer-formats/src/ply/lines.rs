//! Detects vertex rows of a text PLY file whose number of values differs from the header.

use super::header::Header;
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
    let Some((row, (at, numbers))) = wrong else { return false };
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
