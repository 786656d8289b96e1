//! Implements `durer explain`, which explains the colour of a pixel.

mod crossings;
mod page;
mod ray_drawing;
mod tree_drawing;

use crate::failure::{Failure, from_render_error, invalid_input};
use crate::file_registry::FileRegistry;
use crate::job::job;
use crate::open::{CompiledInput, load_options, open};
use crate::options::{JobArgs, SceneArgs, ViewArgs, accel};
use crate::terminal::print_line;
use crate::values::{percent, pixel};
use crate::{output, progress};
use clap::Args;
use clap::builder::PossibleValuesParser;
use durer::film::aov::Aov;
use durer::film::luminance_of;
use durer::image::{Image, Transfer};
use durer::math::{Color, Ray, Vec3};
use durer::options::{crop, doc};
use durer::render::explain::{
    ExplainOptions, Explanation, SceneNames, TextLine, explain_ray, explain_samples, number, ray_text,
};
use durer::render::{Control, Job};
use durer::report::{self, Explained};
use durer::sampler::SampleId;
use std::cell::LazyCell;
use std::ffi::OsString;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::Arc;

/// Explain a pixel's colour as a tree of terms that sum to it
#[derive(Args)]
#[command(after_help = "Examples:
  durer explain scene.txt --pixel 200,150
  durer explain scene.txt --pixel 200,150 --sample 3 --size 640x480 --bounces 2
  durer explain scene.txt --brightest --html why.html
  durer explain scene.txt --pixel 200,150 --depth 4 --svg tree.svg --rays rays.svg
  durer explain scene.txt --ray '0 1 5 0 0 -1' --json
  durer explain model.stl --ray '0 1 5 0 0 -1' --crossings

Pass the same options as to `durer render`, because the colour depends on them, except those of the files to write. With one
sample per pixel, the ray through the pixel centre is explained.")]
pub struct ExplainArgs {
    /// Scene or model file
    pub scene: PathBuf,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[arg(long, value_name = "LEFT,TOP,WIDTHxHEIGHT", value_parser = crop, help = doc("crop"))]
    pub crop: Option<(u32, u32, u32, u32)>,
    #[command(flatten)]
    pub job: JobArgs,
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024), help = doc("threads"))]
    pub threads: Option<u16>,
    /// Transfer curve of the 8-bit colours
    #[arg(long, default_value = "srgb", value_parser = PossibleValuesParser::new(Transfer::ALL.map(Transfer::name)))]
    pub transfer: String,
    /// Print only errors and the explanation
    #[arg(short, long)]
    pub quiet: bool,
    /// Pixel to explain; column and row are counted from 0 at the upper left corner
    #[arg(long, value_name = "X,Y", value_parser = pixel, conflicts_with_all = ["ray", "brightest", "worst"])]
    pub pixel: Option<(u32, u32)>,
    /// Number of the sample to explain in full [default: the first with the largest weight]
    #[arg(long, value_name = "N")]
    pub sample: Option<u32>,
    /// Explain this ray instead of a pixel: origin and direction, of any length
    #[arg(long, value_name = "OX OY OZ DX DY DZ", num_args = 1..=6, allow_negative_numbers = true, conflicts_with_all = ["brightest", "worst", "sample"])]
    pub ray: Option<Vec<f32>>,
    /// List all surfaces that --ray crosses, instead of its colour
    #[arg(long, requires = "ray", conflicts_with_all = ["html", "svg", "rays", "pixel", "brightest", "worst"])]
    pub crossings: bool,
    /// Explain the brightest pixel
    #[arg(long, conflicts_with = "worst")]
    pub brightest: bool,
    /// Explain the pixel that differs most from its neighbours; with path tracing, the pixel to
    /// which a single sample contributes most
    #[arg(long)]
    pub worst: bool,
    /// Omit terms that contribute less than this percentage of the pixel
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, value_parser = percent)]
    pub min: f64,
    /// Omit terms deeper than this level of the tree
    #[arg(long, value_name = "N")]
    pub depth: Option<u32>,
    /// Print JSON
    #[arg(long, conflicts_with = "html")]
    pub json: bool,
    /// Write an HTML page with the picture, the tree and the rays in 3D
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
    /// Draw the tree as an SVG file, for example for slides
    #[arg(long, value_name = "FILE.svg", conflicts_with = "json")]
    pub svg: Option<PathBuf>,
    /// Draw the rays of the tree and the outlines of the objects as an SVG file, from the right
    /// side of the camera
    #[arg(long, value_name = "FILE.svg", conflicts_with = "json")]
    pub rays: Option<PathBuf>,
    /// Draw --rays from above
    #[arg(long, requires = "rays")]
    pub from_above: bool,
}

