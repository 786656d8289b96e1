use crate::testing::{folder, read_in};
use crate::tests::{abuse, read, read_clean};
use durer_scene::math::{Vec2, Vec3};
use durer_scene::scene::{Material, Scene, Spanned};
use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;
use std::sync::Arc;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// Returns the diagnostics for a file in which the vertices of a square, on four lines, are
/// followed by the given text.
fn findings(more: &str) -> Vec<String> {
    read(format!("{SQUARE}{more}").as_bytes(), "m.obj").1
}

#[test]
fn statements() {
    let text = "\u{feff}# made by hand\r\nmtllib a.mtl\no square\ng a b\ns off\nusemtl red#2\n\
        v 0 0 0 1\n\tv  1 0 0   0.5 0.5 0.5 # coloured\nv 1 1 -.5e1\nv 0 1 0\n\
        vt 0 0\nvt 0.25\nvt 1 1 0\nvn 0 0 1\nvn 0 0 -2\nl 1 2\np 1\n\
        f 1 2 3\nf 1/1 2/2 3/3\nf 1//1 2//1 3//2\nf 1/1/1 2/2/1 -2/-1/-1\nf 1/ 2// 4/1/ # corner\nf 1 2 3 4";
    let mesh = read_clean(text.as_bytes(), "m.obj");
    assert_eq!(mesh.positions, [[0., 0., 0.], [1., 0., 0.], [1., 1., -5.], [0., 1., 0.]].map(Vec3::from));
    assert_eq!(mesh.uvs, [[0., 0.], [0.25, 0.], [1., 1.]].map(Vec2::from));
    assert_eq!(mesh.normals, [[0., 0., 1.], [0., 0., -2.]].map(Vec3::from));
    let (n, none) = (NO_INDEX, [NO_INDEX; 3]);
    let triangles = [[0, 1, 2], [0, 1, 2], [0, 1, 2], [0, 1, 2], [0, 1, 3], [0, 1, 2], [0, 2, 3]];
    assert_eq!(mesh.triangles, triangles);
    assert_eq!(mesh.triangle_uvs, [none, [0, 1, 2], none, [0, 1, 2], [n, n, 0], none, none]);
    assert_eq!(mesh.triangle_normals, [none, none, [0, 0, 1], [0, 0, 1], none, none, none]);
}

#[test]
fn line_ends_continuations_and_comments() {
    let plain = read_clean(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m.obj");
    for text in [
        "v 0 0 0\r\nv 1 0 0\r\n\r\nv 0 1 0\r\nf 1 2 3",
        "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
        "  v 0 0 0#0\n \t v 1 \\\n 0 0\nv 0 1\\\r\n0\n # comment \\\nf 1 2 \\\n3 \\",
        "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nfo\\",
    ] {
        let (mesh, findings) = read(text.as_bytes(), "m.obj");
        match findings.is_empty() {
            true => assert_eq!(mesh.unwrap(), plain, "{text}"),
            false => assert_eq!(findings, ["5:1+2 Error: a face needs at least 3 vertices, found 0"]),
        }
    }
}

#[test]
fn relative_indices_count_back_from_the_face() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -3 -2 -1\n";
    assert_eq!(read_clean(text.as_bytes(), "m.obj").triangles, [[0, 1, 2], [1, 2, 3]]);
}

#[test]
fn concave_faces_are_triangulated_inside() {
    let text = "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nv -9 1 0\nf 1 2 3 4\nf 4 3 2 1\nf 1 2 3 4 5";
    let mesh = read_clean(text.as_bytes(), "m.obj");
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).z
    };
    let areas: Vec<f32> = mesh.triangles.iter().map(area).collect();
    assert_eq!(mesh.triangles.len(), 7);
    assert_eq!(areas[..2].iter().sum::<f32>(), 8.0);
    assert_eq!(areas[2..4].iter().sum::<f32>(), -8.0);
    assert!(areas[..2].iter().chain(&areas[4..]).all(|&a| a > 0.0) && areas[2..4].iter().all(|&a| a < 0.0));
}

#[test]
fn wrong_numbers() {
    let limit = "(numbers must lie within the range of 32-bit floating point, about ±3.4e38)";
    let cases = [
        ("v 1 2", "5:1+5 Error: `v` needs 3 numbers, found 2".to_string()),
        ("vn 1", "5:1+4 Error: `vn` needs 3 numbers, found 1".into()),
        ("vt # 1", "5:1+2 Error: `vt` needs 1 number, found 0".into()),
        ("v 1 x2 3", "5:5+2 Error: expected a number, found `x2`".into()),
        ("v 1 2 3 v", "5:9+1 Error: expected a number, found `v`".into()),
        ("\n v\t1 2,5 3", "6:6+3 Error: expected a number, found `2,5` (write decimals with a point: `2.5`)".into()),
        ("v 1 2 nan", format!("5:7+3 Error: expected a finite number, found `nan` {limit}")),
        ("vt 1e39 0", format!("5:4+4 Error: expected a finite number, found `1e39` {limit}")),
        ("vn 0 0 -1.#IND", format!("5:8+7 Error: expected a finite number, found `-1.#IND` {limit}")),
        ("v 1 \\\n2 -inf", format!("6:3+4 Error: expected a finite number, found `-inf` {limit}")),
    ];
    for (text, expected) in cases {
        assert_eq!(findings(text), [expected], "{text}");
    }
    // An invalid vertex is still counted, so that faces that use it are not reported as well.
    assert_eq!(findings("v 1 2\nf 1 2 5\nf 1 2 9\n").len(), 2);
}

