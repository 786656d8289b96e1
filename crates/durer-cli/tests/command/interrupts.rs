//! Tests Ctrl-C. The program must exit with code 130 without delay, and the work so far must be
//! saved.
use crate::common::{self, TestFolder};
use std::process::{Command, Stdio};
use std::time::Duration;

/// Time limit that also holds on a busy machine. On an idle machine, it takes 0.2 s.
const SOON: Duration = Duration::from_secs(8);

#[test]
fn rendering_stops_soon_and_leaves_no_empty_files() {
    let folder = TestFolder::new();
    folder.write("old.png", "an old picture");
    let before = folder.names();
    for options in [
        "endless.txt --bounces 256",
        "endless.txt --bounces 256 --dialect f04",
        "endless.txt --bounces 256 --jitter --blur",
        "endless.txt --bounces 256 --sampler random --samples 16 --filter tent",
        "endless.txt --bounces 256 --show cost",
        "endless.txt --bounces 256 --show samples --size 9x9",
    ] {
        let (output, latency) = folder.interrupted(&format!("render {options} -o old.png"), Duration::from_millis(400));
        assert_eq!((output.code, output.out.as_str()), (Some(130), ""), "{options}: {}", output.err);
        // The work is saved if at least a few blocks of pixels have been rendered.
        let part = folder.path("old.png.part");
        let text = output.err.lines().last().unwrap_or_default();
        assert!(text == "interrupted; nothing was written" || text.contains("old.png.part (--resume"), "{text}");
        assert_eq!(text.contains("old.png.part"), part.exists(), "{options}: {text}");
        let _ = std::fs::remove_file(part);
        assert!(latency < SOON, "{options}: {latency:?}");
        assert_eq!(folder.names(), before, "{options}");
        assert_eq!(folder.bytes("old.png"), b"an old picture");
    }
    let grid = "course -input scene.txt -output old.png -grid 200 200 200 -visualize_grid -size 15000 15000";
    let (output, latency) = folder.interrupted(grid, Duration::from_millis(400));
    assert!(output.code == Some(130) && latency < SOON, "{latency:?} {}", output.err);
}

#[test]
fn finished_work_is_saved_on_interrupt() {
    let folder = TestFolder::new();
    for options in [
        "scene.txt --samples 1048576",
        "scene.txt --sampler uniform --samples 100 --size 1000x1000",
        "scene.txt --sampler uniform --samples 16 --size 300x300 --filter gaussian --filter-radius 60",
        "scene.txt --jitter --size 3500x3500",
        // The time needed for saving is proportional to the work done.
        "scene.txt --size 3000x3000 --samples 64",
    ] {
        folder.write("old.png", "an old picture");
        let _ = std::fs::remove_file(folder.path("old.png.part"));
        let (output, latency) = folder.interrupted(&format!("render {options} -o old.png"), Duration::from_millis(400));
        assert_eq!((output.code, output.out.as_str()), (Some(130), ""), "{options}: {}", output.err);
        assert!(latency < SOON, "{options}: {latency:?}");
        let text = output.err.lines().last().unwrap_or_default();
        assert_eq!(text.contains("old.png.part (--resume"), folder.path("old.png.part").exists(), "{options}: {text}");
        // An incomplete picture does not replace an old one.
        if text.ends_with("and old.png") {
            assert!(folder.image8("old.png").width > 0);
        } else {
            assert_eq!(folder.bytes("old.png"), b"an old picture", "{options}: {text}");
        }
        assert!(folder.names().iter().all(|name| !name.ends_with(".tmp")));
        if options.ends_with("1048576") {
            assert!(text.ends_with("and old.png"), "{text}");
        }
    }
}

#[test]
fn reading_stops_on_interrupt() {
    let folder = TestFolder::new();
    // Two million triangles take seconds to read and sort, in any build.
    let mut mesh = String::new();
    for i in 0..400_000 {
        mesh += &format!("v {i} 0 1\nv {i} 1 {i}\nf {} {} 1\n", 2 * i + 1, 2 * i + 2);
    }
    folder.write("large.obj", mesh);
    folder.write(
        "large.txt",
        common::SCENE.replace("Sphere { center 0 0.5 0 radius 1 }", "TriangleMesh { obj_file large.obj }"),
    );
    for command in ["render large.txt -o p.png", "info large.txt", "course -input large.txt -output p.tga"] {
        // The signal is late enough that the program has started even on a busy machine.
        let (output, latency) = folder.interrupted(command, Duration::from_millis(250));
        assert!(
            output.code == Some(130) && output.out.is_empty() && latency < SOON,
            "{command}: {:?} {latency:?}",
            output.code
        );
    }
    assert!(!folder.path("p.png").exists());
}

