//! Tests that errors have a message and the correct exit code, and that nothing is written.

use crate::common::{self, SCENE, TestFolder};
use std::process::{Command, Stdio};

#[test]
fn invalid_scene_gives_all_errors_with_their_places() {
    let folder = TestFolder::new();
    folder.write(
        "bad.txt",
        SCENE.replace("angle 40", "angle x").replace("Sphere", "Spheer").replace("center 0 0.5", "centre 0"),
    );
    folder.expect_failure(
        2,
        "render bad.txt -o p.png",
        &[
            "bad.txt:1:",
            "bad.txt:8:19",
            "^^^^^^",
            "did you mean `Sphere`?",
            "needs a number",
            "note[dialect]: the scene is read as f04",
        ],
    );
    let quiet = folder.expect_exit(2, "render bad.txt -o p.png --quiet");
    assert!(quiet.err.contains("Spheer") && !quiet.err.contains("note"), "{}", quiet.err);
    folder.expect_failure(2, "info bad.txt", &["Spheer"]);
    folder.expect_failure(2, "convert bad.txt -o c.txt", &["Spheer"]);
    folder.expect_failure(2, "course -input bad.txt -output p.tga", &["Spheer"]);
}

#[test]
fn at_most_twenty_errors_are_shown() {
    let folder = TestFolder::new();
    folder.write("bad.txt", SCENE.replace("numObjects 2", &format!("numObjects 2 {}", "Spheer { } ".repeat(1000))));
    let output = folder.expect_exit(2, "render bad.txt");
    assert!(output.err.matches("\nerror").count() < 20, "{}", output.err);
    assert!(output.err.len() < 20_000, "{} bytes", output.err.len());
}

#[test]
fn missing_files_are_reported_at_their_line() {
    let folder = TestFolder::new();
    let scene = SCENE.replace("Sphere { center 0 0.5 0 radius 1 }", "\nTriangleMesh { obj_file cube.obj }");
    folder.write("mesh.txt", &scene);
    folder.write("cubes.obj", "");
    folder.expect_failure(2, "render mesh.txt -o p.png", &["mesh.txt:9:", "cube.obj", "cubes.obj"]);
    folder.write("texture.txt", SCENE.replace("diffuseColor 0.8", "texture wood.bmp diffuseColor 0.8"));
    folder.expect_failure(2, "render texture.txt -o p.png --dialect durer", &["texture.txt:5:", "wood.bmp"]);
    folder.write("outside.txt", scene.replace("cube.obj", "../cube.obj"));
    folder.expect_exit(2, "render outside.txt -o p.png");
}

#[test]
fn files_other_than_scenes_are_refused_at_once() {
    let folder = TestFolder::new();
    for (name, content) in [
        ("empty.txt", Vec::new()),
        ("binary.txt", (0..200_000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect()),
        ("escape.txt", b"\x1b[31mSphere\x1b]0;title\x07\x9b {".to_vec()),
        ("deep.txt", "Group { numObjects 1 ".repeat(1_000_000).into_bytes()),
        ("braces.txt", "{".repeat(1_000_000).into_bytes()),
        ("long.txt", vec![b'a'; 1_000_000]),
    ] {
        folder.write(name, content);
        folder.expect_failure(2, &format!("render {name} -o p.png"), &["error"]);
        let err = folder.run(&format!("render {name} -o p.png")).err;
        assert!(err.len() < 40_000, "{name}: {} bytes of errors", err.len());
        assert!(!err.chars().any(|c| c.is_control() && c != '\n'), "{name}: {err:?}");
    }
    folder.expect_failure(2, "render missing.txt -o p.png", &["missing.txt"]);
    folder.expect_failure(2, "render . -o p.png", &["not a regular file"]);
    folder.expect_failure(2, "render scene.txt/below -o p.png", &["scene.txt/below"]);
}

/// A file's name must not look like a second message.
#[test]
fn line_breaks_in_names_do_not_break_messages() {
    let folder = TestFolder::new();
    let broken = "a.txt\nerror: forged";
    let output = folder.command("render -o p.png").arg(broken).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        String::from_utf8(output.stderr).unwrap(),
        format!("error: {broken:?} contains a line break; names and values must be on one line\n")
    );
    let gltf = r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"b.bin%0Aerror: forged","byteLength":4}],
        "scenes":[{"nodes":[]}]}"#;
    folder.write("uri.gltf", gltf);
    let output = folder.run("info uri.gltf");
    assert!(output.err.lines().all(|line| !line.starts_with("error: forged")), "{}", output.err);
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused() {
    let folder = TestFolder::new();
    assert!(Command::new("mkfifo").arg(folder.path("pipe.txt")).status().unwrap().success());
    folder.expect_failure(2, "render pipe.txt -o p.png", &["not a regular file"]);
    folder.expect_failure(2, "render /dev/zero -o p.png", &["not a regular file"]);
}

