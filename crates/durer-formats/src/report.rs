//! Collector for the diagnostics of one file.

use durer_diag::{Diagnostic, Diagnostics, ERROR_LIMIT, Severity, Span};
use std::ops::Range;

/// Collector for the diagnostics of one file, which it forwards sorted by their spans.
///
/// A reader may process a file in several passes; sorting hides this from the user.
pub(super) struct Report {
    file: u32,
    diagnostics: Vec<Diagnostic>,
    errors: usize,
    /// Maximum number of errors to collect.
    max_errors: usize,
}

impl Report {
    /// Creates an empty report for a file. The report collects as many errors as `diagnostics` can
    /// still take.
    pub fn new(file: u32, diagnostics: &Diagnostics) -> Self {
        let max_errors = ERROR_LIMIT.saturating_sub(diagnostics.error_count());
        Report { file, diagnostics: Vec::new(), errors: 0, max_errors }
    }

    /// Creates an empty report for a part of the file, which is joined to this report later.
    pub fn part(&self) -> Report {
        Report {
            file: self.file,
            diagnostics: Vec::new(),
            errors: 0,
            max_errors: self.max_errors.saturating_sub(self.errors),
        }
    }

    /// Appends the report of the next part, up to the error limit, as if both parts had been read
    /// at once.
    pub fn join(&mut self, part: Report) {
        for diagnostic in part.diagnostics {
            if self.is_full() {
                return;
            }
            self.errors += usize::from(diagnostic.severity == Severity::Error);
            self.diagnostics.push(diagnostic);
        }
    }

    /// Adds an error at a byte range. The caller can add labels and help to the diagnostic that is
    /// returned.
    pub fn error(&mut self, at: Range<usize>, message: impl Into<String>) -> &mut Diagnostic {
        self.add(at, Diagnostic::error(message))
    }

    /// Adds a warning at a byte range.
    pub fn warning(&mut self, at: Range<usize>, message: impl Into<String>) -> &mut Diagnostic {
        self.add(at, Diagnostic::warning(message))
    }

    /// Adds a note at a byte range.
    pub fn note(&mut self, at: Range<usize>, message: impl Into<String>) -> &mut Diagnostic {
        self.add(at, Diagnostic::note(message))
    }

    /// Adds a diagnostic at a byte range.
    pub fn add(&mut self, at: Range<usize>, diagnostic: Diagnostic) -> &mut Diagnostic {
        if diagnostic.severity == Severity::Error {
            self.errors += 1;
        }
        let index = self.diagnostics.len();
        self.diagnostics.push(diagnostic.at(self.span(at)));
        &mut self.diagnostics[index]
    }

    /// Returns the span of a byte range. [`read_mesh`](crate::read_mesh) has already checked that
    /// offsets fit into 32 bits.
    pub fn span(&self, at: Range<usize>) -> Span {
        Span { file: self.file, start: at.start as u32, end: at.end as u32 }
    }

    /// Returns true if the report contains an error.
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// Returns true if no more errors can be collected, so that there is no point in reading on.
    pub fn is_full(&self) -> bool {
        self.errors >= self.max_errors
    }

    /// Returns true if a diagnostic with this message and byte range has already been added.
    pub fn contains(&self, at: &Range<usize>, message: &str) -> bool {
        let span = self.span(at.clone());
        self.diagnostics.iter().any(|known| known.span == Some(span) && known.message == message)
    }

    /// Returns true if there are diagnostics and all of them are at or after a byte offset.
    pub fn begins_at_or_after(&self, at: usize) -> bool {
        let is_after = |known: &Diagnostic| known.span.is_some_and(|span| span.start as usize >= at);
        !self.diagnostics.is_empty() && self.diagnostics.iter().all(is_after)
    }

    /// Returns the diagnostic that was added last, so that the caller can add help to it.
    pub fn last(&mut self) -> Option<&mut Diagnostic> {
        self.diagnostics.last_mut()
    }

    /// Drops all diagnostics except the first `count`, because another one explains them.
    pub fn truncate(&mut self, count: usize) {
        self.diagnostics.truncate(count);
        self.errors = self.diagnostics.iter().filter(|known| known.severity == Severity::Error).count();
    }

    /// Number of diagnostics of all severities.
    pub fn count(&self) -> usize {
        self.diagnostics.len()
    }

    /// Forwards all diagnostics, sorted by position; returns `result` if there were no errors.
    pub fn finish<T>(mut self, diagnostics: &mut Diagnostics, result: T) -> Option<T> {
        self.diagnostics.sort_by_key(|diagnostic| diagnostic.span.map_or(u32::MAX, |span| span.start));
        let failed = self.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error);
        // If the report is full, reading stopped early.
        let complete = !failed && self.max_errors > 0;
        self.diagnostics.into_iter().for_each(|diagnostic| diagnostics.push(diagnostic));
        complete.then_some(result)
    }
}

/// Quotes a part of a file for use in a message: in backquotes, escaped, and with at most 40
/// characters.
pub(super) fn quoted(bytes: &[u8]) -> String {
    const MAX_CHARS: usize = 40;
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * MAX_CHARS)]);
    let mut shown = String::new();
    for c in text.chars().take(MAX_CHARS) {
        // A doubled backslash would look like a part of a path.
        if c == '\\' { shown.push(c) } else { shown.extend(c.escape_debug()) }
    }
    if text.chars().count() > MAX_CHARS || bytes.len() > 4 * MAX_CHARS {
        shown.push('…');
    }
    format!("`{shown}`")
}

/// Formats a count together with its noun: `1 vertex`, `no vertices`, `8 vertices`.
pub(super) fn count_text(count: usize, one: &str, many: &str) -> String {
    match count {
        0 => format!("no {many}"),
        1 => format!("1 {one}"),
        _ => format!("{count} {many}"),
    }
}

/// Formats which items exist if they are numbered from 0: `no vertices`, `only vertex 0`, `only the
/// vertices 0 to 7`.
pub(super) fn range_text(count: usize, one: &str, many: &str) -> String {
    match count {
        0 => format!("no {many}"),
        1 => format!("only {one} 0"),
        _ => format!("only the {many} 0 to {}", count - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn report_is_sorted_by_file_position() {
        let mut diagnostics = Diagnostics::default();
        let mut report = Report::new(3, &diagnostics);
        report.error(9..10, "second");
        report.warning(2..4, "first").help = Some("help".into());
        assert_eq!(report.finish(&mut diagnostics, ()), None);
        let messages: Vec<_> = diagnostics.iter().map(|d| (d.message.as_str(), d.span.unwrap().file)).collect();
        assert_eq!(messages, [("first", 3), ("second", 3)]);
    }

    #[test]
    fn shown_text_is_short_and_printable() {
        assert_eq!(quoted(b"abc"), "`abc`");
        assert_eq!(quoted(b"a\x00\n"), "`a\\0\\n`");
        assert!(quoted(&[b'x'; 1000]).chars().count() < 50);
        assert!(quoted(&[0xff; 1000]).chars().count() < 50);
    }
}
