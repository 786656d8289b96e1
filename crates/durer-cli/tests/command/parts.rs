//! Tests partial work: shards and merging, checkpoints and resuming, single pixels, and limits.

use crate::common::{self, SCENE, TestFolder};

const SMALL: &str = "render scene.txt --size 40x30 --samples 6 --show color,depth,variance --quiet";

fn last_line(text: &str) -> String {
    text.lines().last().unwrap_or_default().to_string()
}

#[test]
fn shards_merge_to_the_bytes_of_one_run() {
    let folder = TestFolder::new();
    let hash = last_line(&folder.expect_exit(0, &format!("{SMALL} -o whole.exr --hash")).out);
    assert_eq!(hash.len(), 64, "{hash}");
    for (by, tile) in [("tiles", 8), ("samples", 32)] {
        for index in 1..=3 {
            let shard = format!("--shard {index}/3 --shard-by {by} --tile {tile} --threads {index}");
            let output = folder.expect_exit(0, &format!("{SMALL} {shard} -o {index}.part"));
            assert_eq!(output.out, "");
        }
        let output = folder.expect_exit(0, "merge 2.part 3.part 1.part -o merged.exr --hash");
        assert_eq!(output.out, format!("wrote merged.exr\n{hash}\n"), "by {by}");
        assert!(folder.bytes("merged.exr") == folder.bytes("whole.exr"), "by {by}");
        folder.expect_failure(2, "merge 3.part 1.part -o m.exr", &["missing", "2/3", by]);
        folder.expect_failure(2, "merge 1.part 2.part 3.part 2.part -o m.exr", &["`2.part` and `2.part` overlap"]);
        folder.expect_failure(2, "merge 1.part 2.part 3.part -o m.xyz", &["m.xyz"]);
    }
    // The job stored in the parts says that pictures go to separate files.
    folder.expect_exit(0, "merge 1.part 2.part 3.part -o m.png --quiet");
    folder.expect_exit(0, &format!("{SMALL} -o w.png"));
    assert!(folder.bytes("m.depth.png") == folder.bytes("w.depth.png"));
    assert!(folder.bytes("m.color.png") == folder.bytes("w.color.png"));
    // Merging fails if a part belongs to another picture or if a file is not a part.
    folder.expect_exit(0, &format!("{SMALL} --seed 7 --shard 2/3 --shard-by samples -o other.part"));
    folder.expect_failure(2, "merge 1.part other.part 3.part -o m.exr", &["other.part", "`seed` is 7"]);
    let bytes = folder.bytes("2.part");
    folder.write("torn.part", &bytes[..bytes.len() / 2]);
    folder.expect_failure(2, "merge 1.part torn.part 3.part -o m.exr", &["torn.part", "truncated or damaged"]);
    folder.expect_failure(2, "merge scene.txt -o m.exr", &["scene.txt", "not a part"]);
    folder.expect_failure(2, "merge missing.part -o m.exr", &["missing.part"]);
    folder.expect_failure(
        2,
        &format!("{SMALL} --shard 7/7 --shard-by samples -o 7.part"),
        &["6 samples per pixel are too few"],
    );
    folder.expect_failure(2, &format!("{SMALL} --shard 4/3 -o 4.part"), &["from 1 to 3"]);
}

#[test]
fn stopped_work_is_resumed() {
    let folder = TestFolder::new();
    let work = "render scene.txt --size 120x90 --samples 300 --quiet --hash";
    let hash = last_line(&folder.expect_exit(0, &format!("{work} -o calm.png")).out);
    folder.expect_exit(0, &format!("{work} --time-limit 30ms --checkpoint c.part -o p.png"));
    assert!(folder.path("c.part").exists(), "it cannot have been finished in 30 ms");
    // Saved work that belongs to another job is rejected and kept.
    let other = |options: &str, words: &[&str]| {
        folder.expect_failure(2, &format!("{work} --resume --checkpoint c.part -o p.png {options}"), words);
    };
    other("--seed 1", &["c.part", "a different job", "`seed`"]);
    other("--bounces 3", &["a different job", "`settings`"]);
    folder.write("scene.txt", SCENE.replace("radius 1", "radius 1.5"));
    other("", &["c.part", "a different scene"]);
    folder.write("scene.txt", SCENE);
    let bytes = folder.bytes("c.part");
    folder.write("c.part", &bytes[..bytes.len() - 1]);
    other("", &["c.part", "truncated or damaged"]);
    folder.write("c.part", &bytes);
    let output = folder.expect_exit(0, &format!("{work} --resume --checkpoint c.part -o p.png --threads 3 --tile 40"));
    assert_eq!(last_line(&output.out), hash);
    assert!(folder.bytes("p.png") == folder.bytes("calm.png") && !folder.path("c.part").exists());
    // If there is no saved work, --resume starts a new render.
    let output = folder.expect_exit(0, &format!("{work} --resume --checkpoint c.part -o p.png"));
    assert_eq!(last_line(&output.out), hash);
}

