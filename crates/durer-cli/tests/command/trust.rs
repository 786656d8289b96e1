//! Tests hostile input: files that exhaust memory, options that would overwrite files, and system
//! limits.
use crate::common::{self, ProgramOutput, SCENE, TestFolder};
use std::os::unix::fs::symlink;
use std::time::Duration;

/// Returns one chunk of a PNG file.
fn chunk(kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
    let mut chunk = (content.len() as u32).to_be_bytes().to_vec();
    chunk.extend(kind);
    chunk.extend(content);
    let mut crc = !0_u32;
    for byte in kind.iter().chain(content) {
        crc ^= u32::from(*byte);
        (0..8).for_each(|_| crc = crc >> 1 ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 });
    }
    chunk.extend((!crc).to_be_bytes());
    chunk
}

/// Returns a PNG with a single colour and with extra chunks between the header and the pixels.
fn png(side: u32, between: &[u8]) -> Vec<u8> {
    let mut head = [side.to_be_bytes(), side.to_be_bytes()].concat();
    head.extend([8, 2, 0, 0, 0]);
    let pixels = zeros(u64::from(side) * (3 * u64::from(side) + 1));
    [b"\x89PNG\r\n\x1a\n", &chunk(b"IHDR", &head)[..], between, &chunk(b"IDAT", &pixels), &chunk(b"IEND", b"")].concat()
}

/// Returns `count` zeros, compressed as much as deflate allows.
fn zeros(count: u64) -> Vec<u8> {
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    std::io::copy(&mut std::io::Read::take(std::io::repeat(0), count), &mut packer).unwrap();
    packer.finish().unwrap()
}

fn with_pictures(folder: &TestFolder, name: &str) -> [String; 3] {
    let texture = "PhongMaterial { texture PICTURE diffuseColor 0.8 0.3 0.2 }";
    let field = "HeightField { picture PICTURE min -1 0 -1  max 1 1 1 }";
    let sky = "Background { cubeMap sky color 0.2 0.1 0.5";
    let scenes = [
        ("texture.txt", SCENE.replace("Material { diffuseColor 0.8 0.3 0.2 }", texture)),
        ("field.txt", SCENE.replace("Sphere { center 0 0.5 0 radius 1 }", field)),
        ("sky.txt", SCENE.replace("Background { color 0.2 0.1 0.5", sky)),
    ];
    let _ = std::fs::create_dir(folder.path("sky"));
    for face in ["left", "right", "up", "down", "front", "back"] {
        let face = folder.path(&format!("sky/{face}.png"));
        let _ = std::fs::remove_file(&face);
        std::fs::hard_link(folder.path(name), face).unwrap();
    }
    scenes.map(|(file, text)| {
        folder.write(file, text.replace("PICTURE", name));
        format!("render {file} --dialect durer --size 8x8 --samples 1 --quiet --restart -o {file}.png")
    })
}

/// Limits the program to half a gigabyte of address space and two threads.
const LIMITED: &str = "ulimit -v 700000; export RAYON_NUM_THREADS=2; $DURER ";

#[cfg(target_os = "linux")]
#[test]
fn compression_bombs_in_profiles_are_not_inflated() {
    let folder = TestFolder::new();
    let mut profile = b"x\0\0".to_vec();
    profile.extend(zeros(1 << 29));
    folder.write("bomb.png", png(4, &chunk(b"iCCP", &profile)));
    for line in with_pictures(&folder, "bomb.png") {
        let output = folder.shell(&format!("{LIMITED}{line} --threads 2"));
        assert_eq!(output.code, Some(0), "{line}: {}", output.err);
    }
    let output = folder.shell(&format!("{LIMITED}compare bomb.png bomb.png"));
    assert_eq!((output.code, output.out.lines().next()), (Some(0), Some("identical")), "{}", output.err);
}

