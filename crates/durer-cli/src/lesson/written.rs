//! A lesson that is to be written: its steps, whose pictures are files.

use crate::failure::Failure;
use crate::page::png;
use durer::image::{Layer, Transfer};
use durer::lesson::{OWN_SCENE_NAME, Picture, Step, Topic};

/// The text of the lesson, and the page.
pub const TEXT: &str = "lesson.md";
pub const PAGE: &str = "index.html";

/// A picture's caption and its file.
pub struct Figure {
    pub caption: &'static str,
    pub file: String,
}

/// A step whose pictures are files.
pub struct Written {
    pub topic: &'static Topic,
    pub title: String,
    pub words: String,
    pub ours: bool,
    /// Why the scene cannot show it.
    pub lacking: &'static str,
    /// Whether it goes on with the topic of the step before.
    pub goes_on: bool,
    pub before: Option<Figure>,
    pub after: Figure,
    pub change: Option<String>,
    /// A drawing and its file.
    pub plan: Option<(String, String)>,
}

/// A lesson that is to be written.
pub struct Lesson {
    /// The scene's file, without its folder.
    pub scene: String,
    pub steps: Vec<Written>,
    /// The pictures, each once, by their files' names.
    pub pictures: Vec<(String, Vec<u8>)>,
    pub transfer: Transfer,
}

impl Lesson {
    /// Adds a step, whose pictures' files begin with its number.
    pub fn add(&mut self, step: Step) -> Result<(), Failure> {
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

    /// Whether some step is shown in our own scene.
    pub fn shows_ours(&self) -> bool {
        self.steps.iter().any(|step| step.ours)
    }
}

impl Written {
    /// That the step is shown in another scene, and why.
    pub fn elsewhere(&self, scene: &str) -> Option<String> {
        let lacking = self.lacking;
        // The steps after the first are shown in the same scene.
        (self.ours && !self.goes_on).then(|| {
            format!("{scene} cannot show this: {lacking}. It is shown in a small scene of ours, {OWN_SCENE_NAME}.")
        })
    }
}
