//! Formatting of numbers in explanations.

use durer_scene::math::{Color, Vec3};

/// Formats a number with four significant digits. Zero is written without a sign.
pub fn number(x: f32) -> String {
    if x == 0.0 || !x.is_finite() {
        return if x == 0.0 { "0".into() } else { x.to_string() };
    }
    // Formatting with an exponent rounds to four digits, and parsing returns the number nearest to
    // the result.
    let rounded: f64 = format!("{x:.3e}").parse().unwrap_or(f64::from(x));
    let size = rounded.abs();
    if (1e-4..1e7).contains(&size) { rounded.to_string() } else { format!("{rounded:e}") }
}

/// Formats a vector.
pub fn vector(v: Vec3) -> String {
    format!("({}, {}, {})", number(v.x), number(v.y), number(v.z))
}

/// Formats a colour.
pub(super) fn rgb(color: Color) -> String {
    vector(color)
}
