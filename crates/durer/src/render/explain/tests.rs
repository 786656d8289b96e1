//! Explanations against the pictures that they explain.

use super::*;
use crate::compile::{AccelKind, testing};
use crate::dialect::Dialect;
use crate::film::Filter;
use crate::integrator::Settings;
use crate::math::random::Random;
use crate::render::{Control, render};
use std::path::Path;

#[track_caller]
fn adds_up(node: &Node) {
    assert_eq!(node.sum(), node.value, "{node:?}");
    node.terms.iter().for_each(adds_up);
}

#[test]
fn explanations_sum_to_the_pixels_of_all_our_scenes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut scenes: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    scenes.retain(|path| path.extension().is_some_and(|extension| extension == "txt"));
    scenes.sort();
    assert!(scenes.len() > 12);
    let mut random = Random(3);
    for (i, scene) in scenes.iter().enumerate() {
        let text = std::fs::read_to_string(scene).unwrap();
        let dialect = [Dialect::Durer, Dialect::F12a4, Dialect::F04, Dialect::F12a5][i % 4];
        let (world, findings) = testing::try_read(&text, dialect.rules(), AccelKind::Bvh, &folder);
        let world = world.unwrap_or_else(|| panic!("{}: {findings:?}", scene.display()));
        let filtered = Sampling::Filtered { samples: 3, filter: Filter::default() };
        for sampling in [Sampling::Center, filtered] {
            let job = Job {
                width: 24,
                height: 20,
                seed: 5,
                sampling,
                settings: Settings {
                    bounces: 4,
                    shadows: true,
                    shade_back: i % 2 == 0,
                    transparent_shadows: i % 3 == 0,
                    reflection: true,
                    refraction: true,
                    least_weight: 0.01,
                },
                ..Job::default()
            };
            let picture = render(&world, &job, &Control::default()).unwrap();
            for _ in 0..25 {
                let (x, y) = (random.below(24) as u32, random.below(20) as u32);
                let explanation = explain(&world, &job, x, y).unwrap();
                let stored = picture.layers[0].image.get(x, y).unwrap();
                let bits = |color: Color| (color + Vec3::ZERO).to_array().map(f32::to_bits);
                assert_eq!(bits(explanation.color), bits(stored), "{} {x},{y}", scene.display());
                assert_eq!(explanation.sum(), (explanation.color, explanation.coverage));
                explanation.samples.iter().filter_map(|sample| sample.light.as_ref()).for_each(adds_up);
            }
        }
    }
}
