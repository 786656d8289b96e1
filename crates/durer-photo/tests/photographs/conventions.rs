//! Tests for the table of conventions. They use one camera that observes one point, written by hand
//! in each format.

use durer_photo::format::{CONVENTIONS, Output, read, read_control};
use durer_photo::matching::FORMAT;
use durer_photo::{Reconstruction, View};
use nalgebra::{Matrix3, Vector2, Vector3};
use std::path::Path;
use tempfile::TempDir;

// The image has 640 x 480 pixels, f = 500, and k1 = 0.1. The camera is rotated by 90 degrees about
// z, and t = (0.5, 1, 5). In the camera frame, the point X = (1, 2, 3) is at P = (-1.5, 2, 8), so p
// = (-0.1875, 0.25) and r = 1 + 0.1 |p|² = 1.009765625. The pixel is 94.66552734375 pixels to the
// left of the centre and 126.220703125 pixels below it.
const PIXEL: [f64; 2] = [320.0 - 94.66552734375, 240.0 + 126.220703125];
const CENTER: [f64; 3] = [-1.0, 0.5, -5.0];
const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Test case for a file format, with its name in the table, the path to read, and the files to
/// create.
type Case = (&'static str, &'static str, Vec<(&'static str, Vec<u8>)>);

/// Returns test files in every format that can be read.
fn files() -> Vec<Case> {
    let bundler = "# Bundle file v0.3\n1 1\n500 0.1 0\n0 -1 0\n-1 0 0\n0 0 -1\n0.5 -1 -5\n1 2 3\n10 20 30\n1 0 0 -94.66552734375 -126.220703125\n";
    // The rotation is by 180 degrees about (1, -1, 0).
    let bal = "1 1 1\n0 0 -94.66552734375 -126.220703125\n2.221441469079183 -2.221441469079183 0\n0.5 -1 -5\n500 0.1 0\n1 2 3\n";
    let opensfm = r#"[{"cameras": {"c": {"projection_type": "perspective", "width": 640, "height": 480, "focal": 0.78125, "k1": 0.1, "k2": 0}},
        "shots": {"a.jpg": {"rotation": [0, 0, 1.5707963267948966], "translation": [0.5, 1, 5], "camera": "c"}},
        "points": {"7": {"color": [10, 20, 30], "coordinates": [1, 2, 3]}}}]"#;
    let tracks = "OPENSFM_TRACKS_VERSION_v2\na.jpg\t7\t0\t-0.147914886474609375\t0.1972198486328125\t1\t10\t20\t30\n";
    let images = format!("1 {HALF} 0 0 {HALF} 0.5 1 5 1 a.jpg\n{} {} 1\n", PIXEL[0], PIXEL[1]);
    let fspy = r#"{"principalPoint": {"x": 0, "y": 0}, "imageWidth": 640, "imageHeight": 480, "relativeFocalLength": 1.5625,
        "viewTransform": {"rows": [[0, -1, 0, 0.5], [-1, 0, 0, -1], [0, 0, -1, -5], [0, 0, 0, 1]]}}"#;
    let ply = "ply\nformat ascii 1.0\ncomment cameras at the end: 1\nelement vertex 2\nproperty double x\nproperty double y\nproperty double z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n1 2 3 10 20 30\n-1 0.5 -5 255 0 0\n";
    // The node of the camera is translated, rotated by a half turn about x, and scaled by 2. The
    // data are 1, 2, 3 as floats and 10, 20, 30 as bytes.
    let data = "AACAPwAAAEAAAEBAChQe/w==";
    let gltf = format!(
        r#"{{"asset": {{"version": "2.0"}}, "nodes": [
            {{"name": "a.jpg", "camera": 0, "translation": [-1.5, -0.25, 2.5], "rotation": [0, 0, {HALF}, {HALF}]}},
            {{"children": [0], "translation": [2, 0, 0], "rotation": [1, 0, 0, 0], "scale": [2, 2, 2]}}, {{"mesh": 0}}],
        "cameras": [{{"type": "perspective", "perspective": {{"yfov": 0.8950399503143397, "aspectRatio": 1.3333333333333333}},
            "extras": {{"lens": {{"width": 640, "height": 480, "center": [320, 240], "radial": [0.1, 0]}}}}}}],
        "meshes": [{{"primitives": [{{"mode": 0, "attributes": {{"POSITION": 0, "COLOR_0": 1}}}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 1, "type": "VEC3"}},
            {{"bufferView": 0, "byteOffset": 12, "componentType": 5121, "normalized": true, "count": 1, "type": "VEC4"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 16}}],
        "buffers": [{{"byteLength": 16, "uri": "data:application/octet-stream;base64,{data}"}}]}}"#
    );
    let doubles = |values: &[f64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let longs = |values: &[u64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let ints = |values: &[u32]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    // In COLMAP, camera model 2 is SIMPLE_RADIAL.
    let cameras_bin = [longs(&[1]), ints(&[1, 2]), longs(&[640, 480]), doubles(&[500.0, 320.0, 240.0, 0.1])].concat();
    let pose = doubles(&[HALF, 0.0, 0.0, HALF, 0.5, 1.0, 5.0]);
    let name = b"a.jpg\0".to_vec();
    let images_bin =
        [longs(&[1]), ints(&[1]), pose, ints(&[1]), name, longs(&[1]), doubles(&PIXEL), longs(&[1])].concat();
    let track = [longs(&[1]), ints(&[1, 0])].concat();
    let points_bin = [longs(&[1, 1]), doubles(&[1.0, 2.0, 3.0]), vec![10, 20, 30], doubles(&[0.1]), track].concat();
    vec![
        ("Bundler", "b.out", vec![("b.out", bundler.into())]),
        ("BAL", "b.txt", vec![("b.txt", bal.into())]),
        (
            "COLMAP text",
            "text",
            vec![
                ("text/cameras.txt", "1 SIMPLE_RADIAL 640 480 500 320 240 0.1\n".into()),
                ("text/images.txt", images.into()),
                ("text/points3D.txt", "1 1 2 3 10 20 30 0.1 1 0\n".into()),
            ],
        ),
        (
            "COLMAP binary",
            "binary",
            vec![
                ("binary/cameras.bin", cameras_bin),
                ("binary/images.bin", images_bin),
                ("binary/points3D.bin", points_bin),
            ],
        ),
        (
            "OpenSfM",
            "reconstruction.json",
            vec![("reconstruction.json", opensfm.into()), ("tracks.csv", tracks.into())],
        ),
        ("fSpy", "camera.json", vec![("camera.json", fspy.into())]),
        ("PLY", "points.ply", vec![("points.ply", ply.into())]),
        ("glTF", "cameras.gltf", vec![("cameras.gltf", gltf.into())]),
    ]
}

/// Checks that the camera and the point equal the values computed by hand.
#[track_caller]
fn is_as_meant(all: &Reconstruction, name: &str) {
    assert_eq!(all.views.len(), usize::from(name != "PLY"), "{name}");
    all.views.iter().for_each(|view| view_is_as_meant(all, view, name));
    for point in &all.points {
        assert!((point.position - Vector3::new(1.0, 2.0, 3.0)).norm() < 1e-12, "{name}");
        assert_eq!(point.color, if name == "BAL" { [128; 3] } else { [10, 20, 30] }, "{name}");
        assert_eq!(point.track.len(), usize::from(!["PLY", "glTF"].contains(&name)), "{name}");
        for seen in &point.track {
            assert!((seen.pixel - Vector2::from(PIXEL)).norm() < 1e-9, "{name}: {}", seen.pixel);
            assert!(all.residual(&point.position, seen).unwrap().norm() < 1e-9, "{name}");
        }
    }
    assert_eq!(all.points.len(), usize::from(name != "fSpy"), "{name}");
}

fn view_is_as_meant(all: &Reconstruction, view: &View, name: &str) {
    let (lens, pose) = (&all.lenses[view.lens], view.pose.unwrap());
    assert!((pose.center() - Vector3::from(CENTER)).norm() < 1e-12, "{name}: {}", pose.center());
    let rotation = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    assert!((pose.rotation - rotation).norm() < 1e-12, "{name}: {}", pose.rotation);
    let radial = if name == "fSpy" { 0.0 } else { 0.1 };
    assert!((lens.focal - 500.0).abs() < 1e-9, "{name}: {}", lens.focal);
    assert_eq!((lens.aspect, lens.principal_point, lens.distortion), (1.0, [320.0, 240.0], [radial, 0.0]), "{name}");
    // In every format, the camera sees the point at the pixel that was computed by hand.
    let pixel = lens.project(&pose.apply(&Vector3::new(1.0, 2.0, 3.0)));
    assert!(name == "fSpy" || (pixel - Vector2::from(PIXEL)).norm() < 1e-9, "{name}: {pixel}");
}

fn put(folder: &Path, name: &str, bytes: &[u8]) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, bytes).unwrap();
}

