//! Compares the cost of rendering a room with a hundred thousand lights to that with ten lights, at
//! equal error.
//!
//! In both rooms the lights have the same total area and power, and they are outside the picture.
//! Visible emitters far smaller than a pixel would dominate the noise, whatever the light sampling.

use anyhow::{Context, Result};
use durer::film::Filter;
use durer::image::Image;
use durer::integrator::{IntegratorKind, RenderSettings};
use durer::math::Color;
use durer::render::{Control, Job, PixelRect, Sampling, render};
use durer::sampler::random_2d;
use durer::world::World;
use std::fmt::Write as _;
use std::process::ExitCode;
use std::time::Instant;

/// Maximum acceptable ratio of the costs.
const MAX_COST_RATIO: f64 = 2.0;

/// Number of random placements of the lights in each room, because the noise of ten lights depends
/// on their positions.
const PLACEMENTS: u64 = 4;

/// Number of pictures per placement, each with another seed.
const RUNS: u64 = 3;

/// Rooms of the corpus, with the bounds of the space inside.
const ROOMS: [(&str, [f64; 3], [f64; 3]); 2] = [
    ("kitchen.ply", [-1.930758, -0.034231, -2.479913], [3.614574, 2.523191, 2.593479]),
    ("hall.ply", [-3.535412, -2.480083, -24.03392], [48.30188, 16.92997, 24.325836]),
];

/// Builds a room with square lights in its upper middle that face down.
fn room((name, low, high): (&str, [f64; 3], [f64; 3]), lights: u32, placing: u64) -> Result<World> {
    let at = |axis: usize, share: f64| low[axis] + share * (high[axis] - low[axis]);
    let size = |axis: usize| high[axis] - low[axis];
    let [right, up, forward] = [0.8, -0.1, 0.59];
    let eye = [(0, right), (1, up), (2, forward)].map(|(axis, way)| at(axis, 0.5 - 0.15 * way));
    let side = (0.0016 * size(0) * size(2) / f64::from(lights)).sqrt();
    let [x, y, z] = eye;
    let mut text = format!(
        "PerspectiveCamera {{ center {x} {y} {z} direction {right} {up} {forward} up 0 1 0 angle 70 }}\n\
         Background {{ color 0 0 0 }}\n\
         Materials {{ PrincipledMaterial {{ baseColor 0.6 0.6 0.6 specularWeight 0 }}\n\
         PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 200 }} }}\n\
         Group {{ MaterialIndex 0 TriangleMesh {{ obj_file {name} }}\nMaterialIndex 1\n"
    );
    for i in 0..lights {
        let (u, v) = (random_2d(placing, 0, 0, i, 0), random_2d(placing, 0, 0, i, 1));
        let share = |u: f32, from: f64, to: f64| from + f64::from(u) * (to - from);
        let [x, y, z] = [at(0, share(u.x, 0.2, 0.8)), at(1, share(u.y, 0.7, 0.8)), at(2, share(v.x, 0.2, 0.8))];
        writeln!(text, "Rectangle {{ corner {x} {y} {z} edge0 {side} 0 0 edge1 0 0 {side} }}")?;
    }
    text += "}\n";
    // Resolve the path of the mesh relative to the corpus.
    let path = crate::corpus().join("meshes/room.txt");
    crate::world(path.to_str().context("the path of the corpus is not Unicode")?, &text)
}

/// Renders of one room with different seeds, and the minimum render time, from which the cost
/// follows.
struct RoomResult {
    world: World,
    seconds: f64,
    pictures: Vec<Image>,
}

impl RoomResult {
    fn new(world: World) -> Result<Self> {
        let found = RoomResult { world, seconds: f64::INFINITY, pictures: Vec::new() };
        // Render once before timing, because of one-time initialisation.
        found.picture(0, 1)?;
        Ok(found)
    }

    fn picture(&self, seed: u64, samples: u32) -> Result<Image> {
        let settings = RenderSettings { bounces: 8, ..Job::default().settings };
        let sampling = Sampling::Filtered { samples, filter: Filter::Box { radius: 0.5 } };
        let crop = Some(PixelRect { left: 0, top: 70, width: 128, height: 58 });
        let job = Job {
            width: 128,
            height: 128,
            crop,
            seed,
            sampling,
            settings,
            method: IntegratorKind::PATH,
            ..Job::default()
        };
        let mut made = render(&self.world, &job, &Control { threads: Some(1), ..Control::default() })?;
        Ok(std::sync::Arc::unwrap_or_clone(made.layers.swap_remove(0).image))
    }

    fn run(&mut self, seed: u64) -> Result<()> {
        let start = Instant::now();
        let picture = self.picture(seed, 64)?;
        self.seconds = self.seconds.min(start.elapsed().as_secs_f64());
        self.pictures.push(picture);
        Ok(())
    }

    /// Returns the relative error of a picture, and the cost (seconds times squared error). The
    /// error is computed from pairs of pictures, whose difference has twice the variance.
    fn cost(&self) -> (f64, f64) {
        let (mut squares, mut pairs, mut sum, mut count) = (0.0, 0.0, 0.0, 0.0);
        for (i, a) in self.pictures.iter().enumerate() {
            sum += a.pixels.iter().map(|pixel| f64::from(pixel.element_sum())).sum::<f64>();
            count += 3.0 * a.pixels.len() as f64;
            for b in &self.pictures[..i] {
                let square = |(a, b): (&Color, &Color)| f64::from((*a - *b).length_squared());
                squares += a.pixels.iter().zip(&b.pixels).map(square).sum::<f64>() / (3.0 * a.pixels.len() as f64);
                pairs += 1.0;
            }
        }
        let mean = sum / count;
        let relative = 0.5 * squares / pairs / (mean * mean);
        (relative.sqrt(), self.seconds * relative)
    }
}

/// Measures the cost for each room and prints the ratio.
pub fn run() -> Result<ExitCode> {
    let mut all_hold = true;
    for given in ROOMS {
        let (mut few_cost, mut many_cost) = (0.0, 0.0);
        for placing in 0..PLACEMENTS {
            let found = |lights| RoomResult::new(room(given, lights, placing)?);
            let (mut few, mut many) = (found(10)?, found(100_000)?);
            // Alternate between both rooms, so that they see the same machine load.
            for seed in 1..=RUNS {
                few.run(seed)?;
                many.run(seed)?;
            }
            for (found, lights, cost) in [(few, 10, &mut few_cost), (many, 100_000, &mut many_cost)] {
                let (error, own) = found.cost();
                *cost += own;
                println!("{}, {lights} lights: {:.2} s, relative error {error:.4}", given.0, found.seconds);
            }
        }
        let ratio = many_cost / few_cost;
        println!("at equal error, a hundred thousand lights take {ratio:.2} x the time of ten");
        all_hold &= ratio <= MAX_COST_RATIO;
    }
    Ok(if all_hold { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
