//! `cargo xtask bitterli`: renders Benedikt Bitterli's scenes from pbrt files, compares them with
//! pictures by his renderer Tungsten, and writes the table in docs/models.md.

use crate::section::Section;
use anyhow::{Context, Result, bail};
use durer::diag::{Diagnostics, Files, Severity};
use durer::film::Filter;
use durer::image::compare::{Options, Picture, Scale, compare};
use durer::image::{Image, Layer, WriteOptions, format_for, read, save};
use durer::integrator::{IntegratorKind, PhotonParameters};
use durer::math::Vec3;
use durer::render::{Control, Job, PartialRender, Sampling, Shard};
use durer::{LoadOptions, load};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Default number of samples per pixel, and size of the block of reference pixels that a pixel
/// covers.
const SAMPLES: u32 = 256;
const STEP: u32 = 4;

/// Maximum relative deviation of the mean, and maximum FLIP at equal exposure.
const MAX_DEVIATION: f64 = 0.02;
const MAX_FLIP: f64 = 0.08;

/// Scenes whose file specifies another depth than Tungsten used, with the number of scattering
/// events after the first hit. With 0, the walls and the floor of veach-mis agree to a thousandth.
const BOUNCES: [(&str, u32); 2] = [("cornell-box", 62), ("veach-mis", 0)];

/// Scenes whose pbrt file requests photon mapping: photons per sample, and the radius in the file.
const PHOTONS: [(&str, u32, f32); 1] = [("water-caustic", 200_000, 0.01)];

/// Known causes of differences from Tungsten.
const CAUSES: [(&str, &str); 3] = [
    ("coffee", "coats attenuate light by the same mean factor in all directions"),
    ("veach-mis", "the metals in the file lack the factor 0.3 and the Beckmann distribution that Tungsten uses"),
    (
        "water-caustic",
        "bright isolated pixels, different in each image, where the water reflects the light; +0.2 % if clamped to 1",
    ),
];

const SECTION: Section = Section { page: "docs/models.md", command: "bitterli" };

/// A scene of the table in docs/models.md and how its render compares with Tungsten's picture.
struct Row {
    name: String,
    size: (u32, u32),
    /// Ratio of the mean luminances, and FLIP and HDR-FLIP after dividing by this ratio.
    ratio: f64,
    flip: f64,
    hdr_flip: f64,
    bounces: u32,
}

