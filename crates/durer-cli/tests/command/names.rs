//! Tests file names inside input files. Files outside the folder, pipes and devices must not be
//! read and must not block the program.
use crate::common::{ProgramOutput, SCENE, TestFolder};
use std::os::unix::fs::symlink;
use std::process::Command;

/// Creates a COLMAP folder for two photographs of 32 x 32 pixels.
fn colmap(place: &TestFolder, folder: &str, names: [&str; 2]) {
    std::fs::create_dir_all(place.path(folder)).unwrap();
    place.write(&format!("{folder}/cameras.txt"), "1 PINHOLE 32 32 30 30 16 16\n");
    let [a, b] = names;
    let images = format!("1 1 0 0 0 0 0 5 1 {a}\n16 16 1\n2 1 0 0 0 .1 0 5 1 {b}\n16 16 1\n");
    place.write(&format!("{folder}/images.txt"), images);
    place.write(&format!("{folder}/points3D.txt"), "1 0 0 0 255 0 0 0.1 1 0 2 0\n");
}

fn picture(folder: &TestFolder, path: &str) {
    folder.expect_exit(0, &format!("render scene.txt --size 32x32 --samples 1 -q --restart -o {path}"));
}

fn fifo(folder: &TestFolder, name: &str) {
    assert!(Command::new("mkfifo").arg(folder.path(name)).status().unwrap().success());
}

/// Runs a command that must end within ten seconds.
fn ends(folder: &TestFolder, line: &str) -> ProgramOutput {
    let output = folder.shell(&format!("timeout 10 $DURER {line}"));
    assert_ne!(output.code, Some(124), "{line} does not end");
    output
}

#[track_caller]
fn refused(folder: &TestFolder, line: &str, words: &str) {
    let output = ends(folder, line);
    assert_eq!(output.code, Some(2), "{line}: {}", output.err);
    assert!(output.err.contains(words), "{line}: {}", output.err);
}

#[test]
fn tour_embeds_only_pictures_of_its_folder() {
    let folder = TestFolder::new();
    std::fs::create_dir_all(folder.path("photos/more")).unwrap();
    for path in ["secret.png", "photos/a.png", "photos/more/b.png"] {
        picture(&folder, path);
    }
    symlink("../secret.png", folder.path("photos/link.png")).unwrap();
    symlink("/dev/zero", folder.path("photos/zero.png")).unwrap();
    symlink("more/b.png", folder.path("photos/inner.png")).unwrap();
    fifo(&folder, "photos/pipe.png");
    let absolute = folder.path("secret.png").display().to_string();
    for (name, words) in [
        ("../secret.png", "outside the folder `photos`"),
        ("more/../../secret.png", "outside the folder `photos`"),
        (&absolute, "outside the folder `photos`"),
        ("link.png", "outside the folder `photos`"),
        ("/dev/zero", "outside the folder `photos`"),
        ("/proc/self/environ", "outside the folder `photos`"),
        ("zero.png", "outside the folder `photos`"),
        ("pipe.png", "is not a regular file"),
        ("more", "is not a regular file"),
        ("none.png", "No such file"),
    ] {
        colmap(&folder, "solved", ["a.png", name]);
        refused(&folder, "photo tour solved --pictures photos -o t.html -q", words);
        assert!(!folder.path("t.html").exists(), "{name}");
    }
    colmap(&folder, "solved", ["a.png", "more/b.png"]);
    folder.expect_exit(0, "photo tour solved --pictures photos -o t.html -q");
    colmap(&folder, "solved", ["a.png", "inner.png"]);
    folder.expect_exit(0, "photo tour solved --pictures photos -o t.html -q");
}

