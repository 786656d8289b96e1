//! `durer render`.

use crate::args::{DIAGRAMS, RenderArgs, SceneArgs};
use crate::output::Target;
use crate::{Failure, bad, output, progress, report};
use durer::LoadOptions;
use durer::compile::AccelKind;
use durer::diag::{Diagnostic, Diagnostics, Files};
use durer::dialect::Dialect;
use durer::film::aov::Aov;
use durer::film::course::CourseFilter;
use durer::film::{Filter, diagram};
use durer::image::{Image, Layer, Transfer};
use durer::integrator::Settings;
use durer::math::Vec2;
use durer::render::{Control, Crop, Job, RenderError, Rendered, Sampling};
use durer::sampler::Sampler;
use durer::world::World;
use durer::{Loaded, load};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene that was read and compiled, its findings printed.
pub struct Opened {
    pub loaded: Loaded,
    pub world: World,
    pub files: Files,
}

/// Reads and compiles a scene; prints what is found.
pub fn open(path: &Path, options: &LoadOptions, quiet: bool) -> Result<Opened, Failure> {
    let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
    let loaded = load(path, options, &mut files, &mut diagnostics).map_err(report::unreadable)?;
    let opened = loaded.and_then(|loaded| {
        let world = loaded.compile(options, &mut files, &mut diagnostics)?;
        Some((loaded, world))
    });
    if let (Some(guess), false) = (opened.as_ref().and_then(|(loaded, _)| loaded.guess.as_ref()), quiet) {
        report::note(&guess.note());
    }
    report::print(&files, &diagnostics, quiet);
    let (loaded, world) = opened.ok_or(Failure::Input(None))?;
    Ok(Opened { loaded, world, files })
}

/// What the options about reading say.
pub fn load_options(args: &SceneArgs) -> LoadOptions {
    LoadOptions {
        dialect: args.dialect.as_deref().and_then(Dialect::from_name),
        compat: args.compat.clone(),
        strict: args.strict,
        allow_outside: args.allow_outside,
        assets: args.assets.clone(),
        ..LoadOptions::default()
    }
}

pub fn run(args: &RenderArgs) -> Result<(), Failure> {
    let default_name = || {
        let mut name = args.scene.file_stem().unwrap_or_default().to_os_string();
        name.push(".png");
        PathBuf::from(name)
    };
    let names: Vec<&str> = args.show.iter().map(String::as_str).collect();
    if let Some(twice) = (1..names.len()).find(|&i| names[..i].contains(&names[i])) {
        return Err(bad(format!("--show: `{}` is asked for twice", names[twice])));
    }
    let target = Target::new(args.output.clone().unwrap_or_else(default_name), &names)?;
    let transfer = Transfer::from_name(&args.transfer).unwrap_or_default();
    let mut options = load_options(&args.reading);
    if args.grid.is_some() && args.accel != "grid" {
        return Err(bad(format!("--grid makes no sense with --accel {}", args.accel)));
    }
    options.accel = match args.accel.as_str() {
        "grid" => AccelKind::Grid(args.grid),
        "none" => AccelKind::None,
        _ => AccelKind::Bvh,
    };
    let opened = open(&args.scene, &options, args.quiet)?;
    let job = job(args, &opened)?;
    if args.show.iter().any(|show| DIAGRAMS.contains(&show.as_str())) {
        check_diagram(&job, args.zoom).map_err(failure)?;
    }
    let control = Arc::new(Control { threads: args.threads.map(usize::from), ..Control::default() });
    let rendered = progress::watch(&job, &control, args.quiet, || {
        let mut rendered = durer::render::render(&opened.world, &job, &control)?;
        diagrams(args, &opened.world, &job, &control, &mut rendered)?;
        Ok(rendered)
    })
    .map_err(failure)?;
    rejected(&rendered, args.quiet);
    let files = target.files(&rendered, transfer)?;
    drop(rendered);
    output::save(&files, args.quiet)
}

/// What a failed render means for the shell.
pub fn failure(error: RenderError) -> Failure {
    match error {
        RenderError::Cancelled => Failure::Interrupted,
        RenderError::Threads(_) => error.into(),
        _ => bad(error.to_string()),
    }
}

/// Says which samples were left out.
pub fn rejected(rendered: &Rendered, quiet: bool) {
    if let (Some(first), false) = (rendered.first_rejected.first(), quiet) {
        let count = rendered.rejected;
        report::note(&Diagnostic::warning(format!(
            "{count} samples were not finite numbers and were left out, the first in pixel {},{} (sample {})",
            first.x, first.y, first.sample
        )));
    }
}