/// Runs `cargo xtask bitterli`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let samples = crate::value(arguments, "--samples").map_or(Ok(SAMPLES), |number| number.parse())?;
    let (only, keep) = (crate::value(arguments, "--only"), crate::value(arguments, "--keep").map(PathBuf::from));
    let folder = crate::corpus().join("samples/pbrt/bitterli");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: {} is missing", folder.display());
        return Ok(ExitCode::SUCCESS);
    };
    let mut scenes: Vec<PathBuf> = entries.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    scenes.retain(|path| path.join("scene-v4.pbrt").is_file() && path.join("TungstenRender.exr").is_file());
    scenes.retain(|path| only.is_none_or(|only| path.to_string_lossy().contains(only.as_str())));
    scenes.sort();
    if scenes.is_empty() {
        bail!("no matching scenes in {}", folder.display());
    }
    let mut table = format!(
        "{samples} samples per pixel.\n\n\
         | scene | pixels | bounces | mean luminance | FLIP | HDR-FLIP | |\n\
         | --- | --- | ---: | ---: | ---: | ---: | --- |\n",
    );
    for scene in &scenes {
        let row = compared(scene, samples, keep.as_deref())?;
        let cause = CAUSES.iter().find(|known| known.0 == row.name).map_or("", |known| known.1);
        let met = (row.ratio - 1.0).abs() <= MAX_DEVIATION && row.flip <= MAX_FLIP;
        let line = format!(
            "| {} | {} x {} | {} | {:+.2} % | {:.3} | {:.3} | {}{cause} |",
            row.name,
            row.size.0,
            row.size.1,
            row.bounces,
            100.0 * (row.ratio - 1.0),
            row.flip,
            row.hdr_flip,
            if met { "" } else { "off: " },
        );
        println!("{line}");
        writeln!(table, "{line}")?;
    }
    if only.is_none() {
        SECTION.write(&table)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn compared(folder: &Path, samples: u32, keep: Option<&Path>) -> Result<Row> {
    let name = folder.file_name().context("a name")?.to_string_lossy().into_owned();
    let path = folder.join("TungstenRender.exr");
    let whole = smaller(&read(&std::fs::read(&path)?, "a.exr")?)?;
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let options = LoadOptions::default();
    let loaded = load(&folder.join("scene-v4.pbrt"), &options, &mut files, &mut diagnostics)?;
    let loaded = loaded.with_context(|| format!("cannot read {name}: {diagnostics:?}"))?;
    let world = loaded.compile(&options, &mut files, &mut diagnostics);
    let world = world.with_context(|| format!("cannot compile {name}: {diagnostics:?}"))?;
    for finding in diagnostics.iter().filter(|finding| finding.severity == Severity::Warning) {
        println!("{name}: {}", finding.message);
    }
    let known = BOUNCES.iter().find(|row| row.0 == name).map(|row| row.1);
    let bounces = known.or(loaded.scene.render_defaults.bounces).unwrap_or(16);
    let photons = PHOTONS.iter().find(|row| row.0 == name);
    let method = photons.map_or(IntegratorKind::PATH, |&(_, count, radius)| {
        IntegratorKind::Photons(PhotonParameters { count, radius: Some(radius), ..PhotonParameters::default() })
    });
    let usual = Job::default();
    let job = Job {
        width: whole.width,
        height: whole.height,
        sampling: Sampling::Filtered { samples, filter: Filter::Box { radius: 0.5 } },
        method,
        settings: durer::integrator::RenderSettings { bounces, ..usual.settings },
        ..usual
    };
    let part = PartialRender::new(&world, &job, Shard::WHOLE)?;
    part.render(&world, &Control::default(), &mut |_, _| {})?;
    let rendered = part.pictures()?;
    let ours = &rendered.layers.first().context("a picture")?.image;
    // Exclude pixels that are infinite in the reference, such as bright emitters, from both means.
    let seen = |image: &Image| {
        let pixel = |(&own, other): (&Vec3, &Vec3)| if other.is_finite() { own } else { Vec3::ZERO };
        Image { pixels: image.pixels.iter().zip(&whole.pixels).map(pixel).collect(), ..image.clone() }
    };
    let (ours, reference) = (&seen(ours), seen(&whole));
    let ratio = mean(ours) / mean(&reference);
    let equal = Image { pixels: ours.pixels.iter().map(|&p| p / ratio as f32).collect(), ..ours.clone() };
    let measured = compare(&light(&reference), &light(&equal), &Options::default())?.measures;
    if let Some(keep) = keep {
        std::fs::create_dir_all(keep)?;
        for (kind, image) in [("ours", ours), ("tungsten", &reference)] {
            for ending in ["png", "exr"] {
                let place = keep.join(format!("{name}-{kind}.{ending}"));
                let mut bytes = Vec::new();
                format_for(&place)?.write(&[Layer::color("", image.clone())], &WriteOptions::default(), &mut bytes)?;
                save(&place, &bytes)?;
            }
        }
    }
    let (flip, hdr_flip) = (measured.flip, measured.hdr_flip.unwrap_or(f64::NAN));
    Ok(Row { name, size: (reference.width, reference.height), ratio, flip, hdr_flip, bounces })
}

/// Converts an image to a picture in linear light.
fn light(image: &Image) -> Picture {
    Picture { image: image.clone(), scale: Scale::Linear }
}

/// Returns the mean luminance.
fn mean(image: &Image) -> f64 {
    let luminance = |p: &Vec3| f64::from(p.dot(Vec3::new(0.2126, 0.7152, 0.0722)));
    image.pixels.iter().map(luminance).sum::<f64>() / image.pixels.len() as f64
}

/// Averages blocks of pixels.
fn smaller(image: &Image) -> Result<Image> {
    let (width, height) = (image.width / STEP, image.height / STEP);
    let pixel = |x: u32, y: u32| {
        let all = (0..STEP * STEP).filter_map(|i| image.get(STEP * x + i % STEP, STEP * y + i / STEP));
        all.sum::<Vec3>() / (STEP * STEP) as f32
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
    Ok(Image::from_pixels(width, height, pixels)?)
}
