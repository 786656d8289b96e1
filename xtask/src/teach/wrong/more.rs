//! Scenes with textures, a sky, patterns, a prism and a mirror box, and the mistakes that they
//! show.

use super::{bulb, floor, glossy, matt, moved, octahedron, sphere};
use crate::teach::scene::{Material, Object, Pattern, Scene, Shape, Transform, Year};
use crate::teach::vector::Vec3;

/// Returns a box from -1 to 1.
fn cuboid(name: &'static str) -> Shape {
    let corner =
        |i: usize| Vec3((i % 2) as f64 * 2.0 - 1.0, (i / 2 % 2) as f64 * 2.0 - 1.0, (i / 4) as f64 * 2.0 - 1.0);
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Shape::Mesh(name, (0..8).map(corner).collect(), faces)
}

/// Returns a square from -1 to 1 in the plane z = 0.
fn square(name: &'static str) -> Shape {
    let corners = vec![Vec3(-1.0, -1.0, 0.0), Vec3(1.0, -1.0, 0.0), Vec3(1.0, 1.0, 0.0), Vec3(-1.0, 1.0, 0.0)];
    Shape::Mesh(name, corners, vec![[0, 1, 2], [0, 2, 3]])
}

fn pattern(pattern: Pattern, space: &'static [Transform], of: [usize; 2]) -> Material {
    Material { pattern: Some((pattern, space, of)), ..matt(Vec3::ZERO) }
}

