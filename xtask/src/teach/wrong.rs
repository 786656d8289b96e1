//! Wrong pictures for testing `durer compare`: scenes that the judge's tracer renders with
//! mistakes.

mod more;

use super::scene::{Light, Material, Object, Scene, Shape, Transform, Year};
use super::vector::Vec3;

/// A wrong picture: index of its scene, and the mistakes it is rendered with.
pub struct Case {
    pub scene: usize,
    pub mistakes: Vec<&'static str>,
}

const SUN: Light = Light::Directional(Vec3(-1.0, -2.0, -1.5), Vec3(0.7, 0.7, 0.6));

fn bulb(at: Vec3, color: Vec3, fade: Vec3) -> Light {
    Light::Point(at, color, fade)
}

fn matt(kd: Vec3) -> Material {
    Material { kd, shininess: 10.0, index: 0.0, ..Material::default() }
}

fn glossy(kd: Vec3, ks: Vec3, shininess: f64) -> Material {
    Material { ks, shininess, ..matt(kd) }
}

fn sphere(c: Vec3, r: f64, material: usize) -> Object {
    Object { shape: Shape::Sphere(c, r), ops: Vec::new(), material }
}

fn floor(offset: f64, material: usize) -> Object {
    Object { shape: Shape::Plane(Vec3(0.0, 1.0, 0.0), offset), ops: Vec::new(), material }
}

fn moved(object: Object, ops: Vec<Transform>) -> Object {
    Object { ops, ..object }
}

/// Returns an octahedron: eight triangles with vertices on the axes.
fn octahedron(name: &'static str, r: f64) -> Shape {
    let corners =
        vec![Vec3(r, 0., 0.), Vec3(-r, 0., 0.), Vec3(0., r, 0.), Vec3(0., -r, 0.), Vec3(0., 0., r), Vec3(0., 0., -r)];
    let faces = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    Shape::Mesh(name, corners, faces)
}

/// Returns a rotated and stretched mesh next to a sphere on a floor.
fn beside_a_ball(mesh: Shape) -> Vec<Object> {
    let ops =
        vec![Transform::Translate(Vec3(1.2, 0.5, 0.5)), Transform::Y(30.0), Transform::Scale(Vec3(1.0, 1.5, 1.0))];
    vec![sphere(Vec3(-1.4, 0.6, 0.0), 1.0, 0), Object { shape: mesh, ops, material: 1 }, floor(-0.8, 2)]
}

