//! A lesson ready to be written: its steps, with pictures as files.

use crate::failure::Failure;
use crate::page::png;
use durer::image::{Layer, Transfer};
use durer::lesson::{OWN_SCENE_NAME, Picture, Step, Topic};

/// File names of the lesson's text and page.
pub const TEXT: &str = "lesson.md";
pub const PAGE: &str = "index.html";

/// A picture's caption and file.
pub struct Figure {
    pub caption: &'static str,
    pub file: String,
}

/// A step with its pictures as files.
pub struct StepFiles {
    pub topic: &'static Topic,
    pub title: String,
    pub words: String,
    pub ours: bool,
    /// Reason why the scene cannot show the step.
    pub lacking: &'static str,
    /// True if the step continues the topic of the step before.
    pub goes_on: bool,
    pub before: Option<Figure>,
    pub after: Figure,
    pub change: Option<String>,
    /// Drawing as SVG, and its file.
    pub plan: Option<(String, String)>,
}

/// A lesson ready to be written.
pub struct Lesson {
    /// Name of the scene's file, without its folder.
    pub scene: String,
    pub steps: Vec<StepFiles>,
    /// Pictures by file name, without duplicates.
    pub pictures: Vec<(String, Vec<u8>)>,
    pub transfer: Transfer,
}

impl Lesson {
    /// Adds a step. The names of its files begin with its number.
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
        self.steps.push(StepFiles { topic, title, words, ours, lacking, goes_on, before, after, change, plan });
        Ok(())
    }

    /// Returns the file of a picture. Equal pictures share a file, because a step can begin with
    /// the picture that ends the previous one.
    fn picture(&mut self, name: String, layer: &Layer) -> Result<String, Failure> {
        let png = png(layer.clone(), self.transfer)?;
        if let Some((there, _)) = self.pictures.iter().find(|picture| picture.1 == png) {
            return Ok(there.clone());
        }
        self.pictures.push((name.clone(), png));
        Ok(name)
    }

    /// Returns true if some step uses the built-in scene.
    pub fn shows_ours(&self) -> bool {
        self.steps.iter().any(|step| step.ours)
    }
}

impl StepFiles {
    /// Returns a sentence that says why the step uses the built-in scene; `None` if it does not.
    pub fn elsewhere(&self, scene: &str) -> Option<String> {
        let lacking = self.lacking;
        // Later steps of the topic use the same scene.
        (self.ours && !self.goes_on).then(|| {
            format!("{scene} cannot show this: {lacking}. This step uses a small built-in scene, {OWN_SCENE_NAME}.")
        })
    }
}