#[test]
fn wrong_faces() {
    let form = "(write `vertex`, `vertex/texture`, `vertex//normal` or `vertex/texture/normal`)";
    let none = "(add `vt` statements for texture coordinates)";
    let cases = [
        (
            "f 1 2",
            "5:1+5 Error: a face needs at least 3 vertices, found 2 (write a line as an `l` statement)".to_string(),
        ),
        ("f", "5:1+1 Error: a face needs at least 3 vertices, found 0".into()),
        ("f 1 0 3", "5:5+1 Error: vertex 0 does not exist: the first index is 1".into()),
        ("f 1 2 5", "5:7+1 Error: vertex `5` does not exist: the file has 4 vertices".into()),
        (
            "f 1 2 -5",
            "5:7+2 Error: index `-5` reaches back too far: the file has 4 vertices before this statement".into(),
        ),
        (
            "f -1 2 3\nf 1 2 99999999999999999999",
            "6:7+20 Error: vertex `99999999999999999999` does not exist: the file has 4 vertices".into(),
        ),
        (
            "f 1 2/1 3",
            format!("5:7+1 Error: texture coordinate `1` does not exist: the file has no texture coordinates {none}"),
        ),
        ("vn 0 0 1\nf 1 2 3//2", "6:10+1 Error: normal `2` does not exist: the file has 1 normal".into()),
        ("f 1 2 x", "5:7+1 Error: expected the number of a vertex, found `x`".into()),
        ("f 1 2 3.0", "5:7+3 Error: expected the number of a vertex, found `3.0`".into()),
        ("f 1 2 /1", "5:7+0 Error: expected the number of a vertex, found nothing".into()),
        ("f 1 2 3////", format!("5:7+5 Error: a vertex reference can have at most 3 indices, found `3////` {form}")),
    ];
    for (text, expected) in cases {
        assert_eq!(findings(text), [expected], "{text}");
    }
}

#[test]
fn errors_are_in_file_order() {
    let found = findings("f 1 2 7\nv 1 2\nf 0 1 2\nvt x");
    let lines: Vec<&str> = found.iter().map(|f| &f[..1]).collect();
    assert_eq!(lines, ["5", "6", "7", "8"]);
}

#[test]
fn warnings_and_notes() {
    assert_eq!(findings(""), ["5:1+0 Warning: the mesh has no triangles"]);
    assert_eq!(read(b"", "m.obj").1, ["1:1+0 Warning: the mesh has no triangles"]);
    let unknown =
        "5:1+6 Warning: left out 2 statements with an unknown keyword; the first is `usemlt` (did you mean `usemtl`?)";
    assert_eq!(findings("usemlt a\nf 1 2 3\ncurv2 1 2\n"), [unknown]);
    assert_eq!(
        findings("f 1 2 2\nf 1 2 3 1\n"),
        ["5:1+7 Note: 2 faces use a vertex twice; the first such face is here"]
    );
}

#[test]
fn nothing_panics() {
    let text = "\u{feff}# x\no a\nv 0 0 0 1\nv 1 0 0\nv 1 1 \\\n-.5e1\r\nv 0 1 0\nv .2 .2 0\nvt 0 0\nvt 1.#INF\nvn 0 0 1\n\
        l 1 2\nf 1/1/1 2/1/1 3/1/1 4/1/1 5/1/1\nf -1 -2 -3\nf 1//1 2//1 3//1 # c\nf 1/1 2/1 3/1 4/1\\";
    abuse(text.as_bytes(), "m.obj");
    abuse(text.replace("vt 1.#INF\n", "").as_bytes(), "m.obj");
}

/// Returns the name, the number of triangles, and the number of vertices of each mesh in a scene.
fn meshes(scene: &Scene) -> Vec<(String, usize, usize)> {
    let count = |(name, data): (&String, &Arc<MeshData>)| (name.clone(), data.triangles.len(), data.positions.len());
    scene.assets.meshes.iter().map(count).collect()
}

