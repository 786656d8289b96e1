//! Rows of explanations, which show formulas with their numbers.

use crate::protocol::FormulaRow;
use glam::DVec3;

/// Formats a number with five significant digits.
pub(crate) fn number(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    if !x.is_finite() {
        return if x.is_nan() { "NaN".into() } else { if x > 0.0 { "∞" } else { "−∞" }.into() };
    }
    let rounded: f64 = format!("{x:.4e}").parse().unwrap_or(x);
    let size = rounded.abs();
    let text = if (1e-4..1e7).contains(&size) { rounded.to_string() } else { format!("{rounded:e}") };
    text.replace('-', "−")
}

/// Formats a vector as a tuple.
pub(crate) fn vector(v: impl Into<DVec3>) -> String {
    let v = v.into();
    format!("({}, {}, {})", number(v.x), number(v.y), number(v.z))
}

/// Formats a factor of a formula. Negative numbers are put in parentheses.
pub(crate) fn factor(x: f64) -> String {
    if x < 0.0 { format!("({})", number(x)) } else { number(x) }
}

/// Returns a row with a scalar result.
pub(crate) fn row(name: &str, formula: &str, numbers: impl Into<String>, value: f64) -> FormulaRow {
    FormulaRow {
        name: name.into(),
        formula: formula.into(),
        numbers: numbers.into(),
        result: number(value),
        value: Some(value),
    }
}

/// Returns a row with a vector result.
pub(crate) fn vector_row(name: &str, formula: &str, numbers: impl Into<String>, value: impl Into<DVec3>) -> FormulaRow {
    FormulaRow {
        name: name.into(),
        formula: formula.into(),
        numbers: numbers.into(),
        result: vector(value),
        value: None,
    }
}
