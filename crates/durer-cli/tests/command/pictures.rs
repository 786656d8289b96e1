//! Tests the pictures of `durer render`, and options that must not change them by a single bit.

use crate::common::{self, SCENE, TestFolder};

/// Sampling options that are tested.
const SAMPLINGS: [&str; 9] = [
    "--samples 1",
    "--samples 5",
    "--samples 4 --filter mitchell",
    "--sampler random --samples 3",
    "--sampler uniform --samples 4 --filter tent --filter-radius 1.5",
    "--sampler jittered --samples 4 --filter gaussian",
    "--jitter",
    "--blur",
    "--jitter --blur --seed 7",
];

#[test]
fn crop_equals_that_part_of_the_whole_picture() {
    let folder = TestFolder::new();
    for sampling in SAMPLINGS {
        for dialect in ["f04", "f12a4", "durer"] {
            let render =
                format!("render scene.txt --dialect {dialect} --size 37x29 --show color,depth,normals {sampling}");
            folder.write(
                "scene.txt",
                if dialect == "f12a4" { SCENE.replace("reflectiveColor 0.5 0.5 0.5", "") } else { SCENE.into() },
            );
            folder.expect_exit(0, &format!("{render} -o whole.pfm"));
            folder.expect_exit(0, &format!("{render} -o part.pfm --crop 11,7,19x21"));
            for show in ["color", "depth", "normals"] {
                let (whole, part) =
                    (folder.image(&format!("whole.{show}.pfm")), folder.image(&format!("part.{show}.pfm")));
                assert_eq!((whole.width, whole.height, part.width, part.height), (37, 29, 19, 21));
                let bits = |pixel: Option<durer::math::Vec3>| pixel.unwrap().to_array().map(f32::to_bits);
                for (x, y) in (0..21).flat_map(|y| (0..19).map(move |x| (x, y))) {
                    assert_eq!(
                        bits(part.get(x, y)),
                        bits(whole.get(x + 11, y + 7)),
                        "{sampling} {dialect} {show} {x},{y}"
                    );
                }
            }
        }
    }
}

#[test]
fn threads_and_accelerators_change_no_bit() {
    let folder = TestFolder::new();
    for sampling in SAMPLINGS {
        let render = format!("render scene.txt --size 40x30 {sampling} -o");
        folder.expect_exit(0, &format!("{render} first.pfm --threads 1"));
        for other in ["--threads 2", "--threads 7", "--accel none", "--accel grid", "--grid 3x4x5"] {
            folder.expect_exit(0, &format!("{render} other.pfm {other}"));
            assert!(folder.bytes("first.pfm") == folder.bytes("other.pfm"), "{sampling} {other}");
        }
    }
}

