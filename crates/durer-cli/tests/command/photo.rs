//! Tests `durer photo` with photographs rendered by Dürer, for which the correct result is known,
//! and with files that are not photographs.

use crate::common::{TestFolder, browser, corpus};
use durer::image::read8;
use durer_photo::format::{projective_camera, read};
use durer_photo::geometry::align::align_cameras;
use durer_photo::model::axis_angle_of;
use durer_photo::{Lens, Pose, Reconstruction};
use nalgebra::Vector3;
use std::path::Path;

/// Width, height and focal length of the photographs, in pixels.
const SIZE: [u32; 2] = [400, 300];
const FOCAL: f64 = 410.0;
/// Length of the scene in world units.
const LENGTH: f64 = 8.0;

/// Folder with photographs that Dürer has rendered.
const PHOTOGRAPHS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/photographs");

/// Boxes and walls with a noise texture in uniform light.
const SCENE: &str = "
Background { color 0.1 0.1 0.1 ambientLight 1 1 1 }
Materials { numMaterials 3
  PhongMaterial { Noise { color 1 0.95 0.8 color 0.05 0.1 0.1 octaves 4 frequency 3 amplitude 12 } }
  PhongMaterial { Noise { color 1 0.4 0.2 color 0.1 0.1 0.3 octaves 4 frequency 4 amplitude 14 } }
  PhongMaterial { Noise { color 0.9 1 0.9 color 0.1 0.3 0.1 octaves 4 frequency 5 amplitude 12 } } }
Group { numObjects 8
  MaterialIndex 0 Rectangle { corner -4 0 4 edge0 8 0 0 edge1 0 0 -8 }
  MaterialIndex 2 Rectangle { corner -4 0 -2.5 edge0 8 0 0 edge1 0 4 0 }
  MaterialIndex 1 Rectangle { corner -4 0 4 edge0 0 0 -8 edge1 0 4 0 }
  MaterialIndex 1 Box { min -1.2 0 -0.8 max 0.1 1.1 0.3 }
  MaterialIndex 2 Box { min 0.4 0 -1.4 max 1.5 1.9 -0.4 }
  MaterialIndex 0 Box { min 0.6 0 0.4 max 1.3 0.6 1.1 }
  MaterialIndex 2 Sphere { center -1.6 0.5 1.2 radius 0.5 }
  MaterialIndex 1 Box { min -2.8 0 -1.9 max -1.8 1.5 -1 } }
";

/// Returns twenty cameras in two rows along an arc.
fn cameras() -> Vec<Pose> {
    let camera = |i: usize| {
        let (angle, height) = ((f64::from(i as u32 % 10) - 4.5) * 0.11, if i < 10 { 1.4 } else { 2.6 });
        let center = Vector3::new(6.0 * libm::sin(angle), height, 6.0 * libm::cos(angle) - 0.5);
        Pose::look_at(&center, &Vector3::new(0.05 * height, 0.7, -0.3), &Vector3::y())
    };
    (0..20).map(camera).collect()
}

/// Returns the errors of a solution after alignment by a similarity transform: the largest camera
/// distance and the largest angle in degrees.
fn differences(all: &Reconstruction, truth: &[Pose]) -> (f64, f64) {
    let found: Vec<Pose> = all.views.iter().map(|view| view.pose.unwrap()).collect();
    let there = align_cameras(&found, truth).unwrap();
    let (mut folder, mut angle) = (0.0_f64, 0.0_f64);
    for (found, truth) in found.iter().zip(truth) {
        folder = folder.max((there.apply(&found.center()) - truth.center()).norm());
        let turned = found.rotation * there.rotation.transpose() * truth.rotation.transpose();
        angle = angle.max(axis_angle_of(&turned).norm().to_degrees());
    }
    (folder, angle)
}