fn reread(path: &Path) -> Reconstruction {
    let mut all = read(path).unwrap();
    if !all.views.is_empty() {
        all.set_image(0, "a.jpg", [640, 480]);
    }
    all
}

#[test]
fn every_format_follows_the_table() {
    let place = TempDir::new().unwrap();
    let cases = files();
    let rows = CONVENTIONS.iter().filter(|row| row.direction.starts_with("in")).map(|row| row.name);
    assert_eq!(rows.collect::<Vec<_>>(), cases.iter().map(|case| case.0).collect::<Vec<_>>());
    for (name, path, files) in cases {
        files.iter().for_each(|(file, bytes)| put(place.path(), file, bytes));
        let all = reread(&place.path().join(path));
        is_as_meant(&all, name);
        // Files are read back exactly as they were written.
        let row = CONVENTIONS.iter().find(|row| row.name == name).unwrap();
        if row.direction.contains("out") {
            let again = place.path().join("again").join(path);
            let output = Output::of(&again, name.ends_with("binary")).unwrap();
            for (file, bytes) in output.files(&again).iter().zip(output.write(&all).unwrap()) {
                put(place.path(), file.strip_prefix(place.path()).unwrap().to_str().unwrap(), &bytes);
            }
            is_as_meant(&reread(&again), name);
        }
    }
}