#[test]
fn background_is_transparent_or_a_color() {
    let folder = TestFolder::new();
    folder.write("ball.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    let render = "render ball.obj --size 40x30 --samples 4 --view front --background";
    folder.expect_exit(0, &format!("{render} transparent -o open.png"));
    let picture = folder.image8("open.png");
    // The model has no ground, and edges are partly covered.
    assert_eq!((picture.alpha[0], picture.alpha[20 * 40 + 15], picture.alpha[29 * 40]), (0, 255, 0));
    assert!(picture.alpha.iter().any(|alpha| (1..255).contains(alpha)));
    folder.expect_exit(0, &format!("{render} 0,0.25,1 -o blue.pfm"));
    let blue = folder.image("blue.pfm");
    assert_eq!(blue.get(0, 0).unwrap().to_array(), [0.0, 0.25, 1.0]);
    for (name, shown) in [("white", [255; 3]), ("black", [0; 3]), ("#ffcc00", [255, 204, 0])] {
        folder.expect_exit(0, &format!("{render} {name} -o named.png"));
        assert_eq!(folder.image8("named.png").pixels[0], shown, "{name}");
    }
    let refused = folder.expect_exit(2, &format!("{render} transparent -o open.jpg"));
    assert!(refused.err.contains("JPEG files cannot be transparent: write a PNG"), "{}", refused.err);
    for wrong in ["1,1", "-1,0,0", "whit", "#ffcc0", "nan,0,0"] {
        let refused = folder.expect_exit(2, &format!("{render}={wrong} -o open.png"));
        assert!(refused.err.contains("or red, green and blue"), "{}", refused.err);
    }
    folder.write("fog.txt", format!("{SCENE}\nFog {{ extinction 0.1 }}"));
    let refused = folder.expect_exit(2, "render fog.txt --dialect durer --background 1,1,1 -o fog.png");
    assert!(refused.err.contains("fog in front of it"), "{}", refused.err);
}

#[test]
fn seed_changes_random_pictures_only() {
    let folder = TestFolder::new();
    for sampling in SAMPLINGS {
        let render = format!("render scene.txt --size 30x30 {} -o", sampling.replace("--seed 7", ""));
        folder.expect_exit(0, &format!("{render} 0.pfm"));
        folder.expect_exit(0, &format!("{render} 1.pfm --seed 18446744073709551615"));
        let fixed = matches!(sampling, "--samples 1" | "--blur") || sampling.contains("uniform");
        assert_eq!(folder.bytes("0.pfm") == folder.bytes("1.pfm"), fixed, "{sampling}");
    }
}

#[test]
fn every_format_is_written_and_read_back() {
    let folder = TestFolder::new();
    let mut eight_bit = Vec::new();
    for format in durer::image::FORMATS {
        for extension in format.extensions {
            let name = format!("picture.{extension}");
            let output = folder.expect_exit(0, &format!("render scene.txt --size 13x7 -o {name}"));
            assert_eq!(output.out, format!("wrote {name}\n"));
            // JPEG is lossy; see `lossy_pictures_are_nearly_those_of_png`.
            if format.depth == durer::image::Depth::EightBit && format.name != "JPEG" {
                eight_bit.push(folder.image8(&name));
            } else {
                let image = folder.image(&name);
                assert_eq!((image.width, image.height), (13, 7), "{name}");
            }
        }
    }
    assert!(eight_bit.len() >= 4 && eight_bit.windows(2).all(|pair| pair[0] == pair[1]));
}

#[test]
fn pictures_of_sixteen_bits_have_finer_steps() {
    let folder = TestFolder::new();
    let render = "render scene.txt --size 13x7 --transfer linear";
    folder.expect_exit(0, &format!("{render} -o exact.pfm"));
    let exact = folder.image("exact.pfm");
    for name in ["fine.png", "fine.ppm"] {
        folder.expect_exit(0, &format!("{render} --bits 16 -o {name}"));
        let error =
            |(a, b): (&durer::math::Vec3, &durer::math::Vec3)| (*a - b.min(durer::math::Vec3::ONE)).abs().max_element();
        let worst = folder.image(name).pixels.iter().zip(&exact.pixels).map(error).fold(0.0, f32::max);
        assert!(worst < 1e-5, "{name}: {worst}");
    }
    folder.expect_failure(2, &format!("{render} --bits 16 -o x.jpg"), &["--bits 16 needs a .png or .ppm file", "JPEG"]);
    folder.expect_failure(2, &format!("{render} --bits 16 -o x.exr"), &["OpenEXR stores floating-point numbers"]);
    folder.expect_failure(2, &format!("{render} --bits 12 -o x.png"), &["expected 8 or 16"]);
}

#[test]
fn exposure_is_chosen_for_bright_and_dark_scenes() {
    let folder = TestFolder::new();
    let mut stops = Vec::new();
    for light in [1.0, 5000.0, 0.001] {
        let grey = |value: f32| format!("{0} {0} {0}", value * light);
        let lit = SCENE.replace("color 0.2 0.1 0.5", &format!("color {}", grey(0.3)));
        let lit = lit.replace("ambientLight 0.2 0.2 0.2", &format!("ambientLight {}", grey(0.2)));
        folder.write("lit.txt", lit.replace("color 0.9 0.9 0.8", &format!("color {}", grey(0.9))));
        let output = folder.expect_exit(0, "render lit.txt --size 24x24 --exposure auto -o lit.png");
        let chosen = output.err.split("--exposure auto chose ").nth(1).and_then(|rest| rest.split(' ').next());
        stops.push(chosen.unwrap_or_else(|| panic!("{}", output.err)).parse::<f32>().unwrap());
        let pixels = folder.image8("lit.png").pixels;
        let bright = pixels.iter().filter(|pixel| pixel[1] > 60).count();
        assert!(bright > pixels.len() / 4, "{light}: {bright}");
    }
    // log2(5000) and log2(1000), with stops rounded to two decimals.
    assert!((stops[0] - stops[1] - 12.288).abs() < 0.02 && (stops[2] - stops[0] - 9.966).abs() < 0.02, "{stops:?}");
    folder.expect_failure(2, "render scene.txt -o p.png --exposure bright", &["a number from -60 to 60, or auto"]);
}

#[test]
fn several_pictures_are_separate_files_or_layers() {
    let folder = TestFolder::new();
    let before = folder.names();
    let all = "color,depth,normals,position,uv,barycentric,object,material,cost,samples,filter";
    let output = folder.expect_exit(0, &format!("render scene.txt --size 9x8 --zoom 5 --show {all} -o a.b.png"));
    for name in all.split(',') {
        assert!(output.out.contains(&format!("wrote a.b.{name}.png\n")), "{}", output.out);
        let size = match name {
            "samples" => (45, 40),
            "filter" => (46, 41),
            _ => (9, 8),
        };
        let image = folder.image8(&format!("a.b.{name}.png"));
        assert_eq!((image.width, image.height), size, "{name}");
    }
    assert_eq!(folder.names().len(), before.len() + 11);
    // An EXR file holds all pictures except diagrams, which have other sizes.
    let output = folder.expect_exit(0, "render scene.txt --size 9x8 --show color,depth,normals -o layers.exr");
    assert_eq!(output.out, "wrote layers.exr\n");
    let text = String::from_utf8_lossy(&folder.bytes("layers.exr")).into_owned();
    assert!(["depth.R", "normals.G"].iter().all(|layer| text.contains(layer)));
    let output = folder.expect_exit(0, "render scene.txt --size 9x8 --show depth,samples -o dots.exr");
    assert_eq!(output.out, "wrote dots.depth.exr\nwrote dots.samples.exr\n");
    let output = folder.expect_exit(0, "render scene.txt --size 9x9 --show samples -o dots.png");
    assert_eq!(output.out, "wrote dots.png\n");
}

#[test]
fn names_and_defaults() {
    let folder = TestFolder::new();
    folder.write("my.best.scene.txt", SCENE);
    let output = folder.expect_exit(0, "render my.best.scene.txt --quiet");
    assert_eq!((output.out.as_str(), output.err.as_str()), ("", ""));
    assert_eq!((folder.image8("my.best.scene.png").width, folder.image8("my.best.scene.png").height), (512, 512));
    let output = folder.expect_exit(0, "render scene.txt --size 3x3 -o p.png");
    assert_eq!(output.err, "", "an explicit option needs no note");
    let output = folder.expect_exit(0, "render scene.txt --dialect f04 -o p.png");
    assert_eq!((output.err.as_str(), folder.image8("p.png").width), ("", 100));
}

#[test]
fn eight_bits_by_transfer() {
    let folder = TestFolder::new();
    for transfer in ["srgb", "linear", "course"] {
        folder.expect_exit(
            0,
            &format!("render scene.txt --size 2x2 --samples 1 --crop 0,0,1x1 --transfer {transfer} -o {transfer}.png"),
        );
    }
    // The colour of the sky is 0.2 0.1 0.5.
    assert_eq!(folder.image8("srgb.png").pixels, [[124, 89, 188]]);
    assert_eq!(folder.image8("linear.png").pixels, [[51, 26, 128]]);
    assert_eq!(folder.image8("course.png").pixels, [[51, 25, 127]]);
}

#[test]
fn extreme_values_work() {
    let folder = TestFolder::new();
    folder.write("mirrors.txt", common::ENDLESS.replace("transparentColor 1 1 1 indexOfRefraction 1.5", ""));
    for options in [
        "mirrors.txt --bounces 256",
        "mirrors.txt --bounces 256 --dialect f04 --threads 2 --show color,samples --zoom 1 --sampler uniform",
        "scene.txt --size 1x1 --samples 4096",
        "scene.txt --size 1x1 --sampler random --samples 65536",
        "scene.txt --size 40000x1 --samples 1",
        "scene.txt --size 1x1 --samples 2 --filter box --filter-radius 64",
        "scene.txt --size 20x20 --sampler uniform --samples 4 --filter gaussian --filter-radius 64",
        "scene.txt --threads 1024 --size 2x2",
        "scene.txt --grid 400x400x400 --size 2x2",
        "scene.txt --min-throughput 1e30 --size 2x2",
        "scene.txt --depth-range -1e38 1e38 --show depth --size 2x2",
        "scene.txt --depth-range 9 -5 --show depth --size 2x2",
    ] {
        let size = if options.contains("--size") { "" } else { "--size 20x20" };
        folder.expect_exit(0, &format!("render {options} {size} -o p.png"));
    }
}

#[test]
fn existing_link_is_kept() {
    let folder = TestFolder::new();
    folder.write("real.png", "old");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("real.png", folder.path("link.png")).unwrap();
        folder.expect_exit(0, "render scene.txt --size 3x3 -o link.png");
        assert!(folder.path("link.png").is_symlink());
        assert_eq!(folder.image8("real.png").width, 3);
    }
}

