//! `durer lesson`.

mod folder;
mod markdown;
mod page;

use crate::args::LessonArgs;
use crate::job::{accel, job, warn};
use crate::open::{load_options, open};
use crate::output::{lengthened, say};
use crate::render::failure;
use crate::{Failure, bad, progress};
use durer::camera::{Lens, Raster};
use durer::image::{Transfer, checked_count};
use durer::lesson::{OWN_SCENE, OWN_SCENE_NAME, Stage, Step, TOPICS, Teacher};
use durer::render::{Control, RenderError};
use folder::Folder;
use std::path::Path;

/// The longer side of a picture where no size is asked for.
const SIDE: u32 = 256;
/// The text of the lesson, and the page.
const TEXT: &str = "lesson.md";
const PAGE: &str = "index.html";

/// A step with the names of its pictures' files.
struct Written {
    step: Step,
    before: Option<String>,
    after: String,
    change: Option<String>,
    plan: Option<String>,
}

/// A lesson that is to be written.
struct Lesson {
    /// The scene's file, without its folder.
    scene: String,
    steps: Vec<Written>,
    /// The pictures, each once, by their files' names.
    pictures: Vec<(String, Vec<u8>)>,
    transfer: Transfer,
}

pub fn run(args: &LessonArgs) -> Result<(), Failure> {
    if args.job.crop.is_some() || args.job.show != ["color"] {
        return Err(bad(
            "a lesson shows whole pictures, and chooses itself what they show: leave --crop and --show out",
        ));
    }
    let stem = Path::new(args.scene.file_stem().unwrap_or_default());
    let folder = Folder::new(args.output.clone().unwrap_or_else(|| lengthened(stem, "-lesson")))?;
    let mut options = load_options(&args.reading);
    (options.accel, options.threads) = (accel(&args.job)?, args.threads.map(usize::from));
    let opened = open(&args.scene, &options, args.quiet)?;
    let mut job = job(&args.job, &opened.loaded, false)?;
    if args.job.size.is_none() {
        let proportions = opened.world.camera.proportions();
        (job.width, job.height) = Raster::natural_size(proportions, (SIDE, SIDE));
    }
    checked_count(job.width, job.height).map_err(|error| bad(error.to_string()))?;
    if !args.quiet {
        warn(&job, &opened.world);
    }
    let transfer = Transfer::from_name(&args.transfer).unwrap_or_default();
    let mut teacher = Teacher::new(Stage::new(opened.loaded.scene, opened.files, opened.world, job), transfer);
    let control = Control { threads: options.threads, ..Control::default() };
    let names: Vec<String> = TOPICS.iter().map(|topic| topic.title.to_string()).collect();
    // Ctrl-C ends the program here: nothing is written yet.
    let steps = progress::each(&names, TOPICS.iter().collect(), args.quiet, |topic| teacher.steps(topic, &control));
    let steps: Vec<Vec<Step>> = steps.into_iter().collect::<Result<_, RenderError>>().map_err(failure)?;
    let scene = args.scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut lesson = Lesson { scene, steps: Vec::new(), pictures: Vec::new(), transfer };
    for (number, step) in (1..).zip(steps.into_iter().flatten()) {
        lesson.add(number, step)?;
    }
    let files = lesson.files()?;
    let count = files.len() - 2;
    let path = folder.write(files)?;
    if !args.quiet {
        say(&format!("wrote {}, {TEXT} and {count} files that they show", path.join(PAGE).display()));
    }
    Ok(())
}

impl Lesson {
    /// Adds a step, whose pictures' files begin with its number.
    fn add(&mut self, number: usize, step: Step) -> Result<(), Failure> {
        let name = format!("{number:02}-{}", step.topic.name);
        let before = step.before.as_ref().map(|picture| self.picture(format!("{name}-before.png"), &picture.layer));
        let before = before.transpose()?;
        let after = self.picture(format!("{name}.png"), &step.after.layer)?;
        let change = step.change.as_ref().map(|change| self.picture(format!("{name}-change.png"), &change.picture));
        let change = change.transpose()?;
        let plan = step.plan.is_some().then(|| format!("{name}-plan.svg"));
        self.steps.push(Written { step, before, after, change, plan });
        Ok(())
    }

    /// The file of a picture: what one step ends with, the next may begin with.
    fn picture(&mut self, name: String, layer: &durer::image::Layer) -> Result<String, Failure> {
        let png = crate::page::png(layer.clone(), self.transfer)?;
        if let Some((there, _)) = self.pictures.iter().find(|picture| picture.1 == png) {
            return Ok(there.clone());
        }
        self.pictures.push((name.clone(), png));
        Ok(name)
    }

    /// All files, by their names in the folder.
    fn files(self) -> Result<Vec<(String, Vec<u8>)>, Failure> {
        let mut files = vec![(PAGE.to_string(), page::page(&self).into_bytes())];
        files.push((TEXT.to_string(), markdown::text(&self).into_bytes()));
        if self.steps.iter().any(|written| written.step.ours) {
            files.push((OWN_SCENE_NAME.to_string(), OWN_SCENE.into()));
        }
        let plans = self.steps.iter().filter_map(|written| Some((written.plan.clone()?, written.step.plan.clone()?)));
        files.extend(plans.map(|(name, svg)| (name, svg.into_bytes())));
        files.extend(self.pictures);
        Ok(files)
    }
}

impl Written {
    /// That the step is shown in another scene, and why.
    fn elsewhere(&self, scene: &str) -> Option<String> {
        let lacking = self.step.topic.lacking;
        self.step.ours.then(|| {
            format!("{scene} cannot show this: {lacking}. It is shown in a small scene of ours, {OWN_SCENE_NAME}.")
        })
    }
}
