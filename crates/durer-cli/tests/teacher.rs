//! What students break, one case for each that `check` or the reader once missed or told wrongly.

mod common;

use common::Place;
use serde_json::Value;

const SCENE: &str = "PerspectiveCamera { center 0 2 9 direction 0 -0.15 -1 up 0 1 0 angle 35 }
Lights { numLights 1
  PointLight { position 3 5 4 color 0.9 0.9 0.9 LIGHT } }
Background { color 0.2 0.3 0.4 ambientLight 0.1 0.1 0.1 }
Materials { numMaterials 3
  Material { diffuseColor 0.7 0.3 0.2 specularColor 0.4 0.4 0.4 SHINE }
  Material { diffuseColor 0.6 0.6 0.6 }
  Material { diffuseColor 0.1 0.1 0.1 GLASS } }
Group { numObjects 3
  MaterialIndex 0 Sphere { center -1.2 1 0 radius 1 }
  MaterialIndex 2 Sphere { center 1.2 1 0 radius 1 }
  MaterialIndex 1 Plane { normal 0 1 0 offset 0 } }
";

/// The scene in a year's words, with changes.
fn scene(year: &str, changes: &[(&str, &str)]) -> String {
    let (light, shine, glass) = match year {
        "f04" => ("attenuation 1 0 0.01", "exponent 20", "transparentColor 0.9 0.9 0.9 indexOfRefraction 1.5"),
        "f12a5" => ("falloff 0.01", "shininess 20", "specularColor 0.9 0.9 0.9 refractionIndex 1.5"),
        "f16" => ("falloff 0.03", "shininess 20", "specularColor 0.8 0.8 0.8 shininess 20"),
        _ => ("", "shininess 20", "specularColor 0.2 0.2 0.2 shininess 20"),
    };
    let mut text = SCENE.replace("LIGHT", light).replace("SHINE", shine).replace("GLASS", glass);
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    text
}

fn found(place: &Place, year: &str, options: &str, changes: &[(&str, &str)]) -> (Vec<String>, String) {
    place.put("broken.txt", scene(year, changes));
    let ran = place.run(&format!("check broken.txt --json --dialect {year} {options}"));
    let json: Value = serde_json::from_str(&ran.out).unwrap_or_else(|error| panic!("{error}: {}{}", ran.out, ran.err));
    let findings = json["scenes"][0]["findings"].as_array().unwrap();
    (findings.iter().map(|finding| finding["code"].as_str().unwrap().to_string()).collect(), ran.out)
}

/// Year, options, changes, the finding that stands first; none where there is to be no warning.
type Case = (&'static str, &'static str, &'static [(&'static str, &'static str)], &'static str);

const CASES: &[Case] = &[
    ("f12a4", "", &[("shininess 20", "shininess 0")], "pow-zero"),
    ("f16", "", &[("up 0 1 0", "up 0 9 0")], "long-up"),
    ("f12a4", "--size 300x100", &[], "stretched"),
    ("f04", "--bounces 3 --weight 2", &[], "no-bounces"),
    ("f12a5", "--bounces 0", &[], "no-bounces"),
    ("f04", "--bounces 3", &[("MaterialIndex 1 Plane", "MaterialIndex 2 Plane")], "open-glass"),
    ("f04", "", &[("exponent 20", "")], "no-exponent"),
    ("f04", "", &[("normal 0 1 0 offset 0", "normal 0 2 0 offset 0.5")], "plane-normal"),
    ("f04", "", &[("ambientLight 0.1 0.1 0.1", "ambientLight 1 1 1")], "full-ambient"),
    ("f04", "", &[("offset 0 }", "offset 3 }")], "below-plane"),
    ("f04", "--shadows", &[("position 3 5 4", "position 3 -5 4")], "light-blocked"),
    ("f04", "", &[("center 1.2 1 0 radius 1", "center 1.2 1 0 radius 1e30")], "out-of-scale"),
    ("f04", "", &[("diffuseColor 0.6 0.6 0.6", "diffuseColor 1.6 1.6 1.6")], "color-range"),
    ("f16", "", &[("falloff 0.03", "attenuation 1 0 0.03")], "foreign-word"),
];

