//! `--json`: its form is told in the help of `durer check`.

use super::change::Change;
use super::checked::Checked;
use durer::check::Finding;
use durer::diag::{Files, Severity, Span};
use serde_json::{Value, json};

/// The version of the JSON.
const VERSION: u32 = 1;

/// All scenes.
pub fn document(all: &[(Checked, Vec<Change>)]) -> Value {
    let scene = |(checked, changes): &(Checked, Vec<Change>)| {
        json!({
            "scene": checked.path.to_string_lossy(),
            "dialect": checked.dialect,
            "readable": checked.readable,
            "findings": checked.findings.iter().map(|f| finding(f, &checked.files)).collect::<Vec<_>>(),
            "mended": changes.iter().map(change).collect::<Vec<_>>(),
        })
    };
    json!({ "version": VERSION, "scenes": all.iter().map(scene).collect::<Vec<_>>() })
}

/// A finding.
pub fn finding(finding: &Finding, files: &Files) -> Value {
    let d = &finding.diagnostic;
    json!({
        "code": if d.code.is_empty() { "syntax" } else { d.code },
        "severity": match d.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        },
        "whole": finding.whole,
        "message": d.message,
        "label": d.label,
        "effect": d.effect,
        "help": d.help,
        "place": d.span.map(|span| place(files, span)),
        "related": d.related.as_ref().map(|(span, what)| json!({ "place": place(files, *span), "what": what })),
        "fix": d.fix.iter().map(|edit| json!({ "place": place(files, edit.span), "text": edit.text })).collect::<Vec<_>>(),
    })
}

fn change(change: &Change) -> Value {
    json!({ "code": change.code, "place": change.place, "old": change.old, "new": change.new })
}

/// A place by lines and columns, and by bytes.
pub fn place(files: &Files, span: Span) -> Value {
    let end = Span { start: span.end, ..span };
    let ((line, column), (end_line, end_column)) =
        (files.position(span).unwrap_or_default(), files.position(end).unwrap_or_default());
    json!({
        "file": files.name(span.file), "line": line, "column": column, "end_line": end_line, "end_column": end_column,
        "start": span.start, "end": span.end,
    })
}
