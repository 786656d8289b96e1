//! `cargo xtask fuzz`: fuzzes the readers and the tracer with random bytes and scenes, in parallel.
//! The targets are in `fuzz/`.

use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Fuzz targets, with the extensions of their seed files.
const TARGETS: [(&str, &[&str]); 26] = [
    ("scene", &["txt"]),
    ("obj", &["obj"]),
    ("ply", &["ply"]),
    ("png", &["png"]),
    ("tga", &["tga"]),
    ("bmp", &["bmp"]),
    ("ppm", &["ppm"]),
    ("pfm", &["pfm"]),
    ("exr", &["exr"]),
    ("hdr", &["hdr"]),
    ("ktx2", &["ktx2"]),
    ("stl", &["stl"]),
    // Also covers Draco and meshopt.
    ("dae", &["dae"]),
    ("gltf", &["gltf", "glb"]),
    ("json", &["json"]),
    ("pbrt", &["pbrt"]),
    ("rad", &["rad"]),
    ("threemf", &["3mf"]),
    ("off", &["off"]),
    ("usd", &["usda", "usdc", "usdz"]),
    ("xml", &["xml"]),
    ("curve", &["csv"]),
    ("weather", &["epw", "wea"]),
    ("ies", &["ies", "ldt"]),
    ("part", &[]),
    ("ways", &[]),
];

/// Limits: bytes per input, MiB of memory, and seconds per input.
const MAX_BYTES: u64 = 16 << 10;
const MAX_MEMORY: u32 = 2048;
const MAX_SECONDS: u32 = 20;

/// Runs `cargo xtask fuzz`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let minutes: f64 = crate::value(arguments, "--minutes").map_or("10", String::as_str).parse()?;
    let only = crate::value(arguments, "--only").map_or("", String::as_str);
    let targets: Vec<_> = TARGETS.iter().filter(|target| target.0.contains(only)).collect();
    if targets.is_empty() {
        bail!("no target's name contains `{only}`: {}", TARGETS.map(|target| target.0).join(", "));
    }
    let jobs =
        crate::value(arguments, "--jobs").map_or(Ok(targets.len()), |jobs| jobs.parse())?.clamp(1, targets.len());
    what_is_missing()?;
    let fuzz = crate::root()?.join("fuzz");
    let built = cargo_fuzz(&fuzz, &["build"]).status()?;
    if !built.success() {
        bail!("cannot build the targets");
    }
    let scratch = fuzz.join("target/runs");
    println!("{} targets, {jobs} at a time, {minutes} minutes each; logs are in {}", targets.len(), scratch.display());
    let (next, found) = (AtomicUsize::new(0), AtomicUsize::new(0));
    std::thread::scope(|scope| {
        let one_after_another = || -> Result<()> {
            while let Some((name, endings)) = targets.get(next.fetch_add(1, Ordering::Relaxed)) {
                found.fetch_add(usize::from(!is_clean(&fuzz, &scratch, name, endings, minutes)?), Ordering::Relaxed);
            }
            Ok(())
        };
        let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(one_after_another)).collect();
        workers.into_iter().try_for_each(|worker| worker.join().unwrap_or_else(|_| bail!("a worker panicked")))
    })?;
    if let Some(hours) = hours_of_children() {
        println!("{hours:.2} hours of processor time");
    }
    Ok(if found.into_inner() == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Runs a target. Returns true if it found no failure.
fn is_clean(fuzz: &Path, scratch: &Path, name: &str, endings: &[&str], minutes: f64) -> Result<bool> {
    let (corpus, seeds) = (fuzz.join("corpus").join(name), scratch.join(name).join("seeds"));
    std::fs::create_dir_all(&corpus)?;
    collect_seeds(&seeds, endings)?;
    let log = scratch.join(name).join("log.txt");
    let file = std::fs::File::create(&log)?;
    let mut command = cargo_fuzz(fuzz, &["run", name]);
    command.args([&corpus, &fuzz.join("seeds").join(name), &seeds].into_iter().filter(|folder| folder.is_dir()));
    command.arg("--").args([
        format!("-max_total_time={}", (60.0 * minutes) as u64),
        format!("-rss_limit_mb={MAX_MEMORY}"),
        format!("-malloc_limit_mb={MAX_MEMORY}"),
        format!("-timeout={MAX_SECONDS}"),
        format!("-max_len={MAX_BYTES}"),
        "-print_final_stats=1".into(),
    ]);
    let start = Instant::now();
    let status = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(file).status()?;
    let text = String::from_utf8_lossy(&std::fs::read(&log)?).into_owned();
    if status.success() {
        let runs = text.lines().find_map(|line| line.strip_prefix("stat::number_of_executed_units:"));
        println!("{name}: {} inputs, nothing found", runs.map_or("?", str::trim));
        return Ok(true);
    }
    let seconds = start.elapsed().as_secs_f64();
    println!("{name}: FOUND after {seconds:.0} s; the input is in fuzz/artifacts/{name}, the end of its log:");
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(25)..].iter().for_each(|line| println!("    {line}"));
    Ok(false)
}

/// Returns the CPU time of finished child processes in hours; `None` except on Linux.
fn hours_of_children() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The name in parentheses can contain spaces. The fields after it start with the third; fields
    // 16 and 17 are in 1/100 s.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |number: usize| fields.get(number - 3)?.parse::<f64>().ok();
    Some((ticks(16)? + ticks(17)?) / 100.0 / 3600.0)
}

fn cargo_fuzz(fuzz: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new("cargo");
    // The cargo that started this process uses another toolchain, and must not select the compiler.
    command.env_remove("RUSTUP_TOOLCHAIN").env_remove("CARGO").args(["+nightly", "fuzz"]).args(arguments);
    command.current_dir(fuzz.join(".."));
    command
}

/// Fails with installation instructions if a tool is missing.
fn what_is_missing() -> Result<()> {
    let there = |arguments: &[&str]| {
        let mut command = Command::new("cargo");
        command.env_remove("RUSTUP_TOOLCHAIN").env_remove("CARGO").args(arguments);
        command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
    };
    if !there(&["+nightly", "--version"]) {
        bail!(
            "fuzzing needs a nightly compiler: `rustup toolchain install nightly` installs one beside the stable one"
        );
    }
    if !there(&["+nightly", "fuzz", "--version"]) {
        bail!("fuzzing needs cargo-fuzz: `cargo install cargo-fuzz` installs it");
    }
    Ok(())
}

/// Copies small files as seeds, from the scenes of the repository and from the corpus if it exists.
fn collect_seeds(folder: &Path, endings: &[&str]) -> Result<()> {
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let mut found = Vec::new();
    for root in [crate::root()?.join("scenes"), crate::corpus()] {
        files(&root, endings, 6, &mut found);
    }
    for (number, path) in found.iter().take(400).enumerate() {
        std::fs::copy(path, folder.join(number.to_string()))?;
    }
    Ok(())
}

/// Collects small files with the given extensions, in a folder and below.
fn files(folder: &Path, endings: &[&str], depth: usize, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() && depth > 0 {
            files(&path, endings, depth - 1, found);
        }
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let small = entry.metadata().is_ok_and(|metadata| metadata.is_file() && metadata.len() <= MAX_BYTES);
        if small && endings.contains(&ending.as_str()) {
            found.push(path);
        }
    }
}
