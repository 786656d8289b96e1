//! Renders one picture, from reading the scene file to writing the picture files.

use crate::autosave::Autosave;
use crate::failure::{Failure, from_render_error, invalid_input};
use crate::file_registry::FileRegistry;
use crate::open::{is_stream, load_options, read};
use crate::options::{DIAGRAMS, ERROR, RenderArgs, accel};
use crate::output::{STANDARD_OUTPUT, Target, with_suffix};
use crate::report::rejected;
use crate::stats::StageTimer;
use crate::terminal::{print_error_line, print_line};
use crate::{check, device, diagrams, job, large, output, progress};
use durer::compile::AssetCache;
use durer::image::checked_count;
use durer::integrator::IntegratorKind;
use durer::render::explain::explain;
use durer::render::{
    Backdrop, BandedRender, Control, Job, Panicked, PartialRender, RenderError, RenderOutcome, Rendered, Shard,
    ShardBy, replay,
};
use durer::world::World;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex};

/// State shared between a render and the thread that watches files for `--watch`.
#[derive(Default)]
pub struct WatchState {
    /// Files that the scene refers to, except the scene file itself.
    pub files: Mutex<Vec<PathBuf>>,
    /// True if one of the files has been saved since the render began.
    pub outdated: AtomicBool,
    /// Meshes and images that earlier renders have loaded.
    pub cache: Option<Arc<AssetCache>>,
    control: Mutex<Option<Arc<Control>>>,
}

impl WatchState {
    /// Creates a state that keeps meshes and images between pictures.
    pub fn keeping(cache: &Arc<AssetCache>) -> Self {
        WatchState { cache: Some(Arc::clone(cache)), ..WatchState::default() }
    }

    /// Marks the render as outdated and cancels it.
    pub fn cancel(&self) {
        self.outdated.store(true, Relaxed);
        if let Ok(Some(control)) = self.control.lock().as_deref() {
            control.cancel.store(true, Relaxed);
        }
    }

    /// Registers a render so that it can be cancelled.
    fn register(&self, control: &Arc<Control>) {
        if let Ok(mut place) = self.control.lock() {
            *place = Some(Arc::clone(control));
        }
        if self.outdated.load(Relaxed) {
            control.cancel.store(true, Relaxed);
        }
    }
}

/// A pixel, or one of its samples, whose colour `--pixel` prints instead of writing a picture.
#[derive(Clone, Copy, Default)]
pub struct Pixel {
    pub place: (u32, u32),
    pub sample: Option<u32>,
}

/// Returns the file for the picture, which is the one given by `--output` or the default.
pub fn output_of(args: &RenderArgs) -> PathBuf {
    let stem = if is_stream(&args.scene) { "picture".as_ref() } else { args.scene.file_stem().unwrap_or_default() };
    match &args.output {
        Some(output) if is_stream(output) => STANDARD_OUTPUT.into(),
        Some(output) => output.clone(),
        None => with_suffix(Path::new(stem), ".png"),
    }
}

