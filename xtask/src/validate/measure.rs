//! Compares measurements of the path tracer with known answers.

use super::Table;
use super::cases::{Case, Quantity, cases};
use anyhow::Result;
use durer::integrator::{Integrate, Path, PathOptions, RenderSettings};
use durer::math::Ray;
use durer::render::Job;
use durer::sampler::{SampleId, random_2d};
use durer::world::World;

/// Compiles a scene in Dürer's own dialect from the texts of its sections.
pub fn world(name: &str, background: &str, materials: &str, lights: &str, group: &str) -> Result<World> {
    let text = format!(
        "PerspectiveCamera {{ center 0 1 9 direction 0 0 -1 up 0 1 0 angle 30 }}\nBackground {{ color 0 0 0 {background} }}\n\
         Lights {{ {lights} }}\nMaterials {{ {materials} }}\nGroup {{ {group} }}\n"
    );
    crate::world(name, &text)
}

/// Returns one sample of a case's quantity.
fn one(path: &Path, what: &Quantity, sample: u32) -> f64 {
    let id = SampleId::new(0, (0, 0), sample);
    match what {
        Quantity::Illuminance(point, normal) => f64::from(path.irradiance(point.as_dvec3(), *normal, id, &mut ()).y),
        Quantity::Luminance(origin, dir) => {
            f64::from(path.radiance(&Ray::new(*origin, dir.normalize()), id, &mut ()).y)
        }
        Quantity::Flux(patches) => {
            // Choose a uniform point on all parallelograms.
            let area = |patch: &[durer::math::Vec3; 3]| f64::from(patch[1].cross(patch[2]).length());
            let all: f64 = patches.iter().map(area).sum();
            let u = random_2d(99, 0, 0, sample, 0);
            let mut rest = f64::from(random_2d(99, 0, 0, sample, 1).x) * all;
            let last = &patches[patches.len() - 1];
            let found = patches.iter().find(|patch| {
                rest -= area(patch);
                rest < 0.0
            });
            let [corner, a, b] = found.unwrap_or(last);
            let point = (*corner + u.x * *a + u.y * *b).as_dvec3();
            all * f64::from(path.irradiance(point, a.cross(*b).normalize(), id, &mut ()).y)
        }
    }
}

/// Returns the mean of many samples, and its standard error.
fn measured(case: &Case, samples: u32) -> Result<(f64, f64)> {
    let world = world(case.name, &case.background, &case.materials, &case.lights, &case.group)?;
    let settings = RenderSettings { bounces: case.bounces, ..Job::default().settings };
    let path = Path::new(&world, settings, PathOptions::default());
    let (mut sum, mut squares) = (0.0, 0.0);
    for sample in 0..samples {
        let value = one(&path, &case.what, sample);
        (sum, squares) = (sum + value, squares + value * value);
    }
    let n = f64::from(samples);
    Ok((sum / n, ((squares / n - (sum / n) * (sum / n)).max(0.0) / n).sqrt()))
}

/// Adds the table that compares light with known answers.
pub fn light(table: &mut Table, samples: u32) -> Result<()> {
    table.head(
        "Light",
        "Each row compares a result of the path tracer with a known answer. The standard error assumes independent samples; the\n\
         error of Dürer's stratified samples is smaller. A row passes if the difference is at most three standard errors plus\n\
         0.1 %. If the formula is an integral without a closed form, the answer is computed by quadrature in double precision.\n\
         \n\
         A number in brackets is the section of CIE 171:2006 with an analytical case that tests the same physics, but with\n\
         different dimensions and values. Scenes and formulas are in `xtask/src/validate/cases.rs`.",
        "case|formula|>answer|>measured|>difference",
    );
    for case in cases() {
        let (mean, error) = measured(&case, samples)?;
        let off = mean / case.answer - 1.0;
        let right = (mean - case.answer).abs() <= 3.0 * error + 0.001 * case.answer;
        let Case { name, formula, what, answer, .. } = &case;
        let unit = what.unit();
        let row =
            format!("| {name} | {formula} | {answer:.3} {unit} | {mean:.3} ± {error:.3} | {:+.3} % |", 100.0 * off);
        table.row(&row, right);
    }
    Ok(())
}
