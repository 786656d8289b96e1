//! Tests that explanations match the pictures that they explain.

use super::*;
use crate::compile::{AccelKind, testing};
use crate::integrator::{IntegratorKind, PathOptions, RenderSettings};
use durer_scene::dialect::Dialect;
use durer_scene::spectrum::ColorMode;
use std::path::Path;

#[test]
fn explanations_sum_to_the_pixels_of_all_scenes() {
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
        let settings = RenderSettings {
            bounces: 4,
            shadows: true,
            shade_back: i % 2 == 0,
            transparent_shadows: i % 3 == 0,
            reflection: true,
            refraction: true,
            min_weight: 0.01,
        };
        // Use path tracing for the scenes that are designed for it and for some other scenes.
        let paths = text.contains("PrincipledMaterial") || i % 5 == 0;
        let color = [ColorMode::Rgb, ColorMode::Spectral][i % 2];
        let method = if paths {
            IntegratorKind::Path(PathOptions { color, ..PathOptions::default() })
        } else {
            IntegratorKind::WHITTED
        };
        let job = Job { width: 20, height: 18, seed: 5, settings, method, ..Job::default() };
        let differences = check::check(&world, &job, 6, i as u64).unwrap();
        assert!(differences.is_empty(), "{}: {differences:?}", scene.display());
    }
}

#[test]
fn brightest_sample_below_glass_is_explained_as_a_caustic() {
    // The light is small and above a glass sphere. Below the sphere, paths find its light only by
    // chance.
    let world = testing::read(
        "PerspectiveCamera { center 0 3 5 direction 0 -0.6 -1 up 0 1 0 angle 30 } Background { color 0 0 0 }\n\
         Materials { PrincipledMaterial { baseColor 0.8 0.8 0.8 specularWeight 0 }\n\
         PrincipledMaterial { transmissionWeight 1 specularRoughness 0 specularIor 1.5 }\n\
         PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 2000 } }\n\
         Group { MaterialIndex 0 Plane { normal 0 1 0 offset -1 } MaterialIndex 1 Sphere { center 0 0.5 0 radius 0.6 }\n\
         MaterialIndex 2 Sphere { center 0 4 0 radius 0.1 } }",
    );
    let sampling = Sampling::Filtered { filter: crate::film::Filter::default(), samples: 64 };
    let settings = RenderSettings { bounces: 8, ..Job::default().settings };
    let job = Job { width: 24, height: 24, sampling, settings, method: IntegratorKind::PATH, ..Job::default() };
    let explained = (0..job.height).flat_map(|y| (0..job.width).map(move |x| (x, y)));
    let explained = explained.map(|(x, y)| explain(&world, &job, x, y).unwrap());
    let adds = |pixel: &Explanation| pixel.brightest().map_or(0.0, |(_, adds)| adds);
    let worst = explained.max_by(|a, b| adds(a).total_cmp(&adds(b))).unwrap();
    let causes = worst.firefly();
    assert!(causes.len() >= 3 && causes[0].starts_with("sample "), "{causes:?}");
    assert!(causes.iter().any(|sentence| sentence.contains("--integrator photons")), "{causes:?}");
    // The brightest sample adds no more than the total of the pixel.
    let (number, most) = worst.brightest().unwrap();
    let light = worst.samples[number].light.as_ref().unwrap();
    assert!(most > 0.0 && light.sum().max_element() > 0.0);
}