/// Renders a scene and writes its pictures.
pub fn render_picture(args: &RenderArgs, pixel: Option<Pixel>, watched: &WatchState) -> Result<(), Failure> {
    let shard = match args.work.shard {
        Some(shard) if args.work.shard_by == "samples" => Shard { by: ShardBy::Samples, ..shard },
        shard => shard.unwrap_or(Shard::WHOLE),
    };
    let output = output_of(args);
    if let Some(Pixel { place: (x, y), .. }) = pixel
        && args.view.show.iter().any(|name| name != "color")
    {
        let message = "`--pixel` prints the colour only";
        let advice = format!("`durer explain --pixel {x},{y}` prints the distance, the normal and more");
        return Err(invalid_input(format!("{message}: {advice}")));
    }
    if pixel.is_some() && args.denoise.is_some() {
        return Err(invalid_input("--denoise needs the whole picture: remove it, or --pixel"));
    }
    // Check that the output can be written before starting the work.
    let mut registry = FileRegistry::default();
    let (target, autosave) = match (pixel, args.work.shard) {
        (Some(_), _) => (None, None),
        (_, Some(_)) => (None, Some(Autosave::new(args, &output, &mut registry)?)),
        _ => {
            let target = Target::new(&output, &shows(args)?, &mut registry)?;
            args.display.check_bits(target.format())?;
            (Some(target), Some(Autosave::new(args, &output, &mut registry)?))
        }
    };
    let stats_file = args.stats_file().map(|path| registry.register_output_as("--stats", path, "json")).transpose()?;
    let mut options = load_options(&args.reading);
    let memory = options.memory;
    let threads = args.work.threads.map(usize::from);
    (options.accel, options.threads) = (accel(&args.job)?, threads);
    args.job.options.adapt(&mut options.scene_defaults);
    options.cache = watched.cache.clone();
    let mut stages = StageTimer::start();
    let scene = read(&args.scene, &options, args.quiet, &mut registry)?;
    stages.end_stage("reading");
    let mut job = job::job(&args.job, Some(&args.view), &scene.loaded, args.work.time.is_some())?;
    if let Some(target) = &target
        && job.backdrop == Some(Backdrop::Transparent)
        && !target.format().has_alpha
    {
        let message =
            format!("{} files cannot be transparent: write a PNG, WebP, TGA or EXR file", target.format().name);
        return Err(invalid_input(message));
    }
    let window = job.window();
    let mut needed = PartialRender::bytes_needed(&job, shard);
    let bands = match &target {
        Some(target) if large::is_large(&job, needed, memory) => Some(large::bands(args, &job, target, memory)?),
        target => {
            // Report an invalid size as such, regardless of the memory limit.
            checked_count(window.width, window.height).map_err(|error| invalid_input(error.to_string()))?;
            target.as_ref().map_or(Ok(()), |target| target.check_size(window.width, window.height))?;
            None
        }
    };
    // Memory used by the film is not available to the scene.
    needed = bands.as_ref().map_or(needed, BandedRender::bytes_needed);
    options.memory = memory.map(|memory| memory.saturating_sub(needed));
    if let Some(allowed) = memory.filter(|&memory| needed > memory) {
        return Err(from_render_error(RenderError::Memory { needed, allowed }));
    }
    options.rays = Some(window.pixels().saturating_mul(u64::from(job.sampling.samples())));
    // Without lights, Whitted's method shows flat colours. Other pictures do not need them.
    let shows_lights = job.color && job.method.name() == IntegratorKind::WHITTED.name();
    let unneeded: &[&str] = if shows_lights { &[] } else { &["no-light"] };
    let compiled = scene.compile_without(unneeded, &options, &mut registry)?;
    stages.end_stage("meshes, pictures and trees");
    if let Ok(mut files) = watched.files.lock() {
        *files = compiled.loaded.files();
    }
    if !args.quiet {
        job::warn(&job, &compiled.world);
    }
    let blocker = match (&bands, pixel) {
        (Some(_), _) => Some("a picture larger than the memory"),
        (_, Some(_)) => Some("--pixel"),
        _ => None,
    };
    let mut gpu = device::open(args.work.device, &mut job, &compiled.world, blocker, args.quiet)?;
    let control = Arc::new(Control {
        threads,
        tile_size: args.work.tile,
        time_limit: args.work.time,
        save_every: Some(args.work.checkpoint_every),
        memory,
        accumulates: bands.is_some(),
        ..Control::default()
    });
    watched.register(&control);
    if let (Some(bands), Some(target)) = (&bands, &target) {
        return large::render(bands, &compiled.world, &control, target, args);
    }
    let autosave = match (pixel, autosave) {
        (None, Some(autosave)) => autosave,
        (pixel, _) => return print_pixel(&compiled.world, &job, &control, pixel.unwrap_or_default()),
    };
    let shows_error = args.view.show.iter().any(|show| show == ERROR);
    if shows_error && (target.is_none() || job.method.path_options().is_none()) {
        return Err(invalid_input(
            "--show error needs the full picture and the integrator path or photons: remove --shard, or set \
             --integrator",
        ));
    }
    if args.view.show.iter().any(|show| DIAGRAMS.contains(&show.as_str())) {
        if target.is_none() {
            return Err(invalid_input(
                "diagrams cannot be split into parts: remove --shard, or the diagram from --show",
            ));
        }
        diagrams::check(&job, args.view.zoom()).map_err(from_render_error)?;
    } else if args.view.zoom.is_some() {
        return Err(invalid_input(
            "--zoom magnifies the pictures of --show samples and --show filter: add one of them, or enlarge the \
             picture with --size",
        ));
    }
    let part = autosave.begin(PartialRender::new(&compiled.world, &job, shard).map_err(from_render_error)?)?;
    // A picture in the terminal has a status line of its own.
    let hides_bar = args.quiet || autosave.draws_in_terminal();
    let stop = progress::watch(&control, hides_bar, || {
        let mut watch = |part: &PartialRender, moment| autosave.watch(part, moment);
        device::render(gpu.as_mut(), &part, &compiled.world, &control, &mut watch)
    })
    .map_err(from_render_error)?;
    stages.end_stage("rendering");
    rejected(&part.statistics(), Some(&compiled.world), args.quiet);
    let finished = match &stop {
        RenderOutcome::Finished => true,
        RenderOutcome::OutOfTime => part.is_finished(),
        RenderOutcome::Cancelled if watched.outdated.load(Relaxed) => return Err(Failure::Interrupted(String::new())),
        RenderOutcome::Cancelled => return Err(save_after_interrupt(args, &part, &autosave, target.as_ref())),
        RenderOutcome::Panicked(panicked) => return Err(autosave.after_panic(&part, panicked, &replaying(panicked))),
    };
    match target {
        None => autosave.save(&part)?,
        Some(target) => {
            let display = args.display.display_of(&part, args.quiet)?;
            let plain = args.view.show == ["color"] && args.denoise.is_none() && !autosave.draws_in_terminal();
            let saved = || if plain { target.save_colors(&part, display, args.quiet) } else { Ok(None) };
            let (looks, pictures) = match durer::threads::install(threads, saved)? {
                Some(looks) => (Some(looks), Vec::new()),
                None => {
                    let rendered = pictures(args, &compiled.world, &part, &control)?;
                    let files = durer::threads::install(threads, || target.files(&rendered, display))?;
                    if let Some(first) = rendered.pictures.first() {
                        autosave.draw_final(first, display);
                    }
                    output::save(&files, args.quiet)?;
                    (check::scan(&job, &rendered.pictures, display.exposure), rendered.pictures)
                }
            };
            autosave.done(&part, finished);
            if finished && !args.quiet {
                check::after_render(&compiled, &job, looks.as_ref(), &pictures, &part.statistics(), display);
            }
        }
    }
    if !finished && !args.quiet {
        print_error_line(&format!("note: the time limit ended the render after {} samples", part.statistics().samples));
    }
    stages.end_stage("writing");
    match (stats_file, &args.stats) {
        (Some(file), _) => output::save(&[(&file, stages.json(&compiled.world, &part)?)], args.quiet)?,
        (None, Some(_)) => stages.report(&compiled.world, &part)?,
        (None, None) => {}
    }
    if args.hash {
        print_line(&part.hash().to_string());
    }
    Ok(())
}