/// Splits the numbers of a `--ray`, which are separated by spaces or commas, into separate words
/// because clap would treat `-1 0 0` as an option.
pub fn split_ray_argument(words: Vec<OsString>) -> Vec<OsString> {
    let mut all: Vec<OsString> = Vec::with_capacity(words.len());
    for word in words {
        match word.to_str() {
            Some(text) if all.last().is_some_and(|last| last == "--ray") && text.contains([' ', ',']) => {
                all.extend(text.split([' ', ',']).filter(|word| !word.is_empty()).map(OsString::from));
            }
            _ => all.push(word),
        }
    }
    all
}

/// Runs `durer explain`.
pub fn run(args: &ExplainArgs) -> Result<(), Failure> {
    let mut options = load_options(&args.reading);
    options.accel = accel(&args.job)?;
    args.job.options.adapt(&mut options.scene_defaults);
    let mut registry = FileRegistry::default();
    let page_file = args.html.as_ref().map(|path| registry.register_output("--html", path)).transpose()?;
    let drawing_file = args.svg.as_ref().map(|path| registry.register_output("--svg", path)).transpose()?;
    let rays_file = args.rays.as_ref().map(|path| registry.register_output("--rays", path)).transpose()?;
    let compiled = open(&args.scene, &options, args.quiet, &mut registry)?;
    let view = ViewArgs { crop: args.crop, show: vec!["color".into()], zoom: None };
    let job = job(&args.job, Some(&view), &compiled.loaded, false)?;
    let names = SceneNames { files: &compiled.files, scene: &compiled.loaded.scene, world: &compiled.world };
    if let (Some(numbers), true) = (&args.ray, args.crossings) {
        return crossings::print(&names, &given_ray(numbers)?, args.json);
    }
    let (picture, counts) = match args.brightest || args.worst || args.html.is_some() {
        true => picture(args, &compiled, &job)?,
        false => (None, None),
    };
    let subject = subject(args, &compiled, &job, picture.as_ref(), counts.as_ref())?;
    // Show a single tree because the rays of all samples of a pixel would hide each other.
    let sample = match &subject {
        Explained::Pixel(pixel) => match (args.sample, args.worst) {
            (Some(sample), _) => sample as usize,
            (None, true) => pixel.brightest().map_or_else(|| pixel.max_weight_index(), |(sample, _)| sample),
            (None, false) => pixel.max_weight_index(),
        },
        Explained::Ray(_) => 0,
    };
    let transfer = Transfer::from_name(&args.transfer).unwrap_or_default();
    if args.json {
        print_line(&serde_json::to_string_pretty(&report::explanation(&subject, &names))?);
        return Ok(());
    }
    let max_depth = args.depth.map_or(usize::MAX, |depth| depth as usize);
    let detail = ExplainOptions { min_share: (args.min / 100.0) as f32, max_depth, transfer };
    let lines = LazyCell::new(|| match &subject {
        Explained::Ray(light) => ray_text(light, &names, &detail),
        Explained::Pixel(pixel) => pixel.lines(&names, sample, &detail),
    });
    let mut written = Vec::new();
    if let (Some(destination), Some(picture)) = (&page_file, &picture) {
        let page = page::page(&args.scene, &compiled, &job, &subject, sample, picture, transfer)?;
        written.push((destination, page.into_bytes()));
    }
    if let Some(destination) = &drawing_file {
        written.push((destination, tree_drawing::tree_svg(&lines, transfer).into_bytes()));
    }
    if let Some(destination) = &rays_file {
        let tree = match &subject {
            Explained::Ray(tree) => Some(&**tree),
            Explained::Pixel(pixel) => pixel.samples.get(sample).and_then(|sample| sample.light.as_ref()),
        };
        let Some(tree) = tree else {
            return Err(invalid_input("--rays: the camera has no ray in this pixel"));
        };
        let drawn = ray_drawing::rays_svg(&compiled.world, &tree.root, args.from_above);
        written.push((destination, drawn.into_bytes()));
    }
    // A page contains the tree.
    if page_file.is_none() {
        let colored = std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
        lines.iter().for_each(|line| print_line(&format_line(line, colored, transfer)));
        if let Explained::Pixel(pixel) = &subject
            && job.method.is_stochastic()
        {
            pixel.firefly().iter().for_each(|sentence| print_line(&format!("  {sentence}")));
        }
    }
    output::save(&written, args.quiet)
}

