//! Tests the help, the manual page, `durer dialects`, `durer words` and `durer info`.

mod common;

use common::{SCENE, TestFolder};

#[test]
fn help_has_examples() {
    let place = TestFolder::new();
    for command in ["", "render", "info", "convert", "compare", "dialects", "words", "completions", "man"] {
        let help = place.expect_exit(0, &format!("{command} --help"));
        assert!(help.out.contains("Example") && help.out.contains("\n  durer "), "{command}: {}", help.out);
    }
    assert!(place.expect_exit(0, "help course").out.contains("Example"));
    assert!(place.expect_exit(0, "course -help").out.contains("  durer course -input"));
}

#[test]
fn manual_completions_and_dialects() {
    let place = TestFolder::new();
    let man = place.expect_exit(0, "man").out;
    assert!(man.contains(".TH durer") && man.contains("durer-render") && man.contains("depth"));
    for shell in ["bash", "zsh", "fish"] {
        assert!(place.expect_exit(0, &format!("completions {shell}")).out.contains("transfer"), "{shell}");
    }
    place.refused(2, "completions tcl", &["bash"]);
    let dialects = place.expect_exit(0, "dialects").out;
    for dialect in durer::dialect::Dialect::ALL {
        assert!(dialects.contains(&format!("  {}", dialect.name())));
    }
    for (_, name, _) in durer::dialect::Quirk::ALL {
        assert!(dialects.contains(&format!("\n  {name} ")), "{name}");
    }
}

#[test]
fn info_as_text_and_json() {
    let place = TestFolder::new();
    let text = place.expect_exit(0, "info scene.txt").out;
    let words =
        ["dialect    f04", "PerspectiveCamera", "DirectionalLight", "1 Plane, 1 Sphere", "materials  2", "rays     "];
    for word in words {
        assert!(text.contains(word), "{word}: {text}");
    }
    let output = place.expect_exit(0, "info scene.txt --json");
    assert_eq!(output.err, "");
    let json: serde_json::Value = serde_json::from_str(&output.out).unwrap();
    assert_eq!(
        (json["dialect"].as_str(), json["objects"].as_u64(), json["lights"].as_u64()),
        (Some("f04"), Some(2), Some(1))
    );
    assert!(json["scene"].is_object() && json["nodes_per_ray"].as_f64().is_some());
    assert!(json["tree_cost"].is_null(), "the scene has no mesh");
    place.put("ball.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    place.put(
        "mesh.txt",
        SCENE
            .replacen("Plane {", "TriangleMesh { obj_file ball.obj } Plane {", 1)
            .replace("numObjects 2", "numObjects 3"),
    );
    let json: serde_json::Value = serde_json::from_str(&place.expect_exit(0, "info mesh.txt --json").out).unwrap();
    // The tree is a single leaf: the root and one box of equal size. Three vertices take 36 bytes,
    // an index 4, a node 256, and the padding of a leaf 320.
    assert_eq!((json["tree_cost"].as_f64(), json["bytes_per_triangle"].as_f64()), (Some(2.0), Some(616.0)));
}

#[test]
fn converted_scene_is_the_same() {
    let place = TestFolder::new();
    place.put("commented.txt", format!("# a comment\n{SCENE}"));
    for (from, options) in [("scene.txt", ""), ("scene.txt", "--to durer"), ("commented.txt", "")] {
        place.expect_exit(0, &format!("convert {from} -o again.txt {options}"));
        place.expect_exit(0, &format!("render {from} --dialect durer --size 40x40 -o a.pfm"));
        place.expect_exit(0, "render again.txt --dialect durer --size 40x40 -o b.pfm");
        assert!(place.bytes("a.pfm") == place.bytes("b.pfm"), "{from} {options}");
        place.expect_exit(0, &format!("convert again.txt -o twice.txt {options}"));
        assert_eq!(place.bytes("again.txt"), place.bytes("twice.txt"));
    }
    // An input is never overwritten.
    let before = place.bytes("again.txt");
    place.refused(2, "convert again.txt -o again.txt", &["again.txt", "is an input of this run"]);
    assert_eq!(place.bytes("again.txt"), before);
}

#[test]
fn words_are_looked_up() {
    let place = TestFolder::new();
    let all = place.expect_exit(0, "words").out;
    for word in ["PerspectiveCamera", "PointLight", "PhongMaterial", "Sphere", "Difference", "Transform", "numObjects"]
    {
        assert!(all.contains(&format!("  {word} ")), "{word} is not in\n{all}");
    }
    let light = place.expect_exit(0, "words pointlight").out;
    for part in ["f23", "position", "required", "falloff", "Example:\n    PointLight {"] {
        assert!(light.contains(part), "{part} is not in\n{light}");
    }
    // The entry of a field names the blocks that have it; a dialect lists only its own words.
    assert!(place.expect_exit(0, "words radius").out.contains("in Sphere\n"));
    assert!(!place.expect_exit(0, "words --dialect f04").out.contains("Torus"));
    place.refused(2, "words Spere", &["did you mean `Sphere`?"]);
    place.refused(2, "words Torus --dialect f04", &["the dialect `f04`"]);
    place.refused(2, "words --dialect f99", &["f99", "f23"]);
}
