//! One finding, and how it is put into words.

use durer_diag::{Diagnostic, Edit, Severity};
use durer_scene::math::Vec3;

/// At most so many findings of one kind are told one by one.
pub(super) const MAX_ALIKE: usize = 3;
/// After so many of one kind, no more are looked for.
pub(super) const MAX_SOUGHT: usize = 50;

/// What a check has found.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Code, place, words, and the edit that mends it.
    pub diagnostic: Diagnostic,
    /// Whether it spoils the whole picture, and not a part of it.
    pub whole: bool,
    /// Whether it only says how the picture is, for want of anything that says why.
    pub(super) last: bool,
}

impl From<Diagnostic> for Finding {
    fn from(diagnostic: Diagnostic) -> Self {
        Finding { diagnostic, whole: false, last: false }
    }
}

impl Finding {
    /// Whether the picture is not what was meant, or cannot be made.
    pub fn is_serious(&self) -> bool {
        self.diagnostic.severity > Severity::Note
    }

    /// One that spoils the whole picture if `whole`.
    pub(super) fn whole(self, whole: bool) -> Self {
        Finding { whole, ..self }
    }

    /// One that gives way to all that spoil the whole picture.
    pub(super) fn last(self) -> Self {
        Finding { last: true, whole: true, ..self }
    }
}

/// Says at the last finding of a kind how many more there are, and takes their edits over.
pub(super) fn count_more(last: Option<&mut Finding>, more: usize, other: &Finding) {
    let Some(Finding { diagnostic, .. }) = last else { return };
    let words = format!("; and {more} more of this kind");
    let kept = diagnostic.message.rfind("; and ").filter(|_| more > 1).unwrap_or(diagnostic.message.len());
    diagnostic.message.truncate(kept);
    diagnostic.message += &words;
    let meets = |edit: &&Edit| diagnostic.fix.iter().any(|own| own.span.start == edit.span.start);
    let others: Vec<Edit> = other.diagnostic.fix.iter().filter(|edit| !meets(edit)).cloned().collect();
    diagnostic.fix.extend(others);
}

/// A number with four significant digits.
pub(super) fn number(x: f32) -> String {
    if x == 0.0 || !x.is_finite() {
        return if x == 0.0 { "0".into() } else { x.to_string() };
    }
    // Written with an exponent it is cut where the digits end, and is the nearest such number.
    let rounded: f64 = format!("{x:.3e}").parse().unwrap_or(f64::from(x));
    let size = rounded.abs();
    if (1e-4..1e7).contains(&size) { rounded.to_string() } else { format!("{rounded:e}") }
}

/// A vector as scene files have it.
pub(super) fn vector(v: Vec3) -> String {
    format!("{} {} {}", number(v.x), number(v.y), number(v.z))
}

/// A share as percent.
pub(super) fn percent(part: usize, of: usize) -> String {
    let share = 100.0 * part as f32 / of.max(1) as f32;
    if share > 0.0 && share < 1.0 { "less than 1 %".into() } else { format!("{share:.0} %") }
}

/// A count with its noun.
pub(super) fn counted(count: usize, one: &str, many: &str) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{count} {many}") }
}
