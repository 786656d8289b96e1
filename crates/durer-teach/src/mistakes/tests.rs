//! Tests the student's tracer without mistakes, and the table of mistakes.

use super::pictures::View;
use super::table::MISTAKES;
use super::{BuggyTracer, Diagnosis, DiagnosisInput, SceneVariant, diagnose};
use crate::lesson::TOPICS;
use durer_diag::{Diagnostics, Files};
use durer_formats::Decoder;
use durer_formats::course::{self, ReadOptions};
use durer_formats::folder::FolderSource;
use durer_image::compare::{Picture, Scale};
use durer_image::{Image, Transfer};
use durer_render::compile::{AccelKind, Resources, compile};
use durer_render::integrator::Whitted;
use durer_render::render::{Job, Sampling, center_ray};
use durer_render::world::World;
use durer_scene::dialect::{Dialect, DialectRules};
use durer_scene::scene::Scene;
use std::collections::BTreeSet;
use std::path::Path;

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

fn world(rules: &DialectRules) -> (Scene, World) {
    world_of(SCENE, rules)
}

fn world_of(text: &str, rules: &DialectRules) -> (Scene, World) {
    world_in(Path::new("."), text, rules)
}

/// Compiles a scene whose files are in a folder.
pub(super) fn world_in(folder: &Path, text: &str, rules: &DialectRules) -> (Scene, World) {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let file = files.add("scene.txt", text.as_bytes().into());
    let options = ReadOptions { dialect: Dialect::Durer, strict: false, compat: 0 };
    let scene = course::read(text.as_bytes(), file, options, &mut diagnostics).unwrap();
    let source = FolderSource::new(folder);
    let resources = Resources::new(&source, &Decoder, &mut files);
    let world = compile(&scene, rules, AccelKind::Bvh, resources, &mut diagnostics).unwrap();
    (scene, world)
}

fn job() -> Job {
    let job = Job { width: 48, height: 40, sampling: Sampling::Center, ..Job::default() };
    Job { settings: durer_render::integrator::RenderSettings { bounces: 3, min_weight: 0.0, ..job.settings }, ..job }
}

/// Without mistakes, the student's tracer reproduces the rendered picture bit for bit in every
/// dialect.
#[test]
fn variant_without_mistakes_renders_the_correct_picture() {
    for dialect in Dialect::ALL {
        for rules in [dialect.rules().clone(), dialect.rules().without_quirks()] {
            let (scene, world) = world(&rules);
            let job = job();
            let variant = SceneVariant::new(&scene, world, job.settings);
            let tracer = BuggyTracer::new(&variant.world, job.settings, &variant.bugs);
            let whitted = Whitted { world: &variant.world, settings: job.settings, cancel: None };
            let raster = variant.raster(job.width, job.height);
            for place in job.whole().pixel_positions() {
                let ray = center_ray(&variant.world, &raster, place).unwrap();
                let (own, right) = (tracer.radiance(&ray), whitted.radiance(&ray, &mut ()));
                // The official program of a year may divide by zero.
                let same = own == right || own.is_nan() && own.is_nan_mask() == right.is_nan_mask();
                assert!(same, "{} at {place:?}: {own} {right}", dialect.name());
            }
        }
    }
}

#[test]
fn every_row_has_a_unique_name_and_a_lesson_step() {
    let mut names = BTreeSet::new();
    for mistake in MISTAKES.iter().copied().flatten() {
        assert!(names.insert(mistake.name), "{} exists twice", mistake.name);
        assert!(TOPICS.iter().any(|topic| topic.name == mistake.step), "{}: no step {}", mistake.name, mistake.step);
        assert!(!mistake.description.ends_with('.') && mistake.right != mistake.wrong, "{}", mistake.name);
    }
}