/// Renders the whole picture. With adaptive sampling, also returns the number of samples per pixel.
fn picture(args: &ExplainArgs, compiled: &CompiledInput, job: &Job) -> Result<(Option<Image>, Option<Image>), Failure> {
    let counts = if job.adaptive { Aov::from_name("sample-count") } else { None };
    let job = Job { crop: None, color: true, aovs: counts.into_iter().collect(), ..job.clone() };
    let control = Arc::new(Control { threads: args.threads.map(usize::from), ..Control::default() });
    let render = || durer::render::render(&compiled.world, &job, &control);
    let rendered = progress::watch(&control, args.quiet, render).map_err(from_render_error)?;
    let mut images = rendered.layers.into_iter().map(|layer| Arc::unwrap_or_clone(layer.image));
    Ok((images.next(), images.next()))
}

fn subject(
    args: &ExplainArgs,
    compiled: &CompiledInput,
    job: &Job,
    picture: Option<&Image>,
    counts: Option<&Image>,
) -> Result<Explained, Failure> {
    let pixel = match (&args.ray, args.pixel, picture) {
        (Some(numbers), ..) => {
            let ray = given_ray(numbers)?;
            let world = &compiled.world;
            let light = explain_ray(world, job, &ray, SampleId::new(job.seed, (0, 0), 0));
            return light
                .map(|light| Explained::Ray(light.into()))
                .ok_or_else(|| invalid_input("the given ray cannot be explained"));
        }
        (None, Some(pixel), _) => pixel,
        (None, None, Some(picture)) if args.brightest => max_pixel(picture, |x, y| luminance_of(at(picture, x, y))),
        (None, None, Some(picture)) if job.method.is_stochastic() => {
            return worst(compiled, job, picture, counts).map(Explained::Pixel);
        }
        (None, None, Some(picture)) => max_pixel(picture, |x, y| deviation_from_neighbours(picture, x, y)),
        (None, None, None) => {
            return Err(invalid_input("choose a pixel or a ray: --pixel X,Y, --brightest, --worst, or --ray"));
        }
    };
    if pixel.0 >= job.width || pixel.1 >= job.height {
        let (x, y) = pixel;
        return Err(invalid_input(format!(
            "pixel {x},{y} is outside the picture of {} x {} pixels",
            job.width, job.height
        )));
    }
    let world = &compiled.world;
    // With adaptive sampling, a crop has different sample counts than the whole picture.
    let samples = counted(counts.filter(|_| job.crop.is_none()), pixel);
    let explanation = explain_samples(world, job, pixel, samples).map_err(from_render_error)?;
    if let Some(sample) = args.sample.filter(|&sample| sample as usize >= explanation.samples.len()) {
        let last = explanation.samples.len() - 1;
        return Err(invalid_input(format!("no sample {sample}: the pixel's samples are numbered from 0 to {last}")));
    }
    Ok(Explained::Pixel(explanation))
}

/// Returns the ray of `--ray`. Its direction is normalized, as for camera rays, so that `t` is a
/// distance.
fn given_ray(numbers: &[f32]) -> Result<Ray, Failure> {
    let [ox, oy, oz, dx, dy, dz] = numbers[..] else { return Err(invalid_input("--ray needs six numbers")) };
    let ray = Ray::new(Vec3::new(ox, oy, oz), Vec3::new(dx, dy, dz));
    match ray.dir.as_dvec3().try_normalize() {
        Some(unit) if ray.origin.is_finite() => Ok(Ray { dir: unit.as_vec3(), ..ray }),
        _ => Err(invalid_input("--ray needs finite numbers and a direction other than 0 0 0")),
    }
}

