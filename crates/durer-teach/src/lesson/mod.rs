//! Explains the rendering of a scene in the order of the lecture, with pictures and equations for
//! each step.
//!
//! The table [`TOPICS`] contains the steps, and [`Teacher`] renders their pictures in order. If a
//! step changes nothing in the user's scene, it is shown with a small built-in scene. Path-tracing
//! steps are shown only for path-traced scenes in which the effect occurs.

mod change;
mod plan;
mod stage;
mod topics;

#[cfg(test)]
mod tests;

pub use change::Change;
use durer_image::{Layer, Transfer};
use durer_render::render::{Control, RenderError};
use stage::LessonPicture;
pub use stage::{LessonScene, OWN_SCENE, OWN_SCENE_NAME};
pub use topics::{Glass, PathSettings, Shot, ShotOptions, SourcePlace, TOPICS, Topic};

/// A rendered picture of a lesson step and its caption.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Short caption.
    pub caption: &'static str,
    /// The picture with eight bits per channel.
    pub layer: Layer,
}

/// One step of the lesson as shown on a page, with its text, its pictures, and the difference that
/// the step makes.
#[derive(Clone, Debug)]
pub struct Step {
    /// Topic of the step.
    pub topic: &'static Topic,
    /// Title of the step.
    pub title: String,
    /// True if the pictures show the built-in scene because the user's scene lacks the effect.
    pub uses_built_in_scene: bool,
    /// Reason why the user's scene lacks the effect.
    pub missing_because: &'static str,
    /// True if the step continues the previous step's topic.
    pub continues_topic: bool,
    /// The picture before the step, or `None` if there is nothing to compare with.
    pub before: Option<Picture>,
    /// The picture after the step.
    pub after: Picture,
    /// SVG drawing to show with the picture, if there is one.
    pub plan: Option<String>,
    /// The difference between the two pictures.
    pub change: Option<Change>,
    /// Effect of the step in this scene, described in one or two sentences.
    pub effect: String,
}

/// Renders the steps of the lesson for a scene, one topic at a time.
#[derive(Debug)]
pub struct Teacher {
    /// The scene of the lesson and the built-in scene.
    stages: [LessonScene; 2],
    transfer: Transfer,
}

impl Teacher {
    /// Creates a teacher for a scene. `transfer` is the transfer curve that is applied before
    /// pictures are compared.
    pub fn new(stage: LessonScene, transfer: Transfer) -> Self {
        let uses_built_in_scene = LessonScene::built_in(stage.size());
        Teacher { stages: [stage, uses_built_in_scene], transfer }
    }

    /// Renders the steps of a topic. There is at least one step, unless a path-tracing topic has no
    /// effect in the scene. Later steps of the topic that change nothing are left out.
    ///
    /// # Errors
    /// [`RenderError`].
    pub fn steps(&mut self, topic: &'static Topic, control: &Control) -> Result<Vec<Step>, RenderError> {
        if topic.needs_path_tracing() {
            let stage = &mut self.stages[0];
            let picture =
                if stage.has_paths() { steps(topic, stage, self.transfer, false, control)? } else { Vec::new() };
            return Ok(with_reason(picture, topic.lacking));
        }
        let unknown = self.stages[0].unsupported_by_method(topic);
        let missing_because = self.stages[0].unsupported_by_dialect(topic.name).or(unknown).unwrap_or(topic.lacking);
        let stages = [false, true].into_iter().zip(&mut self.stages);
        for (uses_built_in_scene, stage) in
            stages.filter(|(uses_built_in_scene, _)| *uses_built_in_scene || unknown.is_none())
        {
            let steps = steps(topic, stage, self.transfer, uses_built_in_scene, control)?;
            if !steps.is_empty() {
                return Ok(with_reason(steps, missing_because));
            }
        }
        // This line is not reached because a test checks that the built-in scene shows every topic.
        Ok(Vec::new())
    }
}

/// Sets why the steps use the built-in scene, and which of them continue the previous step.
fn with_reason(steps: Vec<Step>, missing_because: &'static str) -> Vec<Step> {
    steps.into_iter().enumerate().map(|(i, step)| Step { missing_because, continues_topic: i > 0, ..step }).collect()
}

/// Renders the steps of a topic in a scene. There are none if the first step makes no visible
/// change.
fn steps(
    topic: &'static Topic,
    stage: &mut LessonScene,
    transfer: Transfer,
    uses_built_in_scene: bool,
    control: &Control,
) -> Result<Vec<Step>, RenderError> {
    let one = |picture: &LessonPicture, shot: &Shot| Picture { caption: shot.caption, layer: picture.layer.clone() };
    let mut steps: Vec<Step> = Vec::new();
    let mut last: Option<(&Shot, LessonPicture)> = None;
    for shot in topic.shots {
        let picture = stage.render(shot, control)?;
        let many = topic.shots.len() > 2;
        let title = if many { format!("{}: {}", topic.title, shot.caption) } else { topic.title.to_string() };
        let step = |before, change, words| Step {
            topic,
            title: title.clone(),
            uses_built_in_scene,
            missing_because: topic.lacking,
            continues_topic: false,
            before,
            after: one(&picture, shot),
            plan: (shot.aov == Some("rays")).then(|| plan::plan(stage)),
            change,
            effect: words,
        };
        if topic.shots.len() == 1 {
            // A single picture of a quantity other than colour is not compared.
            let words = stage.describe(shot, &picture);
            steps.extend(words.map(|words| step(None, None, words)));
        } else if let Some((before_shot, before)) = &last {
            let change = Change::new(&before.layer, &picture.layer, transfer);
            if !change.is_seen() {
                if steps.is_empty() {
                    return Ok(steps);
                }
                continue;
            }
            let words = change.words(stage) + &noise(before, &picture);
            steps.push(step(Some(one(before, before_shot)), Some(change), words));
        }
        last = Some((shot, picture));
    }
    Ok(steps)
}

/// Describes the noise of two Monte Carlo pictures in a sentence. The result is empty if a picture
/// has no noise estimate.
fn noise(before: &LessonPicture, after: &LessonPicture) -> String {
    let share = |noise: f64| format!("{:.1} %", 100.0 * noise);
    match (before.noise, after.noise) {
        (Some(before), Some(after)) => format!(
            " The noise of the picture (the mean of the pixels' standard errors, clipped to white) is {} of the mean \
             luminance; before, it was {}.",
            share(after),
            share(before)
        ),
        _ => String::new(),
    }
}
