//! What determinism costs: exact sums beside floating point, threads, and how soon a render ends that is cancelled.

use anyhow::{Result, bail};
use durer::compile::AccelKind;
use durer::diag::{Diagnostics, Files};
use durer::film::{Film, Filter};
use durer::integrator::Whitted;
use durer::math::{Vec2, Vec3};
use durer::render::{Control, Job, Part, Sampling, Shard, camera_ray, raster};
use durer::sampler::{Sampler, hash};
use durer::world::World;
use durer::{LoadOptions, load};
use std::process::ExitCode;
use std::sync::atomic::Ordering::Relaxed;
use std::time::{Duration, Instant};

const SCENES: [&str; 3] = ["sphere", "whitted", "melencolia"];

pub fn run(_: &[String]) -> Result<ExitCode> {
    for name in SCENES {
        let world = world(name)?;
        let (exact, plain) = film(&world);
        let ratio = exact.as_secs_f64() / plain.as_secs_f64();
        println!("{name:<12} exact sums against f32: {:.4} of the time", ratio);
    }
    let world = world("melencolia")?;
    let times = [1, 2].map(|threads| threaded(&world, threads));
    println!(
        "melencolia   two threads against one: {:.3} times as fast",
        times[0].as_secs_f64() / times[1].as_secs_f64()
    );
    let worst = (0..60).map(|i| latency(&world, i)).max().unwrap_or_default();
    println!("melencolia   longest of 60 cancels: {:.1} ms", worst.as_secs_f64() * 1e3);
    Ok(ExitCode::SUCCESS)
}

fn world(name: &str) -> Result<World> {
    let path = crate::root()?.join(format!("scenes/{name}.txt"));
    let options = LoadOptions { accel: AccelKind::Bvh, ..LoadOptions::default() };
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let loaded = load(&path, &options, &mut files, &mut diagnostics)?;
    match loaded.and_then(|loaded| loaded.compile(&options, &mut files, &mut diagnostics)) {
        Some(world) => Ok(world),
        None => bail!("{name} cannot be read: {diagnostics:?}"),
    }
}

const SIDE: u32 = 128;
const SAMPLES: u32 = 16;

/// Time that this thread had a processor: on a busy machine it says more than the clock.
fn cpu() -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    Duration::from_nanos(text.split(' ').next().and_then(|number| number.parse().ok()).unwrap_or_default())
}

/// The least time of several for the same samples, added exactly and added as `f32`, in turns.
fn film(world: &World) -> (Duration, Duration) {
    let job = Job { width: SIDE, height: SIDE, ..Job::default() };
    let whitted = Whitted { world, settings: job.settings, cancel: None };
    let (raster, warp) = (raster(world, SIDE, SIDE), Filter::default().sampler());
    let sample = |x, y, s| {
        let (offset, weight) = warp.sample(Sampler::Sobol.pixel_position(0, x, y, s, SAMPLES));
        let place = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) + offset;
        let ray = camera_ray(world, &raster, (x, y), place, Vec2::splat(0.5));
        (ray.map_or(Vec3::ZERO, |ray| whitted.radiance(&ray, &mut ())), weight)
    };
    let all = || (0..SIDE * SIDE).flat_map(|i| (0..SAMPLES).map(move |s| (i % SIDE, i / SIDE, s)));
    let (mut exact, mut plain) = (Duration::MAX, Duration::MAX);
    for _ in 0..15 {
        let start = cpu();
        let mut film = Film::new(SIDE, SIDE);
        for (x, y, s) in all() {
            let (color, weight) = sample(x, y, s);
            film.add(x, y, s, color, weight);
        }
        std::hint::black_box(&film);
        exact = exact.min(cpu() - start);
        let start = cpu();
        let mut sums = vec![(Vec3::ZERO, 0.0_f32); (SIDE * SIDE) as usize];
        for (x, y, s) in all() {
            let (color, weight) = sample(x, y, s);
            let sum = &mut sums[(y * SIDE + x) as usize];
            *sum = (sum.0 + weight * color, sum.1 + weight);
        }
        std::hint::black_box(&sums);
        plain = plain.min(cpu() - start);
    }
    (exact, plain)
}

fn large() -> Job {
    let sampling = Sampling::Filtered { samples: 16, filter: Filter::default() };
    Job { width: 512, height: 384, sampling, ..Job::default() }
}

fn threaded(world: &World, threads: usize) -> Duration {
    let time = || {
        let control = Control { threads: Some(threads), ..Control::default() };
        let start = Instant::now();
        let rendered = durer::render::render(world, &large(), &control);
        assert!(rendered.is_ok_and(|rendered| rendered.statistics.samples > 0));
        start.elapsed()
    };
    (0..3).map(|_| time()).min().unwrap_or_default()
}

/// How long a render goes on after it is cancelled.
fn latency(world: &World, number: u32) -> Duration {
    let job = Job { width: 1920, height: 1080, ..large() };
    let control = Control::default();
    let after = Duration::from_micros(hash(1, number, 0, 0, 0) % 400_000);
    std::thread::scope(|scope| {
        let render = scope.spawn(|| {
            let stop =
                Part::new(world, &job, Shard::WHOLE).and_then(|part| part.render(world, &control, &mut |_, _| {}));
            (stop, Instant::now())
        });
        std::thread::sleep(after);
        let cancelled = Instant::now();
        control.cancel.store(true, Relaxed);
        render.join().map_or(Duration::MAX, |(_, end)| end.saturating_duration_since(cancelled))
    })
}
