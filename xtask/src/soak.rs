//! `cargo xtask soak`: renders random scenes and files of all formats with all integrators, in one
//! process and with the command. Checks that repeated jobs have the same hash, that memory does not
//! grow, and that no handles leak.

use anyhow::{Context, Result, bail, ensure};
use durer::describe::DescribedKind;
use durer::diag::{Diagnostics, Files};
use durer::integrator::IntegratorKind;
use durer::render::{Control, PartialRender, Shard};
use durer::sampler::hash;
use durer::{LoadOptions, RenderJob, fuzz, load};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};

/// Fraction of the time after which memory must not grow any more, and the growth in bytes that is
/// allowed.
const WARM_UP_FRACTION: f64 = 0.3;
const MAX_GROWTH: u64 = 96 << 20;
/// One in this many rounds is also rendered with the command.
const COMMAND_INTERVAL: u64 = 25;
/// Maximum size of a file in bytes, because larger files take too long.
const MAX_BYTES: u64 = 256 << 10;
const MEMORY: u64 = 1 << 30;

/// A scene to render in the soak test: randomly generated from a key, or read from a file.
enum Scene {
    Random(u64),
    File(PathBuf),
}

/// Runs `cargo xtask soak`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let number = |name: &str, usual: f64| -> Result<f64> {
        crate::value(arguments, name)
            .map_or(Ok(usual), |value| value.parse().with_context(|| format!("{name} needs a number")))
    };
    let (minutes, seed) = (number("--minutes", 2.0)?, number("--seed", 1.0)? as u64);
    let (durer, folder) = (crate::build::build_durer()?, tempfile::tempdir()?);
    let files = files()?;
    ensure!(!files.is_empty(), "there are no scenes");
    let methods: Vec<IntegratorKind> = IntegratorKind::kinds();
    let (start, time) = (Instant::now(), Duration::from_secs_f64(60.0 * minutes));
    let mut known: HashMap<u64, Option<String>> = HashMap::new();
    let (mut rounds, mut again, mut commands, mut refused) = (0_u64, 0, 0, 0);
    let mut warm: Option<Usage> = None;
    let mut most = Usage::default();
    while start.elapsed() < time {
        // Half of the rounds repeat an earlier job from a sliding window.
        let random = |place: u32, below: u64| hash(seed, rounds as u32, place, 0, 0) % below.max(1);
        let newest = 1 + rounds / 2;
        let key = if random(0, 2) == 0 { newest } else { newest.saturating_sub(random(1, 200)) };
        rounds += 1;
        let pick = |place: u32, below: usize| (hash(seed, key as u32, place, 1, 0) % below.max(1) as u64) as usize;
        let scene = match pick(0, 2) {
            0 => Scene::Random(key),
            _ => Scene::File(files[pick(1, files.len())].clone()),
        };
        let method = methods[pick(2, methods.len())].name();
        let options = [("size", "24x18"), ("samples", "2"), ("integrator", method), ("seed", ["1", "7"][pick(3, 2)])];
        let path = write_scene(&scene, seed, folder.path())?;
        let found = rendered(&path, &options)?;
        refused += u64::from(found.is_none());
        match known.get(&key) {
            Some(before) => {
                again += 1;
                ensure!(
                    *before == found,
                    "the hash of {} with {options:?} changed: {before:?}, {found:?}",
                    path.display()
                );
            }
            None => drop(known.insert(key, found.clone())),
        }
        if let (Some(found), 0) = (found, rounds % COMMAND_INTERVAL) {
            commands += 1;
            let own = command(&durer, &path, &options, folder.path())?;
            ensure!(
                own == found,
                "the command gives a different hash for {} with {options:?}: {own}, {found}",
                path.display()
            );
        }
        let used = Usage::now();
        match &warm {
            None if start.elapsed() > time.mul_f64(WARM_UP_FRACTION) => warm = Some(most),
            Some(warm) if used.bytes > warm.bytes + MAX_GROWTH => {
                bail!(
                    "memory grows: {} MiB after {rounds} rounds, {} MiB at most before",
                    used.bytes >> 20,
                    warm.bytes >> 20
                )
            }
            Some(warm) if used.handles > warm.handles => {
                bail!("{} handles are open after {rounds} rounds, {} at most before", used.handles, warm.handles)
            }
            _ => {}
        }
        most = Usage { bytes: most.bytes.max(used.bytes), handles: most.handles.max(used.handles) };
    }
    println!(
        "{rounds} renders of {} jobs in {minutes} minutes, {again} repeated with the same hash, {refused} refused; \
         {commands} by the command with the same hash; at most {} MiB and {} handles",
        known.len(),
        most.bytes >> 20,
        most.handles
    );
    Ok(ExitCode::SUCCESS)
}

