//! Many lamps: what a picture of a hundred thousand costs beside one of ten, at equal error.

use anyhow::Result;
use durer::integrator::{Path, Settings, Transport};
use durer::math::Vec3;
use durer::render::Job;
use durer::sampler::{SampleId, random_2d};
use durer::world::World;
use std::fmt::Write as _;
use std::process::ExitCode;
use std::time::Instant;

/// How much more a hundred thousand may cost.
const MOST: f64 = 2.0;

/// Points along each side of the floor, and samples of each in a round.
const SIDE: u32 = 24;
const SAMPLES: u32 = 64;

/// A hall of 20 m x 20 m with columns and some small lamps that face down at many heights: together
/// as bright as ten of 1000 cd/m^2.
fn hall(lamps: u32) -> Result<World> {
    let bright = 1_000.0 * 10.0 / f64::from(lamps);
    let mut text = format!(
        "PerspectiveCamera {{ center 0 2 9 direction 0 0 -1 up 0 1 0 angle 60 }} Background {{ color 0 0 0 }}\nMaterials {{ \
         PrincipledMaterial {{ baseColor 0.5 0.5 0.5 specularWeight 0 }} \
         PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance {bright} }} }}\nGroup {{\nMaterialIndex 0 \
         Plane {{ normal 0 1 0 offset 0 }}\n"
    );
    for i in 0..16 {
        let (x, z) = (f64::from(i % 4) * 5.0 - 7.4, f64::from(i / 4) * 5.0 - 7.4);
        writeln!(text, "Cylinder {{ base {x} 0 {z} top {x} 4 {z} radius 0.3 }}")?;
    }
    text += "MaterialIndex 1\n";
    for i in 0..lamps {
        let (u, v) = (random_2d(5, 0, 0, i, 0), random_2d(5, 0, 0, i, 1));
        let (x, y, z) = (20.0 * u.x - 10.0, 3.0 + v.x, 20.0 * u.y - 10.0);
        writeln!(text, "Rectangle {{ corner {x} {y} {z} edge0 0.05 0 0 edge1 0 0 0.05 }}")?;
    }
    text += "}\n";
    crate::world("hall.txt", &text)
}

/// What was found of one hall so far.
struct Found {
    world: World,
    seconds: f64,
    /// The sums of samples and of their squares, for each point.
    sums: Vec<(f64, f64)>,
    samples: u32,
}

impl Found {
    fn round(&mut self) {
        let settings = Settings { bounces: 1, ..Job::default().settings };
        let path = Path::new(&self.world, settings, Transport::default());
        let start = Instant::now();
        for (number, sums) in (0..).zip(&mut self.sums) {
            let place = |i: u32| 18.0 * (i as f32 + 0.5) / SIDE as f32 - 9.0;
            let point = Vec3::new(place(number % SIDE), 0.001, place(number / SIDE)).as_dvec3();
            for sample in self.samples..self.samples + SAMPLES {
                let id = SampleId::new(0, (number, 0), sample);
                let value = f64::from(path.irradiance(point, Vec3::Y, id, &mut ()).y);
                *sums = (sums.0 + value, sums.1 + value * value);
            }
        }
        self.seconds += start.elapsed().as_secs_f64();
        self.samples += SAMPLES;
    }

    /// Seconds times the square of the relative error: what an error costs.
    fn cost(&self) -> (f64, f64) {
        let n = f64::from(self.samples);
        let variance = |&(sum, squares): &(f64, f64)| {
            let mean = sum / n;
            ((squares / n - mean * mean) / n, mean * mean)
        };
        let (off, bright) = self.sums.iter().map(variance).fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
        let relative = off / bright;
        (relative.sqrt(), self.seconds * relative)
    }
}

pub fn run() -> Result<ExitCode> {
    let found = |lamps| {
        let sums = vec![(0.0, 0.0); (SIDE * SIDE) as usize];
        hall(lamps).map(|world| Found { world, seconds: 0.0, sums, samples: 0 })
    };
    let (mut few, mut many) = (found(10)?, found(100_000)?);
    // In turns, so that both meet the same machine.
    for _ in 0..8 {
        few.round();
        many.round();
    }
    let ((few_error, few_cost), (many_error, many_cost)) = (few.cost(), many.cost());
    println!("    10 lamps: {:.2} s, relative error {few_error:.4}", few.seconds);
    println!("100000 lamps: {:.2} s, relative error {many_error:.4}", many.seconds);
    let ratio = many_cost / few_cost;
    println!("at equal error a hundred thousand take {ratio:.2} x the time of ten");
    Ok(if ratio <= MOST { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
