//! Tests `durer compare` with wrong pictures from an independent path tracer.
//!
//! The pictures are noisy, so means over blocks of pixels are compared with their noise to find
//! out whether a mistake is visible.

mod scenes;
mod tracer;

use super::vector::Vec3;
use super::{Outcome, output, summary};
use anyhow::{Context, Result};
use scenes::{PathScene, SIDE};
use std::path::Path;
use std::process::Command;
use tracer::{PathTracer, Picture};

/// Samples per pixel of the reference and of the wrong pictures.
const SAMPLES: usize = 48;
/// Samples per pixel for comparing the two path tracers.
const MANY_SAMPLES: usize = 512;
/// Side of the blocks in pixels.
const BLOCK: usize = 4;
/// Number of standard errors beyond which a block differs.
const ERRORS: f64 = 4.0;
/// Smallest difference of a block's mean in display values that is visible.
const LEAST: f64 = 1.5 / 255.0;
/// Fraction of differing blocks from which a mistake is visible, and from which it is wrong to say
/// that the pictures differ only by noise.
const VISIBLE: f64 = 0.05;
const CLEARLY_VISIBLE: f64 = 0.15;
/// Fraction of the visible mistakes that should be identified.
const GOAL: f64 = 0.6;

/// Correct answer for a wrong picture.
#[derive(Clone, Copy)]
enum Answer {
    /// Names and values of rows in the library's table, any of which is correct.
    Rows(&'static [(&'static str, f64)]),
    /// The mean is correct and only the noise differs.
    Noise,
}
use Answer::{Noise, Rows};