/// Returns every picture of a part file, including diagrams, error bounds and the denoised picture.
fn pictures(
    args: &RenderArgs,
    world: &World,
    part: &PartialRender,
    control: &Arc<Control>,
) -> Result<Rendered, Failure> {
    let (job, threads) = (part.job(), control.threads);
    let mut rendered = durer::threads::install(threads, || part.pictures()).map_err(from_render_error)?;
    diagrams::add(&args.view.show, args.view.zoom(), world, job, control, &mut rendered).map_err(from_render_error)?;
    if args.view.show.iter().any(|show| show == ERROR) {
        let [values, shown] = part.error(world, threads).map_err(from_render_error)?;
        rendered.layers.push(values);
        rendered.pictures.push(shown);
    }
    if let (Some(denoiser), true) = (args.denoise, job.color) {
        let noisy = part.noisy(world, threads).map_err(from_render_error)?;
        let clean = denoiser.clean(noisy, threads, args.quiet)?;
        for shown in rendered.pictures.iter_mut().filter(|layer| layer.name == "color") {
            shown.image = clean.image.clone();
        }
        rendered.layers.push(clean);
    }
    Ok(rendered)
}

/// Returns the names of the pictures to show, without duplicates.
fn shows(args: &RenderArgs) -> Result<Vec<&str>, Failure> {
    let names: Vec<&str> = args.view.show.iter().map(String::as_str).collect();
    match (1..names.len()).find(|&i| names[..i].contains(&names[i])) {
        Some(twice) => Err(invalid_input(format!("--show: `{}` is given twice", names[twice]))),
        None => Ok(names),
    }
}

