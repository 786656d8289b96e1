//! Tests scenes with mistakes of students. There is one case for each mistake that `check` or the
//! reader once missed or reported incorrectly.

use crate::common::TestFolder;
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

/// Returns the scene in the dialect of a year, with changes.
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

fn found(folder: &TestFolder, year: &str, options: &str, changes: &[(&str, &str)]) -> (Vec<String>, String) {
    folder.write("broken.txt", scene(year, changes));
    let output = folder.run(&format!("check broken.txt --json --dialect {year} {options}"));
    let json: Value =
        serde_json::from_str(&output.out).unwrap_or_else(|error| panic!("{error}: {}{}", output.out, output.err));
    let findings = json["scenes"][0]["findings"].as_array().unwrap();
    (findings.iter().map(|finding| finding["code"].as_str().unwrap().to_string()).collect(), output.out)
}

/// Year, options, changes, and the code of the first finding. The code is empty if there must be no
/// warning.
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
    ("f04", "--bounces 3", &[(RIGHT, "Triangle { vertex0 0 0 0 vertex1 2 0 0 vertex2 1 2 0 }")], "open-glass"),
    (
        "f04",
        "",
        &[
            ("numMaterials 3", "numMaterials 4"),
            (GREY, "Material { diffuseColor 0.6 0.6 0.6 } Checkerboard { materialIndex 0 materialIndex 0 }"),
        ],
        "same-parts",
    ),
    ("f04", "--bounces 3", &[(LEFT, "TriangleMesh { obj_file quad.obj }")], "mesh-quads"),
    // If a floor faces down, the light is not the cause.
    ("f04", "--bounces 3", &[("normal 0 1 0 offset 0", "normal 0 -1 0 offset 0")], "seen-from-behind"),
    ("f16", "", &[("normal 0 1 0 offset 0", "normal 0 -1 0 offset 0")], "seen-from-behind"),
    // Report the cause instead of saying that nothing is visible or that the picture has a single
    // colour.
    ("f04", "--bounces 3", &[("direction 0 -0.15 -1", "direction 0 0.15 1")], "camera-away"),
    (
        "f04",
        "--bounces 3",
        &[(ANGLE, "OrthographicCamera { center -1.2 1 9 direction 0 0 -1 up 0 1 0 size 0.1 }")],
        "too-narrow",
    ),
    // If the camera were turned to the objects below the floor, it would see only the floor.
    (
        "f04",
        "--bounces 3",
        &[("-1.2 1 0 radius", "-1.2 -7 0 radius"), ("1.2 1 0 radius", "1.2 -8 0 radius")],
        "below-plane",
    ),
    (
        "f04",
        "--bounces 3",
        &[(RIGHT, "Transform { Translate -240 -198 -1791 Sphere { center 0 0 0 radius 1 } }")],
        // If an object is narrower than two pixels, report why it is invisible.
        "tiny",
    ),
    ("f04", "--bounces 3 --show depth --depth-range 12 6", &[], "depth-range"),
    (
        "f12a5",
        "",
        &[("specularColor 0.9 0.9 0.9 refractionIndex", "specularColor 0 0 0 refractionIndex")],
        "dull-glass",
    ),
    (
        "durer",
        "",
        &[(LEFT, "Difference { Sphere { center -1.2 1 0 radius 1 } Sphere { center -1.2 1 0 radius 1.5 } }")],
        "empty-solid",
    ),
    ("durer", "", &[("PerspectiveCamera {", "ThinLensCamera { aperture 8 focusDistance 9")], "wide-aperture"),
];

const LEFT: &str = "Sphere { center -1.2 1 0 radius 1 }";
const RIGHT: &str = "Sphere { center 1.2 1 0 radius 1 }";
const GREY: &str = "Material { diffuseColor 0.6 0.6 0.6 }";
const ANGLE: &str = "PerspectiveCamera { center 0 2 9 direction 0 -0.15 -1 up 0 1 0 angle 35 }";