#[cfg(target_os = "linux")]
#[test]
fn large_pictures_are_refused_by_their_headers() {
    let folder = TestFolder::new();
    folder.write("large.png", png(6000, b""));
    let [texture, field, sky] = with_pictures(&folder, "large.png");
    for (line, words) in
        [(texture, "need about 275"), (field, "the image of a height field must have"), (sky, "need about 275")]
    {
        let output = folder.shell(&format!("{LIMITED}{line} --threads 2 --memory 64M"));
        assert_eq!(output.code, Some(2), "{line}: {}", output.err);
        assert!(output.err.contains(words), "{}", output.err);
    }
    // Readers of other formats decode their images themselves, but the same memory limit applies.
    let pbrt = "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n";
    let lit = r#"LightSource "infinite" "string filename" "large.png" Shape "sphere""#;
    let rough = r#"Texture "t" "float" "imagemap" "string filename" "large.png"
        Material "coateddiffuse" "texture roughness" "t" Shape "sphere""#;
    folder.write("lit.pbrt", format!("{pbrt}{lit}"));
    folder.write("rough.pbrt", format!("{pbrt}{rough}"));
    folder.write(
        "lit.xml",
        r#"<scene version="3.0.0"><sensor type="perspective"/><shape type="sphere"/>
        <emitter type="envmap"><string name="filename" value="large.png"/></emitter></scene>"#,
    );
    folder.write(
        "bright.rad",
        "void colorpict p\n7 red green blue large.png . u v\n0\n0\np plastic m\n0\n0\n5 .5 .5 .5 0 0\n\
        m sphere s\n0\n0\n4 0 0 0 1\n",
    );
    folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for scene in ["lit.pbrt", "rough.pbrt", "lit.xml", "bright.rad", "m.obj --environment large.png --up z"] {
        let line = format!("render {scene} --size 8x8 --samples 1 --quiet --restart -o o.png");
        let output = folder.shell(&format!("{LIMITED}{line} --threads 2 --memory 64M"));
        assert_eq!(output.code, Some(2), "{line}: {}", output.err);
        assert!(output.err.contains("need about") && output.err.contains("see `--memory`"), "{line}: {}", output.err);
    }
    // The decoded picture is copied once, so two copies exist for a short time.
    folder.write("large.png", png(5000, b""));
    let [texture, ..] = with_pictures(&folder, "large.png");
    let output = folder.shell(&format!("{LIMITED}{texture} --threads 2 --memory 120M"));
    assert!(output.code == Some(2) && output.err.contains("need about 191 MiB"), "{}", output.err);
    // The six faces together exceed the limit, although each one alone would fit.
    folder.write("large.png", png(2000, b""));
    let [texture, _, sky] = with_pictures(&folder, "large.png");
    assert_eq!(folder.shell(&format!("{LIMITED}{texture} --threads 2 --memory 32M")).code, Some(0));
    let output = folder.shell(&format!("{LIMITED}{sky} --threads 2 --memory 32M"));
    assert!(output.code == Some(2) && output.err.contains(" left"), "{}", output.err);
    folder.write("small.png", png(8, b""));
    let output = folder.shell(&format!("{LIMITED}compare large.png large.png --memory 300M"));
    assert!(output.code == Some(2) && output.err.contains("the limit is 300 MiB"), "{}", output.err);
    let output = folder.shell(&format!("{LIMITED}compare large.png small.png"));
    assert!(output.code == Some(2) && output.err.contains("different sizes"), "{}", output.err);
}