#[test]
fn single_pixel_is_printed() {
    let folder = TestFolder::new();
    let options = "render scene.txt --size 40x30 --samples 4 --pixel 20,15";
    let one = folder.expect_exit(0, &format!("{options} --sample 3")).out;
    assert!(one.starts_with("pixel 20,15, sample 3: 0."), "{one}");
    assert_eq!(folder.names(), ["endless.txt", "scene.txt"]);
    folder.expect_failure(2, &format!("{options} --sample 4"), &["numbered from 0 to 3"]);
    folder.expect_failure(2, "render scene.txt --size 40x30 --pixel 40,0", &["pixel 40,0 is not in the picture"]);
    folder.expect_failure(2, "render scene.txt --sample 3", &["--pixel"]);
    folder.expect_failure(2, "render scene.txt --pixel 3", &["200,150"]);
}

#[test]
fn stopping_rules_and_limits() {
    let folder = TestFolder::new();
    let output =
        folder.expect_exit(0, "render scene.txt --size 64x48 --noise-threshold 0.005 --show sample-count -o n.exr");
    assert_eq!(output.out, "wrote n.exr\n");
    let counts = folder.image("n.exr");
    let most = counts.pixels.iter().fold(0.0_f32, |most, p| most.max(p.x));
    assert!(counts.pixels.iter().any(|p| p.x == 16.0) && most > 16.0 && most < 4096.0, "{most}");
    let output =
        folder.expect_exit(0, "render scene.txt --size 64x48 --samples 32 --adaptive --show sample-count -o a.exr");
    assert_eq!(output.out, "wrote a.exr\n");
    let counts: Vec<f32> = folder.image("a.exr").pixels.iter().map(|p| p.x).collect();
    assert_eq!((counts.iter().sum::<f32>(), counts.contains(&8.0)), (32.0 * 64.0 * 48.0, true));
    let text = folder.expect_exit(0, "explain scene.txt --size 64x48 --samples 32 --adaptive --pixel 30,20 --json").out;
    let text: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(text["pixel"]["samples"].as_array().unwrap().len() as f32, counts[20 * 64 + 30]);
    let adaptive = "render scene.txt --size 64x48 --adaptive -o x.exr";
    folder.expect_failure(2, &format!("{adaptive} --samples 15"), &["at least 16"]);
    folder.expect_failure(2, &format!("{adaptive} --noise-threshold 0.1"), &["--adaptive", "cannot be used with"]);
    folder.expect_failure(2, &format!("{adaptive} --sampler jittered --samples 16"), &["cannot be adaptive"]);
    folder.expect_failure(2, &format!("{adaptive} --time-limit 1s"), &["--samples"]);
    folder.expect_failure(2, &format!("{adaptive} --shard 1/2"), &["cannot be split"]);
    folder.expect_failure(2, &format!("{adaptive} --integrator photons"), &["photons"]);
    let output = folder.expect_exit(0, "render scene.txt --size 64x48 --time 100ms --preview v.png -o t.png");
    assert!(output.err.contains("the time limit ended the render after"), "{}", output.err);
    assert_eq!((folder.image8("v.png").width, folder.image8("t.png").width), (64, 64));
    assert!(!folder.path("t.png.part").exists(), "what nobody wanted is not left");
    let large = "render scene.txt --size 4000x4000 --memory 100M";
    folder.expect_failure(
        2,
        &format!("{large} -o p.bmp"),
        &["bands of rows", "BMP needs all rows at once; use one of", "OpenEXR"],
    );
    folder.expect_failure(
        2,
        &format!("{large} -o p.png --show color,depth"),
        &["bands of rows", "pictures other than"],
    );
    folder.expect_failure(2, &format!("{large} -o p.png --preview q.png"), &["bands of rows", "--preview"]);
    folder.expect_failure(2, &format!("{large} -o p.part --shard 1/2"), &["needs about", "100 MiB", "--memory"]);
    folder.expect_failure(
        2,
        "render scene.txt --size 4294967295x4 --memory 100M",
        &["needs about", "100 MiB", "--memory"],
    );
    // A picture that is rendered in bands is identical to one that is rendered at once.
    let size = "--size 700x500 --samples 2 --hash";
    let [bands, whole] = ["--memory 12M", ""].map(|memory| {
        let name = if memory.is_empty() { "w.ppm" } else { "b.ppm" };
        let output = folder.expect_exit(0, &format!("render scene.txt {size} {memory} -o {name}"));
        assert!(output.out.contains(&format!("wrote {name}")), "{}", output.out);
        (folder.bytes(name), output.out.lines().last().map(String::from))
    });
    assert!(bands == whole, "{:?} {:?}", bands.1, whole.1);
    folder.expect_failure(2, "render scene.txt --memory 5Q", &["8G"]);
    folder.expect_failure(2, "render scene.txt --noise-threshold 0", &["above 0"]);
    folder.expect_failure(2, "render scene.txt --noise-threshold 0.1 --sampler jittered", &["sobol or random"]);
    folder.expect_failure(2, "render scene.txt --time-limit soon", &["--time-limit"]);
    folder.expect_failure(2, "render scene.txt --preview p.xyz", &["p.xyz"]);
    folder.expect_failure(2, "render scene.txt --shard 1/2", &["--output"]);
    let many: String =
        (0..50_000).map(|i| format!("v {i} 0 1\nv {i} 1 {i}\nf {} {} 1\n", 2 * i + 1, 2 * i + 2)).collect();
    folder.write("large.obj", many);
    folder
        .write("large.txt", SCENE.replace("Sphere { center 0 0.5 0 radius 1 }", "TriangleMesh { obj_file large.obj }"));
    folder.expect_failure(2, "render large.txt --size 8x8 --memory 8M", &["large.obj", "of memory", "--memory"]);
}

