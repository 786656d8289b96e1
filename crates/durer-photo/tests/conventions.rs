//! What the table of conventions says, by hand: one camera that sees one point, written as each format has it.

use durer_photo::Reconstruction;
use durer_photo::format::{CONVENTIONS, Output, read, read_control};
use nalgebra::{Matrix3, Vector2, Vector3};
use std::path::Path;
use tempfile::TempDir;

// A picture of 640 x 480 pixels, f = 500, k1 = 0.1; the camera is turned by a right angle about z, t = (0.5, 1, 5). It sees
// X = (1, 2, 3) at P = (-1.5, 2, 8): p = (-0.1875, 0.25), r = 1 + 0.1 |p|² = 1.009765625, and so 94.66552734375 pixels left of the
// middle and 126.220703125 below it.
const PIXEL: [f64; 2] = [320.0 - 94.66552734375, 240.0 + 126.220703125];
const CENTER: [f64; 3] = [-1.0, 0.5, -5.0];
const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A format by its name in the table, what is read, and its files.
type Case = (&'static str, &'static str, Vec<(&'static str, Vec<u8>)>);

/// Each format that is read.
fn files() -> Vec<Case> {
    let bundler = "# Bundle file v0.3\n1 1\n500 0.1 0\n0 -1 0\n-1 0 0\n0 0 -1\n0.5 -1 -5\n1 2 3\n10 20 30\n1 0 0 -94.66552734375 -126.220703125\n";
    // A half turn about (1, -1, 0).
    let bal = "1 1 1\n0 0 -94.66552734375 -126.220703125\n2.221441469079183 -2.221441469079183 0\n0.5 -1 -5\n500 0.1 0\n1 2 3\n";
    let opensfm = r#"[{"cameras": {"c": {"projection_type": "perspective", "width": 640, "height": 480, "focal": 0.78125, "k1": 0.1, "k2": 0}},
        "shots": {"a.jpg": {"rotation": [0, 0, 1.5707963267948966], "translation": [0.5, 1, 5], "camera": "c"}},
        "points": {"7": {"color": [10, 20, 30], "coordinates": [1, 2, 3]}}}]"#;
    let tracks = "OPENSFM_TRACKS_VERSION_v2\na.jpg\t7\t0\t-0.147914886474609375\t0.1972198486328125\t1\t10\t20\t30\n";
    let images = format!("1 {HALF} 0 0 {HALF} 0.5 1 5 1 a.jpg\n{} {} 1\n", PIXEL[0], PIXEL[1]);
    let fspy = r#"{"principalPoint": {"x": 0, "y": 0}, "imageWidth": 640, "imageHeight": 480, "relativeFocalLength": 1.5625,
        "viewTransform": {"rows": [[0, -1, 0, 0.5], [-1, 0, 0, -1], [0, 0, -1, -5], [0, 0, 0, 1]]}}"#;
    let doubles = |values: &[f64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let longs = |values: &[u64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let ints = |values: &[u32]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    // Model 2 is SIMPLE_RADIAL.
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
    ]
}

/// Whether it is the camera and the point of the hand's calculation.
#[track_caller]
fn is_as_meant(all: &Reconstruction, name: &str) {
    let view = &all.views[0];
    let (lens, pose) = (&all.lenses[view.lens], view.pose.unwrap());
    assert!((pose.center() - Vector3::from(CENTER)).norm() < 1e-12, "{name}: {}", pose.center());
    let rotation = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    assert!((pose.rotation - rotation).norm() < 1e-12, "{name}: {}", pose.rotation);
    let radial = if name == "fSpy" { 0.0 } else { 0.1 };
    assert_eq!((lens.focal, lens.center, lens.radial), (500.0, [320.0, 240.0], [radial, 0.0]), "{name}");
    for point in &all.points {
        assert!((point.position - Vector3::new(1.0, 2.0, 3.0)).norm() < 1e-12, "{name}");
        let seen = &point.track[0];
        assert!((seen.pixel - Vector2::from(PIXEL)).norm() < 1e-9, "{name}: {}", seen.pixel);
        assert!(all.residual(&point.position, seen).unwrap().norm() < 1e-9, "{name}");
    }
    assert_eq!(all.points.len(), usize::from(name != "fSpy"), "{name}");
}

fn put(folder: &Path, name: &str, bytes: &[u8]) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, bytes).unwrap();
}

