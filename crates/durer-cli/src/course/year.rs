//! Chooses the dialect of a scene whose keywords and options fit several years.
//!
//! A small picture is rendered in the guessed dialect. If it has NaN samples, the first other
//! fitting dialect whose picture has no NaN samples is used instead.

use super::job;
use super::options::Arguments;
use crate::failure::{Failure, from_render_error};
use crate::file_registry::FileRegistry;
use crate::open::{CompiledInput, read};
use crate::report;
use durer::LoadOptions;
use durer::diag::Diagnostic;
use durer::dialect::Dialect;
use durer::format::course::Guess;
use durer::image::Layer;
use durer::math::Vec3;
use durer::render::{Control, Job, Sampling};
use std::path::Path;

/// Maximum width and height of the trial picture in pixels.
const SIDE: u32 = 64;

/// Maximum difference per channel between two pixels that look the same.
const MAX_CHANNEL_DIFFERENCE: f32 = 2.0 / 255.0;

/// Two pictures look the same if at most one out of this many pixels differs visibly.
const MIN_PIXELS_PER_DIFFERENCE: usize = 1000;

/// Opens a scene in the dialect that fits best. Prints the warnings of the scene. Also prints a
/// note if the picture differs from the picture in the dialect guessed from keywords alone.
pub fn open(
    scene: &Path,
    options: &LoadOptions,
    arguments: &Arguments,
    registry: &mut FileRegistry,
) -> Result<CompiledInput, Failure> {
    let quiet = arguments.has("--quiet");
    let read = read(scene, options, quiet, registry)?;
    let guess = read.loaded.guess.clone().filter(|guess| guess.changed_by_hints() || guess.fitting.len() > 1);
    let Some(guess) = guess else {
        return read.compile(options, registry);
    };
    let mut chosen = read.quiet().compile(options, registry)?;
    let mut trial = Trial::of(&chosen, arguments)?;
    let mut under = |dialect| {
        let options = LoadOptions { dialect: Some(dialect), ..options.clone() };
        let compiled = self::read(scene, &options, true, registry)?.compile(&options, registry)?;
        Ok::<_, Failure>((Trial::of(&compiled, arguments)?, compiled))
    };
    if trial.nan > 0 {
        let others = guess.fitting.iter().filter(|other| **other != guess.dialect);
        let mut tried = others.filter_map(|other| under(*other).ok());
        if let Some(sound) = tried.find(|(trial, _)| trial.nan == 0) {
            (trial, chosen) = sound;
        }
    }
    let dialect = chosen.loaded.dialect;
    if !quiet && dialect != guess.by_keywords {
        let is_same = under(guess.by_keywords).is_ok_and(|(by_words, _)| by_words.looks_like(&trial));
        if !is_same {
            report::note(&note(&guess, dialect));
        }
    }
    report::print(&chosen.files, &chosen.diagnostics, quiet);
    Ok(chosen)
}

/// Explains why a scene is read in a certain dialect.
fn note(guess: &Guess, dialect: Dialect) -> Diagnostic {
    match guess.dialect == dialect {
        true => guess.note(),
        false => {
            let (dialect, other) = (dialect.name(), guess.dialect.name());
            Diagnostic::note(format!("read as {dialect}, because the picture rendered as {other} has NaN samples"))
                .code("dialect")
        }
    }
}

/// A small picture rendered to test whether a dialect fits the scene.
struct Trial {
    layers: Vec<Layer>,
    /// Number of NaN samples.
    nan: u64,
}

impl Trial {
    fn of(compiled: &CompiledInput, arguments: &Arguments) -> Result<Self, Failure> {
        let job = job(arguments, compiled)?;
        let times = job.width.max(job.height).div_ceil(SIDE);
        let [width, height] = [job.width, job.height].map(|length| (length / times).max(1));
        let job = Job { width, height, sampling: Sampling::Center, ..job };
        let rendered = durer::render::render(&compiled.world, &job, &Control::default()).map_err(from_render_error)?;
        Ok(Trial { nan: rendered.statistics.rejected, layers: rendered.pictures })
    }

    fn looks_like(&self, other: &Trial) -> bool {
        let differs = |(a, b): (&Vec3, &Vec3)| (*a - *b).abs().max_element() > MAX_CHANNEL_DIFFERENCE;
        self.nan == other.nan
            && self.layers.iter().zip(&other.layers).all(|(a, b)| {
                let (a, b) = (&a.image.pixels, &b.image.pixels);
                a.len() == b.len()
                    && a.iter().zip(b).filter(|pair| differs(*pair)).count() * MIN_PIXELS_PER_DIFFERENCE <= a.len()
            })
    }
}
