//! Reader of spectra in text files, where each row contains a wavelength in nanometres and one or
//! more values, separated by commas, semicolons, or spaces.
//!
//! `#` starts a comment. If the first row contains words instead of numbers, they are the column
//! names.

use durer_diag::{Diagnostic, Diagnostics, Span};
use std::ops::Range;

/// Maximum number of rows in a file.
const MAX_ROWS: usize = 100_000;

/// Reads a spectrum as pairs of a wavelength and a value, sorted by wavelength in ascending order.
/// `column` selects the column of values by its name; without it, the first column is used.
pub fn read(bytes: &[u8], column: Option<&str>, file: u32, diagnostics: &mut Diagnostics) -> Option<Vec<[f32; 2]>> {
    std::str::from_utf8(bytes)
        .map_err(|error| {
            (error.valid_up_to()..error.valid_up_to() + 1, "a spectrum file must be UTF-8 text".to_string())
        })
        .and_then(|text| parse(text, column))
        .map_err(|(at, message)| {
            let span = Span { file, start: at.start as u32, end: at.end as u32 };
            diagnostics.push(Diagnostic::error(message).code("bad-file").at(span));
        })
        .ok()
}

type ParseError = (Range<usize>, String);

fn parse(text: &str, column: Option<&str>) -> Result<Vec<[f32; 2]>, ParseError> {
    let (mut rows, mut number, mut at) = (Vec::<[f32; 2]>::new(), None, 0);
    for line in text.split_inclusive('\n') {
        let content = line.split('#').next().unwrap_or_default().trim_end();
        let place = at..at + content.len();
        at += line.len();
        let words: Vec<&str> = content.split(|c: char| c == ',' || c == ';' || c.is_whitespace()).collect();
        let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
        let Some(first) = words.first() else { continue };
        let Ok(nm) = first.parse::<f32>() else {
            if !rows.is_empty() || number.is_some() {
                return Err((place, format!("`{first}` is not a wavelength in nanometres")));
            }
            let column_index =
                column.map_or(Some(1), |name| words.iter().position(|word| *word == name).filter(|&i| i > 0));
            let columns = words[1..].join(", ");
            let missing =
                || format!("the file has no column `{}`: the columns are {columns}", column.unwrap_or_default());
            number = Some(column_index.ok_or_else(|| (place, missing()))?);
            continue;
        };
        if let (Some(name), None) = (column, number) {
            return Err((
                place,
                format!("the file has no column `{name}`, because no row of names precedes the numbers"),
            ));
        }
        let word = words
            .get(number.unwrap_or(1))
            .ok_or_else(|| (place.clone(), "the value after the wavelength is missing".to_string()))?;
        let value = word.parse().ok().filter(|value: &f32| value.is_finite() && *value >= 0.0);
        let value =
            value.ok_or_else(|| (place.clone(), format!("`{word}` is not a spectral value: it must be 0 or more")))?;
        if !(nm > 0.0 && nm.is_finite()) || rows.last().is_some_and(|last| last[0] >= nm) {
            return Err((place, "wavelengths must be more than 0 and in ascending order".into()));
        }
        if rows.len() == MAX_ROWS {
            return Err((place, format!("a spectrum can have at most {MAX_ROWS} rows")));
        }
        rows.push([nm, value]);
    }
    if rows.last().is_some_and(|last| last[0] < 20.0) {
        let message = "wavelengths must be in nanometres: these look like micrometres, so multiply them by 1000";
        return Err((0..text.lines().next().map_or(0, str::len), message.into()));
    }
    if rows.len() < 2 {
        return Err((0..0, "a spectrum needs at least two rows of a wavelength and a value".into()));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_by_name_and_number() {
        let text = "# by hand\nnm,white,red\n400,0.5,0.1\n\n500 , 0.75 , 0.2 # the last\n";
        assert_eq!(parse(text, None).unwrap(), [[400.0, 0.5], [500.0, 0.75]]);
        assert_eq!(parse(text, Some("red")).unwrap(), [[400.0, 0.1], [500.0, 0.2]]);
        assert_eq!(parse("400\t1\r\n410;2\r\n", None).unwrap(), [[400.0, 1.0], [410.0, 2.0]]);
    }

    #[test]
    fn non_utf8_spectrum_is_an_error() {
        let mut diagnostics = Diagnostics::default();
        assert!(read(b"400 1\n500 \xff\n", None, 0, &mut diagnostics).is_none());
        assert!(diagnostics.has_errors());
    }

    #[test]
    fn spectrum_error_has_byte_range() {
        for (text, column, place, words) in [
            ("", None, 0..0, "two rows"),
            ("400 1\n", None, 0..0, "two rows"),
            ("nm a\n400 1\n500 2", Some("b"), 0..4, "columns are a"),
            ("400 1\n500 2", Some("b"), 0..5, "no row of names"),
            ("400 1\n300 2\n", None, 6..11, "ascend"),
            ("400 1\nblue 2\n", None, 6..12, "not a wavelength"),
            ("400 1\n500 -2\n", None, 6..12, "0 or more"),
            ("400 1\n500\n", None, 6..9, "missing"),
            ("400 1\n500 nan\n", None, 6..13, "0 or more"),
        ] {
            let (at, message) = parse(text, column).unwrap_err();
            assert!(at == place && message.contains(words), "{text:?}: {at:?} {message}");
        }
    }
}
