//! Runs every command in the README and the book with a small picture size.
//!
//! docs/lecture.md has a test of its own.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Option values that are replaced in order to keep the test short.
const SMALLER: [(&str, &str); 3] = [("--size", "40x30"), ("--samples", "4"), ("--pixel", "20,15")];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Folders with pages of the book.
const FOLDERS: [&str; 4] = ["docs", "docs/coming", "docs/language", "docs/tutorial"];

/// Returns the README and all pages of the book.
fn pages() -> Vec<String> {
    let mut pages = vec!["README.md".to_string(), "crates/durer-cli/README.md".to_string()];
    for folder in FOLDERS {
        let names = std::fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().file_name());
        let names = names.map(|name| format!("{folder}/{}", name.to_string_lossy()));
        pages.extend(names.filter(|name| name.ends_with(".md") && name != "docs/lecture.md"));
    }
    pages.sort();
    pages
}

/// Returns the commands of a page in order. Commands are lines of code that begin with `cargo
/// durer` or `durer`. A command may use files that earlier commands wrote.
fn commands(page: &str) -> Vec<String> {
    let text = std::fs::read_to_string(root().join(page)).unwrap();
    let lines = text.lines().filter_map(|line| line.strip_prefix("    "));
    let commands = lines.filter_map(|line| line.strip_prefix("cargo ").unwrap_or(line).strip_prefix("durer "));
    // A server runs until it is stopped, `--device gpu` needs a graphics processor, and
    // `--terminal` needs a terminal. All have their own tests.
    let has_own_tests = |command: &str| {
        command.starts_with("live ") || command.contains("--device gpu") || command.contains("--terminal")
    };
    commands.filter(|command| !has_own_tests(command) && *command != "lesson monday.md").map(str::to_string).collect()
}

/// Returns the scenes of a page: fenced blocks that begin with a comment that names their file.
fn scenes(page: &str) -> Vec<(String, String)> {
    let text = std::fs::read_to_string(root().join(page)).unwrap();
    let blocks = text.split("\n```\n").skip(1).step_by(2);
    let name = |block: &str| {
        block.lines().next()?.strip_prefix("# ").filter(|name| name.ends_with(".txt")).map(str::to_string)
    };
    blocks.filter_map(|block| Some((name(block)?, block.to_string()))).collect()
}

/// Files that pages refer to but do not create. `scene.txt` and `model.glb` are generated from a
/// scene.
const STAND_INS: [(&str, &str); 4] = [
    (
        "scene.xml",
        r#"<scene version="3.0.0"><sensor type="perspective"/><sensor type="perspective" id="second"/>
        <emitter type="constant"/><shape type="sphere"/></scene>"#,
    ),
    ("office.rad", "void light l\n0\n0\n3 9 9 9\nl sphere s\n0\n0\n4 0 0 0 1\n"),
    ("office.rif", "scene= office.rad\nview= def -vp 0 -5 0 -vd 0 1 0\n"),
    ("office.vf", "rvu -vtv -vp 0 -5 0 -vd 0 1 0 -vu 0 0 1 -vh 45 -vv 45\n"),
];

/// Changes a command so that it renders only a few pixels.
fn smaller(command: &str) -> String {
    let mut words: Vec<&str> = command.split_whitespace().collect();
    for i in 1..words.len() {
        if let Some((_, value)) = SMALLER.iter().find(|row| row.0 == words[i - 1]) {
            words[i] = value;
        }
    }
    let sized = ["render", "explain", "lesson"].contains(&words[0]) && !words.contains(&"--size");
    words.extend(if sized { &["--size", "40x30"][..] } else { &[] });
    words.join(" ")
}

#[test]
#[cfg(unix)]
fn every_command_of_the_book_runs() {
    let durer = |folder: &Path, line: &str| {
        // Expand file name patterns in the same way as a shell.
        let line = format!("{} {line}", env!("CARGO_BIN_EXE_durer"));
        Command::new("sh").args(["-c", &line]).current_dir(folder).output().unwrap()
    };
    let mut count = 0;
    for page in pages() {
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(root().join("scenes").canonicalize().unwrap(), folder.path().join("scenes"))
            .unwrap();
        std::fs::copy(root().join("scenes/sphere.txt"), folder.path().join("scene.txt")).unwrap();
        STAND_INS.iter().for_each(|(name, text)| std::fs::write(folder.path().join(name), text).unwrap());
        scenes(&page).iter().for_each(|(name, text)| std::fs::write(folder.path().join(name), text).unwrap());
        let commands = commands(&page);
        if commands.iter().any(|command| command.contains("model.glb")) {
            assert!(durer(folder.path(), "convert scene.txt -o model.glb").status.success());
        }
        if commands.iter().any(|command| command.contains("class.csv")) {
            for pictures in ["reference", "class/anna"] {
                std::fs::create_dir_all(folder.path().join(pictures)).unwrap();
                let line = format!("render scene.txt -o {pictures}/ball.png --size 40x30 --samples 1");
                assert!(durer(folder.path(), &line).status.success());
            }
            let table = "picture,scene,options\nball.png,scene.txt,--samples 1\n";
            std::fs::write(folder.path().join("class.csv"), table).unwrap();
        }
        for command in commands {
            count += 1;
            let output = durer(folder.path(), &smaller(&command));
            let errors = String::from_utf8_lossy(&output.stderr);
            // `compare` exits with 1 because the pictures on these pages differ.
            let fine = output.status.success() || command.starts_with("compare") && output.status.code() == Some(1);
            assert!(fine, "{page}: {command}\n{errors}");
        }
    }
    println!("{count} commands");
    assert!(count > 50);
}

#[test]
fn links_of_the_pages_are_valid() {
    for page in pages().into_iter().chain(["docs/lecture.md".into()]).map(|page| root().join(page)) {
        let text = std::fs::read_to_string(&page).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = link.split('#').next().unwrap_or_default();
            if file.is_empty() || link.contains("://") || link.starts_with("figure:") || link.contains(' ') {
                continue;
            }
            assert!(page.parent().unwrap().join(file).exists(), "{} links to {link}", page.display());
        }
    }
}

#[test]
fn table_of_conventions_matches_the_code() {
    let text = std::fs::read_to_string(root().join("docs/photographs.md")).unwrap();
    for c in durer_photo::format::CONVENTIONS {
        let cells = [c.name, c.files, c.direction, c.frame, c.rotation, c.translation, c.pixels, c.lens];
        let row = format!("| {} |", cells.join(" | "));
        assert!(text.contains(&row), "docs/photographs.md lacks\n{row}");
    }
}
