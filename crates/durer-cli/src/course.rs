//! Implements `durer course`, which accepts the command lines of the course's programs.

mod options;
mod year;

pub use options::{Program, program};

use crate::diagrams::{self, filter_layer, samples_layer};
use crate::failure::{Failure, from_render_error, invalid_input};
use crate::file_registry::FileRegistry;
use crate::open::CompiledInput;
use crate::report::rejected;
use crate::terminal::print_line;
use crate::values::weight;
use crate::{check, output, progress};
use clap::Args;
use durer::LoadOptions;
use durer::camera::{Projection, Raster};
use durer::compile::AccelKind;
use durer::dialect::{Dialect, Quirk};
use durer::film::aov::Aov;
use durer::film::course::{CourseFilter, average_3x3};
use durer::image::{Destination, Format, Image, Layer, Transfer, format_for};
use durer::integrator::RenderSettings;
use durer::options::memory::Memory;
use durer::render::{Control, Job, RenderError, Sampling};
use durer::sampler::Sampler;
use options::{Arguments, PROGRAMS, usage};
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

/// Memory limit. The course's programs have no option for this.
const MEMORY: Memory = Memory::Percent(80.0);

/// Runs `durer course`. `program_name` is the official program to emulate, if there is one.
pub fn run(arguments: Vec<String>, program_name: Option<&'static Program>) -> Result<(), Failure> {
    if arguments.is_empty() || arguments.iter().any(|a| a == "--help" || a == "-h" || a == "-help") {
        usage();
        return if arguments.is_empty() { Err(Failure::Input(None)) } else { Ok(()) };
    }
    let parsed = Arguments::parse(arguments)?;
    let quiet = parsed.has("--quiet");
    let options = load_options(&parsed, program_name)?;
    parsed.check_unknown(options.dialect, quiet)?;
    let scene =
        parsed.text("-input").ok_or_else(|| invalid_input("-input is missing: pass -input with the scene file"))?;
    // Report invalid file names before the render starts.
    let mut registry = FileRegistry::default();
    let outputs = Outputs::of(&parsed, options.dialect, &mut registry)?;
    let compiled = year::open(Path::new(scene), &options, &parsed, &mut registry)?;
    let job = job(&parsed, &compiled)?;
    let control = Arc::new(Control { threads: threads(&parsed)?, memory: MEMORY.bytes(), ..Control::default() });
    let world = &compiled.world;
    let zooms = (parsed.zoom("-render_samples")?, parsed.zoom("-render_filter")?);
    for zoom in [zooms.0, zooms.1].into_iter().flatten() {
        diagrams::check(&job, zoom).map_err(from_render_error)?;
    }
    // The picture of the grid is written instead of the colour picture.
    let grid_wanted = job.color && parsed.has("-visualize_grid");
    let job = Job { color: job.color && !grid_wanted, ..job };
    let (rendered, grid, diagrams) = progress::watch(&control, quiet, || {
        let rendered = durer::render::render(world, &job, &control)?;
        let grid = grid_wanted.then(|| durer::render::grid_picture(world, &job, &control)).transpose()?;
        let samples = zooms.0.map(|zoom| samples_layer(world, &job, &control, zoom)).transpose()?;
        let filter = zooms.1.map(|zoom| filter_layer(&job, zoom)).transpose()?;
        Ok((rendered, grid.map(|image| Layer::color("color", image)), [samples, filter]))
    })
    .map_err(from_render_error)?;
    // If the interrupt arrives after the work is done, it still ends the program.
    if control.cancel.load(Relaxed) {
        return Err(from_render_error(RenderError::Cancelled));
    }
    rejected(&rendered.statistics, Some(world), quiet);
    if parsed.has("-stats") {
        stats(&compiled, &control);
    }
    let mut rendered = rendered;
    if odd_size(&parsed, &compiled) == Some(OddSize::Third) {
        rendered.pictures.iter_mut().filter(|layer| layer.name == "color").try_for_each(third)?;
    }
    let layers = grid.iter().chain(&rendered.pictures).chain(diagrams.iter().flatten());
    let mut files = Vec::new();
    for (layer, (destination, format)) in layers.zip(&outputs.0) {
        files.push((destination, output::encode(format, std::slice::from_ref(layer), Transfer::Course, &[])?));
    }
    output::save(&files, quiet)?;
    if !quiet {
        check::after_course(&compiled, &job, &rendered.pictures, &rendered.statistics);
    }
    Ok(())
}