#[test]
fn lines_points_and_lone_vertices_become_sticks_and_balls() {
    let folder = folder(&[("m.mtl", b"newmtl red\nKd 1 0 0\n")]);
    let read = |text: &str| read_in(folder.path(), "m.obj", text);
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let (scene, messages) = read(&format!("mtllib m.mtl\n{vertices}f 1 2 3\nusemtl red\nl -1/1 1 2\np 3\n"));
    let named = |name: &str, triangles, positions| (name.to_string(), triangles, positions);
    // The scene contains two sticks with six sides each, and an octahedron.
    assert_eq!(meshes(&scene.unwrap()), [named("m.obj", 1, 3), named("m.obj#red", 32, 30)]);
    let note = "lines and points have no surface: thin sticks and small balls are shown for 2 lines and 1 point";
    assert_eq!(messages, [format!("m.obj:6:8 note {note}")]);
    let (scene, messages) = read(vertices);
    assert_eq!(meshes(&scene.unwrap()), [named("m.obj", 24, 18)]);
    assert!(messages[1].contains("are shown for 3 points"), "{messages:?}");
    let (none, messages) = read(&format!("{vertices}l 1 4\np 0 1\n"));
    assert!(none.is_none());
    let wrong = ["vertex `4` does not exist: the file has 3 vertices", "vertex 0 does not exist: the first index is 1"];
    assert_eq!(messages[1..], [format!("m.obj:4:5 error {}", wrong[0]), format!("m.obj:5:3 error {}", wrong[1])]);
    let (scene, messages) = read_in(
        folder.path(),
        "m.ply",
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n\
        property float y\nproperty float z\nend_header\n0 0 0\n1 0 0\n",
    );
    assert_eq!(meshes(&scene.unwrap()), [named("m.ply", 16, 12)]);
    // A point cloud of PLY needs no triangles.
    assert!(messages.len() == 1 && messages[0].contains("are shown for 2 points"), "{messages:?}");
}

#[test]
fn material_file_names_may_have_blanks() {
    let mtl = |name| format!("newmtl {name}\nKd 1 0 0\n");
    let (a, b) = (mtl("a"), mtl("b"));
    let folder = folder(&[("one two.mtl", a.as_bytes()), ("three.mtl", b.as_bytes())]);
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    for names in ["one two.mtl", "three.mtl one\\ two.mtl", "\"one two.mtl\"", "One Two.MTL"] {
        let messages = read_in(folder.path(), "m.obj", &format!("mtllib {names}\n{triangle}")).1;
        assert!(messages.is_empty(), "{names}: {messages:?}"); // prose: keep
    }
}

#[test]
fn smoothing_group_smooths_its_faces() {
    // Two squares share an edge along the x axis and form a right angle.
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 0 0 1\n";
    let of = |faces: &str| {
        let (scene, messages) = read_in(&std::env::temp_dir(), "m.obj", &format!("{corners}{faces}"));
        assert_eq!(messages, [""; 0], "{faces}");
        let scene = scene.unwrap();
        let data = scene.assets.meshes.values().next().unwrap();
        // Get the normal at the first corner of each face, which is at the origin.
        let normal = |triangle: usize| data.normals[data.triangle_normals[triangle][0] as usize];
        data.triangle_normals.first().map(|_| [normal(0), normal(2)])
    };
    let half = (Vec3::Z + Vec3::Y).normalize();
    let [one, other] = of("s 1\nf 1 2 3 4\nf 1 6 5 2\n").unwrap();
    // The normals of two triangles that meet at a corner of a square are weighted by the angles of
    // the triangles.
    assert!((one - half).length() < 1e-6 && one == other, "{one} {other}");
    // Each of the two smoothing groups has its own normals.
    assert_eq!(of("s 1\nf 1 2 3 4\ns 2\nf 1 6 5 2\n").unwrap(), [Vec3::Z, Vec3::Y]);
    assert_eq!(of("s off\nf 1 2 3 4\nf 1 6 5 2\n"), None);
    assert_eq!(of("f 1 2 3 4\nf 1 6 5 2\n"), None);
    // Normals that the file contains are kept.
    let [one, other] = of("vn 0 1 0\ns 1\nf 1//1 2//1 3//1 4//1\nf 1 6 5 2\n").unwrap();
    assert_eq!([one, other], [Vec3::Y, Vec3::Y]);
}

#[test]
fn texture_without_kd_keeps_its_colours() {
    let folder = folder(&[
        ("m.mtl", b"newmtl a\nmap_Kd a.ppm\nnewmtl b\nKd 0.5 0.5 0.5\nmap_Kd a.ppm\nnewmtl c\n"),
        ("a.ppm", b"P6\n1 1\n255\n\x80\x80\x80"),
    ]);
    let faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n";
    let (scene, messages) = read_in(folder.path(), "m.obj", &format!("mtllib m.mtl\n{faces}"));
    assert_eq!(messages, [""; 0]);
    let base = |material: &Spanned<Material>| match &material.value {
        Material::Principled(layers) => layers.base_color.x,
        _ => panic!(),
    };
    // The last material is that of the ground.
    assert_eq!(scene.unwrap().materials[..3].iter().map(base).collect::<Vec<_>>(), [1.0, 0.5, 0.8]);
}