/// Returns the scenes, which are small and have few objects, as in the course. There are scenes for
/// every year with the old grammar.
pub fn scenes() -> Vec<Scene> {
    let old = Scene {
        name: "lamps",
        year: Year::F04,
        size: (120, 120),
        shadows: true,
        bounces: 0,
        eye: Vec3(0.0, 1.5, 9.0),
        look: Vec3(0.0, -0.15, -1.0),
        up: Vec3(0.0, 1.0, 0.0),
        angle: 36.0,
        background: Vec3(0.2, 0.1, 0.6),
        sky: false,
        ambient: Vec3(0.15, 0.15, 0.2),
        lights: vec![SUN, bulb(Vec3(3.0, 4.0, 3.0), Vec3(1.0, 0.9, 0.5), Vec3(1.0, 0.05, 0.03))],
        materials: vec![
            glossy(Vec3(0.8, 0.3, 0.2), Vec3(0.6, 0.6, 0.6), 16.0),
            glossy(Vec3(0.2, 0.5, 0.8), Vec3(0.9, 0.9, 0.5), 40.0),
            matt(Vec3(0.5, 0.6, 0.4)),
        ],
        objects: vec![sphere(Vec3(-1.1, 0.3, 0.0), 1.0, 0), sphere(Vec3(1.2, 0.0, 0.8), 0.8, 1), floor(-0.8, 2)],
    };
    let mirrors = Scene {
        name: "mirrors",
        bounces: 2,
        materials: vec![
            Material { kr: Vec3(0.5, 0.5, 0.6), ..glossy(Vec3(0.4, 0.2, 0.2), Vec3(0.5, 0.5, 0.5), 20.0) },
            Material { kr: Vec3(0.7, 0.6, 0.5), ..matt(Vec3(0.2, 0.2, 0.2)) },
            Material { kr: Vec3(0.3, 0.3, 0.3), ..matt(Vec3(0.5, 0.6, 0.4)) },
        ],
        ..old.clone()
    };
    let glass = Scene {
        name: "glass",
        bounces: 4,
        shadows: false,
        materials: vec![
            Material {
                kr: Vec3(0.1, 0.1, 0.1),
                kt: Vec3(0.8, 0.9, 0.8),
                index: 1.5,
                ..glossy(Vec3(0.05, 0.05, 0.05), Vec3(0.6, 0.6, 0.6), 30.0)
            },
            matt(Vec3(0.9, 0.5, 0.1)),
            matt(Vec3(0.4, 0.5, 0.6)),
            matt(Vec3(0.2, 0.7, 0.3)),
        ],
        objects: vec![
            sphere(Vec3(-0.4, 0.4, 1.5), 1.0, 0),
            sphere(Vec3(1.4, 0.0, -1.0), 0.8, 1),
            sphere(Vec3(-1.8, 0.2, -2.0), 1.0, 3),
            floor(-0.8, 2),
        ],
        ..old.clone()
    };
    let turned = Scene {
        name: "turned",
        shadows: false,
        eye: Vec3(0.0, 0.5, 10.0),
        look: Vec3(0.0, 0.0, -2.0),
        objects: vec![
            moved(
                sphere(Vec3::ZERO, 1.0, 0),
                vec![
                    Transform::Translate(Vec3(-1.3, 0.6, 0.0)),
                    Transform::Z(40.0),
                    Transform::Scale(Vec3(1.6, 0.6, 1.0)),
                ],
            ),
            moved(
                sphere(Vec3(0.2, 0.0, 0.0), 0.9, 1),
                vec![
                    Transform::Translate(Vec3(1.5, -0.4, 0.0)),
                    Transform::Y(25.0),
                    Transform::X(-35.0),
                    Transform::Scale(Vec3(0.5, 1.7, 0.8)),
                ],
            ),
            Object {
                shape: Shape::Triangle([Vec3(-1.0, -1.0, 0.0), Vec3(1.0, -1.0, 0.0), Vec3(0.0, 0.8, 0.5)]),
                ops: vec![
                    Transform::Translate(Vec3(0.0, 0.6, -2.0)),
                    Transform::Z(20.0),
                    Transform::Scale(Vec3(1.8, 1.2, 1.0)),
                ],
                material: 2,
            },
        ],
        ..old.clone()
    };
    let flat = Scene {
        name: "orthographic",
        angle: -6.0,
        eye: Vec3(0.5, 2.0, 6.0),
        look: Vec3(-0.3, -0.8, -2.0),
        shadows: false,
        lights: vec![
            Light::Directional(Vec3(-0.5, -1.0, -0.7), Vec3(0.8, 0.8, 0.8)),
            Light::Directional(Vec3(1.0, -0.3, -0.4), Vec3(0.2, 0.3, 0.4)),
        ],
        ..old.clone()
    };
    let phong = Scene {
        name: "phong",
        year: Year::F12a4,
        shadows: false,
        lights: vec![
            bulb(Vec3(3.0, 4.0, 5.0), Vec3(0.7, 0.6, 0.6), Vec3(1.0, 0.0, 0.0)),
            Light::Directional(Vec3(1.0, -0.5, -0.8), Vec3(0.3, 0.4, 0.3)),
        ],
        objects: beside_a_ball(octahedron("octahedron.obj", 1.0)),
        ..old.clone()
    };
    let falling = Scene {
        name: "falloff",
        year: Year::F16,
        bounces: 2,
        lights: vec![
            bulb(Vec3(2.0, 4.0, 3.0), Vec3(1.0, 1.0, 0.9), Vec3(0.0, 0.0, 0.06)),
            bulb(Vec3(-4.0, 3.0, 4.0), Vec3(0.4, 0.5, 0.7), Vec3(0.0, 0.0, 0.04)),
        ],
        up: Vec3(0.2, 1.0, 0.0),
        ..old.clone()
    };
    let fresnel = Scene {
        name: "fresnel",
        year: Year::F12a5,
        bounces: 4,
        lights: vec![bulb(Vec3(3.0, 5.0, 4.0), Vec3(1.5, 1.4, 1.2), Vec3(1.0, 0.0, 0.02))],
        materials: vec![
            Material { ks: Vec3(0.9, 0.9, 0.9), index: 1.5, ..matt(Vec3(0.05, 0.05, 0.1)) },
            Material { ks: Vec3(0.4, 0.4, 0.4), ..matt(Vec3(0.6, 0.3, 0.2)) },
            matt(Vec3(0.5, 0.6, 0.4)),
        ],
        ..old.clone()
    };
    let ours = Scene { name: "ours", year: Year::Durer, bounces: 3, ..mirrors.clone() };
    let wide =
        Scene { name: "wide", size: (160, 100), look: Vec3(0.3, -0.2, -1.3), up: Vec3(0.3, 1.0, 0.1), ..old.clone() };
    let facets =
        Scene { name: "facets", shadows: false, objects: beside_a_ball(octahedron("facets.obj", 1.0)), ..old.clone() };
    let cubes = Scene { name: "cubes", year: Year::F12a5, bounces: 1, ..facets.clone() };
    let more = more::scenes(&old);
    let mut all = vec![old, mirrors, glass, turned, flat, phong, falling, fresnel, ours, wide, facets, cubes];
    all.extend(more);
    all
}

