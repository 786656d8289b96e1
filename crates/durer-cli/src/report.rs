//! Diagnostics on the terminal.

use crate::Failure;
use codespan_reporting::diagnostic::{Diagnostic as Shown, Label, Severity as Level};
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term::termcolor::{ColorChoice, StandardStream};
use codespan_reporting::term::{Config, emit_to_write_style};
use durer::diag::{Diagnostic, Diagnostics, ERROR_LIMIT, Files, Severity, Span};
use std::io::IsTerminal;
use std::path::Path;

/// Prints findings to standard error: all, or the errors alone.
pub fn print(files: &Files, diagnostics: &Diagnostics, errors_only: bool) {
    let wanted: Vec<&Diagnostic> =
        diagnostics.iter().filter(|d| !errors_only || d.severity == Severity::Error).collect();
    if wanted.is_empty() {
        return;
    }
    let mut shown = SimpleFiles::new();
    for file in 0.. {
        let (Some(name), Some(bytes)) = (files.name(file), files.bytes(file)) else { break };
        // Files that nothing is said of need no text.
        let used = wanted.iter().any(|d| spans(d).any(|span| span.file == file));
        shown.add(name.to_string(), if used { text(bytes) } else { String::new() });
    }
    let color = if std::io::stderr().is_terminal() { ColorChoice::Auto } else { ColorChoice::Never };
    let stream = StandardStream::stderr(color);
    for diagnostic in wanted {
        // Nothing can be said where standard error is closed.
        let _ = emit_to_write_style(&mut stream.lock(), &Config::default(), &shown, &show(diagnostic));
    }
    if diagnostics.error_count() > ERROR_LIMIT {
        eprintln!("and {} errors more", diagnostics.error_count() - ERROR_LIMIT);
    }
}

/// One note, in one line.
pub fn note(diagnostic: &Diagnostic) {
    eprintln!("note: {}", diagnostic.message);
}

/// A scene file that cannot be read.
pub fn unreadable(path: &Path, error: durer::source::SourceError) -> Failure {
    Failure::Input(Some(format!("{}: {error}", path.display())))
}

fn spans(diagnostic: &Diagnostic) -> impl Iterator<Item = Span> {
    diagnostic.span.into_iter().chain(diagnostic.related.iter().map(|r| r.0))
}

/// A file's bytes as text of the same length: places stay where they are, whatever the bytes.
fn text(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_string(),
        Err(_) => bytes.iter().map(|&b| if b.is_ascii() { char::from(b) } else { '?' }).collect(),
    }
}

fn show(diagnostic: &Diagnostic) -> Shown<usize> {
    let level = match diagnostic.severity {
        Severity::Error => Level::Error,
        Severity::Warning => Level::Warning,
        Severity::Note => Level::Note,
    };
    let range = |span: Span| span.start as usize..span.end as usize;
    let mut labels = Vec::new();
    if let Some(span) = diagnostic.span {
        labels.push(Label::primary(span.file as usize, range(span)).with_message(&diagnostic.label));
    }
    if let Some((span, what)) = &diagnostic.related {
        labels.push(Label::secondary(span.file as usize, range(*span)).with_message(what));
    }
    let notes = diagnostic.help.iter().map(|help| format!("help: {help}")).collect();
    Shown::new(level).with_message(&diagnostic.message).with_labels(labels).with_notes(notes)
}