/// Returns the number of samples of a pixel if it is known.
fn counted(counts: Option<&Image>, (x, y): (u32, u32)) -> Option<u32> {
    counts.map(|counts| at(counts, x, y).x as u32)
}

/// Returns the brightest firefly. Among the pixels that differ most from their neighbours, this is
/// the one with the largest contribution of a single sample.
fn worst(compiled: &CompiledInput, job: &Job, picture: &Image, counts: Option<&Image>) -> Result<Explanation, Failure> {
    const CANDIDATES: usize = 256;
    let pixels = (0..picture.height).flat_map(|y| (0..picture.width).map(move |x| (x, y)));
    let mut odd: Vec<(f64, (u32, u32))> =
        pixels.map(|(x, y)| (deviation_from_neighbours(picture, x, y), (x, y))).collect();
    odd.sort_by(|a, b| b.0.total_cmp(&a.0));
    odd.truncate(CANDIDATES);
    let mut best: Option<(f64, Explanation)> = None;
    for (_, (x, y)) in odd {
        let samples = counted(counts, (x, y));
        let explanation = explain_samples(&compiled.world, job, (x, y), samples).map_err(from_render_error)?;
        // Pixels at the edge of a visible light are also bright, but they are not fireflies.
        let outlier_weight = if explanation.outlier().is_some() { 1.0 } else { 1e-6 };
        let adds = explanation.brightest().map_or(0.0, |(_, adds)| outlier_weight * adds);
        if best.as_ref().is_none_or(|(most, _)| adds > *most) {
            best = Some((adds, explanation));
        }
    }
    best.map(|(_, explanation)| explanation).ok_or_else(|| invalid_input("the picture has no pixels"))
}

fn at(picture: &Image, x: u32, y: u32) -> Color {
    picture.get(x, y).unwrap_or(Vec3::ZERO)
}

/// Returns the absolute difference between a pixel's luminance and the median of its neighbours.
fn deviation_from_neighbours(picture: &Image, x: u32, y: u32) -> f64 {
    let mut around: Vec<f64> = (0..9)
        .filter(|&i| i != 4)
        .filter_map(|i| picture.get((x + i % 3).checked_sub(1)?, (y + i / 3).checked_sub(1)?))
        .map(luminance_of)
        .collect();
    around.sort_by(f64::total_cmp);
    let middle = around.get(around.len() / 2).copied().unwrap_or(0.0);
    (luminance_of(at(picture, x, y)) - middle).abs()
}

/// Returns the pixel with the greatest value. If several are equal, returns the first in reading
/// order.
fn max_pixel(picture: &Image, value: impl Fn(u32, u32) -> f64) -> (u32, u32) {
    let pixels = (0..picture.height).flat_map(|y| (0..picture.width).map(move |x| (x, y)));
    let mut best = ((0, 0), f64::NEG_INFINITY);
    for (x, y) in pixels {
        let value = value(x, y);
        if value > best.1 {
            best = ((x, y), value);
        }
    }
    best.0
}

/// Formats a fraction as a percentage.
fn percentage(share: f32) -> String {
    match 100.0 * share {
        0.0 => "0 %".into(),
        share if share.abs() < 0.1 => "< 0.1 %".into(),
        share if share.abs() < 10.0 => format!("{share:.1} %"),
        share => format!("{share:.0} %"),
    }
}

/// Formats a line of an explanation, preceded by its contribution.
pub fn format_line(line: &TextLine, colored: bool, transfer: Transfer) -> String {
    let indent = "  ".repeat(line.depth);
    let text = match line.adds {
        Some(adds) if line.depth > 0 => {
            let numbers: Vec<_> = adds.numbers().iter().map(|x| number(*x)).collect();
            let [r, g, b] = transfer.encode_pixel(line.color);
            format!("+ ({})  [{}, alone {r} {g} {b}]  {}", numbers.join(", "), percentage(line.share), line.text)
        }
        _ => line.text.clone(),
    };
    match (colored, line.adds) {
        (false, _) => format!("{indent}{text}"),
        // Show remarks and terms that contribute nothing in a dim colour.
        (true, adds) if line.depth > 0 && adds.is_none_or(|adds| adds.equals(0.0)) => {
            format!("{indent}\x1b[2m{text}\x1b[0m")
        }
        (true, _) => format!("{indent}\x1b[1m{text}\x1b[0m"),
    }
}
