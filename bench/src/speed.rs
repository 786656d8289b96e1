//! How fast: tables of medians and ratios.

use crate::Options;
use crate::embree::{Embree, Quality, Scene};
use crate::peers::{BvhCrate, Obvhs, Parry};
use crate::rays::{Case, Found, Mesh, cases};
use anyhow::Result;
use durer::bvh::{Counts, Level, Preset, TriangleBvh};
use durer::math::{Ray, fp};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Something that traces; the rays go through it in one call, so that nothing is chosen ray by ray.
type Trace<'a> = Box<dyn Fn(&[Ray], &mut [Found]) + Sync + 'a>;

struct Tracer<'a> {
    name: &'static str,
    trace: Trace<'a>,
}

/// Calls a function for each ray.
fn each(rays: &[Ray], found: &mut [Found], trace: impl Fn(&Ray) -> Found) {
    for (ray, found) in rays.iter().zip(found) {
        *found = trace(ray);
    }
}

/// The answer to whether anything is hit, in the same form.
fn hit(occluded: bool) -> Found {
    if occluded { Found { t: 0.0, triangle: 0 } } else { Found::NONE }
}

macro_rules! single {
    ($name:expr, $tracer:expr, $any:expr) => {{
        let tracer = $tracer;
        let trace: Trace = match $any {
            false => Box::new(move |rays, found| each(rays, found, |ray| tracer.closest(ray))),
            true => Box::new(move |rays, found| each(rays, found, |ray| hit(tracer.occluded(ray)))),
        };
        Tracer { name: $name, trace }
    }};
}

/// Our tree, in the form of the others.
struct Ours(TriangleBvh);

impl Ours {
    #[inline]
    fn closest(&self, ray: &Ray) -> Found {
        self.0.closest(ray).map_or(Found::NONE, |hit| Found { t: hit.t, triangle: hit.triangle })
    }
    #[inline]
    fn occluded(&self, ray: &Ray) -> bool {
        self.0.occluded(ray)
    }
    fn batch(&self, rays: &[Ray], found: &mut [Found], any: bool) {
        const AT_ONCE: usize = 1024;
        let (mut hits, mut answers) = ([None; AT_ONCE], [false; AT_ONCE]);
        for (rays, found) in rays.chunks(AT_ONCE).zip(found.chunks_mut(AT_ONCE)) {
            match any {
                false => self.0.closest_batch(rays, &mut hits[..rays.len()]),
                true => self.0.occluded_batch(rays, &mut answers[..rays.len()]),
            }
            for ((found, triangle), occluded) in found.iter_mut().zip(&hits).zip(&answers) {
                *found = match any {
                    false => triangle.map_or(Found::NONE, |hit| Found { t: hit.t, triangle: hit.triangle }),
                    true => hit(*occluded),
                };
            }
        }
    }
}

/// Seconds for all rays on so many threads.
fn time(tracer: &Tracer, rays: &[Ray], found: &mut [Found], threads: usize) -> f64 {
    let clock = Instant::now();
    if threads == 1 {
        // The thread's own time: what others do on the machine does not count.
        let start = thread_seconds();
        (tracer.trace)(rays, found);
        return thread_seconds() - start;
    } else {
        const CHUNK: usize = 4096;
        let next = AtomicUsize::new(0);
        let parts: Vec<_> = rays.chunks(CHUNK).zip(found.chunks_mut(CHUNK)).map(std::sync::Mutex::new).collect();
        std::thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| {
                    while let Some(part) = parts.get(next.fetch_add(1, Ordering::Relaxed)) {
                        let mut part = part.lock().expect("no thread panics");
                        let (rays, found) = &mut *part;
                        (tracer.trace)(rays, found);
                    }
                });
            }
        });
    }
    clock.elapsed().as_secs_f64()
}

/// Processor time of this thread.
fn thread_seconds() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the place for the answer is valid.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// How many answers differ by more than rounding.
fn differences(a: &[Found], b: &[Found]) -> usize {
    let same = |a: &Found, b: &Found| a.t == b.t || (a.t - b.t).abs() <= 1e-3 * a.t.abs();
    a.iter().zip(b).filter(|(a, b)| !same(a, b)).count()
}

pub fn run(options: &Options) -> Result<()> {
    let embree = match &options.embree {
        Some(path) => Some(Arc::new(Embree::load(path, options.threads)?)),
        None => None,
    };
    let version = embree.as_ref().map_or("none".into(), |embree| embree.version());
    println!("Embree {version}; Dürer's SIMD {}; threads {}", Level::chosen().name(), options.threads);
    println!(
        "Millions of rays a second, medians of {} rounds; a ratio is Dürer's to the better of Embree's.\n",
        options.rounds
    );
    let mut ratios = Vec::new();
    for path in &options.meshes {
        one_mesh(&Mesh::read(path)?, options, embree.as_ref(), &mut ratios)?;
    }
    if embree.is_some() && !ratios.is_empty() {
        let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let logarithms: f32 = ratios.iter().map(|&ratio| fp::ln(ratio as f32)).sum();
        let mean = fp::exp(logarithms / ratios.len() as f32);
        println!("least ratio of {} cases of single rays: {least:.2}", ratios.len());
        println!("geometric mean of the ratios of single rays: {mean:.3}");
    }
    Ok(())
}

