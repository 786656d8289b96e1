//! Implements `durer measure`, which computes illuminance and irradiance at points.

use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::open::{load_options, open};
use crate::options::{IntegratorArgs, SceneArgs};
use crate::report;
use crate::terminal::print_line;
use clap::Args;
use durer::diag::Diagnostic;
use durer::integrator::{Integrate, Integrator, IntegratorContext, IntegratorKind, RenderSettings};
use durer::math::{Color, LUMINANCE, Ray64, Vec3};
use durer::options::vector;
use durer::render::Job;
use durer::sampler::SampleId;
use durer::scene::Axis;
use durer::scene::defaults::ModelAxes;
use durer::threads;
use durer::world::World;
use rayon::prelude::*;
use std::path::PathBuf;

/// Measure illuminance and irradiance at points in a scene, as CSV with standard errors
#[derive(Args)]
#[command(mut_arg("at", |moment| moment.long("moment")), after_help = "Examples:
  durer measure room.txt --at 0,0.8,0
  durer measure room.txt --at 0,0.8,0 --at 1,0.8,0 --normal 0,1,0 --samples 16384
  durer measure room.txt --grid 0,0.8,0:4,0,0:0,0,6:8x12 > desk.csv
  durer measure lens.txt --at 0,0,0 --integrator photons --samples 64

A grid is given by a corner, two edges that start at the corner, and the number of points along each edge. The points are
the centres of its cells. Without --normal, a grid measures light from above; the normal of an upright grid is the cross
product of its second and first edges.
Illuminance is in lux if the scene's light is in cd/m^2 (`emissionLuminance`, `sun`), and in Radiance scenes. Irradiance has
one value per colour channel. Light that arrives from behind the normal is ignored. The standard errors assume independent
samples, so the actual errors are smaller. Lights that only BSDF sampling can find, for example in mirrors, increase the
standard errors.")]
pub struct MeasureArgs {
    /// Scene or model file
    pub scene: PathBuf,
    /// Point to measure; can be given several times
    #[arg(id = "point", long = "at", value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub points: Vec<Vec3>,
    /// Normal of the receiving surface [default: upwards]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub normal: Option<Vec3>,
    /// Grid of points: a corner, two edges, and the number of points along each edge
    #[arg(long, value_name = "CORNER:EDGE:EDGE:NxM", value_parser = grid, allow_hyphen_values = true)]
    pub grid: Vec<Grid>,
    /// Number of threads [default: one per processor]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    #[command(flatten)]
    pub reading: SceneArgs,
    /// Maximum number of scattering events before light reaches the point
    #[arg(long, default_value_t = durer::job::PATH_BOUNCES, value_parser = clap::value_parser!(u32).range(0..=256))]
    pub bounces: u32,
    #[command(flatten)]
    pub method: IntegratorArgs,
    /// Samples per point
    #[arg(long, default_value_t = 4096, value_parser = clap::value_parser!(u32).range(2..=1 << 24))]
    pub samples: u32,
    /// Seed of the random number generator
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
}

/// Grid of measuring points on a parallelogram, as given by `--grid`.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    corner: Vec3,
    edges: [Vec3; 2],
    counts: [u32; 2],
}

/// Largest allowed number of measuring points.
const MAX_POINTS: usize = 1 << 20;

fn grid(text: &str) -> Result<Grid, String> {
    let wanted = || "expected CORNER:EDGE:EDGE:NxM, for example 0,0.8,0:4,0,0:0,0,6:8x12".to_string();
    let [corner, a, b, counts] = text.split(':').collect::<Vec<_>>()[..] else { return Err(wanted()) };
    let (n, m) = counts.split_once('x').ok_or_else(wanted)?;
    let count = |word: &str| word.parse().ok().filter(|n| (1..=4096).contains(n)).ok_or_else(wanted);
    Ok(Grid { corner: vector(corner)?, edges: [vector(a)?, vector(b)?], counts: [count(n)?, count(m)?] })
}

impl Grid {
    fn points(&self) -> impl Iterator<Item = Vec3> {
        let Grid { corner, edges: [a, b], counts: [n, m] } = *self;
        let share = |i: u32, n: u32| (i as f32 + 0.5) / n as f32;
        (0..n * m).map(move |i| corner + share(i % n, n) * a + share(i / n, m) * b)
    }
}

/// Sums over the samples at one measuring point, used to compute the mean and its standard error.
#[derive(Clone, Default)]
struct Sums {
    light: [f64; 3],
    bright: f64,
    squares: f64,
}

impl Sums {
    fn add(&mut self, light: Color, lumens: Color) {
        let brightness = f64::from(light.dot(lumens));
        self.light = std::array::from_fn(|i| self.light[i] + f64::from(light[i]));
        self.bright += brightness;
        self.squares += brightness * brightness;
    }

    /// Returns the mean irradiance per channel, the mean illuminance, and the standard error of the
    /// mean illuminance. `rare` is the largest value of a light that only BSDF sampling can find.
    /// One more sample of this kind would raise the mean by `rare` divided by the number of
    /// samples, so the error includes that amount.
    fn mean(&self, samples: u32, rare: f64) -> ([f64; 3], f64, f64) {
        let n = f64::from(samples);
        let mean = self.bright / n;
        let variance = (self.squares / n - mean * mean).max(0.0) / n;
        let error = (variance + (rare / n) * (rare / n)).sqrt();
        (self.light.map(|sum| sum / n), mean, error)
    }
}