fn told(path: &Path) -> Reconstruction {
    let mut all = read(path).unwrap();
    all.set_picture(0, "a.jpg", [640, 480]);
    all
}

#[test]
fn every_format_means_what_the_table_says() {
    let place = TempDir::new().unwrap();
    let cases = files();
    let rows = CONVENTIONS.iter().filter(|row| row.way.starts_with("in")).map(|row| row.name);
    assert_eq!(rows.collect::<Vec<_>>(), cases.iter().map(|case| case.0).collect::<Vec<_>>());
    for (name, path, files) in cases {
        files.iter().for_each(|(file, bytes)| put(place.path(), file, bytes));
        let all = told(&place.path().join(path));
        is_as_meant(&all, name);
        // What is written is read as the same again.
        let row = CONVENTIONS.iter().find(|row| row.name == name).unwrap();
        if row.way.contains("out") {
            let again = place.path().join("again").join(path);
            let output = Output::of(&again, name.ends_with("binary")).unwrap();
            for (file, bytes) in output.files(&again).iter().zip(output.write(&all).unwrap()) {
                put(place.path(), file.strip_prefix(place.path()).unwrap().to_str().unwrap(), &bytes);
            }
            is_as_meant(&told(&again), name);
        }
    }
}

#[test]
fn what_is_only_written_means_what_the_table_says() {
    let place = TempDir::new().unwrap();
    let (_, path, files) = files().remove(2);
    files.iter().for_each(|(file, bytes)| put(place.path(), file, bytes));
    let all = told(&place.path().join(path));
    let gltf = Output::Gltf.write(&all).unwrap().remove(0);
    let gltf: serde_json::Value = serde_json::from_slice(&gltf).unwrap();
    let node = &gltf["nodes"][0];
    let numbers = |value: &serde_json::Value| {
        value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect::<Vec<f64>>()
    };
    assert!((Vector3::from_iterator(numbers(&node["translation"])) - Vector3::from(CENTER)).norm() < 1e-12);
    // From the camera's frame to the world: its -z is the world's z, its x the world's -y, and its y the world's -x.
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
    let body = ply.windows(11).position(|text| text == b"end_header\n").unwrap() + 11;
    let row = |place: [f64; 3], color: [u8; 3]| {
        place.iter().flat_map(|value| (*value as f32).to_le_bytes()).chain(color).collect::<Vec<u8>>()
    };
    assert_eq!(ply[body..], [row([1.0, 2.0, 3.0], [10, 20, 30]), row(CENTER, [255, 0, 0])].concat());
}

#[test]
fn what_is_packed_is_unpacked() {
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
        is_as_meant(&told(&place.path().join(name)), name);
        put(place.path(), name, &bytes[..bytes.len() / 2]);
        let error = read(&place.path().join(name)).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains("cannot be unpacked"), "{error}");
    }
}

#[test]
fn what_is_wrong_with_a_row_is_told_at_its_place() {
    let told = |text: &str| read_control("c", text.as_bytes(), &["a.jpg", "b.jpg"]).err().unwrap().to_string();
    for (text, wanted) in [
        ("0 0 0 a.jpg 1 2\n0 0 nan b.jpg 1 2\n", "c:2:5: `nan` is not one of X Y Z"),
        ("0 0 0 a.jpg 1\n1 0 0 b.jpg 1 2\n", "c:1:14: the row ends where one of u v should follow"),
        ("0 0\n0 0 0\n", "c:1:4: the row ends where one of X Y Z should follow"),
        ("0 0 0 a.jpg 1 2 c.jpg 3 4\n", "c:1:17: there is no photograph `c.jpg`"),
        ("0 0 0 a.jpg 1 2 a.jpg 3 4\n", "c:1:17: this row names twice the photograph `a.jpg`"),
    ] {
        assert!(told(text).starts_with(wanted), "{text}: {}", told(text));
    }
    let read = read_control("c", b"# X Y Z\n1 2 3 b.jpg 4 5 a.jpg 6 7\r\n\n0 0 0\n", &["a.jpg", "b.jpg"]).unwrap();
    assert_eq!(read.iter().map(|point| point.1.len()).collect::<Vec<_>>(), [2, 0]);
    assert_eq!((read[0].0.z, read[0].1[0].view, read[0].1[1].pixel.y), (3.0, 1, 7.0));
}
