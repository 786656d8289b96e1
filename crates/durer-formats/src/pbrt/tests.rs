//! Tests of the pbrt reader: its syntax, its conventions compared with analytic results, and the
//! positions of errors.

mod conventions;
mod language;
mod shapes;
mod third;
mod third_materials;

use crate::testing::{self, folder};
use durer::{LoadOptions, load_text};
use durer_diag::{Diagnostics, Files};
use durer_scene::material::PrincipledMaterial;
use durer_scene::scene::{Material, Scene};
use std::path::Path;

/// Reads a scene whose files are in the folder `folder`; see [`testing`].
fn read_in(folder: &Path, text: &str) -> (Option<Scene>, Vec<String>) {
    testing::read_in(folder, "scene.pbrt", text)
}

fn read(text: &str) -> (Option<Scene>, Vec<String>) {
    read_in(&std::env::temp_dir(), text)
}

/// Reads a scene, which must not cause any diagnostics.
fn clean(text: &str) -> Scene {
    let (scene, messages) = read(text);
    assert_eq!(messages, [""; 0], "{text}");
    scene.unwrap()
}

/// Returns the layers of a sphere's material, and the diagnostics.
fn material(text: &str) -> (PrincipledMaterial, Vec<String>) {
    let (scene, messages) = read(&format!("Camera \"perspective\" WorldBegin {text} Shape \"sphere\""));
    let scene = scene.unwrap_or_else(|| panic!("{text}: {messages:?}")); // prose: keep
    let number = scene.root.as_ref().unwrap().objects[0].material.unwrap() as usize;
    let Material::Principled(layers) = &scene.materials[number].value else { panic!("no layers: {text}") };
    ((**layers).clone(), messages)
}
