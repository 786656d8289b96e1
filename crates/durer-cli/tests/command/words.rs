//! Tests the help, the manual page, `durer dialects`, `durer words` and `durer info`.

use crate::common::{SCENE, TestFolder};

#[test]
fn help_has_examples() {
    let folder = TestFolder::new();
    for command in ["", "render", "info", "convert", "compare", "dialects", "words", "completions", "man"] {
        let help = folder.expect_exit(0, &format!("{command} --help"));
        assert!(help.out.contains("Example") && help.out.contains("\n  durer "), "{command}: {}", help.out);
    }
    assert!(folder.expect_exit(0, "help course").out.contains("Example"));
    assert!(folder.expect_exit(0, "course -help").out.contains("  durer course -input"));
}

#[test]
fn manual_completions_and_dialects() {
    let folder = TestFolder::new();
    let man = folder.expect_exit(0, "man").out;
    assert!(man.contains(".TH durer") && man.contains("durer\\-render(1)"), "{man}");
    let render = folder.expect_exit(0, "man render").out;
    assert!(render.contains(".TH durer-render") && render.contains("photon\\-radius"), "{render}");
    folder.expect_failure(2, "man rendre", &["there is no command `rendre`", "render"]);
    folder.expect_exit(0, "man --folder pages");
    assert_eq!(std::fs::read_to_string(folder.path("pages/durer-render.1")).unwrap().trim_end(), render.trim_end());
    for shell in ["bash", "zsh", "fish"] {
        assert!(folder.expect_exit(0, &format!("completions {shell}")).out.contains("transfer"), "{shell}");
    }
    folder.expect_failure(2, "completions tcl", &["bash"]);
    let dialects = folder.expect_exit(0, "dialects").out;
    for dialect in durer::dialect::Dialect::ALL {
        assert!(dialects.contains(&format!("  {}", dialect.name())));
    }
    for (_, name, _) in durer::dialect::Quirk::ALL {
        assert!(dialects.contains(&format!("\n  {name} ")), "{name}");
    }
}

#[test]
fn words_are_found_as_people_write_them() {
    let folder = TestFolder::new();
    for (asked, found) in [
        ("point light", "PointLight ("),
        ("spot-light", "SpotLight"),
        ("cube", "\n  Box "),
        ("IES", "PhotometricLight"),
        ("AreaLight", "emissionLuminance"),
        ("softshadow", "DirectionalLight: spread"),
        ("--all --dialect f04", "PhongMaterial"),
    ] {
        let output = folder.expect_exit(0, &format!("words {asked}")).out;
        assert!(output.contains(found), "{asked}: {output}");
        assert!(asked != "IES" || !output.contains("multiplies"), "{output}");
    }
    assert!(!folder.expect_exit(0, "words --all --dialect f04").out.contains("\nPrincipledMaterial"));
}

#[test]
fn info_as_text_and_json() {
    let folder = TestFolder::new();
    let text = folder.expect_exit(0, "info scene.txt").out;
    let words =
        ["dialect    f04", "PerspectiveCamera", "DirectionalLight", "1 Plane, 1 Sphere", "materials  2", "rays     "];
    for word in words {
        assert!(text.contains(word), "{word}: {text}");
    }
    let output = folder.expect_exit(0, "info scene.txt --json");
    assert_eq!(output.err, "");
    let json: serde_json::Value = serde_json::from_str(&output.out).unwrap();
    assert_eq!(
        (json["dialect"].as_str(), json["objects"].as_u64(), json["lights"].as_u64()),
        (Some("f04"), Some(2), Some(1))
    );
    assert!(json["scene"].is_object() && json["nodes_per_ray"].as_f64().is_some());
    assert!(json["tree_cost"].is_null(), "the scene has no mesh");
    folder.write("ball.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write(
        "mesh.txt",
        SCENE
            .replacen("Plane {", "TriangleMesh { obj_file ball.obj } Plane {", 1)
            .replace("numObjects 2", "numObjects 3"),
    );
    let json: serde_json::Value = serde_json::from_str(&folder.expect_exit(0, "info mesh.txt --json").out).unwrap();
    // The tree is a single leaf, so it has the root and one box of equal size. The three vertices
    // take 36 bytes, an index takes 4, a node takes 256, and the padding of a leaf takes 320.
    assert_eq!((json["tree_cost"].as_f64(), json["bytes_per_triangle"].as_f64()), (Some(2.0), Some(616.0)));
}

