//! A lesson that is ready to be written, with the pictures of its steps as files.

use crate::failure::Failure;
use crate::page::png;
use durer::image::{Layer, Transfer};
use durer::lesson::{OWN_SCENE_NAME, Picture, Step, Topic};

/// Name of the lesson's text file.
pub const TEXT: &str = "lesson.md";
/// Name of the lesson's HTML page.
pub const PAGE: &str = "index.html";

/// A picture of a lesson step: its caption and the name of its file.
pub struct Figure {
    pub caption: &'static str,
    pub file: String,
}

/// A lesson step whose pictures have been encoded as files.
pub struct StepFiles {
    pub topic: &'static Topic,
    pub title: String,
    pub effect: String,
    pub uses_built_in_scene: bool,
    /// Reason why the step cannot be shown with the user's scene.
    pub missing_because: &'static str,
    /// True if the step continues the topic of the previous step.
    pub continues_topic: bool,
    pub before: Option<Figure>,
    pub after: Figure,
    pub change: Option<String>,
    /// SVG drawing and the name of its file, if there is one.
    pub plan: Option<(String, String)>,
}

/// A lesson that is ready to be written: its steps, and its encoded pictures by file name.
pub struct Lesson {
    /// File name of the scene without its folder.
    pub scene: String,
    pub steps: Vec<StepFiles>,
    /// Names and contents of the picture files, without duplicates.
    pub pictures: Vec<(String, Vec<u8>)>,
    pub transfer: Transfer,
}

impl Lesson {
    /// Adds a step. The names of its files begin with the number of the step.
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
        let Step { topic, title, effect, uses_built_in_scene, missing_because, continues_topic, .. } = step;
        self.steps.push(StepFiles {
            topic,
            title,
            effect,
            uses_built_in_scene,
            missing_because,
            continues_topic,
            before,
            after,
            change,
            plan,
        });
        Ok(())
    }

    /// Returns the file name of a picture. Identical pictures share a file because a step often
    /// begins with the last picture of the previous step.
    fn picture(&mut self, name: String, layer: &Layer) -> Result<String, Failure> {
        let png = png(layer.clone(), self.transfer)?;
        if let Some((there, _)) = self.pictures.iter().find(|picture| picture.1 == png) {
            return Ok(there.clone());
        }
        self.pictures.push((name.clone(), png));
        Ok(name)
    }

    /// Returns true if at least one step uses the built-in scene.
    pub fn shows_ours(&self) -> bool {
        self.steps.iter().any(|step| step.uses_built_in_scene)
    }
}

impl StepFiles {
    /// Returns a sentence that says why the step uses the built-in scene, or `None` if it uses the
    /// user's scene.
    pub fn elsewhere(&self, scene: &str) -> Option<String> {
        let missing_because = self.missing_because;
        // Later steps of the same topic do not need an explanation.
        (self.uses_built_in_scene && !self.continues_topic).then(|| {
            format!(
                "{scene} cannot show this step: {missing_because}. The step uses a small built-in scene, \
                 {OWN_SCENE_NAME}."
            )
        })
    }
}
