//! `durer lesson`.

mod folder;
mod markdown;
mod page;

use crate::args::LessonArgs;
use crate::guard::Guard;
use crate::job::{accel, aspect, job, warn};
use crate::open::{load_options, open};
use crate::output::{lengthened, say};
use crate::page::png;
use crate::render::failure;
use crate::{Failure, bad, progress};
use durer::camera::{Lens, Raster};
use durer::image::{Layer, Transfer, checked_count};
use durer::lesson::{OWN_SCENE, OWN_SCENE_NAME, Picture, Stage, Step, TOPICS, Teacher, Topic};
use durer::render::Control;
use folder::Folder;
use std::path::Path;

/// The longer side of a picture where no size is asked for.
const SIDE: u32 = 256;
/// The text of the lesson, and the page.
const TEXT: &str = "lesson.md";
const PAGE: &str = "index.html";

/// A picture's caption and its file.
struct Figure {
    caption: &'static str,
    file: String,
}

/// A step whose pictures are files.
struct Written {
    topic: &'static Topic,
    title: String,
    words: String,
    ours: bool,
    /// Why the scene cannot show it.
    lacking: &'static str,
    /// Whether it goes on with the topic of the step before.
    goes_on: bool,
    before: Option<Figure>,
    after: Figure,
    change: Option<String>,
    /// A drawing and its file.
    plan: Option<(String, String)>,
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
    let stem = Path::new(args.scene.file_stem().unwrap_or_default());
    let mut guard = Guard::default();
    let folder = Folder::new(args.output.clone().unwrap_or_else(|| lengthened(stem, "-lesson")), &mut guard)?;
    let mut options = load_options(&args.reading);
    (options.accel, options.threads) = (accel(&args.job)?, args.threads.map(usize::from));
    options.staging.aspect = aspect(&args.job);
    let opened = open(&args.scene, &options, args.quiet, &mut guard)?;
    let mut job = job(&args.job, None, &opened.loaded, false)?;
    if args.job.size.is_none() {
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
        let steps = teacher.steps(topic, &control).map_err(failure)?;
        steps.into_iter().try_for_each(|step| lesson.add(step))
    });
    made.into_iter().collect::<Result<(), Failure>>()?;
    let files = lesson.files()?;
    let count = files.len() - 2;
    let path = folder.write(files, &mut guard)?;
    if !args.quiet {
        say(&format!("wrote {}, {TEXT} and {count} files that they show", path.join(PAGE).display()));
    }
    Ok(())
}

impl Lesson {
    /// Adds a step, whose pictures' files begin with its number.
    fn add(&mut self, step: Step) -> Result<(), Failure> {
        let name = format!("{:02}-{}", self.steps.len() + 1, step.topic.name);
        let figure = |lesson: &mut Lesson, picture: &Picture, end: &str| -> Result<Figure, Failure> {
            let file = lesson.picture(format!("{name}{end}.png"), &picture.layer)?;
            Ok(Figure { caption: picture.caption, file })
        };
        let before = step.before.as_ref().map(|picture| figure(self, picture, "-before")).transpose()?;
        let after = figure(self, &step.after, "")?;
        let change = step.change.as_ref().map(|change| self.picture(format!("{name}-change.png"), &change.picture));
        let change = change.transpose()?;
        let plan = step.plan.map(|svg| (svg, format!("{name}-plan.svg")));
        let Step { topic, title, words, ours, lacking, goes_on, .. } = step;
        self.steps.push(Written { topic, title, words, ours, lacking, goes_on, before, after, change, plan });
        Ok(())
    }

    /// The file of a picture: what one step ends with, the next may begin with.
    fn picture(&mut self, name: String, layer: &Layer) -> Result<String, Failure> {
        let png = png(layer.clone(), self.transfer)?;
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
        if self.shows_ours() {
            files.push((OWN_SCENE_NAME.to_string(), OWN_SCENE.into()));
        }
        let plans = self.steps.into_iter().filter_map(|step| step.plan);
        files.extend(plans.map(|(svg, name)| (name, svg.into_bytes())));
        files.extend(self.pictures);
        Ok(files)
    }

    /// Whether some step is shown in our own scene.
    fn shows_ours(&self) -> bool {
        self.steps.iter().any(|step| step.ours)
    }
}

impl Written {
    /// That the step is shown in another scene, and why.
    fn elsewhere(&self, scene: &str) -> Option<String> {
        let lacking = self.lacking;
        // The steps after the first are shown in the same scene.
        (self.ours && !self.goes_on).then(|| {
            format!("{scene} cannot show this: {lacking}. It is shown in a small scene of ours, {OWN_SCENE_NAME}.")
        })
    }
}
