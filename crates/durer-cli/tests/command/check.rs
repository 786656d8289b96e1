//! Tests `durer check` with scenes that were broken by hand.

use crate::common::{ProgramOutput, TestFolder};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Returns the folder and the names of the broken scenes. The name of each scene begins with the
/// code of the expected finding, for example `camera-away.backwards.txt`.
fn broken() -> (PathBuf, Vec<String>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/command/broken");
    let entries = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = entries.filter(|name| name.ends_with(".txt")).collect();
    names.sort();
    assert!(names.len() >= 60, "{} scenes", names.len());
    (folder, names)
}

fn code(name: &str) -> &str {
    name.split('.').next().unwrap()
}

/// Returns a folder with the broken scenes and their meshes, and the names of the scenes.
fn with_broken() -> (TestFolder, Vec<String>) {
    let (folder, names) = broken();
    let place = TestFolder::new();
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        place.write(&path.file_name().unwrap().to_string_lossy(), std::fs::read(&path).unwrap());
    }
    (place, names)
}

fn json(output: &ProgramOutput) -> Value {
    serde_json::from_str(&output.out).unwrap_or_else(|error| panic!("{error}\n{}\n{}", output.out, output.err))
}

fn codes(scene: &Value) -> Vec<String> {
    let findings = scene["findings"].as_array().unwrap();
    findings.iter().map(|finding| finding["code"].as_str().unwrap().to_string()).collect()
}

