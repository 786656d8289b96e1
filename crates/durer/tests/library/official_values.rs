//! Tests that degenerate values and repeated sections are handled in the same way as in the
//! course's programs since 2012. Without the quirks, the results must be correct.

use durer::diag::{Diagnostics, Files, Severity};
use durer::dialect::{Dialect, Quirk};
use durer::film::aov::Aov;
use durer::integrator::{RenderSettings, Whitted};
use durer::light::Light;
use durer::math::{Color, Ray, Vec3};
use durer::render::{Control, Job, render};
use durer::world::World;
use durer::{LoadOptions, load_text};
use std::path::Path;

/// Loads a scene in a dialect, with its quirks if `official` is true. Returns the diagnostics and
/// the world, which is `None` if there are errors.
fn load(folder: &Path, text: &str, dialect: Dialect, official: bool) -> (Option<World>, Diagnostics) {
    let all = Quirk::ALL.iter().map(|row| (row.0, false));
    let compat = if official { Vec::new() } else { all.collect() };
    let options = LoadOptions { dialect: Some(dialect), compat, course: true, ..LoadOptions::default() };
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let path = folder.join("scene.txt");
    let loaded = load_text(&path, text.as_bytes().into(), &options, &mut files, &mut diagnostics);
    let world = loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics));
    (world, diagnostics)
}

fn official(text: &str, dialect: Dialect) -> World {
    let (world, diagnostics) = load(Path::new("."), text, dialect, true);
    world.unwrap_or_else(|| panic!("{dialect:?}: {diagnostics:?}"))
}

fn traced_color(world: &World, origin: [f32; 3], dir: [f32; 3]) -> Color {
    let settings = RenderSettings {
        bounces: 1,
        shadows: false,
        shade_back: false,
        transparent_shadows: false,
        reflection: true,
        refraction: true,
        min_weight: 0.0,
    };
    let ray = Ray::new(origin.into(), Vec3::from(dir).normalize());
    Whitted { world, settings, cancel: None }.radiance(&ray, &mut ())
}

const DOWN: [f32; 3] = [0.0, -1.0, 0.0];
const LIT: &str = "Lights { numLights 1 DirectionalLight { direction 0 -1 0 color 0.5 0.5 0.5 } }";
const BALL: &str = "Sphere { center 0 0 0 radius 2 }";

/// Returns a scene in the language used before 2020. The scene is seen from above.
fn classic(lights: &str, angle: &str, shininess: &str, objects: &str) -> String {
    format!(
        "PerspectiveCamera {{ center 0 5 0 direction 0 -1 0 up 0 0 1 angle {angle} }} {lights}
         Background {{ color 0 0 0.25 ambientLight 0.25 0.25 0.25 }}
         Materials {{ numMaterials 1
           PhongMaterial {{ diffuseColor 1 1 1 specularColor 0.5 0.5 0.5 shininess {shininess} }} }}
         Group {{ numObjects 1 MaterialIndex 0 {objects} }}"
    )
}

fn nodes(fov: &str, shininess: &str, node: &str) -> String {
    format!(
        "Camera {{ center 0 5 0 direction 0 -1 0 up 0 0 1 fov {fov} }}
         Background {{ color 0 0 0.25 ambient_light 0.25 0.25 0.25 }}
         Materials {{ Material {{ diffuse 1 1 1 specular 0.5 0.5 0.5 shininess {shininess} }} }}
         Scene {{ Node {{ Component<Light> {{ type directional direction 0 -1 0 color 0.5 0.5 0.5 }} }} {node} }}"
    )
}

const NODE: &str = "Node { Component<Material> { index 0 } Component<Object> { type sphere radius 2 } }";

/// Returns all dialects that have an official program, with a scene for each.
fn years(edit: impl Fn(&str) -> String) -> Vec<(Dialect, String)> {
    let classic = edit(&classic(LIT, "40", "10", BALL));
    let mut scenes: Vec<_> =
        [Dialect::F12a4, Dialect::F12a5, Dialect::F16].into_iter().map(|year| (year, classic.clone())).collect();
    scenes.push((Dialect::F23, edit(&nodes("40", "10", NODE))));
    scenes
}

