//! Tests that every scene in the repository is read without diagnostics, gives the same picture
//! with every acceleration structure, and is listed in the README and the gallery.

use durer::compile::AccelKind;
use durer::diag::{Diagnostics, Files};
use durer::dialect::Dialect;
use durer::format::{course, json};
use durer::integrator::{IntegratorKind, RenderSettings};
use durer::math::Vec3;
use durer::render::{Control, Job, PartialRender, Shard, render};
use durer::world::World;
use durer::{LoadOptions, LoadedScene, load, load_text};
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the root folder of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns the sorted names of the files in a folder that have this ending. The ending is removed
/// from the names.
fn names(folder: &str, ending: &str) -> Vec<String> {
    let files = fs::read_dir(root().join(folder)).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = files.filter_map(|name| Some(name.strip_suffix(ending)?.to_string())).collect();
    names.sort();
    names
}

fn scenes() -> Vec<String> {
    let scenes = names("scenes", ".txt");
    assert!(scenes.len() >= 14, "{scenes:?}");
    scenes
}

/// Reads and compiles a scene. Panics if there are any diagnostics.
fn opened(name: &str, accel: AccelKind) -> (LoadedScene, World) {
    let options = LoadOptions { accel, ..LoadOptions::default() };
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let path = root().join(format!("scenes/{name}.txt"));
    let loaded = load(&path, &options, &mut files, &mut diagnostics).unwrap();
    let world = loaded.as_ref().and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics));
    let findings: Vec<&str> = diagnostics.iter().map(|finding| finding.message.as_str()).collect();
    assert!(findings.is_empty(), "{name}: {findings:?}");
    (loaded.unwrap(), world.unwrap())
}

/// Returns the integrator of a scene.
fn method(loaded: &LoadedScene) -> IntegratorKind {
    if loaded.scene.is_physical() { IntegratorKind::PATH } else { IntegratorKind::WHITTED }
}

/// Renders a small picture with one ray through the centre of each pixel.
fn pixels(name: &str, accel: AccelKind, threads: usize) -> Vec<Vec3> {
    let (loaded, world) = opened(name, accel);
    let job = Job {
        width: 64,
        height: 64,
        settings: RenderSettings {
            bounces: loaded.rules.bounces,
            shadows: loaded.rules.shadows,
            shade_back: loaded.rules.shade_back,
            transparent_shadows: loaded.rules.transparent_shadows,
            reflection: true,
            refraction: true,
            min_weight: 0.001,
        },
        method: method(&loaded),
        ..Job::default()
    };
    let control = Control { threads: Some(threads), ..Control::default() };
    let rendered = render(&world, &job, &control).unwrap();
    assert_eq!(rendered.statistics.rejected, 0, "{name}");
    let image = &rendered.layers[0].image;
    (0..64).flat_map(|y| (0..64).map(move |x| image.get(x, y).unwrap())).collect()
}

#[test]
fn scenes_are_read_in_our_dialect_without_diagnostics() {
    for name in scenes() {
        let (loaded, _) = opened(&name, AccelKind::Bvh);
        let guess = loaded.guess.unwrap();
        assert_eq!((guess.dialect, loaded.dialect), (Dialect::Durer, Dialect::Durer), "{name}");
        let text = fs::read_to_string(root().join(format!("scenes/{name}.txt"))).unwrap();
        assert!(text.starts_with("# "), "{name} does not begin with a description");
    }
}

#[test]
fn scenes_are_identical_for_all_thread_counts_and_accelerators() {
    let bits = |pixels: &[Vec3]| -> Vec<[u32; 3]> { pixels.iter().map(|p| p.to_array().map(f32::to_bits)).collect() };
    for name in scenes() {
        let picture = pixels(&name, AccelKind::Bvh, 1);
        assert!(picture.iter().all(|p| p.is_finite()), "{name}");
        assert!(picture.iter().any(|p| *p != picture[0]), "{name} has only one colour");
        for (accel, threads) in [(AccelKind::Bvh, 2), (AccelKind::Grid(None), 1), (AccelKind::Grid(None), 2)] {
            let other = pixels(&name, accel, threads);
            // Avoid printing the pictures in the message.
            assert!(bits(&other) == bits(&picture), "{name}: {accel:?} on {threads} threads differs");
        }
    }
}

#[test]
fn scenes_are_listed_and_shown() {
    let table = fs::read_to_string(root().join("scenes/README.md")).unwrap();
    let gallery = fs::read_to_string(root().join("docs/gallery.md")).unwrap();
    let pictures = names("docs/gallery", ".png");
    for name in scenes() {
        let row = format!("| [{name}]({name}.txt) | ");
        assert_eq!(table.lines().filter(|line| line.starts_with(&row)).count(), 1, "{name} in scenes/README.md");
        assert!(gallery.contains(&format!("](../scenes/{name}.txt)")), "{name} is not linked in docs/gallery.md");
        assert!(pictures.contains(&name), "{name} has no picture in docs/gallery");
    }
    for picture in pictures {
        let shown = gallery.contains(&format!("(gallery/{picture}.png"));
        assert!(shown, "{picture}.png is not shown in docs/gallery.md");
    }
}

#[test]
fn scenes_are_equal_after_conversion_to_json_and_back() {
    for name in scenes() {
        let (loaded, world) = opened(&name, AccelKind::Bvh);
        let text = json::write(&loaded.scene, loaded.dialect);
        let (mut files, mut found) = (Files::default(), Diagnostics::default());
        let (path, bytes) = (root().join("scenes/scene.json"), text.as_bytes().into());
        let again = load_text(&path, bytes, &LoadOptions::default(), &mut files, &mut found).unwrap();
        // Compare the bits, because `==` treats 0 and -0 as equal.
        let bits = |loaded: &LoadedScene| serde_json::to_string(&loaded.scene).unwrap();
        assert!(again.scene == loaded.scene && bits(&again) == bits(&loaded), "{name}");
        assert!(again.rules == loaded.rules && found.iter().count() == 0, "{name}");
        let words = |loaded: &LoadedScene| course::write(&loaded.scene, loaded.dialect);
        assert_eq!(words(&again), words(&loaded), "{name}");
        let again = again.compile(&LoadOptions::default(), &mut files, &mut found).unwrap();
        let job = Job { width: 8, height: 6, method: method(&loaded), ..Job::default() };
        let hash = |world: &World| {
            let part = PartialRender::new(world, &job, Shard::WHOLE).unwrap();
            part.render(world, &Control::default(), &mut |_, _| {}).unwrap();
            part.hash()
        };
        assert_eq!(hash(&again), hash(&world), "{name}");
    }
}
