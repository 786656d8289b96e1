//! `durer course`: the command lines of the course's programs of all years.

mod options;
mod year;

pub use options::{Program, program};

use crate::diagrams::{self, filter_layer, samples_layer};
use crate::failure::{Failure, bad, failed};
use crate::guard::Guard;
use crate::open::Opened;
use crate::report::rejected;
use crate::terminal::say;
use crate::values::weight;
use crate::{check, output, progress};
use clap::Args;
use durer::LoadOptions;
use durer::camera::{Projection, Raster};
use durer::compile::AccelKind;
use durer::dialect::{Compat, Dialect};
use durer::film::aov::Aov;
use durer::film::course::{CourseFilter, average_3x3};
use durer::image::{Destination, Format, Image, Layer, Transfer, format_for};
use durer::integrator::Settings;
use durer::options::memory::Memory;
use durer::render::{Control, Job, RenderError, Sampling};
use durer::sampler::Sampler;
use options::{Given, PROGRAMS, usage};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;

/// Accept the arguments of the course's own programs from any year
#[derive(Args)]
#[command(
    disable_help_flag = true,
    after_help = "Example:
  durer course -input scene.txt -size 200 200 -output picture.tga -depth 9 10 depth.tga

`durer course --help` lists the options."
)]
pub struct CourseArgs {
    /// Arguments of the course's programs
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    pub arguments: Vec<String>,
}

/// Memory limit; the old programs have no option for it.
const MEMORY: Memory = Memory::Percent(80.0);

pub fn run(arguments: Vec<String>, program_name: Option<&'static Program>) -> Result<(), Failure> {
    if arguments.is_empty() || arguments.iter().any(|a| a == "--help" || a == "-h" || a == "-help") {
        usage();
        return if arguments.is_empty() { Err(Failure::Input(None)) } else { Ok(()) };
    }
    let given = Given::parse(arguments)?;
    let quiet = given.has("--quiet");
    let options = load_options(&given, program_name)?;
    given.check_unknown(options.dialect, quiet)?;
    let scene = given.text("-input").ok_or_else(|| bad("-input is missing: give the scene file"))?;
    // Report invalid file names before the work.
    let mut guard = Guard::default();
    let outputs = Outputs::of(&given, options.dialect, &mut guard)?;
    let opened = year::open(Path::new(scene), &options, &given, &mut guard)?;
    let job = job(&given, &opened)?;
    let control = Arc::new(Control { threads: threads(&given)?, memory: MEMORY.bytes(), ..Control::default() });
    let world = &opened.world;
    let zooms = (given.zoom("-render_samples")?, given.zoom("-render_filter")?);
    for zoom in [zooms.0, zooms.1].into_iter().flatten() {
        diagrams::check(&job, zoom).map_err(failed)?;
    }
    // The picture of the grid replaces the colour picture.
    let grid_wanted = job.color && given.has("-visualize_grid");
    let job = Job { color: job.color && !grid_wanted, ..job };
    let (rendered, grid, diagrams) = progress::watch(&control, quiet, || {
        let rendered = durer::render::render(world, &job, &control)?;
        let grid = grid_wanted.then(|| durer::render::grid_picture(world, &job, &control)).transpose()?;
        let samples = zooms.0.map(|zoom| samples_layer(world, &job, &control, zoom)).transpose()?;
        let filter = zooms.1.map(|zoom| filter_layer(&job, zoom)).transpose()?;
        Ok((rendered, grid.map(|image| Layer::color("color", image)), [samples, filter]))
    })
    .map_err(failed)?;
    // The interrupt may arrive after the work is done; honour it anyway.
    if control.cancel.load(Relaxed) {
        return Err(failed(RenderError::Cancelled));
    }
    rejected(&rendered.statistics, Some(world), quiet);
    if given.has("-stats") {
        stats(&opened, &control);
    }
    let mut rendered = rendered;
    if odd_size(&given, &opened) == Some(OddSize::Third) {
        rendered.pictures.iter_mut().filter(|layer| layer.name == "color").try_for_each(third)?;
    }
    let layers = grid.iter().chain(&rendered.pictures).chain(diagrams.iter().flatten());
    let mut files = Vec::new();
    for (layer, (place, format)) in layers.zip(&outputs.0) {
        files.push((place, output::encode(format, std::slice::from_ref(layer), Transfer::Course, &[])?));
    }
    output::save(&files, quiet)?;
    if !quiet {
        check::after_course(&opened, &job, &rendered.pictures, &rendered.statistics);
    }
    Ok(())
}

