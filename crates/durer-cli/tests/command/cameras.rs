//! Tests cameras on the command line: aspect ratios, alpha, and invalid values.

use crate::common::{SCENE, TestFolder};

/// Returns the shared test scene with a different camera.
fn seen_by(camera: &str) -> String {
    let (_, rest) = SCENE.split_once('\n').unwrap();
    format!("# ours\n{camera}\n{rest}")
}

const POSE: &str = "center 0 1 8 direction 0 -0.1 -1 up 0 1 0";

/// Returns the bits per pixel and the RGBA pixels of an uncompressed Targa picture, with the bottom
/// row first.
fn targa(folder: &TestFolder, name: &str) -> (u8, Vec<[u8; 4]>) {
    let bytes = folder.bytes(name);
    let (head, rest) = bytes.split_at(18);
    let pixels = match head[16] {
        32 => rest.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect(),
        _ => rest.chunks_exact(3).map(|p| [p[0], p[1], p[2], 255]).collect(),
    };
    (head[16], pixels)
}

#[test]
fn pixels_outside_the_camera_are_transparent_with_any_sampling() {
    let folder = TestFolder::new();
    folder.write("eye.txt", seen_by(&format!("FisheyeCamera {{ {POSE} angle 160 }}")));
    let ways = [
        "--samples 1",
        "--samples 16",
        "--sampler jittered --samples 9",
        "--jitter",
        "--show depth",
        "--show normals",
        "--show object",
    ];
    for way in ways {
        folder.expect_exit(0, &format!("render eye.txt --size 40x40 -o eye.tga {way}"));
        let (bits, pixels) = targa(&folder, "eye.tga");
        assert_eq!(bits, 32, "{way}");
        let at = |x: usize, y: usize| pixels[y * 40 + x];
        assert_eq!([at(0, 0), at(39, 0), at(0, 39), at(39, 39)], [[0; 4]; 4], "{way}");
        assert_eq!([at(20, 20)[3], at(20, 1)[3], at(38, 20)[3]], [255; 3], "{way}");
        // With several samples per pixel, the rim of the image circle is antialiased.
        let partly = pixels.iter().filter(|p| ![0, 255].contains(&p[3])).count();
        assert_eq!(partly > 20, way.contains("jitter") || way == "--samples 16", "{way}: {partly}");
        // Area of the disc in pixels.
        let area: f64 = pixels.iter().map(|p| f64::from(p[3]) / 255.0).sum();
        assert!((area / (400.0 * std::f64::consts::PI) - 1.0).abs() < 0.02, "{way}: {area}");
    }
    // Formats without alpha show black outside the image circle. A picture that is fully covered
    // has no alpha channel.
    folder.expect_exit(0, "render eye.txt --size 40x40 -o eye.ppm");
    assert_eq!(folder.image8("eye.ppm").pixels[0], [0; 3]);
    folder.expect_exit(0, "render eye.txt --size 40x40 -o inside.tga --crop 10,10,20x20");
    assert_eq!(targa(&folder, "inside.tga").0, 24);
}

#[test]
fn pictures_have_the_aspect_ratio_of_their_cameras() {
    let folder = TestFolder::new();
    for (camera, size) in [
        ("FisheyeCamera {@}", (512, 512)),
        ("EquirectangularCamera {@}", (720, 360)),
        ("EquirectangularCamera {@ eyes topBottom}", (360, 360)),
        ("EquirectangularCamera {@ eyes sideBySide}", (720, 180)),
        ("CubeMapCamera {@}", (592, 444)),
        ("CubeMapCamera {@ layout strip}", (1254, 209)),
        ("StereoCamera {@ angle 40 separation 0.1 aspect 1.5}", (888, 296)),
        ("CaveCamera {center 0 1 8 walls {-3 0 4 3 0 4 -3 4 4 3 0 4 3 0 8 3 4 4}}", (810, 324)),
        ("PerspectiveCamera {@ angle 40}", (512, 512)),
    ] {
        folder.write("shape.txt", seen_by(&camera.replace('@', POSE)));
        let output = folder.expect_exit(0, "info shape.txt").out;
        let (width, height) = size;
        assert!(output.contains(&format!("picture    {width}x{height} by default")), "{camera}: {output}");
    }
    // With a different aspect ratio, the image is not distorted, and a warning reports the empty
    // pixels.
    folder.write("sphere.txt", seen_by(&format!("EquirectangularCamera {{ {POSE} }}")));
    let output = folder.expect_exit(0, "render sphere.txt -o a.tga --size 40x40 --samples 1").err;
    assert!(output.contains("20 rows of the 40x40 picture stay empty") && output.contains("--size 56x28"), "{output}");
    let (_, square) = targa(&folder, "a.tga");
    let output = folder.expect_exit(0, "render sphere.txt -o b.tga --size 40x20 --samples 1").err;
    assert!(!output.contains("empty"), "{output}");
    let (bits, whole) = targa(&folder, "b.tga");
    assert_eq!((bits, &square[400..1200], square[0]), (24, &whole[..], [0; 4]));
}

