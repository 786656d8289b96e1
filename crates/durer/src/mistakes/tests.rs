//! The pupil without mistakes, and the table.

use super::table::MISTAKES;
use super::{Diagnosis, Pupil, Question, Variant, diagnose};
use crate::compile::{AccelKind, Resources, compile};
use crate::diag::{Diagnostics, Files};
use crate::dialect::{Dialect, Rules};
use crate::format::course::{self, ReadOptions};
use crate::image::compare::{Picture, Scale};
use crate::image::{Image, Transfer};
use crate::integrator::Whitted;
use crate::lesson::TOPICS;
use crate::render::{Job, Sampling, center_ray};
use crate::scene::Scene;
use crate::source::Source;
use crate::world::World;
use std::collections::BTreeSet;

const SCENE: &str = "PerspectiveCamera { center 0 1 8 direction 0 -0.1 -1 up 0.1 1 0 angle 40 }
Lights { numLights 2 DirectionalLight { direction -1 -2 -1 color 0.7 0.7 0.6 }
  PointLight { position 3 4 3 color 0.6 0.5 0.5 attenuation 1 0.02 0.01 } }
Background { color 0.2 0.1 0.5 ambientLight 0.2 0.2 0.2 }
Materials { numMaterials 3
  Material { diffuseColor 0.8 0.3 0.2 specularColor 0.5 0.5 0.5 exponent 12 }
  Material { diffuseColor 0.2 0.4 0.2 reflectiveColor 0.5 0.5 0.5 }
  Material { diffuseColor 0.1 0.1 0.1 transparentColor 0.8 0.8 0.8 indexOfRefraction 1.5 reflectiveColor 0.2 0.2 0.2 } }
Group { numObjects 4
  MaterialIndex 0 Transform { Translate -1 0.6 0 ZRotate 30 Scale 1.4 0.8 1 Sphere { center 0 0 0 radius 1 } }
  MaterialIndex 2 Sphere { center 1.4 0.6 1 radius 0.9 }
  MaterialIndex 0 Triangle { vertex0 -3 -0.5 -3 vertex1 3 -0.5 -3 vertex2 0 3 -3 }
  MaterialIndex 1 Plane { normal 0 1 0 offset -0.5 } }
";

fn world(rules: &Rules) -> (Scene, World) {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let file = files.add("scene.txt", SCENE.as_bytes().into());
    let options = ReadOptions { dialect: Dialect::Durer, strict: false, compat: 0 };
    let scene = course::read(SCENE.as_bytes(), file, options, &mut diagnostics).unwrap();
    let source = Source::folder(".");
    let resources = Resources { source: &source, files: &mut files, sky_optional: false, memory: u64::MAX };
    let world = compile(&scene, rules, AccelKind::Bvh, resources, &mut diagnostics).unwrap();
    (scene, world)
}

fn job() -> Job {
    let job = Job { width: 48, height: 40, sampling: Sampling::Center, ..Job::default() };
    Job { settings: crate::integrator::Settings { bounces: 3, least_weight: 0.0, ..job.settings }, ..job }
}

/// Whatever year's rules hold, a pupil without mistakes makes the picture that is rendered, to the bit.
#[test]
fn without_mistakes_the_picture_is_right() {
    for dialect in Dialect::ALL {
        for rules in [dialect.rules().clone(), dialect.rules().sane()] {
            let (scene, world) = world(&rules);
            let job = job();
            let variant = Variant::new(&scene, world, job.settings);
            let pupil = Pupil::new(&variant.world, job.settings, &variant.habits);
            let whitted = Whitted { world: &variant.world, settings: job.settings, cancel: None };
            let raster = variant.raster(job.width, job.height);
            for place in job.whole().places() {
                let ray = center_ray(&variant.world, &raster, place).unwrap();
                let (own, right) = (pupil.radiance(&ray), whitted.radiance(&ray, &mut ()));
                // A year's program may divide by zero.
                let same = own == right || own.is_nan() && own.is_nan_mask() == right.is_nan_mask();
                assert!(same, "{} at {place:?}: {own} {right}", dialect.name());
            }
        }
    }
}