/// Saves the work after Ctrl-C. The picture is written only if every pixel has a sample because it
/// could replace a better one.
fn save_after_interrupt(
    args: &RenderArgs,
    part: &PartialRender,
    autosave: &Autosave,
    target: Option<&Target>,
) -> Failure {
    let mut written = autosave.after_interrupt(part);
    if let Some(target) = target.filter(|_| part.is_whole()) {
        let display = args.display.display_of(part, args.quiet).unwrap_or_default();
        let files = part.pictures().map_err(from_render_error).and_then(|rendered| target.files(&rendered, display));
        if let Ok(files) = files.and_then(|files| output::save_silently(&files).map(|()| files)) {
            written.extend(files.into_iter().map(|(place, _)| place.path().display().to_string()));
        }
    }
    let (all, done) = part.work();
    Failure::Interrupted(match written.is_empty() {
        true => "nothing was written".into(),
        false => format!("{} % done, saved in {}", 100 * done / all.max(1), written.join(" and ")),
    })
}

/// Returns a command that reproduces a panic. It is this command line with the pixel and sample
/// added.
fn replaying(panicked: &Panicked) -> String {
    let words = std::env::args().chain(["--pixel".into(), format!("{},{}", panicked.x, panicked.y)]);
    let sample = panicked.sample.map(|sample| ["--sample".to_string(), sample.to_string()]);
    let words: Vec<String> = words.chain(sample.into_iter().flatten()).collect();
    shlex::try_join(words.iter().map(String::as_str)).unwrap_or_default()
}

/// Prints the colour of a pixel or sample for `--pixel`. The colour of a pixel is that of the
/// picture.
fn print_pixel(world: &World, job: &Job, control: &Control, pixel: Pixel) -> Result<(), Failure> {
    let Pixel { place: (x, y), sample } = pixel;
    // This also repeats a panic outside the samples.
    let mut color = replay(world, job, control, (x, y), sample).map_err(from_render_error)?;
    if sample.is_none() {
        let explain = || explain(world, job, x, y);
        let explained = durer::threads::install(control.threads, explain).map_err(from_render_error)?;
        color = (explained.coverage > 0.0).then_some(explained.color);
    }
    let sample = sample.map(|sample| format!(", sample {sample}")).unwrap_or_default();
    let shown = color.map_or("the camera sees nothing there".into(), |c| format!("{:?} {:?} {:?}", c.x, c.y, c.z));
    print_line(&format!("pixel {x},{y}{sample}: {shown}"));
    Ok(())
}