#[test]
fn bad_options_of_render() {
    let folder = TestFolder::new();
    for (options, words) in [
        ("--size 0x5", "width and height must be at least 1"),
        ("--size 5", "640x480"),
        ("--size 99999999999x1", "640x480"),
        ("--size 100000x100000 -o p.bmp", "bands of rows"),
        ("--size 4294967295x4294967295", "needs about"),
        ("--size 70000x1 -o p.tga", "65535"),
        ("--crop 0,0,513x1", "crop"),
        ("--crop 4294967295,0,1x1", "crop"),
        ("--crop 0,0,0x0", "10,20,64x48"),
        ("--samples 0", "--samples"),
        ("--samples 1048577", "--samples"),
        ("--show samples --samples 1048576 --zoom 1", "can show at most"),
        ("--show samples --samples 65536 --sampler random --size 4000x4000 --zoom 1", "can show at most"),
        ("--jitter --samples 4", "cannot be used with"),
        ("--jitter --sampler random", "cannot be used with"),
        ("--blur --filter tent", "cannot be used with"),
        ("--sampler sobel", "sobol"),
        ("--sampler random --filter mitchell", "box, tent and gaussian"),
        ("--filter gauss", "gaussian"),
        ("--filter-radius 2", "--filter"),
        ("--filter box --filter-radius 0", "--filter-radius"),
        ("--filter box --filter-radius nan", "--filter-radius"),
        ("--filter box --filter-radius 65", "--filter-radius"),
        ("--show colour", "color"),
        ("--show depth,color,depth", "twice"),
        ("--show samples --size 5000x5000", "too large"),
        ("--show filter --size 9x9 --zoom 1001", "--zoom"),
        ("--zoom 2", "magnifies the pictures of --show samples"),
        ("--depth-range 3 3", "--depth-range"),
        ("--depth-range nan 3", "--depth-range"),
        ("--depth-range 3", "--depth-range"),
        ("--transfer gamma", "--transfer"),
        ("--accel kd", "bvh"),
        ("--accel none --grid 2x2x2", "--grid"),
        ("--grid 0x1x1", "10x10x10"),
        ("--grid 1x1", "10x10x10"),
        ("--grid 100000x100000x100000", "cells"),
        ("--threads 0", "--threads"),
        ("--threads 1000000", "--threads"),
        ("--seed -1", "-1"),
        ("--bounces 257", "--bounces"),
        ("--bounces -1", "-1"),
        ("--min-throughput -1", "0 or more"),
        ("--min-throughput nan", "0 or more"),
        ("--shadows=maybe", "`on` or `off`"),
        ("--dialect f05", "f04"),
        ("--compat border-pixel", "border-pixels"),
        ("-o p.pgn", "did you mean `.png`?"),
        ("-o picture", ".png"),
        ("--sise 3x3", "--size"),
    ] {
        folder.expect_failure(2, &format!("render scene.txt {options}"), &[words]);
    }
    folder.expect_failure(2, "rendr scene.txt", &["render"]);
    folder.expect_failure(2, "", &["Usage"]);
}