/// Mistakes that are made alone, for each scene.
const SINGLE: [&[&str]; 12] = [
    &[
        "no-ambient",
        "ambient-each-light",
        "ambient-bare",
        "no-diffuse",
        "no-cosine",
        "two-sided",
        "not-clamped-below",
        "no-highlights",
        "exponent-doubled",
        "exponent-halved",
        "exponent-3",
        "exponent-one",
        "other-model",
        "highlight-cosine",
        "highlight-diffuse",
        "highlight-bare",
        "half-sum",
        "half-mean",
        "light-missing",
        "last-light-only",
        "white-lights",
        "light-negated",
        "light-long",
        "point-light-long",
        "no-falloff",
        "falloff-1-over-d",
        "falloff-1-over-d2",
        "falloff-multiplied",
        "no-shadows",
        "shadows-endless",
        "shadows-ambient",
        "shadows-epsilon",
        "clamped-each-light",
        "pixel-corner",
        "border-pixels",
        "angle-not-halved",
        "angle-ignored",
        "direction-not-unit",
        "right-not-unit",
        "epsilon-0",
        "plane-negated",
        "farthest-object",
        "last-written",
        "mirrored",
        "upside-down",
        "bgr",
        "curve-more",
        "curve-less",
    ],
    &[
        "no-reflection",
        "bounce-less",
        "bounce-more",
        "mirror-in-full",
        "mirror-negated",
        "mirror-along",
        "secondary-each-light",
        "secondary-black-sky",
        "clamped-before-bounces",
        "clamped-each-light",
        "wrapped",
        "scaled-to-maximum",
        "no-shadows",
        "epsilon-large",
        "exponent-doubled",
        "highlight-cosine",
        "no-ambient",
        "last-hit",
    ],
    &[
        "no-refraction",
        "index-inverted",
        "exit-not-swapped",
        "not-bent",
        "glass-in-full",
        "bounce-less",
        "bounce-more",
        "shadows-added",
        "no-reflection",
        "mirror-negated",
        "secondary-black-sky",
        "center-ignored",
        "exponent-halved",
    ],
    &[
        "normals-local",
        "normals-moved",
        "normals-long",
        "local-direction-unit",
        "matrices-reversed",
        "rotation-radians",
        "rotation-negated",
        "transforms-ignored",
        "triangles-turned",
        "direction-not-unit",
        "two-sided",
        "normals-faced",
        "border-pixels",
        "point-light-long",
    ],
    &[
        "size-doubled",
        "pixel-corner",
        "border-pixels",
        "up-not-orthogonal",
        "light-negated",
        "light-long",
        "no-ambient",
        "hits-behind",
        "transposed",
    ],
    &[
        "normals-flat",
        "normals-mixed-long",
        "other-model",
        "normals-local",
        "exponent-doubled",
        "exponent-3",
        "border-pixels",
        "light-missing",
        "local-direction-unit",
        "no-highlights",
        "highlight-cosine",
        "rotation-negated",
        "matrices-reversed",
        "two-sided",
    ],
    &[
        "no-falloff",
        "falloff-1-over-d",
        "falloff-1-over-d2",
        "falloff-with-one",
        "up-not-orthogonal",
        "no-shadows",
        "bounce-less",
        "bounce-more",
        "mirror-in-full",
        "last-light-only",
        "border-pixels",
        "half-sum",
        "shadows-endless",
    ],
    &[
        "fresnel-constant",
        "no-fresnel",
        "highlights-added",
        "no-refraction",
        "no-reflection",
        "index-inverted",
        "exit-not-swapped",
        "not-bent",
        "bounce-less",
        "no-falloff",
        "falloff-linear",
        "bounce-more",
    ],
    &[
        "no-ambient",
        "exponent-doubled",
        "other-model",
        "no-shadows",
        "mirror-in-full",
        "bounce-less",
        "curve-more",
        "curve-less",
        "no-highlights",
        "light-missing",
    ],
    &[
        "stretch",
        "aspect-other-axis",
        "aspect-smaller-side",
        "right-not-unit",
        "up-not-orthogonal",
        "direction-not-unit",
        "angle-not-halved",
        "pixel-corner",
        "mirrored",
        "upside-down",
    ],
    &["normals-smooth", "triangles-turned", "normals-local", "no-highlights", "two-sided"],
    &["normals-smooth", "normals-local", "no-falloff"],
];