#[test]
fn written_files_follow_the_table() {
    let place = TempDir::new().unwrap();
    let (_, path, files) = files().remove(2);
    files.iter().for_each(|(file, bytes)| put(place.path(), file, bytes));
    let all = reread(&place.path().join(path));
    let gltf = Output::Gltf.write(&all).unwrap().remove(0);
    let gltf: serde_json::Value = serde_json::from_slice(&gltf).unwrap();
    let node = &gltf["nodes"][0];
    let numbers = |value: &serde_json::Value| {
        value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect::<Vec<f64>>()
    };
    assert!((Vector3::from_iterator(numbers(&node["translation"])) - Vector3::from(CENTER)).norm() < 1e-12);
    // The rotation from the camera frame to the world maps -z to z, x to -y, and y to -x.
    let q = numbers(&node["rotation"]);
    let q = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[3], q[0], q[1], q[2]));
    for (axis, there) in [(-Vector3::z(), Vector3::z()), (Vector3::x(), -Vector3::y()), (Vector3::y(), -Vector3::x())] {
        assert!((q * axis - there).norm() < 1e-12);
    }
    let perspective = &gltf["cameras"][0]["perspective"];
    assert!((perspective["yfov"].as_f64().unwrap() - 2.0 * libm::atan(240.0 / 500.0)).abs() < 1e-12);
    assert!((perspective["aspectRatio"].as_f64().unwrap() - 4.0 / 3.0).abs() < 1e-12);
    assert_eq!(numbers(&gltf["accessors"][0]["min"]), [1.0, 2.0, 3.0]);
    let ply = Output::Ply.write(&all).unwrap().remove(0);
    let head =
        "ply\nformat binary_little_endian 1.0\ncomment cameras at the end: 1\nelement vertex 2\nproperty float x\n";
    assert!(ply.starts_with(head.as_bytes()));
    let body = ply.windows(11).position(|text| text == b"end_header\n").unwrap() + 11;
    let row = |place: [f64; 3], color: [u8; 3]| {
        place.iter().flat_map(|value| (*value as f32).to_le_bytes()).chain(color).collect::<Vec<u8>>()
    };
    assert_eq!(ply[body..], [row([1.0, 2.0, 3.0], [10, 20, 30]), row(CENTER, [255, 0, 0])].concat());
}

