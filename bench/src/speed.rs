//! Measures ray tracing speed and prints medians and ratios.

use crate::Options;
use crate::embree::{Embree, Quality, Scene};
use crate::peers::{BvhCrate, Obvhs, Parry};
use crate::rays::{BenchHit, Mesh, RayCase, cases};
use anyhow::{Context, Result};
use durer::bvh::{BuildQuality, Instance, InstanceBvh, InstanceHit, SimdLevel, TraversalStats, TriangleBvh};
use durer::math::{Affine, Ray, Vec3, fp};
use durer::sampler::random_2d;
use glam::{DAffine3, DMat3, DVec3};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Function that traces all rays in one call, so that there is no dynamic dispatch per ray.
type Trace<'a> = Box<dyn Fn(&[Ray], &mut [BenchHit]) + Sync + 'a>;

/// A tracer to be timed, with its name in the output.
struct Tracer<'a> {
    name: &'static str,
    trace: Trace<'a>,
}

/// Traces rays one by one with a function.
fn each(rays: &[Ray], found: &mut [BenchHit], trace: impl Fn(&Ray) -> BenchHit) {
    for (ray, found) in rays.iter().zip(found) {
        *found = trace(ray);
    }
}

/// Converts the result of an occlusion test to a `BenchHit`.
fn hit(occluded: bool) -> BenchHit {
    if occluded { BenchHit { t: 0.0, triangle: 0 } } else { BenchHit::NONE }
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

/// Dürer's BVH of one mesh, with the interface of the other tracers.
struct DurerTracer(TriangleBvh);

impl DurerTracer {
    #[inline]
    fn closest(&self, ray: &Ray) -> BenchHit {
        self.0.closest(ray).into()
    }
    #[inline]
    fn occluded(&self, ray: &Ray) -> bool {
        self.0.occluded(ray)
    }
    fn batch(&self, rays: &[Ray], found: &mut [BenchHit], any: bool) {
        const AT_ONCE: usize = 1024;
        let (mut hits, mut answers) = ([None; AT_ONCE], [false; AT_ONCE]);
        for (rays, found) in rays.chunks(AT_ONCE).zip(found.chunks_mut(AT_ONCE)) {
            if any {
                self.0.occluded_batch(rays, &mut answers[..rays.len()]);
                found.iter_mut().zip(&answers).for_each(|(found, occluded)| *found = hit(*occluded));
            } else {
                self.0.closest_batch(rays, &mut hits[..rays.len()]);
                found.iter_mut().zip(&hits).for_each(|(found, hit)| *found = (*hit).into());
            }
        }
    }
}

/// Returns the seconds that a tracer needs for all rays on `threads` threads.
fn time(tracer: &Tracer, rays: &[Ray], found: &mut [BenchHit], threads: usize) -> f64 {
    let clock = Instant::now();
    if threads == 1 {
        // The CPU time of a thread excludes other processes.
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

/// Returns the CPU time of this thread in seconds.
fn thread_seconds() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer to the result is valid.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Counts the hits that differ by more than rounding.
fn differences(a: &[BenchHit], b: &[BenchHit]) -> usize {
    let same = |a: &BenchHit, b: &BenchHit| a.t == b.t || (a.t - b.t).abs() <= 1e-3 * a.t.abs();
    a.iter().zip(b).filter(|(a, b)| !same(a, b)).count()
}

/// Times all tracers on the selected meshes and prints the results.
pub fn run(options: &Options) -> Result<()> {
    let embree = match &options.embree {
        Some(path) => Some(Arc::new(Embree::load(path, options.threads)?)),
        None => None,
    };
    let version = embree.as_ref().map_or("none".into(), |embree| embree.version());
    println!("Embree {version}; Dürer's SIMD {}; threads {}", SimdLevel::chosen().name(), options.threads);
    println!(
        "Millions of rays per second, medians of {} rounds. A ratio compares Dürer with the faster of Embree's qualities.\n",
        options.rounds
    );
    let mut ratios = Vec::new();
    for path in &options.meshes {
        let mesh = Mesh::read(path)?;
        match options.instances {
            Some(count) => instances(&mesh, count, options, embree.as_ref(), &mut ratios),
            None => one_mesh(&mesh, options, embree.as_ref(), &mut ratios),
        }
    }
    if embree.is_some() && !ratios.is_empty() {
        let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let logarithms: f32 = ratios.iter().map(|&ratio| fp::ln(ratio as f32)).sum();
        let mean = fp::exp(logarithms / ratios.len() as f32);
        println!("lowest ratio of {} cases of single rays: {least:.2}", ratios.len());
        println!("geometric mean of the ratios of single rays: {mean:.3}");
    }
    Ok(())
}

/// Reads numbers from a binary file.
fn numbers<T>(path: &Path, number: impl Fn([u8; 4]) -> T) -> Result<Vec<T>> {
    let bytes = std::fs::read(path).with_context(|| path.display().to_string())?;
    Ok(bytes.as_chunks().0.iter().map(|&bytes| number(bytes)).collect())
}

/// Prints the speed of Dürer's batch interface, in millions of rays per second, for a mesh and rays
/// written by another program. Comparing it with that program gives the overhead of its interface.
pub fn arrays(folder: &Path, options: &Options) -> Result<()> {
    let floats = |name: &str| numbers(&folder.join(name), f32::from_le_bytes);
    let points =
        |name: &str| Ok::<_, anyhow::Error>(floats(name)?.chunks_exact(3).map(Vec3::from_slice).collect::<Vec<_>>());
    let faces = numbers(&folder.join("faces.u32"), u32::from_le_bytes)?;
    let tree = TriangleBvh::try_build(&points("vertices.f32")?, faces.as_chunks().0, options.preset)?;
    let rays: Vec<Ray> =
        points("origins.f32")?.into_iter().zip(points("directions.f32")?).map(|(o, d)| Ray::new(o, d)).collect();
    let ours = DurerTracer(tree);
    let trace = |rays: &[Ray], found: &mut [BenchHit]| ours.batch(rays, found, false);
    let tracer = Tracer { name: "Dürer batch", trace: Box::new(trace) };
    let mut found = vec![BenchHit::NONE; rays.len()];
    let mut times: Vec<f64> = (0..options.rounds).map(|_| time(&tracer, &rays, &mut found, options.threads)).collect();
    println!("{:.2}", rays.len() as f64 / median(&mut times) / 1e6);
    Ok(())
}

fn one_mesh(mesh: &Mesh, options: &Options, embree: Option<&Arc<Embree>>, ratios: &mut Vec<f64>) {
    println!("{}: {} triangles", mesh.name, mesh.triangles.len());
    let ours = DurerTracer(TriangleBvh::build(&mesh.vertices, &mesh.triangles, options.preset));
    let scenes = embree.map(|embree| builds(mesh, embree, options.rounds.min(5)));
    let peers = options.peers.then(|| (Obvhs::build(mesh), BvhCrate::build(mesh), Parry::build(mesh)));
    for case in cases(mesh, options.side, |ray| ours.closest(ray)) {
        if case.rays.is_empty() || !options.wants(&case) {
            continue;
        }
        let mut tracers = vec![single!("Dürer", &ours, case.any)];
        let (any, ours) = (case.any, &ours);
        tracers.push(Tracer { name: "Dürer batch", trace: Box::new(move |rays, found| ours.batch(rays, found, any)) });
        if let Some([medium, high]) = &scenes {
            tracers.push(single!("Embree medium", medium, case.any));
            tracers.push(single!("Embree high", high, case.any));
            let (any, coherent) = (case.any, case.coherent);
            let packets = move |rays: &[Ray], found: &mut [BenchHit]| high.trace_packets(rays, found, any, coherent);
            tracers.push(Tracer { name: "Embree 16-wide", trace: Box::new(packets) });
        }
        if let Some((obvhs, bvh, parry)) = &peers {
            tracers.push(single!("obvhs", obvhs, case.any));
            tracers.push(single!("bvh", bvh, case.any));
            tracers.push(single!("parry3d", parry, case.any));
        }
        let count = |ray: &Ray, counts: &mut TraversalStats| match case.any {
            false => drop(ours.0.closest_counting(ray, counts)),
            true => drop(ours.0.occluded_counting(ray, counts)),
        };
        one_case(&case, &count, &tracers, options, ratios);
    }
    println!();
}

/// Compares instances of one mesh, each with its own rotation and scale.
fn instances(mesh: &Mesh, count: u32, options: &Options, embree: Option<&Arc<Embree>>, ratios: &mut Vec<f64>) {
    println!("{} instances of {}: {} triangles", count, mesh.name, mesh.triangles.len());
    let places = instance_transforms(mesh, count);
    let tree = Arc::new(TriangleBvh::build(&mesh.vertices, &mesh.triangles, options.preset));
    let place = |place: &DAffine3| Instance::new(tree.clone(), Affine::new(*place).expect("places can be inverted"));
    let clock = Instant::now();
    let ours = DurerInstances(InstanceBvh::new(places.iter().map(place).collect()), mesh.triangles.len() as u32);
    let time = clock.elapsed().as_secs_f64();
    let theirs = embree.map(|embree| {
        let object = embree.build(mesh, Quality::High, false).0;
        let (scene, seconds) = embree.build_instances(&object, &places);
        print!("  build     Embree {:.1} ms; ", 1e3 * seconds);
        (scene, object)
    });
    println!("ours {:.1} ms, {} bytes with the mesh", 1e3 * time, ours.0.memory_usage());
    for case in cases(&flattened(mesh, &places), options.side, |ray| ours.closest(ray)) {
        if case.rays.is_empty() || !options.wants(&case) {
            continue;
        }
        let mut tracers = vec![single!("Dürer", &ours, case.any)];
        if let Some((scene, _)) = &theirs {
            tracers.push(single!("Embree high", scene, case.any));
        }
        let count = |ray: &Ray, counts: &mut TraversalStats| match case.any {
            false => drop(ours.0.closest_counting(ray, counts)),
            true => drop(ours.0.occluded_counting(ray, counts)),
        };
        one_case(&case, &count, &tracers, options, ratios);
    }
    println!();
}

/// Dürer's BVH over instances with the interface of the other tracers, and the number of triangles
/// of an instance.
struct DurerInstances(InstanceBvh, u32);

impl DurerInstances {
    #[inline]
    fn closest(&self, ray: &Ray) -> BenchHit {
        let found = |hit: InstanceHit| BenchHit { t: hit.t, triangle: hit.instance * self.1 + hit.triangle };
        self.0.closest(ray).map_or(BenchHit::NONE, found)
    }
    #[inline]
    fn occluded(&self, ray: &Ray) -> bool {
        self.0.occluded(ray)
    }
}

/// Returns transforms to the cells of a cube. Each cell is about as large as the mesh.
fn instance_transforms(mesh: &Mesh, count: u32) -> Vec<DAffine3> {
    let side = (1..).find(|side| side * side * side >= count).expect("some cube is large enough");
    let (center, size) = (mesh.bounds().center().as_dvec3(), f64::from(mesh.bounds().size().max_element()));
    let place = |i: u32| {
        let cell = DVec3::new(f64::from(i % side), f64::from(i / side % side), f64::from(i / side / side));
        let random = |dimension: u32| random_2d(5, i, 0, 0, dimension).as_dvec2();
        let (turns, stretch) = (6.0 * random(0), 0.6 + 0.6 * random(1));
        let mut matrix = DMat3::from_rotation_y(turns.x) * DMat3::from_rotation_x(turns.y);
        // Stretch along one axis and shear.
        matrix *= DMat3::from_diagonal(DVec3::new(stretch.x, stretch.y, 0.9));
        matrix.y_axis += 0.3 * random(2).x * matrix.x_axis;
        DAffine3 { matrix3: matrix, translation: size * cell - matrix * center }
    };
    (0..count).map(place).collect()
}

/// Returns all instances as a single mesh, for which rays are generated.
fn flattened(mesh: &Mesh, places: &[DAffine3]) -> Mesh {
    let place =
        |place: &DAffine3| mesh.vertices.iter().map(|v| place.transform_point3(v.as_dvec3()).as_vec3()).collect();
    let vertices: Vec<Vec<Vec3>> = places.iter().map(place).collect();
    let all = (0..places.len() as u32)
        .flat_map(|i| mesh.triangles.iter().map(move |t| t.map(|v| i * mesh.vertices.len() as u32 + v)));
    Mesh { name: mesh.name.clone(), vertices: vertices.concat(), triangles: all.collect() }
}

fn one_case(
    case: &RayCase,
    count: &dyn Fn(&Ray, &mut TraversalStats),
    tracers: &[Tracer],
    options: &Options,
    ratios: &mut Vec<f64>,
) {
    let mut found: Vec<Vec<BenchHit>> = vec![vec![BenchHit::NONE; case.rays.len()]; tracers.len()];
    let mut seconds = vec![Vec::new(); tracers.len()];
    for round in 0..options.rounds {
        for (i, tracer) in tracers.iter().enumerate() {
            // Run the other crates only twice: they are slow and serve only for orientation.
            if round >= 2 && !tracer.name.starts_with(['D', 'E']) {
                continue;
            }
            seconds[i].push(time(tracer, &case.rays, &mut found[i], options.threads));
        }
    }
    let rates: Vec<f64> = seconds.iter_mut().map(|seconds| case.rays.len() as f64 / median(seconds) / 1e6).collect();
    let rate = |name: &str| tracers.iter().position(|t| t.name == name).map(|i| rates[i]);
    let mut counts = TraversalStats::default();
    case.rays.iter().for_each(|ray| count(ray, &mut counts));
    let per_ray = |n: u64| n as f64 / case.rays.len() as f64;
    print!("  {:<9}", case.name);
    for (tracer, rate) in tracers.iter().zip(&rates) {
        print!(" {} {rate:<6.2}", tracer.name);
    }
    if let Some(theirs) = rate("Embree high").map(|high| rate("Embree medium").map_or(high, |medium| medium.max(high)))
    {
        ratios.push(rates[0] / theirs);
        print!(" | ratio {:.2}", rates[0] / theirs);
    }
    if let (Some(packets), Some(batch)) = (rate("Embree 16-wide"), rate("Dürer batch")) {
        print!(", batch to packets {:.2}", batch / packets);
    }
    print!(" | nodes {:.1}, tests {:.1} per ray", per_ray(counts.nodes), per_ray(counts.primitive_tests));
    let differ: Vec<String> = (1..tracers.len())
        .map(|i| (tracers[i].name, differences(&found[0], &found[i])))
        .filter(|(_, n)| *n > 0)
        .map(|(name, n)| format!("{name} {n}"))
        .collect();
    println!("{}{}", if differ.is_empty() { "" } else { " | results that differ: " }, differ.join(", "));
}

/// Times builds with two qualities of Embree and three presets of Dürer, in alternation. Returns
/// the scenes of Embree.
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
        for (i, (_, preset)) in BuildQuality::NAMES.into_iter().enumerate() {
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
    for ((name, _), (tree, time)) in BuildQuality::NAMES.iter().zip(trees.iter().zip(times.drain(2..))) {
        print!("; ours {name} {time:.1} ms, {:.0} B, cost {:.1}", of(tree.memory_usage()), tree.sah_cost());
    }
    println!(" (bytes per triangle)");
    scenes
}