#[test]
fn cause_is_among_the_first_two() {
    let (folder, names) = with_broken();
    let output = folder.expect_exit(2, &format!("check --json {}", names.join(" ")));
    let all = json(&output);
    assert_eq!(all["version"], 1);
    let mut wrong = Vec::new();
    for (name, scene) in names.iter().zip(all["scenes"].as_array().unwrap()) {
        assert_eq!(scene["scene"], name.as_str());
        let codes = codes(scene);
        if !codes.iter().take(2).any(|found| found == code(name)) {
            wrong.push(format!("{name}: {codes:?}"));
        }
        for finding in scene["findings"].as_array().unwrap() {
            // Each span must lie within an existing file.
            let span = &finding["place"];
            if !span.is_null() {
                let bytes = folder.bytes(span["file"].as_str().unwrap());
                assert!(span["end"].as_u64().unwrap() as usize <= bytes.len(), "{name}: {finding}");
                assert!(span["line"].as_u64() >= Some(1) && span["column"].as_u64() >= Some(1), "{name}: {finding}");
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Scenes that `--fix` must repair completely.
const MENDED: [&str; 32] = [
    "bad-value.radius",
    "camera-away.backwards",
    "camera-away.f23",
    "camera-away.orthographic",
    "camera-away.point",
    "color-range.bytes",
    "color-range.light",
    "edge-on.offset",
    "extra-brace",
    "hidden-behind.floor",
    "hidden-behind.wall",
    "light-divides",
    "light-faint.attenuation",
    "light-faint.f23",
    "light-faint.falloff",
    "light-twice",
    "material-index.counted-from-1",
    "missing-file.mesh",
    "negative-color",
    "no-material",
    "radians",
    "syntax.commas",
    "too-bright",
    "too-narrow.radians",
    "too-narrow.size",
    "too-small.size",
    "turned-triangle",
    "unclosed-block",
    "unclosed-block.end",
    "unknown-word.capital",
    "unknown-word.typo",
    "up-parallel",
];

#[test]
fn mechanical_faults_are_fixed() {
    let (folder, names) = with_broken();
    for name in &names {
        let before = folder.bytes(name);
        let output = folder.run(&format!("check {name} --fix -o mended.txt --json"));
        assert_eq!(folder.bytes(name), before, "{name} itself was changed");
        let scene = &json(&output)["scenes"][0];
        let mended = scene["mended"].as_array().unwrap();
        // A second run does not report the repaired findings either.
        let again = folder.run("check mended.txt --json");
        assert_eq!(again.code, output.code, "{name}\n{}", output.out);
        let found = codes(&json(&again)["scenes"][0]);
        assert_eq!(codes(scene), found, "{name}");
        for change in mended {
            assert!(!found.iter().any(|code| change["code"] == code.as_str()), "{name}: {change} {found:?}");
        }
        if MENDED.contains(&name.trim_end_matches(".txt")) {
            assert_eq!(output.code, Some(0), "{name}\n{}", output.out);
            assert!(!mended.is_empty(), "{name}");
        }
        assert_eq!(mended.is_empty(), folder.bytes("mended.txt") == before, "{name}");
    }
}

#[test]
fn fixing_in_place_reports_the_changes() {
    let (folder, _) = with_broken();
    let output = folder.expect_exit(0, "check wrong-count.group.txt --fix");
    assert!(
        output.out.contains("wrong-count.group.txt:8:9: `numObjects 3` is now `numObjects 2` [wrong-count]"),
        "{}",
        output.out
    );
    assert!(output.out.contains("wrote wrong-count.group.txt"), "{}", output.out);
    assert!(output.out.contains("no findings left"), "{}", output.out);
    // A second run changes nothing.
    let output = folder.expect_exit(0, "check wrong-count.group.txt --fix");
    assert!(!output.out.contains("wrote"), "{}", output.out);
    // A finding without a fix is reported, and the scene stays unchanged.
    let before = folder.bytes("camera-inside.sphere.txt");
    let output = folder.expect_exit(1, "check camera-inside.sphere.txt --fix");
    assert!(output.out.contains("1 warning left"), "{}", output.out);
    assert_eq!(folder.bytes("camera-inside.sphere.txt"), before);
    // A failed write changes nothing.
    let before = folder.bytes("extra-brace.txt");
    let output = folder.run("check extra-brace.txt --fix -o no/such/folder.txt");
    assert_ne!(output.code, Some(0));
    assert!(output.err.contains("does not exist"), "{}", output.err);
    assert_eq!(folder.bytes("extra-brace.txt"), before);
    folder.expect_failure(
        2,
        "check extra-brace.txt scene.txt --fix -o one.txt",
        &["--output can be used with only one scene"],
    );
}

#[test]
fn exit_code_reflects_the_worst_finding() {
    let (folder, _) = with_broken();
    assert!(folder.expect_exit(0, "check scene.txt").out.contains("scene.txt: no findings"));
    // Notes do not change the exit code.
    assert!(folder.expect_exit(0, "check material-index.counted-from-1.txt --fix").out.contains("no findings left"));
    assert!(folder.expect_exit(1, "check scene.txt light-inside.txt").out.contains("[light-inside]"));
    assert!(
        folder.expect_exit(2, "check light-inside.txt no-camera.txt scene.txt").out.contains("scene.txt: no findings")
    );
    let output = folder.expect_exit(2, "check nowhere.txt scene.txt");
    assert!(
        output.err.contains("nowhere.txt") && output.out.contains("scene.txt: no findings"),
        "{}{}",
        output.err,
        output.out
    );
    folder.expect_failure(2, "check nowhere.txt", &["nowhere.txt"]);
    folder.expect_failure(2, "check", &["SCENE"]);
}

#[test]
fn options_affect_the_findings() {
    let folder = TestFolder::new();
    folder.write(
        "back.txt",
        "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 40 }
Lights { numLights 1 DirectionalLight { direction 0 0 -1 color 1 1 1 } }
Materials { numMaterials 1 PhongMaterial { diffuseColor 1 1 1 } }
Group { numObjects 1 MaterialIndex 0 Triangle { vertex0 -1 0 0 vertex1 0 1 0 vertex2 1 0 0 } }
",
    );
    folder.expect_exit(0, "check back.txt");
    // The course's programs do not shade back faces, so this triangle is an error here.
    let output = folder.expect_exit(1, "check back.txt --dialect f04");
    assert!(
        output.out.contains("[seen-from-behind]") && output.out.contains("the back of the object stays black"),
        "{}",
        output.out
    );
    folder.expect_exit(0, "check back.txt --dialect f04 --fix -o front.txt");
    folder.expect_exit(0, "check front.txt --dialect f04");
    folder.expect_exit(0, "check back.txt --dialect f04 --shade-back");

    folder.expect_exit(0, "check scene.txt --depth-range 6 30");
    for range in ["100 200", "0.1 1", "0 100000"] {
        let output = folder.expect_exit(1, &format!("check scene.txt --depth-range {range}"));
        assert!(
            output.out.contains("[depth-range]") && output.out.contains("the picture has depths from"),
            "{}",
            output.out
        );
    }
    let output = folder.expect_exit(1, "check scene.txt --bounces 0");
    assert!(output.out.contains("[no-bounces]"), "{}", output.out);
}

#[test]
fn faulty_picture_is_reported_after_the_render() {
    let (folder, _) = with_broken();
    let render = |scene: &str, more: &str| {
        folder.expect_exit(0, &format!("render {scene} -o p.png --size 40x30 --samples 2 {more}")).err
    };
    let err = render("scene.txt", "");
    assert!(!err.contains("the picture"), "{err}");
    let err = render("camera-away.point.txt", "");
    assert!(err.contains("the picture has only one colour; `durer check` reports:"), "{err}");
    assert!(err.contains("[camera-away]") && err.contains("turn the camera: `direction"), "{err}");
    let err = render("light-divides.txt", "");
    assert!(err.contains("lacks samples") && err.contains("[light-divides]") && err.contains("sample 0"), "{err}");
    let err = render("color-range.light.txt", "");
    assert!(err.contains("the picture is mostly white") && err.contains("[color-range]"), "{err}");
    let err = render("scene.txt", "--exposure -6");
    assert!(err.contains("the picture is nearly black"), "{err}");
    let err = render("scene.txt", "--show depth --depth-range 100 200");
    assert!(err.contains("[depth-range]"), "{err}");
    assert_eq!(render("camera-away.point.txt", "--quiet"), "");

    let course = |scene: &str| folder.expect_exit(0, &format!("course -input {scene} -output p.tga -size 30 30")).err;
    assert!(!course("scene.txt").contains("the picture"));
    // Students judge the brightness themselves, so only pictures of a single colour are reported.
    assert!(!course("color-range.light.txt").contains("the picture"));
    assert!(course("camera-away.point.txt").contains("[camera-away]"));
}

#[test]
fn every_code_is_listed_once() {
    let folder = TestFolder::new();
    let list = folder.expect_exit(0, "check --codes").out;
    let listed: Vec<&str> = list.lines().map(|line| line.split(' ').next().unwrap()).collect();
    let distinct: BTreeSet<&str> = listed.iter().copied().collect();
    assert_eq!(listed.len(), distinct.len());
    let (_, names) = broken();
    let shown: BTreeSet<&str> = names.iter().map(|name| code(name)).collect();
    assert!(shown.is_subset(&distinct), "{:?}", shown.difference(&distinct));
}

/// A finding names the file of an object that does not come from the scene file itself.
#[test]
fn objects_of_other_files_are_named_with_their_file() {
    let folder = TestFolder::new();
    folder.write("parts.txt", "Group { MaterialIndex 0 Sphere { center 0 0 -4 radius 0.2 } }\n");
    folder.write(
        "scene.txt",
        "PerspectiveCamera { center 0 0 8 direction 0 0 -1 up 0 1 0 angle 40 }
Lights { DirectionalLight { direction -1 -1 -1 color 0.9 0.9 0.9 } }
Background { color 0.2 0.2 0.4 ambientLight 0.2 0.2 0.2 }
Materials { PhongMaterial { diffuseColor 0.8 0.5 0.3 } }
Group { MaterialIndex 0 Sphere { center 0 0 0 radius 1.5 }
  include parts.txt
}
",
    );
    let output = folder.run("check scene.txt").out;
    assert!(output.contains("the `Sphere` of line 1 of `parts.txt` is hidden by the `Sphere` of line 5"), "{output}");
}

/// A transform that moves an object out of sight is named, and not the plane or the camera.
#[test]
fn transforms_that_move_objects_out_of_sight_are_named() {
    let folder = TestFolder::new();
    let scene = |object: &str| {
        format!(
            "PerspectiveCamera {{ center 0 1 10 direction 0 -0.1 -1 up 0 1 0 angle 30 }}\nLights {{ DirectionalLight {{ \
             direction -0.5 -1 -0.8 color 0.8 0.8 0.8 }} }}\nBackground {{ color 0.1 0.2 0.4 ambientLight 0.1 0.1 0.1 \
             }}\nMaterials {{ PhongMaterial {{ diffuseColor 0.8 0.2 0.2 }} }}\nGroup {{ MaterialIndex 0\n{object}\nPlane \
             {{ normal 0 1 0 offset -1 }} }}\n"
        )
    };
    let said = |object: &str| {
        folder.write("a.txt", scene(object));
        folder.run("check a.txt").out
    };
    let order = said("Transform { Scale 8 8 8 Translate 0 -1 0 Sphere { center 0 0.125 0 radius 0.125 } }");
    assert!(order.contains("warning[below-plane]") && order.contains("a.txt:6:1"), "{order}");
    assert!(order.contains("in the reverse order, they would move it to 0 0 0"), "{order}");
    assert!(!order.contains("check the `offset`"), "{order}");
    let twice = said("Transform { Translate 3 0 0 Sphere { center 3 0 0 radius 0.9 } }");
    assert!(twice.contains("from 3 0 0 to 6 0 0; without them, it would be in the picture"), "{twice}");
    assert!(twice.contains("a.txt:6:1") && !twice.contains("--fix"), "{twice}");
    let sound = said("Transform { Translate 0 -1 0 Scale 8 8 8 Sphere { center 0 0.125 0 radius 0.125 } }");
    assert!(sound.contains("no findings"), "{sound}");
}

/// An error in a file and the place where the scene names the file are one finding.
#[test]
fn errors_in_files_are_one_finding() {
    let folder = TestFolder::new();
    folder.write("zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n");
    let camera = "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 30 }";
    folder.write("a.txt", format!("Group {{\n  TriangleMesh {{ obj_file zero.obj }}\n}}\n{camera}\n"));
    let output = folder.expect_exit(2, "check a.txt").out;
    assert!(output.starts_with("error[bad-file]: vertex 0 does not exist"), "{output}");
    assert!(output.contains("zero.obj:4:3") && output.contains("a.txt:2:27"), "{output}");
    assert!(output.contains("named here") && output.contains("a.txt: 1 error"), "{output}");
}

/// Stars are too small for the samples that measure the brightness.
#[test]
fn bright_stars_in_a_dark_picture_are_sound() {
    let folder = TestFolder::new();
    let mut group = String::from("Group { MaterialIndex star\n");
    for i in 0..40 {
        group += &format!("Sphere {{ center {} {} -20 radius 0.05 }}\n", (i * 37) % 19 - 9, (i * 23) % 11 - 2);
    }
    let head = "PerspectiveCamera { center 0 2 8 direction 0 0 -1 up 0 1 0 angle 50 }\nBackground { color 0 0 0 }\n\
                Materials { PrincipledMaterial star { baseColor 0 0 0 specularWeight 0 emissionLuminance 3 } }\n";
    folder.write("stars.txt", format!("{head}{group}}}\n"));
    let output = folder.run("check stars.txt --integrator path").out;
    assert!(!output.contains("warning"), "{output}");
}

/// A scene with a box, a floor and a small change.
fn with_change(change: impl Fn(&str) -> String) -> String {
    change(
        "PerspectiveCamera { center 0 2 9 direction 0 -0.15 -1 up 0 1 0 angle 35 }
Lights { DirectionalLight { direction -1 -2 -1 color 0.8 0.8 0.8 } }
Background { color 0.2 0.3 0.4 ambientLight 0.2 0.2 0.2 }
Materials { PhongMaterial paint { diffuseColor 0.8 0.3 0.2 } PhongMaterial floor { diffuseColor 0.5 0.5 0.5 } }
Group { MaterialIndex paint Sphere { center -1.2 1 0 radius 1 }
Box { min 0.4 0 -0.6 max 1.8 1.4 0.8 }
MaterialIndex floor Plane { normal 0 1 0 offset 0 } }
",
    )
}

/// Objects outside the picture are said to be behind the camera or beside the view, and the
/// transform that moves them there is named. Objects in a mirror are visible.
#[test]
fn places_outside_the_picture_are_described() {
    let folder = TestFolder::new();
    let said = |old: &str, new: &str| {
        folder.write("a.txt", with_change(|text| text.replacen(old, new, 1)));
        folder.run("check a.txt").out
    };
    let box_text = "Box { min 0.4 0 -0.6 max 1.8 1.4 0.8 }";
    let behind = said(box_text, "Transform { Translate 1 0 0 Translate 0 0 30 Box { min -1 0 -1 max 1 2 1 } }");
    assert!(behind.contains("21.05 away, behind the camera"), "{behind}");
    assert!(behind.contains("without the translation by 0 0 30, it would be at 1 1 0"), "{behind}");
    assert!(!behind.contains("the camera looks elsewhere"), "{behind}");
    let right = said(box_text, "Box { min 20 0 -1 max 22 2 1 }");
    assert!(right.contains("to the right of the view"), "{right}");
    // The ball behind the camera is seen in a mirror.
    let mirror = "Box { min -3 0 -4 max 3 5 -3.9 } MaterialIndex paint Sphere { center 0 1.5 14 radius 1 }";
    let mirrored = with_change(|text| {
        let text = text.replacen(box_text, &format!("MaterialIndex glass {mirror}"), 1);
        let glass = "Materials { PhongMaterial glass { diffuseColor 0.1 0.1 0.1 reflectiveColor 0.8 0.8 0.8 }";
        text.replacen("Materials {", glass, 1)
    });
    folder.write("a.txt", mirrored);
    let mirrored = folder.run("check a.txt").out;
    assert!(!mirrored.contains("unseen"), "{mirrored}");
    // A wall seen edge-on is not hidden.
    let edge = "Rectangle { corner -3 0 -2 edge0 6 0 0 edge1 0 2 0 }";
    folder.write(
        "a.txt",
        with_change(|text| {
            let above = "OrthographicCamera { center 0 9 0 direction 0 -1 0 up 0 0 -1 size 8 }";
            let camera = "PerspectiveCamera { center 0 2 9 direction 0 -0.15 -1 up 0 1 0 angle 35 }";
            text.replacen(camera, above, 1).replacen(box_text, edge, 1)
        }),
    );
    let above = folder.run("check a.txt").out;
    assert!(!above.contains("is hidden by"), "{above}");
}

/// Values that come from options are not blamed on the file.
#[test]
fn values_of_options_are_not_blamed_on_the_file() {
    let folder = TestFolder::new();
    folder.write("a.txt", with_change(str::to_string));
    let inside = folder.run("check a.txt --eye -1.2,1,0.5").out;
    assert!(
        inside.contains("[camera-inside]") && inside.contains("an option such as `--eye` sets this value"),
        "{inside}"
    );
    assert!(inside.contains("`--eye ") && !inside.contains("`center "), "{inside}");
    assert!(!inside.contains("a.txt:1:28"), "{inside}");
    folder.write("a.txt", with_change(|text| text.replacen("center 0 2 9", "center -1.2 1 0.5", 1)));
    let inside = folder.run("check a.txt").out;
    assert!(inside.contains("a.txt:1:28") && inside.contains("`center "), "{inside}");
}

/// Materials are called by their names, and one mistake causes one error.
#[test]
fn names_of_materials_are_used() {
    let folder = TestFolder::new();
    folder.write("a.txt", with_change(|text| text.replacen("MaterialIndex paint", "MaterialIndex floor", 1)));
    let unused = folder.run("check a.txt").out;
    assert!(unused.contains("no object uses material `paint`"), "{unused}");
    let late = with_change(|text| text.replacen("Box {", "use post Box {", 1))
        + "define post Cylinder { base 0 0 0 top 0 1 0 radius 1 }\n";
    folder.write("b.txt", late);
    let late = folder.run("check b.txt").out;
    assert!(late.contains("nothing is defined as `post`") && late.contains("b.txt: 1 error"), "{late}");
    let rough = "PrincipledMaterial paint { baseColor 0.8 0.3 0.2 roughness 0.4 }";
    folder.write(
        "c.txt",
        with_change(|text| text.replacen("PhongMaterial paint { diffuseColor 0.8 0.3 0.2 }", rough, 1)),
    );
    let rough = folder.run("check c.txt").out;
    assert!(rough.contains("did you mean `specularRoughness`?"), "{rough}");
}

/// A room in haze with a spotlight, for the cases below.
const STAGE: &str = "PerspectiveCamera { center 0 1.7 8 direction 0 0 -1 up 0 1 0 angle 45 }
Background { color 0 0 0 }
Fog { extinction 0.05 color 0.9 0.9 0.9 min -4 0 -4 max 4 5 5 }
Lights { SpotLight { position -2.5 4.5 1 direction 2.5 -4.5 -1 color 60 55 45 angle 18 innerAngle 12 } }
Materials {
  PrincipledMaterial boards { baseColor 0.35 0.25 0.18 specularRoughness 0.5 }
  PrincipledMaterial glass { transmissionWeight 1 specularRoughness 0 }
  PrincipledMaterial actor { baseColor 0.7 0.65 0.6 }
}
Group {
  MaterialIndex boards Box { min -4 -0.2 -4 max 4 0 4 }
  MaterialIndex actor Box { min -0.3 0 -0.3 max 0.3 1.4 0.3 } Sphere { center 0 1.65 0 radius 0.25 }
  MaterialIndex glass Sphere { center 2 0.5 0 radius 0.5 }
}
";

#[test]
fn causes_in_a_stage_are_named() {
    let folder = TestFolder::new();
    let lens = "ThinLensCamera { center 0 1.7 8 direction 0 0 -1 up 0 1 0 angle 0.785 aperture 0.01 focusDistance 8 }";
    let camera = "PerspectiveCamera { center 0 1.7 8 direction 0 0 -1 up 0 1 0 angle 45 }";
    for (from, to, expected) in [
        ("specularRoughness 0 }", "specularRoughness 0", "[unclosed-block]"),
        ("center 2 0.5 0 radius 0.5", "center 0 1.7 8 radius 0.5", "[camera-inside]"),
        (camera, lens, "[too-narrow]"),
        ("color 0.9 0.9 0.9", "color 0 0 0", "[black-fog]"),
    ] {
        assert_eq!(STAGE.matches(from).count(), 1, "{from}");
        folder.write("stage.txt", STAGE.replace(from, to));
        let output = folder.run("check stage.txt");
        let all = output.out + &output.err;
        assert!(all.contains(expected), "{from} => {to}\n{all}");
    }
    folder.write("stage.txt", STAGE);
    let output = folder.expect_exit(0, "check stage.txt").out;
    assert!(output.contains("no findings"), "{output}");
}

/// The help of a finding fits the mistake, and nothing else is blamed.
#[test]
fn help_fits_the_mistake() {
    let folder = TestFolder::new();
    let said = |text: &str, options: &str| {
        folder.write("a.txt", text);
        folder.run(&format!("check a.txt {options}")).out
    };
    let scene = |camera: &str, rest: &str, material: &str, object: &str| {
        format!(
            "PerspectiveCamera {{ {camera} up 0 1 0 angle 35 }}\n{rest}\nMaterials {{ {material} }}\nGroup {{ \
             MaterialIndex 0 Sphere {{ center 0 1 0 radius 1 }} Plane {{ normal 0 1 0 offset 0 }} {object} }}\n"
        )
    };
    let (view, layered) = ("center 0 2 9 direction 0 -0.15 -1", "PrincipledMaterial { baseColor 0.6 0.6 0.6 }");
    // An axis is a direction and not a point, if its negation is right.
    let photometry = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 30\n0 45 90\n0\n1300 900 0\n";
    folder.write("lamp.ies", photometry);
    let up = "Lights { PhotometricLight { position 0.3 5 0.2 file lamp.ies direction 0 1 0 } }";
    let lamp = said(&scene(view, up, layered, ""), "--integrator path");
    assert!(lamp.contains("negate the direction: write `direction 0 -1 0`"), "{lamp}");
    // The time zone or the sign of the longitude is wrong.
    let place = "Background { latitude 35.7 longitude -139.7 date 2024 6 21 time 16 0 0 timeZone 9 }";
    let sun = said(&scene(view, place, layered, ""), "--integrator path --exposure -14");
    assert!(sun.contains("try `timeZone -9`, or `longitude 139.7`"), "{sun}");
    // The camera's direction is a position.
    let lights = "Lights { DirectionalLight { direction -1 -2 -1 color 1 1 1 } }";
    let phong = "PhongMaterial { diffuseColor 0.6 0.6 0.6 }";
    let inside = said(&scene("center 0.1 1 -0.1 direction 1 3 12", lights, phong, ""), "");
    assert!(inside.contains("write `center 1 3 12`"), "{inside}");
    // The ground is too high, and an object far too large.
    let ball = |center: &str| format!("Sphere {{ center {center} radius 800 }}");
    let low = said(&scene(view, lights, phong, &ball("0 -790 0")), "");
    assert!(low.contains("lower it by 10") && low.contains("at 0 -800 0") && low.contains("a.txt:4:"), "{low}");
    let large = said(&scene(view, lights, phong, &ball("0 0 0")), "--shadows=on");
    assert!(large.contains("are inside the `Sphere`") && !large.contains("move the camera"), "{large}");
    // A flat object is not hidden by a plane.
    let text = scene(view, lights, phong, "Transform { Scale 1 0 1 Box { min -3 0 -1 max -2 1 1 } }");
    let flat = said(&text, "--dialect f16");
    assert!(flat.contains("flat-transform") && !flat.contains("unseen"), "{flat}");
    // An invalid value comes before its consequences.
    let text = scene(view, lights, "Material { diffuseColor 1 1 1 specularColor 1 1 1 shininess -8 }", "");
    let negative = said(&text, "--dialect f16");
    assert!(!negative.contains("pow-zero") && !negative.contains("too-bright"), "{negative}");
    let [value, sample] = ["bad-value", "not-finite"].map(|code| negative.find(code));
    assert!(value.is_some() && (sample.is_none() || value < sample), "{negative}");
}
