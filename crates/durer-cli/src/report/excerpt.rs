//! The part of a file that a diagnostic shows.

use codespan_reporting::files::{self, Files as _, SimpleFiles};
use durer::diag::Span;
use std::ops::Range;

/// View of the files of a diagnostic that shows only the text around its labels. This is necessary
/// because lines can be megabytes long.
pub struct Excerpt<'f> {
    files: &'f SimpleFiles<String, String>,
    /// File and range of the main label and of the related one. Each range is within the visible
    /// part of its line.
    pub main: Option<(usize, Range<usize>)>,
    pub related: Option<(usize, Range<usize>)>,
}

impl<'f> Excerpt<'f> {
    /// Number of bytes of a line shown before and after the start of a label.
    const BEFORE: usize = 80;
    const AFTER: usize = 120;

    /// Selects the text around two spans. The second one has no label if it is in the same long
    /// line as the first one, but too far from it.
    pub fn new(files: &'f SimpleFiles<String, String>, main: Option<Span>, related: Option<Span>) -> Self {
        let mut excerpt = Excerpt { files, main: None, related: None };
        excerpt.main = main.and_then(|span| excerpt.visible(span));
        excerpt.related = related.and_then(|span| excerpt.visible(span));
        excerpt
    }

    /// Returns the file of a span, and the part of the span that is in the visible part of its
    /// first line. Returns nothing if the span starts outside this part.
    fn visible(&self, span: Span) -> Option<(usize, Range<usize>)> {
        let (file, source) = (span.file as usize, self.files.source(span.file as usize).ok()?);
        let start = (span.start as usize).min(source.len());
        let shown = self.around(file, self.files.line_index(file, start).ok()?, start).ok()?;
        let last = shown.start + source[shown.clone()].trim_end_matches('\n').len();
        let end = (span.end as usize).clamp(start, last.max(start));
        (shown.start <= start && start <= shown.end).then_some((file, start..end))
    }

    /// Returns the visible part of a line: the text around the first label in the line, or around
    /// `start` if there is no label yet.
    fn around(&self, file: usize, line: usize, start: usize) -> Result<Range<usize>, files::Error> {
        let (whole, source) = (self.files.line_range(file, line)?, self.files.source(file)?);
        let is_here = |label: &&(usize, Range<usize>)| {
            label.0 == file && self.files.line_index(file, label.1.start).is_ok_and(|other| other == line)
        };
        let label = self.main.iter().chain(&self.related).find(is_here);
        let place = label.map_or(start, |label| label.1.start).clamp(whole.start, whole.end);
        let boundary = |from: usize| (from..whole.end).find(|&at| source.is_char_boundary(at)).unwrap_or(whole.end);
        Ok(boundary(place.saturating_sub(Self::BEFORE).max(whole.start))..boundary(place.saturating_add(Self::AFTER)))
    }
}

impl<'f> files::Files<'f> for Excerpt<'_> {
    type FileId = usize;
    type Name = String;
    type Source = &'f str;

    fn name(&'f self, id: usize) -> Result<String, files::Error> {
        self.files.name(id)
    }

    fn source(&'f self, id: usize) -> Result<&'f str, files::Error> {
        self.files.source(id)
    }

    fn line_index(&'f self, id: usize, byte: usize) -> Result<usize, files::Error> {
        self.files.line_index(id, byte)
    }

    fn column_number(&'f self, id: usize, line: usize, byte: usize) -> Result<usize, files::Error> {
        self.files.column_number(id, line, byte)
    }

    fn line_range(&'f self, id: usize, line: usize) -> Result<Range<usize>, files::Error> {
        self.around(id, line, 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::show;
    use codespan_reporting::term::{Config, emit_to_write_style, termcolor::NoColor};
    use durer::diag::Diagnostic;

    /// Returns the printed form of a diagnostic with two labels.
    fn printed(text: &str, main: Range<usize>, related: Range<usize>) -> String {
        let mut files = SimpleFiles::new();
        files.add("scene.txt".to_string(), text.to_string());
        let span = |range: Range<usize>| Span { file: 0, start: range.start as u32, end: range.end as u32 };
        let diagnostic = Diagnostic::warning("a message").at(span(main)).label("here").related(span(related), "there");
        let excerpt = Excerpt::new(&files, diagnostic.span, diagnostic.related.as_ref().map(|related| related.0));
        let mut out = NoColor::new(Vec::new());
        emit_to_write_style(&mut out, &Config::default(), &excerpt, &show(&diagnostic, &excerpt)).unwrap();
        String::from_utf8(out.into_inner()).unwrap()
    }

    #[test]
    fn a_related_label_at_the_start_of_a_long_line_is_shown() {
        let text = format!("<shape{}\nmain", " ".repeat(110));
        let shown = printed(&text, text.len() - 4..text.len(), 1..6);
        assert!(shown.contains("1 │ <shape") && shown.contains("----- there"), "{shown}");
        assert!(shown.contains("2 │ main") && shown.contains("^^^^ here"), "{shown}");
    }

    #[test]
    fn a_related_label_far_away_in_the_same_line_is_left_out() {
        let text = format!("first{}second", " ".repeat(300));
        let shown = printed(&text, text.len() - 6..text.len(), 0..5);
        assert!(shown.contains("^^^^^^ here") && !shown.contains("there"), "{shown}");
    }

    /// Labels at any two places of texts with long lines, wide characters and tabs are printed.
    #[test]
    fn labels_at_any_place_are_printed() {
        let mut state = 1_u64;
        let mut random = |below: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % below.max(1)
        };
        for round in 0..20_000 {
            let mut text = String::new();
            for _ in 0..random(4) {
                let (width, character) = (random(300), random(6));
                (0..width)
                    .for_each(|at| text.push(['a', ' ', 'é', '漢', '🙂', '\t'][(character + at * (round % 2)) % 6]));
                text.push('\n');
            }
            let mut range = || {
                let (start, length) = (random(text.len() + 2), random([1, 5, 400][round % 3]));
                // Positions can lie behind the end, and ends can precede starts.
                start..(start + length).saturating_sub(round % 2)
            };
            let shown = printed(&text, range(), range());
            assert!(shown.contains("a message") && shown.contains("here"), "{text:?}\n{shown}");
            assert!(shown.lines().all(|line| line.len() < 1000), "{text:?}\n{shown}");
        }
    }
}