/// What the options and the scene say of the picture.
pub fn job(args: &RenderArgs, opened: &Opened) -> Result<Job, Failure> {
    let rules = &opened.loaded.rules;
    // Ours is a dialect like others to ask for, but not an old program.
    let asked = opened.loaded.guess.is_none() && opened.loaded.dialect != Dialect::Durer;
    let (width, height) = args.size.unwrap_or(rules.size);
    let shows = |name: &str| args.show.iter().any(|show| show == name);
    let depth_range = args.depth_range.as_ref().map(|range| (range[0], range[1]));
    if depth_range.is_some_and(|(min, max)| !(min.is_finite() && max.is_finite() && min != max)) {
        return Err(bad("--depth-range needs two different numbers"));
    }
    Ok(Job {
        width,
        height,
        crop: args.crop.map(|(left, top, width, height)| Crop { left, top, width, height }),
        seed: args.seed,
        sampling: sampling(args, asked)?,
        settings: Settings {
            bounces: args.bounces.unwrap_or(rules.bounces),
            shadows: args.shadows.unwrap_or(rules.shadows),
            shade_back: args.shade_back.unwrap_or(rules.shade_back),
            transparent_shadows: args.transparent_shadows || rules.transparent_shadows,
            reflection: !args.no_reflection,
            refraction: !args.no_refraction,
            least_weight: args.weight.unwrap_or(if asked { 0.0 } else { 1.0 / 256.0 }),
        },
        color: shows("color"),
        aovs: args.show.iter().filter_map(|name| Aov::from_name(name)).collect(),
        depth_range,
    })
}

fn sampling(args: &RenderArgs, asked: bool) -> Result<Sampling, Failure> {
    if args.jitter || args.blur {
        return Ok(Sampling::Course2012 { jitter: args.jitter, blur: args.blur });
    }
    if args.filter_radius.is_some_and(|r| !(r > 0.0 && r <= 64.0)) {
        return Err(bad("--filter-radius must be more than 0 and at most 64"));
    }
    let sampler = Sampler::from_name(&args.sampler).unwrap_or_default();
    let filter = args.filter.as_deref().and_then(Filter::from_name);
    let samples = args.samples.unwrap_or(if asked { 1 } else { 16 });
    if sampler == Sampler::Sobol {
        let filter = filter.unwrap_or_default();
        let filter = args.filter_radius.map_or(filter, |radius| filter.with_radius(radius));
        return Ok(if samples == 1 { Sampling::Center } else { Sampling::Filtered { samples, filter } });
    }
    let filter = match filter {
        None => None,
        Some(Filter::Box { .. }) => Some(CourseFilter::Box { radius: args.filter_radius.unwrap_or(0.5) }),
        Some(Filter::Tent { .. }) => Some(CourseFilter::Tent { radius: args.filter_radius.unwrap_or(1.0) }),
        Some(Filter::Gaussian { .. }) => Some(CourseFilter::Gaussian { sigma: args.filter_radius.unwrap_or(0.5) }),
        Some(_) => return Err(bad("the course's samplers take the filters box, tent and gaussian")),
    };
    Ok(Sampling::Course2004 { sampler, samples, filter })
}

/// Adds the diagrams of samples and filter.
fn diagrams(
    args: &RenderArgs,
    world: &World,
    job: &Job,
    control: &Control,
    rendered: &mut Rendered,
) -> Result<(), RenderError> {
    for show in &args.show {
        let made = match show.as_str() {
            "samples" => samples_layer(world, job, control, args.zoom)?,
            "filter" => filter_layer(job, args.zoom)?,
            _ => continue,
        };
        rendered.layers.push(made.clone());
        rendered.pictures.push(made);
    }
    Ok(())
}

/// Where samples lie, as a layer.
pub fn samples_layer(world: &World, job: &Job, control: &Control, zoom: u32) -> Result<Layer, RenderError> {
    let stored = durer::render::sample_diagram(world, job, control)?;
    layer("samples", diagram::samples(&stored, zoom))
}

/// A filter's weights, as a layer.
pub fn filter_layer(job: &Job, zoom: u32) -> Result<Layer, RenderError> {
    let made = match job.sampling {
        Sampling::Course2004 { filter, .. } => {
            diagram::filter(job.width, job.height, zoom, filter.unwrap_or(CourseFilter::Box { radius: 0.5 }))
        }
        Sampling::Filtered { filter, .. } => {
            let most = filter.weight(0.0, 0.0);
            let support = (filter.radius() - 0.5).ceil().max(0.0) as u32;
            let weight = |offset: Vec2| filter.weight(offset.x, offset.y) / most;
            diagram::weights(job.width, job.height, zoom, support, weight)
        }
        _ => diagram::filter(job.width, job.height, zoom, CourseFilter::Box { radius: 0.5 }),
    };
    layer("filter", made)
}

/// Refuses a diagram too large before it is made.
pub fn check_diagram(job: &Job, zoom: u32) -> Result<(), RenderError> {
    let side = |pixels: u32| pixels.saturating_mul(zoom).saturating_add(1);
    let (width, height) = (side(job.width), side(job.height));
    if u64::from(width) * u64::from(height) > 1 << 24 {
        let message = "a diagram of so many pixels is too large; ask for a smaller --size or --zoom";
        return Err(RenderError::Diagram(message.into()));
    }
    Ok(())
}

fn layer(name: &str, made: diagram::Diagram) -> Result<Layer, RenderError> {
    Ok(Layer::data(name, Image::from_pixels(made.width, made.height, made.pixels)?))
}
