//! Diagnostics: what is wrong with an input, and where.
//!
//! The library makes them, the shells print them.

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::sync::Arc;

/// At most this many errors of one input are collected.
pub const ERROR_LIMIT: usize = 20;

/// A range of bytes in a file.
///
/// Spans compare equal to each other: where a thing was written is not part of what it is.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Span {
    /// Number of the file in its [`Files`].
    pub file: u32,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl PartialEq for Span {
    fn eq(&self, _: &Span) -> bool {
        true
    }
}

impl Span {
    /// Whether it is a place in a file: what options say, and what is not written, has none.
    pub fn is_place(self) -> bool {
        self.end > 0
    }

    /// From the start of this span to the end of another in the same file; this span, if that is in
    /// another.
    pub fn to(self, end: Span) -> Span {
        if end.file != self.file {
            return self;
        }
        Span { end: end.end.max(self.start), ..self }
    }
}

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// The picture may not be what was meant.
    Warning,
    /// No picture can be made.
    Error,
}

/// A change of a file's text: what stands at a place is replaced.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Edit {
    /// What is replaced; of no length where something is put in.
    pub span: Span,
    /// By what.
    pub text: String,
}

/// One finding about an input.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// The kind of finding, in a word that does not change from version to version; empty where it
    /// has none.
    pub code: &'static str,
    /// What is wrong, in one sentence without a full stop.
    pub message: String,
    /// Where; `None` where it concerns no place in a file.
    pub span: Option<Span>,
    /// Said at the underlined place.
    pub label: String,
    /// What may have been meant, or what to do.
    pub help: Option<String>,
    /// Another place that has to do with it, with what it is.
    pub related: Option<(Span, String)>,
    /// What comes of it in the picture.
    pub effect: Option<String>,
    /// The change that mends it, where that is mechanical.
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

    /// A finding because of which no picture can be made.
    pub fn error(message: impl Into<String>) -> Self {
        Diagnostic::new(Severity::Error, message)
    }

    /// A finding because of which the picture may not be what was meant.
    pub fn warning(message: impl Into<String>) -> Self {
        Diagnostic::new(Severity::Warning, message)
    }

    /// Something worth knowing.
    pub fn note(message: impl Into<String>) -> Self {
        Diagnostic::new(Severity::Note, message)
    }

    /// Sets the kind.
    pub fn code(self, code: &'static str) -> Self {
        Diagnostic { code, ..self }
    }

    /// Sets what comes of it in the picture.
    pub fn effect(self, effect: impl Into<String>) -> Self {
        Diagnostic { effect: Some(effect.into()), ..self }
    }

    /// Adds a change that is a part of what mends it.
    pub fn fix(mut self, span: Span, text: impl Into<String>) -> Self {
        self.fix.push(Edit { span, text: text.into() });
        self
    }

    /// The same, where the place is known.
    pub fn fix_at(self, place: Option<Span>, text: impl Into<String>) -> Self {
        match place {
            Some(span) => self.fix(span, text),
            None => self,
        }
    }

    /// Sets the place.
    pub fn at(mut self, span: Span) -> Self {
        self.span = Some(span);
        self
    }

    /// Sets what is said at the underlined place.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Sets the advice.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Names a second place.
    pub fn related(mut self, span: Span, what: impl Into<String>) -> Self {
        self.related = Some((span, what.into()));
        self
    }
}

/// Collects diagnostics, up to [`ERROR_LIMIT`] errors and as many warnings.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    errors: usize,
    warnings: usize,
}

impl Diagnostics {
    /// Adds a finding. Beyond the limit of its severity it is counted only.
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

    /// Adds a finding once for all places: where it is there in the same words, that one is said to
    /// be so again, and takes the edits. Tells whether it was new.
    pub fn push_once(&mut self, diagnostic: Diagnostic) -> bool {
        let is_same = |known: &&mut Diagnostic| known.code == diagnostic.code && known.message == diagnostic.message;
        let Some(known) = self.list.iter_mut().find(is_same) else {
            self.push(diagnostic);
            return true;
        };
        known.fix.extend(diagnostic.fix);
        known.label = "here, and again further on".into();
        false
    }

    /// Adds all findings of another collection.
    pub fn extend(&mut self, other: Diagnostics) {
        let errors = other.list.iter().filter(|d| d.severity == Severity::Error).count();
        // Those that the other counted without keeping them count here too.
        let uncollected = (other.errors - errors, other.warnings - (other.list.len() - errors));
        for diagnostic in other.list {
            self.push(diagnostic);
        }
        self.errors += uncollected.0;
        self.warnings += uncollected.1;
    }

