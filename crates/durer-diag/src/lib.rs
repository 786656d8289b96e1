//! Diagnostics: errors, warnings, and notes about input files, with their positions.
//!
//! The library creates diagnostics; the command-line program and the Python module print them.

mod stand_in;

use serde::{Deserialize, Serialize};
pub use stand_in::{StandIn, stand_in};
use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;

/// Maximum number of errors that are collected for one input file.
pub const ERROR_LIMIT: usize = 20;

/// Range of bytes in an input file, to which a diagnostic or an item of a scene refers.
///
/// Any two spans compare as equal, so comparing two scenes ignores the positions of their items in
/// the files.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Span {
    /// Number of the file in its [`Files`].
    pub file: u32,
    /// Offset of the first byte.
    pub start: u32,
    /// Offset of the byte after the last one.
    pub end: u32,
}

impl PartialEq for Span {
    fn eq(&self, _: &Span) -> bool {
        true
    }
}

impl Span {
    /// Returns true if the span is in a file. Items that come from options or defaults have no
    /// position.
    pub fn has_position(self) -> bool {
        self.end > 0
    }

    /// Joins this span with a later one; the result reaches from the start of this span to the end
    /// of `end`. Returns this span unchanged if `end` is in another file.
    pub fn join(self, end: Span) -> Span {
        if end.file != self.file {
            return self;
        }
        Span { end: end.end.max(self.start), ..self }
    }
}

/// Severity of a [`Diagnostic`]: note, warning, or error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The diagnostic only gives information and needs no action.
    Note,
    /// The picture may differ from what the author intended.
    Warning,
    /// The error prevents the picture from being rendered.
    Error,
}

/// Replacement of some text in an input file, which is part of the fix of a [`Diagnostic`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Edit {
    /// Range of bytes to replace; it is empty if the edit only inserts text.
    pub span: Span,
    /// Text that replaces the range.
    pub text: String,
}

/// An error, warning, or note about an input file, with its position and a suggestion for fixing
/// it.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Severity of the problem.
    pub severity: Severity,
    /// Identifier of the kind of problem, which stays the same across versions; empty if the
    /// problem has none.
    pub code: &'static str,
    /// Description of the problem, in one sentence without a full stop.
    pub message: String,
    /// Position in a file; `None` if the problem has no position.
    pub span: Option<Span>,
    /// Text that is printed next to the underlined position.
    pub label: String,
    /// Suggestion for fixing the problem, such as what the author probably meant.
    pub help: Option<String>,
    /// Second position that is related to the problem, with a description.
    pub related: Option<(Span, String)>,
    /// How the problem affects the picture.
    pub effect: Option<String>,
    /// Edits that fix the problem automatically; empty if there is no such fix.
    pub fix: Vec<Edit>,
}

impl Diagnostic {
    fn new(severity: Severity, message: impl Into<String>) -> Self {
        Diagnostic {
            severity,
            code: "",
            message: message.into(),
            span: None,
            label: String::new(),
            help: None,
            related: None,
            effect: None,
            fix: Vec::new(),
        }
    }

    /// Creates an error, which means that no picture can be rendered.
    pub fn error(message: impl Into<String>) -> Self {
        Diagnostic::new(Severity::Error, message)
    }

    /// Creates a warning, which means that the picture may differ from what the author intended.
    pub fn warning(message: impl Into<String>) -> Self {
        Diagnostic::new(Severity::Warning, message)
    }

    /// Creates a note, which is only for information.
    pub fn note(message: impl Into<String>) -> Self {
        Diagnostic::new(Severity::Note, message)
    }

    /// Sets the identifier of the kind of problem.
    pub fn code(self, code: &'static str) -> Self {
        Diagnostic { code, ..self }
    }

    /// Sets the text that describes how the problem affects the picture.
    pub fn effect(self, effect: impl Into<String>) -> Self {
        Diagnostic { effect: Some(effect.into()), ..self }
    }

    /// Adds an edit to the fix.
    pub fn fix(mut self, span: Span, text: impl Into<String>) -> Self {
        self.fix.push(Edit { span, text: text.into() });
        self
    }

    /// Adds an edit to the fix if its position is known.
    pub fn fix_at(self, place: Option<Span>, text: impl Into<String>) -> Self {
        match place {
            Some(span) => self.fix(span, text),
            None => self,
        }
    }

    /// Sets the position.
    pub fn at(mut self, span: Span) -> Self {
        self.span = Some(span);
        self
    }

