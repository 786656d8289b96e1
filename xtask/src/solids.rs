//! `cargo xtask solids`: tests a million points in solids against the Boolean of the parts, and
//! measures the cost of rays.

use anyhow::{Context, Result};
use durer::bvh::{TraversalCounter, TraversalStats};
use durer::compile::{AccelKind, Resources, compile};
use durer::diag::{Diagnostics, Files};
use durer::dialect::Dialect;
use durer::format::Decoder;
use durer::format::course::{ReadOptions, read};
use durer::format::folder::FolderSource;
use durer::math::{Ray, Vec3};
use durer::sampler::hash;
use durer::world::World;
use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};

const POINTS: usize = 1_000_000;
const RAYS: u32 = 200_000;
/// Number of alternating runs. Times are minima over these runs.
const RUNS: usize = 7;

/// Runs `cargo xtask solids`.
pub fn run() -> Result<ExitCode> {
    let status = Command::new("cargo")
        .args(["test", "--release", "--quiet", "-p", "durer", "--lib", "solids_have_the_points", "--", "--nocapture"])
        .env("DURER_SOLID_POINTS", POINTS.to_string())
        .status()
        .context("cannot run cargo")?;
    println!("{:52} {:>8} {:>12} {:>12}", "a thousand spheres, random rays", "objects", "ns per ray", "tests per ray");
    for (name, radius) in [("apart from each other", 0.3), ("touching: one tree of a thousand parts", 0.6)] {
        let plain = world("Group", radius)?;
        let merged = world("Merge", radius)?;
        let holes = holes(radius)?;
        let rows = [("as plain objects", &plain), ("merged", &merged), ("subtracted from a box", &holes)];
        let mut least = [Duration::MAX; 3];
        for _ in 0..RUNS {
            for (time, (_, world)) in least.iter_mut().zip(&rows) {
                *time = (*time).min(timed(world));
            }
        }
        println!("{name}");
        for (time, (kind, world)) in least.iter().zip(&rows) {
            let mut counts = TraversalStats::default();
            let hits = (0..RAYS).filter(|&i| traced(world, i, &mut counts)).count();
            let ratio = time.as_secs_f64() / least[0].as_secs_f64();
            println!(
                "    {kind:48} {:8} {:12.0} {:12.2}   {ratio:.2} times, {hits} hits",
                world.objects().len(),
                time.as_nanos() as f64 / f64::from(RAYS),
                counts.primitive_tests as f64 / f64::from(RAYS)
            );
        }
    }
    Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Returns a random number between 0 and 1.
fn random(i: u32, dimension: u32) -> f32 {
    (hash(0, i, dimension, 0, 0) >> 40) as f32 / (1u64 << 24) as f32
}

/// Returns spheres on a jittered lattice of 10 x 10 x 10 points.
fn balls(radius: f32) -> String {
    let ball = |i: u32| {
        let [x, y, z] = [i % 10, i / 10 % 10, i / 100].map(|k| k as f32);
        let [a, b, c] = [0, 1, 2].map(|d| 0.3 * random(i, d));
        format!("Sphere {{ center {} {} {} radius {radius} }}\n", x + a, y + b, z + c)
    };
    (0..1000).map(ball).collect()
}

fn world(word: &str, radius: f32) -> Result<World> {
    compiled(&format!("{word} {{ {} }}", balls(radius)))
}

fn holes(radius: f32) -> Result<World> {
    compiled(&format!("Difference {{ Box {{ min -1 -1 -1 max 11 11 11 }} {} }}", balls(radius)))
}

fn compiled(body: &str) -> Result<World> {
    let text = format!("PerspectiveCamera {{ center 0 0 0 direction 0 0 1 up 0 1 0 angle 40 }} Group {{ {body} }}");
    let (mut files, mut diagnostics, source) = (Files::default(), Diagnostics::default(), FolderSource::new("."));
    let file = files.add("balls.txt", text.as_bytes().into());
    let options = ReadOptions { dialect: Dialect::Durer, strict: false, compat: 0 };
    let scene = read(text.as_bytes(), file, options, &mut diagnostics).context("cannot read the spheres")?;
    let resources = Resources::new(&source, &Decoder, &mut files);
    compile(&scene, Dialect::Durer.rules(), AccelKind::Bvh, resources, &mut diagnostics).context("no world")
}

/// Returns a ray between two random points in or near the lattice.
fn ray(i: u32) -> Ray {
    let place = |first: u32| Vec3::new(random(i, first), random(i, first + 1), random(i, first + 2)) * 16.0 - 3.0;
    let origin = place(3);
    Ray::new(origin, place(6) - origin)
}

fn timed(world: &World) -> Duration {
    let start = Instant::now();
    let hits = (0..RAYS).filter(|&i| traced(world, i, &mut ())).count();
    assert!(hits > 0);
    start.elapsed()
}

fn traced<T: TraversalCounter>(world: &World, i: u32, counter: &mut T) -> bool {
    world.closest(&ray(i), counter).is_some()
}
