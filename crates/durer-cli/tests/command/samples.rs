//! Tests that converted scenes produce the same picture, and that the Khronos sample models look as
//! specified on their test cards.

use crate::common::{TestFolder, corpus};
use durer::diag::{Diagnostics, Files};
use durer::image::Image8;
use durer::{LoadOptions, load};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const SMALL: &str = "--size 16x16 --samples 2 --quiet --hash";

/// Returns the hash of a small picture.
#[track_caller]
fn hash(folder: &TestFolder, scene: impl AsRef<Path>, more: &str) -> String {
    folder.expect_exit(0, &format!("render {} -o x.png {SMALL} {more}", scene.as_ref().display())).out
}

/// Returns a sorted list of the files with these extensions in a folder and its subfolders. Paths
/// that contain spaces are skipped because spaces separate arguments here.
fn below(folder: &Path, endings: &[&str], found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            below(&path, endings, found);
        } else if !path.to_string_lossy().contains(' ')
            && path.extension().is_some_and(|ending| endings.iter().any(|wanted| ending == *wanted))
        {
            found.push(path);
        }
    }
}

/// Returns the first file of a Khronos sample model if the samples are available.
fn khronos(name: &str) -> Option<PathBuf> {
    let folder = corpus()?.parent()?.join("samples/gltf/khronos").join(name);
    let mut found = Vec::new();
    below(&folder, &["glb", "gltf"], &mut found);
    if found.is_empty() {
        println!("skipped: {} not found", folder.display());
    }
    found.into_iter().next()
}

/// Number of scenes per dialect that are tested.
const SCENES: usize = 3;

#[test]
fn course_scenes_survive_conversion_to_durer_and_json() {
    let Some(folder) = corpus() else { return };
    let mut all = Vec::new();
    below(&folder, &["txt"], &mut all);
    let mut tried = BTreeMap::new();
    let place = TestFolder::new();
    for path in all {
        // Skip files that are not scenes, and determine the dialect.
        let options = LoadOptions::default();
        let read = load(&path, &options, &mut Files::default(), &mut Diagnostics::default()).unwrap();
        let Some(dialect) = read.and_then(|loaded| Some(loaded.guess.as_ref()?.dialect.name())) else { continue };
        let count = tried.entry(dialect).or_insert(0);
        *count += 1;
        if *count > SCENES {
            continue;
        }
        let files = format!("--assets {}", path.parent().unwrap().display());
        let shown = path.display().to_string();
        place.expect_exit(0, &format!("convert {shown} -o ours.txt --to durer {files}"));
        place.expect_exit(0, &format!("convert ours.txt -o back.txt --dialect durer --to {dialect} {files}"));
        // Use every quirk of the year's program.
        let requested = format!("{files} --dialect {dialect}");
        assert_eq!(hash(&place, "back.txt", &requested), hash(&place, &path, &requested), "{shown}");
        // JSON files store the dialect because a keyword can have a different meaning in another
        // year.
        place.expect_exit(0, &format!("convert {shown} -o scene.json {files}"));
        place.expect_exit(0, &format!("convert scene.json -o back.txt --to {dialect} {files}"));
        let usual = hash(&place, &path, &files);
        assert_eq!(hash(&place, "scene.json", &files), usual, "{shown}");
        assert_eq!(hash(&place, "back.txt", &requested), hash(&place, &path, &requested), "{shown}");
    }
    assert!(tried.len() >= 5, "{tried:?}");
}

/// Sample models that produce the same picture after conversion to glTF.
const WRITTEN: [&str; 12] = [
    "AlphaBlendModeTest",
    "BoxTextured",
    "BoxVertexColors",
    "Cameras",
    "NegativeScaleTest",
    "SimpleInstancing",
    "SimpleSkin",
    "TextureSettingsTest",
    "TextureTransformTest",
    "UnlitTest",
    "SpecularTest",
    "TransmissionTest",
];

#[test]
fn converted_gltf_renders_the_same_picture() {
    let folder = TestFolder::new();
    for name in WRITTEN {
        let Some(path) = khronos(name) else { continue };
        let output = folder.expect_exit(0, &format!("convert {} -o a.glb", path.display())).err;
        folder.expect_exit(0, "convert a.glb -o b.gltf");
        let (first, again) = (hash(&folder, "a.glb", ""), hash(&folder, "b.gltf", ""));
        assert_eq!(first, again, "{name}");
        let usual = hash(&folder, &path, "");
        assert_eq!(first, usual, "{name}");
        // The conversion loses nothing, so it reports no loss.
        assert!(!output.contains("no-counterpart"), "{name}: {output}");
    }
}

