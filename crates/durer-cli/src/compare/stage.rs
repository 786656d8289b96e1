//! Opens the scene of a pair of pictures and finds the options with which the reference was
//! rendered.

use super::args::RenderingArgs;
use super::pairs::Pair;
use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::job;
use crate::open::{CompiledInput, load_options, open, readable};
use durer::LoadOptions;
use durer::dialect::Dialect;
use durer::image::Transfer;
use durer::image::compare::Picture;
use durer::mistakes::{DiagnosisInput, off};
use durer::render::{Job, Sampling};
use std::path::{Path, PathBuf};

/// Maximum fraction of differing pixels for which the options count as those of the reference.
const MAX_SAME: f64 = 0.01;
/// Limit used instead of [`MAX_SAME`] for filters that are wider than a pixel.
const MAX_SAME_FILTERED: f64 = 0.2;

/// A compiled scene with the options that reproduce the reference, used to explain differences.
pub struct ReferenceScene {
    pub compiled: CompiledInput,
    pub job: Job,
    pub transfer: Transfer,
    /// Scene file.
    pub path: PathBuf,
    /// Command-line options that reproduce the picture, except its size.
    pub options: String,
    /// Note about the options if they were inferred.
    pub note: Option<String>,
}

/// Options that may have been used to render the reference.
struct RenderGuess {
    dialect: Option<Dialect>,
    center: bool,
    shadows: Option<bool>,
    bounces: Option<u32>,
}

/// Opens the scene of a pair and finds the options that reproduce the reference. If the given
/// options do not reproduce it, tries the ones that students often forget: the dialect, one sample
/// per pixel, shadows, and the number of bounces.
pub fn stage(
    scene: &Path,
    args: &RenderingArgs,
    pair: &Pair,
    reference: &Picture,
    registry: &mut FileRegistry,
) -> Result<ReferenceScene, Failure> {
    let path = path(scene, pair)?;
    let requested = load_options(&args.reading);
    let first = compiled(args, &path, &requested, reference, registry)?;
    let transfer = args.transfer();
    let mut best = (reference_difference(&first, reference, transfer), first, transfer, None);
    // With filters wider than a pixel, edges cannot be reproduced exactly.
    let enough = if best.1.1.sampling.is_local() { MAX_SAME } else { MAX_SAME_FILTERED };
    // The course's programs have no path tracer, so there are no other dialects to try in this
    // case.
    if best.0 <= enough || best.1.1.method.path_options().is_some() {
        return Ok(reference_scene(args, path, best.1, best.2, None));
    }
    let guessed = requested.dialect.or(best.1.0.loaded.guess.as_ref().map(|guess| guess.dialect));
    let mut dialects = vec![requested.dialect];
    if requested.dialect.is_none() {
        dialects.push(guessed);
        let others = Dialect::ALL.into_iter().filter(|dialect| Some(*dialect) != guessed && *dialect != Dialect::Durer);
        dialects.extend(others.map(Some));
    }
    let shadows =
        if args.job.options.get("shadows").is_some() { vec![None] } else { vec![None, Some(true), Some(false)] };
    let bounces = if args.job.options.get("bounces").is_some() {
        vec![None]
    } else {
        vec![None, Some(4), Some(0), Some(1), Some(2)]
    };
    'found: for dialect in dialects {
        let options = LoadOptions { dialect, ..load_options(&args.reading) };
        // Skip dialects in which the scene cannot be read.
        let Some((compiled, job)) = tried(args, &path, &options, reference, registry) else { continue };
        let mut current = (compiled, job);
        for candidate in shadows.iter().flat_map(|&shadows| {
            bounces
                .iter()
                .flat_map(move |&bounces| [false, true].map(|center| RenderGuess { dialect, center, shadows, bounces }))
        }) {
            let kept = current.1.clone();
            candidate.apply(&mut current.1);
            let tried = [transfer, Transfer::Course, Transfer::Linear, Transfer::Srgb];
            for transfer in tried {
                let off = reference_difference(&current, reference, transfer);
                if off < 0.5 * best.0 {
                    let again = reopened(args, &path, &options, reference, &candidate, registry)?;
                    best = (off, again, transfer, Some(candidate.dialect));
                }
                if best.0 <= MAX_SAME {
                    break 'found;
                }
            }
            current.1 = kept;
        }
    }
    let (off, found, transfer, _) = best;
    let mut stage = reference_scene(args, path, found, transfer, None);
    if off <= MAX_SAME {
        stage.note = Some(format!("inferred that the reference was rendered with `{}`", stage.options));
    }
    Ok(stage)
}