fn one_mesh(mesh: &Mesh, options: &Options, embree: Option<&Arc<Embree>>, ratios: &mut Vec<f64>) -> Result<()> {
    println!("{}: {} triangles", mesh.name, mesh.triangles.len());
    let ours = Ours(TriangleBvh::build(&mesh.vertices, &mesh.triangles, options.preset));
    let scenes = embree.map(|embree| builds(mesh, embree, options.rounds.min(5)));
    let peers = options.peers.then(|| (Obvhs::build(mesh), BvhCrate::build(mesh), Parry::build(mesh)));
    for case in cases(mesh, options.side, |ray| ours.closest(ray)) {
        let wanted = options.cases.is_empty() || options.cases.iter().any(|name| name == case.name);
        if !wanted || case.rays.is_empty() {
            continue;
        }
        let mut tracers = vec![single!("Dürer", &ours, case.any)];
        let (any, ours) = (case.any, &ours);
        tracers.push(Tracer { name: "Dürer batch", trace: Box::new(move |rays, found| ours.batch(rays, found, any)) });
        if let Some([medium, high]) = &scenes {
            tracers.push(single!("Embree medium", medium, case.any));
            tracers.push(single!("Embree high", high, case.any));
            let (any, coherent) = (case.any, case.coherent);
            let packets = move |rays: &[Ray], found: &mut [Found]| high.packets(rays, found, any, coherent);
            tracers.push(Tracer { name: "Embree 16-wide", trace: Box::new(packets) });
        }
        if let Some((obvhs, bvh, parry)) = &peers {
            tracers.push(single!("obvhs", obvhs, case.any));
            tracers.push(single!("bvh", bvh, case.any));
            tracers.push(single!("parry3d", parry, case.any));
        }
        one_case(&case, &ours, &tracers, options, ratios);
    }
    println!();
    Ok(())
}

fn one_case(case: &Case, ours: &Ours, tracers: &[Tracer], options: &Options, ratios: &mut Vec<f64>) {
    let mut found: Vec<Vec<Found>> = vec![vec![Found::NONE; case.rays.len()]; tracers.len()];
    let mut seconds = vec![Vec::new(); tracers.len()];
    for round in 0..options.rounds {
        for (i, tracer) in tracers.iter().enumerate() {
            // The other crates take long, and are here for orientation.
            if round >= 2 && !tracer.name.starts_with(['D', 'E']) {
                continue;
            }
            seconds[i].push(time(tracer, &case.rays, &mut found[i], options.threads));
        }
    }
    let rates: Vec<f64> = seconds.iter_mut().map(|seconds| case.rays.len() as f64 / median(seconds) / 1e6).collect();
    let rate = |name: &str| tracers.iter().position(|t| t.name == name).map(|i| rates[i]);
    let mut counts = Counts::default();
    for ray in &case.rays {
        match case.any {
            false => drop(ours.0.closest_counting(ray, &mut counts)),
            true => drop(ours.0.occluded_counting(ray, &mut counts)),
        }
    }
    let per_ray = |n: u64| n as f64 / case.rays.len() as f64;
    print!("  {:<9}", case.name);
    for (tracer, rate) in tracers.iter().zip(&rates) {
        print!(" {} {rate:<6.2}", tracer.name);
    }
    if let (Some(medium), Some(high), Some(packets), Some(batch)) =
        (rate("Embree medium"), rate("Embree high"), rate("Embree 16-wide"), rate("Dürer batch"))
    {
        let ratio = rates[0] / medium.max(high);
        ratios.push(ratio);
        print!(" | ratio {ratio:.2}, batch to packets {:.2}", batch / packets);
    }
    print!(" | nodes {:.1}, tests {:.1} a ray", per_ray(counts.nodes), per_ray(counts.tests));
    let differ: Vec<String> = (1..tracers.len())
        .map(|i| (tracers[i].name, differences(&found[0], &found[i])))
        .filter(|(_, n)| *n > 0)
        .map(|(name, n)| format!("{name} {n}"))
        .collect();
    println!("{}{}", if differ.is_empty() { "" } else { " | answers that differ: " }, differ.join(", "));
}

/// Builds with Embree's two qualities and our three presets, alternating.
fn builds(mesh: &Mesh, embree: &Arc<Embree>, rounds: usize) -> [Scene; 2] {
    let mut scenes = None;
    let mut seconds = vec![Vec::new(); 5];
    let mut trees = Vec::new();
    for _ in 0..rounds {
        trees.clear();
        let (medium, time) = embree.build(mesh, Quality::Medium, false);
        seconds[0].push(time);
        let (high, time) = embree.build(mesh, Quality::High, false);
        seconds[1].push(time);
        scenes = Some([medium, high]);
        for (i, (_, preset)) in Preset::NAMES.into_iter().enumerate() {
            let clock = Instant::now();
            trees.push(TriangleBvh::build(&mesh.vertices, &mesh.triangles, preset));
            seconds[2 + i].push(clock.elapsed().as_secs_f64());
        }
    }
    let scenes = scenes.expect("there is a round");
    let of = |bytes: usize| bytes as f64 / mesh.triangles.len() as f64;
    let mut times: Vec<f64> = seconds.iter_mut().map(|seconds| 1e3 * median(seconds)).collect();
    print!("  build     Embree medium {:.1} ms, {:.0} B", times[0], of(scenes[0].bytes));
    print!("; high {:.1} ms, {:.0} B", times[1], of(scenes[1].bytes));
    for ((name, _), (tree, time)) in Preset::NAMES.iter().zip(trees.iter().zip(times.drain(2..))) {
        print!("; ours {name} {time:.1} ms, {:.0} B, cost {:.1}", of(tree.bytes()), tree.cost());
    }
    println!(" (bytes a triangle)");
    scenes
}
