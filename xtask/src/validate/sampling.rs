//! White furnace tests of materials, and chi-square tests of sampling against pdfs.

use super::Table;
use super::measure::world;
use anyhow::Result;
use durer::bsdf::validation::{self, DirectionGrid, Furnace, FurnaceView, PdfComparison};
use durer::bsdf::warp;
use durer::math::{Ray64, Vec2, Vec3, fp};
use durer::medium::HenyeyGreenstein;
use durer::world::World;
use durer::world::emitters::Receiver;

const ROUGHNESSES: [f32; 7] = [0.0, 0.05, 0.1, 0.3, 0.5, 0.8, 1.0];
const COSINES: [f32; 5] = [0.999, 0.7, 0.4, 0.2, 0.1];

/// Adds the table of white furnace tests.
pub fn furnaces(table: &mut Table) {
    table.head(
        "Energy conservation",
        "White furnace test: a white, non-absorbing material in uniform light of radiance 1 must reflect radiance 1. The columns\n\
         give the minimum and maximum over seven roughnesses and five angles from 3 to 84 degrees. A row passes if all values are\n\
         1 within 0.2 % plus three standard errors (2^18 samples each).",
        "material|>minimum|>maximum",
    );
    let smooth = validation::with_films().into_iter().map(|(name, material)| (format!("{name}, smooth"), material, 1));
    let all =
        validation::lossless().into_iter().map(|(name, material)| (name.to_string(), material, ROUGHNESSES.len()));
    for (name, material, count) in all.chain(smooth) {
        let furnace = Furnace::new(&material);
        let (mut least, mut most, mut right) = (f64::MAX, f64::MIN, true);
        for (roughness, cosine) in ROUGHNESSES[..count].iter().flat_map(|&r| COSINES.map(|cosine| (r, cosine))) {
            let (mean, error) = furnace.albedo(roughness, cosine, 1 << 18);
            (least, most) = (least.min(mean), most.max(mean));
            if (mean - 1.0).abs() > 0.002 + 3.0 * error {
                right = false;
                println!("  {name}, roughness {roughness}, cosine {cosine}: {mean:.5} ± {error:.5}");
            }
        }
        table.row(&format!("| {name} | {least:.4} | {most:.4} |"), right);
    }
    brushed(table);
}

/// Adds furnace tests of anisotropic materials, over anisotropy, azimuth and side.
fn brushed(table: &mut Table) {
    for (name, material) in validation::brushed() {
        let furnace = Furnace::new(&material);
        let (mut least, mut most, mut right) = (f64::MAX, f64::MIN, true);
        let sides = if material.base_metalness > 0.0 { &[false][..] } else { &[false, true] };
        let seen = ROUGHNESSES[1..].iter().flat_map(|&r| COSINES.map(|c| (r, c)));
        let seen = seen.flat_map(|seen| [0.3, 0.6, 0.9, 1.0].map(|anisotropy| (seen, anisotropy)));
        for ((roughness, cosine), anisotropy) in seen {
            for (&inside, turn) in sides.iter().flat_map(|side| [0.0, 0.07, 0.2, 0.25].map(|turn| (side, turn))) {
                let from = FurnaceView { roughness, anisotropy, cosine, turn, inside, eta: None };
                let (mean, error) = furnace.albedo_for(from, 1 << 14);
                (least, most) = (least.min(mean), most.max(mean));
                if (mean - 1.0).abs() > 0.002 + 3.0 * error {
                    right = false;
                    println!("  {name}, {from:?}: {mean:.5} ± {error:.5}");
                }
            }
        }
        table.row(&format!("| {name} | {least:.4} | {most:.4} |"), right);
    }
}

/// Area lights as seen from the origin. Cylinders are missing, because their pdf is unbounded at
/// the silhouette, so that sums over cells are too inaccurate. Unit tests compare them with random
/// sampling instead.
const LIGHTS: [(&str, &str); 6] = [
    ("sphere", "Sphere { center 0.5 2 1 radius 0.7 }"),
    ("disc", "Disc { center 0 2 0.5 normal 0.3 -1 0 radius 1.5 }"),
    ("rectangle", "Rectangle { corner -1 2 0 edge0 3 0 0 edge1 0 0 1 }"),
    ("triangle", "Triangle { vertex0 -1 2 -1 vertex1 2 2 -1 vertex2 2 1.5 2 }"),
    (
        "five lights in the light tree",
        "Sphere { center 0.5 2 1 radius 0.4 } Disc { center -3 1 0 normal 1 -0.3 0 radius 1 } Rectangle { corner 1 3 -2 edge0 1 0 0 edge1 0 0 1 } \
         Sphere { center 2 1.5 -1 radius 0.2 } Triangle { vertex0 -1 2 -3 vertex1 2 2 -3 vertex2 2 1.5 -2 }",
    ),
    ("sphere around the point", "Sphere { center 0.4 0.2 0.1 radius 2 }"),
];