/// Returns the scenes, which are variants of one with lights.
pub fn scenes(old: &Scene) -> Vec<Scene> {
    let mirror = Material { kr: Vec3(0.7, 0.7, 0.6), ..matt(Vec3(0.1, 0.1, 0.1)) };
    let picture = Material { textured: true, ..glossy(Vec3(0.6, 0.9, 0.5), Vec3(0.3, 0.3, 0.3), 20.0) };
    let ops =
        vec![Transform::Translate(Vec3(-1.2, 0.5, 0.0)), Transform::Y(25.0), Transform::Scale(Vec3(1.2, 1.2, 1.0))];
    let board = Object { shape: square("board.obj"), ops, material: 0 };
    let textures = Scene {
        name: "textures",
        year: Year::Durer,
        materials: vec![picture, matt(Vec3(0.5, 0.6, 0.4))],
        objects: vec![board, sphere(Vec3(1.3, 0.3, 0.4), 1.0, 0), floor(-0.8, 1)],
        ..old.clone()
    };
    let sky = Scene {
        name: "cube-sky",
        year: Year::Durer,
        sky: true,
        bounces: 2,
        look: Vec3(0.2, 0.05, -1.0),
        angle: 60.0,
        materials: vec![mirror, matt(Vec3(0.5, 0.6, 0.4))],
        objects: vec![sphere(Vec3(-1.4, 1.0, 2.0), 1.2, 0), sphere(Vec3(1.9, 2.2, 1.0), 1.1, 0), floor(-0.8, 1)],
        ..old.clone()
    };
    let patterns = Scene {
        name: "patterns",
        year: Year::Durer,
        materials: vec![
            matt(Vec3(0.9, 0.8, 0.3)),
            matt(Vec3(0.1, 0.2, 0.6)),
            pattern(
                Pattern::Checkerboard,
                &[
                    Transform::Y(30.0),
                    Transform::Translate(Vec3(0.3, 0.45, 0.2)),
                    Transform::Scale(Vec3(1.1, 0.9, 0.8)),
                ],
                [0, 1],
            ),
            pattern(Pattern::Noise(3), &[Transform::Scale(Vec3(0.6, 0.6, 0.6))], [0, 1]),
            pattern(Pattern::Marble(4, 4.0, 3.0), &[Transform::Z(40.0), Transform::Scale(Vec3(0.7, 0.7, 0.7))], [0, 1]),
            pattern(
                Pattern::Wood(2, 9.0, 2.0),
                &[Transform::X(70.0), Transform::Translate(Vec3(0.2, 0.0, 0.1))],
                [0, 1],
            ),
        ],
        objects: vec![
            moved(sphere(Vec3::ZERO, 1.0, 3), vec![Transform::Translate(Vec3(-1.8, 0.3, 0.0)), Transform::Y(50.0)]),
            sphere(Vec3(0.2, 0.6, -0.8), 1.1, 4),
            sphere(Vec3(1.8, 0.0, 0.8), 0.8, 5),
            floor(-0.8, 2),
        ],
        ..old.clone()
    };
    let prism = Scene {
        name: "prism",
        year: Year::Durer,
        bounces: 4,
        shadows: false,
        materials: vec![
            Material { kr: Vec3(0.2, 0.2, 0.2), kt: Vec3(0.8, 0.8, 0.7), index: 1.5, ..matt(Vec3(0.05, 0.05, 0.05)) },
            matt(Vec3(0.9, 0.5, 0.1)),
            matt(Vec3(0.4, 0.5, 0.6)),
        ],
        objects: vec![
            moved(
                Object { shape: octahedron("prism.obj", 1.4), ops: Vec::new(), material: 0 },
                vec![Transform::Translate(Vec3(-0.8, 0.9, 1.0)), Transform::Y(20.0), Transform::Z(10.0)],
            ),
            sphere(Vec3(1.6, 0.0, -1.0), 0.8, 1),
            sphere(Vec3(0.9, 0.1, 2.4), 0.7, 0),
            floor(-0.8, 2),
        ],
        ..old.clone()
    };
    let crystal = Scene {
        name: "crystal",
        year: Year::F12a5,
        lights: vec![bulb(Vec3(3.0, 5.0, 4.0), Vec3(1.5, 1.4, 1.2), Vec3(1.0, 0.0, 0.02))],
        materials: vec![
            Material { ks: Vec3(0.9, 0.9, 0.9), index: 1.5, ..matt(Vec3(0.05, 0.05, 0.1)) },
            Material { ks: Vec3(0.3, 0.3, 0.3), ..matt(Vec3(0.6, 0.3, 0.2)) },
            matt(Vec3(0.5, 0.6, 0.4)),
        ],
        ..prism.clone()
    };
    let mirror_box = Scene {
        name: "mirror-box",
        year: Year::Durer,
        bounces: 2,
        materials: vec![
            Material { kr: Vec3(0.6, 0.6, 0.5), ..matt(Vec3(0.3, 0.2, 0.2)) },
            glossy(Vec3(0.2, 0.5, 0.8), Vec3(0.9, 0.9, 0.5), 40.0),
            matt(Vec3(0.5, 0.6, 0.4)),
        ],
        objects: vec![
            Object {
                shape: cuboid("box.obj"),
                ops: vec![
                    Transform::Translate(Vec3(-0.6, 0.2, 0.0)),
                    Transform::Y(35.0),
                    Transform::X(25.0),
                    Transform::Scale(Vec3(1.0, 0.9, 0.9)),
                ],
                material: 0,
            },
            sphere(Vec3(1.6, 0.0, 1.4), 0.8, 1),
            floor(-0.8, 2),
        ],
        ..old.clone()
    };
    let lens = Scene { name: "small-falloff", year: Year::Durer, ..old.clone() };
    vec![textures, sky, patterns, prism, crystal, mirror_box, lens]
}