#[test]
fn no_input_is_overwritten() {
    let folder = TestFolder::new();
    folder.write("p.png", png(8, b""));
    folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let mesh = SCENE.replace("Sphere { center 0 0.5 0 radius 1 }", "TriangleMesh { obj_file m.obj }");
    let texture = SCENE.replace("Material { diffuse", "PhongMaterial { texture p.png diffuse");
    folder.write("mesh.txt", mesh);
    folder.write("texture.txt", texture);
    symlink("p.png", folder.path("link.png")).unwrap();
    std::fs::hard_link(folder.path("p.png"), folder.path("hard.png")).unwrap();
    symlink(".", folder.path("here")).unwrap();
    std::fs::create_dir(folder.path("folder")).unwrap();
    symlink("m.obj", folder.path("mesh.png")).unwrap();
    symlink("scene.txt", folder.path("scene.png")).unwrap();
    let size = "--size 8x8 --samples 1";
    for line in [
        format!("render scene.txt {size} -o scene.png"),
        format!("render scene.txt {size} -o o.png --preview here/scene.png"),
        format!("render texture.txt --dialect durer {size} -o p.png"),
        format!("render texture.txt --dialect durer {size} -o ./here/folder/../p.png"),
        format!("render texture.txt --dialect durer {size} -o link.png"),
        format!("render texture.txt --dialect durer {size} -o hard.png"),
        format!("render texture.txt --dialect durer {size} -o o.png --preview p.png"),
        format!("render mesh.txt {size} -o mesh.png"),
        format!("explain scene.txt {size} --pixel 3,3 --html scene.txt"),
        format!("explain mesh.txt {size} --pixel 3,3 --html ./m.obj"),
        "convert scene.txt -o here/scene.txt".into(),
        "convert mesh.txt -o m.obj".into(),
        "compare p.png link.png --report hard.png".into(),
        "compare p.png p.png --report r.html --heat here/p.png".into(),
        "compare p.png p.png --report scene.txt --scene scene.txt".into(),
        "check mesh.txt --fix -o m.obj".into(),
        "check scene.txt --fix -o here/scene.txt".into(),
        "course -input scene.txt -size 8 8 -output scene.png".into(),
        "course -input mesh.txt -size 8 8 -normals mesh.png".into(),
    ] {
        let before = ["scene.txt", "p.png", "m.obj"].map(|name| folder.bytes(name));
        let names = folder.names();
        let result = folder.expect_exit(2, &line);
        assert!(result.err.contains("is an input of this run"), "{line}: {}", result.err);
        assert!(before == ["scene.txt", "p.png", "m.obj"].map(|name| folder.bytes(name)), "{line}");
        assert_eq!(folder.names(), names, "{line}");
    }
    let two = "choose another name for one of them";
    folder.expect_failure(2, &format!("render scene.txt {size} -o o.png --preview here/o.png"), &[two]);
    folder.expect_failure(2, &format!("render scene.txt {size} -o o.png --checkpoint ./o.png"), &[two]);
    folder.expect_failure(2, "course -input scene.txt -output o.tga -normals ./o.tga", &[two]);
    // This part file has a name like that of a picture.
    folder.expect_exit(0, &format!("render scene.txt {size} --shard 1/1 -o part.png --quiet"));
    folder.expect_failure(2, "merge part.png -o here/part.png", &["is an input of this run"]);
    // Saved work never overwrites other files.
    for option in ["--checkpoint scene.txt", "--checkpoint here/m.obj", "--shard 1/1"] {
        let output = if option.starts_with("--sh") { "endless.txt" } else { "o.png" };
        folder.expect_failure(2, &format!("render mesh.txt {size} {option} -o {output}"), &["not a part file"]);
    }
    // Other outputs never overwrite saved work.
    let part = folder.bytes("part.png");
    for line in [
        format!("render scene.txt {size} -o part.png"),
        format!("explain scene.txt {size} --pixel 3,3 --html here/part.png"),
        "convert scene.txt -o part.png".into(),
        "compare p.png p.png --report part.png".into(),
        "check scene.txt --fix -o part.png".into(),
    ] {
        folder.expect_failure(2, &line, &["holds saved work"]);
        assert_eq!(folder.bytes("part.png"), part, "{line}");
    }
    folder.write("o.png.part", "somebody's download");
    folder.expect_failure(2, &format!("render scene.txt {size} -o o.png"), &["`o.png.part` is not a part file"]);
    assert_eq!(folder.bytes("o.png.part"), b"somebody's download");
}

#[test]
fn lesson_replaces_no_file_of_its_scene() {
    let folder = TestFolder::new();
    folder.expect_exit(0, "lesson scene.txt -o lesson --size 16x12 --samples 1 --quiet");
    let own: Vec<_> = std::fs::read_dir(folder.path("lesson")).unwrap().map(|e| e.unwrap().file_name()).collect();
    let picture = own.iter().map(|name| name.to_str().unwrap()).find(|name| name.ends_with(".png")).unwrap();
    let field = format!("HeightField {{ picture {picture} min -1 0 -1  max 1 1 1 }}");
    folder.write("lesson/mine.txt", SCENE.replace("Sphere { center 0 0.5 0 radius 1 }", &field));
    let before = folder.bytes(&format!("lesson/{picture}"));
    let output =
        folder.expect_exit(2, "lesson lesson/mine.txt --dialect durer -o lesson --size 16x12 --samples 1 --quiet");
    assert!(output.err.contains("is an input of this run"), "{}", output.err);
    assert!(folder.bytes(&format!("lesson/{picture}")) == before);
}