#[test]
fn lens_pictures_are_identical_in_crops_and_on_any_number_of_threads() {
    let folder = TestFolder::new();
    let lens = format!("ThinLensCamera {{ {POSE} angle 40 aperture 0.8 focusDistance 8 blades 5 }}");
    folder.write("lens.txt", seen_by(&lens));
    folder.write("sharp.txt", seen_by(&lens.replace("aperture 0.8", "aperture 0")));
    for way in ["--samples 8", "--sampler random --samples 8"] {
        folder.expect_exit(0, &format!("render lens.txt -o whole.pfm --size 40x40 --threads 2 {way}"));
        folder.expect_exit(0, &format!("render lens.txt -o part.pfm --size 40x40 --crop 7,9,20x21 --threads 1 {way}"));
        let (whole, part) = (folder.image("whole.pfm"), folder.image("part.pfm"));
        for (x, y) in (0..21).flat_map(|y| (0..20).map(move |x| (x, y))) {
            assert_eq!(part.get(x, y), whole.get(x + 7, y + 9), "{way} {x},{y}");
        }
    }
    // A single sample passes through the centre of the lens, so everything is in focus.
    let output = folder.expect_exit(0, "render lens.txt -o one.pfm --size 40x40 --samples 1").err;
    assert!(output.contains("everything is in focus"), "{output}");
    folder.expect_exit(0, "render sharp.txt -o sharp.pfm --size 40x40 --samples 1");
    assert_eq!(folder.bytes("one.pfm"), folder.bytes("sharp.pfm"));
}

#[test]
fn invalid_cameras_are_refused() {
    let folder = TestFolder::new();
    let refused = |camera: &str, words: &[&str]| {
        folder.write("wrong.txt", seen_by(&camera.replace('@', POSE)));
        folder.expect_failure(2, "render wrong.txt -o p.png --dialect durer", words);
    };
    refused("FisheyeCamera {@ projection equdistant}", &["wrong.txt:2:", "equdistant", "did you mean `equidistant`?"]);
    refused("FisheyeCamera {@ projection 3}", &["cannot be `3`", "stereographic"]);
    refused("FisheyeCamera {@ angle 400}", &["at most 360"]);
    refused("FisheyeCamera {@ angle 200 projection orthographic}", &["wrong.txt:2:1", "at most 180 degrees"]);
    refused("FisheyeCamera {@ projection }", &["`projection` needs one of"]);
    refused("ThinLensCamera {@ angle 40 blades 2}", &["`blades` must be 0"]);
    refused("OmnimaxCamera {@ viewer 0 2 0}", &["inside the dome"]);
    refused("CaveCamera {center 0 0 0 walls {1 2 3}}", &["rows of 9 numbers, but has 3"]);
    refused("CaveCamera {center 0 0 0 walls {}}", &["must have 1 to 64 rows, but has 0"]);
    refused("CaveCamera {center 0 0 0 walls {0 0 0 1 0 0 0 1 x}}", &["number 9 of 9", "`x`"]);
    refused("CaveCamera {center 0 0 0 walls 0 0 0}", &["`walls` needs `{`"]);
    refused("CaveCamera {center 0 0 0 walls {-1 -1 0 1 -1 0 -1 1 0}}", &["an eye is in the plane of wall 1"]);
    refused("PushBroomCamera {start 0 0 0 end 0 0 -1 direction 0 0 -1 up 0 1 0 angle 60}", &["must move sideways"]);
    refused("MultipleCenterCamera {path {0 0 0 0 0 0  1 0 0 1 0 -1} up 0 1 0 angle 50}", &["at row 1 of `path`"]);
    refused("ProjectiveCamera {matrix {1 0 0 0 0 1 0 0 0 0 0 1} width 9 height 9}", &["singular"]);
    refused("ProjectiveCamera {width 9 height 9}", &["has no `matrix`"]);
    refused("FishEyeCamera {@}", &["did you mean `FisheyeCamera`?"]);
    refused("FisheyeCamera {@} FisheyeCamera {@ walls 3}", &["no field `walls`"]);
    // These keywords are extensions of the language, so --strict rejects them.
    folder.write("ours.txt", seen_by(&format!("FisheyeCamera {{ {POSE} }}")).replace("# ours\n", ""));
    folder.expect_failure(2, "render ours.txt -o p.png --strict", &["`FisheyeCamera` is a Dürer extension"]);
    folder.expect_failure(2, "render ours.txt -o p.png --strict --dialect f04", &["`FisheyeCamera`"]);
    let output = folder.expect_exit(0, "render ours.txt -o p.png --size 9x9 --dialect f04").err;
    assert!(output.contains("`FisheyeCamera` is not a word of f04"), "{output}");
    assert_eq!(output.matches("warning").count(), 1, "{output}");
    folder.write("short.txt", seen_by("FisheyeCamera { center 0 1 8 up 0 1 0 }").replace("# ours\n", ""));
    folder.expect_failure(2, "render short.txt -o q.png --dialect f04", &["`FisheyeCamera` has no `direction`"]);
    // Converted scenes produce the same picture.
    folder.expect_exit(0, "convert ours.txt -o again.txt");
    folder.expect_exit(0, "render ours.txt -o a.pfm --size 20x20 --samples 2");
    folder.expect_exit(0, "render again.txt -o b.pfm --size 20x20 --samples 2");
    assert_eq!(folder.bytes("a.pfm"), folder.bytes("b.pfm"));
}