#[test]
fn write_errors_have_exit_code_1_and_keep_old_files() {
    let folder = TestFolder::new();
    std::fs::create_dir(folder.path("folder.png")).unwrap();
    folder.expect_failure(1, "render scene.txt -o missing/p.png", &["the folder `missing` does not exist"]);
    folder.expect_failure(1, "render scene.txt -o folder.png", &["it is a folder"]);
    folder.expect_failure(1, "render scene.txt -o scene.txt/p.png", &["does not exist"]);
    folder.expect_failure(1, "render scene.txt --show color,depth -o missing/p.png", &["does not exist"]);
    folder.expect_failure(1, "convert scene.txt -o missing/c.txt", &["does not exist"]);
    folder.expect_failure(1, "course -input scene.txt -output missing/p.tga", &["does not exist"]);
    folder.write("old.png", "an old picture");
    for arguments in ["missing.txt -o old.png", "scene.txt --size 4294967295x70000 -o old.png"] {
        folder.expect_exit(2, &format!("render {arguments}"));
        assert_eq!(folder.bytes("old.png"), b"an old picture");
    }
    // If one of two files cannot be written, neither of them is.
    folder.expect_failure(
        1,
        "course -input scene.txt -size 4 4 -output p.tga -normals missing/n.tga",
        &["does not exist"],
    );
}

#[cfg(target_os = "linux")]
#[test]
fn full_disk_is_an_error() {
    let folder = TestFolder::new();
    std::os::unix::fs::symlink("/dev/full", folder.path("full.png")).unwrap();
    folder.expect_failure(1, "render scene.txt --size 8x8 -o full.png", &["No space left"]);
    folder.expect_failure(1, "course -input scene.txt -size 8 8 -output p.tga -normals full.png", &["No space left"]);
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = folder.command("man").stdout(full).stderr(Stdio::null()).status().unwrap();
    assert_eq!(output.code(), Some(1));
}

#[cfg(target_os = "linux")]
#[test]
fn closed_pipes_and_odd_names_do_not_panic() {
    use std::os::unix::ffi::OsStrExt;
    let folder = TestFolder::new();
    for arguments in
        ["dialects", "man", "completions bash", "info scene.txt --json", "course --help", "render missing.txt"]
    {
        let script =
            format!("{} {arguments} 2>&1 | true; {} {arguments} 2>&1 | head -1", common::durer(), common::durer());
        let output = Command::new("bash").args(["-c", &script]).current_dir(folder.path("")).output().unwrap();
        assert!(!String::from_utf8_lossy(&output.stdout).contains("panicked"), "{arguments}");
    }
    // Standard error is a closed pipe, and there is a message to print.
    let mut child = folder.command("render missing.txt").stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(2));
    let odd = std::ffi::OsStr::from_bytes(b"\xff\xfe.txt");
    for command in ["render", "course", "info"] {
        assert_eq!(folder.command(command).arg(odd).output().unwrap().status.code(), Some(2), "{command}");
    }
    std::os::unix::fs::symlink(common::durer(), folder.path("a4soln")).unwrap();
    let output = Command::new(folder.path("a4soln")).arg(odd).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}

