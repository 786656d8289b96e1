//! Shared helpers for tests of readers, which read texts as scenes and format the diagnostics.

use crate::folder::FolderSource;
use crate::scene::{ReadInput, WriteContext, find_scene_format, read_model};
use crate::shared_report::NO_COUNTERPART;
use durer::{LoadOptions, load_text};
use durer_diag::{Diagnostic, Diagnostics, Files, Severity};
use durer_scene::dialect::MeshNormals;
use durer_scene::scene::{Scene, SceneDefaults};
use glam::DVec3;
use serde::Serialize;
use serde_json::Value;
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

/// Reads a text, writes the scene in the format of its name, which must not lose anything, and
/// reads that again. Returns both scenes.
pub(super) fn written_again(name: &str, text: &str) -> [Scene; 2] {
    let folder = folder(&[]);
    let (before, messages) = read_in(folder.path(), name, text);
    let before = before.unwrap_or_else(|| panic!("{messages:?}"));
    let after_name = format!("again.{}", name.rsplit('.').next().unwrap());
    let messages = write_in(folder.path(), &after_name, &before);
    assert_eq!(messages, [""; 0], "{text}");
    let (after, read) = read_in(folder.path(), &after_name, std::fs::read(folder.path().join(&after_name)).unwrap());
    let after = after.unwrap_or_else(|| panic!("{read:?}"));
    assert!(!read.iter().any(|line| line.contains("warning")), "{read:?}");
    [before, after]
}

/// Writes a scene and the files beside it in a folder. Returns the messages of the writer.
pub(super) fn write_in(folder: &Path, name: &str, scene: &Scene) -> Vec<String> {
    let source = FolderSource::new(folder);
    let (normals, mut diagnostics) = (MeshNormals::Flat, Diagnostics::default());
    let context = WriteContext { name, source: &source, normals, srgb_textures: true, memory: u64::MAX };
    let format = crate::scene::scene_format_for(name).unwrap();
    let written = format.write.unwrap()(scene, &context, &mut diagnostics);
    for (path, bytes) in written.files.into_iter().chain([(name.to_string(), written.bytes)]) {
        let path = folder.join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    assert!(diagnostics.iter().all(|found| found.code == NO_COUNTERPART), "{diagnostics:?}");
    diagnostics.iter().map(|found| found.message.clone()).collect()
}

/// Asserts that the writer of a format reports each kind of loss once, even if several parts of a
/// scene have it. `name` is that of a file in this format.
pub(super) fn assert_losses_are_reported_once(name: &str) {
    let text = "FisheyeCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 }
        Materials { numMaterials 1 PrincipledMaterial { fuzzWeight 1 } }
        Group { numObjects 2 MaterialIndex 0 Plane { normal 0 1 0 offset 0 } Plane { normal 0 1 0 offset 1 } }";
    let folder = folder(&[]);
    let (before, messages) = read_in(folder.path(), "a.txt", text);
    let messages = write_in(folder.path(), name, &before.unwrap_or_else(|| panic!("{messages:?}")));
    assert_eq!(messages.len(), 3, "{messages:?}");
    for part in ["fuzz", "infinite planes", "camera of this kind"] {
        assert_eq!(messages.iter().filter(|message| message.contains(part)).count(), 1, "{part} {messages:?}");
    }
}

/// Asserts that two values have the same parts, and numbers that differ by at most `tolerance`.
pub(super) fn assert_near(what: &str, before: &impl Serialize, after: &impl Serialize, tolerance: f64) {
    fn differs(a: &Value, b: &Value, tolerance: f64) -> bool {
        match (a, b) {
            (Value::Number(a), Value::Number(b)) => (a.as_f64().unwrap() - b.as_f64().unwrap()).abs() > tolerance,
            (Value::Array(a), Value::Array(b)) => {
                a.len() != b.len() || a.iter().zip(b).any(|(a, b)| differs(a, b, tolerance))
            }
            (Value::Object(a), Value::Object(b)) => {
                a.len() != b.len() || a.iter().any(|(key, a)| b.get(key).is_none_or(|b| differs(a, b, tolerance)))
            }
            (a, b) => a != b,
        }
    }
    let [a, b] = [serde_json::to_value(before).unwrap(), serde_json::to_value(after).unwrap()];
    assert!(!differs(&a, &b, tolerance), "{what}:\n{a}\n{b}");
}

/// Returns the corners of all triangles of a scene in world space.
pub(super) fn triangles(scene: &Scene) -> Vec<[DVec3; 3]> {
    let context = (FolderSource::new("."), Diagnostics::default());
    let (source, mut diagnostics) = context;
    let context =
        WriteContext { name: "a", source: &source, normals: MeshNormals::Flat, srgb_textures: true, memory: u64::MAX };
    let mut export = crate::export::Export::new(scene, &context, &mut diagnostics);
    let mut all = Vec::new();
    for shape in export.shapes("test") {
        let data = export.triangles(&shape, "test").unwrap();
        let data = crate::export::shape::transformed(data, &shape.to_world);
        all.extend(data.triangles.iter().map(|corners| corners.map(|i| data.positions[i as usize].as_dvec3())));
    }
    all
}
