//! `durer lesson`.

mod folder;
mod markdown;
mod page;
mod written;

use crate::failure::{Failure, bad, failed};
use crate::guard::Guard;
use crate::job::{job, warn};
use crate::open::{load_options, open};
use crate::options::{JobArgs, SceneArgs, accel, aspect};
use crate::output::lengthened;
use crate::progress;
use crate::terminal::say;
use clap::Args;
use clap::builder::PossibleValuesParser;
use durer::camera::{Projection, Raster};
use durer::image::{Transfer, checked_count};
use durer::lesson::{OWN_SCENE, OWN_SCENE_NAME, Stage, TOPICS, Teacher};
use durer::render::Control;
use folder::Folder;
use std::path::{Path, PathBuf};
use written::{Lesson, PAGE, TEXT};

/// Show a scene in the order of the lecture: rays, distance, normals, light by light, with
/// equations and mistakes
#[derive(Args)]
#[command(after_help = "Examples:
  durer lesson scene.txt -o lesson/
  durer lesson scene.txt -o lesson/ --size 400x300 --samples 64
  durer lesson scene.txt -o lesson/ --dialect f04 --shadows --bounces 4 --transfer course
  durer lesson scenes/plates.txt -o lesson/ --samples 32

FOLDER gets a page for a browser, index.html, which needs nothing else, and the same as lesson.md with its pictures as
files. A folder that is there already keeps its other files; what an earlier lesson wrote is replaced.
Give the options with which the picture is rendered: with Whitted's light the last step is that picture. Without --size its
longer side has 256 pixels. A step of which nothing is seen in the scene is shown in a small scene of ours, and says so.
With --integrator path or photons, which some scenes have by themselves, the lesson goes on with soft shadows, bounces, lamps
found in two ways, caustics and spectra, as far as the scene has them.")]
pub struct LessonArgs {
    /// The scene file
    pub scene: PathBuf,
    /// The folder to write [default: the scene's name with -lesson, here]
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub reading: SceneArgs,
    #[command(flatten)]
    pub job: JobArgs,
    /// Threads that build and render [default: as many as the machine has]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// How colours become eight bits
    #[arg(long, default_value = "srgb", value_parser = PossibleValuesParser::new(Transfer::ALL.map(Transfer::name)))]
    pub transfer: String,
    /// Say nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// The longer side of a picture where no size is asked for.
const SIDE: u32 = 256;
pub fn run(args: &LessonArgs) -> Result<(), Failure> {
    let stem = Path::new(args.scene.file_stem().unwrap_or_default());
    let mut guard = Guard::default();
    let folder = Folder::new(args.output.clone().unwrap_or_else(|| lengthened(stem, "-lesson")), &mut guard)?;
    let mut options = load_options(&args.reading);
    (options.accel, options.threads) = (accel(&args.job)?, args.threads.map(usize::from));
    options.staging.aspect = aspect(&args.job);
    let opened = open(&args.scene, &options, args.quiet, &mut guard)?;
    let mut job = job(&args.job, None, &opened.loaded, false)?;
    if args.job.options.given_size().is_none() {
        let proportions = opened.world.camera().proportions();
        (job.width, job.height) = Raster::natural_size(proportions, (SIDE, SIDE));
    }
    checked_count(job.width, job.height).map_err(|error| bad(error.to_string()))?;
    if !args.quiet {
        warn(&job, &opened.world);
    }
    let transfer = Transfer::from_name(&args.transfer).unwrap_or_default();
    let mut teacher = Teacher::new(Stage::new(opened.loaded.scene, opened.files, opened.world, job), transfer);
    let control = Control { threads: options.threads, ..Control::default() };
    let scene = args.scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut lesson = Lesson { scene, steps: Vec::new(), pictures: Vec::new(), transfer };
    let names: Vec<String> = TOPICS.iter().map(|topic| topic.title.to_string()).collect();
    // Ctrl-C ends the program here: nothing is written yet.
    let made = progress::each(&names, TOPICS.iter().collect(), args.quiet, |topic| {
        let steps = teacher.steps(topic, &control).map_err(failed)?;
        steps.into_iter().try_for_each(|step| lesson.add(step))
    });
    made.into_iter().collect::<Result<(), Failure>>()?;
    let files = files(lesson)?;
    let count = files.len() - 2;
    let path = folder.write(files, &mut guard)?;
    if !args.quiet {
        say(&format!("wrote {}, {TEXT} and {count} files that they show", path.join(PAGE).display()));
    }
    Ok(())
}

/// All files, by their names in the folder.
fn files(lesson: Lesson) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let mut files = vec![(PAGE.to_string(), page::page(&lesson).into_bytes())];
    files.push((TEXT.to_string(), markdown::text(&lesson).into_bytes()));
    if lesson.shows_ours() {
        files.push((OWN_SCENE_NAME.to_string(), OWN_SCENE.into()));
    }
    let plans = lesson.steps.into_iter().filter_map(|step| step.plan);
    files.extend(plans.map(|(svg, name)| (name, svg.into_bytes())));
    files.extend(lesson.pictures);
    Ok(files)
}