/// Returns the first point that is not on a surface. For such a point, a short ray along its normal
/// hits nothing.
fn in_the_air(world: &World, points: &[(Vec3, Vec3)]) -> Option<Vec3> {
    let bounds = world.bounds();
    let size = (bounds.max - bounds.min).length();
    let near = 0.01 * if size.is_finite() { size } else { 1.0 };
    let lies_on_a_surface = |(point, normal): &&(Vec3, Vec3)| {
        let from = point.as_dvec3() + f64::from(near) * normal.as_dvec3();
        world.closest(&Ray64::new(from, -*normal, 0.0, 2.0 * near), &mut ()).is_some()
    };
    points.iter().find(|entry| !lies_on_a_surface(entry)).map(|entry| entry.0)
}

fn vector_of(v: Vec3) -> String {
    format!("{},{},{}", v.x, v.y, v.z)
}

/// Runs `durer measure`.
pub fn run(args: &MeasureArgs) -> Result<(), Failure> {
    let mut options = load_options(&args.reading);
    // Measure only the light of the scene itself.
    options.scene_defaults.own_light = options.scene_defaults.lighting.is_none();
    let compiled = open(&args.scene, &options, false, &mut FileRegistry::default())?;
    let scene = &compiled.loaded.scene;
    let up = ModelAxes::new(scene.up.unwrap_or(Axis::Y)).up.as_vec3();
    let lumens = compiled.world.lumens().unwrap_or(LUMINANCE);
    let grids = args.grid.iter().flat_map(|grid| {
        let normal = grid.edges[1].cross(grid.edges[0]).normalize_or(up);
        let normal = if normal.dot(up) < 0.0 { -normal } else { normal };
        grid.points().map(move |point| (point, normal))
    });
    let own = args.points.iter().map(|&point| (point, up)).chain(grids);
    let mut points: Vec<(Vec3, Vec3)> = own.take(MAX_POINTS + 1).collect();
    if points.is_empty() || points.len() > MAX_POINTS {
        return Err(invalid_input(format!(
            "the number of points must be from 1 to {MAX_POINTS}: pass --at X,Y,Z or --grid"
        )));
    }
    if let Some(normal) = args.normal {
        let Some(normal) = normal.try_normalize() else { return Err(invalid_input("--normal must not be 0,0,0")) };
        points.iter_mut().for_each(|entry| entry.1 = normal);
    }
    let settings = RenderSettings { bounces: args.bounces, ..Job::default().settings };
    let method = args.method.0.resolve_integrator(IntegratorKind::PATH).map_err(invalid_input)?;
    let context = IntegratorContext { world: &compiled.world, settings, cone: None, seed: args.seed, cancel: None };
    let (Integrator::Path(path) | Integrator::Photons(path)) = method.create(context) else {
        return Err(invalid_input("only path tracing can measure illuminance: set --integrator path or photons"));
    };
    if path.photons.is_some()
        && let Some(point) = in_the_air(&compiled.world, &points)
    {
        let message = format!(
            "photons are stored on surfaces, but {} is not on a surface: light from mirrors and glass would be missing",
            vector_of(point)
        );
        return Err(invalid_input(format!("{message}; use --integrator path, or add a surface there")));
    }
    let mut sums = vec![Sums::default(); points.len()];
    // Photons are traced again for every sample.
    let step = if method.prepares() { 1 } else { args.samples };
    threads::install(args.threads.map(usize::from), || {
        for first in (0..args.samples).step_by(step as usize) {
            path.prepare(first);
            sums.par_iter_mut().zip(&points).enumerate().for_each(|(number, (sums, &(point, normal)))| {
                for sample in first..first + step {
                    let id = SampleId::new(args.seed, (number as u32, 0), sample);
                    sums.add(path.irradiance(point.as_dvec3(), normal, id, &mut ()), lumens);
                }
            });
        }
    });
    let rare = f64::from(path.max_rare_contribution(|color| color.dot(lumens)));
    print_line("x,y,z,nx,ny,nz,illuminance,illuminance_error,irradiance_r,irradiance_g,irradiance_b");
    let mut missed = false;
    for ((point, normal), sums) in points.iter().zip(sums) {
        let (light, mean, error) = sums.mean(args.samples, rare);
        missed |= rare / f64::from(args.samples) > 0.01 * mean.max(error);
        let [p, n, c] = [*point, *normal, Color::from(light.map(|x| x as f32))].map(vector_of);
        print_line(&format!("{p},{n},{mean:.6},{error:.6},{c}"));
    }
    if missed {
        let message = "some lights (in mirrors or glass, on solids, or textured) are found only by BSDF sampling: the \
                       errors include the effect of one more sample of such a light; use more `--samples` or \
                       `--integrator photons`";
        report::note(&Diagnostic::warning(message).code("RARE_LIGHT"));
    }
    Ok(())
}