#[test]
fn mesh_is_equal_in_all_formats_with_the_same_attributes() {
    let place = TestFolder::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/meshes");
    // PLY and STL files are written without normals, which changes meshes that have normals.
    for (mesh, its_own) in [("durer-solid.obj", false), ("knot.ply", true)] {
        let path = folder.join(mesh);
        let usual = hash(&place, &path, "--up y");
        for (name, has_normals) in
            [("a.obj", true), ("a.glb", true), ("a.gltf", true), ("a.ply", false), ("a.stl", false)]
        {
            place.expect_exit(0, &format!("convert {} -o {name}", path.display()));
            let same = hash(&place, name, "--up y") == usual;
            assert_eq!(same, has_normals || !its_own, "{mesh} as {name}");
        }
        // Without normals, the pictures are equal again.
        assert_eq!(hash(&place, "a.ply", "--up y"), hash(&place, "a.stl", "--up y"), "{mesh}");
    }
}

/// Width and height of the pictures of the cards, in pixels.
const SIDE: usize = 200;

/// Expected content of a test card around a pixel.
#[derive(Clone, Copy, Debug)]
enum Mark {
    /// There is a green tick and no red cross.
    Tick,
    /// The colour is uniform except for noise.
    Color([u8; 3]),
    /// The content is equal to the content around another pixel.
    As(usize, usize),
}

/// A test card, and the content that must be visible at some of its pixels.
type Card = (&'static str, &'static [(usize, usize, Mark)]);

/// The test cards, with the content that must be visible at pixels of the front view.
const CARDS: &[Card] = &[
    (
        "TextureSettingsTest",
        &[
            (107, 65, Mark::Tick),
            (107, 83, Mark::Tick),
            (107, 100, Mark::Tick),
            (107, 117, Mark::Tick),
            (107, 134, Mark::Tick),
            (107, 152, Mark::Tick),
            (107, 169, Mark::Tick),
        ],
    ),
    ("NegativeScaleTest", &[(100, 55, Mark::Tick), (100, 73, Mark::Tick)]),
    // The arrows of transformed texture coordinates point to the ticks.
    ("TextureTransformTest", &[(36, 153, Mark::Tick), (101, 128, Mark::Tick), (154, 141, Mark::Tick)]),
    ("TextureLinearInterpolationTest", &[(57, 143, Mark::Tick), (143, 143, Mark::Tick), (143, 143, Mark::As(57, 143))]),
    ("UnlitTest", &[(53, 100, Mark::Color([255, 127, 0])), (147, 100, Mark::Color([0, 127, 255]))]),
    (
        "VertexColorTest",
        &[
            (53, 71, Mark::As(53, 147)),
            (100, 71, Mark::As(100, 147)),
            (147, 71, Mark::As(147, 147)),
            (100, 71, Mark::Tick),
        ],
    ),
];

/// These cells are behind a hidden back face, and only light from the studio lights reaches them.
const BEHIND: &[Card] = &[
    ("TextureSettingsTest", &[(107, 47, Mark::Tick)]),
    ("NegativeScaleTest", &[(131, 54, Mark::Tick), (131, 73, Mark::Tick)]),
];

/// Returns the pixels around a given position.
fn around(picture: &Image8, (x, y): (usize, usize)) -> impl Iterator<Item = [f64; 3]> {
    const REACH: usize = 7;
    let rows = y - REACH..=y + REACH;
    rows.flat_map(move |y| (x - REACH..=x + REACH).map(move |x| picture.pixels[y * SIDE + x].map(f64::from)))
}

fn mean(picture: &Image8, folder: (usize, usize)) -> [f64; 3] {
    let (sum, count) = around(picture, folder)
        .fold(([0.0; 3], 0.0), |(sum, count), pixel| (std::array::from_fn(|i| sum[i] + pixel[i]), count + 1.0));
    sum.map(|sum| sum / count)
}

#[test]
fn test_cards_show_ticks_and_no_crosses() {
    let folder = TestFolder::new();
    let all = CARDS.iter().map(|card| (card, "--studio none --samples 4"));
    for ((name, marks), options) in all.chain(BEHIND.iter().map(|card| (card, "--samples 16"))) {
        let Some(path) = khronos(name) else { continue };
        let options = format!("--view front {options} --size {SIDE}x{SIDE} -q");
        folder.expect_exit(0, &format!("render {} -o card.png {options}", path.display()));
        let picture = folder.image8("card.png");
        for &(x, y, mark) in *marks {
            let here = mean(&picture, (x, y));
            let near = |other: [f64; 3]| here.iter().zip(other).all(|(a, b)| (a - b).abs() < 16.0);
            let share = |is: fn([f64; 3]) -> bool| {
                let all = around(&picture, (x, y)).count() as f64;
                around(&picture, (x, y)).filter(|pixel| is(*pixel)).count() as f64 / all
            };
            let green = share(|[r, g, b]| g > 1.4 * r && g > 1.4 * b);
            let red = share(|[r, g, b]| r > 1.6 * g && r > 1.6 * b);
            let holds = match mark {
                Mark::Tick => green > 0.05 && red < 0.01,
                Mark::Color(color) => near(color.map(f64::from)),
                Mark::As(x, y) => near(mean(&picture, (x, y))),
            };
            assert!(holds, "{name} at {x} {y}: {mark:?}, but {here:?} on average, {green} green, {red} red");
        }
    }
}
