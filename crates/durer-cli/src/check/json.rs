//! `--json`: its form is told in the help of `durer check`.

use super::change::Change;
use super::checked::Checked;
use durer::report::findings;
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
            "findings": findings(&checked.findings, &checked.files),
            "mended": changes.iter().map(change).collect::<Vec<_>>(),
        })
    };
    json!({ "version": VERSION, "scenes": all.iter().map(scene).collect::<Vec<_>>() })
}

fn change(change: &Change) -> Value {
    json!({ "code": change.code, "place": change.place, "old": change.old, "new": change.new })
}