#[test]
fn every_row_has_a_name_of_its_own_and_a_step_of_the_lesson() {
    let mut names = BTreeSet::new();
    for mistake in MISTAKES.iter().copied().flatten() {
        assert!(names.insert(mistake.name), "{} is there twice", mistake.name);
        assert!(TOPICS.iter().any(|topic| topic.name == mistake.step), "{}: no step {}", mistake.name, mistake.step);
        assert!(!mistake.words.ends_with('.') && mistake.right != mistake.wrong, "{}", mistake.name);
    }
}

/// The picture of a variant, as eight bits have it.
fn picture(variant: &Variant, job: &Job) -> Picture {
    let raster = variant.raster(job.width, job.height);
    let pupil = Pupil::new(&variant.world, variant.settings, &variant.habits);
    let pixel = |(x, y): (u32, u32)| {
        let middle = crate::math::Vec2::new(x as f32, y as f32) + 0.5;
        let ray = variant.ray(&raster, (x, y), middle, crate::math::Vec2::splat(0.5)).unwrap();
        Transfer::Course.encode_pixel(pupil.radiance(&ray)).map(crate::image::decode_linear).into()
    };
    let pixels = job.whole().places().map(pixel).collect();
    Picture { image: Image::from_pixels(job.width, job.height, pixels).unwrap(), scale: Scale::Display }
}

fn found(names: &[(&str, f32)]) -> Diagnosis {
    let rules = Dialect::F04.rules();
    let (scene, world) = world(rules);
    let job = job();
    let right = Variant::new(&scene, world, job.settings);
    let mut wrong = right.clone();
    for (name, value) in names {
        (super::of_name(name).unwrap().make)(&mut wrong, *value);
    }
    let (reference, test) = (picture(&right, &job), picture(&wrong, &job));
    let transfer = Transfer::Course;
    let question =
        Question { scene: &scene, world: &right.world, job: &job, transfer, reference: &reference, test: &test };
    diagnose(&question, &|_| {})
}

#[test]
fn mistakes_are_named_alone_and_in_pairs() {
    for name in
        ["no-ambient", "no-highlights", "light-negated", "no-shadows", "mirror-negated", "normals-local", "not-bent"]
    {
        let diagnosis = found(&[(name, 0.0)]);
        let named = &diagnosis.named;
        assert!(named.iter().any(|n| n.mistakes.len() == 1 && n.mistakes[0].0.name == name), "{name}: {diagnosis:#?}");
    }
    let diagnosis = found(&[("exponent", 3.0)]);
    let (mistake, value) = diagnosis.named[0].mistakes[0];
    assert!(mistake.name == "exponent" && (value - 3.0).abs() < 0.1, "{diagnosis:?}");
    let diagnosis = found(&[("no-shadows", 0.0), ("no-ambient", 0.0)]);
    let names: BTreeSet<&str> = diagnosis.named[0].mistakes.iter().map(|m| m.0.name).collect();
    assert_eq!(names, BTreeSet::from(["no-ambient", "no-shadows"]));
}

/// A picture of something else is no mistake of this scene, and a reference of something else is said to be so.
#[test]
fn what_is_no_mistake_is_not_named() {
    let (scene, world) = world(Dialect::F04.rules());
    let job = job();
    let right = Variant::new(&scene, world, job.settings);
    let reference = picture(&right, &job);
    let mut other = reference.clone();
    for (i, pixel) in other.image.pixels.iter_mut().enumerate() {
        *pixel = crate::math::Vec3::splat((i * 7919 % 251) as f32 / 255.0);
    }
    let ask = |reference: &Picture, test: &Picture| {
        let transfer = Transfer::Course;
        diagnose(&Question { scene: &scene, world: &right.world, job: &job, transfer, reference, test }, &|_| {})
    };
    let diagnosis = ask(&reference, &other);
    assert!(diagnosis.is_of_scene() && diagnosis.named.is_empty(), "{:?}", diagnosis.named);
    let diagnosis = ask(&other, &reference);
    assert!(!diagnosis.is_of_scene() && diagnosis.named.is_empty());
}