/// A mistake, its correct answer, and its scenes. After the name of the scene follows the method
/// of the student: `nee` for light samples only, or `mis` for both strategies with weights.
type Mistake = (&'static str, Answer, &'static [&'static str]);

/// Correct answer for a mistake that the table of the library lacks.
const UNKNOWN: Answer = Rows(&[]);

const MISTAKES: &[Mistake] = &[
    ("no-cosine", Rows(&[("path-cosine", 0.0)]), &["box nee", "sky mis", "room mis"]),
    ("no-cosine-light", Rows(&[("path-cosine", 0.0)]), &["box nee", "room mis", "floor nee"]),
    ("cosine-twice", Rows(&[("path-cosine", 1.0)]), &["box nee", "sky mis", "room mis"]),
    ("no-pi", Rows(&[("path-no-pi", 0.0)]), &["box nee", "room mis"]),
    ("no-pi-light", Rows(&[("path-no-pi", 1.0)]), &["box nee", "sky mis", "room mis"]),
    ("no-pdf", Rows(&[("path-no-pdf", 0.0)]), &["box nee", "sky mis", "room mis"]),
    ("no-pdf-light", Rows(&[("path-no-pdf", 1.0)]), &["box nee", "sky mis", "room mis"]),
    ("other-pdf", Rows(&[("path-light-pdf", 0.0)]), &["box nee", "box mis", "sky mis", "room mis"]),
    ("uniform-pdf", Rows(&[("path-uniform", 1.0)]), &["box nee", "sky mis", "glass nee"]),
    ("uniform-directions", Rows(&[("path-uniform", 0.0)]), &["box nee", "sky mis", "glass nee"]),
    ("unweighted", Rows(&[("path-emission-twice", 0.0)]), &["sky mis", "room mis"]),
    ("emission-again", Rows(&[("path-emission-twice", 0.0)]), &["box nee", "glass nee"]),
    ("no-roulette", Rows(&[("path-roulette", 0.0)]), &["white nee"]),
    ("early-roulette", Rows(&[("path-roulette", 0.0)]), &["box nee", "room mis"]),
    ("roulette-per-channel", Rows(&[("path-roulette", 1.0)]), &["white nee", "white mis"]),
    ("no-distance", Rows(&[("path-light-factor", 0.0)]), &["box nee", "room mis", "floor nee"]),
    ("no-light-cosine", Rows(&[("path-light-factor", 1.0)]), &["box nee", "room mis", "floor nee"]),
    ("no-area", Rows(&[("path-light-factor", 2.0)]), &["box nee", "room nee", "room mis"]),
    ("no-choice", Rows(&[("path-light-factor", 3.0)]), &["room nee", "room mis", "floor nee"]),
    ("wrong-frame", Rows(&[("path-local-frame", 0.0)]), &["box nee", "sky mis"]),
    ("wrong-frame-y", Rows(&[("path-local-frame", 0.0)]), &["box nee", "room mis"]),
    ("depth-less", Rows(&[("path-depth", 0.0)]), &["box nee", "sky mis", "room mis"]),
    ("depth-more", Rows(&[("path-depth", 2.0)]), &["room nee", "room mis"]),
    ("direct-only", Rows(&[("path-depth", 3.0)]), &["box nee", "glass nee"]),
    ("gamma-first", Rows(&[("path-mean", 1.0)]), &["box nee", "sky mis", "glass nee"]),
    ("clamped-first", Rows(&[("path-mean", 0.0)]), &["box nee", "room mis", "glass nee"]),
    ("eta-squared-divided", Rows(&[("path-eta-squared", 1.0)]), &["glass nee"]),
    ("eta-squared-multiplied", Rows(&[("path-eta-squared", 2.0)]), &["glass nee"]),
    ("index-inverted", Rows(&[("path-refraction", 0.0)]), &["glass nee"]),
    ("index-inverted-ends", Rows(&[("path-refraction", 0.0)]), &["glass nee"]),
    ("bent-back", Rows(&[("path-refraction", 1.0)]), &["glass nee"]),
    ("not-bent", Rows(&[("path-refraction", 2.0)]), &["glass nee"]),
    ("throughput-kept", Rows(&[("path-throughput", 0.0)]), &["box nee", "floor nee"]),
    ("one-number", Rows(&[("path-one-number", 0.0)]), &["box nee", "sky mis"]),
    ("two-sided", Rows(&[("path-two-sided", 0.0)]), &["room nee", "room mis"]),
    ("texture-raw", Rows(&[("path-texture", 0.0)]), &["floor nee", "floor mis"]),
    ("sky-upside-down", Rows(&[("path-sky", 0.0)]), &["sky nee", "sky mis"]),
    ("sky-no-sine", Rows(&[("path-sky", 1.0)]), &["sky nee", "sky mis"]),
    ("no-shadow-rays", Rows(&[("path-no-shadows", 0.0)]), &["box nee", "sky mis", "room mis", "floor nee"]),
    ("no-curve", Rows(&[("path-curve", 0.0)]), &["box nee", "glass nee"]),
    ("curve-twice", Rows(&[("path-curve", 1.0)]), &["sky mis", "floor nee"]),
    ("by-chance", Noise, &["box nee", "sky mis", "room mis"]),
    ("light-halved", Rows(&[("path-factor", 0.5)]), &["box nee"]),
    ("x-albedo-squared", UNKNOWN, &["box nee", "sky mis"]),
    ("x-centre-only", UNKNOWN, &["glass nee"]),
    ("x-mirror-dark", UNKNOWN, &["sky nee", "glass nee"]),
    ("x-no-fresnel", UNKNOWN, &["glass nee"]),
];

/// A claim of `durer compare`: names and values of the mistakes that it says were made together.
type Claim = Vec<(String, f64)>;

/// Tests `durer compare` on all wrong pictures of the path tracer. Returns true if the goals are
/// met.
pub fn pictures(durer: &Path, folder: &Path, wanted: &dyn Fn(&str) -> bool) -> Result<bool> {
    let scenes = scenes::scenes();
    let mut results = Vec::new();
    for (i, scene) in scenes.iter().enumerate() {
        let cases: Vec<(&Mistake, bool)> = MISTAKES
            .iter()
            .flat_map(|mistake| mistake.2.iter().map(move |place| (mistake, *place)))
            .filter(|(mistake, place)| wanted(&format!("paths {place} {}", mistake.0)))
            .filter_map(|(mistake, place)| {
                let (name, method) = place.split_once(' ')?;
                (name == scene.name).then_some((mistake, method == "mis"))
            })
            .collect();
        if cases.is_empty() {
            continue;
        }
        let own = folder.join(format!("paths-{}", scene.name));
        std::fs::create_dir_all(&own)?;
        std::fs::write(own.join("scene.txt"), scene.text())?;
        scenes::files().into_iter().try_for_each(|(name, bytes)| std::fs::write(own.join(name), bytes))?;
        compare_tracers(durer, &own, scene)?;
        render(durer, &own, scene, "right.ppm", SAMPLES, 0)?;
        let right = PathTracer::new(scene, "", false).picture(8 * SAMPLES, 3);
        for (mistake, weighted) in cases {
            results.push(test(durer, &own, scene, &right, mistake, weighted, i as u64)?);
        }
    }
    if results.is_empty() {
        return Ok(true);
    }
    Ok(summary("path-traced ", &results, GOAL))
}

/// Renders a scene with the library.
fn render(durer: &Path, own: &Path, scene: &PathScene, file: &str, samples: usize, seed: u64) -> Result<()> {
    let mut render = Command::new(durer);
    render.current_dir(own).args(["render", "scene.txt", "-q", "-o", file]).args(options(scene, samples));
    output(render.args(["--seed", &seed.to_string()]))?;
    Ok(())
}

fn options(scene: &PathScene, samples: usize) -> Vec<String> {
    let text =
        format!("--integrator path --size {SIDE}x{SIDE} --filter box --bounces {} --samples {samples}", scene.bounces);
    text.split(' ').map(String::from).collect()
}

/// Prints the difference between the library's path tracer and the judge's with both methods.
fn compare_tracers(durer: &Path, own: &Path, scene: &PathScene) -> Result<()> {
    let half = |seed: u64| {
        let file = format!("right-{seed}.pfm");
        render(durer, own, scene, &file, MANY_SAMPLES / 2, seed)?;
        read_pfm(&own.join(file))
    };
    let theirs = [half(1)?, half(2)?];
    for (method, weighted) in [("nee", false), ("mis", true)] {
        let ours = PathTracer::new(scene, "", weighted).picture(MANY_SAMPLES, 7);
        // Sums of the three channels over the picture, and their variances.
        let [(own, own_noise), (other, other_noise)] = [&ours.linear, &theirs].map(|halves| {
            let pairs = halves[0].iter().zip(&halves[1]);
            pairs.fold((0.0, 0.0), |(sum, noise), (a, b)| {
                let difference = 0.5 * (*a - *b).dot(Vec3::ONE);
                (sum + 0.5 * (*a + *b).dot(Vec3::ONE), noise + difference * difference)
            })
        });
        println!(
            "scene {:<5} {method}: the two path tracers differ by {:+.2} % (standard error {:.2} %), and by more than \
             noise in {:.1} % of the blocks",
            scene.name,
            100.0 * (own / other - 1.0),
            100.0 * (own_noise + other_noise).sqrt() / other,
            100.0 * differing(&ours.linear, &theirs, 0.002)
        );
    }
    Ok(())
}

/// Returns the colours of a picture in PFM format, starting with the top row.
fn read_pfm(path: &Path) -> Result<Vec<Vec3>> {
    let bytes = std::fs::read(path)?;
    let start = bytes.len().checked_sub(12 * SIDE * SIDE).context("a PFM file is too short")?;
    let value = |four: &[u8]| f64::from(f32::from_le_bytes([four[0], four[1], four[2], four[3]]));
    let color = |c: &[u8]| Vec3(value(&c[..4]), value(&c[4..8]), value(&c[8..]));
    let rows = bytes[start..].chunks_exact(12 * SIDE).rev();
    Ok(rows.flat_map(|row| row.chunks_exact(12).map(color).collect::<Vec<Vec3>>()).collect())
}

/// Returns the fraction of the blocks in which two pictures differ by more than noise. The halves
/// of each picture show its noise. Differences up to `least` do not count.
fn differing(a: &[Vec<Vec3>; 2], b: &[Vec<Vec3>; 2], least: f64) -> f64 {
    let blocks = SIDE / BLOCK;
    let differs = |block: usize| {
        let (left, top) = (block % blocks * BLOCK, block / blocks * BLOCK);
        let (mut difference, mut noise) = (Vec3::ZERO, 0.0);
        for i in 0..BLOCK * BLOCK {
            let pixel = (top + i / BLOCK) * SIDE + left + i % BLOCK;
            difference = difference + (a[0][pixel] + a[1][pixel] - b[0][pixel] - b[1][pixel]) * 0.5;
            for [one, other] in [a, b] {
                let halves = (one[pixel] - other[pixel]) * 0.5;
                noise += halves.dot(halves);
            }
        }
        let count = (BLOCK * BLOCK) as f64;
        difference.length() > ERRORS * noise.sqrt() + count * least
    };
    (0..blocks * blocks).filter(|block| differs(*block)).count() as f64 / (blocks * blocks) as f64
}

/// Renders a wrong picture, compares it with the library's and prints the outcome.
fn test(
    durer: &Path,
    own: &Path,
    scene: &PathScene,
    right: &Picture,
    mistake: &Mistake,
    weighted: bool,
    seed: u64,
) -> Result<(String, Outcome)> {
    let method = if weighted { "mis" } else { "nee" };
    let (name, answer, _) = *mistake;
    let picture = PathTracer::new(scene, name, weighted).picture(SAMPLES, 100 + seed);
    let share = differing(&picture.shown, &right.shown, LEAST);
    let file = format!("{name}-{method}.ppm");
    std::fs::write(own.join(&file), super::ppm((SIDE, SIDE), &picture.bytes))?;
    let mut compare = Command::new(durer);
    compare.current_dir(own).args(["compare", "right.ppm", &file, "--scene", "scene.txt", "--json"]);
    compare.args(options(scene, SAMPLES));
    let started = std::time::Instant::now();
    let json = output(&mut compare)?;
    let seconds = started.elapsed().as_secs_f64();
    let claims = claims(&json);
    let remark = json.contains("\"remark\": \"");
    let named = |right: &[(&str, f64)]| {
        let is_right =
            |(name, value): &(String, f64)| right.iter().any(|right| right.0 == name && (right.1 - value).abs() < 1e-4);
        claims.iter().any(|claim| claim.len() == 1 && is_right(&claim[0]))
    };
    let outcome = match answer {
        Noise if claims.is_empty() && remark => Outcome::Identified,
        Noise if claims.is_empty() => Outcome::NotIdentified,
        Noise => Outcome::Wrong,
        Rows(right) if named(right) => Outcome::Identified,
        Rows(_) if !claims.is_empty() => Outcome::Wrong,
        Rows(_) if share < VISIBLE => Outcome::Invisible,
        // The remark says that the pictures differ only by noise.
        Rows(_) if remark && share >= CLEARLY_VISIBLE => Outcome::Wrong,
        Rows(_) if remark => Outcome::NotIdentified,
        Rows([]) => Outcome::Identified,
        Rows(_) => Outcome::NotIdentified,
    };
    let words = lines(&json);
    let line = format!(
        "{outcome:<13?} {seconds:5.1} s  {:<5} {method} {name:<22} {:>5.1} %  {words}",
        scene.name,
        100.0 * share
    );
    println!("{line}");
    Ok((line, outcome))
}

/// Returns the sets of mistakes in the JSON output of `durer compare`, each of which is said to
/// reproduce the picture.
fn claims(json: &str) -> Vec<Claim> {
    let field = |text: &str, name: &str| -> Option<String> {
        let rest = text.split(&format!("\"{name}\": ")).nth(1)?;
        Some(rest.split([',', '\n']).next()?.trim_matches('"').to_string())
    };
    let mistake = |text: &str| -> Option<(String, f64)> {
        let name = text.split('"').next()?.to_string();
        Some((name, field(text, "value").and_then(|value| value.parse().ok()).unwrap_or(0.0)))
    };
    let named = json.split("\"named\": [").nth(1).and_then(|rest| rest.split("\"reference_off\"").next());
    let sets = named.unwrap_or("").split("\"mistakes\": [").skip(1);
    sets.map(|set| set.split("\"name\": \"").skip(1).filter_map(mistake).collect()).collect()
}

/// Returns the first line of the diagnosis in the JSON output of `durer compare`.
fn lines(json: &str) -> String {
    let rest = json.split("\"lines\": [").nth(1).unwrap_or("");
    rest.split('"').nth(1).unwrap_or("").to_string()
}
