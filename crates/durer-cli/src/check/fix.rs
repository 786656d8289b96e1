//! Implements `durer check --fix`, which applies one edit after another and keeps those that remove
//! their finding.

use super::args::CheckArgs;
use super::change::Change;
use super::checked_scene::{CheckedScene, check_text};
use crate::failure::Failure;
use durer::check::{Finding, apply, rank};
use durer::diag::{Edit, Severity};
use durer::report::place;
use std::sync::Arc;

/// Maximum number of findings that are fixed in one run.
const MAX_FIXED: usize = 100;

/// Applies all fixes that help, and sets `checked` to the result for the new text.
pub fn apply_fixes(
    checked: &mut CheckedScene,
    mut text: Arc<[u8]>,
    args: &CheckArgs,
) -> Result<(Arc<[u8]>, Vec<Change>), Failure> {
    let mut changes = Vec::new();
    'again: for _ in 0..MAX_FIXED {
        for finding in checked.findings.iter().filter(|finding| !finding.diagnostic.fix.is_empty()) {
            let repaired = apply(&text, 0, std::slice::from_ref(finding));
            if repaired.fixed.is_empty() {
                continue;
            }
            let bytes: Arc<[u8]> = repaired.bytes.into();
            let after = check_text(&checked.path, bytes.clone(), args)?;
            if is_better(checked, &after, finding) {
                changes.extend(finding.diagnostic.fix.iter().map(|edit| change(checked, finding, edit)));
                (*checked, text) = (after, bytes);
                continue 'again;
            }
        }
        break;
    }
    Ok((text, changes))
}

/// Maximum number of findings whose edits are tried before they are offered to the user.
const MAX_TRIED: usize = 8;

/// Removes edits from the findings if `--fix` would not keep them.
pub fn remove_useless_fixes(checked: &mut CheckedScene, text: &[u8], args: &CheckArgs) -> Result<(), Failure> {
    let offered = |finding: &&Finding| !finding.diagnostic.fix.is_empty();
    let mut needed = Vec::new();
    for finding in checked.findings.iter().filter(offered).take(MAX_TRIED) {
        let repaired = apply(text, 0, std::slice::from_ref(finding));
        needed.push(match repaired.fixed.is_empty() {
            true => false,
            false => is_better(checked, &check_text(&checked.path, repaired.bytes.into(), args)?, finding),
        });
    }
    let offers = checked.findings.iter_mut().filter(|finding| !finding.diagnostic.fix.is_empty());
    for (finding, _) in offers.zip(needed).filter(|(_, needed)| !needed) {
        finding.diagnostic.fix.clear();
    }
    Ok(())
}

/// Returns true if `finding` is gone and nothing has become worse. That means there is no new
/// error, and no new finding about the whole picture that comes earlier in the causal order.
fn is_better(before: &CheckedScene, after: &CheckedScene, finding: &Finding) -> bool {
    let code = finding.diagnostic.code;
    let errors = |checked: &CheckedScene| checked.count(|f| f.diagnostic.severity == Severity::Error);
    // One finding may represent several similar ones.
    let alike = |checked: &CheckedScene| checked.count(|f| f.diagnostic.code == code);
    if errors(after) < errors(before) {
        return true;
    }
    let worse = |f: &Finding| f.affects_whole_picture && rank(f.diagnostic.code) < rank(code);
    errors(after) == errors(before) && alike(after) < alike(before) && after.count(worse) <= before.count(worse)
}

fn change(checked: &CheckedScene, finding: &Finding, edit: &Edit) -> Change {
    let span = edit.span;
    let bytes = checked.files.bytes(span.file).unwrap_or_default();
    let (line, column) = checked.files.position(span).unwrap_or_default();
    Change {
        code: finding.diagnostic.code,
        place: place(&checked.files, span),
        at: format!("{}:{line}:{column}", checked.files.name(span.file).unwrap_or_default()),
        old: String::from_utf8_lossy(&bytes[span.start as usize..span.end as usize]).into_owned(),
        new: edit.text.clone(),
    }
}