#[test]
fn interrupt_leaves_a_complete_file_or_none() {
    let folder = TestFolder::new();
    for after in (0..120).step_by(8) {
        let _ = std::fs::remove_file(folder.path("p.png"));
        let (output, _) = folder.interrupted(
            "render scene.txt --size 300x300 --samples 1 --restart -o p.png",
            Duration::from_millis(after),
        );
        match output.code {
            Some(0) => assert_eq!(folder.image8("p.png").width, 300),
            // The signal may have arrived after the work was finished.
            Some(130) => assert!(!folder.path("p.png").exists() || folder.image8("p.png").width == 300),
            // Before the handler is installed, the operating system ends the program. After the
            // program has ended, the signal has no effect.
            other => assert!(other.is_none(), "{other:?} after {after} ms"),
        }
        assert!(folder.names().iter().all(|name| !name.ends_with(".tmp")));
    }
}

#[test]
fn progress_bar_appears_on_terminals_only() {
    let folder = TestFolder::new();
    let on_terminal = |options: &str| {
        let line =
            format!("{} render scene.txt --size 1000x1000 --samples 100 --restart -o p.png {options}", common::durer());
        let mut script = Command::new("script");
        script
            .args(["-qec", &format!("timeout -s INT 2 {line}"), "/dev/null"])
            .current_dir(folder.path(""))
            .stdin(Stdio::null());
        script.env("TERM", "xterm").output().ok()
    };
    let Some(shown) = on_terminal("") else { return println!("skipped: `script` not found") };
    let quiet = on_terminal("--quiet").unwrap();
    assert!(String::from_utf8_lossy(&shown.stdout).contains("rays/s"), "{shown:?}");
    assert!(!String::from_utf8_lossy(&quiet.stdout).contains("rays/s"), "{quiet:?}");
    let (output, _) = folder
        .interrupted("render scene.txt --size 1000x1000 --samples 100 --restart -o p.png", Duration::from_millis(1500));
    assert!(!output.err.contains("rays/s"), "{}", output.err);
}

#[test]
fn watch_renders_saved_changes_until_ctrl_c() {
    let folder = TestFolder::new();
    let scene = std::fs::read_to_string(folder.path("scene.txt")).unwrap();
    let mut child = folder
        .command("render scene.txt -o a.png --watch --size 16x16 --samples 2")
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let wait = |what: &dyn Fn() -> bool| {
        let start = std::time::Instant::now();
        while !what() {
            assert!(start.elapsed() < Duration::from_secs(60), "nothing comes");
            std::thread::sleep(Duration::from_millis(20));
        }
    };
    let picture = || std::fs::read(folder.path("a.png")).unwrap_or_default();
    wait(&|| !picture().is_empty());
    let mut before = picture();
    // After an error, the program waits until the file is fixed.
    for text in [scene.replace("0.8 0.3 0.2", "0.1 0.3 0.9"), scene.replace("radius 1", "radius x"), scene.clone()] {
        std::thread::sleep(Duration::from_millis(400));
        folder.write("scene.txt", &text);
        match text.contains("radius x") {
            true => std::thread::sleep(Duration::from_millis(400)),
            false => wait(&|| !picture().is_empty() && picture() != before),
        }
        before = picture();
    }
    std::thread::sleep(Duration::from_millis(400));
    Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    let status = child.wait().unwrap();
    assert_eq!(status.code(), Some(0));
    assert!(!folder.path("a.png.part").exists());
}

/// Returns a grid of triangles as an OBJ file.
fn mesh(side: usize) -> String {
    let mut mesh = String::new();
    for i in 0..side * side {
        let (x, y) = (i % side, i / side);
        mesh += &format!("v {x} {y} {}\n", (x * 7 + y * 13) % 5);
    }
    for i in (0..side * (side - 1)).filter(|i| (i + 1) % side != 0) {
        mesh += &format!("f {} {} {}\n", i + 1, i + 2, i + 1 + side);
    }
    mesh
}

/// Returns a PPM file with noise that has detectable features.
fn noise(side: usize, seed: u32) -> Vec<u8> {
    let mut bytes = format!("P6 {side} {side} 255\n").into_bytes();
    let mut state = seed.wrapping_mul(2_654_435_761).max(1);
    bytes.extend((0..3 * side * side).map(|_| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    }));
    bytes
}