#[test]
fn verify_reports_one_hash() {
    let folder = TestFolder::new();
    let output = folder.expect_exit(0, "verify scene.txt --trials 6 --size 24x20");
    assert!(output.out.starts_with("6 ways, structures bvh, grid, none"), "{}", output.out);
    let hash = last_line(&output.out);
    assert_eq!(last_line(&folder.expect_exit(0, "verify scene.txt --trials 1 --size 24x20 --quiet").out), hash);
    folder.expect_failure(2, "verify missing.txt", &["missing.txt"]);
}

#[cfg(target_os = "linux")]
#[test]
fn killed_program_is_resumed_by_the_next_run() {
    let folder = TestFolder::new();
    let work = "render scene.txt --size 160x120 --samples 80 --quiet --hash --resume --checkpoint-every 5ms";
    let hash = last_line(&folder.expect_exit(0, &format!("{work} -o calm.exr")).out);
    for i in 0..8 {
        let mut child =
            folder.command(&format!("{work} -o p.exr")).stdout(std::process::Stdio::null()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(10 + 23 * i));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    let output = folder.expect_exit(0, &format!("{work} -o p.exr"));
    assert_eq!(last_line(&output.out), hash);
    assert_eq!(folder.names(), ["calm.exr", "endless.txt", "p.exr", "scene.txt"]);
    assert!(folder.bytes("p.exr") == folder.bytes("calm.exr"));
}

#[cfg(target_os = "linux")]
#[test]
fn full_disk_is_reported_and_keeps_the_old_file() {
    let folder = TestFolder::new();
    for (name, options) in [("p.png", ""), ("p.exr", ""), ("p.part", "--shard 1/2")] {
        // Saved work may replace only other saved work.
        let old = if name == "p.part" { "" } else { "old" };
        folder.write(name, old);
        for limit in [0, 100, 500] {
            let line = format!("render scene.txt --size 40x30 -o {name} {options}");
            let mut command = std::process::Command::new("sh");
            command.args([
                "-c",
                "trap '' XFSZ; exec prlimit --fsize=\"$0\" \"$@\"",
                &limit.to_string(),
                common::durer(),
            ]);
            let output = command.args(line.split_whitespace()).current_dir(folder.path("")).output().unwrap();
            let text = String::from_utf8_lossy(&output.stderr).into_owned();
            if text.contains("prlimit: not found") {
                return println!("skipped: `prlimit` not found");
            }
            assert_eq!(output.status.code(), Some(1), "{text}");
            assert!(text.contains(&format!("cannot write `{name}`")), "{text}");
            assert_eq!(folder.bytes(name), old.as_bytes());
            assert!(folder.names().iter().all(|name| !name.ends_with(".tmp")));
        }
    }
}