fn load_options(arguments: &Arguments, program_name: Option<&'static Program>) -> Result<LoadOptions, Failure> {
    let named = match arguments.text("--program") {
        Some(name) => Some(program(name).ok_or_else(|| {
            invalid_input(format!("unknown program {name}; known programs: {}", PROGRAMS.map(|p| p.name).join(", ")))
        })?),
        None => program_name,
    };
    let dialect = match arguments.text("--dialect") {
        Some(name) => Some(Dialect::from_name(name).ok_or_else(|| {
            invalid_input(format!(
                "unknown dialect {name}; known dialects: {}",
                Dialect::ALL.map(Dialect::name).join(", ")
            ))
        })?),
        None => named.map(|program| program.dialect),
    };
    let mut compat: Vec<(Quirk, bool)> = named.iter().flat_map(|p| p.compat).map(|&compat| (compat, true)).collect();
    for word in arguments.text("--compat").into_iter().flat_map(|names| names.split(',')) {
        let (name, on) = word.strip_prefix("no-").map_or((word, true), |name| (name, false));
        let known = Quirk::from_name(name).ok_or_else(|| invalid_input(format!("--compat: unknown quirk {name}")))?;
        compat.push((known, on));
    }
    let cells = arguments.numbers::<u32>("-grid", 3)?.and_then(|cells| <[u32; 3]>::try_from(cells).ok());
    Ok(LoadOptions {
        dialect,
        course: true,
        hints: arguments.hints(),
        compat,
        allow_outside: arguments.has("--allow-outside"),
        assets: arguments.text("--assets").map(PathBuf::from).into_iter().collect(),
        accel: match cells {
            None if !arguments.has("-visualize_grid") => AccelKind::Bvh,
            cells => AccelKind::Grid(cells),
        },
        strict: false,
        threads: threads(arguments)?,
        memory: MEMORY.bytes(),
        ..LoadOptions::default()
    })
}