#[test]
fn converted_scene_is_the_same() {
    let folder = TestFolder::new();
    folder.write("commented.txt", format!("# a comment\n{SCENE}"));
    for (from, options) in [("scene.txt", ""), ("scene.txt", "--to durer"), ("commented.txt", "")] {
        folder.expect_exit(0, &format!("convert {from} -o again.txt {options}"));
        folder.expect_exit(0, &format!("render {from} --dialect durer --size 40x40 -o a.pfm"));
        folder.expect_exit(0, "render again.txt --dialect durer --size 40x40 -o b.pfm");
        assert!(folder.bytes("a.pfm") == folder.bytes("b.pfm"), "{from} {options}");
        folder.expect_exit(0, &format!("convert again.txt -o twice.txt {options}"));
        assert_eq!(folder.bytes("again.txt"), folder.bytes("twice.txt"));
    }
    // An input file is never overwritten.
    let before = folder.bytes("again.txt");
    folder.expect_failure(2, "convert again.txt -o again.txt", &["again.txt", "is an input of this run"]);
    assert_eq!(folder.bytes("again.txt"), before);
}

#[test]
fn words_are_looked_up() {
    let folder = TestFolder::new();
    let all = folder.expect_exit(0, "words").out;
    for word in ["PerspectiveCamera", "PointLight", "PhongMaterial", "Sphere", "Difference", "Transform", "numObjects"]
    {
        assert!(all.contains(&format!("  {word} ")), "{word} is not in\n{all}");
    }
    let light = folder.expect_exit(0, "words pointlight").out;
    for part in ["f23", "position", "required", "falloff", "Example:\n    PointLight {"] {
        assert!(light.contains(part), "{part} is not in\n{light}");
    }
    // The entry for a field names the blocks that have the field, and a dialect lists only its own
    // words.
    assert!(folder.expect_exit(0, "words radius").out.contains("in Sphere\n"));
    assert!(!folder.expect_exit(0, "words --dialect f04").out.contains("Torus"));
    folder.expect_failure(2, "words Spere", &["did you mean `Sphere`?"]);
    folder.expect_failure(2, "words Torus --dialect f04", &["the dialect `f04`"]);
    folder.expect_failure(2, "words --dialect f99", &["f99", "f23"]);
}

#[test]
fn terms_lead_to_words() {
    let folder = TestFolder::new();
    for (term, word) in [
        ("glass", "refractionIndex"),
        ("lens", "aperture"),
        ("ies", "PhotometricLight"),
        ("area light", "emissionLuminance"),
        ("refraction", "indexOfRefraction"),
        ("depth of field", "focusDistance"),
        ("csg", "Difference"),
        ("hdri", "environment"),
    ] {
        let mut command = folder.command("words");
        let output = command.arg(term).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success() && text.contains(word), "{term}: {text}");
    }
    for (term, part) in [
        ("supersampling", "--samples 64"),
        ("antialiasing", "--samples 64"),
        ("daylight factor", "docs/light.md"),
        ("transparent background", "--background transparent"),
        ("UGR", "--ugr EYE:TARGET"),
        ("statistics", "--stats=FILE.json"),
        ("glass", "PrincipledMaterial { preset glass }"),
        ("mirror", "PrincipledMaterial { preset silver"),
    ] {
        let output = folder.command("words").arg(term).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success() && text.contains(part), "{term}: {text}");
    }
    let list = folder.expect_exit(0, "words").out;
    assert_eq!(list.matches("\n  Noise ").count(), 1, "{list}");
    folder.expect_failure(2, "words Spehre", &["did you mean `Sphere`?"]);
    folder.expect_failure(2, "words xyzzyx", &["lists them all"]);
}