#[test]
fn photographs_of_a_known_scene_give_its_cameras() {
    let folder = TestFolder::new();
    std::fs::create_dir(folder.path("photos")).unwrap();
    let lens = Lens::new(SIZE, FOCAL);
    for (i, pose) in cameras().iter().enumerate() {
        folder.write("shot.txt", projective_camera(&lens, pose) + SCENE);
        let [width, height] = SIZE;
        folder.expect_exit(0, &format!("render shot.txt -o photos/{i:02}.png --size {width}x{height} --samples 4 -q"));
    }
    folder.expect_exit(0, "photo match photos -o matches.json --features 1200 --field 60 -q");
    let solved = folder.expect_exit(0, "photo solve matches.json -o solved -o points.ply -o scene.gltf -o bundle.out");
    println!("{}", solved.out);
    folder.expect_exit(0, "photo explain solved --camera 03.png");
    folder.expect_exit(0, "photo explain bundle.out --point 3");
    for (file, there) in [("points.ply", "0 of 0"), ("scene.gltf", "20 of 20")] {
        let points = solved.out.split("; ").nth(1).and_then(|rest| rest.split('\n').next()).unwrap();
        assert_eq!(
            folder.expect_exit(0, &format!("photo convert {file}")).out,
            format!("{there} photographs registered; {points}\n")
        );
    }
    assert!(
        folder
            .expect_exit(0, "photo explain scene.gltf --camera 03.png")
            .out
            .contains("the file has no observations in this photograph")
    );
    assert!(
        folder
            .expect_exit(0, "photo explain points.ply --point 3")
            .out
            .contains("the file has no observations of this point")
    );
    folder.expect_failure(2, "photo convert matches.json", &["the file contains matches without cameras"]);
    folder.expect_failure(2, "photo solve scene.gltf -o no.out", &["there is nothing to adjust"]);
    folder.expect_failure(
        2,
        "photo tour points.ply --pictures photos -o no.html",
        &["no photograph of `points.ply` has a camera position"],
    );
    folder.expect_exit(0, "photo tour solved --pictures photos -o tour.html --side 64 -q");
    let walked = [
        "20 photographs, ",
        "button first: choose a photograph first, at -1",
        "strip: 03.png: sees ",
        "opacity 0.95, at 3 | fills true",
        "is left true",
        "another true",
        "point in several true",
        "all: 20 photographs, ",
        "turned true",
        "keys true",
    ];
    browser::sees(&folder, "tour.html", include_str!("common/walk.js"), &walked);
    folder.expect_failure(
        2,
        "photo explain solved --camera 77.png",
        &["no photograph `77.png`; known photographs: 00.png"],
    );
    let all = read(&folder.path("solved")).unwrap();
    assert_eq!(all.registered_count(), 20);
    let (far, angle) = differences(&all, &cameras());
    let focal = (all.lenses[0].focal / FOCAL - 1.0).abs();
    println!("{far} {angle} {focal}");
    assert!(far <= 0.001 * LENGTH, "{far}");
    assert!(angle <= 0.05, "{angle}");
    assert!(focal <= 0.002, "{focal}");
}

#[test]
fn results_are_independent_of_threads() {
    let folder = TestFolder::new();
    for threads in [1, 2, 5] {
        folder.expect_exit(
            0,
            &format!("photo match {PHOTOGRAPHS} -o {threads}.json --features 800 --threads {threads} -q"),
        );
        folder.expect_exit(0, &format!("photo solve {threads}.json -o {threads}.out --threads {threads} -q"));
    }
    assert_eq!(folder.bytes("1.json"), folder.bytes("2.json"));
    assert_eq!(folder.bytes("1.json"), folder.bytes("5.json"));
    assert_eq!(folder.bytes("1.out"), folder.bytes("2.out"));
    assert_eq!(folder.bytes("1.out"), folder.bytes("5.out"));
}

