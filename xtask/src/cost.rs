//! `cargo xtask cost`: measures the cost of determinism (exact sums compared with floating point),
//! the speedup by a second thread, and the latency of cancelling a render.

use anyhow::{Result, bail};
use durer::compile::AccelKind;
use durer::diag::{Diagnostics, Files};
use durer::film::{Film, Filter};
use durer::integrator::Whitted;
use durer::math::{Vec2, Vec3};
use durer::render::{Control, Job, PartialRender, Sampling, Shard, camera_ray, raster};
use durer::sampler::{Sampler, hash};
use durer::world::World;
use durer::{LoadOptions, load};
use std::process::ExitCode;
use std::sync::atomic::Ordering::Relaxed;
use std::time::{Duration, Instant};

const SCENES: [&str; 3] = ["sphere", "whitted", "melencolia"];

/// Runs `cargo xtask cost`.
pub fn run(_: &[String]) -> Result<ExitCode> {
    for name in SCENES {
        let world = world(name)?;
        let [exact, plain] = film(&world);
        let ratio = exact.as_secs_f64() / plain.as_secs_f64();
        println!("{name:<12} exact sums against f32: {:.4} of the time", ratio);
    }
    let world = world("melencolia")?;
    let [one, two, pair] = threaded(&world).map(|time| time.as_secs_f64());
    println!("melencolia   two threads against one: {:.3} times as fast", one / two);
    println!("melencolia   two renders at once, a thread each, against one: {:.3} times the work", 2.0 * one / pair);
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
        None => bail!("cannot read {name}: {diagnostics:?}"),
    }
}

const SIDE: u32 = 128;
const SAMPLES: u32 = 16;
/// Luminance weights of Rec. 709.
const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// Sums of a pixel's samples as in the film, but in floating point, for comparing the speed.
#[derive(Clone, Default)]
struct FloatSums {
    color: Vec3,
    squares: f32,
    luminance: f32,
    weight: f32,
    covered: f32,
    samples: u32,
    rejected: u32,
}

impl FloatSums {
    fn add(&mut self, color: Vec3, weight: f32) {
        if !(color.is_finite() && weight.is_finite()) {
            self.rejected += 1;
            return;
        }
        let luminance = color.dot(LUMINANCE);
        self.color += weight * color;
        self.squares += luminance * luminance;
        self.luminance += luminance;
        self.weight += weight;
        self.covered += weight;
        self.samples += 1;
    }
}

/// Returns the times for the same samples with exact sums and with `f32` sums. Each time is the
/// minimum over alternating runs, because disturbances last longer than a single run.
fn film(world: &World) -> [Duration; 2] {
    let job = Job { width: SIDE, height: SIDE, ..Job::default() };
    let whitted = Whitted { world, settings: job.settings, cancel: None };
    let (raster, warp) = (raster(world, SIDE, SIDE), Filter::default().sampler());
    // Hide the function from the compiler, so that both versions call the same code.
    let sample: &dyn Fn(u32, u32, u32) -> (Vec3, f32) = &|x, y, s| {
        let (offset, weight) = warp.sample(Sampler::Sobol.pixel_position(0, x, y, s, SAMPLES));
        let place = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) + offset;
        let ray = camera_ray(world, &raster, (x, y), place, Vec2::splat(0.5));
        (ray.map_or(Vec3::ZERO, |ray| whitted.radiance(&ray, &mut ())), weight)
    };
    let sample = std::hint::black_box(sample);
    let mut exact = Film::new(SIDE, SIDE);
    let mut plain = vec![FloatSums::default(); (SIDE * SIDE) as usize];
    let mut least = [[Duration::MAX; SIDE as usize]; 2];
    for _ in 0..12 {
        for y in 0..SIDE {
            let row = || (0..SIDE).flat_map(|x| (0..SAMPLES).map(move |s| (x, s)));
            let mut note = |way: usize, start: Instant| {
                let least = &mut least[way][y as usize];
                *least = start.elapsed().min(*least);
            };
            let start = Instant::now();
            for (x, s) in row() {
                let (color, weight) = sample(x, y, s);
                exact.add(x, y, s, color, weight);
            }
            note(0, start);
            let start = Instant::now();
            for (x, s) in row() {
                let (color, weight) = sample(x, y, s);
                plain[(y * SIDE + x) as usize].add(color, weight);
            }
            note(1, start);
        }
    }
    std::hint::black_box((&exact, &plain));
    least.map(|rows| rows.iter().sum())
}

fn large() -> Job {
    let sampling = Sampling::Filtered { samples: 16, filter: Filter::default() };
    Job { width: 800, height: 600, sampling, ..Job::default() }
}

/// Returns the minimum times of a render on one thread, of a render on two threads, and of two
/// simultaneous renders on one thread each. The last one shows how much both processors can do
/// together, because they may be two hyperthreads of the same core.
fn threaded(world: &World) -> [Duration; 3] {
    let render = |threads| {
        let control = Control { threads: Some(threads), ..Control::default() };
        let rendered = durer::render::render(world, &large(), &control);
        assert!(rendered.is_ok_and(|rendered| rendered.statistics.samples > 0));
    };
    let time = |work: &dyn Fn()| {
        let start = Instant::now();
        work();
        start.elapsed()
    };
    let both = || {
        std::thread::scope(|scope| {
            scope.spawn(|| render(1));
            render(1);
        });
    };
    let mut least = [Duration::MAX; 3];
    for _ in 0..3 {
        let times = [time(&|| render(1)), time(&|| render(2)), time(&both)];
        least.iter_mut().zip(times).for_each(|(least, time)| *least = time.min(*least));
    }
    least
}

/// Measures how long a render continues after it is cancelled.
fn latency(world: &World, number: u32) -> Duration {
    let job = Job { width: 1920, height: 1080, ..large() };
    let control = Control::default();
    let after = Duration::from_micros(hash(1, number, 0, 0, 0) % 400_000);
    std::thread::scope(|scope| {
        let render = scope.spawn(|| {
            let stop = PartialRender::new(world, &job, Shard::WHOLE)
                .and_then(|part| part.render(world, &control, &mut |_, _| {}));
            (stop, Instant::now())
        });
        std::thread::sleep(after);
        let cancelled = Instant::now();
        control.cancel.store(true, Relaxed);
        render.join().map_or(Duration::MAX, |(_, end)| end.saturating_duration_since(cancelled))
    })
}
