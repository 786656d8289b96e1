//! Tests of the lesson's steps.

use super::*;
use durer::{LoadOptions, load};
use durer_render::compile::AccelKind;
use durer_render::film::Filter;
use durer_render::integrator::{IntegratorKind, PhotonParameters};
use durer_render::render::{Job, Sampling, render};
use durer_scene::dialect::{Dialect, Quirk};
use durer_scene::math::{Ray, Vec3};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn stage(scene: &str, size: u32) -> LessonScene {
    let (mut files, mut findings) = Default::default();
    let options = LoadOptions { accel: AccelKind::Bvh, ..LoadOptions::default() };
    let loaded = load(&root().join("scenes").join(scene), &options, &mut files, &mut findings).unwrap().unwrap();
    let world = loaded.compile(&options, &mut files, &mut findings).unwrap();
    let sampling = Sampling::Filtered { samples: 4, filter: Filter::default() };
    LessonScene::new(loaded.scene, files, world, Job { width: size, height: size, sampling, ..Job::default() })
}

fn lesson(stage: LessonScene) -> Vec<Step> {
    let mut teacher = Teacher::new(stage, Transfer::Srgb);
    TOPICS.iter().flat_map(|topic| teacher.steps(topic, &Control::default()).unwrap()).collect()
}

#[test]
fn built_in_scene_shows_every_topic() {
    let mut ours = LessonScene::built_in((64, 48));
    for topic in TOPICS.iter().filter(|topic| !topic.needs_path_tracing()) {
        let steps = steps(topic, &mut ours, Transfer::Srgb, true, &Control::default()).unwrap();
        // Mirrors show other mirrors, which in turn show mirrors.
        let least = if topic.name == "reflection" { 3 } else { 1 };
        assert!(steps.len() >= least, "{}: {}", topic.name, steps.len());
        assert!(steps.iter().all(|step| step.effect.ends_with('.')));
    }
}

#[test]
fn lesson_ends_with_the_final_picture_and_is_deterministic() {
    let bits = |steps: &[Step]| -> Vec<u32> {
        let pixels = steps.iter().flat_map(|step| &step.after.layer.image.pixels);
        pixels.flat_map(|pixel| pixel.to_array().map(f32::to_bits)).collect()
    };
    let steps = lesson(stage("whitted.txt", 40));
    let whitted = stage("whitted.txt", 40);
    let picture = render(&whitted.world, &whitted.job, &Control::default()).unwrap();
    assert_eq!(steps.last().unwrap().after.layer.image, picture.layers[0].image);
    assert_eq!(bits(&steps), bits(&lesson(whitted)));
    // A step may start with the last picture of an earlier step.
    let specular = steps.iter().find(|step| step.topic.name == "specular").unwrap();
    let diffuse = steps.iter().find(|step| step.topic.name == "diffuse").unwrap();
    assert_eq!(specular.before.as_ref().unwrap().layer, diffuse.after.layer);
}

#[test]
fn built_in_scene_replaces_a_scene_without_the_effect() {
    let ours = |scene: &str| -> Vec<&str> {
        let steps = lesson(stage(scene, 48));
        steps.iter().filter(|step| step.uses_built_in_scene).map(|step| step.topic.name).collect()
    };
    assert_eq!(ours("whitted.txt"), ["transforms"]);
    let transforms = ours("transforms.txt");
    assert!(!transforms.contains(&"transforms") && transforms.contains(&"refraction"), "{transforms:?}");
}

/// Renders the path-tracing steps of a scene as small pictures.
fn of_paths(scene: &str) -> Vec<Step> {
    let mut stage = stage(scene, 40);
    stage.job.method =
        IntegratorKind::Photons(PhotonParameters { count: 20_000, radius: Some(0.1), ..PhotonParameters::default() });
    stage.job.sampling = Sampling::Filtered { samples: 8, filter: Filter::default() };
    let mut teacher = Teacher::new(stage, Transfer::Srgb);
    let topics = TOPICS.iter().filter(|topic| topic.needs_path_tracing());
    topics.flat_map(|topic| teacher.steps(topic, &Control::default()).unwrap()).collect()
}

#[test]
fn path_steps_appear_only_in_scenes_that_show_them() {
    let names = |steps: &[Step]| {
        let mut names: Vec<&str> = steps.iter().map(|step| step.topic.name).collect();
        names.dedup();
        names
    };
    let cornell = of_paths("cornell-box.txt");
    assert_eq!(names(&cornell), ["soft-shadows", "bounces", "mis"]);
    assert!(cornell.iter().all(|step| !step.uses_built_in_scene && step.effect.contains("The noise of the picture")));
    // Each further bounce only adds light.
    let bounces = cornell.iter().filter(|step| step.topic.name == "bounces").map(|step| step.change.as_ref().unwrap());
    assert!(bounces.clone().count() >= 3 && bounces.clone().all(|change| change.lighter == change.changed));
    assert_eq!(names(&of_paths("caustic.txt")), ["soft-shadows", "bounces", "mis", "caustic"]);
    // The sun is a light without a visible extent.
    assert_eq!(names(&of_paths("prism.txt")).last(), Some(&"spectrum"));
    // Whitted's method has no path-tracing steps.
    assert!(lesson(stage("whitted.txt", 24)).iter().all(|step| !step.topic.needs_path_tracing()));
}

