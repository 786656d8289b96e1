//! Tests docs/lecture.md and the topics of the lesson. Their references to the source code must
//! exist, and their commands must reproduce the pictures.

use crate::common::{self, TestFolder};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn guide() -> String {
    std::fs::read_to_string(root().join("docs/lecture.md")).unwrap()
}

/// Returns the pieces of text between two markers.
fn between<'t>(text: &'t str, from: &'t str, to: &'t str) -> impl Iterator<Item = &'t str> {
    text.split(from).skip(1).filter_map(move |rest| rest.split_once(to)).map(|parts| parts.0)
}

/// Checks that a file of the repository defines exactly this name.
#[track_caller]
fn defined(file: &str, symbol: &str) {
    let text = std::fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
    let mut nexts = text.match_indices(symbol).map(|(at, _)| text[at + symbol.len()..].chars().next());
    let whole = nexts.any(|next| next.is_none_or(|c| !c.is_alphanumeric() && c != '_'));
    assert!(whole, "`{symbol}` is not in {file}");
}

#[test]
fn places_in_the_source_exist() {
    for folder in durer::lesson::TOPICS.iter().flat_map(|topic| topic.places) {
        defined(folder.file, folder.symbol);
    }
    let guide = guide();
    let rows: Vec<&str> = guide.lines().filter(|line| line.starts_with("- [")).collect();
    assert!(rows.len() > 40);
    for row in rows {
        let file = between(row, "](../", ")").next().unwrap();
        assert!(file.ends_with(between(row, "[", "]").next().unwrap()), "{row}");
        let symbols: Vec<&str> = row.split('`').skip(1).step_by(2).collect();
        assert!(!symbols.is_empty(), "{row}");
        symbols.iter().for_each(|symbol| defined(file, symbol));
    }
}

#[test]
fn links_are_valid_and_every_picture_is_shown() {
    let guide = guide();
    let links: BTreeSet<&str> = between(&guide, "](", ")").collect();
    for link in &links {
        assert!(root().join("docs").join(link).is_file(), "{link}");
    }
    for entry in std::fs::read_dir(root().join("docs/lecture")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(links.contains(format!("lecture/{name}").as_str()), "{name} is not shown");
    }
}

#[test]
fn commands_reproduce_the_pictures() {
    let (guide, folder) = (guide(), TestFolder::new());
    let commands: Vec<&str> = guide.lines().filter_map(|line| line.strip_prefix("    cargo durer ")).collect();
    assert_eq!(commands.len(), between(&guide, "](lecture/", ")").count());
    let check = |(number, command): (usize, &&str)| {
        let picture = between(command, "-o ", " ").next().unwrap();
        let made = folder.path(&format!("{number}.png"));
        let arguments = command.split(' ').map(|word| if word == picture { made.as_os_str() } else { word.as_ref() });
        let run = Command::new(common::durer()).current_dir(root()).args(arguments).output().unwrap();
        assert!(run.status.success(), "{command}\n{}", String::from_utf8_lossy(&run.stderr));
        let (made, kept) = (std::fs::read(made).unwrap(), std::fs::read(root().join(picture)).unwrap());
        // The cost picture changes whenever the BVH is improved, so it may be out of date.
        let older = command.contains("--show cost");
        assert!(
            older || made == kept,
            "{picture} differs from the output of its command; the guide says how to render the pictures again"
        );
    };
    // Run two commands at a time because small renders leave threads idle.
    std::thread::scope(|scope| {
        for turn in 0..2 {
            let (commands, check) = (&commands, &check);
            scope.spawn(move || commands.iter().enumerate().filter(|row| row.0 % 2 == turn).for_each(check));
        }
    });
}
