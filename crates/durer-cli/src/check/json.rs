//! Output of `durer check --json`. The help text of `durer check` describes its form.

use super::change::Change;
use super::checked_scene::CheckedScene;
use durer::report::findings;
use serde_json::{Value, json};

/// Version of the JSON form.
const VERSION: u32 = 1;

/// Returns the JSON document for the checked scenes and their changes.
pub fn document(all: &[(CheckedScene, Vec<Change>)]) -> Value {
    let scene = |(checked, changes): &(CheckedScene, Vec<Change>)| {
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
