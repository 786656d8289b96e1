//! Explanations against the pictures that they explain.

use super::*;
use crate::compile::{AccelKind, testing};
use crate::dialect::Dialect;
use crate::integrator::{Method, Settings};
use std::path::Path;

#[test]
fn explanations_sum_to_the_pixels_of_all_our_scenes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut scenes: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    scenes.retain(|path| path.extension().is_some_and(|extension| extension == "txt"));
    scenes.sort();
    assert!(scenes.len() > 12);
    for (i, scene) in scenes.iter().enumerate() {
        let text = std::fs::read_to_string(scene).unwrap();
        let dialect = [Dialect::Durer, Dialect::F12a4, Dialect::F04, Dialect::F12a5][i % 4];
        let (world, findings) = testing::try_read(&text, dialect.rules(), AccelKind::Bvh, &folder);
        let world = world.unwrap_or_else(|| panic!("{}: {findings:?}", scene.display()));
        let settings = Settings {
            bounces: 4,
            shadows: true,
            shade_back: i % 2 == 0,
            transparent_shadows: i % 3 == 0,
            reflection: true,
            refraction: true,
            least_weight: 0.01,
        };
        // The scenes that paths were made for, and some others.
        let paths = text.contains("PrincipledMaterial") || i % 5 == 0;
        let method = if paths { Method::PATH } else { Method::Whitted };
        let job = Job { width: 20, height: 18, seed: 5, settings, method, ..Job::default() };
        let differences = check::check(&world, &job, 6, i as u64).unwrap();
        assert!(differences.is_empty(), "{}: {differences:?}", scene.display());
    }
}