#[test]
fn cause_is_reported_first() {
    let folder = TestFolder::new();
    folder.write("quad.obj", "v -2 0 0\nv 0 0 0\nv 0 2 0\nv -2 2 0\nf 1 2 3 4\n");
    for year in ["f04", "f12a4", "f12a5", "f16"] {
        let bounces = if year == "f04" { "--bounces 3" } else { "" };
        let (codes, text) = found(&folder, year, bounces, &[]);
        assert!(!text.contains("\"severity\": \"warning\""), "{year}: {codes:?}");
    }
    let mut wrong = Vec::new();
    for (year, options, changes, wanted) in CASES {
        let (codes, _) = found(&folder, year, options, changes);
        if codes.first().map(String::as_str) != Some(wanted) {
            wrong.push(format!("{year} {options} {changes:?}: {wanted} is wanted, {codes:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A colour that is out of range is not also reported as too much light. An object behind glass is
/// not reported as hidden.
#[test]
fn consequences_are_not_reported() {
    let folder = TestFolder::new();
    let (codes, _) = found(&folder, "f04", "--bounces 3", &[("color 0.9 0.9 0.9", "color 230 230 230")]);
    assert!(!codes.iter().any(|code| code == "too-bright"), "{codes:?}");
    let behind = [("center -1.2 1 0 radius 1", "center 1.2 1 -1.5 radius 0.3")];
    let (codes, _) = found(&folder, "f04", "--bounces 3", &behind);
    assert!(!codes.iter().any(|code| code == "unseen" || code == "hidden-behind"), "{codes:?}");
}

/// Something that may be intended gets at most a note and no fix.
#[test]
fn possible_intentions_are_left_unchanged() {
    let folder = TestFolder::new();
    // A crescent moon, and a scene that has only ambient light of 1, as in the first assignment.
    let moon = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 20 }
Lights { numLights 1 DirectionalLight { direction -1 -0.1 0.35 color 1 1 0.9 } }
Materials { numMaterials 1 Material { diffuseColor 0.8 0.8 0.8 } }
Group { numObjects 1 MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }
";
    let flat = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 20 }
Background { color 0 0 0 ambientLight 1 1 1 }
Materials { numMaterials 1 Material { diffuseColor 0.8 0.2 0.2 } }
Group { numObjects 1 MaterialIndex 0 Sphere { center 0 0 0 radius 1 } }
";
    for text in [moon, flat] {
        folder.write("meant.txt", text);
        let output = folder.expect_exit(0, "check meant.txt --dialect f04");
        assert!(!output.out.contains("warning["), "{}", output.out);
        folder.expect_exit(0, "check meant.txt --dialect f04 --fix");
        assert_eq!(folder.bytes("meant.txt"), text.as_bytes());
    }
}

/// A colour of 5 is not interpreted as 5 out of 255, and messages use the keywords of the year.
#[test]
fn help_suggests_the_intended_value() {
    let folder = TestFolder::new();
    folder.write("five.txt", scene("f04", &[("diffuseColor 0.6 0.6 0.6", "diffuseColor 5 5 5")]));
    let before = folder.bytes("five.txt");
    folder.run("check five.txt --dialect f04 --fix");
    assert_eq!(folder.bytes("five.txt"), before);
    let (_, text) = found(&folder, "f16", "", &[("falloff 0.03", "falloff 0")]);
    assert!(!text.contains("attenuation"), "{text}");
    // A directional light has no position, so the help must not suggest moving it.
    let behind =
        ("PointLight { position 3 5 4 color 0.9 0.9 0.9", "DirectionalLight { direction 0.1 1 -0.1 color 0.9 0.9 0.9");
    let (_, text) = found(&folder, "f12a4", "", &[behind]);
    assert!(text.contains("light-behind") && !text.contains("move the light"), "{text}");
    // If mirrors reflect more light than they receive, the lights are not blamed.
    let mirrors = [
        ("color 0.2 0.3 0.4 ambientLight 0.1 0.1 0.1", "color 0.9 0.9 0.9 ambientLight 0.4 0.4 0.4"),
        ("diffuseColor 0.6 0.6 0.6", "diffuseColor 0.6 0.6 0.6 reflectiveColor 1 1 1"),
    ];
    let (codes, text) = found(&folder, "f04", "--bounces 3", &mirrors);
    assert!(
        codes[0] == "too-bright"
            && text.contains("material 1 reflects and transmits 1.6 times the light that it receives"),
        "{text}"
    );
    assert!(!text.contains("colours of the lights"), "{text}");
    let nodes = "Camera { center 0 0 9 direction 0 0 -1 up 0 1 0 fov 30 }
Background { color 0 0 0 ambient_light 0.1 0.1 0.1 }
Materials { Material { diffuse 1 0 0 } }
Scene { Node { Component<Object> { type sphere radius 1 } }
  Node { Transform { translate 0 3 4 } Component<Light> { type point color 1 1 1 attenuation 0.05 } } }
";
    folder.write("nodes.txt", nodes);
    let output = folder.run("check nodes.txt --dialect f23").out;
    assert!(output.contains("`Component<Material> { index 0 }`") && !output.contains("MaterialIndex"), "{output}");
    // Each message that mentions `--fix` says what it would change.
    folder.write("bytes.txt", scene("f04", &[("diffuseColor 0.7 0.3 0.2", "diffuseColor 204 51 51")]));
    let output = folder.run("check bytes.txt --dialect f04 --bounces 3").out;
    assert!(output.contains("(`--fix` writes `0.8 0.2 0.2`)"), "{output}");
}

#[test]
fn reader_suggests_the_intended_word() {
    let folder = TestFolder::new();
    let says = |dialect: &str, text: &str, wanted: &str| {
        folder.write("words.txt", text);
        let dialect = if dialect.is_empty() { String::new() } else { format!("--dialect {dialect}") };
        let output = folder.run(&format!("render words.txt -q -o words.png {dialect}"));
        assert!(output.code == Some(2) && output.err.contains(wanted), "{wanted}: {}", output.err);
        assert!(output.err.lines().count() < 60, "{}", output.err);
    };
    let sphere = "Sphere { center -1.2 1 0 radius 1 }";
    for (old, new, wanted) in [
        ("Plane {", "Plain {", "did you mean `Plane`?"),
        (sphere, "Transform { Rotation 45 Sphere { center 0 0 0 radius 1 } }", "`XRotate`, `YRotate` and `ZRotate`"),
        (sphere, "Transform { Scale 2 Sphere { center 0 0 0 radius 1 } }", "`UniformScale 2`"),
        (sphere, "Transform { Rotate 0 1 0 45 Sphere { center 0 0 0 radius 1 } }", "write `Rotate { 0 1 0 45 }`"),
        (sphere, "Transform { Translate 0 1 0 }", "write the object after its matrices"),
        (sphere, "Sphere { center 0 0 0 }", "for example `radius 1`"),
        ("PointLight {", "SpotLight {", "`SpotLight` has no field `attenuation`"),
        ("PointLight {", "DirectionalLight {", "a directional light has a `direction` in which it shines"),
    ] {
        says("f04", &scene("f04", &[(old, new)]), wanted);
    }
    let nodes = "Camera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 30 }
Background { color 0 0 0 ambient_light 0.1 0.1 0.1 }
Materials { Material { diffuse 1 0 0 } }
Scene { Node { Component<Material> { index 0 } Component<Object> { type sphere radius 1 } } }
";
    // A single keyword from another dialect does not change the dialect of a file. The message
    // names the keyword and its equivalent.
    folder.write("nodes.txt", nodes);
    let errors = folder.run("check nodes.txt").out;
    assert!(errors.contains("`angle` is not a word of f23") && errors.contains("write `fov` in f23"), "{errors}");
    let wide: Vec<u8> = SCENE.bytes().flat_map(|b| [b, 0]).collect();
    folder.write("wide.txt", [&[0xff, 0xfe][..], &wide].concat());
    let output = folder.expect_exit(2, "render wide.txt -q -o words.png");
    assert!(output.err.contains("UTF-16") && output.err.lines().count() < 8, "{}", output.err);
    folder.write("binary.txt", (0..4000_u32).map(|i| (i * 7919 % 251) as u8).collect::<Vec<u8>>());
    let output = folder.expect_exit(2, "render binary.txt -q -o words.png");
    assert!(output.err.contains("binary") && output.err.lines().count() < 8, "{}", output.err);
    // The message about a light with a zero direction must not be the one for the camera.
    let still = ("PointLight { position 3 5 4", "DirectionalLight { direction 0 0 0");
    says("", &scene("f12a4", &[still]), "the `direction` of a light is the direction in which the light shines");
    // A scene that the official program of its year would reject gets a note.
    folder.write("brace.txt", scene("f04", &[("Group {", "Group{")]));
    let output = folder.run("check brace.txt --dialect f04 --bounces 3");
    assert!(output.out.contains("would refuse this file"), "{}{}", output.out, output.err);
    folder.write("count.txt", scene("f04", &[("numObjects 3", "")]));
    let output = folder.run("check count.txt --dialect f04 --bounces 3");
    assert!(output.out.contains("would refuse this file: `Group` has no `numObjects`"), "{}{}", output.out, output.err);
}
