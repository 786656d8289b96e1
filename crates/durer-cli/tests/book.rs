//! Every command of the README and of the book's chapters for readers is run, at a small size.
//!
//! docs/lecture.md, whose commands made its pictures, has a test of its own.

mod common;

use std::path::{Path, PathBuf};
use std::process::Command;

/// The pages, each with commands that go on from one to the next.
const PAGES: [&str; 8] = [
    "README.md",
    "docs/student.md",
    "docs/teacher.md",
    "docs/engineer.md",
    "docs/scenes.md",
    "docs/models.md",
    "docs/explain.md",
    "docs/photographs.md",
];

/// What follows an option in a command, changed so that the test is short.
const SMALLER: [(&str, &str); 3] = [("--size", "40x30"), ("--samples", "4"), ("--pixel", "20,15")];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The commands of a page: lines of code that begin with `cargo durer`.
fn commands(page: &str) -> Vec<String> {
    let text = std::fs::read_to_string(root().join(page)).unwrap();
    text.lines().filter_map(|line| line.strip_prefix("    cargo durer ")).map(str::to_string).collect()
}

/// The same command for a picture of few pixels.
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
    for page in PAGES {
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(root().join("scenes").canonicalize().unwrap(), folder.path().join("scenes"))
            .unwrap();
        for command in commands(page) {
            // A shell, for the pages' patterns of file names.
            let line = format!("{} {}", env!("CARGO_BIN_EXE_durer"), smaller(&command));
            let ran = Command::new("sh").args(["-c", &line]).current_dir(folder.path()).output().unwrap();
            let said = String::from_utf8_lossy(&ran.stderr);
            // `compare` says by 1 that pictures differ, as they do on these pages.
            let fine = ran.status.success() || command.starts_with("compare") && ran.status.code() == Some(1);
            assert!(fine, "{page}: {command}\n{said}");
        }
    }
}

#[test]
fn links_of_the_pages_lead_somewhere() {
    let docs = std::fs::read_dir(root().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let language = std::fs::read_dir(root().join("docs/language")).unwrap().map(|entry| entry.unwrap().path());
    let pages = docs.chain(language).chain([root().join("README.md")]);
    for page in pages.filter(|path| path.extension().is_some_and(|e| e == "md")) {
        let text = std::fs::read_to_string(&page).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = link.split('#').next().unwrap_or_default();
            if file.is_empty() || link.contains("://") || link.contains(' ') {
                continue;
            }
            assert!(page.parent().unwrap().join(file).exists(), "{} links to {link}", page.display());
        }
    }
}

#[test]
fn the_table_of_conventions_is_that_of_the_code() {
    let text = std::fs::read_to_string(root().join("docs/photographs.md")).unwrap();
    for c in durer_photo::format::CONVENTIONS {
        let cells = [c.name, c.files, c.way, c.frame, c.rotation, c.translation, c.pixels, c.lens];
        let row = format!("| {} |", cells.join(" | "));
        assert!(text.contains(&row), "docs/photographs.md lacks\n{row}");
    }
}