/// Returns a JPEG whose EXIF data contain a focal length in millimetres and a sensor resolution in
/// pixels per inch.
fn with_exif(jpeg: &[u8], millimetres: [u32; 2], pixels: [u32; 2]) -> Vec<u8> {
    let entry = |tag: u16, kind: u16, value: u32| {
        [&tag.to_be_bytes()[..], &kind.to_be_bytes(), &1_u32.to_be_bytes(), &value.to_be_bytes()].concat()
    };
    let end = vec![0; 4];
    let first = [vec![0, 1], entry(0x8769, 4, 26), end.clone()].concat();
    let second = [vec![0, 2], entry(0x920a, 5, 56), entry(0xa20e, 5, 64), end].concat();
    let numbers = [millimetres, pixels].concat().into_iter().flat_map(u32::to_be_bytes).collect();
    let tiff = [b"MM\0*\0\0\0\x08".to_vec(), first, second, numbers].concat();
    let length = (tiff.len() as u16 + 8).to_be_bytes();
    [&jpeg[..2], &[0xff, 0xe1], &length, b"Exif\0\0", &tiff, &jpeg[2..]].concat()
}

#[test]
fn implausible_exif_is_reported_and_wrong_exif_is_corrected() {
    let folder = TestFolder::new();
    std::fs::create_dir(folder.path("photos")).unwrap();
    let photographs = (0..6).map(|i| (i, std::fs::read(Path::new(PHOTOGRAPHS).join(format!("{i}.jpg"))).unwrap()));
    for (i, jpeg) in photographs {
        // The true focal length is 330 pixels, and 660 pixels would be possible. One value is too
        // long for any lens, and another would cause a division by zero.
        let (millimetres, pixels) = match i {
            0 => ([5, 1], [1_000_000_000, 1]),
            1 => ([5, 0], [1000, 1]),
            _ => ([254, 10], [660, 1]),
        };
        folder.write(&format!("photos/{i}.jpg"), with_exif(&jpeg, millimetres, pixels));
    }
    let matched = folder.expect_exit(0, "photo match photos -o m.json --features 1500 --field 60");
    assert!(matched.err.contains("warning: 0.jpg: EXIF's focal length, 196850394 pixels from 5 mm"), "{}", matched.err);
    assert!(!matched.err.contains("1.jpg") && matched.out.contains("1.jpg: 320x240, 1500 features, focal length 277"));
    assert!(matched.out.contains("2.jpg: 320x240, 1500 features, focal length 660 (EXIF: 25.4 mm"), "{}", matched.out);
    let solved = folder.expect_exit(0, "photo solve m.json -o m.out");
    assert!(solved.err.contains("EXIF wrongly says 660"), "{}", solved.err);
    for lens in read(&folder.path("m.out")).unwrap().lenses {
        assert!((lens.focal - 330.0).abs() < 5.0, "{lens:?}");
    }
}

