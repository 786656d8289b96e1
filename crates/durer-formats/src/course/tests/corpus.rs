//! Tests with the scenes of the course in the folder `DURER_CORPUS`, if this folder exists.

use super::*;
use durer_scene::dialect::set;
use std::path::{Path, PathBuf};

/// Returns all scenes of the course with their dialects. The list is empty if the folder does not
/// exist.
pub(super) fn scenes() -> Vec<(PathBuf, Dialect)> {
    let default = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared"));
    let root = std::env::var_os("DURER_CORPUS").map_or_else(default, PathBuf::from).join("course/scenes");
    let mut found = Vec::new();
    for dialect in Dialect::ALL {
        collect(&root.join(dialect.name()), dialect, &mut found);
    }
    if found.is_empty() {
        println!("skipped: no scenes in {}", root.display());
    }
    found.sort();
    found.into_iter().map(|(path, bit)| (path, Dialect::ALL.into_iter().find(|d| *d as u8 == bit).unwrap())).collect()
}

fn collect(folder: &Path, dialect: Dialect, found: &mut Vec<(PathBuf, u8)>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let (path, name) = (entry.path(), entry.file_name().into_string().unwrap());
        // Splines are curves for another program.
        let other = name.starts_with("spline8_") || name == "readme.txt";
        if path.is_dir() {
            collect(&path, dialect, found);
        } else if name.ends_with(".txt") && !other {
            found.push((path, dialect as u8));
        }
    }
}

#[test]
fn course_scenes_have_no_findings() {
    let mut wrong = Vec::new();
    for (path, dialect) in scenes() {
        let text = std::fs::read(&path).unwrap();
        for strict in [false, true] {
            let (_, findings) = read_as(&text, dialect, strict);
            wrong.extend(findings.iter().map(|finding| format!("{} (strict: {strict}): {finding}", path.display())));
        }
    }
    assert_eq!(wrong, [""; 0]);
}

#[test]
fn grid_of_2003_reports_mistakes() {
    let found = |inside: &str| {
        let text = format!("Group {{\n numObjects 1\n Grid {{ {inside} }}\n}}\n");
        read_as(text.as_bytes(), Dialect::F03, false).1
    };
    assert_eq!(found("min -1 -1 -1 max 1 1 1 numCells 3 3 3"), [""; 0]);
    let wrong = "3:41 error: `numCells` must be whole numbers from 1 to 256 [3 0 3]";
    assert_eq!(found("min -1 -1 -1 max 1 1 1 numCells 3 0 3"), [wrong]);
    assert_eq!(found("min -1 -1 -1 max 1 1 1 numCells 3 1.5 3"), [wrong.replace("3 0 3", "3 1.5 3")]);
    let ball = "min -1 -1 -1 max 1 1 1 numCells 3 3 3 rasterizeSphere { radius 1 }";
    assert_eq!(
        found(ball),
        [
            "3:47 error: `rasterizeSphere` has no `center` [rasterizeSphere] (add it to the block, for example `center 0 0 5`)"
        ]
    );
}

#[test]
fn guess_of_every_scene_includes_its_year() {
    for (path, dialect) in scenes() {
        let text = std::fs::read(&path).unwrap();
        let folder = path.parent().unwrap();
        let guess = guess(&text, 0, &[], &|name| folder.join(name).exists());
        println!("{} {}", path.display(), guess.note().message);
        // The files of the two years with `falloff` are identical, so one of the years is guessed
        // and the other one remains possible.
        assert!(guess.dialect == dialect || guess.others.contains(&dialect), "{}: {guess:?}", path.display());
        // The file can be read without diagnostics in the dialect that was guessed.
        let (_, findings) = read_as(&text, guess.dialect, false);
        assert_eq!(findings, [""; 0], "{}", path.display());
    }
}

#[test]
fn distinctive_words_decide_the_guess() {
    let of = |text: &str| guess(text.as_bytes(), 0, &[], &|name| name == "sky/left.png").dialect;
    for (text, dialect) in [
        ("PerspectiveCamera { }", Dialect::F12a4),
        ("OrthographicCamera { }", Dialect::F04),
        ("Materials { Material { exponent 3 } }", Dialect::F04),
        ("Group { Material { } }", Dialect::F03),
        ("Transform { Translate { 1 2 3 } }", Dialect::F03),
        ("PointLight { falloff 1 }", Dialect::F12a5),
        ("Background { cubeMap sky }", Dialect::F16),
        ("Background { cubeMap other }", Dialect::F12a5),
        ("Scene { Node { } }", Dialect::F23),
        ("Scene { Node { } } # by me", Dialect::F23),
        ("Group { } # by me", Dialect::Durer),
        ("OrthographicCamera { } Material { shininess 3 }", Dialect::Durer),
        ("", Dialect::F12a4),
    ] {
        assert_eq!(of(text), dialect, "{text}");
    }
    // The note lists only the reasons that are needed for the guess.
    let note = guess(
        b"PerspectiveCamera { } PointLight { falloff 1 } Materials { Material { refractionIndex 2 } }",
        0,
        &[],
        &|_| false,
    )
    .note();
    assert_eq!(note.message, "the scene is read as f12a5: `refractionIndex` is a word of f12a5");
    let hint = Hint { set: Dialect::F16 as u8, reason: "the output is a PNG file".into(), weak: false };
    let guess = guess(b"PerspectiveCamera { }", 0, &[hint], &|_| false);
    assert_eq!((guess.dialect, guess.others.len()), (Dialect::F16, 0));
    assert_eq!((guess.by_keywords, guess.changed_by_hints()), (Dialect::F12a4, true));
    assert!(guess.note().message.ends_with("the output is a PNG file"));
}

#[test]
fn weak_hints_choose_among_the_years_that_fit_and_rule_none_out() {
    let hint = |set, weak| Hint { set, reason: "of a reason".into(), weak };
    let (shadows, png) = (hint(set::ALL & !set::F12A4, false), hint(set::F16 | set::F23, true));
    let scene = b"PerspectiveCamera { } Materials { Material { shininess 3 } }";
    let found = guess(scene, 0, std::slice::from_ref(&png), &|_| false);
    assert_eq!((found.dialect, found.by_keywords), (Dialect::F16, Dialect::F12a4));
    assert_eq!(found.fitting, [Dialect::F12a4, Dialect::F12a5, Dialect::F16]);
    // The order of the hints has no effect on the result.
    for hints in [[png.clone(), shadows.clone()], [shadows, png.clone()]] {
        let found = guess(scene, 0, &hints, &|_| false);
        assert_eq!(found.dialect, Dialect::F16);
        assert_eq!(found.fitting, [Dialect::F12a5, Dialect::F16]);
    }
    // If no word distinguishes the years, a weak hint has no effect.
    let found = guess(b"", 0, &[png], &|_| false);
    assert_eq!(found.dialect, Dialect::F12a4);
}
