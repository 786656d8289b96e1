//! From options to a job.

use crate::failure::{Failure, bad};
use crate::options::{JobArgs, SceneArgs, ViewArgs};
use crate::{method, report};
use durer::Loaded;
use durer::camera::{Projection, Raster};
use durer::compile::AccelKind;
use durer::diag::Diagnostic;
use durer::dialect::{Compat, Dialect};
use durer::film::Filter;
use durer::film::aov::Aov;
use durer::film::false_color::LightScale;
use durer::integrator::{Method, Settings};
use durer::render::course::CourseFilter;
use durer::render::{Crop, Job, Sampling};
use durer::sampler::Sampler;
use durer::world::World;

/// Samples where noise or time decides when there are enough.
const MAX_FOR_NOISE: u32 = 4096;
const MAX_FOR_TIME: u32 = 1 << 20;

/// How often paths are scattered after the first time, unless asked otherwise.
pub const PATH_BOUNCES: u32 = 16;

/// The structure that the options ask for.
pub fn accel(args: &JobArgs) -> Result<AccelKind, Failure> {
    if args.grid.is_some() && args.accel != "grid" {
        return Err(bad(format!("--grid makes no sense with --accel {}", args.accel)));
    }
    Ok(match args.accel.as_str() {
        "grid" => AccelKind::Grid(args.grid),
        "none" => AccelKind::None,
        _ => AccelKind::Bvh,
    })
}

/// The width over the height of the picture that the options ask for.
pub fn aspect(args: &JobArgs) -> Option<f32> {
    args.size.map(|(width, height)| width as f32 / height.max(1) as f32)
}

/// The job that the options ask for, the colour of the whole picture without a view; `timed` if
/// time decides when it ends.
pub fn job(args: &JobArgs, view: Option<&ViewArgs>, loaded: &Loaded, timed: bool) -> Result<Job, Failure> {
    let rules = &loaded.rules;
    // Ours is a dialect like others to ask for, but not an old program.
    let asked = loaded.guess.is_none() && loaded.dialect != Dialect::Durer;
    let camera = loaded.scene.camera.as_ref();
    let proportions = camera.and_then(|camera| camera.proportions());
    let wishes = loaded.scene.wishes;
    let (width, height) = args.size.or(wishes.size).unwrap_or_else(|| Raster::natural_size(proportions, rules.size));
    // A blur needs more samples than an edge.
    let method = args.method.method(method::usual(&loaded.scene))?;
    let plenty = if camera.is_some_and(|camera| camera.has_aperture()) || method.is_random() { 64 } else { 16 };
    let plenty = wishes.samples.unwrap_or(plenty);
    if method.is_random() && (args.jitter || args.blur) {
        return Err(bad(format!("--jitter and --blur make no sense with --integrator {}", method.name())));
    }
    let bounces = usual_bounces(method, loaded);
    let shown = view.map_or(&[][..], |view| &view.show);
    let depth_range = args.depth_range.as_ref().map(|range| (range[0], range[1]));
    if depth_range.is_some_and(|(min, max)| !(min.is_finite() && max.is_finite() && min != max)) {
        return Err(bad("--depth-range needs two different numbers"));
    }
    let light_scale = match args.light_range.as_deref() {
        Some(&[low, high]) => {
            let least = if args.light_log { f32::MIN_POSITIVE } else { 0.0 };
            if !(low >= least && high > low && high.is_finite()) {
                return Err(bad(match args.light_log {
                    true => "--light-range needs two numbers above 0 with --light-log, the second greater",
                    false => "--light-range needs two numbers from 0 on, the second greater",
                }));
            }
            Some(LightScale { low, high, logarithmic: args.light_log })
        }
        _ => None,
    };
    // Of a picture of another size it would be another part.
    let wished = wishes.crop.filter(|_| wishes.size == Some((width, height)));
    Ok(Job {
        width,
        height,
        crop: view.and_then(|view| view.crop.or(wished)).map(|(left, top, width, height)| Crop {
            left,
            top,
            width,
            height,
        }),
        seed: args.seed,
        sampling: sampling(args, asked, timed, plenty)?,
        noise: args.noise,
        adaptive: args.adaptive,
        method,
        settings: Settings {
            bounces: args.bounces.unwrap_or(bounces),
            shadows: args.shadows.unwrap_or(rules.shadows),
            shade_back: args.shade_back.unwrap_or(rules.shade_back),
            transparent_shadows: args.transparent_shadows || rules.transparent_shadows,
            reflection: !args.no_reflection,
            refraction: !args.no_refraction,
            least_weight: args.weight.unwrap_or(if asked { 0.0 } else { 1.0 / 256.0 }),
        },
        color: view.is_none() || shown.iter().any(|show| show == "color"),
        aovs: shown.iter().filter_map(|name| Aov::from_name(name)).collect(),
        depth_range,
        light_scale,
    })
}

/// How often light is scattered, or reflected, after the first time, unless asked otherwise.
fn usual_bounces(method: Method, loaded: &Loaded) -> u32 {
    match method.transport() {
        Some(_) => loaded.scene.wishes.bounces.unwrap_or(PATH_BOUNCES),
        None => loaded.rules.bounces,
    }
}

