//! Converts command-line options to a render job.

use crate::failure::{Failure, invalid_input};
use crate::options::{JobArgs, SceneArgs, ViewArgs};
use crate::report;
use durer::LoadedScene;
use durer::camera::{Projection, Raster};
use durer::diag::Diagnostic;
use durer::dialect::Quirk;
use durer::integrator::IntegratorKind;
use durer::job::{OutputSelection, RenderJob};
use durer::render::{Job, Sampling};
use durer::world::World;

/// Returns the job for the options. Without `view`, the job renders the whole colour picture.
/// `timed` is true if a time limit ends the render.
pub fn job(args: &JobArgs, view: Option<&ViewArgs>, loaded: &LoadedScene, timed: bool) -> Result<Job, Failure> {
    let view = view.map(|view| OutputSelection { crop: view.crop, show: view.show.clone() });
    args.options.resolve(&loaded.job_context(timed), view.as_ref()).map_err(invalid_input)
}

/// Warns if the camera leaves part of the picture empty, if depth of field needs more samples, if
/// photons are of no use, or if two integrators compute the pictures.
pub fn warn(job: &Job, world: &World) {
    let camera = world.camera();
    let (columns, rows) = durer::render::raster(world, job.width, job.height).empty();
    if (columns, rows) != (0, 0) {
        let (count, what) = if columns > 0 { (columns, "columns") } else { (rows, "rows") };
        let (w, h) = Raster::natural_size(camera.proportions(), (job.width, job.height));
        report::note(&Diagnostic::warning(format!(
            "{count} {what} of the {}x{} picture stay empty: the camera has a different aspect ratio; use `--size \
             {w}x{h}` to match the camera",
            job.width, job.height
        )));
    }
    if job.sampling == Sampling::Center && camera.has_aperture() {
        let message = "one sample per pixel uses only the centre of the lens, so everything is in focus; use more \
                       `--samples`, for example 64";
        report::note(&Diagnostic::warning(message));
    }
    let shows = |name: &str| job.aovs.iter().any(|aov| aov.name == name);
    if job.method.path_options().is_none() && shows("illuminance") && (job.color || shows("luminance")) {
        let method = job.method.name();
        let message = format!("the illuminance is that of path tracing, and the other pictures are by {method}");
        report::note(&Diagnostic::warning(message).help("`--integrator path` computes all of them"));
    }
    if matches!(job.method, IntegratorKind::Photons(_)) && !world.casts_caustics() {
        let message = "photons have no effect: no object reflects or refracts light sharply";
        let help = "a smooth surface has `specularRoughness 0`; the default of a `PrincipledMaterial` is 0.3";
        report::note(&Diagnostic::warning(message).help(help));
    }
}

/// Returns the command-line options that reproduce a job, except the picture size. Options that are
/// equal to the scene's defaults are omitted.
pub fn spelled(reading: &SceneArgs, job: &Job, loaded: &LoadedScene) -> String {
    let requested = loaded.guess.is_none();
    let mut words: Vec<String> = Vec::new();
    let mut add = |word: String| words.push(word);
    if requested {
        add(format!("--dialect {}", loaded.dialect.name()));
    }
    for (compat, on) in &reading.compat {
        let name = Quirk::ALL.iter().find(|row| row.0 == *compat).map_or("", |row| row.1);
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
    words.extend(RenderJob::of(job, &loaded.job_context(false)).to_arguments());
    words.join(" ")
}
