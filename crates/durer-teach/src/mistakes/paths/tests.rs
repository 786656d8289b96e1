//! Tests that each mistake of path tracers is named in a scene that shows it.

use super::blocks::Blocks;
use super::search::Search;
use super::table::MISTAKES;
use crate::lesson::TOPICS;
use crate::mistakes::pictures::View;
use crate::mistakes::tests::world_in;
use crate::mistakes::{Diagnosis, DiagnosisInput, SceneVariant};
use durer_image::compare::{Picture, Scale};
use durer_image::{Image, Transfer};
use durer_render::film::Filter;
use durer_render::integrator::{IntegratorKind, PathOptions};
use durer_render::render::{Job, Sampling};
use durer_scene::dialect::Dialect;
use std::collections::BTreeSet;

/// A room with a sphere and two one-sided area lights of different sizes and colours.
const ROOM: &str = "PerspectiveCamera { center 2 1.6 5.8 direction 0 -0.06 -1 up 0 1 0 angle 60 }
Background { color 0 0 0 }
Materials {
  PrincipledMaterial { baseColor 0.7 0.7 0.7 specularWeight 0 }
  PrincipledMaterial { baseColor 0.8 0.2 0.1 specularWeight 0 }
  PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 5 emissionColor 1 0.8 0.6 }
  PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 30 emissionColor 0.5 0.7 1 } }
Group {
  MaterialIndex 0
  Rectangle { corner 0 0 0 edge0 0 0 6 edge1 4 0 0 }
  Rectangle { corner 0 3 0 edge0 4 0 0 edge1 0 0 6 }
  Rectangle { corner 0 0 0 edge0 4 0 0 edge1 0 3 0 }
  MaterialIndex 1
  Rectangle { corner 0 0 0 edge0 0 3 0 edge1 0 0 6 }
  MaterialIndex 0
  Rectangle { corner 4 0 0 edge0 0 0 6 edge1 0 3 0 }
  MaterialIndex 2
  Rectangle { corner 1.4 2.6 2 edge0 1.2 0 0 edge1 0 0 1.2 }
  MaterialIndex 3
  Rectangle { corner 3.9 1 4 edge0 0 0 0.4 edge1 0 0.4 0 }
  MaterialIndex 0
  Sphere { center 1.4 0.6 2 radius 0.6 } }
";

/// A matte sphere and a textured floor under an environment map with one bright side.
const SKY: &str = "PerspectiveCamera { center 0 1.5 6 direction 0 -0.2 -1 up 0 1 0 angle 50 }
Background { environment sky.pfm }
Materials {
  PrincipledMaterial { baseColor 0.8 0.8 0.8 specularWeight 0 }
  PrincipledMaterial { baseColorTexture checks.ppm specularWeight 0 } }
Group {
  MaterialIndex 0 Sphere { center 0 1 0 radius 1 }
  MaterialIndex 1 TriangleMesh { obj_file floor.obj } }
";

/// A point light and a directional light on matte surfaces.
const POINTS: &str = "PerspectiveCamera { center 0 1.5 6 direction 0 -0.2 -1 up 0 1 0 angle 45 }
Background { color 0.1 0.1 0.15 }
Lights { PointLight { position 2 3 2 color 4 3.5 3 attenuation 0 0 1 }
  DirectionalLight { direction 1 -1.5 -0.7 color 0.3 0.35 0.4 } }
Materials { PhongMaterial { diffuseColor 0.7 0.6 0.5 } PhongMaterial { diffuseColor 0.3 0.4 0.7 } }
Group {
  MaterialIndex 0 Rectangle { corner -4 0 -4 edge0 0 0 8 edge1 8 0 0 }
  MaterialIndex 0 Rectangle { corner -4 0 -3 edge0 8 0 0 edge1 0 3 0 }
  MaterialIndex 1 Sphere { center 0 1 0.5 radius 1 } }
";