fn load_options(given: &Given, program_name: Option<&'static Program>) -> Result<LoadOptions, Failure> {
    let named = match given.text("--program") {
        Some(name) => Some(program(name).ok_or_else(|| {
            bad(format!("unknown program {name}; known programs: {}", PROGRAMS.map(|p| p.name).join(", ")))
        })?),
        None => program_name,
    };
    let dialect = match given.text("--dialect") {
        Some(name) => Some(Dialect::from_name(name).ok_or_else(|| {
            bad(format!("unknown dialect {name}; known dialects: {}", Dialect::ALL.map(Dialect::name).join(", ")))
        })?),
        None => named.map(|program| program.dialect),
    };
    let mut compat: Vec<(Compat, bool)> = named.iter().flat_map(|p| p.compat).map(|&compat| (compat, true)).collect();
    for word in given.text("--compat").into_iter().flat_map(|names| names.split(',')) {
        let (name, on) = word.strip_prefix("no-").map_or((word, true), |name| (name, false));
        let known = Compat::from_name(name).ok_or_else(|| bad(format!("--compat: unknown quirk {name}")))?;
        compat.push((known, on));
    }
    let cells = given.numbers::<u32>("-grid", 3)?.and_then(|cells| <[u32; 3]>::try_from(cells).ok());
    Ok(LoadOptions {
        dialect,
        course: true,
        hints: given.hints(),
        compat,
        allow_outside: given.has("--allow-outside"),
        assets: given.text("--assets").map(PathBuf::from).into_iter().collect(),
        accel: match cells {
            None if !given.has("-visualize_grid") => AccelKind::Bvh,
            cells => AccelKind::Grid(cells),
        },
        strict: false,
        threads: threads(given)?,
        memory: MEMORY.bytes(),
        ..LoadOptions::default()
    })
}