    /// Sets the text that is printed next to the underlined position.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Sets the suggestion.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Sets the related position.
    pub fn related(mut self, span: Span, what: impl Into<String>) -> Self {
        self.related = Some((span, what.into()));
        self
    }
}

/// The diagnostics of one input file: up to [`ERROR_LIMIT`] errors, and up to the same number of
/// warnings and notes together. The collection counts any further diagnostics but does not store
/// them.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    errors: usize,
    warnings: usize,
}

/// Writes the message of each error on a line of its own. [`Files`] is needed for file, line and
/// column.
impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let messages: Vec<&str> = self.errors().map(|error| error.message.as_str()).collect();
        f.write_str(&messages.join("\n"))
    }
}

impl std::error::Error for Diagnostics {}

impl Diagnostics {
    /// Adds a diagnostic. If the collection already contains [`ERROR_LIMIT`] errors (or that many
    /// warnings and notes), any further ones are only counted.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        let count = match diagnostic.severity {
            Severity::Error => &mut self.errors,
            Severity::Warning | Severity::Note => &mut self.warnings,
        };
        *count += 1;
        if *count <= ERROR_LIMIT {
            self.list.push(diagnostic);
        }
    }

    /// Adds a diagnostic and returns true, unless the collection already has one with the same code
    /// and message. In that case, the label of the existing one says that the problem occurs again,
    /// and the new edits are added to it.
    pub fn push_once(&mut self, diagnostic: Diagnostic) -> bool {
        let is_same = |known: &&mut Diagnostic| known.code == diagnostic.code && known.message == diagnostic.message;
        let Some(known) = self.list.iter_mut().find(is_same) else {
            self.push(diagnostic);
            return true;
        };
        known.fix.extend(diagnostic.fix);
        known.label = "here, and again later in the file".into();
        false
    }

    /// Drops the diagnostics for which `keep` returns false.
    pub fn retain(&mut self, keep: impl Fn(&Diagnostic) -> bool) {
        let is_dropped = |diagnostic: &&Diagnostic| !keep(diagnostic);
        let errors =
            |list: &[Diagnostic]| list.iter().filter(is_dropped).filter(|d| d.severity == Severity::Error).count();
        let dropped = errors(&self.list);
        self.errors -= dropped;
        self.warnings -= self.list.iter().filter(is_dropped).count() - dropped;
        self.list.retain(keep);
    }

    /// Adds the diagnostics of another collection.
    pub fn extend(&mut self, other: Diagnostics) {
        let errors = other.errors().count();
        // Diagnostics that the other collection counted but did not store are counted here as well.
        let uncollected = (other.errors - errors, other.warnings - (other.list.len() - errors));
        for diagnostic in other.list {
            self.push(diagnostic);
        }
        self.errors += uncollected.0;
        self.warnings += uncollected.1;
    }

    /// Adds details to the first error, if there is one.
    pub fn add_to_first_error(&mut self, add: impl FnOnce(&mut Diagnostic)) {
        self.list.iter_mut().find(|diagnostic| diagnostic.severity == Severity::Error).map(add);
    }

    /// Returns true if the collection contains an error.
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// Returns true if the number of errors has reached the limit.
    pub fn is_full(&self) -> bool {
        self.errors >= ERROR_LIMIT
    }

    /// Diagnostics in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.list.iter()
    }

    /// Errors in the order in which they were added.
    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.iter().filter(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// Byte offset of the end of the last span in a file that any diagnostic refers to.
    fn end_in(&self, file: u32) -> usize {
        let places = |d: &Diagnostic| {
            let others = d.related.iter().map(|other| other.0).chain(d.fix.iter().map(|edit| edit.span));
            others.chain(d.span).filter(|span| span.file == file).map(|span| span.end).max()
        };
        self.list.iter().filter_map(places).max().unwrap_or(0) as usize
    }

    /// Number of errors, including those beyond the limit.
    pub fn error_count(&self) -> usize {
        self.errors
    }
}

/// The input files that were read, by number; converts spans to file names, lines, and columns.
#[derive(Clone, Debug, Default)]
pub struct Files {
    files: Vec<(String, Arc<[u8]>)>,
    /// Numbers of the files that are only partly kept in memory.
    truncated: BTreeSet<u32>,
}

impl Files {
    /// Maximum size in bytes of a file that is kept completely.
    const SMALL: usize = 64 << 20;