#[test]
fn degenerate_values_are_rendered_for_a_named_year_and_refused_otherwise() {
    let plain = |text: &str| text.to_string();
    let of = |edit: &dyn Fn(&str) -> String| years(edit);
    for (what, scenes) in [
        ("a radius below 0", of(&|text| text.replace("radius 2", "radius -2"))),
        ("no radius", of(&|text| text.replace("radius 2", "radius 0"))),
        ("an exponent below 0", of(&|text| text.replace("shininess 10", "shininess -2"))),
        ("half a turn", of(&|text| text.replace("angle 40", "angle 180").replace("fov 40", "fov 180"))),
        ("a light without a direction", of(&|text| text.replace("direction 0 -1 0 color", "direction 0 0 0 color"))),
    ] {
        for (dialect, text) in scenes {
            assert!(text != plain(&years(plain)[0].1), "{what}");
            let (world, found) = load(Path::new("."), &text, dialect, true);
            assert!(world.is_some(), "{what} {dialect:?}: {found:?}");
            assert!(
                found.iter().any(|d| d.code == "bad-value" && d.severity == Severity::Warning),
                "{what}: {found:?}"
            );
            let (world, found) = load(Path::new("."), &text, dialect, false);
            assert!(world.is_none() && found.has_errors(), "{what} {dialect:?}");
        }
    }
    // No official program accepts these values.
    for wrong in ["radius 1e99", "radius x", "radius nan"] {
        let text = years(|text| text.replace("radius 2", wrong)).remove(2).1;
        assert!(load(Path::new("."), &text, Dialect::F16, true).0.is_none(), "{wrong}");
    }
}

#[test]
fn negative_radius_is_used_as_absolute_value_and_zero_is_invisible() {
    for (dialect, text) in years(str::to_string) {
        let [whole, below, none] =
            ["radius 2", "radius -2", "radius 0"].map(|radius| official(&text.replace("radius 2", radius), dialect));
        for x in [0.0, 0.5, 1.9, 2.1] {
            let look = |world: &World| traced_color(world, [x, 5.0, 0.3], DOWN);
            assert_eq!(look(&whole), look(&below), "{dialect:?}");
            assert_eq!(look(&none), Color::new(0.0, 0.0, 0.25), "{dialect:?}");
        }
    }
}

#[test]
fn hexadecimal_numbers_are_read_before_2020() {
    for (dialect, text) in years(|text| text.replace("radius 2", "radius 0x1.8p0")) {
        let (world, found) = load(Path::new("."), &text, dialect, true);
        assert_eq!(world.is_some(), dialect != Dialect::F23, "{dialect:?}: {found:?}");
        let Some(world) = world else { continue };
        assert!(found.iter().any(|d| d.message.contains("hexadecimal")), "{found:?}");
        let same = official(&text.replace("0x1.8p0", "1.5"), dialect);
        assert_eq!(traced_color(&world, [0.0, 5.0, 1.49], DOWN), traced_color(&same, [0.0, 5.0, 1.49], DOWN));
        assert!(load(Path::new("."), &text, dialect, false).0.is_none());
    }
    for wrong in ["0x", "0xp1", "0x1p", "0x1.8q0", "0x1p99999", "-0x"] {
        let (_, text) = years(|text| text.replace("radius 2", &format!("radius {wrong}"))).remove(2);
        assert!(load(Path::new("."), &text, Dialect::F16, true).0.is_none(), "{wrong}");
    }
}

#[test]
fn flat_scales_are_rendered_before_2020_and_ignored_since() {
    let flat = |scale: &str| classic(LIT, "40", "10", &format!("Transform {{ Scale {scale} {BALL} }}"));
    for dialect in [Dialect::F12a4, Dialect::F12a5, Dialect::F16] {
        let (world, found) = load(Path::new("."), &flat("1 0 1"), dialect, true);
        assert!(world.is_some() && found.iter().any(|d| d.code == "flat-transform"), "{dialect:?}: {found:?}");
        let (world, found) = load(Path::new("."), &flat("1 0 1"), dialect, false);
        assert!(world.is_none() && found.has_errors(), "{dialect:?}");
    }
    // In the program of 2016, the sphere is hit at a t of NaN and is black. In the program of 2012,
    // it is hit at t = 10000, as in a4soln.
    assert_eq!(traced_color(&official(&flat("1 0 1"), Dialect::F16), [0.0, 5.0, 0.0], DOWN), Color::ZERO);
    assert_eq!(traced_color(&official(&flat("1 0 1"), Dialect::F12a4), [0.0, 5.0, 0.0], DOWN), Color::splat(0.25));
    let node = |scale: &str| {
        let node = NODE.replace("Node {", &format!("Node {{ Transform {{ translate 9 0 0 scale {scale} }}"));
        official(&nodes("40", "10", &node), Dialect::F23)
    };
    // All matrices of the transform are ignored, so the sphere keeps its position.
    for scale in ["1 0 1", "0.004 0.004 0.004"] {
        assert_ne!(traced_color(&node(scale), [1.5, 5.0, 0.0], DOWN), Color::new(0.0, 0.0, 0.25), "{scale}");
    }
    assert_eq!(traced_color(&node("0.006 0.006 0.006"), [1.5, 5.0, 0.0], DOWN), Color::new(0.0, 0.0, 0.25));
}