/// Warns of a picture that its camera does not fill, or whose lens stays unused.
pub fn warn(job: &Job, world: &World) {
    let camera = world.camera();
    let (columns, rows) = durer::render::raster(world, job.width, job.height).empty();
    if (columns, rows) != (0, 0) {
        let (count, what) = if columns > 0 { (columns, "columns") } else { (rows, "rows") };
        let (w, h) = Raster::natural_size(camera.proportions(), (job.width, job.height));
        report::note(&Diagnostic::warning(format!(
            "{count} {what} of {}x{} stay empty: this camera's picture has another shape; `--size {w}x{h}` has it",
            job.width, job.height
        )));
    }
    if job.sampling == Sampling::Center && camera.has_aperture() {
        let message = "with one sample a pixel only the middle of the lens is used, and nothing is out of focus; ask for \
                       more `--samples`, 64 say";
        report::note(&Diagnostic::warning(message));
    }
}

fn sampling(args: &JobArgs, asked: bool, timed: bool, plenty: u32) -> Result<Sampling, Failure> {
    if args.jitter || args.blur {
        return Ok(Sampling::Course2012 { jitter: args.jitter, blur: args.blur });
    }
    if args.filter_radius.is_some_and(|r| !(r > 0.0 && r <= 64.0)) {
        return Err(bad("--filter-radius must be more than 0 and at most 64"));
    }
    let sampler = Sampler::from_name(&args.sampler).unwrap_or_default();
    if matches!(sampler, Sampler::Uniform | Sampler::Jittered) && (args.noise.is_some() || timed) {
        return Err(bad(
            "--noise-threshold and --time-limit need a sampler whose first samples are spread over the pixel: sobol or random",
        ));
    }
    if args.adaptive && timed && args.samples.is_none() {
        return Err(bad("--adaptive divides a number of samples: with --time-limit, say how many with --samples"));
    }
    let filter = args.filter.as_deref().and_then(Filter::from_name);
    let usual = match (asked, args.noise.is_some(), timed) {
        (true, ..) => 1,
        (false, true, _) => MAX_FOR_NOISE,
        (false, false, true) => MAX_FOR_TIME,
        (false, false, false) => plenty,
    };
    let samples = args.samples.unwrap_or(usual);
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

/// The options that make a job of a scene, but for its size: those that are not what the scene has
/// by itself.
pub fn spelled(reading: &SceneArgs, job: &Job, loaded: &Loaded) -> String {
    let asked = loaded.guess.is_none();
    let mut words: Vec<String> = Vec::new();
    let mut add = |word: String| words.push(word);
    if asked {
        add(format!("--dialect {}", loaded.dialect.name()));
    }
    for (compat, on) in &reading.compat {
        let name = Compat::ALL.iter().find(|row| row.0 == *compat).map_or("", |row| row.1);
        add(format!("--compat {}{name}", if *on { "" } else { "no-" }));
    }
    for assets in &reading.assets {
        add(format!("--assets {}", shlex::try_quote(&assets.to_string_lossy()).unwrap_or_default()));
    }
    for (flag, on) in [("--strict", reading.strict), ("--allow-outside", reading.allow_outside)] {
        if on {
            add(flag.into());
        }
    }
    let (settings, rules) = (&job.settings, &loaded.rules);
    method::spelled(job.method, &loaded.scene).into_iter().for_each(&mut add);
    let bounces = usual_bounces(job.method, loaded);
    if settings.bounces != bounces {
        add(format!("--bounces {}", settings.bounces));
    }
    for (name, value, usual) in
        [("shadows", settings.shadows, rules.shadows), ("shade-back", settings.shade_back, rules.shade_back)]
    {
        if value != usual {
            add(format!("--{name}={}", if value { "on" } else { "off" }));
        }
    }
    let flags = [
        ("--transparent-shadows", settings.transparent_shadows && !rules.transparent_shadows),
        ("--no-reflection", !settings.reflection),
        ("--no-refraction", !settings.refraction),
    ];
    flags.into_iter().filter(|flag| flag.1).for_each(|flag| add(flag.0.into()));
    let old = asked && loaded.dialect != Dialect::Durer;
    if settings.least_weight != if old { 0.0 } else { 1.0 / 256.0 } {
        add(format!("--min-throughput {}", settings.least_weight));
    }
    match job.sampling {
        Sampling::Center if !old => add("--samples 1".into()),
        Sampling::Center => {}
        Sampling::Filtered { samples, filter } => {
            add(format!("--samples {samples}"));
            if filter != Filter::default() {
                let of_kind = |row: &&(&str, Filter)| row.1.with_radius(filter.radius()) == filter;
                let name = Filter::NAMES.iter().find(of_kind).map_or("", |row| row.0);
                add(format!("--filter {name} --filter-radius {}", filter.radius()));
            }
        }
        Sampling::Course2004 { sampler, samples, filter } => {
            let names = Sampler::NAMES.iter().find(|row| row.1 == sampler).map_or("sobol", |row| row.0);
            add(format!("--sampler {names} --samples {samples}"));
            match filter {
                None => {}
                Some(CourseFilter::Box { radius }) => add(format!("--filter box --filter-radius {radius}")),
                Some(CourseFilter::Tent { radius }) => add(format!("--filter tent --filter-radius {radius}")),
                Some(CourseFilter::Gaussian { sigma }) => add(format!("--filter gaussian --filter-radius {sigma}")),
            }
        }
        Sampling::Course2012 { jitter, blur } => {
            [("--jitter", jitter), ("--blur", blur)].iter().filter(|f| f.1).for_each(|f| add(f.0.into()));
        }
    }
    if job.seed != 0 {
        add(format!("--seed {}", job.seed));
    }
    words.join(" ")
}
