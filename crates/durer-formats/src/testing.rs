//! What tests of readers share: texts to scenes, and what is told of them.

use durer::{LoadOptions, load_text};
use durer_diag::{Diagnostics, Files, Severity};
use durer_scene::scene::Scene;
use std::path::Path;
use tempfile::TempDir;

/// Reads a file as if it were in a folder; findings as `file:line:column severity message`, in their order.
pub(super) fn read_in(folder: &Path, name: &str, text: impl AsRef<[u8]>) -> (Option<Scene>, Vec<String>) {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let path = folder.join(name);
    let options = LoadOptions::default();
    let loaded = load_text(&path, text.as_ref().into(), &options, &mut files, &mut diagnostics);
    assert_eq!(loaded.is_none(), diagnostics.has_errors(), "{diagnostics:?}");
    let told = diagnostics.iter().map(|found| {
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
    });
    let told = told.collect();
    (loaded.map(|loaded| loaded.scene), told)
}

/// A folder with some files.
pub(super) fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    folder
}
