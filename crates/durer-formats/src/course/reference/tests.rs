//! Tests that the reference contains all words and that its examples are valid scenes.

use super::*;
use crate::course::tests::clean;
use durer_render::compile::{AccelKind, testing};
use std::path::Path;

#[test]
fn every_word_of_the_reader_is_in_the_reference() {
    let ours = all_words();
    let missing: Vec<_> = super::super::words::all().filter(|word| !ours.contains(word)).collect();
    assert!(missing.is_empty(), "no entry for {missing:?}");
    let unknown: Vec<_> = ours.iter().filter(|word| super::super::words::dialects_of(word).is_none()).collect();
    assert!(unknown.is_empty(), "the reader does not know {unknown:?}");
}

#[test]
fn every_example_is_a_visible_scene() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    for entry in entries() {
        let Some(text) = entry.scene() else { continue };
        let (world, found) = testing::try_read(&text, Dialect::Durer.rules(), AccelKind::Bvh, &scenes);
        assert!(world.is_some() && found.iter().next().is_none(), "{}: {found:?}\n{text}", entry.name());
    }
}

/// Returns a scene of four sections that contains an example, which is only a part of a scene.
fn around(example: &str) -> (Dialect, String) {
    let first = example.split(' ').next().unwrap_or_default();
    if let "Scene" | "Node" | "Component<Object>" | "Component<Light>" | "Component<Material>" = first {
        let scene = match first {
            "Scene" => example.into(),
            "Node" => format!("Scene {{ {example} }}"),
            _ => format!("Scene {{ Node {{ {example} }} }}"),
        };
        let before = "Camera { center 0 0 10 direction 0 0 -1 up 0 1 0 fov 30 }
            Materials { Material { diffuse 1 0 0 } Material { diffuse 0 1 0 } }";
        return (Dialect::F23, format!("{before}\n{scene}"));
    }
    let usual = [
        ("PerspectiveCamera", "PerspectiveCamera { center 0 0 10 direction 0 0 -1 up 0 1 0 angle 30 }"),
        ("Background", "Background { color 0 0 0 }"),
        ("Lights", "Lights { PointLight { position 0 5 0 color 1 1 1 } }"),
        ("Materials", "Materials { PhongMaterial red { diffuseColor 1 0 0 } }"),
        ("define", "define column Sphere { center 0 0 0 radius 1 }"),
        ("Group", "Group { EXAMPLE MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }"),
    ];
    let (inside, before) = match first {
        "MaterialIndex" | "Transform" => (example, String::new()),
        "Texture" => ("", format!("Textures {{ {example} }}")),
        _ if usual.iter().any(|row| row.0 == first) => ("", String::new()),
        _ => ("", example.into()),
    };
    let sections = usual.map(|(word, text)| if word == first { example } else { text });
    (Dialect::Durer, format!("{before}\n{}", sections.join("\n").replace("EXAMPLE", inside)))
}

#[test]
fn every_word_has_a_readable_example() {
    for entry in entries() {
        assert!(!entry.example.is_empty(), "{} has no example", entry.name());
        // The included files do not exist in these tests. The tests of `include` cover an example
        // with an existing file.
        if entry.chapter == Chapter::Structure && entry.name() != "include" {
            let (dialect, text) = around(&entry.example);
            assert!(dialect.is_in(entry.dialects()), "{}", entry.name());
            clean(&text, dialect);
        }
    }
}
