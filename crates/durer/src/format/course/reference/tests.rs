//! The reference has every word, and its examples are scenes.

use super::*;
use crate::compile::{AccelKind, testing};
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
fn every_example_is_a_scene_in_which_something_is_seen() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    for entry in entries() {
        let Some(text) = entry.scene() else { continue };
        let (world, found) = testing::try_read(&text, Dialect::Durer.rules(), AccelKind::Bvh, &scenes);
        assert!(world.is_some() && found.iter().next().is_none(), "{}: {found:?}\n{text}", entry.name());
    }
}
