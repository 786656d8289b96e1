//! Tests with thousands of broken files. The reader must not panic, must take a bounded amount of
//! time, and must report errors with spans that are inside the file.

use super::*;
use crate::Decoder;
use crate::course::random::SceneGenerator;
use crate::folder::FolderSource;
use durer_render::compile::{AccelKind, Resources, compile};

/// Reads a file in the given dialect. If there are no errors, also compiles the scene and writes
/// it.
fn try_it(text: &[u8], dialect: Dialect, strict: bool, source: &FolderSource) {
    let (scene, _) = read_as(text, dialect, strict);
    guess(text, 0, &[], &|_| false);
    let Some(scene) = scene else { return };
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let resources = Resources { sky_optional: true, ..Resources::new(source, &Decoder, &mut files) };
    let world = compile(&scene, dialect.rules(), AccelKind::Bvh, resources, &mut diagnostics);
    assert_eq!(world.is_none(), diagnostics.has_errors());
    assert!(!write(&scene, dialect).is_empty());
}

fn folder() -> (tempfile::TempDir, FolderSource) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cube.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let source = FolderSource::new(folder.path());
    (folder, source)
}

#[test]
fn every_prefix_of_a_scene() {
    let (_folder, source) = folder();
    for (dialect, text) in SMALL {
        for end in 0..text.len() {
            try_it(&text.as_bytes()[..end], dialect, end % 2 == 0, &source);
            // A truncated file causes one error, or two errors if a word was cut.
            let errors = read_as(&text.as_bytes()[..end], dialect, false).1;
            let errors = errors.iter().filter(|f| f.contains(" error: ")).count();
            assert!(errors <= 2, "{end}: {:?}", read_as(&text.as_bytes()[..end], dialect, false).1);
        }
    }
}

#[test]
fn changed_bytes() {
    let (_folder, source) = folder();
    let mut random = SceneGenerator::seeded(3);
    for i in 0..12_000 {
        let (dialect, text) = SMALL[i % SMALL.len()];
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..1 + random.below(4) {
            let at = random.below(bytes.len());
            match random.below(4) {
                0 => bytes[at] ^= 1 << random.below(8),
                1 => bytes[at] = random.below(256) as u8,
                2 => bytes[at] = b" {}0-.#\n"[random.below(8)],
                // Bytes that are copied from elsewhere in the file cause realistic errors.
                _ => bytes[at] = bytes[random.below(bytes.len())],
            }
        }
        try_it(&bytes, dialect, random.below(4) == 0, &source);
    }
}

#[test]
fn words_removed_doubled_and_moved() {
    let (_folder, source) = folder();
    let mut random = SceneGenerator::seeded(4);
    for i in 0..12_000 {
        let (dialect, text) = SMALL[i % SMALL.len()];
        let mut words: Vec<&str> = text.split_ascii_whitespace().collect();
        for _ in 0..1 + random.below(3) {
            let (at, to) = (random.below(words.len()), random.below(words.len()));
            match random.below(5) {
                0 => drop(words.remove(at)),
                1 => words.insert(to, words[at]),
                2 => words.swap(at, to),
                3 => words[at] = ["{", "}", "0", "-1", "1e38", "1e-38", "4294967295", "nan"][random.below(8)],
                _ => drop(words.drain(at.min(to)..at.max(to))),
            }
            if words.is_empty() {
                break;
            }
        }
        // Read some of the files in a dialect other than their own.
        let dialect = if random.below(4) == 0 { Dialect::ALL[random.below(7)] } else { dialect };
        try_it(words.join(" ").as_bytes(), dialect, random.below(4) == 0, &source);
    }
}

#[test]
fn random_scenes_compile_without_panic() {
    let (_folder, source) = folder();
    let mut random = SceneGenerator::seeded(5);
    for _ in 0..500 {
        for dialect in Dialect::ALL {
            let scene = random.scene(dialect);
            try_it(write(&scene, dialect).as_bytes(), dialect, false, &source);
        }
    }
}

#[test]
fn time_is_linear_in_file_size() {
    let ball = "MaterialIndex 0 Sphere { center 0 0 0 radius 1 }\n";
    let start = std::time::Instant::now();
    let text = format!("Materials {{ Material {{ }} }} Group {{ {} }}", ball.repeat(100_000));
    assert_eq!(clean(&text, Dialect::F04).root.unwrap().objects.len(), 100_000);
    guess(text.as_bytes(), 0, &[], &|_| false);
    for junk in ["foo ", "color ", "1 ", "Group ", "# ", "{ } ", "texture "] {
        for dialect in [Dialect::F04, Dialect::F23] {
            for head in ["", "Background { ", "Group { ", "Materials { Material { "] {
                read_as(format!("{head}{}", junk.repeat(200_000)).as_bytes(), dialect, false);
            }
        }
    }
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}