    /// Adds a file and returns its number.
    pub fn add(&mut self, name: impl Into<String>, bytes: Arc<[u8]>) -> u32 {
        self.files.push((name.into(), bytes));
        (self.files.len() - 1) as u32
    }

    /// Discards the end of a large file to save memory. Keeps the first `end` bytes, which later
    /// spans may refer to, and everything that the diagnostics in `messages` refer to.
    pub fn truncate(&mut self, file: u32, end: usize, messages: &Diagnostics) {
        let Some((_, bytes)) = self.files.get_mut(file as usize).filter(|(_, bytes)| bytes.len() > Self::SMALL) else {
            return;
        };
        let end = end.max(messages.end_in(file));
        if end < bytes.len() {
            // Keep the rest of the last line, because it is printed with a diagnostic. Keep at most
            // 256 bytes of it, since a binary file may have no lines.
            *bytes = bytes[..bytes.len().min(end + 256)].into();
            self.truncated.insert(file);
        }
    }

    /// Returns the number of the file that has this name and content. Adds the file if there is
    /// none yet.
    pub fn add_once(&mut self, name: &str, bytes: &Arc<[u8]>) -> u32 {
        match self.files.iter().position(|(known, content)| known == name && content == bytes) {
            Some(number) => number as u32,
            None => self.add(name, bytes.clone()),
        }
    }

    /// Name under which the file was read.
    pub fn name(&self, file: u32) -> Option<&str> {
        self.files.get(file as usize).map(|(name, _)| name.as_str())
    }

    /// Content of the file; `None` if only its beginning was kept.
    pub fn complete_bytes(&self, file: u32) -> Option<&[u8]> {
        self.bytes(file).filter(|_| !self.truncated.contains(&file))
    }

    /// Content of the file, or the part of it that was kept.
    pub fn bytes(&self, file: u32) -> Option<&[u8]> {
        self.files.get(file as usize).map(|(_, bytes)| &**bytes)
    }

    /// Line and column where a span starts, both counted from 1. Columns count characters, as
    /// editors do.
    pub fn position(&self, span: Span) -> Option<(usize, usize)> {
        let before = self.bytes(span.file)?.get(..span.start as usize)?;
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        // A byte order mark does not count as a column.
        let shown = if line == 1 { before.strip_prefix(b"\xef\xbb\xbf").unwrap_or(before) } else { before };
        // Continuation bytes of UTF-8 do not start a new character.
        let begins = |b: &&u8| **b & 0xc0 != 0x80;
        let column = shown.iter().rev().take_while(|&&b| b != b'\n').filter(begins).count() + 1;
        Some((line, column))
    }
}

/// Returns the candidate that is most similar to `word`, if one is similar enough.
pub fn did_you_mean<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Time and memory are proportional to the length of the word, which can be as long as a whole
    // file.
    if word.len() > 64 {
        return None;
    }
    let lower = word.to_lowercase();
    let letters = |word: &str| {
        let mut letters: Vec<char> = word.chars().collect();
        letters.sort_unstable();
        letters
    };
    // A candidate made of the same letters is the best match: for `RotateY`, it is `YRotate`.
    let distance = |candidate: &str| match letters(candidate) == letters(&lower) {
        true => 0,
        false => strsim::damerau_levenshtein(&lower, candidate),
    };
    candidates
        .into_iter()
        .map(|candidate| (distance(&candidate.to_lowercase()), candidate))
        .min_by_key(|&(distance, _)| distance)
        .filter(|&(distance, candidate)| distance <= (candidate.len().max(word.len()) / 3).max(1))
        .map(|(_, candidate)| candidate)
}

/// Formats a number of bytes in a readable unit, rounded up.
pub fn format_bytes_up(bytes: u64) -> String {
    rounded(bytes, u64::div_ceil)
}

/// Formats a number of bytes in a readable unit, rounded down. With this rounding, a limit never
/// looks larger than a size that exceeds it and is formatted by [`format_bytes_up`].
pub fn format_bytes_down(bytes: u64) -> String {
    rounded(bytes, |bytes, unit| bytes / unit)
}

fn rounded(bytes: u64, divide: fn(u64, u64) -> u64) -> String {
    match bytes {
        1 => "1 byte".into(),
        0 | 2..0x400 => format!("{bytes} bytes"),
        0x400..0x10_0000 => format!("{} KiB", divide(bytes, 1 << 10)),
        _ => format!("{} MiB", divide(bytes, 1 << 20)),
    }
}

#[cfg(test)]
mod tests;
