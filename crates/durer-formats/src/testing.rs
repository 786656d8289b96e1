//! Shared helpers for tests of readers, which read texts as scenes and format the diagnostics.

use crate::folder::FolderSource;
use crate::scene::{ReadInput, find_scene_format, read_model};
use durer::{LoadOptions, load_text};
use durer_diag::{Diagnostic, Diagnostics, Files, Severity};
use durer_scene::scene::{Scene, SceneDefaults};
use std::cell::RefCell;
use std::path::Path;
use std::sync::Arc;
use tempfile::TempDir;

/// Reads a text as if it were a file in a folder. Returns the diagnostics in order, in the form
/// `file:line:column severity message`.
pub(super) fn read_in(folder: &Path, name: &str, text: impl AsRef<[u8]>) -> (Option<Scene>, Vec<String>) {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let path = folder.join(name);
    let options = LoadOptions::default();
    let loaded = load_text(&path, text.as_ref().into(), &options, &mut files, &mut diagnostics);
    assert_eq!(loaded.is_none(), diagnostics.has_errors(), "{diagnostics:?}");
    (loaded.map(|loaded| loaded.scene), lines(&diagnostics, &files))
}

/// Reads a model with the test build of this crate, which has lower size limits. [`read_in`]
/// instead uses the crate `durer`, which is linked against the normal build.
pub(super) fn read_with_low_limits(name: &str, text: &str) -> (Option<Scene>, Vec<String>) {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let bytes: Arc<[u8]> = text.as_bytes().into();
    let file = files.add(name, bytes.clone());
    let (files, source, scene_defaults) = (RefCell::new(files), FolderSource::new("."), SceneDefaults::default());
    let memory = u64::MAX;
    let input = ReadInput {
        bytes: &bytes,
        file,
        files: &files,
        name,
        source: &source,
        scene_defaults: &scene_defaults,
        memory,
    };
    let scene = read_model(find_scene_format(&bytes, name).unwrap(), &input, &mut diagnostics);
    (scene, lines(&diagnostics, &files.borrow()))
}

/// Formats diagnostics in the form `file:line:column severity message (help)`.
fn lines(diagnostics: &Diagnostics, files: &Files) -> Vec<String> {
    let line = |found: &Diagnostic| {
        let severity = match found.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        let place = found.span.and_then(|span| {
            let (line, column) = files.position(span)?;
            let name = files.name(span.file)?.rsplit('/').next()?.to_string();
            Some(format!("{name}:{line}:{column} "))
        });
        let help = found.help.as_ref().map_or(String::new(), |help| format!(" ({help})"));
        format!("{}{severity} {}{help}", place.unwrap_or_default(), found.message)
    };
    diagnostics.iter().map(line).collect()
}

/// Creates a temporary folder that contains the given files.
pub(super) fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    folder
}