/// Options of other programs lead to a hint that names the equivalent option of Dürer.
#[test]
fn options_of_other_programs_are_pointed_to_ours() {
    let folder = TestFolder::new();
    for (options, words, course) in [
        ("--width 640", "`--size 640x480`", false),
        ("--height=480", "`--size 640x480`", false),
        ("--format png", "`-o picture.exr`", false),
        ("--spp 64", "`--samples 64`", false),
        ("--verbose", "`--stats`", false),
        ("-size 200 200", "`--size 640x480`", true),
        ("--size 200 100", "`--size 200x100`", false),
        ("--pixel 3 4", "`--pixel 3,4`", false),
        ("--shadows off", "`--shadows=off`", false),
        ("--no-shadows", "`--shadows=off`", false),
        ("--depth", "`--show depth`", false),
        ("--normals n.png", "`--show normals`", false),
        ("--transparent", "`--background transparent`", false),
        ("--sampels 4", "`--samples`", false),
        ("--quaternion 4", "`durer render --help-all`", false),
    ] {
        let output = folder.expect_exit(2, &format!("render scene.txt -o x.png {options}"));
        assert!(output.err.contains("unexpected argument") && output.err.contains(words), "{}", output.err);
        assert_eq!(output.err.contains("`durer course`"), course, "{}", output.err);
        assert!(!output.err.contains("similar argument") && !output.err.contains("as a value"), "{}", output.err);
    }
    let output = folder.expect_exit(2, "check scene.txt --verbose");
    assert!(output.err.contains("use `--json` for the full output"), "{}", output.err);
    assert!(!output.err.contains("--stats"), "{}", output.err);
    let output = folder.expect_exit(2, "scene.txt -o x.png");
    assert!(output.err.contains("use `durer render scene.txt`"), "{}", output.err);
    let output = folder.expect_exit(2, "measure scene.txt --at 2 0.8 3");
    assert!(output.err.contains("`--at 2,0.8,3`"), "{}", output.err);
    let output = folder.expect_exit(2, "render scene.txt --pixel 3,4 --show depth");
    assert!(output.err.contains("`durer explain --pixel 3,4`"), "{}", output.err);
}

/// Options that do not apply are refused instead of ignored.
#[test]
fn options_without_effect_are_refused() {
    let folder = TestFolder::new();
    for (options, help) in [
        ("--view top", "--eye"),
        ("--fit", "--target"),
        ("--camera 3", "--eye"),
        ("--up z", "Transform"),
        ("--studio sun", "Background"),
        ("--environment sky.hdr", "environment FILE"),
        ("--variant x", "Materials"),
        ("--at 3", "animation"),
    ] {
        let option = options.split(' ').next().unwrap();
        folder.expect_failure(2, &format!("render scene.txt -o a.png {options}"), &[option, "to models", help]);
    }
    assert!(!folder.path("a.png").exists());
    folder.expect_failure(2, "explain scene.txt --pixel 3,3 -o a.png", &["`-o` is an option of `durer render`"]);
    folder.expect_failure(2, "explain scene.txt --pixel 3,3 --stats", &["`--stats` is an option of `durer render`"]);
    folder.expect_failure(2, "render .", &["a folder"]);
    folder.expect_failure(2, "render scene.txt --time-limit 3", &["with its unit, for example 30s"]);
    folder.expect_failure(2, "render scene.txt --json", &["--stats=FILE.json"]);
    folder.expect_failure(2, "render scene.txt --stats=a.txt", &["must end in .json"]);
    folder.expect_exit(0, "render scene.txt -o a.png --size 16x12 --stats=a.json");
    // Without a tree, each ray tests both objects.
    let statistics = folder.expect_exit(0, "render scene.txt -o b.png --size 16x12 --accel none --stats").err;
    assert!(statistics.contains("2.0  tests and 0.0 nodes for each of 4096 camera rays"), "{statistics}");
    folder.expect_failure(2, "compare a.png -", &["reads files only"]);
    let statistics: serde_json::Value = serde_json::from_slice(&folder.bytes("a.json")).unwrap();
    assert!(statistics["one_thread"]["rays"]["shadow"].as_u64().unwrap() > 0, "{statistics}");
    assert!(statistics["rays"].as_u64().unwrap() > 100 && statistics["seconds"]["rendering"].is_f64(), "{statistics}");
}

/// `check` reads standard input, and OBJ files there are recognised by their content.
#[test]
fn scenes_come_from_standard_input() {
    let folder = TestFolder::new();
    for (arguments, text, part) in [
        ("check -", common::SCENE, "standard-input: no findings"),
        ("info -", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "triangles  1"),
    ] {
        folder.write("input", text);
        let mut command = folder.command(arguments);
        let output = command.stdin(std::fs::File::open(folder.path("input")).unwrap()).output().unwrap();
        let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert!(output.status.success() && out.contains(part), "{arguments}: {out}{err}");
    }
    folder.expect_failure(2, "check - --fix", &["--output"]);
}