/// A sphere of glass and a mirror on a floor below an area light.
const GLASS: &str = "PerspectiveCamera { center 0 1.5 6 direction 0 -0.15 -1 up 0 1 0 angle 45 }
Background { color 0.3 0.35 0.4 }
Materials {
  PrincipledMaterial { baseColor 0.7 0.5 0.3 specularWeight 0 }
  PrincipledMaterial { transmissionWeight 1 specularRoughness 0 specularIor 1.5 }
  PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 12 }
  PhongMaterial { diffuseColor 0 0 0 reflectiveColor 0.9 0.6 0.4 } }
Group {
  MaterialIndex 3 Sphere { center -1.6 0.7 1 radius 0.7 }
  MaterialIndex 0 Rectangle { corner -4 0 -4 edge0 0 0 8 edge1 8 0 0 }
  MaterialIndex 0 Rectangle { corner -4 0 -3 edge0 8 0 0 edge1 0 3 0 }
  MaterialIndex 1 Sphere { center 0 1.05 0.5 radius 1 }
  MaterialIndex 2 Rectangle { corner -1 4 -1 edge0 2 0 0 edge1 0 0 2 } }
";

/// Files to which [`SKY`] refers.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    let sky = (0..16 * 8).flat_map(|i| {
        let (x, y) = (i % 16, i / 16);
        let bright = if (2..6).contains(&x) && y > 4 { 3.0 } else { 0.1 + 0.1 * y as f32 };
        [bright, 0.9 * bright, 0.7 * bright].into_iter().flat_map(f32::to_le_bytes)
    });
    let checks = (0..8 * 8).flat_map(|i| if (i % 8 + i / 8) % 2 == 0 { [128, 60, 200] } else { [60, 200, 128] });
    let floor =
        "v -4 0 -4\nv -4 0 4\nv 4 0 4\nv 4 0 -4\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
    vec![
        ("sky.pfm", b"PF\n16 8\n-1.0\n".iter().copied().chain(sky).collect()),
        ("checks.ppm", b"P6\n8 8\n255\n".iter().copied().chain(checks).collect()),
        ("floor.obj", floor.into()),
    ]
}

fn job(bounces: u32) -> Job {
    let sampling = Sampling::Filtered { samples: 64, filter: Filter::Box { radius: 0.5 } };
    let job =
        Job { width: 48, height: 36, sampling, method: IntegratorKind::Path(PathOptions::default()), ..Job::default() };
    Job { settings: durer_render::integrator::RenderSettings { bounces, ..job.settings }, ..job }
}

/// Renders an eight-bit picture of a variant, with a block for each pixel.
fn picture(variant: &SceneVariant, job: &Job, seed: u64) -> Picture {
    let view = View { job, scale: Scale::Display, transfer: Transfer::Srgb, max_value: 1.0 };
    let blocks = Blocks { pixels: job.whole().pixel_positions().map(|pixel| vec![pixel]).collect() };
    let pixels = blocks.render(&view, variant, seed).mean;
    Picture { image: Image::from_pixels(job.width, job.height, pixels).unwrap(), scale: Scale::Display }
}

/// Finds the mistake in pictures of a scene to which `changes` are made.
fn found(text: &str, bounces: u32, changes: &[&dyn Fn(&mut SceneVariant)]) -> Vec<Diagnosis> {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in files() {
        std::fs::write(folder.path().join(name), content).unwrap();
    }
    let (scene, world) = world_in(folder.path(), text, &Dialect::Durer.rules().without_quirks());
    let job = job(bounces);
    let right = SceneVariant::new(&scene, world, job.settings);
    let reference = picture(&right, &job, 77);
    let (world, transfer) = (&right.world, Transfer::Srgb);
    let input = DiagnosisInput { scene: &scene, world, job: &job, transfer, reference: &reference, test: &reference };
    let search = Search::new(&input);
    let candidates = search.candidates(&|_| {});
    let diagnosis = |change: &&dyn Fn(&mut SceneVariant)| {
        let mut wrong = right.clone();
        change(&mut wrong);
        search.diagnose(&picture(&wrong, &job, 78).image.pixels, || candidates.clone())
    };
    changes.iter().map(diagnosis).collect()
}