/// Returns the small scenes and models of the repository.
fn files() -> Result<Vec<PathBuf>> {
    let (mut found, mut folders) = (Vec::new(), vec![crate::root()?.join("scenes")]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder)? {
            let (path, metadata) = {
                let entry = entry?;
                (entry.path(), entry.metadata()?)
            };
            let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
            let known = [
                "txt", "json", "gltf", "glb", "pbrt", "xml", "dae", "rad", "rif", "3mf", "usda", "usdc", "usdz", "obj",
                "ply", "stl",
            ];
            match metadata.is_dir() {
                true => folders.push(path),
                false if metadata.len() <= MAX_BYTES && known.contains(&&*ending) => found.push(path),
                false => {}
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Returns the path of a scene. A random scene is written to `folder`.
fn write_scene(scene: &Scene, seed: u64, folder: &Path) -> Result<PathBuf> {
    Ok(match scene {
        Scene::File(path) => path.clone(),
        Scene::Random(key) => {
            let bytes: Vec<u8> = (0..400).map(|i| hash(seed, *key as u32, i, 2, 0) as u8).collect();
            let path = folder.join("scene.txt");
            std::fs::write(&path, fuzz::random_scene(&bytes))?;
            fuzz::write_files(folder)?;
            path
        }
    })
}

/// Renders a file in this process and returns the hash of the film; `None` if the file is rejected.
fn rendered(path: &Path, options: &[(&str, &str)]) -> Result<Option<String>> {
    let load_options = LoadOptions { memory: Some(MEMORY), ..LoadOptions::default() };
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let Some(loaded) = load(path, &load_options, &mut files, &mut diagnostics)? else { return Ok(None) };
    let Some(world) = loaded.compile(&load_options, &mut files, &mut diagnostics) else { return Ok(None) };
    let mut job = RenderJob::default();
    for (name, value) in options {
        job.set(name, value).map_err(anyhow::Error::msg)?;
    }
    let Ok(job) = job.resolve(&loaded.job_context(false), None) else { return Ok(None) };
    let part = PartialRender::new(&world, &job, Shard::WHOLE)?;
    part.render(&world, &Control { memory: Some(MEMORY), ..Control::default() }, &mut |_, _| {})?;
    Ok(Some(part.hash().to_string()))
}

/// Renders a file with the `durer` command and returns the hash of the film.
fn command(durer: &Path, path: &Path, options: &[(&str, &str)], folder: &Path) -> Result<String> {
    let mut command = Command::new(durer);
    command.arg("render").arg(path).args(["--hash", "--quiet", "--no-checkpoint", "--memory", "1G", "-o"]);
    command.arg(folder.join("picture.pfm"));
    for (name, value) in options {
        command.args([&format!("--{name}"), *value]);
    }
    let output = command.output()?;
    let messages = String::from_utf8_lossy(&output.stdout);
    let hash = messages.lines().last().map(str::to_string);
    hash.with_context(|| format!("{}: {}", path.display(), String::from_utf8_lossy(&output.stderr)))
}

/// Memory and open handles of this process; zero except on Linux.
#[derive(Clone, Copy, Default)]
struct Usage {
    bytes: u64,
    handles: usize,
}

impl Usage {
    fn now() -> Self {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
        let kib: u64 = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse().ok()).unwrap_or(0);
        let handles = std::fs::read_dir("/proc/self/fd").map_or(0, Iterator::count);
        Usage { bytes: kib << 10, handles }
    }
}