#[test]
fn the_cause_stands_first() {
    let place = Place::new();
    for year in ["f04", "f12a4", "f12a5", "f16"] {
        let bounces = if year == "f04" { "--bounces 3" } else { "" };
        let (codes, text) = found(&place, year, bounces, &[]);
        assert!(!text.contains("\"severity\": \"warning\""), "{year}: {codes:?}");
    }
    let mut wrong = Vec::new();
    for (year, options, changes, wanted) in CASES {
        let (codes, _) = found(&place, year, options, changes);
        if codes.first().map(String::as_str) != Some(wanted) {
            wrong.push(format!("{year} {options} {changes:?}: {wanted} is wanted, {codes:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// After a colour out of range, nobody is told of too much light as well; what is behind glass is not hidden.
#[test]
fn consequences_are_silent() {
    let place = Place::new();
    let (codes, _) = found(&place, "f04", "--bounces 3", &[("color 0.9 0.9 0.9", "color 230 230 230")]);
    assert!(!codes.iter().any(|code| code == "too-bright"), "{codes:?}");
    let behind = [("center -1.2 1 0 radius 1", "center 1.2 1 -1.5 radius 0.3")];
    let (codes, _) = found(&place, "f04", "--bounces 3", &behind);
    assert!(!codes.iter().any(|code| code == "unseen" || code == "hidden-behind"), "{codes:?}");
}

/// A colour of 5 is not 5 of 255, and a year is told its own words.
#[test]
fn help_is_what_was_meant() {
    let place = Place::new();
    place.put("five.txt", scene("f04", &[("diffuseColor 0.6 0.6 0.6", "diffuseColor 5 5 5")]));
    let before = place.bytes("five.txt");
    place.run("check five.txt --dialect f04 --fix");
    assert_eq!(place.bytes("five.txt"), before);
    let (_, text) = found(&place, "f16", "", &[("falloff 0.03", "falloff 0")]);
    assert!(!text.contains("attenuation"), "{text}");
}

#[test]
fn the_reader_knows_what_is_meant() {
    let place = Place::new();
    let says = |dialect: &str, text: &str, wanted: &str| {
        place.put("words.txt", text);
        let dialect = if dialect.is_empty() { String::new() } else { format!("--dialect {dialect}") };
        let ran = place.run(&format!("render words.txt -q -o words.png {dialect}"));
        assert!(ran.code == Some(2) && ran.err.contains(wanted), "{wanted}: {}", ran.err);
        assert!(ran.err.lines().count() < 60, "{}", ran.err);
    };
    let sphere = "Sphere { center -1.2 1 0 radius 1 }";
    for (old, new, wanted) in [
        ("Plane {", "Plain {", "did you mean `Plane`?"),
        (sphere, "Transform { Rotation 45 Sphere { center 0 0 0 radius 1 } }", "`XRotate`, `YRotate` and `ZRotate`"),
        (sphere, "Transform { Scale 2 Sphere { center 0 0 0 radius 1 } }", "`UniformScale 2`"),
        (sphere, "Transform { Rotate 0 1 0 45 Sphere { center 0 0 0 radius 1 } }", "write `Rotate { 0 1 0 45 }`"),
        (sphere, "Transform { Translate 0 1 0 }", "write the object after its matrices"),
        (sphere, "Sphere { center 0 0 0 }", "as in `radius 1`"),
        ("PointLight {", "SpotLight {", "there are no spot lights"),
        ("PointLight {", "DirectionalLight {", "a directional light has no place"),
    ] {
        says("f04", &scene("f04", &[(old, new)]), wanted);
    }
    let nodes = "Camera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 30 }
Background { color 0 0 0 ambient_light 0.1 0.1 0.1 }
Materials { Material { diffuse 1 0 0 } }
Scene { Node { Component<Material> { index 0 } Component<Object> { type sphere radius 1 } } }
";
    // One foreign word does not make another dialect of a file; it is named, and so is its counterpart.
    place.put("nodes.txt", nodes);
    let told = place.run("check nodes.txt").out;
    assert!(told.contains("`angle` is not a word of f23") && told.contains("in f23 it is `fov`"), "{told}");
    let wide: Vec<u8> = SCENE.bytes().flat_map(|b| [b, 0]).collect();
    place.put("wide.txt", [&[0xff, 0xfe][..], &wide].concat());
    let ran = place.gives(2, "render wide.txt -q -o words.png");
    assert!(ran.err.contains("UTF-16") && ran.err.lines().count() < 8, "{}", ran.err);
    place.put("binary.txt", (0..4000_u32).map(|i| (i * 7919 % 251) as u8).collect::<Vec<u8>>());
    let ran = place.gives(2, "render binary.txt -q -o words.png");
    assert!(ran.err.contains("binary") && ran.err.lines().count() < 8, "{}", ran.err);
    // What the year's own program would refuse is a note.
    place.put("brace.txt", scene("f04", &[("Group {", "Group{")]));
    let ran = place.run("check brace.txt --dialect f04 --bounces 3");
    assert!(ran.out.contains("would refuse this file"), "{}{}", ran.out, ran.err);
}