/// Returns a cloud of two points as a PLY file in each encoding.
fn clouds() -> Vec<(&'static str, Vec<u8>)> {
    let head = |format: &str, shade: &str| {
        format!(
            "ply\r\nformat {format} 1.0\ncomment by hand\nobj_info none\nelement vertex 2\nproperty short label\n\
            property float x\nproperty float32 y\nproperty double z\nproperty {shade} red\nproperty {shade} green\n\
            property {shade} blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        )
    };
    let rows = [(-7_i16, 0.5_f32, -1.0_f32, 0.25_f64), (8, 3.0, 4.0, 1e9)];
    let shades = [[0_u16, 65535, 32896], [257, 514, 771]];
    let text = "-7 0.5 -1 0.25 0 1 0.502\n\n8 3 4 1e9 0.00392 0.00784 0.01176\n3 0 1 2\n".to_string();
    let mut all = vec![("ascii", (head("ascii", "float") + &text).into_bytes())];
    for (format, big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let mut bytes = head(format, "ushort").into_bytes();
        let mut put = |little: &[u8]| match big {
            true => bytes.extend(little.iter().rev()),
            false => bytes.extend(little),
        };
        for ((label, x, y, z), shades) in rows.iter().zip(shades) {
            put(&label.to_le_bytes());
            [x, y].iter().for_each(|value| put(&value.to_le_bytes()));
            put(&z.to_le_bytes());
            shades.iter().for_each(|shade| put(&shade.to_le_bytes()));
        }
        bytes.extend([3, 0, 0, 0]);
        all.push((format, bytes));
    }
    all
}

#[test]
fn clouds_are_read_in_every_encoding() {
    let place = TempDir::new().unwrap();
    for (format, bytes) in clouds() {
        put(place.path(), "cloud.ply", &bytes);
        let all = read(&place.path().join("cloud.ply")).unwrap();
        let rows: Vec<_> = all.points.iter().map(|point| (<[f64; 3]>::from(point.position), point.color)).collect();
        assert_eq!(rows, [([0.5, -1.0, 0.25], [0, 255, 128]), ([3.0, 4.0, 1e9], [1, 2, 3])], "{format}");
        // Files that are truncated within the points are rejected.
        for cut in 0..bytes.len() - 11 {
            put(place.path(), "cloud.ply", &bytes[..cut]);
            assert!(
                format == "ascii" && cut > bytes.len() - 30 || read(&place.path().join("cloud.ply")).is_err(),
                "{cut}"
            );
        }
    }
}

#[test]
fn ply_and_gltf_errors_name_the_fault() {
    let place = TempDir::new().unwrap();
    let reread = |name: &str, text: &str| {
        put(place.path(), name, text.as_bytes());
        let error = read(&place.path().join(name)).unwrap_err().to_string();
        error.strip_prefix(&*place.path().join(name).to_string_lossy()).unwrap().to_string()
    };
    let cloud = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
    for (old, new, wanted) in [
        ("ply", "plx", ": the file is not a PLY file"),
        ("end_header", "comment end_header", ": the file is not a PLY file"),
        ("ascii", "utf8", ":2:1: `utf8` is not a PLY format"),
        ("vertex 1", "vertex 99999999999", ":3:16: the file is too short for 99999999999 points: 6 bytes follow"),
        ("vertex 1", "vertex -1", ":3:16: expected a number of points, found `-1`"),
        ("vertex 1", "vertices 1", ":3:1: the element `vertex` must come before `vertices`"),
        ("float z", "float w", ":3:16: the points need the properties x, y and z"),
        ("float z", "list uchar int z", ":6:10: `list` is not a number type"),
        ("1 2 3", "1 2", ":8:4: the row ends where z should follow"),
        ("1 2 3", "1 2 x", ":8:5: expected z, found `x`"),
        ("1 2 3", "1 2 3 4", ":8:7: the row should end here, after the properties of a point"),
        ("property float x\nproperty float y\nproperty float z\n", "", ": the file has no points"),
    ] {
        let error = reread("c.ply", &cloud.replace(old, new));
        assert!(error.starts_with(wanted), "{new}: {error}");
    }
    let (_, _, files) = files().pop().unwrap();
    let gltf = String::from_utf8(files[0].1.clone()).unwrap();
    for (old, new, wanted) in [
        ("\"children\": [0]", "\"children\": [1]", ": some nodes are their own ancestors"),
        ("\"children\": [0]", "\"children\": [0, 0]", ": node 0 has two parents"),
        ("\"children\": [0]", "\"children\": [9]", ": node 9 does not exist"),
        ("\"camera\": 0", "\"camera\": 1", ": node 0: camera 1 does not exist"),
        ("\"mesh\": 0", "\"mesh\": 1", ": node 2: mesh 1 does not exist"),
        ("[2, 2, 2]", "[2, 2, -2]", ": node 0: a camera cannot be scaled to zero, or mirrored"),
        ("0.8950399503143397", "4", ": camera 0: `yfov` or `aspectRatio` is out of range"),
        ("\"width\": 640", "\"width\": 0", ": camera 0: `extras.lens` has a size of 0"),
        ("\"width\": 640, ", "", ": camera 0: `extras.lens` is invalid (missing field `width`"),
        ("\"count\": 1, \"type\": \"VEC3\"", "\"count\": 2, \"type\": \"VEC3\"", ": accessor 0 has incomplete bytes"),
        ("\"byteLength\": 16}],", "\"byteLength\": 17}],", ": accessor 0 has incomplete bytes"),
        ("data:application", "points.bin?", ": accessor 0 has its bytes in another file"),
        ("AACAPw", "AACA/w", ": accessor 0 contains NaN or infinity"),
        ("{\"asset\"", "glTF", ": the binary glTF file is truncated"),
    ] {
        let text = gltf.replace(old, new);
        assert_ne!(text, gltf, "{old}");
        let error = reread("c.gltf", &text);
        assert!(error.starts_with(wanted), "{new}: {error}");
    }
    assert!(reread("c.gltf", &gltf.replace("\"nodes\": [", "\"nodes\": 3, [")).starts_with(":1:"));
    assert!(reread("m.json", &format!("{{\"format\": \"{FORMAT}\",")).starts_with(": the file contains matches"));
}

#[test]
fn binary_gltf_is_read_and_foreign_cameras_have_1000_rows() {
    let place = TempDir::new().unwrap();
    let json = r#"{"nodes": [{"camera": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1,2,3,1]}, {"camera": 0}, {"mesh": 0}, {"mesh": 1}],
        "cameras": [{"name": "Camera", "type": "perspective", "perspective": {"yfov": 1.5707963267948966, "aspectRatio": 1.5}}],
        "meshes": [{"primitives": [{"mode": 0, "attributes": {"POSITION": 0}}]}, {"primitives": [{"attributes": {"POSITION": 9}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 4, "byteLength": 28, "byteStride": 16}], "buffers": [{"byteLength": 32}]}  "#;
    let json = format!("{json:<0$}", json.len().next_multiple_of(4));
    let numbers = [9.0_f32, 1.0, 2.0, 3.0, 9.0, 4.0, 5.0, 6.0];
    let binary: Vec<u8> = numbers.iter().flat_map(|value| value.to_le_bytes()).collect();
    let chunk = |kind: &[u8], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes()[..], kind, bytes].concat();
    let chunks = [chunk(b"JSON", json.as_bytes()), chunk(b"BIN\0", &binary)].concat();
    let head = [&b"glTF"[..], &2_u32.to_le_bytes(), &(12 + chunks.len() as u32).to_le_bytes()].concat();
    put(place.path(), "c.glb", &[head, chunks].concat());
    let all = read(&place.path().join("c.glb")).unwrap();
    // The two cameras share a lens with a vertical field of view of 90 degrees.
    assert_eq!((all.lenses.len(), all.views.len(), all.lenses[0].size), (1, 2, [1500, 1000]));
    assert!((all.lenses[0].focal - 500.0).abs() < 1e-9 && all.views[0].name == "Camera");
    let centers: Vec<_> = all.views.iter().map(|view| view.pose.unwrap().center()).collect();
    assert_eq!(centers, [Vector3::new(1.0, 2.0, 3.0), Vector3::zeros()]);
    // The camera looks along -z. A point in front of it and to the upper right therefore appears to
    // the upper right of the centre.
    let pixel = all.lenses[0].project(&all.views[1].pose.unwrap().apply(&Vector3::new(1.0, 0.5, -2.0)));
    assert!((pixel - Vector2::new(1000.0, 375.0)).norm() < 1e-9, "{pixel}");
    let positions: Vec<[f64; 3]> = all.points.iter().map(|point| point.position.into()).collect();
    assert_eq!(positions, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    let bytes = std::fs::read(place.path().join("c.glb")).unwrap();
    for cut in 4..bytes.len() {
        put(place.path(), "c.glb", &bytes[..cut]);
        assert!(read(&place.path().join("c.glb")).is_err(), "{cut}");
    }
}

#[test]
fn compressed_files_are_decompressed() {
    use std::io::Write;
    let place = TempDir::new().unwrap();
    let (_, _, files) = files().remove(1);
    let plain = &files[0].1;
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    gz.write_all(plain).unwrap();
    let mut bz2 = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::default());
    bz2.write_all(plain).unwrap();
    for (name, bytes) in [("p.txt.gz", gz.finish().unwrap()), ("p.txt.bz2", bz2.finish().unwrap())] {
        put(place.path(), name, &bytes);
        is_as_meant(&reread(&place.path().join(name)), "BAL");
        put(place.path(), name, &bytes[..bytes.len() / 2]);
        let error = read(&place.path().join(name)).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains("cannot decompress the file"), "{error}");
    }
}