#[test]
fn special_files_are_written_through_or_refused_at_once() {
    let folder = TestFolder::new();
    symlink("nowhere", folder.path("dangling.png")).unwrap();
    symlink("loop.png", folder.path("loop.png")).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(folder.path("pipe.png")).status().unwrap().success());
    symlink("/dev/null", folder.path("null.png")).unwrap();
    let work = "render scene.txt --size 8x8 --samples 1 --quiet";
    folder.expect_failure(1, &format!("{work} -o dangling.png"), &["broken symbolic link"]);
    folder.expect_failure(1, &format!("{work} -o loop.png"), &["broken symbolic link"]);
    folder.expect_failure(1, &format!("{work} -o pipe.png"), &["a pipe without a reader"]);
    folder.expect_failure(1, &format!("{work} -o o.png --preview pipe.png"), &["a pipe without a reader"]);
    folder.expect_failure(2, &format!("{work} -o o.png --checkpoint null.png"), &["is not a regular file"]);
    folder.expect_exit(0, &format!("{work} -o null.png --no-checkpoint"));
    let reader = folder.path("pipe.png");
    let reader = std::thread::spawn(move || std::fs::read(reader).unwrap());
    // The reader may not be ready immediately.
    let output = (0..100).map(|_| folder.run(&format!("{work} -o pipe.png"))).find(|output| output.code == Some(0));
    assert!(output.is_some() && reader.join().unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn unfinished_work_is_kept_unless_restarted() {
    let folder = TestFolder::new();
    let work = "render scene.txt --size 300x200 --samples 100000 --quiet";
    for (place_of_part, options) in [("o.png.part", "-o o.png"), ("s.part", "--shard 1/2 -o s.part")] {
        let (output, _) =
            folder.interrupted(&format!("{work} {options} --checkpoint-every 50ms"), Duration::from_millis(700));
        assert_eq!(output.code, Some(130), "{}", output.err);
        let saved = folder.bytes(place_of_part);
        for other in ["", "--seed 3", "--bounces 1"] {
            let line = format!("{work} {options} {other}");
            folder.expect_failure(2, &line, &["unfinished work", place_of_part, "--resume", "--restart"]);
        }
        folder.expect_failure(2, &format!("{work} {options} --resume --seed 3"), &["a different job", "--restart"]);
        folder.expect_failure(2, &format!("{work} {options} --resume --restart"), &["cannot be used with"]);
        assert!(folder.bytes(place_of_part) == saved);
        folder.expect_exit(0, &format!("render scene.txt --size 48x32 --quiet {options} --restart"));
        // A finished shard is replaced like any picture.
        folder.expect_exit(0, &format!("render scene.txt --size 48x32 --seed 1 --quiet {options}"));
        assert!(!folder.path("o.png.part").exists());
    }
    let saved = folder.bytes("s.part");
    folder.write("s.part", &saved[..saved.len() / 2]);
    folder.expect_failure(2, &format!("{work} --shard 1/2 -o s.part"), &["truncated or damaged", "--restart"]);
}

#[test]
fn terminating_signals_save_the_work() {
    let folder = TestFolder::new();
    let work = "render scene.txt --size 300x200 --samples 100000 --quiet --restart -o o.png";
    for (signals, code) in [
        (&["INT"][..], 130),
        (&["TERM"], 143),
        (&["HUP"], 129),
        // Send the signals that `timeout` and closed terminals send.
        (&["INT", "INT"], 130),
        (&["TERM", "TERM"], 143),
        (&["HUP", "TERM"], 129),
    ] {
        // On a busy machine, the first sample can take longer than half a second.
        let delays = [500, 2000, 8000].map(Duration::from_millis);
        let mut runs = delays.into_iter().map(|delay| folder.send_signals(work, delay, signals));
        let has_samples = |(output, _): &(ProgramOutput, Duration)| !output.err.contains("nothing was written");
        let (output, latency) = runs.find(has_samples).expect("no sample in 8 seconds");
        assert_eq!(output.code, Some(code), "{signals:?}: {}", output.err);
        assert!(output.err.contains("o.png.part (--resume"), "{signals:?}: {}", output.err);
        assert!(latency < Duration::from_secs(5), "{latency:?}");
    }
    // A program that was started with nohup keeps running when its terminal is closed.
    let output = folder.shell(
        "trap '' HUP; $DURER render scene.txt --size 200x150 --samples 400 --quiet --restart -o n.png & \
         sleep 0.3; kill -HUP $!; wait $!",
    );
    assert_eq!(output.code, Some(0), "{}", output.err);
}

#[cfg(target_os = "linux")]
#[test]
fn system_limits_are_named_errors() {
    let folder = TestFolder::new();
    let work = "$DURER render scene.txt --size 64x64 --samples 1 --quiet";
    let output = folder.shell(&format!("(ulimit -f 1; {work} -o o.pfm 2>&1) | cat; exit ${{PIPESTATUS[0]}}"));
    assert_eq!(output.code, Some(1), "{}", output.out);
    assert!(output.out.contains("cannot write `o.pfm`: File too large"), "{}", output.out);
    let output = folder.shell(&format!("RAYON_NUM_THREADS=100000 {work} -o o.png"));
    assert_eq!(output.code, Some(0), "{}", output.err);
    let output = folder.shell(&format!("{work} -o o.png --memory 1000"));
    assert!(output.code == Some(2) && output.err.contains("the limit is 1000 bytes;"), "{}", output.err);
    for (line, code) in [
        ("$DURER info scene.txt >&-", 1),
        ("$DURER render scene.txt --size 8x8 -o c.png >&-", 1),
        ("$DURER course -input scene.txt -size 8 8 -output /dev/stdout >&-", 1),
        ("$DURER render scene.txt --size 8x8 --quiet -o c.png >&-", 0),
        ("$DURER info scene.txt >/dev/null", 0),
        ("$DURER info scene.txt 1<>/dev/null", 0),
    ] {
        let output = folder.shell(line);
        assert_eq!(output.code, Some(code), "{line}: {}", output.err);
        assert_eq!(output.err.contains("the stream is closed"), code == 1, "{line}: {}", output.err);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn calling_thread_does_all_work_without_threads() {
    let folder = TestFolder::new();
    // Permissions do not limit the superuser. The test therefore runs as the user nobody, in a
    // folder that this user cannot write to.
    let nobody = "setpriv --reuid=65534 --regid=65534 --clear-groups";
    let usable = folder.shell(&format!("chmod 777 . && cp {} own && {nobody} ./own dialects", common::durer()));
    if usable.code != Some(0) {
        return println!("skipped: cannot switch to another user: {}", usable.err);
    }
    let run = |limit: u32, arguments: &str| {
        let output = folder.shell(&format!("{nobody} bash -c 'ulimit -u {limit}; exec ./own {arguments}'"));
        assert_eq!(output.code, Some(0), "{limit} {arguments}: {}", output.err);
        assert!(!output.err.contains("panicked"), "{}", output.err);
        output.out
    };
    let work = "render scene.txt --size 48x40 --samples 4 --bounces 256 --show color,depth --quiet --hash";
    let hashes = [1, 2, 3, 4, 1000].map(|limit| run(limit, &format!("{work} -o {limit}.exr")));
    assert!(hashes.iter().all(|hash| *hash == hashes[0] && hash.len() > 60), "{hashes:?}");
    assert!(folder.bytes("1.exr") == folder.bytes("1000.exr"));
    let _ = run(1, "compare 1.exr 2.exr --report r.html");
    let _ = run(1, "explain scene.txt --size 48x40 --pixel 20,20 --bounces 256");
    let _ = run(1, "info scene.txt");
    let _ = run(1, "lesson scene.txt -o lesson --size 16x12 --samples 1");
    let _ = run(1, "course -input scene.txt -size 20 20 -output o.tga -grid 5 5 5 -visualize_grid");
}

#[test]
fn photographs_larger_than_memory_are_refused() {
    let folder = TestFolder::new();
    std::fs::create_dir(folder.path("photos")).unwrap();
    folder.write("photos/a.png", png(12_000, b""));
    std::fs::copy(folder.path("photos/a.png"), folder.path("photos/b.png")).unwrap();
    let output = folder.shell("ulimit -v 900000; export RAYON_NUM_THREADS=2; $DURER photo match photos -o m.json -q");
    assert_eq!(output.code, Some(2), "{}", output.err);
    assert!(output.err.contains("bytes of memory, more than the limit"), "{}", output.err);
}

#[test]
fn names_and_texts_cannot_control_the_terminal() {
    let folder = TestFolder::new();
    folder.write(
        "scene.txt",
        SCENE.replace("Sphere { center 0 0.5 0 radius 1 }", "TriangleMesh { obj_file a\u{1b}]0;x\u{7}\u{202e}.obj }"),
    );
    for line in ["info scene.txt --dialect durer", "render gone\u{1b}[2J.txt -o a.png"] {
        let output = folder.run(line);
        assert!(!output.err.contains(['\u{1b}', '\u{7}', '\u{202e}']), "{:?}", output.err);
        assert!(output.err.contains("\\u{1b}"), "{:?}", output.err);
    }
}