/// Further mistakes that are made alone, by index of the scene.
const MORE_SINGLE: [(usize, &[&str]); 8] = [
    (
        0,
        &[
            "sphere-normals",
            "sphere-roots",
            "cosine-of-view",
            "diffuse-twice",
            "greatest-light",
            "exponent-plus-one",
            "point-light-from-eye",
            "shadows-from-eye",
            "shadows-reach",
            "shadows-diffuse",
            "angle-inverted",
            "channels",
        ],
    ),
    (1, &["mirror-normal", "bounce-one", "sphere-normals"]),
    (2, &["refraction-formula", "bounce-one", "mirror-normal"]),
    (
        3,
        &["direction-moved", "rotation-axis", "translation-negated", "scale-inverted", "triangle-test", "backs-culled"],
    ),
    (5, &["highlight-mirror", "mesh-first", "rotation-axis", "translation-negated", "sphere-normals"]),
    (6, &["mirror-normal", "exponent-plus-one", "shadows-from-eye"]),
    (7, &["refraction-formula", "greatest-light", "diffuse-twice"]),
    (10, &["triangle-test", "mesh-first", "scale-inverted", "backs-culled"]),
];

/// Mistakes that the table of the library lacked when the judge was written. Correct answers are
/// their own name, or none.
const UNKNOWN: [&str; 7] = [
    "x-ambient-brighter",
    "x-kd-squared",
    "x-materials-swapped",
    "x-light-turned",
    "x-wider",
    "x-eye-moved",
    "x-second-light-unshadowed",
];

/// Pairs of mistakes, by index of the scene.
const PAIRS: &[(usize, [&str; 2])] = &[
    (0, ["no-ambient", "no-highlights"]),
    (0, ["no-shadows", "exponent-doubled"]),
    (0, ["mirrored", "no-ambient"]),
    (0, ["bgr", "no-highlights"]),
    (0, ["no-falloff", "no-ambient"]),
    (1, ["bounce-less", "no-shadows"]),
    (1, ["no-reflection", "no-ambient"]),
    (2, ["no-reflection", "no-highlights"]),
    (3, ["normals-local", "no-ambient"]),
    (3, ["matrices-reversed", "no-highlights"]),
    (5, ["normals-flat", "no-ambient"]),
    (6, ["no-falloff", "no-shadows"]),
    (7, ["no-fresnel", "no-falloff"]),
    (8, ["no-shadows", "no-highlights"]),
];

/// Returns all wrong pictures.
pub fn cases() -> Vec<Case> {
    let alone = SINGLE.iter().enumerate();
    let mut cases: Vec<Case> =
        alone.flat_map(|(scene, names)| names.iter().map(move |name| Case { scene, mistakes: vec![*name] })).collect();
    cases.extend(
        MORE_SINGLE
            .iter()
            .flat_map(|(scene, names)| names.iter().map(|name| Case { scene: *scene, mistakes: vec![*name] })),
    );
    let scenes = scenes();
    let number = |name: &str| scenes.iter().position(|scene| scene.name == name).unwrap_or_default();
    cases.extend(
        more::SINGLE.iter().flat_map(|(scene, names)| {
            names.iter().map(move |name| Case { scene: number(scene), mistakes: vec![*name] })
        }),
    );
    for scene in [0, 1, 5, 6] {
        cases.extend(UNKNOWN.iter().map(|name| Case { scene, mistakes: vec![*name] }));
    }
    cases.extend(PAIRS.iter().map(|(scene, names)| Case { scene: *scene, mistakes: names.to_vec() }));
    cases
}

/// Returns the name in the library's table for a mistake of the judge's tracer.
pub fn description(made: &str) -> &str {
    match made {
        "exponent-doubled" | "exponent-halved" | "exponent-3" => "exponent",
        "size-doubled" => "size",
        // Added to the table later.
        "x-ambient-brighter" => "ambient-factor",
        "x-materials-swapped" => "other-material",
        "x-kd-squared" => "diffuse-twice",
        "x-second-light-unshadowed" => "shadows-of-one-light",
        other => more::description(other).unwrap_or(other),
    }
}