#[test]
fn multiple_importance_sampling_has_less_noise_than_either_strategy() {
    let mut plates = stage("plates.txt", 48);
    (plates.job.method, plates.job.sampling) =
        (IntegratorKind::PATH, Sampling::Filtered { samples: 64, filter: Filter::default() });
    let topic = TOPICS.iter().find(|topic| topic.name == "mis").unwrap();
    let noise: Vec<f64> =
        topic.shots.iter().map(|shot| plates.render(shot, &Control::default()).unwrap().noise.unwrap()).collect();
    // With light sampling alone, the error comes from rare bright samples. With so few samples,
    // most of them are missing.
    assert!(noise[2] < 0.95 * noise[0] && noise[2] < 0.5 * noise[1], "{noise:?}");
}

#[test]
fn acne_makes_lit_surfaces_darker() {
    let mut ours = LessonScene::built_in((64, 48));
    let topic = TOPICS.iter().find(|topic| topic.name == "epsilon").unwrap();
    let steps = steps(topic, &mut ours, Transfer::Srgb, true, &Control::default()).unwrap();
    let change = steps[0].change.as_ref().unwrap();
    // Removing acne can only make pixels lighter.
    assert!(change.changed > 100 && change.lighter == change.changed, "{change:?}");
}

/// Compares a sphere's normal transformed by the matrix itself with the normal transformed by the
/// inverse transpose.
#[test]
fn moved_normals_are_transformed_by_the_matrix_itself() {
    let text = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }
        Group { Transform { Scale 2 0.5 1 Sphere { center 0 0 0 radius 1 } } }";
    for (quirk, expected) in [(false, Vec3::new(0.3, 0.8, 0.0)), (true, Vec3::new(1.2, 0.2, 0.0))] {
        let mut rules = Dialect::Durer.rules().clone();
        rules.quirks = if quirk { Quirk::MovedNormals.bit() } else { 0 };
        let folder = Path::new(".");
        let (world, _) = durer_render::compile::testing::try_read(text, &rules, AccelKind::Bvh, folder);
        // The point (0.6, 0.4, z) of the sphere in object space becomes (1.2, 0.2, z) in world
        // space.
        let ray = Ray::new(Vec3::new(1.2, 0.2, 9.0), Vec3::NEG_Z);
        let world = world.unwrap();
        let surface = world.intersect(&ray, &mut ()).unwrap().surface;
        let z = (1.0f32 - 0.36 - 0.16).sqrt();
        let expected = Vec3::new(expected.x, expected.y, z).normalize();
        assert!((surface.n_shade - expected).length() < 1e-6, "{quirk}: {}", surface.n_shade);
        assert!((surface.n_geo - Vec3::new(0.3, 0.8, z).normalize()).length() < 1e-6);
    }
}

/// Places a ball of radius 1 in the centre of the picture, 5 units from the camera. Rays that miss
/// the ball have no distance.
#[test]
fn distances_are_those_of_the_rays_that_hit() {
    let mut stage = stage("whitted.txt", 24);
    let words = |stage: &mut LessonScene| {
        let topic = TOPICS.iter().find(|topic| topic.name == "distance").unwrap();
        let steps = steps(topic, stage, Transfer::Srgb, false, &Control::default()).unwrap();
        steps[0].effect.clone()
    };
    let text = "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 }
        Lights { DirectionalLight { direction 0 -1 -1 color 1 1 1 } }
        Group { Sphere { center 0 0 0 radius 1 } }";
    let folder = Path::new(".");
    let (world, _) = durer_render::compile::testing::try_read(text, Dialect::Durer.rules(), AccelKind::Bvh, folder);
    stage.world = world.unwrap();
    (stage.job.width, stage.job.height) = (100, 100);
    let words = words(&mut stage);
    // The ball covers a circle whose half angle is asin(1/5), which is 24.7 % of the picture.
    assert!(words.starts_with("24.") && words.contains("from 4.00 to 4.8"), "{words}");
}

/// An area light illuminates the Cornell box. The direct light of the Cornell box is path traced,
/// and mirrors are shown in the built-in scene.
#[test]
fn scene_without_whitted_lights_uses_path_tracing() {
    let mut stage = stage("cornell-box.txt", 32);
    stage.job.method = IntegratorKind::PATH;
    stage.job.sampling = Sampling::Filtered { samples: 4, filter: Filter::default() };
    let mut teacher = Teacher::new(stage, Transfer::Srgb);
    let mut of = |name: &str| {
        let topic = TOPICS.iter().find(|topic| topic.name == name).unwrap();
        teacher.steps(topic, &Control::default()).unwrap()
    };
    let diffuse = of("diffuse");
    let most = diffuse[0].after.layer.image.pixels.iter().map(|pixel| pixel.max_element()).fold(0.0, f32::max);
    assert!(!diffuse[0].uses_built_in_scene && most > 0.3, "{most}");
    let mirrors = of("reflection");
    assert!(
        mirrors[0].uses_built_in_scene && mirrors[0].missing_because.contains("Whitted's method does not support"),
        "{}",
        mirrors[0].missing_because
    );
}