#[test]
fn light_divided_by_zero_is_not_finite() {
    let emitter = |attenuation: &str| {
        let light = format!(
            "Node {{ Transform {{ translate 0 9 0 }} Component<Light> {{ type point color 1 1 1 {attenuation} }} }}"
        );
        let text = nodes("40", "10", &format!("{NODE} {light}"));
        official(&text, Dialect::F23)
    };
    let bright = |world: &World| traced_color(world, [0.0, 5.0, 0.0], DOWN);
    assert!(!bright(&emitter("attenuation 0")).is_finite());
    assert!(bright(&emitter("")).is_finite() && bright(&emitter("attenuation 1")).is_finite());
    for dialect in [Dialect::F12a4, Dialect::F16] {
        let text = classic(&LIT.replace("direction 0 -1 0", "direction 0 0 0"), "40", "10", BALL);
        assert!(!bright(&official(&text, dialect)).is_finite());
    }
}

#[test]
fn second_lights_section_is_added_in_2016_and_replaces_the_first_otherwise() {
    let second = LIT.replace("0.5 0.5 0.5", "0.25 0 0");
    let text = classic(&format!("{LIT} {second}"), "40", "10", BALL);
    let colors = |world: &World| -> Vec<f32> {
        let color = |light: &Light| match light {
            Light::Directional(light) => light.color.x,
            _ => f32::NAN,
        };
        world.lights().iter().map(color).collect()
    };
    assert_eq!(colors(&official(&text, Dialect::F16)), [0.5, 0.25]);
    assert_eq!(colors(&load(Path::new("."), &text, Dialect::F16, false).0.unwrap()), [0.25]);
    assert_eq!(colors(&official(&text, Dialect::F12a4)), [0.25]);
}

#[test]
fn face_without_area_makes_neighbours_black_in_2016() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 3 0 -1\nv 3 0 1\nf 3 2 1\nf 4 3 1\nf 6 5 2\nf 1 4 4\n";
    std::fs::write(folder.path().join("flat.obj"), mesh).unwrap();
    let text = classic(LIT, "40", "10", "TriangleMesh { obj_file flat.obj }");
    let look = |dialect, official, x: f32| {
        let (world, found) = load(folder.path(), &text, dialect, official);
        let world = world.unwrap_or_else(|| panic!("{found:?}"));
        (traced_color(&world, [x, 5.0, 0.2], DOWN), traced_color(&world, [x, 5.0, 0.2], DOWN).x > 0.2)
    };
    assert_eq!(look(Dialect::F16, true, -0.5).0, Color::ZERO);
    assert!(look(Dialect::F16, true, 2.5).1 && look(Dialect::F16, false, -0.5).1);
    assert!(look(Dialect::F12a4, true, -0.5).1);
}

#[test]
fn depths_of_2012_are_clamped_before_they_are_mapped_to_grey() {
    let text = classic(LIT, "40", "10", BALL);
    let grey = |dialect, range: (f32, f32)| {
        let world = official(&text, dialect);
        let job = Job {
            width: 3,
            height: 3,
            color: false,
            aovs: vec![Aov::from_name("depth").unwrap()],
            depth_range: Some(range),
            ..Job::default()
        };
        render(&world, &job, &Control::default()).unwrap().pictures[0].image.pixels[4].x
    };
    // The ball is hit at t = 3.
    assert_eq!(grey(Dialect::F12a4, (2.0, 6.0)), 0.75);
    assert_eq!(grey(Dialect::F12a4, (4.0, 6.0)), 1.0);
    // In a reversed range, depths below the start of the range are set to the start, and all other
    // depths to the end.
    assert_eq!(grey(Dialect::F12a4, (9.0, 2.0)), 1.0);
    assert_eq!(grey(Dialect::F12a4, (2.5, 2.0)), 0.0);
    assert_eq!(grey(Dialect::F04, (9.0, 2.0)), 0.0 + (2.0 - 3.0) / (2.0 - 9.0));
}
