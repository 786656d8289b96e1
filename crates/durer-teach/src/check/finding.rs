//! The result of a check, and helper functions for its wording.

use durer_diag::{Diagnostic, Edit, Severity};
pub(super) use durer_render::render::explain::number;
use durer_scene::math::Vec3;

/// Maximum number of findings of one kind that are reported individually.
pub(super) const MAX_PER_KIND: usize = 3;
/// Number of findings of one kind after which a check stops.
pub(super) const MAX_FINDINGS: usize = 50;

/// A problem that a check found in a scene, such as a light that illuminates nothing, with the edit
/// that fixes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Code, span, message, and the edit that fixes the problem.
    pub diagnostic: Diagnostic,
    /// True if the finding affects the whole picture and not only part of it.
    pub affects_whole_picture: bool,
    /// True if the finding only describes the picture. Such a finding is dropped if another finding
    /// explains the whole picture.
    pub(super) only_describes: bool,
}

impl From<Diagnostic> for Finding {
    fn from(diagnostic: Diagnostic) -> Self {
        Finding { diagnostic, affects_whole_picture: false, only_describes: false }
    }
}

impl Finding {
    /// Returns true for warnings and errors, which mean that the picture is wrong or cannot be
    /// rendered.
    pub fn is_serious(&self) -> bool {
        self.diagnostic.severity > Severity::Note
    }

    /// Sets whether the finding affects the whole picture.
    pub(super) fn affecting_whole_picture(self, whole: bool) -> Self {
        Finding { affects_whole_picture: whole, ..self }
    }

    /// Marks the finding as a description, which is dropped if another finding explains the whole
    /// picture.
    pub(super) fn only_describing(self) -> Self {
        Finding { only_describes: true, affects_whole_picture: true, ..self }
    }
}

/// Adds the number of further findings of the same kind to the last one that is shown, along with
/// the edits of `other`.
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

/// Formats a vector in the way scene files write it.
pub(super) fn vector(v: Vec3) -> String {
    // Components that are tiny next to the others are rounding errors.
    let least = 1e-6 * v.abs().max_element();
    let [x, y, z] = v.to_array().map(|part| if part.abs() < least { 0.0 } else { part }).map(number);
    format!("{x} {y} {z}")
}

/// Formats a ratio as a percentage.
pub(super) fn percent(part: usize, of: usize) -> String {
    let share = 100.0 * part as f32 / of.max(1) as f32;
    if share > 0.0 && share < 1.0 { "less than 1 %".into() } else { format!("{share:.0} %") }
}

/// Formats a count together with its noun.
pub(super) fn counted(count: usize, one: &str, many: &str) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{count} {many}") }
}
