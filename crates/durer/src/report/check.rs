//! Conversion of diagnostics and of the findings of `durer check` to JSON.

use durer_diag::{Files, Severity, Span};
use durer_teach::check::Finding;
use serde_json::{Value, json};

/// Returns the list of findings in the output of `durer check --json`.
pub fn findings(findings: &[Finding], files: &Files) -> Value {
    findings.iter().map(|item| finding(item, files)).collect()
}

/// Returns the entry of a finding in the output of `durer check --json`.
pub fn finding(finding: &Finding, files: &Files) -> Value {
    let d = &finding.diagnostic;
    json!({
        "code": if d.code.is_empty() { "syntax" } else { d.code },
        "severity": match d.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        },
        "whole": finding.affects_whole_picture,
        "message": d.message,
        "label": d.label,
        "effect": d.effect,
        "help": d.help,
        "place": d.span.map(|span| place(files, span)),
        "related": d.related.as_ref().map(|(span, what)| json!({ "place": place(files, *span), "what": what })),
        "fix": d.fix.iter().map(|edit| json!({ "place": place(files, edit.span), "text": edit.text })).collect::<Vec<_>>(),
    })
}

/// Returns the JSON entry of a position in a file. Lines and columns are counted from 1, and bytes
/// from 0.
pub fn place(files: &Files, span: Span) -> Value {
    let end = Span { start: span.end, ..span };
    let ((line, column), (end_line, end_column)) =
        (files.position(span).unwrap_or_default(), files.position(end).unwrap_or_default());
    json!({
        "file": files.name(span.file), "line": line, "column": column, "end_line": end_line, "end_column": end_column,
        "start": span.start, "end": span.end,
    })
}
