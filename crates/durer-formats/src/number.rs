//! Parsing of numbers in text files.

use super::report::{Report, quoted};
use std::ops::Range;

/// Reason why a word in a text file is not a valid number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberError {
    /// The word cannot be parsed as a number.
    Malformed,
    /// The word is not an integer where one is required.
    NotWhole,
    /// The number is infinite, NaN, or beyond the range of 32-bit floating point.
    NotFinite,
}

/// Parses a finite `f32` with correct rounding.
pub(super) fn parse_f32(word: &[u8]) -> Result<f32, NumberError> {
    if let Some(value) = parse_fast(word) {
        return Ok(value);
    }
    let parsed = std::str::from_utf8(word).ok().and_then(|text| text.parse::<f32>().ok());
    match parsed {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(NumberError::NotFinite),
        None if is_c_not_finite(word) => Err(NumberError::NotFinite),
        None => Err(NumberError::Malformed),
    }
}

/// Powers of ten that an `f64` can represent exactly.
const TENS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// Parses words of at most 15 digits quickly. Returns `None` for other words, and whenever the
/// result might not be correctly rounded.
///
/// Source: Clinger, *How to read floating point numbers accurately*, 1990. Multiplying or dividing
/// an integer below 2^53 by an exact power of ten rounds only once. Rounding that result to single
/// precision is wrong only if the result lies halfway between two `f32` values.
fn parse_fast(word: &[u8]) -> Option<f32> {
    let (negative, mut rest) = match word {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        rest => (false, rest),
    };
    let (mut digits, mut count, mut scale) = (0u64, 0, 0i32);
    let mut is_fraction = false;
    while let [byte, after @ ..] = rest {
        match byte {
            b'0'..=b'9' => {
                digits = digits.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
                count += 1;
                scale -= i32::from(is_fraction);
            }
            b'.' if !is_fraction => is_fraction = true,
            b'e' | b'E' => {
                let (sign, power) = match after {
                    [b'-', power @ ..] => (-1, power),
                    [b'+', power @ ..] => (1, power),
                    power => (1, power),
                };
                if !(1..=3).contains(&power.len()) || !power.iter().all(u8::is_ascii_digit) {
                    return None;
                }
                scale += sign * power.iter().fold(0, |n, digit| 10 * n + i32::from(digit - b'0'));
                break;
            }
            _ => return None,
        }
        rest = after;
    }
    if count == 0 || count > 15 {
        return None;
    }
    let power = *TENS.get(scale.unsigned_abs() as usize)?;
    let double = if scale < 0 { digits as f64 / power } else { digits as f64 * power };
    let is_halfway = double.to_bits() & 0x1fff_ffff == 0x1000_0000;
    let is_usual = double == 0.0 || (1e-30..1e30).contains(&double);
    let value = double as f32;
    (is_usual && !is_halfway).then_some(if negative { -value } else { value })
}

/// Returns true for non-finite numbers in the forms that C libraries print: `-nan(ind)`, `1.#QNAN`,
/// `-1.#IND00`.
fn is_c_not_finite(word: &[u8]) -> bool {
    let unsigned = word.strip_prefix(b"-").or(word.strip_prefix(b"+")).unwrap_or(word);
    let is_nan = unsigned.get(..4).is_some_and(|start| start.eq_ignore_ascii_case(b"nan("));
    is_nan || unsigned.strip_prefix(b"1.").is_some_and(is_not_finite_tail)
}

/// Returns true if bytes begin with the text that Microsoft's C library prints after `1.` for
/// non-finite numbers.
pub(super) fn is_not_finite_tail(bytes: &[u8]) -> bool {
    [&b"#INF"[..], b"#IND", b"#QNAN", b"#SNAN"].iter().any(|tail| bytes.starts_with(tail))
}

/// Parses an integer. Values beyond the range of `i64` are clamped to that range.
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

/// Reports a word that is not a valid number of the expected kind.
pub(super) fn report_number(report: &mut Report, error: NumberError, at: Range<usize>, word: &[u8]) {
    match error {
        NumberError::NotFinite => {
            report.error(at, format!("expected a finite number, found {}", quoted(word))).help =
                Some("numbers must lie within the range of 32-bit floating point, about ±3.4e38".into());
        }
        NumberError::NotWhole => {
            report.error(at, format!("expected a whole number, found {}", quoted(word)));
        }
        NumberError::Malformed => {
            let point: Vec<u8> = word.iter().map(|&byte| if byte == b',' { b'.' } else { byte }).collect();
            let help = (point != word && parse_f32(&point).is_ok())
                .then(|| format!("write decimals with a point: {}", quoted(&point)));
            report.error(at, format!("expected a number, found {}", quoted(word))).help = help;
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
    fn fast_path_rounds_like_the_standard_parser() {
        let mut state = 1u64;
        let mut random = |below: u64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 20) % below
        };
        let mut quick = 0;
        for i in 0..200_000u64 {
            let digits = random(10u64.pow(1 + (i % 17) as u32));
            let mut word = digits.to_string();
            word.insert(random(word.len() as u64 + 1) as usize, '.');
            match random(4) {
                0 => word += &format!("e{}", random(60) as i64 - 30),
                1 => word.insert(0, '-'),
                _ => {}
            }
            let number = parse_fast(word.as_bytes());
            quick += usize::from(number.is_some());
            if let Some(number) = number {
                assert_eq!(number.to_bits(), word.parse::<f32>().unwrap().to_bits(), "{word}");
            }
        }
        assert!(quick > 120_000, "{quick}");
        // The first number is halfway between two `f32` values and the second is slightly above it,
        // so only the first needs the slow path.
        assert_eq!(parse_fast(b"16777217"), None);
        assert_eq!(parse_fast(b"16777217.5"), Some(16777218.0));
        assert_eq!(parse_fast(b"-0.0").map(f32::to_bits), Some((-0.0f32).to_bits()));
        for word in [&b""[..], b".", b"-", b"1e", b"1e+", b"1..2", b"1e5.0", b"inf", b"0x1"] {
            assert_eq!(parse_fast(word), None);
        }
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