#[test]
fn info_of_a_luminaire() {
    let folder = TestFolder::new();
    // Lambert's law with a peak of 1000 cd: the flux is 1000 pi lm, or 3141.6 lm,
    // of which linear interpolation between whole degrees loses 0.003 %.
    let angles: Vec<String> = (0..=90).map(|angle| angle.to_string()).collect();
    let candela: Vec<String> =
        (0..=90).map(|angle| (1000.0 * durer::math::fp::sin_cos_degrees(f64::from(angle)).1).to_string()).collect();
    let file = format!(
        "IESNA:LM-63-2002\n[MANUFAC] Test \u{1b}[2J\n[LUMINAIRE] Panel <1>\nTILT=NONE\n1 4000 1 91 1 1 2 0 0 0\n1 1 40\n{}\n0\n{}\n",
        angles.join(" "),
        candela.join(" ")
    );
    folder.write("panel.ies", &file);
    let text = folder.expect_exit(0, "info panel.ies --polar panel.svg").out;
    for line in [
        "luminaire    Panel <1>\n",
        "format       IES LM-63, type C, 91 vertical and 1 horizontal angles\n",
        "flux         3141.5 lm, 100.0 % of it downwards\n",
        "sources      4000.0 lm; light output ratio 78.5 %\n",
        "power        40.0 W; luminous efficacy 78.5 lm/W\n",
        "peak         1000.0 cd at vertical angle 0, horizontal angle 0\n",
        "beam         120.0 degrees in plane 0-180, 120.0 degrees in plane 90-270 (half of the maximum)\n",
        "wrote panel.svg\n",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    assert!(!text.contains('\u{1b}'));
    let svg = std::fs::read_to_string(folder.path("panel.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("Panel &lt;1&gt;") && svg.ends_with("</svg>\n"));
    let json: serde_json::Value = serde_json::from_str(&folder.expect_exit(0, "info panel.ies --json").out).unwrap();
    assert!((json["efficacy_lm_per_w"].as_f64().unwrap() - 78.54).abs() < 0.02);
    folder.expect_failure(2, "info scene.txt --polar panel.svg", &["--polar needs a photometric file"]);
    folder.expect_failure(2, "info panel.ies --polar panel.png", &["must end in .svg"]);
    assert!(!folder.path("panel.png").exists());
    folder.expect_failure(2, "info none.ies", &["none.ies"]);
    folder.write("broken.ies", file.replace("TILT=NONE", ""));
    folder.expect_failure(2, "info broken.ies", &["broken.ies:1:1", "TILT="]);
    folder.expect_failure(2, "info panel.ies --polar panel.ies", &["panel.ies"]);
}

#[test]
fn conversion_does_not_touch_files_of_other_scenes() {
    let folder = TestFolder::new();
    folder.write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("two.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n");
    folder.expect_exit(0, "convert one.obj -o d.usda");
    folder.expect_exit(0, "convert one.obj -o d.xml");
    let names = std::fs::read_dir(folder.path("d")).unwrap().map(|entry| entry.unwrap().path());
    let before: Vec<_> = names.map(|path| (std::fs::read(&path).unwrap(), path)).collect();
    folder.expect_failure(2, "convert two.obj -o d.xml", &["d/", "may belong to another scene"]);
    assert!(before.iter().all(|(bytes, path)| std::fs::read(path).unwrap() == *bytes));
    std::fs::remove_file(folder.path("d.usda")).unwrap();
    folder.expect_exit(0, "convert two.obj -o d.xml");
}

#[test]
fn conversion_warns_of_words_that_the_dialect_lacks() {
    let folder = TestFolder::new();
    folder.write(
        "torus.txt",
        SCENE.replace("Sphere { center 0 0.5 0 radius 1 }", "Torus { center 0 0 0 majorRadius 1 minorRadius 0.2 }"),
    );
    let output = folder.expect_exit(0, "convert torus.txt -o old.txt --to f04");
    assert!(output.err.contains("`Torus` is not a word of f04"), "{}", output.err);
    assert!(!folder.expect_exit(0, "convert scene.txt -o same.txt --to f04").err.contains("no-counterpart"));
}

#[test]
fn converted_scene_is_read_in_its_dialect() {
    let folder = TestFolder::new();
    folder.expect_exit(0, "convert scene.txt -o ours.txt --to durer");
    let info = folder.expect_exit(0, "info ours.txt").out;
    assert!(info.contains("dialect    durer"), "{info}");
    folder.write("plain.txt", SCENE.replace("reflectiveColor 0.5 0.5 0.5", ""));
    let output = folder.expect_exit(0, "convert plain.txt -o plain16.txt --to f16");
    let read = folder.expect_exit(0, "info plain16.txt").out;
    let is_known = read.contains("dialect    f16");
    assert!(is_known || output.err.contains("render it with `--dialect f16`"), "{read} {}", output.err);
}

#[test]
fn conversion_to_another_folder_warns_of_files_left_behind() {
    let folder = TestFolder::new();
    folder.write("ball.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write(
        "mesh.txt",
        SCENE.replacen("Sphere { center 0 0.5 0 radius 1 }", "TriangleMesh { obj_file ball.obj }", 1),
    );
    std::fs::create_dir(folder.path("other")).unwrap();
    let output = folder.expect_exit(0, "convert mesh.txt -o other/mesh.txt");
    assert!(output.err.contains("ball.obj") && output.err.contains("--assets"), "{}", output.err);
    assert!(!folder.expect_exit(0, "convert mesh.txt -o again.txt").err.contains("--assets"));
}

#[test]
fn info_measures_the_surface_of_meshes() {
    let folder = TestFolder::new();
    folder.write("open.obj", "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
    assert!(folder.expect_exit(0, "info open.obj").out.contains("surface    open at 3 edges, area 1"));
    let corners = "v 0 0 0\nv 6 0 0\nv 0 1 0\nv 0 0 1\n";
    folder.write("closed.obj", format!("{corners}f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
    let output = folder.expect_exit(0, "info closed.obj").out;
    assert!(output.contains("surface    closed, area") && output.contains("volume 1\n"), "{output}");
    let json: serde_json::Value = serde_json::from_str(&folder.expect_exit(0, "info closed.obj --json").out).unwrap();
    assert_eq!((json["volume"].as_f64(), json["open_edges"].as_u64()), (Some(1.0), Some(0)));
    assert_eq!(json["bounds"], serde_json::json!([[0.0, 0.0, 0.0], [6.0, 1.0, 1.0]]));
}
