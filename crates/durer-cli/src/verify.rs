//! Implements `durer verify`, which checks that renders are deterministic.

use crate::failure::Failure;
use crate::file_registry::FileRegistry;
use crate::open::{load_options, open};
use crate::options::{JobArgs, SceneArgs, ViewArgs};
use crate::terminal::print_line;
use crate::{job, progress};
use anyhow::Context;
use clap::Args;
use durer::bvh::SimdLevel;
use durer::compile::AccelKind;
use durer::render::verify::{RenderVariant, VariantError, compare};
use durer::render::{Control, MIN_ADAPTIVE_SAMPLES, PartialRender, RenderError};
use durer::world::World;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Render a scene in many ways and check that the film is always the same
#[derive(Args)]
#[command(after_help = "Examples:
  durer verify scene.txt
  durer verify scene.txt --trials 500 --size 64x48 --samples 24 --noise-threshold 0.02

The ways differ in the number of threads, tile size, shards by tiles or samples, interruptions, acceleration structure and
SIMD instructions. A small picture is enough: the default is 64x48 with 8 samples per pixel, or 16 with --adaptive.")]
pub struct VerifyArgs {
    /// Scene or model file
    pub scene: PathBuf,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub view: ViewArgs,
    #[command(flatten)]
    pub job: JobArgs,
    /// Number of ways to render the scene
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub trials: u32,
    /// Print only the hash
    #[arg(short, long)]
    pub quiet: bool,
}

/// Acceleration structures that the scene is rendered with.
const STRUCTURES: [(&str, AccelKind); 3] =
    [("bvh", AccelKind::Bvh), ("grid", AccelKind::Grid(None)), ("none", AccelKind::None)];

/// Returns the available SIMD levels, with their names for `DURER_SIMD`. A process chooses its
/// level only once. If the variable is set, as it is in child processes, only that level is
/// available.
fn simd_levels() -> Vec<&'static str> {
    match std::env::var_os("DURER_SIMD") {
        Some(_) => vec![SimdLevel::chosen().name()],
        None => SimdLevel::available().map(SimdLevel::name).collect(),
    }
}

/// Default size of the pictures.
const SIZE: (u32, u32) = (64, 48);

/// Runs `durer verify`.
pub fn run(args: &VerifyArgs) -> Result<(), Failure> {
    let mut worlds: Vec<(&str, World)> = Vec::new();
    let mut first_job = None;
    for (name, accel) in STRUCTURES {
        let mut options = load_options(&args.reading);
        options.accel = accel;
        let (width, height) = args.job.options.requested_size().unwrap_or(SIZE);
        args.job.options.adapt(&mut options.scene_defaults);
        options.scene_defaults.aspect = Some(width as f32 / height as f32);
        // Diagnostics are printed only for the first acceleration structure.
        let compiled = open(&args.scene, &options, args.quiet || !worlds.is_empty(), &mut FileRegistry::default())?;
        let mut job = job::job(&args.job, Some(&args.view), &compiled.loaded, false)?;
        (job.width, job.height) = (width, height);
        // The cost picture depends on the acceleration structure.
        job.aovs.retain(|aov| aov.name != "cost");
        if ["samples", "noise-threshold"].iter().all(|name| args.job.options.get(name).is_none()) {
            job.sampling = job.sampling.with_samples(if job.adaptive { MIN_ADAPTIVE_SAMPLES } else { 8 });
        }
        first_job = Some(job);
        worlds.push((name, compiled.world));
    }
    let Some(job) = first_job else { return Ok(()) };
    let control = Control::default();
    control.total_work.store(args.trials.into(), Relaxed);
    let never = AtomicBool::new(false);
    let verified = progress::with_progress(&control, args.quiet, || {
        let plain = RenderVariant::PLAIN.render_job(&worlds[0].1, &job, &never).map_err(cancelled)?;
        for number in 0..u64::from(args.trials) {
            let way = RenderVariant::numbered(number, &job, worlds.len());
            let (structure, world) = &worlds[way.world];
            let way_name = format!("{structure}, {way}");
            match way.render_job(world, &job, &never) {
                Err(VariantError::Cancelled) => return Err(RenderError::Cancelled),
                Err(error) => return Ok(Err(format!("way {number} ({way_name}) failed: {error}"))),
                Ok(other) => {
                    if let Some(different) = compare(&plain, &other) {
                        let (expected, found, place) = (different.expected, different.actual, different.place);
                        return Ok(Err(format!("way {number} ({way_name}) differs: {place}\n{expected}\n{found}")));
                    }
                }
            }
            control.done_work.fetch_add(1, Relaxed);
        }
        Ok(Ok(plain))
    });
    let plain: PartialRender =
        verified.map_err(crate::failure::from_render_error)?.map_err(|text| Failure::Other(anyhow::anyhow!(text)))?;
    let hash = plain.hash().to_string();
    let levels = simd_levels();
    for level in levels.iter().filter(|level| **level != SimdLevel::chosen().name()) {
        if hash_at(level).with_context(|| format!("cannot render with DURER_SIMD={level}"))? != hash {
            return Err(Failure::Other(anyhow::anyhow!("the film rendered with DURER_SIMD={level} differs")));
        }
    }
    if !args.quiet {
        print_line(&format!(
            "{} ways, structures {}, instructions {}: all films have the same hash",
            args.trials,
            STRUCTURES.map(|s| s.0).join(", "),
            levels.join(", ")
        ));
    }
    print_line(&hash);
    Ok(())
}

/// Returns the hash that a child process computes at another SIMD level with fewer trials.
fn hash_at(level: &str) -> anyhow::Result<String> {
    let mut arguments: Vec<OsString> = std::env::args_os().skip(1).collect();
    // An option may be given only once.
    while let Some(at) = arguments.iter().position(|argument| argument == "--trials") {
        arguments.drain(at..(at + 2).min(arguments.len()));
    }
    arguments.retain(|a| a != "--quiet" && a != "-q" && !a.to_string_lossy().starts_with("--trials="));
    arguments.extend(["--quiet", "--trials", "10"].map(OsString::from));
    let mut command = Command::new(std::env::current_exe()?);
    let output = progress::run_child(command.args(arguments).env("DURER_SIMD", level))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    text.lines().last().map(str::to_string).with_context(|| String::from_utf8_lossy(&output.stderr).trim().to_string())
}

fn cancelled(error: VariantError) -> RenderError {
    match error {
        VariantError::Render(error) => error,
        _ => RenderError::Cancelled,
    }
}