/// Files to write, in the order of the pictures.
struct Outputs(Vec<(Destination, &'static Format)>);

impl Outputs {
    fn of(given: &Given, asked: Option<Dialect>, guard: &mut Guard) -> Result<Self, Failure> {
        let names = [
            ("-output", given.text("-output")),
            ("-depth", given.values("-depth").map(|values| values[2].as_str())),
            ("-normals", given.text("-normals")),
            ("-render_samples", given.text("-render_samples")),
            ("-render_filter", given.text("-render_filter")),
        ];
        let named = names.into_iter().filter_map(|(option, name)| Some((option, name?)));
        let format = |(option, name)| Ok((option, name, course_format(name, asked)?));
        let named: Vec<_> = named.map(format).collect::<Result<_, Failure>>()?;
        let place = |(option, name, format)| Ok((guard.writes(option, Path::new(name))?, format));
        let files: Vec<_> = named.into_iter().map(place).collect::<Result<_, Failure>>()?;
        if files.is_empty() {
            return Err(bad("nothing to write: pass -output, -depth, -normals, -render_samples or -render_filter"));
        }
        Ok(Outputs(files))
    }
}

/// Returns the format for a name. Names without an extension are TGA, as in the old programs; with
/// the dialect f12a4, every name except .bmp is TGA.
fn course_format(name: &str, asked: Option<Dialect>) -> Result<&'static Format, Failure> {
    let nameless = Path::new(name).extension().is_none();
    let is_tga = nameless || asked == Some(Dialect::F12a4) && !name.ends_with(".bmp");
    format_for(if is_tga { "picture.tga" } else { name }).map_err(|error| bad(error.to_string()))
}

fn job(given: &Given, opened: &Opened) -> Result<Job, Failure> {
    let rules = &opened.loaded.rules;
    let size = given.numbers::<u32>("-size", 2)?;
    // A camera with a fixed aspect ratio determines the size; the old programs have no such camera.
    let natural = || Raster::natural_size(opened.world.camera().proportions(), rules.size);
    let (width, height) = size.map_or_else(natural, |size| (size[0], size[1]));
    if width == 0 || height == 0 {
        return Err(bad("-size: a picture needs at least one pixel"));
    }
    let odd = odd_size(given, opened);
    let (width, height) = match odd {
        Some(OddSize::Threefold) => (width.saturating_mul(3), height.saturating_mul(3)),
        _ => (width, height),
    };
    if odd == Some(OddSize::Third) && (width < 3 || height < 3) {
        return Err(bad("-filter without -jitter averages three by three pixels, but the picture is smaller"));
    }
    let depth = given.numbers::<f32>("-depth", 2)?;
    let depth_range = depth.map(|range| (range[0], range[1]));
    let clamped = opened.world.display_rules().clamped_depths;
    if depth_range.is_some_and(|(min, max)| !(min.is_finite() && max.is_finite() && (min != max || clamped))) {
        return Err(bad("-depth needs two different numbers"));
    }
    // For an empty range the old program divides zero by zero and writes black, as if everything
    // were behind the range.
    let depth_range = depth_range.map(|range| if range.0 == range.1 { (-2.0, -1.0) } else { range });
    let bounces = given.number("-bounces")?.unwrap_or(rules.bounces);
    if bounces > Settings::MAX_BOUNCES {
        return Err(bad(format!("-bounces: must be at most {}", Settings::MAX_BOUNCES)));
    }
    let weight = given.text("-weight").map(weight).transpose().map_err(|error| bad(format!("-weight: {error}")))?;
    let wanted = [("-depth", "depth"), ("-normals", "normals")];
    Ok(Job {
        width,
        height,
        seed: given.number("--seed")?.unwrap_or(0),
        sampling: match odd {
            Some(OddSize::Threefold) => Sampling::Course2004 { sampler: Sampler::Random, samples: 1, filter: None },
            _ => sampling(given, opened.loaded.dialect)?,
        },
        settings: Settings {
            bounces,
            shadows: given.has("-shadows") || rules.shadows,
            shade_back: given.has("-shade_back") || rules.shade_back,
            transparent_shadows: given.has("-transparent_shadows"),
            reflection: !given.has("-reflection_off"),
            refraction: !given.has("-refraction_off"),
            least_weight: weight.unwrap_or(0.0),
        },
        color: given.has("-output"),
        aovs: wanted.iter().filter(|w| given.has(w.0)).filter_map(|w| Aov::from_name(w.1)).collect(),
        depth_range,
        ..Job::default()
    })
}

/// Size of the picture that the 2012 program writes with only one of `-jitter` and `-filter`.
#[derive(Clone, Copy, Debug, PartialEq)]
enum OddSize {
    /// Every sub-pixel, three by three per pixel.
    Threefold,
    /// The mean of each three by three pixels.
    Third,
}

fn odd_size(given: &Given, opened: &Opened) -> Option<OddSize> {
    let is_odd = opened.loaded.rules.has(Compat::OddSizes);
    match (given.has("-jitter"), given.has("-filter")) {
        (true, false) if is_odd => Some(OddSize::Threefold),
        (false, true) if is_odd => Some(OddSize::Third),
        _ => None,
    }
}

/// Averages blocks of three by three pixels.
fn third(layer: &mut Layer) -> Result<(), Failure> {
    let &Image { width, height, ref pixels } = &*layer.image;
    let pixels = average_3x3(pixels, width, height);
    layer.image = Arc::new(Image::from_pixels(width / 3, height / 3, pixels).map_err(|error| bad(error.to_string()))?);
    layer.coverage = None;
    Ok(())
}

fn sampling(given: &Given, dialect: Dialect) -> Result<Sampling, Failure> {
    let (jitter, blur) = (given.has("-jitter"), given.has("-filter"));
    if jitter || blur {
        // The programs of 2016 and later accept both options without effect.
        let ignored = matches!(dialect, Dialect::F16 | Dialect::F23);
        return Ok(if ignored { Sampling::Center } else { Sampling::Course2012 { jitter, blur } });
    }
    let samplers = [
        ("-random_samples", Sampler::Random),
        ("-uniform_samples", Sampler::Uniform),
        ("-jittered_samples", Sampler::Jittered),
    ];
    let sampler = samplers.into_iter().find(|(name, _)| given.has(name));
    let radius = |name: &str| -> Result<Option<f32>, Failure> {
        let radius = given.number::<f32>(name)?;
        if radius.is_some_and(|r| !(0.0..=64.0).contains(&r)) {
            return Err(bad(format!("{name}: must be from 0 to 64")));
        }
        Ok(radius)
    };
    let filter = if let Some(radius) = radius("-box_filter")? {
        Some(CourseFilter::Box { radius })
    } else if let Some(radius) = radius("-tent_filter")? {
        Some(CourseFilter::Tent { radius })
    } else {
        radius("-gaussian_filter")?.map(|sigma| CourseFilter::Gaussian { sigma })
    };
    let samples = sampler.map(|(name, _)| given.number::<u32>(name)).transpose()?.flatten();
    if samples.is_some_and(|n| n == 0 || n > 1 << 16) {
        return Err(bad("the number of samples must be from 1 to 65536"));
    }
    Ok(match (sampler, filter) {
        (None, None) => Sampling::Center,
        (sampler, filter) => Sampling::Course2004 {
            sampler: sampler.map_or(Sampler::Uniform, |(_, sampler)| sampler),
            samples: samples.unwrap_or(1),
            filter,
        },
    })
}

fn threads(given: &Given) -> Result<Option<usize>, Failure> {
    let threads = given.number("--threads")?;
    if threads.is_some_and(|n| !(1..=1024).contains(&n)) {
        return Err(bad("--threads must be from 1 to 1024"));
    }
    Ok(threads)
}

/// Prints the output of `-stats`.
fn stats(opened: &Opened, control: &Control) {
    let rays = control.rays.load(Relaxed);
    say(&format!("objects {}, rays {rays}", opened.world.objects().len()));
}
