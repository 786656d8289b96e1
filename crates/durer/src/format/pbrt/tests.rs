//! pbrt's language: what is read of it, conventions in closed form, and errors with their places.

mod conventions;
mod language;

use crate::diag::{Diagnostics, Files, Severity};
use crate::material::PrincipledMaterial;
use crate::scene::{Material, Scene};
use crate::{LoadOptions, load_text};
use std::path::Path;
use tempfile::TempDir;

/// Reads a text in a folder; findings as `file:line:column severity message`, in their order.
fn read_in(folder: &Path, text: &str) -> (Option<Scene>, Vec<String>) {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let path = folder.join("scene.pbrt");
    let options = LoadOptions::default();
    let loaded = load_text(&path, text.as_bytes().into(), &options, &mut files, &mut diagnostics);
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

fn read(text: &str) -> (Option<Scene>, Vec<String>) {
    read_in(&std::env::temp_dir(), text)
}

/// A text of which nothing is to be said.
fn clean(text: &str) -> Scene {
    let (scene, told) = read(text);
    assert_eq!(told, [""; 0], "{text}");
    scene.unwrap()
}

/// A folder with some files.
fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, bytes)| std::fs::write(folder.path().join(name), bytes).unwrap());
    folder
}

/// A scene with a sphere of a material.
fn material(text: &str) -> (PrincipledMaterial, Vec<String>) {
    let (scene, told) = read(&format!("Camera \"perspective\" WorldBegin {text} Shape \"sphere\""));
    let scene = scene.unwrap_or_else(|| panic!("{text}: {told:?}"));
    let number = scene.root.as_ref().unwrap().objects[0].material.unwrap() as usize;
    let Material::Principled(layers) = &scene.materials[number].value else { panic!("no layers: {text}") };
    ((**layers).clone(), told)
}
