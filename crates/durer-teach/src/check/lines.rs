//! Spans, and the lines of text files with their spans.

use durer_diag::Span;

/// Returns true if two spans are the same bytes of the same file. The operator `==` ignores them.
pub(super) fn is_same_span(a: Span, b: Span) -> bool {
    (a.file, a.start, a.end) == (b.file, b.start, b.end)
}

/// Returns the lines of a file with their spans. A span does not contain the white space at the end
/// of its line.
pub(super) fn lines(bytes: &[u8], file: u32) -> impl Iterator<Item = (Span, &[u8])> {
    let mut next = 0;
    bytes.split_inclusive(|b| *b == b'\n').map(move |line| {
        let start = next;
        next += line.len();
        (Span { file, start: start as u32, end: (start + line.trim_ascii_end().len()) as u32 }, line)
    })
}
