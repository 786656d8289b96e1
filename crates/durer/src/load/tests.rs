use super::*;
use durer_diag::{Diagnostic, Severity};
use std::fs;

const CAMERA: &str = "PerspectiveCamera { center 0 0 10 direction 0 0 -1 up 0 1 0 angle 30 }\n";
const LIGHT: &str = "Lights { numLights 1 DirectionalLight { direction 0 0 -1 color 1 1 1 } }\n";
const MATERIAL: &str = "Materials { numMaterials 1 PhongMaterial { diffuseColor 1 1 1 } }\n";
const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Writes a scene with these objects and a mesh `tri.obj` to a folder `scene`.
fn house(objects: &str) -> tempfile::TempDir {
    let root = tempfile::tempdir().unwrap();
    fs::create_dir(root.path().join("scene")).unwrap();
    fs::write(root.path().join("scene/tri.obj"), TRIANGLE).unwrap();
    fs::write(root.path().join("outside.obj"), TRIANGLE).unwrap();
    let text = format!("{CAMERA}{LIGHT}{MATERIAL}Group {{ MaterialIndex 0\n{objects}\n}}\n");
    fs::write(root.path().join("scene/scene.txt"), text).unwrap();
    root
}

/// Loads and compiles the scene. Returns the world and the diagnostics in the form
/// `file:line:column severity: message (help)`, with paths relative to `root`.
fn load_world(root: &tempfile::TempDir, options: &LoadOptions) -> (Option<World>, Vec<String>) {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let path = root.path().join("scene/scene.txt");
    let loaded = load(&path, options, &mut files, &mut diagnostics).unwrap();
    let world = loaded.and_then(|loaded| loaded.compile(options, &mut files, &mut diagnostics));
    assert_eq!(world.is_none(), diagnostics.has_errors());
    let line = |d: &Diagnostic| {
        let place = d.span.map_or("-".into(), |span| {
            let (line, column) = files.position(span).unwrap();
            format!("{}:{line}:{column}", files.name(span.file).unwrap())
        });
        let severity = if d.severity == Severity::Error { "error" } else { "warning" };
        let help = d.help.as_ref().map_or(String::new(), |help| format!(" ({help})"));
        format!("{place} {severity}: {}{help}", d.message).replace(&format!("{}/", root.path().display()), "")
    };
    (world, diagnostics.iter().map(line).collect())
}

fn findings(objects: &str) -> Vec<String> {
    load_world(&house(objects), &LoadOptions::default()).1
}

fn mesh(path: &str) -> String {
    format!("TriangleMesh {{ obj_file {path} }}")
}

#[test]
fn mesh_is_found_beside_its_scene() {
    for path in ["tri.obj", ".\\tri.obj", "../scene/tri.obj"] {
        let (world, findings) = load_world(&house(&mesh(path)), &LoadOptions::default());
        assert_eq!(findings, [""; 0]);
        assert_eq!(world.unwrap().objects().len(), 1);
    }
}

#[test]
fn file_outside_is_refused_at_the_line_that_names_it() {
    let root = house(&mesh("../outside.obj"));
    let (_, found) = load_world(&root, &LoadOptions::default());
    assert_eq!(
        found,
        [
            "scene/scene.txt:5:25 error: the mesh cannot be read: `../outside.obj` is outside the scene's folder (a scene \
          can only use files in or below its own folder, unless `--allow-outside` is given)"
        ]
    );
    let (world, found) = load_world(&root, &LoadOptions { allow_outside: true, ..Default::default() });
    assert!(world.is_some() && found.is_empty(), "{found:?}");
    let (world, found) = load_world(
        &house(&mesh("outside.obj")),
        &LoadOptions { assets: vec![root.path().into()], ..Default::default() },
    );
    assert!(world.is_some() && found.is_empty(), "{found:?}");
}

#[test]
fn missing_mesh_is_reported_once_with_a_similar_name() {
    let found = findings(&(mesh("tir.obj") + "\n").repeat(100));
    assert_eq!(
        found,
        ["scene/scene.txt:5:25 error: the mesh cannot be read: the file `tir.obj` does not exist (did you \
          mean `tri.obj`? Looked for scene/tir.obj)"]
    );
    // Thousands of missing meshes are reported quickly.
    let many: String = (0..20_000).map(|i| mesh(&format!("{i}.obj"))).collect();
    assert_eq!(findings(&many).len(), 20);
}

