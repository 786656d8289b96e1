//! Tests with external files. They cover the command lines of the official pictures, and the
//! conversion of scenes and models.

use crate::common::{TestFolder, corpus};
use std::collections::BTreeSet;

const MODELS: [&str; 7] = [
    "TextureTransformTest/glTF/TextureTransformTest.gltf",
    "MultiUVTest/glTF-Binary/MultiUVTest.glb",
    "BoxVertexColors/glTF-Binary/BoxVertexColors.glb",
    "NormalTangentMirrorTest/glTF-Binary/NormalTangentMirrorTest.glb",
    "RiggedSimple/glTF-Binary/RiggedSimple.glb",
    "AlphaBlendModeTest/glTF-Binary/AlphaBlendModeTest.glb",
    "SimpleInstancing/glTF/SimpleInstancing.gltf",
];

#[test]
fn year_of_every_official_command_is_guessed() {
    let Some(course) = corpus() else { return };
    let place = TestFolder::new();
    let table = std::fs::read_to_string(course.join("reference.csv")).unwrap();
    let rows: BTreeSet<(&str, &str)> = table
        .lines()
        .skip(1)
        .filter_map(|line| {
            let columns: Vec<&str> = line.splitn(6, ',').collect();
            Some((columns[1], *columns.get(5)?)).filter(|row| !row.1.is_empty())
        })
        .collect();
    assert!(rows.len() > 150, "{} rows", rows.len());
    let mut wrong = Vec::new();
    for (dialect, arguments) in rows {
        // The pictures are written to the test's folder and are four pixels wide.
        let mut words: Vec<String> = arguments.split_whitespace().map(str::to_string).collect();
        for i in 0..words.len() {
            if [".tga", ".bmp", ".png"].iter().any(|ending| words[i].ends_with(ending)) {
                words[i] = place.path(&words[i]).display().to_string();
            } else if words[i] == "-size" {
                (words[i + 1], words[i + 2]) = ("4".into(), "4".into());
            }
        }
        // The guessed dialect produces the same pictures as the named dialect.
        let pictures = |named: &[&str]| {
            let mut command = place.command("course");
            let folder = course.join("scenes").join(dialect);
            let output = command.args(&words).args(named).current_dir(folder).output().unwrap();
            let err = String::from_utf8_lossy(&output.stderr).into_owned();
            let made = words.iter().filter(|word| std::path::Path::new(word).is_absolute());
            let bytes: Vec<_> = made.map(std::fs::read).filter_map(Result::ok).collect();
            (output.status.success() && !bytes.is_empty()).then_some(bytes).ok_or(err)
        };
        let [guessed, named] = [&[][..], &["--dialect", dialect]].map(pictures);
        if guessed.is_err() || guessed != named {
            wrong.push(format!("{dialect}: {arguments}\n  {}", guessed.err().unwrap_or_default()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn models_converted_to_text_render_the_same_picture() {
    let Some(course) = corpus() else { return };
    let models = course.join("../samples/gltf/khronos");
    let folder = TestFolder::new();
    // Models with transformed and repeated textures, vertex colours, tangents, skins, thin films,
    // glass and instances.
    for name in MODELS {
        let model = models.join(name);
        let picture = |path: &str| {
            folder.expect_exit(
                0,
                &format!("render {path} -o a.ppm --integrator path --size 24x24 --samples 4 -q --restart"),
            );
            std::fs::read(folder.path("a.ppm")).unwrap()
        };
        let first = picture(&model.display().to_string());
        for written in ["text.txt", "tree.json"] {
            folder.expect_exit(0, &format!("convert {} -o {written}", model.display()));
            assert!(picture(written) == first, "{name} as {written}");
        }
    }
}

#[test]
fn converted_scenes_render_the_same_picture() {
    let Some(course) = corpus() else { return };
    let place = TestFolder::new();
    let mut count = 0;
    for dialect in ["f04", "f12a4", "f12a5", "f16", "f23"] {
        let folder = course.join("scenes").join(dialect);
        let mut scenes: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path()).collect();
        scenes.retain(|path| {
            // Scenes that contain splines use another file format.
            let name = path.file_name().unwrap().to_string_lossy();
            name.ends_with(".txt") && !name.starts_with("spline")
        });
        scenes.sort();
        for scene in scenes.iter().step_by(3) {
            let assets = format!("--dialect {dialect} --assets {} --quiet", folder.display());
            let path = scene.display();
            let convert = place.expect_exit(0, &format!("convert {path} -o again.txt --dialect {dialect}"));
            assert!(convert.out.contains("wrote again.txt"));
            let render = |scene: &str, name: &str| {
                let output = place.run(&format!("render {scene} {assets} --allow-outside --size 24x24 -o {name}"));
                (output.code, output.err.is_empty())
            };
            let first = render(&path.to_string(), "first.pfm");
            if first.0 != Some(0) {
                println!("not all files of {path} are here");
                continue;
            }
            assert_eq!(first, render("again.txt", "again.pfm"), "{path}");
            assert!(place.bytes("first.pfm") == place.bytes("again.pfm"), "{path}");
            count += 1;
        }
    }
    assert!(count > 20, "{count} scenes");
}
