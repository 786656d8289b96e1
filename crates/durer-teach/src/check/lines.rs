//! Lines of text files with their spans.

use durer_diag::Span;

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
