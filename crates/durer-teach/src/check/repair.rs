//! Applies the edits of findings to the text of a scene.

use super::finding::Finding;
use durer_diag::Edit;

/// Text of a scene file after the edits of some findings have been applied, for `durer check
/// --fix`.
#[derive(Clone, Debug, PartialEq)]
pub struct RepairedText {
    /// Text after the edits.
    pub bytes: Vec<u8>,
    /// Indices of the findings whose edits were applied.
    pub fixed: Vec<usize>,
}

/// Applies the edits of findings to a file. Skips a finding if its edits overlap earlier ones or
/// belong to another file.
pub fn apply(bytes: &[u8], file: u32, findings: &[Finding]) -> RepairedText {
    let mut edits: Vec<&Edit> = Vec::new();
    let mut fixed = Vec::new();
    for (i, finding) in findings.iter().enumerate() {
        let inside = |edit: &Edit| {
            let Edit { span, .. } = edit;
            span.file == file && span.start <= span.end && span.end as usize <= bytes.len()
        };
        let mut all = edits.clone();
        all.extend(&finding.diagnostic.fix);
        all.sort_by_key(|edit| (edit.span.start, edit.span.end));
        let apart = all.windows(2).all(|pair| pair[0].span.end < pair[1].span.start);
        if !finding.diagnostic.fix.is_empty() && apart && finding.diagnostic.fix.iter().all(inside) {
            edits = all;
            fixed.push(i);
        }
    }
    let (mut text, mut at) = (Vec::with_capacity(bytes.len()), 0);
    for edit in edits {
        text.extend_from_slice(&bytes[at..edit.span.start as usize]);
        text.extend_from_slice(edit.text.as_bytes());
        at = edit.span.end as usize;
    }
    text.extend_from_slice(&bytes[at..]);
    RepairedText { bytes: text, fixed }
}