#[test]
fn mesh_error_is_reported_in_the_mesh() {
    let root = house(&mesh("bad.obj"));
    fs::write(root.path().join("scene/bad.obj"), "v 0 0 0\nv 1 0 zero\nf 1 2 9\n").unwrap();
    let (_, found) = load_world(&root, &LoadOptions::default());
    // The first error also names the place in the scene.
    assert!(found[0].starts_with("bad.obj:2:7 error: "), "{found:?}");
    assert!(found.iter().all(|found| found.starts_with("bad.obj:")), "{found:?}");
}

#[test]
fn folder_is_not_a_mesh() {
    let found = findings(&mesh("."));
    assert_eq!(found, ["scene/scene.txt:5:25 error: the mesh cannot be read: `.` is not a regular file"]);
}

#[test]
fn unreadable_scene_is_a_separate_error() {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let root = tempfile::tempdir().unwrap();
    for path in [root.path().join("no.txt"), root.path().to_path_buf()] {
        assert!(load(&path, &LoadOptions::default(), &mut files, &mut diagnostics).is_err());
    }
}

#[test]
fn missing_lights_materials_and_objects_are_reported() {
    let ball = "Sphere { center 0 0 0 radius 1 }\n";
    let text = |lights: &str, group: &str| format!("{CAMERA}{lights}{MATERIAL}{group}");
    let root = house("");
    for (text, expected) in [
        (
            text("", &format!("Group {{ MaterialIndex 0 {ball} }}")),
            vec!["- warning: the scene has no lights: it is shown with an ambient light of 1 1 1, so colours are flat"],
        ),
        (
            text(LIGHT, &format!("Group {{\n{} }}", ball.repeat(100))),
            vec![
                "scene/scene.txt:5:1 warning: this object has no material and is rendered in plain grey; 99 other objects have no material either (write `MaterialIndex 0` before the object)",
            ],
        ),
        (
            text(LIGHT, &format!("Group {{\nMaterialIndex 3 {ball} }}")),
            vec![
                "scene/scene.txt:5:1 warning: material 3 does not exist: there is only material 0 (objects that use it are drawn in plain grey)",
            ],
        ),
        (text(LIGHT, ""), vec!["- warning: the scene has no objects: it has no `Group`"]),
    ] {
        fs::write(root.path().join("scene/scene.txt"), text).unwrap();
        let (world, found) = load_world(&root, &LoadOptions::default());
        assert!(world.is_some());
        assert_eq!(found, expected);
    }
    fs::write(root.path().join("scene/scene.txt"), "Group { }").unwrap();
    assert_eq!(
        load_world(&root, &LoadOptions::default()).1,
        ["- error: the scene has no camera (add a `PerspectiveCamera { ... }`)"]
    );
}

#[test]
fn flattening_transform_is_reported_at_its_object() {
    let found =
        findings("Transform { Matrix4f { 1 1 0 0 1 1 0 0 0 0 1 0 0 0 0 1 }\n Sphere { center 0 0 0 radius 1 } }");
    let expected =
        "scene/scene.txt:6:2 error: the transforms that enclose this object are singular, or their numbers overflow";
    assert_eq!(found, [expected]);
}

#[test]
fn digest_covers_everything_that_the_picture_depends_on() {
    let digest = |root: &tempfile::TempDir, options: &LoadOptions| load_world(root, options).0.unwrap().digest();
    let (root, again) = (house(&mesh("tri.obj")), house(&mesh("tri.obj")));
    let options = LoadOptions::default();
    let first = digest(&root, &options);
    // The digest does not depend on the folder, on the acceleration structure, or on other files in
    // the folder.
    fs::write(again.path().join("scene/other.obj"), "v 1 2 3\n").unwrap();
    assert_eq!(digest(&again, &LoadOptions { accel: AccelKind::None, ..options.clone() }), first);
    assert_eq!(digest(&again, &LoadOptions { threads: Some(1), ..options.clone() }), first);
    // The digest depends on the rules and on every file that is read.
    let requested = LoadOptions { dialect: Some(Dialect::F04), ..options.clone() };
    assert_ne!(digest(&again, &LoadOptions { allow_outside: true, ..requested }), first);
    fs::write(again.path().join("scene/tri.obj"), TRIANGLE.replace("v 1 0 0", "v 1.0001 0 0")).unwrap();
    assert_ne!(digest(&again, &options), first);
    fs::write(again.path().join("scene/tri.obj"), TRIANGLE).unwrap();
    assert_eq!(digest(&again, &options), first);
    let scene = fs::read_to_string(again.path().join("scene/scene.txt")).unwrap();
    fs::write(again.path().join("scene/scene.txt"), scene.replace("diffuseColor 1 1 1", "diffuseColor 1 1 0.5"))
        .unwrap();
    assert_ne!(digest(&again, &options), first);
}
