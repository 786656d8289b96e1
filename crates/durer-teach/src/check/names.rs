//! Checks for names that the scene file defines but never uses.

use super::finding::Finding;
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Severity, Span};
use durer_formats::course::place::values;

/// Reports `define` statements whose names are never used.
pub(super) fn unused_define(scene_probe: &SceneProbe) -> Vec<Finding> {
    // Definitions in included files form a library and do not have to be used.
    let file = scene_probe.input.scene.camera_span.file;
    let Some(bytes) = scene_probe.input.files.bytes(file) else { return Vec::new() };
    let files = (0..).map_while(|i| scene_probe.input.files.bytes(i).map(|bytes| (i, bytes)));
    let used: Vec<String> =
        files.flat_map(|(i, bytes)| values(bytes, i, "use")).map(|span| scene_probe.text(span)).collect();
    let defined = values(bytes, file, "define");
    let unused: Vec<&Span> = defined.iter().filter(|span| !used.contains(&scene_probe.text(**span))).collect();
    let say = |span: &&Span| {
        let name = scene_probe.text(**span);
        let mut diagnostic = Diagnostic::note(format!("`{name}` is defined and never used"))
            .at(**span)
            .effect("the object is not in the picture: `define` only gives it a name")
            .help(format!("write `use {name}` in the `Group` where the object should appear"));
        // If none of the definitions is used, that is probably a mistake.
        if unused.len() == defined.len() {
            diagnostic.severity = Severity::Warning;
        }
        let empty = scene_probe.world().objects().is_empty() && diagnostic.severity == Severity::Warning;
        Finding::from(diagnostic).affecting_whole_picture(empty)
    };
    unused.iter().map(say).collect()
}