/// Files that `durer course` writes, in the order of the pictures.
struct Outputs(Vec<(Destination, &'static Format)>);

impl Outputs {
    fn of(arguments: &Arguments, requested: Option<Dialect>, registry: &mut FileRegistry) -> Result<Self, Failure> {
        let names = [
            ("-output", arguments.text("-output")),
            ("-depth", arguments.values("-depth").map(|values| values[2].as_str())),
            ("-normals", arguments.text("-normals")),
            ("-render_samples", arguments.text("-render_samples")),
            ("-render_filter", arguments.text("-render_filter")),
        ];
        let named = names.into_iter().filter_map(|(option, name)| Some((option, name?)));
        let format = |(option, name)| Ok((option, name, course_format(name, requested)?));
        let named: Vec<_> = named.map(format).collect::<Result<_, Failure>>()?;
        let destination = |(option, name, format)| Ok((registry.register_output(option, Path::new(name))?, format));
        let files: Vec<_> = named.into_iter().map(destination).collect::<Result<_, Failure>>()?;
        if files.is_empty() {
            return Err(invalid_input(
                "nothing to write: pass -output, -depth, -normals, -render_samples or -render_filter",
            ));
        }
        Ok(Outputs(files))
    }
}

/// Returns the picture format for a file name. As in the course's programs, names without an
/// extension mean TGA. In the dialect f12a4, every name that does not end in .bmp means TGA.
fn course_format(name: &str, requested: Option<Dialect>) -> Result<&'static Format, Failure> {
    let nameless = Path::new(name).extension().is_none();
    let is_tga = nameless || requested == Some(Dialect::F12a4) && !name.ends_with(".bmp");
    format_for(if is_tga { "picture.tga" } else { name }).map_err(|error| invalid_input(error.to_string()))
}

fn job(arguments: &Arguments, compiled: &CompiledInput) -> Result<Job, Failure> {
    let rules = &compiled.loaded.rules;
    let size = arguments.numbers::<u32>("-size", 2)?;
    // A camera with a fixed aspect ratio determines the size of the picture. The course's programs
    // do not have such a camera.
    let natural = || Raster::natural_size(compiled.world.camera().proportions(), rules.size);
    let (width, height) = size.map_or_else(natural, |size| (size[0], size[1]));
    if width == 0 || height == 0 {
        return Err(invalid_input("-size: a picture needs at least one pixel"));
    }
    let odd = odd_size(arguments, compiled);
    let (width, height) = match odd {
        Some(OddSize::Threefold) => (width.saturating_mul(3), height.saturating_mul(3)),
        _ => (width, height),
    };
    if odd == Some(OddSize::Third) && (width < 3 || height < 3) {
        return Err(invalid_input(
            "-filter without -jitter averages blocks of 3 by 3 pixels, but the picture is smaller than one block",
        ));
    }
    let depth = arguments.numbers::<f32>("-depth", 2)?;
    let depth_range = depth.map(|range| (range[0], range[1]));
    let clamped = compiled.world.display_rules().clamped_depths;
    if depth_range.is_some_and(|(min, max)| !(min.is_finite() && max.is_finite() && (min != max || clamped))) {
        return Err(invalid_input("-depth needs two different numbers"));
    }
    // For an empty range, the course's program divides zero by zero and writes black, as if all
    // depths were beyond the range.
    let depth_range = depth_range.map(|range| if range.0 == range.1 { (-2.0, -1.0) } else { range });
    let bounces = arguments.number("-bounces")?.unwrap_or(rules.bounces);
    if bounces > RenderSettings::MAX_BOUNCES {
        return Err(invalid_input(format!("-bounces must be at most {}", RenderSettings::MAX_BOUNCES)));
    }
    let weight = arguments
        .text("-weight")
        .map(weight)
        .transpose()
        .map_err(|error| invalid_input(format!("-weight: {error}")))?;
    let wanted = [("-depth", "depth"), ("-normals", "normals")];
    Ok(Job {
        width,
        height,
        device: None,
        seed: arguments.number("--seed")?.unwrap_or(0),
        sampling: match odd {
            Some(OddSize::Threefold) => Sampling::Course2004 { sampler: Sampler::Random, samples: 1, filter: None },
            _ => sampling(arguments, compiled.loaded.dialect)?,
        },
        settings: RenderSettings {
            bounces,
            shadows: arguments.has("-shadows") || rules.shadows,
            shade_back: arguments.has("-shade_back") || rules.shade_back,
            transparent_shadows: arguments.has("-transparent_shadows"),
            reflection: !arguments.has("-reflection_off"),
            refraction: !arguments.has("-refraction_off"),
            min_weight: weight.unwrap_or(0.0),
        },
        color: arguments.has("-output"),
        aovs: wanted.iter().filter(|w| arguments.has(w.0)).filter_map(|w| Aov::from_name(w.1)).collect(),
        depth_range,
        ..Job::default()
    })
}

/// Unusual picture size that the 2012 program writes if only one of `-jitter` and `-filter` is
/// given.
#[derive(Clone, Copy, Debug, PartialEq)]
enum OddSize {
    /// Three times the width and height, with one pixel for every sub-pixel.
    Threefold,
    /// A third of the width and height, where each pixel is the mean of 3 by 3 pixels.
    Third,
}

fn odd_size(arguments: &Arguments, compiled: &CompiledInput) -> Option<OddSize> {
    let is_odd = compiled.loaded.rules.has(Quirk::OddSizes);
    match (arguments.has("-jitter"), arguments.has("-filter")) {
        (true, false) if is_odd => Some(OddSize::Threefold),
        (false, true) if is_odd => Some(OddSize::Third),
        _ => None,
    }
}

/// Averages blocks of 3 by 3 pixels.
fn third(layer: &mut Layer) -> Result<(), Failure> {
    let &Image { width, height, ref pixels } = &*layer.image;
    let pixels = average_3x3(pixels, width, height);
    layer.image =
        Arc::new(Image::from_pixels(width / 3, height / 3, pixels).map_err(|error| invalid_input(error.to_string()))?);
    layer.coverage = None;
    Ok(())
}

fn sampling(arguments: &Arguments, dialect: Dialect) -> Result<Sampling, Failure> {
    let (jitter, blur) = (arguments.has("-jitter"), arguments.has("-filter"));
    if jitter || blur {
        // The programs of 2016 and later accept both options but ignore them.
        let ignored = matches!(dialect, Dialect::F16 | Dialect::F23);
        return Ok(if ignored { Sampling::Center } else { Sampling::Course2012 { jitter, blur } });
    }
    let samplers = [
        ("-random_samples", Sampler::Random),
        ("-uniform_samples", Sampler::Uniform),
        ("-jittered_samples", Sampler::Jittered),
    ];
    let sampler = samplers.into_iter().find(|(name, _)| arguments.has(name));
    let radius = |name: &str| -> Result<Option<f32>, Failure> {
        let radius = arguments.number::<f32>(name)?;
        if radius.is_some_and(|r| !(0.0..=64.0).contains(&r)) {
            return Err(invalid_input(format!("{name} must be from 0 to 64")));
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
    let samples = sampler.map(|(name, _)| arguments.number::<u32>(name)).transpose()?.flatten();
    if samples.is_some_and(|n| n == 0 || n > 1 << 16) {
        return Err(invalid_input("the number of samples must be from 1 to 65536"));
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

fn threads(arguments: &Arguments) -> Result<Option<usize>, Failure> {
    let threads = arguments.number("--threads")?;
    if threads.is_some_and(|n| !(1..=1024).contains(&n)) {
        return Err(invalid_input("--threads must be from 1 to 1024"));
    }
    Ok(threads)
}

/// Prints the output of the option `-stats`.
fn stats(compiled: &CompiledInput, control: &Control) {
    let rays = control.rays.load(Relaxed);
    print_line(&format!("objects {}, rays {rays}", compiled.world.objects().len()));
}