impl RenderGuess {
    fn apply(&self, job: &mut Job) {
        if self.center {
            job.sampling = Sampling::Center;
        }
        job.settings.shadows = self.shadows.unwrap_or(job.settings.shadows);
        job.settings.bounces = self.bounces.unwrap_or(job.settings.bounces);
    }
}

fn reopened(
    args: &RenderingArgs,
    path: &Path,
    options: &LoadOptions,
    reference: &Picture,
    guess: &RenderGuess,
    registry: &mut FileRegistry,
) -> Result<(CompiledInput, Job), Failure> {
    let (compiled, mut job) = compiled(args, path, options, reference, registry)?;
    guess.apply(&mut job);
    Ok((compiled, job))
}

/// Opens the scene in a candidate dialect. Returns `None` if the scene cannot be read in it.
fn tried(
    args: &RenderingArgs,
    path: &Path,
    options: &LoadOptions,
    reference: &Picture,
    registry: &mut FileRegistry,
) -> Option<(CompiledInput, Job)> {
    let is_readable = options.dialect.is_none() || readable(path, options);
    is_readable.then(|| compiled(args, path, options, reference, registry).ok()).flatten()
}

fn compiled(
    args: &RenderingArgs,
    path: &Path,
    options: &LoadOptions,
    reference: &Picture,
    registry: &mut FileRegistry,
) -> Result<(CompiledInput, Job), Failure> {
    let compiled = open(path, options, true, registry)?;
    let job = job::job(&args.job, Some(&args.view), &compiled.loaded, false)?;
    if !job.color || !job.aovs.is_empty() {
        return Err(invalid_input("`--scene` needs colour pictures: remove `--show` or `--scene`"));
    }
    let (width, height) = (reference.image.width, reference.image.height);
    let job = Job { width, height, crop: None, color: true, aovs: Vec::new(), ..job };
    Ok((compiled, job))
}

fn reference_difference((compiled, job): &(CompiledInput, Job), reference: &Picture, transfer: Transfer) -> f64 {
    off(&DiagnosisInput {
        scene: &compiled.loaded.scene,
        world: &compiled.world,
        job,
        transfer,
        reference,
        test: reference,
    })
}

fn reference_scene(
    args: &RenderingArgs,
    path: PathBuf,
    (compiled, job): (CompiledInput, Job),
    transfer: Transfer,
    note: Option<String>,
) -> ReferenceScene {
    let mut options = job::spelled(&args.reading, &job, &compiled.loaded);
    if transfer != Transfer::Srgb {
        options += &format!(" --transfer {}", transfer.name());
    }
    ReferenceScene { options: options.trim().into(), compiled, job, transfer, path, note }
}

impl ReferenceScene {
    /// Returns the command that explains a pixel of the reference.
    pub fn explain(&self, (x, y): (u32, u32)) -> String {
        let shown = self.path.to_string_lossy();
        let quoted = shlex::try_quote(&shown).unwrap_or_default();
        let Job { width, height, .. } = self.job;
        let gap = if self.options.is_empty() { "" } else { " " };
        format!("durer explain {quoted} --pixel {x},{y} --size {width}x{height}{gap}{}", self.options)
    }
}

/// Returns the path of the scene for a pair of pictures. In a folder, this is the file with the
/// same name as the picture.
fn path(scene: &Path, pair: &Pair) -> Result<PathBuf, Failure> {
    if !scene.is_dir() {
        return Ok(scene.into());
    }
    let name = Path::new(&pair.name).with_extension("txt");
    let path = scene.join(&name);
    match path.exists() {
        true => Ok(path),
        false => Err(invalid_input(format!("no `{}` in `{}`", name.display(), scene.display()))),
    }
}