/// Renders the eight-bit picture of a variant, and also returns its brightest value.
fn picture(variant: &SceneVariant, job: &Job, max_value: f32) -> (Picture, f32) {
    let places: Vec<(u32, u32)> = job.whole().pixel_positions().collect();
    let view = View { job, scale: Scale::Display, transfer: Transfer::Course, max_value };
    let max_value = view.light(variant, &places).iter().map(|light| light.max_element()).fold(0.0, f32::max);
    let image = Image::from_pixels(job.width, job.height, view.picture(variant, &places)).unwrap();
    (Picture { image, scale: Scale::Display }, max_value)
}

fn found(names: &[(&str, f32)]) -> Diagnosis {
    found_in(SCENE, job(), names)
}

fn found_in(text: &str, job: Job, names: &[(&str, f32)]) -> Diagnosis {
    found_with(world_of(text, Dialect::F04.rules()), job, names)
}

fn found_with((scene, world): (Scene, World), job: Job, names: &[(&str, f32)]) -> Diagnosis {
    let right = SceneVariant::new(&scene, world, job.settings);
    let mut wrong = right.clone();
    for (name, value) in names {
        (super::mistake_by_name(name).unwrap().apply)(&mut wrong, *value);
    }
    let (reference, max_value) = picture(&right, &job, 1.0);
    let (test, _) = picture(&wrong, &job, max_value);
    let transfer = Transfer::Course;
    let input =
        DiagnosisInput { scene: &scene, world: &right.world, job: &job, transfer, reference: &reference, test: &test };
    diagnose(&input, &|_| {})
}

#[test]
fn mistakes_are_named_alone_and_in_pairs() {
    for name in
        ["no-ambient", "no-highlights", "light-negated", "no-shadows", "mirror-negated", "normals-local", "not-bent"]
    {
        let diagnosis = found(&[(name, 0.0)]);
        let named = &diagnosis.explanations;
        assert!(named.iter().any(|n| n.mistakes.len() == 1 && n.mistakes[0].0.name == name), "{name}: {diagnosis:#?}");
    }
    let diagnosis = found(&[("exponent", 3.0)]);
    let (mistake, value) = diagnosis.explanations[0].mistakes[0];
    assert!(mistake.name == "exponent" && (value - 3.0).abs() < 0.1, "{diagnosis:?}");
    let diagnosis = found(&[("no-shadows", 0.0), ("no-ambient", 0.0)]);
    let names: BTreeSet<&str> = diagnosis.explanations[0].mistakes.iter().map(|m| m.0.name).collect();
    assert_eq!(names, BTreeSet::from(["no-ambient", "no-shadows"]));
}

/// The most common mistakes, each with its value.
const COMMON: [(&str, f32); 49] = [
    ("no-ambient", 0.0),
    ("no-diffuse", 0.0),
    ("no-highlights", 0.0),
    ("no-shadows", 0.0),
    ("no-reflection", 0.0),
    ("no-refraction", 0.0),
    ("light-missing", 1.0),
    ("exponent", 2.0),
    ("exponent", 0.5),
    ("exponent", 4.0),
    ("other-model", 0.0),
    ("highlight-cosine", 0.0),
    ("highlight-diffuse", 0.0),
    ("half-sum", 0.0),
    ("no-falloff", 0.0),
    ("falloff-1-over-d", 0.0),
    ("falloff-1-over-d2", 0.0),
    ("falloff-multiplied", 0.0),
    ("bounce-less", 0.0),
    ("light-negated", 0.0),
    ("light-long", 0.0),
    ("two-sided", 0.0),
    ("not-clamped-below", 0.0),
    ("ambient-each-light", 0.0),
    ("ambient-bare", 0.0),
    ("clamped-each-light", 0.0),
    ("mirror-in-full", 0.0),
    ("glass-in-full", 0.0),
    ("mirror-negated", 0.0),
    ("index-inverted", 0.0),
    ("exit-not-swapped", 0.0),
    ("not-bent", 0.0),
    ("normals-local", 0.0),
    ("normals-moved", 0.0),
    ("normals-long", 0.0),
    ("local-direction-unit", 0.0),
    ("matrices-reversed", 0.0),
    ("rotation-radians", 0.0),
    ("rotation-negated", 0.0),
    ("angle-not-halved", 0.0),
    ("up-not-orthogonal", 0.0),
    ("farthest-object", 0.0),
    ("plane-negated", 0.0),
    ("hits-behind", 0.0),
    ("pixel-corner", 0.0),
    ("mirrored", 0.0),
    ("upside-down", 0.0),
    ("bgr", 0.0),
    ("wrapped", 0.0),
];

