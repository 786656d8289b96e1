//! Implements `durer lesson`, which writes a lesson about a scene to a folder.

mod folder;
mod markdown;
mod page;
mod step_files;

use crate::failure::{Failure, from_render_error, invalid_input};
use crate::file_registry::FileRegistry;
use crate::job::{job, warn};
use crate::open::{load_options, open};
use crate::options::{GivenOptions, JobArgs, SceneArgs, accel};
use crate::output::with_suffix;
use crate::progress;
use crate::terminal::print_line;
use clap::Args;
use clap::builder::PossibleValuesParser;
use durer::camera::{Projection, Raster};
use durer::image::{Transfer, checked_count};
use durer::lesson::{LessonScene, OWN_SCENE, OWN_SCENE_NAME, TOPICS, Teacher};
use durer::render::Control;
use folder::Folder;
use std::path::{Path, PathBuf};
use step_files::{Lesson, PAGE, TEXT};

/// Write a lesson about a scene: rays, distance, normals and lights step by step, with equations
/// and common mistakes
#[derive(Args)]
#[command(after_help = "Examples:
  durer lesson scene.txt -o lesson/
  durer lesson scene.txt -o lesson/ --size 400x300 --samples 64
  durer lesson scene.txt -o lesson/ --dialect f04 --shadows --bounces 4 --transfer course
  durer lesson scenes/plates.txt -o lesson/ --samples 32
  durer lesson monday.md

If SCENE is a Markdown file, the lesson that it describes is shown in the browser and not written to files, so
no other option applies to it; docs/live.md explains how to write one.

The lesson of a scene is written to FOLDER as a self-contained page, index.html, and as lesson.md with separate picture files. In an
existing folder, files of an earlier lesson are replaced and other files are kept.
Pass the same options as to `durer render`: with the whitted integrator, the last step shows the same picture. Without
--size, the longer side has 256 pixels. If the scene cannot show a step, the lesson uses a small built-in scene and says so.
With --integrator path (the default for some scenes) or photons, the lesson continues with soft shadows, bounces, the two
ways to sample lights, caustics and spectra, if they occur in the scene.")]
pub struct LessonArgs {
    #[command(flatten)]
    pub given: GivenOptions,
    /// Scene file, or a lesson in Markdown
    pub scene: PathBuf,
    /// Output folder [default: the scene's name followed by -lesson, in the current folder]
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub job: JobArgs,
    /// Number of threads for building and rendering [default: one per processor]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Transfer curve of the pictures
    #[arg(long, default_value = "srgb", value_parser = PossibleValuesParser::new(Transfer::ALL.map(Transfer::name)))]
    pub transfer: String,
    /// Print only errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Default length of the longer side of a picture, in pixels.
const SIDE: u32 = 256;
/// Runs `durer lesson`.
pub fn run(args: &LessonArgs) -> Result<(), Failure> {
    if args.scene.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("md")) {
        if let Some(name) = args.given.find(|name| name != "scene") {
            return Err(invalid_input(format!(
                "a lesson in Markdown is shown in the browser and not written to files, so --{name} does not apply to \
                 it; its figures give their own options"
            )));
        }
        return crate::live::lesson(&args.scene);
    }
    let stem = Path::new(args.scene.file_stem().unwrap_or_default());
    let mut registry = FileRegistry::default();
    let folder = Folder::new(args.output.clone().unwrap_or_else(|| with_suffix(stem, "-lesson")), &mut registry)?;
    let mut options = load_options(&args.reading);
    (options.accel, options.threads) = (accel(&args.job)?, args.threads.map(usize::from));
    args.job.options.adapt(&mut options.scene_defaults);
    let compiled = open(&args.scene, &options, args.quiet, &mut registry)?;
    let mut job = job(&args.job, None, &compiled.loaded, false)?;
    if args.job.options.requested_size().is_none() {
        let proportions = compiled.world.camera().proportions();
        (job.width, job.height) = Raster::natural_size(proportions, (SIDE, SIDE));
    }
    checked_count(job.width, job.height).map_err(|error| invalid_input(error.to_string()))?;
    if !args.quiet {
        warn(&job, &compiled.world);
    }
    let transfer = Transfer::from_name(&args.transfer).unwrap_or_default();
    let mut teacher =
        Teacher::new(LessonScene::new(compiled.loaded.scene, compiled.files, compiled.world, job), transfer);
    let control = Control { threads: options.threads, ..Control::default() };
    let scene = args.scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut lesson = Lesson { scene, steps: Vec::new(), pictures: Vec::new(), transfer };
    let names: Vec<String> = TOPICS.iter().map(|topic| topic.title.to_string()).collect();
    // Nothing has been written yet, so Ctrl-C may end the program here.
    let pages = progress::each(&names, TOPICS.iter().collect(), args.quiet, |topic| {
        let steps = teacher.steps(topic, &control).map_err(from_render_error)?;
        steps.into_iter().try_for_each(|step| lesson.add(step))
    });
    pages.into_iter().collect::<Result<(), Failure>>()?;
    let files = files(lesson)?;
    let count = files.len() - 2;
    let path = folder.write(files, &mut registry)?;
    if !args.quiet {
        print_line(&format!("wrote {}, {TEXT} and {count} linked files", path.join(PAGE).display()));
    }
    Ok(())
}

/// Returns the names and contents of the files to write.
fn files(lesson: Lesson) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let mut files = vec![(PAGE.to_string(), page::page(&lesson)?.into_bytes())];
    files.push((TEXT.to_string(), markdown::text(&lesson).into_bytes()));
    if lesson.shows_ours() {
        files.push((OWN_SCENE_NAME.to_string(), OWN_SCENE.into()));
    }
    let plans = lesson.steps.into_iter().filter_map(|step| step.plan);
    files.extend(plans.map(|(svg, name)| (name, svg.into_bytes())));
    files.extend(lesson.pictures);
    Ok(files)
}