/// Mistakes that the room does not show, with the scene that shows them, if there is one.
const ELSEWHERE: [(&str, f32, Option<&str>); 22] = [
    ("path-sky", 0.0, Some(SKY)),
    ("path-sky", 1.0, Some(SKY)),
    ("path-sky", 2.0, Some(SKY)),
    ("path-sky", 3.0, Some(SKY)),
    ("path-sky", 4.0, Some(SKY)),
    ("path-texture", 0.0, Some(SKY)),
    ("path-texture-flipped", 0.0, Some(SKY)),
    ("path-cosine", 5.0, Some(POINTS)),
    ("path-light-factor", 6.0, Some(POINTS)),
    ("path-mirror-color", 0.0, Some(GLASS)),
    ("path-emission-after-mirror", 0.0, Some(GLASS)),
    ("path-index", 0.0, Some(GLASS)),
    ("path-fresnel", 0.0, Some(GLASS)),
    ("path-fresnel", 1.0, Some(GLASS)),
    ("path-fresnel", 2.0, Some(GLASS)),
    // It is invisible unless the camera or a light is in the glass.
    ("path-eta-squared", 0.0, None),
    ("path-eta-squared", 1.0, Some(GLASS)),
    ("path-eta-squared", 2.0, Some(GLASS)),
    ("path-refraction", 0.0, Some(GLASS)),
    ("path-refraction", 1.0, Some(GLASS)),
    ("path-refraction", 2.0, Some(GLASS)),
    ("path-refraction", 3.0, Some(GLASS)),
];

/// Mistakes that the noise of these small pictures can hide. They are named correctly or not at
/// all.
const HIDDEN_BY_NOISE: [(&str, f32); 7] = [
    // Reported as a brighter picture of unknown cause.
    ("path-emission-twice", 0.0),
    ("path-uniform", 0.0),
    ("path-two-sided", 0.0),
    ("path-roulette", 1.0),
    ("path-refraction", 1.0),
    ("path-sky", 4.0),
    ("path-fresnel", 2.0),
];

#[test]
fn each_mistake_is_named() {
    let mut wrong = Vec::new();
    for (text, bounces) in [(ROOM, 2), (ROOM, 12), (SKY, 3), (GLASS, 5), (POINTS, 3)] {
        let rows = MISTAKES.iter().flat_map(|row| row.values.numbers(2).into_iter().map(move |value| (row, value)));
        let rows = rows.filter(|(row, value)| {
            let elsewhere = ELSEWHERE.iter().find(|(name, number, _)| *name == row.name && number == value);
            let of_room = if row.name == "path-roulette" { 12 } else { 2 };
            elsewhere.map_or(text == ROOM && bounces == of_room, |(_, _, scene)| *scene == Some(text))
        });
        let rows: Vec<_> = rows.collect();
        let changes: Vec<_> =
            rows.iter().map(|(row, value)| move |v: &mut SceneVariant| (row.apply)(v, *value)).collect();
        let right: &dyn Fn(&mut SceneVariant) = &|_| {};
        let changes: Vec<_> = std::iter::once(right).chain(changes.iter().map(|change| change as _)).collect();
        let mut diagnoses = found(text, bounces, &changes).into_iter();
        // A picture without mistakes differs only in its noise.
        let diagnosis = diagnoses.next().unwrap();
        if !diagnosis.explanations.is_empty() {
            wrong.push(format!("no mistake: {:?}", diagnosis.explanations));
        }
        for ((row, value), diagnosis) in rows.iter().zip(diagnoses) {
            let names: Vec<_> =
                diagnosis.explanations.iter().map(|e| (e.mistakes[0].0.name, e.mistakes[0].1)).collect();
            let hidden = HIDDEN_BY_NOISE.contains(&(row.name, *value)) && names.is_empty();
            if !names.contains(&(row.name, *value)) && !hidden {
                wrong.push(format!("{} {value}: {names:?} {:?}", row.name, diagnosis.remark));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_row_has_a_unique_name_and_a_lesson_step() {
    let mut names = BTreeSet::new();
    for row in MISTAKES {
        assert!(names.insert(row.name), "{} exists twice", row.name);
        assert!(TOPICS.iter().any(|topic| topic.name == row.step), "{}: no step {}", row.name, row.step);
    }
}