#[test]
fn scenes_and_pictures_pass_through_pipes() {
    let folder = TestFolder::new();
    folder.expect_exit(0, "render scene.txt -o file.png --size 37x29");
    let piped = folder.shell("\"$DURER\" render - -o - --size 37x29 < scene.txt > piped.png");
    assert_eq!((piped.out.as_str(), folder.bytes("piped.png")), ("", folder.bytes("file.png")), "{}", piped.err);
    let named = folder.shell("\"$DURER\" render - --size 37x29 < scene.txt");
    assert!(named.out.contains("wrote picture.png"), "{} {}", named.out, named.err);
    let broken = folder.shell("echo 'Sphere {' | \"$DURER\" render - -o x.png");
    assert!(broken.err.contains("standard-input:") && !folder.path("x.png").exists(), "{}", broken.err);
    folder.expect_failure(2, "render - --watch", &["standard input"]);
}

#[test]
fn lossy_pictures_are_nearly_those_of_png() {
    let folder = TestFolder::new();
    for ending in ["png", "webp", "jpg"] {
        folder.expect_exit(0, &format!("render scene.txt -o a.{ending} --size 64x48"));
    }
    let [png, webp, jpg] = ["a.png", "a.webp", "a.jpg"].map(|name| folder.image8(name).pixels);
    assert_eq!(png, webp);
    let differences = png.as_flattened().iter().zip(jpg.as_flattened()).map(|(a, b)| u32::from(a.abs_diff(*b)));
    assert!(differences.sum::<u32>() < 3 * 3 * 64 * 48);
}

