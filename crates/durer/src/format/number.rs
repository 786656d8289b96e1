//! Numbers as they stand in text files.

use super::report::{Report, shown};
use std::ops::Range;

/// Why a word is not a usable number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberError {
    /// It is no number.
    Malformed,
    /// It is infinite, not a number, or beyond the range of 32-bit floating point.
    NotFinite,
}

/// Reads a word as a number, correctly rounded.
pub(super) fn parse_f32(word: &[u8]) -> Result<f32, NumberError> {
    let parsed = std::str::from_utf8(word).ok().and_then(|text| text.parse::<f32>().ok());
    match parsed {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(NumberError::NotFinite),
        None if is_c_not_finite(word) => Err(NumberError::NotFinite),
        None => Err(NumberError::Malformed),
    }
}

/// Whether a word is a not-finite number as C libraries print it: `-nan(ind)`, `1.#QNAN`, `-1.#IND00`.
fn is_c_not_finite(word: &[u8]) -> bool {
    let unsigned = word.strip_prefix(b"-").or(word.strip_prefix(b"+")).unwrap_or(word);
    let is_nan = unsigned.get(..4).is_some_and(|start| start.eq_ignore_ascii_case(b"nan("));
    is_nan || unsigned.strip_prefix(b"1.").is_some_and(is_not_finite_tail)
}

/// Whether bytes begin as Microsoft's C library continues a not-finite number after `1.`.
pub(super) fn is_not_finite_tail(bytes: &[u8]) -> bool {
    [&b"#INF"[..], b"#IND", b"#QNAN", b"#SNAN"].iter().any(|tail| bytes.starts_with(tail))
}

/// Reads a word as a whole number; one beyond the range of `i64` becomes the nearest end of that range.
pub(super) fn parse_integer(word: &[u8]) -> Option<i64> {
    let (negative, digits) = match word {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() {
        return None;
    }
    let mut value = 0i64;
    for &digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        value = value.saturating_mul(10).saturating_add((digit - b'0') as i64);
    }
    Some(if negative { -value } else { value })
}

/// Reports a word that should have been a number.
pub(super) fn report_number(report: &mut Report, error: NumberError, at: Range<usize>, word: &[u8]) {
    match error {
        NumberError::NotFinite => {
            report.error(at, format!("expected a finite number, found {}", shown(word))).help =
                Some("numbers must lie within the range of 32-bit floating point, about ±3.4e38".into());
        }
        NumberError::Malformed => {
            let point: Vec<u8> = word.iter().map(|&byte| if byte == b',' { b'.' } else { byte }).collect();
            let help = (point != word && parse_f32(&point).is_ok())
                .then(|| format!("decimals are written with a point: {}", shown(&point)));
            report.error(at, format!("expected a number, found {}", shown(word))).help = help;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers() {
        for (word, value) in [("1", 1.0), ("-.5", -0.5), ("5.", 5.0), ("+1e-3", 1e-3), ("0.1", 0.1f32)] {
            assert_eq!(parse_f32(word.as_bytes()), Ok(value));
        }
        for word in ["nan", "-inf", "1e39", "1.#QNAN", "-1.#IND", "-nan(ind)", "infinity"] {
            assert_eq!(parse_f32(word.as_bytes()), Err(NumberError::NotFinite), "{word}");
        }
        for word in ["", "-", "1,5", "0x10", "1.2.3", "one", "1.#", "\u{661}"] {
            assert_eq!(parse_f32(word.as_bytes()), Err(NumberError::Malformed), "{word}");
        }
        assert_eq!(parse_f32(b"\xff1"), Err(NumberError::Malformed));
    }

    #[test]
    fn integers() {
        assert_eq!(parse_integer(b"42"), Some(42));
        assert_eq!(parse_integer(b"-7"), Some(-7));
        assert_eq!(parse_integer(b"+7"), Some(7));
        assert_eq!(parse_integer(b"99999999999999999999999"), Some(i64::MAX));
        assert_eq!(parse_integer(b"-99999999999999999999999"), Some(-i64::MAX));
        for word in [&b""[..], b"-", b"1.0", b"a", b"1e3"] {
            assert_eq!(parse_integer(word), None);
        }
    }
}
