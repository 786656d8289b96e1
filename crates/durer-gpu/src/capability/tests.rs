use super::*;
use durer_render::compile::{AccelKind, testing};
use durer_render::integrator::{AoParameters, PathOptions, PhotonParameters, RenderSettings};
use durer_render::render::{Job, Sampling};
use durer_render::world::World;
use durer_scene::dialect::Dialect;
use durer_scene::spectrum::ColorMode;
use std::path::Path;

fn world(materials: &str, rest: &str) -> World {
    let text = format!(
        "PerspectiveCamera {{ center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }} Materials {{ {materials} }} {rest}"
    );
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let (world, findings) = testing::try_read(&text, Dialect::Durer.rules(), AccelKind::Bvh, &folder);
    world.unwrap_or_else(|| panic!("{findings:?}"))
}

fn whitted() -> Job {
    Job::default()
}

fn path() -> Job {
    Job { method: IntegratorKind::PATH, ..Job::default() }
}

#[test]
fn unsupported_features_are_refused_by_name() {
    let sphere = "Group { MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }";
    let plain = "PhongMaterial { diffuseColor 1 1 1 }";
    let none: &[Feature] = &[];
    let torus = "Group { MaterialIndex 0 Torus { center 0 0 0 majorRadius 1 minorRadius 0.2 } }";
    let two = "PhongMaterial { diffuseColor 1 1 1 } PhongMaterial { diffuseColor 0 0 0 }";
    let wood = &format!("{two} Wood {{ materialIndex 0 materialIndex 1 octaves 2 frequency 1 amplitude 1 }}");
    for (materials, rest, of_whitted, of_path) in [
        (plain, sphere, none, none),
        (plain, torus, &[Feature::Tori], &[Feature::Tori]),
        (
            plain,
            "Group { MaterialIndex 0 Difference { Sphere { center 0 0 0 radius 1 } Sphere { center 1 0 0 radius 1 } } }",
            &[Feature::Solids],
            &[Feature::Solids],
        ),
        (wood, "Group { MaterialIndex 2 Sphere { center 0 0 0 radius 1 } }", none, none),
        ("PrincipledMaterial { baseColor 1 1 1 }", sphere, none, none),
        ("PrincipledMaterial { coatWeight 1 }", sphere, none, &[Feature::Layers]),
        ("PrincipledMaterial { transmissionWeight 1 }", sphere, none, &[Feature::Layers]),
        ("PrincipledMaterial { transmissionWeight 1 specularRoughness 0 }", sphere, none, none),
        ("PrincipledMaterial { baseColor 1 1 1 specularWeight 0 opacity 0.5 }", sphere, none, &[Feature::Cutouts]),
        ("HairMaterial { }", sphere, none, &[Feature::Cutouts, Feature::Hair]),
        (
            "PhongMaterial { transparentColor 1 1 1 indexOfRefraction 1.5 }",
            "Group { MaterialIndex 0 Sphere { center 0 0 8 radius 3 } }",
            &[Feature::EyeInGlass],
            &[Feature::EyeInGlass],
        ),
    ] {
        let world = world(materials, rest);
        let [own, paths] = [whitted(), path()].map(|job| refusals(&world, &job));
        assert_eq!(own, of_whitted, "{materials} {rest}");
        assert!(of_path.iter().all(|feature| paths.contains(feature)), "{materials} {rest}: {paths:?}");
        assert_eq!(of_path.is_empty(), paths.is_empty(), "{materials} {rest}: {paths:?}");
    }
}

#[test]
fn unsupported_jobs_are_refused_by_name() {
    let world = world("", "Group { Sphere { center 0 0 0 radius 1 } }");
    let settings = RenderSettings { bounces: 33, ..Job::default().settings };
    let spectral = PathOptions { color: ColorMode::Spectral, ..PathOptions::default() };
    for (job, feature) in [
        (Job { settings, ..whitted() }, Feature::ManyBounces),
        (Job { method: IntegratorKind::Path(spectral), ..path() }, Feature::Spectral),
        (Job { sampling: Sampling::Course2012 { jitter: true, blur: false }, ..whitted() }, Feature::CourseSampling),
    ] {
        assert_eq!(refusals(&world, &job), [feature]);
    }
    for (method, feature) in [
        (IntegratorKind::Photons(PhotonParameters::default()), Feature::Photons),
        (IntegratorKind::Ao(AoParameters::default()), Feature::AmbientOcclusion),
    ] {
        assert!(refusals(&world, &Job { method, ..whitted() }).contains(&feature));
    }
    assert!(refusals(&world, &Job { settings, ..path() }).is_empty());
}

#[test]
fn sentence_lists_names() {
    assert_eq!(sentence(&[Feature::Tori]), "the GPU cannot render tori yet");
    assert_eq!(sentence(&[Feature::Tori, Feature::Hair]), "the GPU cannot render tori or hair yet");
    let three = [Feature::Tori, Feature::Hair, Feature::Textures];
    assert_eq!(sentence(&three), "the GPU cannot render tori, hair or textures yet");
}

#[test]
fn documentation_contains_the_table() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/gpu.md");
    let text = std::fs::read_to_string(file).unwrap();
    assert!(text.contains(&markdown()), "docs/gpu.md must contain:\n{}", markdown());
}