/// Returns the explanations of a mistake if none of them is the mistake alone.
fn unnamed(text: &str, job: Job, name: &str, value: f32) -> Option<String> {
    unnamed_in(world_of(text, Dialect::F04.rules()), job, name, value)
}

fn unnamed_in(world: (Scene, World), job: Job, name: &str, value: f32) -> Option<String> {
    let explanations = found_with(world, job, &[(name, value)]).explanations;
    if explanations.iter().any(|e| e.mistakes.len() == 1 && e.mistakes[0].0.name == name) {
        return None;
    }
    let names: Vec<Vec<_>> =
        explanations.iter().map(|e| e.mistakes.iter().map(|m| (m.0.name, m.1)).collect()).collect();
    Some(format!("{name} {value}: {names:?}"))
}

#[test]
fn each_usual_mistake_is_named() {
    let mut wrong = Vec::new();
    let mut judge = |text: &str, job, name, value| wrong.extend(unnamed(text, job, name, value));
    // Make the scene so bright that values are clamped, with little glass, so that every term is
    // visible.
    let bright = SCENE.replace("0.6 0.5 0.5", "1.1 1.0 1.0");
    for (name, value) in COMMON {
        judge(&bright, job(), name, value);
    }
    let ceiling = SCENE.replace("numObjects 4", "numObjects 5 MaterialIndex 0 Plane { normal 0 -1 0 offset -5 }");
    judge(&ceiling, job(), "shadows-endless", 0.0);
    let wide = Job { width: 60, height: 36, ..job() };
    judge(SCENE, wide.clone(), "aspect-other-axis", 0.0);
    judge(SCENE, wide, "aspect-smaller-side", 0.0);
    let level = SCENE.replace("PerspectiveCamera", "OrthographicCamera").replace("angle 40", "size 6");
    judge(&level, job(), "size", 2.0);
    judge(SCENE, job(), "scaled-to-maximum", 0.0);
    judge(SCENE, job(), "other-rounding", 0.0);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Other mistakes that are common in this course.
const ALSO_COMMON: [(&str, f32); 21] = [
    ("sphere-normals", 0.0),
    ("sphere-roots", 0.0),
    ("triangle-test", 1.0),
    ("direction-moved", 0.0),
    ("rotation-axis", 1.0),
    ("translation-negated", 0.0),
    ("scale-inverted", 0.0),
    ("cosine-of-view", 0.0),
    ("diffuse-twice", 0.0),
    ("greatest-light", 0.0),
    ("exponent-plus-one", 0.0),
    ("point-light-from-eye", 0.0),
    ("shadows-from-eye", 0.0),
    ("shadows-diffuse", 0.0),
    ("shadows-reach", 0.0),
    ("mirror-normal", 0.0),
    ("refraction-formula", 0.0),
    ("refraction-formula", 2.0),
    ("bounce-one", 0.0),
    ("angle-inverted", 0.0),
    ("channels", 2.0),
];

#[test]
fn each_further_mistake_is_named() {
    let bright = SCENE.replace("0.6 0.5 0.5", "1.1 1.0 1.0");
    let mut wrong = Vec::new();
    let mut judge = |text: &str, name, value| wrong.extend(unnamed(text, job(), name, value));
    for (name, value) in ALSO_COMMON {
        judge(&bright, name, value);
    }
    // The third side of the triangle is visible only if the triangle points downwards.
    let hanging =
        bright.replace("-3 -0.5 -3 vertex1 3 -0.5 -3 vertex2 0 3 -3", "-3 3 -3 vertex1 3 3 -3 vertex2 0 1 -3");
    judge(&hanging, "triangle-test", 2.0);
    judge(&bright.replace("ZRotate", "XRotate"), "rotation-axis", 0.0);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A scene with patterns and a prism, whose materials are followed by the patterns that mix them.
const PATTERNS: &str = "PerspectiveCamera { center 0 1 8 direction 0 -0.1 -1 up 0 1 0 angle 40 }
Lights { DirectionalLight { direction -1 -2 -1 color 0.7 0.7 0.6 } }
Background { color 0.2 0.1 0.5 ambientLight 0.2 0.2 0.2 }
Materials {
  Material { diffuseColor 0.9 0.8 0.3 }
  Material { diffuseColor 0.1 0.2 0.6 }
  Checkerboard { Transform { YRotate 30 Translate 0.3 0.45 0.2 } materialIndex 0 materialIndex 1 }
  Noise { Transform { UniformScale 0.6 } materialIndex 0 materialIndex 1 octaves 3 }
  Marble { Transform { ZRotate 40 UniformScale 0.7 } materialIndex 0 materialIndex 1 octaves 4 frequency 4 amplitude 3 } }
Group {
  MaterialIndex 3 Transform { Translate -1.6 0.6 0 YRotate 40 Sphere { center 0 0 0 radius 1.1 } }
  MaterialIndex 4 Sphere { center 1.4 0.6 1 radius 1.1 }
  MaterialIndex 2 Plane { normal 0 1 0 offset -0.5 } }
";

const PATTERN_MISTAKES: [(&str, f32); 12] = [
    ("pattern-exchanged", 0.0),
    ("pattern-space", 0.0),
    ("pattern-space", 2.0),
    ("checkerboard-truncated", 0.0),
    ("checkerboard-remainder", 0.0),
    ("checkerboard-axes", 1.0),
    ("octaves", 1.0),
    ("octave-weights", 0.0),
    ("octave-weights", 1.0),
    ("noise-share", 1.0),
    ("veins", 3.0),
    ("veins-axis", 1.0),
];

#[test]
fn mistakes_in_patterns_are_named() {
    let wrong: Vec<String> =
        PATTERN_MISTAKES.iter().filter_map(|(name, value)| unnamed(PATTERNS, job(), name, *value)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn mistakes_in_textures_and_the_sky_are_named() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("sky")).unwrap();
    let picture = |seed: u32| {
        let code = |i: u32| (i * 7919 + seed * 104_729) % 61 * 4;
        let pixels: String = (0..5 * 4 * 3).map(|i| format!("{} ", code(i))).collect();
        format!("P3\n5 4\n255\n{pixels}\n")
    };
    std::fs::write(folder.path().join("picture.ppm"), picture(1)).unwrap();
    for (i, face) in (2..).zip(["left", "right", "up", "down", "front", "back"]) {
        std::fs::write(folder.path().join(format!("sky/{face}.ppm")), picture(i)).unwrap();
    }
    let text = "PerspectiveCamera { center 0 1 8 direction 0 0.1 -1 up 0 1 0 angle 70 }
Lights { DirectionalLight { direction -1 -2 -1 color 0.7 0.7 0.6 } }
Background { cubeMap sky ambientLight 0.2 0.2 0.2 }
Materials { Material { texture picture.ppm } Material { diffuseColor 0.1 0.1 0.1 reflectiveColor 0.8 0.8 0.8 } }
Group {
  MaterialIndex 0 Sphere { center -1.6 0.6 3 radius 1.5 }
  MaterialIndex 1 Sphere { center 1.6 0.6 3 radius 1.5 } }
";
    let wrong = [
        ("texture-exchanged", 0.0),
        ("texture-flipped", 0.0),
        ("texture-flipped", 1.0),
        ("texture-nearest", 0.0),
        ("texture-shifted", 0.0),
        ("texture-size", 0.0),
        ("texture-border", 0.0),
        ("texture-bgr", 0.0),
        ("texture-undecoded", 0.0),
        ("sky-direction", 0.0),
        ("sky-direction", 4.0),
        ("sky-faces", 0.0),
        ("sky-mirrored", 0.0),
        ("sky-upside-down", 2.0),
        ("sky-rotated", 5.0),
        ("sky-undivided", 0.0),
        ("sky-nearest", 0.0),
        ("sky-bgr", 0.0),
    ];
    let world = || world_in(folder.path(), text, &Dialect::Durer.rules().without_quirks());
    let wrong: Vec<String> =
        wrong.iter().filter_map(|(name, value)| unnamed_in(world(), job(), name, *value)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn mistakes_in_normals_glass_and_factors_are_named() {
    let mirror = SCENE.replace("diffuseColor 0.8 0.3 0.2", "reflectiveColor 0.6 0.6 0.6 diffuseColor 0.8 0.3 0.2");
    let bright = SCENE.replace("0.6 0.5 0.5", "1.1 1.0 1.0");
    let mut wrong = Vec::new();
    let mut judge = |text: &str, name, value| wrong.extend(unnamed(text, job(), name, value));
    for value in [0.0, 1.0] {
        judge(&mirror, "normals-inverse", value);
        judge(&mirror, "normals-transposed", value);
    }
    judge(&bright, "normals-long", 1.0);
    judge(&bright, "falloff-of-one-term", 0.0);
    judge(&bright, "falloff-of-one-term", 1.0);
    judge(&bright, "border-of-one-axis", 0.0);
    judge(&bright, "pixel-center-over-n-less-one", 0.0);
    judge(&bright, "glass-in-front", 0.0);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // A number is reported as the roundest one that fits.
    for (name, value) in [("exponent", 4.0), ("exponent", 3.0)] {
        let diagnosis = found_in(&bright, job(), &[(name, value)]);
        let named = diagnosis.explanations.first().unwrap_or_else(|| panic!("{name} {value} is not named")).mistakes[0];
        assert!(named.0.name == name && named.1 == value, "{name} {value}: {named:?}");
    }
}

/// Mistakes that [`SCENE`] shows if it is bright, has a longer view direction and a coloured mirror
/// with a highlight.
const IN_MIRRORS_AND_TRANSFORMS: [(&str, f32); 24] = [
    ("scale-factors", 0.0),
    ("scale-factors", 1.0),
    ("rotation-axis", 6.0),
    ("sphere-unit-direction", 0.0),
    ("sphere-unit-direction", 1.0),
    ("normals-translated", 0.0),
    ("normals-translated", 1.0),
    ("transforms-inverted", 0.0),
    ("transforms-inverted", 1.0),
    ("triangles-long", 0.0),
    ("direction-not-unit", 1.0),
    ("angle-not-degrees", 0.0),
    ("mirror-multiple", 0.0),
    ("mirror-multiple", 2.0),
    ("mirror-from-eye", 0.0),
    ("mirror-one-channel", 0.0),
    ("secondary-no-ambient", 0.0),
    ("secondary-no-highlights", 0.0),
    ("highlight-from-eye", 0.0),
    ("colors-exchanged", 0.0),
    ("unlit", 0.0),
    ("light-colors-equal", 0.0),
    ("shadows-untransformed", 0.0),
    ("shadows-of-spheres", 0.0),
];

#[test]
fn mistakes_in_mirrors_and_transforms_are_named() {
    let scene = SCENE
        .replace("0.6 0.5 0.5", "1.1 0.8 0.5")
        .replace("direction 0 -0.1 -1", "direction 0 -0.2 -2")
        .replace("reflectiveColor 0.5 0.5 0.5", "specularColor 0.5 0.5 0.5 exponent 20 reflectiveColor 0.7 0.5 0.3");
    let mut wrong = Vec::new();
    let mut judge = |text: &str, job: Job, name, value| wrong.extend(unnamed(text, job, name, value));
    for (name, value) in IN_MIRRORS_AND_TRANSFORMS {
        judge(&scene, job(), name, value);
    }
    judge(&scene, Job { width: 60, height: 36, ..job() }, "aspect-other-axis", 1.0);
    let level = scene.replace("PerspectiveCamera", "OrthographicCamera").replace("angle 40", "size 6");
    judge(&level.replace("center 0 1 8", "center 0 1 0.4"), job(), "parallel-rays-from-center", 0.0);
    judge(&level, job(), "orthographic-as-perspective", 0.0);
    judge(&level, job(), "hits-behind", 2.0);
    // A ray that enters a prism through a side leaves it only after total reflection.
    let prism = scene.replace(
        "MaterialIndex 2 Sphere { center 1.4 0.6 1 radius 0.9 }",
        "MaterialIndex 2 Transform { Translate 1.4 0.6 1 YRotate 35 XRotate 20 Scale 1.5 1.5 1.5 Sphere { center 0 0 0 radius \
         0.6 } }",
    );
    for value in [5.0, 6.0, 8.0] {
        let others = unnamed(&prism, job(), "total-reflection", value);
        assert!(others.is_none_or(|others| others.contains("[]")), "total reflection {value}");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Spheres with other radii than 1, of which one is a mirror and one is glass.
const SPHERES: &str = "PerspectiveCamera { center 0 1.5 9 direction 0 -0.15 -1 up 0 1 0 angle 36 }
Lights { DirectionalLight { direction 0.5 -1 -0.4 color 0.6 0.55 0.5 }
  PointLight { position -3 3 3 color 2 2.4 3 attenuation 0.2 0.1 0.1 } }
Background { color 0.2 0.3 0.5 ambientLight 0.15 0.15 0.1 }
Materials {
  Material { diffuseColor 0.8 0.25 0.1 specularColor 0.4 0.5 0.4 exponent 20 }
  Material { diffuseColor 0.15 0.15 0.2 specularColor 0.6 0.6 0.6 exponent 60 reflectiveColor 0.6 0.65 0.5 }
  Material { diffuseColor 0.2 0.3 0.2 transparentColor 0.7 0.8 0.7 indexOfRefraction 1.4 reflectiveColor 0.1 0.1 0.1 }
  Material { diffuseColor 0.6 0.65 0.5 } }
Group {
  MaterialIndex 0 Sphere { center -1.3 0.2 0 radius 1.2 }
  MaterialIndex 1 Sphere { center 1.2 -0.2 0.4 radius 0.8 }
  MaterialIndex 2 Sphere { center 0.1 -0.3 2 radius 0.6 }
  MaterialIndex 3 Plane { normal 0 1 0 offset -1 } }
";

const AMONG_SPHERES: [(&str, f32); 19] = [
    ("radius-not-squared", 0.0),
    ("radius-not-squared", 1.0),
    ("radius-not-squared", 2.0),
    ("sphere-normals", 1.0),
    ("sphere-normals", 2.0),
    ("mirror-along", 0.0),
    ("mirror-along", 1.0),
    ("mirror-start", 0.3),
    ("mirror-start", 0.25),
    ("mirror-mixed", 0.0),
    ("glass-mixed", 0.0),
    ("glass-mixed", 1.0),
    ("falloff-of-other-length", 0.0),
    ("falloff-of-other-length", 1.0),
    ("highlight-along-axis", 0.0),
    ("ambient-sky", 0.0),
    ("shadows-of-one-object", 0.0),
    ("epsilon-large", 0.35),
    ("epsilon-large", 0.5),
];

#[test]
fn mistakes_among_spheres_are_named() {
    let large = || Job { width: 96, height: 96, ..job() };
    let wrong: Vec<String> =
        AMONG_SPHERES.iter().filter_map(|(name, value)| unnamed(SPHERES, large(), name, *value)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Shadow rays hit the surface that they leave, but mirrored rays do not. A mirror and what it
/// shows then have different specks.
#[test]
fn acne_is_recognised_in_mirrors() {
    let (scene, world) = world_of(SPHERES, Dialect::F04.rules());
    let job = Job { width: 96, height: 96, ..job() };
    let right = SceneVariant::new(&scene, world, job.settings);
    let blocked = |first: u32, later: u32| {
        let mut variant = right.clone();
        variant.bugs.shadows.blocked_lights = [first, later];
        picture(&variant, &job, 1.0).0
    };
    let pictures: Vec<Picture> = (0..16).map(|sets| blocked(sets / 4, sets % 4)).collect();
    let reference = &pictures[0];
    let mut test = reference.clone();
    for (i, pixel) in test.image.pixels.iter_mut().enumerate() {
        // Specks without any pattern, in half of the pixels.
        let mixed = (i as u32).wrapping_mul(0x9e37_79b9);
        let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x85eb_ca6b) >> 16;
        if mixed % 32 < 16 {
            *pixel = pictures[mixed as usize % 16].image.pixels[i];
        }
    }
    let transfer = Transfer::Course;
    let input = DiagnosisInput { scene: &scene, world: &right.world, job: &job, transfer, reference, test: &test };
    let diagnosis = diagnose(&input, &|_| {});
    assert_eq!(
        diagnosis.explanations.first().map(|first| first.mistakes[0].0.name),
        Some("epsilon-0"),
        "{diagnosis:?}"
    );
}

/// The official program of 2016 counts a hit at the start of a ray, so each hit would follow
/// itself.
#[test]
fn all_hits_along_a_ray_are_few_in_every_dialect() {
    for dialect in Dialect::ALL {
        let (scene, world) = world(dialect.rules());
        let job = job();
        let variant = SceneVariant::new(&scene, world, job.settings);
        let raster = variant.raster(job.width, job.height);
        for place in job.whole().pixel_positions() {
            let ray = center_ray(&variant.world, &raster, place).unwrap();
            assert!(variant.world.all_hits(&ray).take(20).count() < 20, "{} at {place:?}", dialect.name());
        }
    }
}

/// Pixels at edges can differ by rounding, and a mistake is not to blame.
#[test]
fn few_pixels_at_edges_are_no_mistake() {
    let (scene, world) = world(Dialect::F04.rules());
    let job = job();
    let right = SceneVariant::new(&scene, world, job.settings);
    let mut aside = right.clone();
    aside.camera_bugs.sample_position += 0.0035;
    let ((reference, _), (test, _)) = (picture(&right, &job, 1.0), picture(&aside, &job, 1.0));
    let transfer = Transfer::Course;
    let (world, reference, test) = (&right.world, &reference, &test);
    let diagnosis = diagnose(&DiagnosisInput { scene: &scene, world, job: &job, transfer, reference, test }, &|_| {});
    assert!(diagnosis.explanations.is_empty() && diagnosis.nearly.is_none(), "{diagnosis:?}");
}

/// An unrelated picture matches no mistake, and an unrelated reference is reported.
#[test]
fn unrelated_pictures_match_no_mistake() {
    let (scene, world) = world(Dialect::F04.rules());
    let job = job();
    let right = SceneVariant::new(&scene, world, job.settings);
    let (reference, _) = picture(&right, &job, 1.0);
    let mut other = reference.clone();
    for (i, pixel) in other.image.pixels.iter_mut().enumerate() {
        *pixel = durer_scene::math::Vec3::splat((i * 7919 % 251) as f32 / 255.0);
    }
    let ask = |reference: &Picture, test: &Picture| {
        let transfer = Transfer::Course;
        diagnose(&DiagnosisInput { scene: &scene, world: &right.world, job: &job, transfer, reference, test }, &|_| {})
    };
    let diagnosis = ask(&reference, &other);
    assert!(diagnosis.reference_matches_scene() && diagnosis.explanations.is_empty(), "{:?}", diagnosis.explanations);
    let diagnosis = ask(&other, &reference);
    assert!(!diagnosis.reference_matches_scene() && diagnosis.explanations.is_empty());
}