#[test]
fn options_place_the_camera_of_any_scene() {
    let folder = TestFolder::new();
    let text = "PerspectiveCamera { center 0 1 9 direction 0 0 -1 up 0 1 0 angle 30 }
        Lights { DirectionalLight { direction -1 -2 -1 color 1 1 1 } }
        Materials { PhongMaterial { diffuseColor 1 0.5 0.2 } }
        Group { MaterialIndex 0 Sphere { center 0 1 0 radius 1 } Sphere { center 2 0.5 1 radius 0.5 } }";
    folder.write("a.txt", text);
    folder.write("b.txt", text.replace("center 0 1 9 direction 0 0 -1", "center 4 3 5 direction -4 -2 -5"));
    folder.expect_exit(0, "render b.txt -o b.pfm --size 40x30");
    folder.expect_exit(0, "render a.txt -o a.pfm --size 40x30 --eye 4,3,5 --target 0,1,0");
    assert_eq!(folder.bytes("a.pfm"), folder.bytes("b.pfm"));
    // Without a target, the eye looks at the center of the scene, so the scene stays visible.
    folder.expect_exit(0, "render a.txt -o c.pfm --size 40x30 --eye -9,-1,2 --fov 40");
    assert!(folder.image("c.pfm").pixels.iter().any(|pixel| pixel.x > 0.1));
    folder.expect_failure(2, "render a.txt --eye 1,1,1 --target 1,1,1", &["--target"]);
    for (option, word) in
        [("--eye 1,2", "three numbers"), ("--eye 1,2,inf", "three numbers"), ("--fov 180", "less than 180")]
    {
        folder.expect_failure(2, &format!("render a.txt {option}"), &[word]);
    }
}