#[test]
fn row_errors_have_their_position() {
    let reread = |text: &str| read_control("c", text.as_bytes(), &["a.jpg", "b.jpg"]).err().unwrap().to_string();
    for (text, wanted) in [
        ("0 0 0 a.jpg 1 2\n0 0 nan b.jpg 1 2\n", "c:2:5: expected one of X Y Z, found `nan`"),
        ("0 0 0 a.jpg 1\n1 0 0 b.jpg 1 2\n", "c:1:14: the row ends where one of u v should follow"),
        ("0 0\n0 0 0\n", "c:1:4: the row ends where one of X Y Z should follow"),
        ("0 0 0 a.jpg 1 2 c.jpg 3 4\n", "c:1:17: unknown photograph `c.jpg`"),
        ("0 0 0 a.jpg 1 2 a.jpg 3 4\n", "c:1:17: the row repeats the photograph `a.jpg`"),
    ] {
        assert!(reread(text).starts_with(wanted), "{text}: {}", reread(text));
    }
    let read = read_control("c", b"# X Y Z\n1 2 3 b.jpg 4 5 a.jpg 6 7\r\n\n0 0 0\n", &["a.jpg", "b.jpg"]).unwrap();
    assert_eq!(read.iter().map(|point| point.1.len()).collect::<Vec<_>>(), [2, 0]);
    assert_eq!((read[0].0.z, read[0].1[0].view, read[0].1[1].pixel.y), (3.0, 1, 7.0));
}