    /// Whether there is an error.
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// Whether as many errors were found as are collected.
    pub fn is_full(&self) -> bool {
        self.errors >= ERROR_LIMIT
    }

    /// The findings, in the order in which they were found.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.list.iter()
    }

    /// Where the last of what is said of a file ends in it.
    fn end_in(&self, file: u32) -> usize {
        let places = |d: &Diagnostic| {
            let others = d.related.iter().map(|other| other.0).chain(d.fix.iter().map(|edit| edit.span));
            others.chain(d.span).filter(|span| span.file == file).map(|span| span.end).max()
        };
        self.list.iter().filter_map(places).max().unwrap_or(0) as usize
    }

    /// How many errors were found, collected or not.
    pub fn error_count(&self) -> usize {
        self.errors
    }
}

/// The files that were read, by number, for turning spans into lines and columns.
#[derive(Clone, Debug, Default)]
pub struct Files {
    files: Vec<(String, Arc<[u8]>)>,
    /// Those of which only the beginning is known.
    cut: BTreeSet<u32>,
}

impl Files {
    /// Files up to this size are kept as they are, for who looks at them again.
    const SMALL: usize = 64 << 20;

    /// Adds a file and returns its number.
    pub fn add(&mut self, name: impl Into<String>, bytes: Arc<[u8]>) -> u32 {
        self.files.push((name.into(), bytes));
        (self.files.len() - 1) as u32
    }

    /// Lets go of a large file that was read: of what lies behind a place up to which spans may
    /// yet be of it, and behind all of which something is said.
    pub fn cut(&mut self, file: u32, end: usize, said: &Diagnostics) {
        let Some((_, bytes)) = self.files.get_mut(file as usize).filter(|(_, bytes)| bytes.len() > Self::SMALL) else {
            return;
        };
        let end = end.max(said.end_in(file));
        if end < bytes.len() {
            // The line in which that ends is shown with it, but there may be none in what is no
            // text.
            *bytes = bytes[..bytes.len().min(end + 256)].into();
            self.cut.insert(file);
        }
    }

    /// The number of a file of this name and these bytes, which is added if it is not there.
    pub fn add_once(&mut self, name: &str, bytes: &Arc<[u8]>) -> u32 {
        match self.files.iter().position(|(known, content)| known == name && content == bytes) {
            Some(number) => number as u32,
            None => self.add(name, bytes.clone()),
        }
    }

    /// The name under which a file was read.
    pub fn name(&self, file: u32) -> Option<&str> {
        self.files.get(file as usize).map(|(name, _)| name.as_str())
    }

    /// The bytes of a file, unless only its beginning is known.
    pub fn whole(&self, file: u32) -> Option<&[u8]> {
        self.bytes(file).filter(|_| !self.cut.contains(&file))
    }

    /// The bytes of a file, or of its beginning.
    pub fn bytes(&self, file: u32) -> Option<&[u8]> {
        self.files.get(file as usize).map(|(_, bytes)| &**bytes)
    }

    /// Line and column of the start of a span, both counted from 1; the column in characters, as
    /// editors count.
    pub fn position(&self, span: Span) -> Option<(usize, usize)> {
        let before = self.bytes(span.file)?.get(..span.start as usize)?;
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        // A byte order mark is no column of the first line.
        let shown = if line == 1 { before.strip_prefix(b"\xef\xbb\xbf").unwrap_or(before) } else { before };
        // Bytes that only go on with a character of UTF-8 begin none.
        let begins = |b: &&u8| **b & 0xc0 != 0x80;
        let column = shown.iter().rev().take_while(|&&b| b != b'\n').filter(begins).count() + 1;
        Some((line, column))
    }
}

/// The candidate most like `word`, if one is near enough to be meant.
pub fn did_you_mean<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // The distance takes time and memory in proportion to the word's length: nobody means a word by
    // a file's contents.
    if word.len() > 64 {
        return None;
    }
    let lower = word.to_lowercase();
    let letters = |word: &str| {
        let mut letters: Vec<char> = word.chars().collect();
        letters.sort_unstable();
        letters
    };
    // A word of the same letters is nearest: `RotateY` means `YRotate`.
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

/// So many bytes for people, rounded up.
pub fn at_least(bytes: u64) -> String {
    rounded(bytes, u64::div_ceil)
}

/// So many bytes for people, rounded down: less than what is told by [`at_least`] of more.
pub fn at_most(bytes: u64) -> String {
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