/// Returns a PNG with noise that depends on the seed.
fn noise(seed: u64) -> Vec<u8> {
    let mut random = durer_photo::random::Random::new(seed);
    let picture = image::GrayImage::from_fn(160, 120, |_, _| image::Luma([random.bits() as u8]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

#[test]
fn unsuitable_photographs_are_refused() {
    let folder = TestFolder::new();
    let refused = |words: &[&str]| folder.expect_failure(2, "photo match photos -o m.json", words);
    refused(&["cannot read the folder `photos`"]);
    std::fs::create_dir(folder.path("photos")).unwrap();
    refused(&["no photographs (.jpg, .jpeg, .png) in `photos`"]);
    folder.write("photos/a.png", noise(1));
    refused(&["at least two photographs are needed"]);
    folder.write("photos/b.png", noise(1));
    refused(&["are the same picture"]);
    folder.write("photos/b.png", noise(2));
    refused(&["no two photographs show the same objects"]);
    folder.write("photos/b.png", &noise(2)[..900]);
    refused(&["b.png: cannot be read as a picture"]);
    folder.write("photos/b.png", noise(2));
    folder.write("photos/b.jpg", "no picture");
    refused(&["b.jpg: the file is neither a JPEG nor a PNG"]);
    // A decoder would fill the missing parts with grey.
    let jpeg = std::fs::read(Path::new(PHOTOGRAPHS).join("0.jpg")).unwrap();
    folder.write("photos/b.jpg", &jpeg[..jpeg.len() / 2]);
    refused(&["b.jpg: cannot be read as a picture: the JPEG is truncated"]);
    std::fs::remove_file(folder.path("photos/b.jpg")).unwrap();
    // A folder does not count as a photograph.
    std::fs::create_dir(folder.path("photos/folder.jpg")).unwrap();
    refused(&["no two photographs show the same objects"]);
    assert!(!folder.path("m.json").exists());
    false_matches_are_refused(&folder);
}

/// The matches of eight photographs include twenty thousand random correspondences, which must be
/// rejected.
fn false_matches_are_refused(folder: &TestFolder) {
    let mut random = durer_photo::random::Random::new(7);
    let picture = |i: usize| {
        format!(
            r#"{{"name": "{i}.jpg", "size": [400, 300], "focal": 400, "focal_from": "a guess", "lens": 0, "features": 9}}"#
        )
    };
    let pairs: Vec<(usize, usize)> = (0..8).flat_map(|a| (a + 1..8).map(move |b| (a, b))).collect();
    let link = |(a, b): &(usize, usize)| {
        format!(r#"{{"pictures": [{a}, {b}], "alike": 700, "matches": 700, "planar": 0.2, "moved": 50}}"#)
    };
    let mut seen =
        |view: usize, i: usize| format!("[{view}, {i}, {}, {}]", 400.0 * random.unit(), 300.0 * random.unit());
    let mut track = |i: usize| {
        let (a, b) = pairs[i % pairs.len()];
        format!(r#"{{"color": [0, 0, 0], "seen": [{}, {}]}}"#, seen(a, i), seen(b, i))
    };
    let tracks: Vec<String> = (0..20_000).map(&mut track).collect();
    let list = |rows: Vec<String>| rows.join(",\n");
    let (pictures, links) = (list((0..8).map(picture).collect()), list(pairs.iter().map(link).collect()));
    let (format, tracks) = (durer_photo::matching::FORMAT, list(tracks));
    folder.write(
        "false.json",
        format!(r#"{{"format": "{format}", "pictures": [{pictures}], "links": [{links}], "tracks": [{tracks}]}}"#),
    );
    folder.expect_failure(2, "photo solve false.json -o solved", &["share enough points that agree on one geometry"]);
    assert!(!folder.path("solved").exists());
}

#[test]
fn broken_files_are_refused_with_their_place() {
    let folder = TestFolder::new();
    folder.write("p.png", noise(1));
    let flat =
        "# X Y Z u v\n0 0 0 10 10\n1 0 0 50 10\n0 1 0 10 50\n1 1 0 50 52\n2 0 0 90 11\n0 2 0 12 90\n2 2 0 95 96\n";
    for (file, content, command, words) in [
        ("b.out", "# Bundle file v0.3\n1 0\n700 0 x\n", "photo convert b.out -o c.ply", &["b.out:3:7", "`x`"][..]),
        ("b.out", "1 1\n", "photo convert b.out -o c.ply", &["b.out", "the file ends"]),
        ("b.out", "9999999 1\n", "photo convert b.out -o c.ply", &["b.out:1:1", "too short"]),
        ("b.txt", "1 1 1\n3 0 1 1\n", "photo solve b.txt -o c.ply", &["b.txt:2:1", "less than 1, found `3`"]),
        ("b.txt", "BZh91AY", "photo solve b.txt -o c.ply", &["b.txt", "cannot decompress the file (bzip2)"]),
        ("b.json", "[{\"cameras\": 3}]", "photo convert b.json -o c.ply", &["b.json:1:"]),
        ("m.json", "{\"format\": \"durer matches 1\"}", "photo solve m.json -o c.ply", &["m.json:1:"]),
        ("b.xyz", "", "photo convert b.xyz -o c.ply", &["the name must end in"]),
        (
            "p.points",
            flat,
            "photo camera p.png --points p.points -o c.txt",
            &["lie in a plane, so DLT has no unique solution"],
        ),
        (
            "p.points",
            "0 0 0 1\n",
            "photo camera p.png --points p.points -o c.txt",
            &["p.points:1:8: the row ends where"],
        ),
        (
            "p.points",
            "0 0 0 1 2 3\n",
            "photo camera p.png --points p.points -o c.txt",
            &["p.points:1:11: the row should end"],
        ),
        (
            "p.points",
            "0 0 O 1 2\n",
            "photo camera p.png --points p.points -o c.txt",
            &["1:5: expected one of X Y Z u v, found `O`"],
        ),
        (
            "b.out",
            "1 0\n700 0 0 9 9 9 0 1 0 0 0 1 0 0 0\n",
            "photo convert b.out -o c.ply",
            &["b.out:2:9", "do not form a rotation matrix"],
        ),
        ("b.out", "1 0\n-700 0 0\n", "photo convert b.out -o c.ply", &["b.out:2:1", "must be positive"]),
        ("b.txt", "1 0 0\n0 0 0 0 0 0 0 0 0\n", "photo solve b.txt -o c.ply", &["b.txt:2:1", "focal length"]),
        ("p.lines", "x 1 2 3 4\nq 1 2 3 4\n", "photo camera p.png --lines p.lines -o c.txt", &["p.lines:2:1"]),
        ("p.fspy", "fspy\u{9}\0\0\0", "photo camera p.fspy -o c.txt", &["version is 9"]),
    ] {
        folder.write(file, content);
        folder.expect_failure(2, command, words);
    }
    // If pixels are counted from the bottom, no camera fits, although a camera can see some of the
    // points.
    let ours = |name: &str| std::fs::read(Path::new(PHOTOGRAPHS).join(name)).unwrap();
    folder.write("2.jpg", ours("2.jpg"));
    let points = String::from_utf8(ours("2.points")).unwrap();
    let turned = |row: &str| {
        let (row, v) = row.rsplit_once(' ').unwrap();
        format!("{row} {}\n", 240.0 - v.parse::<f64>().unwrap())
    };
    let rows = points.lines().filter(|row| !row.starts_with('#'));
    folder.write("turned.points", rows.map(turned).collect::<String>());
    folder.expect_failure(
        2,
        "photo camera 2.jpg --points turned.points -o c.txt",
        &["fewer than two thirds", "v from the top"],
    );
    std::fs::create_dir(folder.path("twice")).unwrap();
    folder.write("twice/cameras.txt", "1 SIMPLE_PINHOLE 9 9 5 4 4\n1 SIMPLE_PINHOLE 9 9 5 4 4\n");
    folder.write("twice/images.txt", "");
    folder.write("twice/points3D.txt", "");
    folder.expect_failure(2, "photo convert twice -o c.ply", &["twice/cameras.txt:2:", "the id 1 occurs twice"]);
    folder.write("twice/cameras.txt", "1 SIMPLE_PINHOLE 9 9 5 4 4 7\n");
    folder.expect_failure(2, "photo convert twice -o c.ply", &["twice/cameras.txt:1:28: the row should end here"]);
    folder.expect_failure(2, "photo camera p.png", &["--points FILE or --lines FILE"]);
    folder.expect_failure(2, "photo solve b.txt -o b.txt", &["is an input of this run"]);
}

/// Returns a square PNG without content.
fn square() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::GrayImage::new(64, 64).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

#[test]
fn objects_are_placed_in_a_photograph_with_shadows() {
    let folder = TestFolder::new();
    let ours = |name: &str| Path::new(PHOTOGRAPHS).join(name);
    for name in ["placed.txt", "2.jpg"] {
        folder.write(name, std::fs::read(ours(name)).unwrap());
    }
    folder.expect_exit(0, "photo place placed.txt --backplate 2.jpg -o placed.png --samples 4 -q");
    let placed = read8(&std::fs::read(folder.path("placed.png")).unwrap(), "placed.png").unwrap();
    let plate = image::open(ours("2.jpg")).unwrap().into_rgb8();
    assert_eq!((placed.width, placed.height), plate.dimensions());
    let sum = |left: u32, top: u32, width: u32, height: u32| {
        let pixels = (top..top + height).flat_map(|y| (left..left + width).map(move |x| (x, y)));
        pixels.fold([[0_u32; 3]; 2], |sum, (x, y)| {
            let both = [placed.pixels[(y * placed.width + x) as usize], plate.get_pixel(x, y).0];
            [0, 1].map(|i| [0, 1, 2].map(|c| sum[i][c] + u32::from(both[i][c])))
        })
    };
    // Apart from rounding, pixels without objects and shadows are equal to the photograph.
    let [now, before] = sum(0, 0, 320, 80);
    assert!((0..3).all(|c| now[c].abs_diff(before[c]) < 320 * 80 / 100), "{now:?} {before:?}");
    // The shadow lies to the left of the red ball. Where the ball is, the picture is red instead of
    // grey.
    let [now, before] = sum(90, 196, 30, 10);
    assert!((0..3).all(|c| now[c] * 10 < before[c] * 9 && now[c] * 4 > before[c]), "{now:?} {before:?}");
    let [now, before] = sum(135, 150, 20, 20);
    assert!(now[0] > 2 * now[2] && before[0] < 3 * before[2], "{now:?} {before:?}");
    for (options, words) in [
        (
            "placed.txt --backplate 2.jpg --stand-in 9",
            "--stand-in 9: the scene has only 4 materials, which are numbered from 0",
        ),
        ("placed.txt --backplate 2.jpg --stand-in 0,1,2,3", "there is nothing to insert"),
        ("placed.txt --backplate 2.jpg --size 10x10", "the picture has the photograph's size, 320x240"),
        ("placed.txt --backplate square.png", "the scene's camera does not fit `square.png`"),
        ("placed.txt --backplate placed.txt", "neither a JPEG nor a PNG"),
    ] {
        folder.write("square.png", square());
        folder.expect_failure(2, &format!("photo place {options} -o no.png"), &[words]);
        assert!(!folder.path("no.png").exists());
    }
}

#[test]
fn object_is_placed_in_an_external_photograph() {
    let Some(course) = corpus() else { return };
    let picture = course.with_file_name("samples/photos/bundler-kermit/kermit001.jpg");
    if !picture.is_file() {
        return println!("skipped: {} not found", picture.display());
    }
    let folder = TestFolder::new();
    folder.write("plate.jpg", std::fs::read(&picture).unwrap());
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/chair.txt");
    folder.expect_exit(0, &format!("photo place {scene} --backplate plate.jpg -o placed.png --samples 4 -q"));
    let placed = read8(&folder.bytes("placed.png"), "placed.png").unwrap();
    let plate = image::open(picture).unwrap().into_rgb8();
    let luma = |left: u32, top: u32, width: u32, height: u32| {
        let pixels = (top..top + height).flat_map(|y| (left..left + width).map(move |x| (x, y)));
        pixels.fold([0_u32; 2], |[now, before], (x, y)| {
            let sum = |p: [u8; 3]| p.iter().map(|c| u32::from(*c)).sum::<u32>();
            [now + sum(placed.pixels[(y * placed.width + x) as usize]), before + sum(plate.get_pixel(x, y).0)]
        })
    };
    // The books do not change. The seat is darker to the left of the solid and to the left of the
    // ball, where the foot also casts a shadow.
    let [now, before] = luma(120, 140, 220, 230);
    assert!(now.abs_diff(before) * 100 < before, "{now} {before}");
    for [now, before] in [luma(466, 442, 8, 6), luma(518, 444, 4, 6)] {
        assert!(now * 10 < before * 8 && now * 4 > before, "{now} {before}");
    }
}
