//! Tests of the positions that diagnostics have, and of the names that appear in messages.

use super::{BOUNDS, document, mesh};
use crate::testing::read_in;
use durer_scene::math::Vec3;
use durer_scene::scene::ObjectKind;

/// Returns the diagnostics that reading a file causes.
fn messages(name: &str, bytes: &[u8]) -> Vec<String> {
    read_in(std::path::Path::new("."), name, bytes).1
}

/// Returns a GLB file that contains only JSON. The length of the file is chosen so that the header
/// contains a line feed byte.
fn glb(json: &str) -> Vec<u8> {
    let json = format!("{json:<2560}");
    let length = |bytes: usize| (bytes as u32).to_le_bytes();
    [b"glTF", &length(2)[..], &length(json.len() + 20), &length(json.len()), b"JSON", json.as_bytes()].concat()
}

/// Returns a document that has four vertices and no spaces at the ends of lines.
fn corners(primitive: &str, nodes: &str) -> String {
    let corners = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let faces = [0u8, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];
    let bytes: Vec<u8> = corners.iter().flatten().flat_map(|x| x.to_le_bytes()).chain(faces).collect();
    let views = r#"{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}"#;
    let accessors = format!(
        r#"{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3",{BOUNDS}}},{{"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}}"#
    );
    let primitive = format!(r#""attributes":{{"POSITION":0{primitive}"#);
    document(views, &accessors, &primitive, &bytes).replace(r#""nodes":[{"mesh":0}]"#, nodes)
}

const PLAIN: &str = r#""nodes":[{"mesh":0}]"#;

#[test]
fn glb_findings_have_positions_in_the_json() {
    let wrong = "{\"asset\":{\"version\":\"2.0\"},\n\"nodes\":[{\"mesh\":3}]}";
    for (name, bytes) in [("a.gltf", wrong.as_bytes().to_vec()), ("a.glb", glb(wrong))] {
        assert_eq!(
            messages(name, &bytes),
            [format!("{name}:2:18 error /nodes/0/mesh: index 3 refers to an item that does not exist")]
        );
    }
    let broken = messages("a.glb", &glb("{\"asset\":\n  }"));
    assert!(broken.len() == 1 && broken[0].starts_with("a.glb:2:3 error invalid JSON"), "{broken:?}");
    let empty =
        messages("a.glb", &glb("{\"asset\":{\"version\":\"2.0\"},\n\"scene\":0,\"scenes\":[{\"name\":\"S\"}]}"));
    assert_eq!(empty, ["a.glb:2:21 warning /scenes/0: the scene has no visible triangles"]);
}

#[test]
fn error_that_two_parts_of_the_reader_find_is_reported_once() {
    let found = messages("a.gltf", corners(r#","NORMAL":7},"indices":1"#, PLAIN).as_bytes());
    let wanted = "/meshes/0/primitives/0/attributes/NORMAL: index 7 refers to an item that does not exist";
    assert!(found.len() == 1 && found[0].ends_with(wanted), "{found:#?}");
}

#[test]
fn warnings_name_the_part_of_the_file() {
    let line = |text: &str, what: &str| {
        let at = text.find(what).unwrap();
        let before = &text[..at];
        let line = before.matches('\n').count() + 1;
        format!("a.gltf:{line}:{}", at - before.rfind('\n').map_or(0, |end| end + 1) + 1)
    };
    let text = corners(r#"},"mode":0"#, PLAIN).replace(r#"{"primitives""#, r#"{"name":"Dots","primitives""#);
    let expected = format!(
        "{} warning /meshes/0/primitives/0: points and lines of mesh `Dots` have no surface, so small balls and thin \
         sticks are shown",
        line(&text, r#"{"attributes""#)
    );
    assert_eq!(messages("a.gltf", text.as_bytes()), [expected]);

    let text = corners(r#","COLOR_1":0},"indices":1"#, PLAIN);
    let expected = "additional attribute sets, for example of mesh, are left out";
    let place = line(&text, r#"0},"indices""#);
    let expected = format!("{place} warning /meshes/0/primitives/0/attributes/COLOR_1: {expected}");
    assert_eq!(messages("a.gltf", text.as_bytes()), [expected]);

    let nodes = r#""nodes":[{"children":[1],"scale":[1,0,1]},{"mesh":0,"name":"Gone","scale":[0,2,1]}]"#;
    let text = corners(r#"},"indices":1"#, nodes);
    let expected = "node `Gone` is left out, because its transform flattens its mesh to a line or point, or has numbers \
                    that are too large";
    let found = messages("a.gltf", text.as_bytes());
    assert_eq!(found[0], format!("{} warning /nodes/1: {expected}", line(&text, r#"{"mesh":0,"name""#)));

    let material = r#""images":[{"uri":"none.png"}],"textures":[{"source":0}],"materials":[{"name":"Wood","pbrMetallicRoughness":
        {"baseColorTexture":{"index":0,"texCoord":2}}}],"nodes":[{"mesh":0}]"#;
    let text = corners(r#"},"indices":1,"material":0"#, material);
    let expected =
        "this texture of material `Wood` uses TEXCOORD_2, but only two sets are supported; TEXCOORD_0 is used";
    let at = "/materials/0/pbrMetallicRoughness/baseColorTexture";
    let found = messages("a.gltf", text.as_bytes());
    assert_eq!(found, [format!("{} warning {at}: {expected}", line(&text, r#"{"index":0,"texCoord""#))]);
    // Errors in a picture are reported at the place where the file names the picture.
    let (scene, _) = read_in(std::path::Path::new("."), "a.gltf", text.as_bytes());
    let durer_scene::scene::Material::Principled(layers) = &scene.unwrap().materials[0].value else { panic!() };
    let span = layers.base_color_texture.as_ref().unwrap().span;
    assert_eq!(&text[span.start as usize..span.end as usize], r#""none.png""#);
}

#[test]
fn animations_not_shown_are_noted() {
    let animated = |names: &[&str]| {
        let all: Vec<String> = names.iter().map(|name| format!(r#"{{"name":"{name}"}}"#)).collect();
        let text = corners(r#"},"indices":1"#, &format!(r#""animations":[{}],{PLAIN}"#, all.join(",")));
        messages("a.gltf", text.as_bytes()).remove(0)
    };
    let expected =
        "the file has 1 animation and is shown at rest; use `--at 0` to show the first moment of the animation";
    assert!(animated(&["Walk"]).ends_with(&format!("note /animations: {expected}")), "{}", animated(&["Walk"]));
    let expected = "the file has 2 animations and is shown at rest; use `--at 0` to show the first moment of the first \
                    animation, `Walk`, and `--animation NAME` to show another";
    assert!(animated(&["Walk", "Run"]).ends_with(expected));
}

#[test]
fn mesh_scaled_to_zero_along_one_axis_is_a_sheet() {
    let sheet = |node: &str| mesh(&corners(r#"},"indices":1"#, &format!(r#""nodes":[{{"mesh":0,{node}}}]"#)));
    // Two of the four faces of the tetrahedron are perpendicular to the sheet, so they disappear.
    let flat = sheet(r#""scale":[2,1,0],"translation":[0,0,5]"#);
    let at = |x: f32, y: f32| Vec3::new(x, y, 5.0);
    assert_eq!(flat.positions, [at(0.0, 0.0), at(2.0, 0.0), at(0.0, 1.0), at(0.0, 0.0)]);
    assert_eq!(flat.triangles, [[0, 2, 1], [1, 2, 3]]);
    assert!(flat.flat && flat.normals.is_empty() && flat.triangle_normals.is_empty());
    // After a rotation, the coordinates are no longer exact.
    let turn = r#""rotation":[0.1825742,0.3651484,0.5477226,0.7302967],"translation":[1000,2000,3000]"#;
    let turned = sheet(&format!(r#""scale":[1,1,0],{turn}"#));
    assert_eq!(turned.triangles, [[0, 2, 1], [1, 2, 3]]);
    // For a shear, the transform is singular although no axis is scaled to 0.
    let leaning = sheet(r#""matrix":[1,0,0,0,0,1,0,0,1,1,0,0,0,0,0,1]"#);
    assert_eq!(leaning.positions[3], Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(leaning.triangles.len(), 4);
}

#[test]
fn each_instance_of_a_flat_mesh_has_its_own_sheet() {
    let nodes = r#""nodes":[{"mesh":0,"scale":[1,1,0]},{"mesh":0,"scale":[0,1,1]},{"mesh":0}]"#;
    let text = corners(r#"},"indices":1"#, nodes).replace(r#""nodes":[0]"#, r#""nodes":[0,1,2]"#);
    let (scene, found) = read_in(std::path::Path::new("."), "a.gltf", text.as_bytes());
    assert_eq!(found, [""; 0]);
    let scene = scene.unwrap();
    let objects = &scene.root.as_ref().unwrap().objects;
    let counts = objects.iter().filter_map(|object| match &object.node {
        ObjectKind::Mesh(mesh) => Some(scene.assets.meshes[&mesh.obj_file.path].triangles.len()),
        _ => None,
    });
    // Skip the ground plane at the end of the list.
    assert_eq!(counts.take(3).collect::<Vec<_>>(), [2, 2, 4]);
}
