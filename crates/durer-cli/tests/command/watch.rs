//! Tests `--watch` while files are replaced, removed, half written, or saved a thousand times per
//! second.
use crate::common::{SCENE, TestFolder};
use std::os::unix::fs::symlink;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fn scene(color: &str) -> String {
    let mesh = SCENE.replace("Sphere { center 0 0.5 0 radius 1 }", "TriangleMesh { obj_file mesh.obj }");
    mesh.replace("0.8 0.3 0.2", color)
}

fn watching(folder: &TestFolder) -> Child {
    folder.write("scene.txt", scene("0.5 0.5 0.5"));
    folder.write("mesh.obj", MESH);
    let errors = std::fs::File::create(folder.path("errors")).unwrap();
    let line = "render scene.txt -o a.png --watch --size 16x16 --samples 2 --dialect durer";
    folder.command(line).stdout(Stdio::null()).stderr(errors).spawn().unwrap()
}

/// Waits until the picture is equal to a render of the current files.
fn shows_what_is_there(folder: &TestFolder, child: &mut Child, after: &str) {
    folder.expect_exit(0, "render scene.txt -o b.png --size 16x16 --samples 2 --dialect durer --quiet --restart");
    let start = Instant::now();
    let read = |name: &str| std::fs::read(folder.path(name)).unwrap_or_default();
    while read("a.png") != read("b.png") {
        assert_eq!(
            child.try_wait().unwrap(),
            None,
            "it ended after {after}: {}",
            String::from_utf8_lossy(&read("errors"))
        );
        assert!(start.elapsed() < Duration::from_secs(60), "no picture after {after}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn watch_survives_file_changes() {
    let folder = TestFolder::new();
    let mut child = watching(&folder);
    shows_what_is_there(&folder, &mut child, "the start");
    let pause = || std::thread::sleep(Duration::from_millis(120));
    let remove = |name: &str| {
        let path = folder.path(name);
        let _ = std::fs::remove_file(&path).or_else(|_| std::fs::remove_dir(&path));
    };
    for name in ["scene.txt", "mesh.obj"] {
        let whole = if name == "scene.txt" { scene("0.9 0.1 0.1") } else { MESH.replace("v 1 0 0", "v 2 0 0") };
        /// A way to change a watched file, with its name in messages and a function that does it.
        type Fire<'a> = (&'a str, Box<dyn Fn() + 'a>);
        let fires: [Fire; 9] = [
            ("a removal", Box::new(|| remove(name))),
            ("an empty file", Box::new(|| folder.write(name, ""))),
            ("half a file", Box::new(|| folder.write(name, &whole[..whole.len() / 2]))),
            ("zeros", Box::new(|| folder.write(name, vec![0; 1 << 20]))),
            (
                "a folder",
                Box::new(|| {
                    remove(name);
                    std::fs::create_dir(folder.path(name)).unwrap();
                }),
            ),
            (
                "a pipe",
                Box::new(|| {
                    remove(name);
                    assert!(Command::new("mkfifo").arg(folder.path(name)).status().unwrap().success());
                }),
            ),
            (
                "a device",
                Box::new(|| {
                    remove(name);
                    symlink("/dev/zero", folder.path(name)).unwrap();
                }),
            ),
            (
                "a circle of links",
                Box::new(|| {
                    remove(name);
                    symlink(name, folder.path(name)).unwrap();
                }),
            ),
            (
                "a file without rights",
                Box::new(|| {
                    remove(name);
                    folder.write(name, &whole);
                    let none = <std::fs::Permissions as std::os::unix::fs::PermissionsExt>::from_mode(0o000);
                    std::fs::set_permissions(folder.path(name), none).unwrap();
                }),
            ),
        ];
        for (what, fire) in &fires {
            fire();
            pause();
            remove(name);
            // Replace the file by renaming another one, as editors do.
            folder.write("new", &whole);
            std::fs::rename(folder.path("new"), folder.path(name)).unwrap();
            shows_what_is_there(&folder, &mut child, &format!("{what} in place of {name}"));
        }
    }
    // Modification times are set to the past and to the future.
    for date in ["1970-01-01", "2001-01-01", "2099-01-01", "1960-01-01"] {
        folder.write("scene.txt", scene(if date < "2001" { "0.1 0.9 0.2" } else { "0.1 0.2 0.9" }));
        let _ = Command::new("touch").args(["-d", date]).arg(folder.path("scene.txt")).status();
        shows_what_is_there(&folder, &mut child, date);
    }
    // The change of the date may start another render, which the signal then interrupts.
    ended(&folder, child, &[0, 130]);
}

#[test]
fn rapid_saves_end_in_last_picture() {
    let folder = TestFolder::new();
    let mut child = watching(&folder);
    shows_what_is_there(&folder, &mut child, "the start");
    for number in 0..2000 {
        let text = scene(&format!("0.{:03} 0.5 0.5", number % 1000));
        match number % 3 {
            0 => folder.write("scene.txt", &text[..text.len() / 2]),
            1 => folder.write("scene.txt", &text),
            _ => {
                folder.write("new", &text);
                std::fs::rename(folder.path("new"), folder.path("scene.txt")).unwrap();
            }
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    folder.write("scene.txt", scene("0.25 0.5 0.75"));
    shows_what_is_there(&folder, &mut child, "2000 saves");
    // Writing truncates the file first, so the last save may start two renders; the signal can
    // interrupt the second.
    ended(&folder, child, &[0, 130]);
}

/// A signal ends the watch even if it arrives while the picture is being saved.
#[test]
fn signal_during_a_save_ends_the_watch() {
    let folder = TestFolder::new();
    for number in 0..20 {
        let mut child = watching(&folder);
        let start = Instant::now();
        while !folder.path("a.png").exists() {
            assert_eq!(child.try_wait().unwrap(), None);
            assert!(start.elapsed() < Duration::from_secs(60), "no picture in run {number}");
        }
        // Before anything is saved, the signal ends the program with exit code 130.
        ended(&folder, child, &[0, 130]);
        std::fs::remove_file(folder.path("a.png")).unwrap();
    }
}

fn ended(folder: &TestFolder, mut child: Child, codes: &[i32]) {
    Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    let start = Instant::now();
    let code = loop {
        match child.try_wait().unwrap() {
            Some(status) => break status.code().unwrap(),
            None if start.elapsed() < Duration::from_secs(30) => std::thread::sleep(Duration::from_millis(10)),
            None => {
                child.kill().unwrap();
                panic!("it runs on after Ctrl-C");
            }
        }
    };
    assert!(codes.contains(&code), "exit code {code}");
    let output = String::from_utf8_lossy(&folder.bytes("errors")).into_owned();
    assert!(!output.contains("panicked"), "{output}");
    let left: Vec<String> =
        folder.names().into_iter().filter(|name| name.ends_with(".tmp") || name.ends_with(".part")).collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn save_that_keeps_size_and_time_is_seen() {
    let folder = TestFolder::new();
    let mut child = watching(&folder);
    shows_what_is_there(&folder, &mut child, "the start");
    // `cp -p`, `tar` and `rsync` set the time of the file that they overwrite.
    let old = std::fs::metadata(folder.path("scene.txt")).unwrap();
    std::fs::write(folder.path("scene.txt"), scene("0.1 0.9 0.2")).unwrap();
    let file = std::fs::File::options().write(true).open(folder.path("scene.txt")).unwrap();
    file.set_modified(old.modified().unwrap()).unwrap();
    assert_eq!(file.metadata().unwrap().len(), old.len());
    shows_what_is_there(&folder, &mut child, "a save with the same size and time");
    child.kill().unwrap();
    child.wait().unwrap();
}
