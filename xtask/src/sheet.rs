//! `cargo xtask sheet`: renders models with default options and writes contact sheets with their
//! reference pictures.

use anyhow::{Context, Result, bail};
use durer::diag::{Diagnostics, Files};
use durer::film::Filter;
use durer::image::{Image, Layer, WriteOptions, format_for, read_srgb, save};
use durer::integrator::IntegratorKind;
use durer::math::Vec3;
use durer::render::{Control, Job, PartialRender, Sampling, Shard};
use durer::scene::{PresetView, SceneDefaults};
use durer::{LoadOptions, load};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Width and height of a picture in pixels, pictures per row, and rows per sheet.
const SIDE: u32 = 256;
const ACROSS: u32 = 6;
const DOWN: u32 = 5;

const EXTENSIONS: [&str; 10] = ["dae", "glb", "gltf", "obj", "ply", "stl", "3mf", "usda", "usdc", "usdz"];

/// Runs `cargo xtask sheet`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let samples = crate::value(arguments, "--samples").map_or(Ok(32), |number| number.parse())?;
    let only = crate::value(arguments, "--only");
    let keep = crate::value(arguments, "--keep").map_or_else(|| PathBuf::from("target/sheet"), PathBuf::from);
    let front = arguments.iter().any(|argument| argument == "--front");
    let mut paths = Vec::new();
    for folder in ["samples/gltf/khronos", "samples/gltf/bevy", "samples/gltf/transform", "samples/meshes", "meshes"] {
        files_below(&crate::corpus().join(folder), &mut paths);
    }
    paths.retain(|path| only.is_none_or(|only| path.to_string_lossy().contains(only.as_str())));
    if paths.is_empty() {
        bail!("no matching models in {}", crate::corpus().display());
    }
    std::fs::create_dir_all(&keep)?;
    let (mut cells, mut failed) = (Vec::new(), 0);
    for path in &paths {
        let shown = path.strip_prefix(crate::corpus()).unwrap_or(path).display();
        match rendered(path, samples, front) {
            Ok(image) => {
                println!("{} {shown}", cells.len());
                cells.push(image);
                if let Some(reference) = screenshot(path) {
                    println!("{} its screenshot", cells.len());
                    cells.push(within(&read_srgb(&std::fs::read(&reference)?, &reference.to_string_lossy())?)?);
                }
            }
            Err(error) => {
                failed += 1;
                println!("  not rendered: {shown}: {}", format!("{error:#}").lines().next().unwrap_or_default());
            }
        }
    }
    for (number, cells) in cells.chunks((ACROSS * DOWN) as usize).enumerate() {
        let place = keep.join(format!("sheet-{number}.png"));
        let mut bytes = Vec::new();
        format_for(&place)?.write(&[Layer::color("", joined(cells)?)], &WriteOptions::default(), &mut bytes)?;
        save(&place, &bytes)?;
        println!("wrote {}", place.display());
    }
    println!("{} models rendered, {failed} failed", paths.len() - failed);
    Ok(ExitCode::SUCCESS)
}

/// Collects the models in a folder and below.
fn files_below(folder: &Path, found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    for path in paths {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        match path.is_dir() {
            true => files_below(&path, found),
            false if EXTENSIONS.contains(&ending.as_str()) => found.push(path),
            false => {}
        }
    }
}

/// Returns the path of the screenshot of a Khronos sample model.
fn screenshot(path: &Path) -> Option<PathBuf> {
    let folder = path.parent()?.parent()?.join("screenshot");
    ["screenshot.png", "screenshot.jpg"].iter().map(|name| folder.join(name)).find(|path| path.is_file())
}

fn rendered(path: &Path, samples: u32, front: bool) -> Result<Image> {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let view = front.then_some(PresetView::Front);
    let scene_defaults = SceneDefaults { aspect: Some(1.0), view, ..SceneDefaults::default() };
    let options = LoadOptions { scene_defaults, ..LoadOptions::default() };
    let complaint = |diagnostics: &Diagnostics| {
        diagnostics.iter().map(|finding| finding.message.clone()).next().unwrap_or_else(|| "no message".into())
    };
    let loaded = load(path, &options, &mut files, &mut diagnostics)?;
    let loaded = loaded.with_context(|| complaint(&diagnostics))?;
    let world = loaded.compile(&options, &mut files, &mut diagnostics).with_context(|| complaint(&diagnostics))?;
    let sampling = Sampling::Filtered { samples, filter: Filter::Box { radius: 0.5 } };
    let job = Job { width: SIDE, height: SIDE, sampling, method: IntegratorKind::PATH, ..Job::default() };
    let part = PartialRender::new(&world, &job, Shard::WHOLE)?;
    part.render(&world, &Control::default(), &mut |_, _| {})?;
    Ok(Image::clone(&part.pictures()?.layers.first().context("a picture")?.image))
}

/// Scales a picture to the size of a cell by averaging, on a grey background.
fn within(image: &Image) -> Result<Image> {
    let scale = image.width.max(image.height) as f32 / SIDE as f32;
    let (left, top) =
        ((SIDE as f32 * scale - image.width as f32) / 2.0, (SIDE as f32 * scale - image.height as f32) / 2.0);
    let steps = scale.ceil().max(1.0) as u32;
    let pixel = |x: u32, y: u32| {
        let at = |i: u32, from: f32, offset: f32| (from + (i as f32 + 0.5) / steps as f32) * scale - offset;
        let all = (0..steps * steps).map(|i| {
            let (px, py) = (at(i % steps, x as f32, left), at(i / steps, y as f32, top));
            let inside = px >= 0.0 && py >= 0.0;
            inside.then(|| image.get(px as u32, py as u32)).flatten().unwrap_or(Vec3::splat(0.2))
        });
        all.sum::<Vec3>() / (steps * steps) as f32
    };
    let pixels = (0..SIDE * SIDE).map(|i| pixel(i % SIDE, i / SIDE)).collect();
    Ok(Image::from_pixels(SIDE, SIDE, pixels)?)
}

/// Joins pictures side by side.
fn joined(cells: &[Image]) -> Result<Image> {
    let rows = (cells.len() as u32).div_ceil(ACROSS);
    let mut sheet =
        Image::from_pixels(ACROSS * SIDE, rows * SIDE, vec![Vec3::ZERO; (ACROSS * SIDE * rows * SIDE) as usize])?;
    for (number, cell) in (0u32..).zip(cells) {
        let (left, top) = (number % ACROSS * SIDE, number / ACROSS * SIDE);
        for y in 0..SIDE {
            let from = (y * SIDE) as usize;
            let to = ((top + y) * ACROSS * SIDE + left) as usize;
            sheet.pixels[to..to + SIDE as usize].copy_from_slice(&cell.pixels[from..from + SIDE as usize]);
        }
    }
    Ok(sheet)
}
