//! `cargo xtask explain`: checks explanations of random pixels of all scenes against the rendered
//! pictures.

use anyhow::{Context, Result};
use durer::diag::{Diagnostics, Files};
use durer::integrator::RenderSettings;
use durer::render::explain::check::{SAMPLINGS, check};
use durer::render::explain::explain;
use durer::render::{Job, Sampling};
use durer::world::World;
use durer::{LoadOptions, LoadedScene, load};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Number of timed explanations per scene, and number of slowest scenes that are printed.
const RUNS: u32 = 5;
const MAX_SLOWEST: usize = 5;

/// A scene compiled in one dialect, whose explanations are checked.
struct DialectScene {
    name: String,
    world: World,
    settings: RenderSettings,
}

/// Result of checking the explanations of one scene.
struct SceneResult {
    name: String,
    differences: Vec<String>,
    pixels: u32,
    slowest: Duration,
}

/// Runs `cargo xtask explain`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let value = |name| crate::value(arguments, name);
    let pixels: usize = value("--pixels").map_or(Ok(100_000), |text| text.parse()).context("--pixels: a number")?;
    let only = value("--only");
    let mut scenes = Vec::new();
    collect(&crate::root()?.join("scenes"), &mut scenes)?;
    let corpus = crate::corpus();
    let course = corpus.join("course/scenes");
    match course.is_dir() {
        true => collect(&course, &mut scenes)?,
        false => println!("the course is missing: testing only our own scenes"),
    }
    scenes.retain(|path| only.is_none_or(|only| path.to_string_lossy().contains(only.as_str())));
    // Use each scene twice: without quirks, and with the quirks of its year's program.
    let ways: Vec<(&PathBuf, bool)> = scenes.iter().flat_map(|scene| [(scene, false), (scene, true)]).collect();
    let pool = rayon::ThreadPoolBuilder::new().stack_size(64 << 20).build()?;
    let read = || ways.par_iter().map(|(scene, official)| read(scene, *official, &course)).collect::<Result<Vec<_>>>();
    let opened: Vec<DialectScene> = pool.install(read)?.into_iter().flatten().collect();
    let each = pixels.div_ceil((opened.len() * SAMPLINGS.len()).max(1)) as u32;
    let one = |(i, opened): (usize, &DialectScene)| opened.explain(each, i as u64);
    let mut found: Vec<SceneResult> = pool.install(|| opened.par_iter().enumerate().map(one).collect::<Result<_>>())?;
    for SceneResult { name, differences, .. } in &found {
        differences.iter().for_each(|difference| println!("{name}: {difference}"));
    }
    let explained: u32 = found.iter().map(|found| found.pixels).sum();
    let differ: usize = found.iter().map(|found| found.differences.len()).sum();
    println!("{} readings of {} files (some are not scenes)", found.len(), scenes.len());
    println!("{explained} pixels explained with {} samplers: {differ} differ", SAMPLINGS.len());
    found.sort_by_key(|found| std::cmp::Reverse(found.slowest));
    println!("slowest explanations (16 samples per pixel, 512x512):");
    for SceneResult { name, slowest, .. } in found.iter().take(MAX_SLOWEST) {
        println!("{:>8.2} ms  {name}", slowest.as_secs_f64() * 1e3);
    }
    Ok(if differ == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Collects files that may be scenes, in a folder and below.
fn collect(folder: &Path, scenes: &mut Vec<PathBuf>) -> Result<()> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    paths.sort();
    for path in paths {
        if path.is_dir() {
            collect(&path, scenes)?;
        } else if path.extension().is_some_and(|extension| extension == "txt") {
            scenes.push(path);
        }
    }
    Ok(())
}

/// Reads a scene; `None` if the file is not a scene.
fn read(scene: &Path, official: bool, course: &Path) -> Result<Option<DialectScene>> {
    let assets = ["f16", "f04"].map(|year| course.join(year)).into_iter().filter(|folder| folder.is_dir()).collect();
    let options = LoadOptions { course: official, assets, ..LoadOptions::default() };
    let (mut files, mut findings) = (Files::default(), Diagnostics::default());
    let Some(loaded) = load(scene, &options, &mut files, &mut findings)? else { return Ok(None) };
    let world = loaded.compile(&options, &mut files, &mut findings);
    let name = format!("{}{}", scene.display(), if official { ", as its year's program" } else { "" });
    Ok(world.map(|world| DialectScene { name, world, settings: settings(&loaded) }))
}

impl DialectScene {
    fn explain(&self, pixels: u32, seed: u64) -> Result<SceneResult> {
        let job = Job { width: 24, height: 20, seed, settings: self.settings, ..Job::default() };
        let differences = check(&self.world, &job, pixels, seed)?;
        let sampling = Sampling::Filtered { samples: 16, filter: Default::default() };
        let job = Job { width: 512, height: 512, sampling, ..job };
        let timed = (0..RUNS).map(|i| {
            let start = Instant::now();
            explain(&self.world, &job, 60 + 97 * i, 80 + 83 * i).map(|_| start.elapsed())
        });
        let slowest = timed.collect::<Result<Vec<_>, _>>()?.into_iter().max().unwrap_or_default();
        Ok(SceneResult { name: self.name.clone(), differences, pixels: pixels * SAMPLINGS.len() as u32, slowest })
    }
}

/// Returns the options of a scene, with shadows and at least some levels of secondary rays.
fn settings(loaded: &LoadedScene) -> RenderSettings {
    RenderSettings {
        bounces: loaded.rules.bounces.max(4),
        shade_back: loaded.rules.shade_back,
        transparent_shadows: loaded.rules.transparent_shadows,
        ..Job::default().settings
    }
}