/// Mistakes that are made alone, by name of the scene.
pub const SINGLE: &[(&str, &[&str])] = &[
    (
        "textures",
        &[
            "texture-exchanged",
            "texture-flipped",
            "texture-u-flipped",
            "texture-nearest",
            "texture-shifted",
            "texture-less-one",
            "texture-repeated",
            "texture-bgr",
            "texture-times-diffuse",
            "texture-undecoded",
            "texture-vertices",
            "no-highlights",
            "wrapped",
        ],
    ),
    (
        "cube-sky",
        &[
            "sky-negated",
            "sky-x",
            "sky-z-up",
            "sky-turned",
            "sky-faces",
            "sky-mirrored",
            "sky-upside-down",
            "sky-up-turned",
            "sky-front-mirrored",
            "sky-undivided",
            "sky-nearest",
            "sky-shifted",
            "sky-bgr",
            "mirror-negated",
            "bounce-less",
        ],
    ),
    (
        "patterns",
        &[
            "pattern-exchanged",
            "pattern-world",
            "pattern-inverse",
            "pattern-object",
            "checkerboard-truncated",
            "checkerboard-rounded",
            "checkerboard-remainder",
            "checkerboard-flat",
            "checkerboard-x",
            "octaves-more",
            "octaves-less",
            "amplitude-same",
            "frequency-same",
            "noise-absolute",
            "noise-bare",
            "noise-halved",
            "veins-all-scaled",
            "veins-undistorted",
            "veins-cosine",
            "veins-unmapped",
            "veins-y",
            "no-shadows",
        ],
    ),
    (
        "prism",
        &[
            "total-mirrored",
            "total-straight",
            "total-black",
            "root-added",
            "glass-in-front",
            "index-inverted",
            "exit-not-swapped",
            "not-bent",
            "refraction-formula",
            "bounce-more",
        ],
    ),
    ("crystal", &["total-lost", "fresnel-exchanged", "no-fresnel", "index-inverted", "root-added", "bounce-less"]),
    (
        "mirror-box",
        &[
            "normals-inverse",
            "normals-transposed",
            "normals-moved",
            "normals-moved-long",
            "normals-local",
            "rotation-negated",
        ],
    ),
    ("small-falloff", &["falloff-of-highlights", "border-columns", "center-over-less-one", "exponent-4", "wrapped"]),
    ("lamps", &["falloff-of-highlights", "border-columns", "center-over-less-one", "exponent-4", "wrapped"]),
    ("turned", &["normals-inverse", "normals-transposed", "normals-moved-long"]),
    ("fresnel", &["shadow-fronts", "fresnel-exchanged", "root-added"]),
    ("ours", &["wrapped", "border-columns"]),
    (
        "lamps",
        &[
            "highlight-along-axis",
            "falloff-of-ray",
            "falloff-of-eye",
            "shadows-of-one-object",
            "ambient-sky",
            "sphere-normals-long",
            "radius-not-squared",
        ],
    ),
    (
        "mirrors",
        &[
            "highlight-along-axis",
            "falloff-of-ray",
            "shadows-of-one-object",
            "ambient-sky",
            "sphere-normals-long",
            "radius-not-squared",
            "mirror-along-unit",
            "mirror-start",
        ],
    ),
    ("glass", &["glass-mixed", "ambient-sky"]),
    ("falloff", &["highlight-along-axis", "falloff-of-ray", "falloff-of-eye"]),
];

/// Returns the name in the library's table for a mistake of the judge's tracer, if it differs.
pub fn description(made: &str) -> Option<&'static str> {
    Some(match made {
        "texture-u-flipped" => "texture-flipped",
        "texture-less-one" => "texture-size",
        "texture-repeated" => "texture-border",
        "sky-negated" | "sky-x" | "sky-z-up" | "sky-turned" => "sky-direction",
        "sky-up-turned" => "sky-rotated",
        "sky-front-mirrored" => "sky-mirrored",
        "pattern-world" | "pattern-inverse" | "pattern-object" => "pattern-space",
        "checkerboard-rounded" => "checkerboard-truncated",
        "checkerboard-flat" | "checkerboard-x" => "checkerboard-axes",
        "octaves-more" | "octaves-less" => "octaves",
        "amplitude-same" | "frequency-same" | "noise-absolute" => "octave-weights",
        "noise-bare" | "noise-halved" => "noise-share",
        "veins-y" => "veins-axis",
        "veins-all-scaled" | "veins-undistorted" | "veins-cosine" | "veins-unmapped" => "veins",
        "total-clamped" | "total-lost" | "total-mirrored" | "total-straight" | "total-black" => "total-reflection",
        "normals-moved-long" => "normals-long",
        "border-columns" => "border-of-one-axis",
        "center-over-less-one" => "pixel-center-over-n-less-one",
        "exponent-4" => "exponent",
        "falloff-of-highlights" => "falloff-of-one-term",
        "falloff-of-ray" | "falloff-of-eye" => "falloff-of-other-length",
        "sphere-normals-long" => "sphere-normals",
        "mirror-along-unit" => "mirror-along",
        _ => return None,
    })
}
