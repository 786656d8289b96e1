//! The house keeps its shape: a room names only rooms on lower floors, and files stay small.

use std::fs;
use std::path::{Path, PathBuf};

/// The rooms by floor, as ARCHITECTURE.md draws them.
const FLOORS: [&[&str]; 10] = [
    &["math", "diag", "dialect", "panics", "threads"],
    &["sampler", "source", "describe", "spectrum"],
    &["image"],
    &["shape", "camera", "light", "material", "texture", "medium"],
    &["scene", "bvh", "bsdf"],
    &["format", "world"],
    &["compile", "film", "integrator"],
    &["render"],
    &["mistakes"],
    &["check", "load", "lesson"],
];

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

fn is_test(path: &Path) -> bool {
    let text = path.to_string_lossy();
    ["test", "conformance", "corpus", "random.rs", "fuzz.rs", "generate"].iter().any(|word| text.contains(word))
}

fn floor(room: &str) -> Option<usize> {
    FLOORS.iter().position(|rooms| rooms.contains(&room))
}

/// Rooms that a line names, as `crate::room`.
fn named(line: &str) -> impl Iterator<Item = &str> {
    line.split("crate::")
        .skip(1)
        .map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or(""))
}

#[test]
fn arrows_point_down() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all = Vec::new();
    files(&root, &mut all);
    assert!(all.len() > 50);
    for path in all.iter().filter(|path| !is_test(path)) {
        let relative = path.strip_prefix(&root).unwrap();
        let first = relative.components().next().unwrap().as_os_str().to_string_lossy().into_owned();
        let room = first.trim_end_matches(".rs");
        if room == "lib" {
            continue;
        }
        let own = floor(room).unwrap_or_else(|| panic!("{room} is on no floor"));
        let text = fs::read_to_string(path).unwrap();
        // Tests at a file's end may look anywhere; documentation may link upwards.
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        for line in code.lines().filter(|line| !line.trim_start().starts_with("//")) {
            for other in named(line).filter(|other| *other != room) {
                if let Some(other_floor) = floor(other) {
                    assert!(other_floor < own, "{}: {room} may not name {other}", relative.display());
                }
            }
        }
    }
}

#[test]
fn files_stay_small() {
    let mut sizes = Vec::new();
    for package in ["durer", "durer-bvh", "durer-cli"] {
        let mut all = Vec::new();
        files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(package).join("src"), &mut all);
        sizes.extend(all.into_iter().map(|path| (fs::read_to_string(&path).unwrap().lines().count(), path)));
    }
    sizes.sort();
    let (median, ninth, largest) = (sizes.len() / 2, sizes.len() * 9 / 10, sizes.len() - 1);
    assert!(sizes[median].0 <= 150, "median {:?}", sizes[median]);
    assert!(sizes[ninth].0 <= 400, "nine in ten {:?}", sizes[ninth]);
    assert!(sizes[largest].0 <= 600, "largest {:?}", sizes[largest]);
}