/// Returns a bundle adjustment problem in which the cameras see random points.
fn problem(cameras: usize, points: usize) -> String {
    let number = |i: usize| ((i * 7919) % 1000) as f64 / 500.0 - 1.0;
    let mut text = format!("{cameras} {points} {}\n", cameras * points);
    for i in 0..cameras * points {
        text += &format!("{} {} {} {}\n", i % cameras, i / cameras, 300.0 * number(i), 300.0 * number(i + 17));
    }
    for i in 0..cameras {
        text += &format!("0.1\n{}\n0.2\n{}\n0\n-5\n500\n0\n0\n", 0.1 * number(i), number(i));
    }
    (0..3 * points).for_each(|i| text += &format!("{}\n", number(3 * i)));
    text
}

#[test]
fn every_command_ends_soon_after_a_signal() {
    let folder = TestFolder::new();
    folder.write("mesh.obj", mesh(700));
    let large = common::SCENE.replace("Sphere { center 0 0.5 0 radius 1 }", "TriangleMesh { obj_file mesh.obj }");
    folder.write("mesh.txt", &large);
    folder.write("a.ppm", noise(4000, 1));
    folder.write("b.ppm", noise(4000, 2));
    folder.write("problem.txt", problem(60, 2000));
    let place = "place X\nlatitude 47\nlongitude -8\ntime_zone -15\nsite_elevation 4\nweather_data_file_units 1\n";
    folder.write("day.wea", format!("{place}6 21 12.5 400 100\n"));
    std::fs::create_dir(folder.path("photos")).unwrap();
    for i in 0..6 {
        let picture = durer::image::read(&noise(1200, i), "a.ppm").unwrap();
        let layer = durer::image::Layer::color("", picture);
        let mut file = Vec::new();
        let format = durer::image::format_for("a.png").unwrap();
        format.write(&[layer], &durer::image::WriteOptions::default(), &mut file).unwrap();
        folder.write(&format!("photos/{i}.png"), file);
    }
    for line in [
        "render endless.txt --bounces 256 -o o.png --restart",
        "render mesh.txt --accel none -o o.png --restart",
        "render mesh.txt --accel grid --size 3000x3000 -o o.png --restart",
        "render endless.txt --bounces 256 --shard 1/2 -o o.part --restart",
        "verify mesh.txt --accel none --trials 1000000",
        "verify endless.txt --bounces 256",
        "verify scene.txt --trials 1000000",
        "explain endless.txt --bounces 256 --pixel 30,30 --size 60x60",
        "lesson endless.txt --bounces 256 -o lesson",
        "course -input endless.txt -output o.tga -size 900 900 -bounces 250 -shadows",
        "measure scene.txt --at 0,1,0 --normal 0,1,0 --samples 16777216",
        "measure scene.txt --at 0,1,0 --weather day.wea --samples 16777216",
        "compare a.ppm b.ppm",
        "check mesh.txt",
        "convert mesh.txt -o o.gltf",
        "photo match photos -o matches.json",
        "photo solve problem.txt -o solved.txt",
    ] {
        for (signal, code) in [("INT", 130), ("TERM", 143)] {
            let (output, latency) = folder.send_signals(line, Duration::from_millis(400), &[signal]);
            // A conversion that is already writing its file completes it.
            let is_complete = output.code == Some(0) && output.out.contains("wrote o.gltf");
            assert!(output.code == Some(code) || is_complete, "{line}: {:?} {}", output.code, output.err);
            // On an idle machine, it takes at most half a second.
            assert!(latency < Duration::from_secs(3), "{line}: {latency:?}");
            println!("{line}: {latency:?} after {signal}");
        }
    }
    for line in ["live scene.txt", "render scene.txt --size 8x8 --samples 1 --watch -o w.png"] {
        let (output, latency) = folder.send_signals(line, Duration::from_millis(600), &["TERM"]);
        assert!(output.code == Some(0) && latency < Duration::from_secs(3), "{line}: {:?} {latency:?}", output.code);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn verification_leaves_no_process_behind() {
    let folder = TestFolder::new();
    let alive = || {
        let found =
            folder.shell("pgrep -f \"verify $PWD/scene.txt\" | grep -vw $$ | xargs -r ps -o stat= -p | grep -cv Z");
        found.out.trim().parse::<u32>().unwrap_or(0)
    };
    let line = format!("verify {} --trials 3 --size 300x300 --samples 64", folder.path("scene.txt").display());
    // Stop the command while the program renders, and also while a child process renders at another
    // SIMD level.
    for after in [300, 2000, 6000] {
        let _ = folder.send_signals(&line, Duration::from_millis(after), &["TERM"]);
        std::thread::sleep(Duration::from_millis(200));
        assert_eq!(alive(), 0, "after {after} ms");
    }
}