/// Adds the table of chi-square tests of sampled directions.
pub fn densities(table: &mut Table) -> Result<()> {
    const CELLS: DirectionGrid = DirectionGrid { rows: 80, columns: 160, samples: 1_000_000, fine: 12 };
    let mut rows: Vec<(String, PdfComparison)> = Vec::new();
    for (name, lobe) in validation::non_delta_lobes() {
        for (cosine, turn) in [(0.95, 0.1), (0.6, 0.7), (0.25, 0.35)] {
            let verdict = CELLS.lobe(11, lobe, warp::polar(cosine, turn));
            rows.push((format!("{name}, viewed at cosine {cosine}"), verdict));
        }
    }
    for anisotropy in [-0.4, 0.0, 0.3, 0.85] {
        let (phase, before) = (HenyeyGreenstein { anisotropy }, warp::polar(0.3, 0.2));
        let verdict = CELLS.compare(12, |_, u| Some(phase.sample(before, u)), |wi| phase.value(before, wi));
        rows.push((format!("Henyey-Greenstein, mean cosine {anisotropy}"), verdict));
    }
    let light = "PrincipledMaterial { baseColor 0 0 0 specularWeight 0 emissionLuminance 1 walls thin }";
    // The pdf of an area light drops to zero at its edge, so use finer integration there.
    let finely = DirectionGrid { fine: 40, ..CELLS };
    for (name, group) in LIGHTS {
        let world = world(name, "", light, "", &format!("MaterialIndex 0 {group}"))?;
        rows.push((format!("light: {name}"), of_lights(&world, finely)));
    }
    for (name, background) in [("clear sky", "sun 1 1 0.3"), ("overcast sky", "cieSky 16")] {
        let world = world(name, background, light, "", "MaterialIndex 0 Sphere { center 0 -50 0 radius 0.001 }")?;
        if let Some(environment) = world.environment() {
            let sample = |_, u| environment.sample(u).map(|(wi, ..)| rotated(wi));
            rows.push((name.into(), finely.compare(14, sample, |wi| environment.pdf(back(wi)))));
        }
    }
    // Sidak's correction: 1 - 0.99^(1/n), which is -ln 0.99 / n up to second order.
    let most = deviate_of(0.010_050_3 / rows.len() as f64);
    table.head(
        "Sampled directions and their pdf",
        &format!(
            "Chi-square test with 10^6 samples in 80 x 160 cells of equal solid angle. The last column is the test result, converted\n\
             to a standard normal deviate. A row passes if this deviate is below {most:.2}, which gives all {} tests together a\n\
             significance level of 0.01 (Šidák correction). The integral of the pdf is 1 minus the fraction of samples below the\n\
             surface.",
            rows.len()
        ),
        "sampler|>integral of pdf|>deviate",
    );
    for (name, PdfComparison { deviate, density }) in rows {
        table.row(&format!("| {name} | {density:.4} | {deviate:+.2} |"), deviate < most && density < 1.002);
    }
    Ok(())
}

/// Rotates a direction, because cells are arranged around the z axis but skies around the y axis.
fn rotated(v: Vec3) -> Vec3 {
    Vec3::new(v.x, -v.z, v.y)
}

fn back(v: Vec3) -> Vec3 {
    Vec3::new(v.x, v.z, -v.y)
}

fn of_lights(world: &World, cells: DirectionGrid) -> PdfComparison {
    let point = Vec3::ZERO.as_dvec3();
    let to = Receiver { point, n: Vec3::ZERO, is_seen: true };
    let sample = |choice: f32, u: Vec2| {
        let choice = world.emitters().choose(world, &to, choice)?;
        Some(rotated(world.emitters().sample(world, &choice, &to, u)?.wi))
    };
    let pdf = |wi: Vec3| {
        let dir = back(wi);
        let mut ray = Ray64::new(point, dir, 0.0, f32::INFINITY);
        let (mut sum, mut met) = (0.0, Vec::new());
        // Occluded emitters are sampled too, but not the far side of an emitter.
        for _ in 0..16 {
            let Some(hit) = world.closest(&ray, &mut ()) else { break };
            if !met.contains(&hit.object) {
                sum += world.emitters().pdf_of_hit(world, &hit, &to, dir, hit.t);
                met.push(hit.object);
            }
            ray.rounded.t_min = hit.t;
        }
        sum
    };
    cells.compare(13, sample, pdf)
}

/// Returns the normal deviate with a given upper tail probability.
fn deviate_of(probability: f64) -> f64 {
    // Integrate the upper tail up to 10 with Simpson's rule.
    let tail = |from: f64| {
        const STEPS: u32 = 2_000;
        let h = (10.0 - from) / f64::from(STEPS);
        let at = |i: u32| {
            let x = from + h * f64::from(i);
            f64::from(fp::exp((-0.5 * x * x) as f32))
        };
        let weight = |i: u32| {
            if i == 0 || i == STEPS {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        (0..=STEPS).map(|i| weight(i) * at(i)).sum::<f64>() * h / 3.0 / (2.0 * std::f64::consts::PI).sqrt()
    };
    let (mut low, mut high) = (0.0, 8.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        (low, high) = if tail(middle) > probability { (middle, high) } else { (low, middle) };
    }
    low
}
