//! Tests that scenes written for pbrt, Mitsuba and USD are read again without warnings, and give
//! the same picture.

use durer::diag::{Diagnostics, Files, Severity};
use durer::film::Filter;
use durer::integrator::{IntegratorKind, RenderSettings};
use durer::math::Vec3;
use durer::render::{Control, Job, Sampling, render};
use durer::world::World;
use durer::{LoadOptions, LoadedScene, load};
use std::fs;
use std::path::{Path, PathBuf};

/// Number of pictures with different seeds, from which the standard error follows.
const SEEDS: u64 = 6;
/// Student's t for 2 · `SEEDS` - 2 = 10 degrees of freedom and a confidence of 99.9 %.
const STUDENT: f64 = 4.6;
/// Relative difference of the means that is allowed beside the noise.
const TOLERANCE: f64 = 0.005;

/// Losses that do not change what these small pictures show.
const HARMLESS: [&str; 3] = ["infinite planes", "behind their centre", "sharp"];

/// Returns the paths of all scenes in the repository.
fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
    let is_scene = |path: &PathBuf| {
        path.extension().is_some_and(|own| ["txt", "pbrt", "xml", "usda"].iter().any(|known| own == *known))
    };
    let mut scenes: Vec<PathBuf> = files.filter(is_scene).collect();
    scenes.sort();
    assert!(scenes.len() > 50, "{scenes:?}");
    scenes
}

fn open(path: &Path) -> (LoadedScene, World) {
    let options = LoadOptions::default();
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let loaded = load(path, &options, &mut files, &mut diagnostics).unwrap();
    let world = loaded.as_ref().and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics));
    let findings: Vec<_> = diagnostics.iter().filter(|found| found.severity != Severity::Note).collect();
    assert!(findings.is_empty(), "{}: {findings:?}", path.display());
    (loaded.unwrap(), world.unwrap())
}

/// Writes a scene in a folder. Returns the messages of the writer.
fn write(loaded: &LoadedScene, path: &Path) -> Vec<String> {
    let mut diagnostics = Diagnostics::default();
    let written = loaded.write(&path.to_string_lossy(), &mut diagnostics).unwrap();
    let folder = path.parent().unwrap();
    for (name, bytes) in written.files {
        fs::create_dir_all(folder.join(&name).parent().unwrap()).unwrap();
        fs::write(folder.join(name), bytes).unwrap();
    }
    fs::write(path, written.bytes).unwrap();
    diagnostics.iter().map(|found| found.message.clone()).collect()
}

/// Returns the mean pixel values of pictures with different seeds.
fn means(world: &World) -> Vec<f64> {
    let mean = |seed: u64| {
        let job = Job {
            width: 32,
            height: 24,
            seed,
            sampling: Sampling::Filtered { samples: 16, filter: Filter::default() },
            method: IntegratorKind::PATH,
            settings: RenderSettings { bounces: 16, ..Job::default().settings },
            ..Job::default()
        };
        let rendered = render(world, &job, &Control::default()).unwrap();
        let pixels = &rendered.layers[0].image.pixels;
        f64::from(pixels.iter().sum::<Vec3>().element_sum()) / (3 * pixels.len()) as f64
    };
    (0..SEEDS).map(mean).collect()
}

/// Returns the mean and the variance of the mean.
fn statistics(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (mean, values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count * (count - 1.0)))
}

/// Writes all scenes, reads them again, and compares pictures if nothing visible was lost. Returns
/// how many pictures were compared.
fn compare_all(extension: &str) -> usize {
    let folder = tempfile::tempdir().unwrap();
    let mut compared = 0;
    let mut wrong = Vec::new();
    for path in scenes() {
        let (loaded, before) = open(&path);
        let name = format!("{}.{extension}", path.file_stem().unwrap().to_string_lossy());
        let lost = write(&loaded, &folder.path().join(&name));
        let (_, after) = open(&folder.path().join(&name));
        if !lost.iter().all(|message| HARMLESS.iter().any(|part| message.contains(part))) {
            continue;
        }
        compared += 1;
        let ((a, va), (b, vb)) = (statistics(&means(&before)), statistics(&means(&after)));
        let allowed = TOLERANCE * a + STUDENT * (va + vb).sqrt();
        let line = format!("{name}: {a:.5} and {b:.5}, a ratio of {:.4}, allowed {allowed:.5}", b / a);
        println!("{line}");
        if (a - b).abs() > allowed {
            wrong.push(line);
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    compared
}

#[test]
fn scenes_written_for_mitsuba_give_the_same_picture() {
    let compared = compare_all("xml");
    assert!(compared >= 8, "{compared}");
}

#[test]
fn scenes_written_for_pbrt_give_the_same_picture() {
    let compared = compare_all("pbrt");
    assert!(compared >= 8, "{compared}");
}

#[test]
fn scenes_written_for_usd_give_the_same_picture() {
    let compared = compare_all("usda");
    assert!(compared >= 5, "{compared}");
}