#[test]
fn photo_folder_does_not_lead_outside() {
    let folder = TestFolder::new();
    std::fs::create_dir(folder.path("photos")).unwrap();
    for path in ["secret.png", "photos/a.png", "photos/b.png"] {
        picture(&folder, path);
    }
    // These are tables of points in a folder, and a file of tracks next to a reconstruction.
    colmap(&folder, "solved", ["a.png", "b.png"]);
    std::fs::rename(folder.path("solved/points3D.txt"), folder.path("points")).unwrap();
    for (target, words) in [("../points", "outside the folder `solved`"), ("/dev/zero", "outside the folder `solved`")]
    {
        symlink(target, folder.path("solved/points3D.txt")).unwrap();
        refused(&folder, "photo convert solved", words);
        std::fs::remove_file(folder.path("solved/points3D.txt")).unwrap();
    }
    fifo(&folder, "solved/points3D.txt");
    refused(&folder, "photo convert solved", "is not a regular file");
    std::fs::create_dir(folder.path("sfm")).unwrap();
    folder.write("sfm/reconstruction.json", "[]");
    symlink("../points", folder.path("sfm/tracks.csv")).unwrap();
    refused(&folder, "photo convert sfm/reconstruction.json", "outside the folder `sfm`");
    // A Bundler file does not contain the sizes of the photographs, so the photographs are read.
    let bundle = "# Bundle file v0.3\n2 0\n30 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n30 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0\n";
    folder.write("two.out", bundle);
    folder.expect_exit(0, "photo convert two.out --pictures photos -o two.gltf -q");
    std::fs::remove_file(folder.path("photos/b.png")).unwrap();
    symlink("../secret.png", folder.path("photos/b.png")).unwrap();
    for line in [
        "photo convert two.out --pictures photos",
        "photo match photos -o m.json",
        "photo explain two.out --camera 0 --pictures photos",
    ] {
        refused(&folder, line, "outside the folder `photos`");
    }
}

#[test]
fn pipes_and_devices_that_are_named_are_refused() {
    let folder = TestFolder::new();
    fifo(&folder, "pipe.txt");
    fifo(&folder, "pipe.png");
    fifo(&folder, "pipe.json");
    picture(&folder, "a.png");
    folder.write("points", "0 0 0 1 1\n");
    for line in [
        "photo convert pipe.txt",
        "photo solve pipe.json -o o.out",
        "photo camera pipe.png --points points",
        "photo camera a.png --points pipe.txt",
        "photo place scene.txt --backplate pipe.png -o o.png",
        "photo camera a.png --points /dev/zero",
        "render pipe.txt -o o.png",
        "check pipe.txt",
        "compare a.png pipe.png",
        "merge pipe.txt -o o.png",
        "convert pipe.txt -o o.gltf",
    ] {
        refused(&folder, line, "is not a regular file");
    }
    refused(&folder, "live pipe.txt", "is not a file");
    // A folder of pictures may contain files of any kind.
    std::fs::create_dir(folder.path("one")).unwrap();
    std::fs::create_dir(folder.path("two")).unwrap();
    picture(&folder, "one/a.png");
    fifo(&folder, "two/a.png");
    assert_ne!(ends(&folder, "compare one two").code, Some(0));
}

#[test]
fn lesson_ignores_pipes_and_devices() {
    for target in ["pipe.txt", "/dev/zero"] {
        let folder = TestFolder::new();
        std::fs::create_dir(folder.path("lesson")).unwrap();
        fifo(&folder, "pipe.txt");
        symlink(folder.path(target), folder.path("lesson/lesson.md")).unwrap();
        let output = ends(&folder, "lesson scene.txt -o lesson --size 16x12 --samples 1 -q");
        assert_ne!(output.code, Some(0), "{target}");
    }
}

#[test]
fn pipes_with_names_of_temporary_files_delay_no_save() {
    let folder = TestFolder::new();
    let output = folder.shell("$DURER render scene.txt --size 8x8 --samples 1 -q -o o.png; ls -a");
    assert_eq!(output.code, Some(0), "{}", output.err);
    // Renders that were killed leave temporary files with such names.
    for name in [".durer-ready-1.tmp", ".durer-1.tmp", ".durer-x.tmp"] {
        fifo(&folder, name);
    }
    assert_eq!(ends(&folder, "render scene.txt --size 8x8 --samples 1 -q --restart -o o.png").code, Some(0));
}

#[test]
fn watched_scene_reads_no_other_files() {
    let folder = TestFolder::new();
    picture(&folder, "secret.png");
    std::fs::create_dir(folder.path("below")).unwrap();
    let field = "HeightField { picture ../secret.png min -1 0 -1  max 1 1 1 }";
    folder.write("below/scene.txt", SCENE.replace("Sphere { center 0 0.5 0 radius 1 }", field));
    let output = folder.shell(
        "timeout -s INT 3 $DURER render below/scene.txt --dialect durer --watch --size 8x8 --samples 1 -o below/o.png",
    );
    assert!(output.err.contains("is outside the scene's folder"), "{}", output.err);
    assert!(!folder.path("below/o.png").exists());
}
