//! A scene in the order of the lecture: each step's pictures, its equation, and what it changes.
//!
//! The steps are one table, [`TOPICS`]; [`Teacher`] makes the pictures of one after the other. A
//! step that changes nothing in a scene is shown in a small scene of ours instead. Steps of light
//! that paths follow are shown of scenes whose pictures are made by paths, as far as those can show
//! them.

mod change;
mod plan;
mod stage;
mod topics;

#[cfg(test)]
mod tests;

pub use change::Change;
use durer_image::{Layer, Transfer};
use durer_render::render::{Control, RenderError};
use stage::Shown;
pub use stage::{OWN_SCENE, OWN_SCENE_NAME, Stage};
pub use topics::{Carriage, Glass, Look, Place, Shot, TOPICS, Topic};

/// A picture and what it shows.
#[derive(Clone, Debug)]
pub struct Picture {
    /// What it shows, in a few words.
    pub caption: &'static str,
    /// The picture, as eight bits have it.
    pub layer: Layer,
}

/// One step of the lesson.
#[derive(Clone, Debug)]
pub struct Step {
    /// What it is about.
    pub topic: &'static Topic,
    /// Its title.
    pub title: String,
    /// Whether it is shown in our scene, because the other has nothing of it.
    pub ours: bool,
    /// Why the other has nothing of it.
    pub lacking: &'static str,
    /// Whether it goes on with the topic of the step before.
    pub goes_on: bool,
    /// What there was before, where that can be compared.
    pub before: Option<Picture>,
    /// What there is now.
    pub after: Picture,
    /// A drawing beside it: an SVG file.
    pub plan: Option<String>,
    /// The difference of the two.
    pub change: Option<Change>,
    /// What came of it in this very scene, in a sentence or two.
    pub words: String,
}

/// Makes the steps.
#[derive(Debug)]
pub struct Teacher {
    /// The scene that is taught, and ours.
    stages: [Stage; 2],
    transfer: Transfer,
}

impl Teacher {
    /// For a scene; pictures are compared as they look with a transfer curve.
    pub fn new(stage: Stage, transfer: Transfer) -> Self {
        let ours = Stage::ours(stage.size());
        Teacher { stages: [stage, ours], transfer }
    }

    /// The steps of a topic: at least one, but for a topic of paths, which has none where the scene
    /// cannot show it. Later steps of one topic that change nothing are left out.
    ///
    /// # Errors
    /// [`RenderError`].
    pub fn steps(&mut self, topic: &'static Topic, control: &Control) -> Result<Vec<Step>, RenderError> {
        if topic.is_of_paths() {
            let stage = &mut self.stages[0];
            let shown =
                if stage.has_paths() { steps(topic, stage, self.transfer, false, control)? } else { Vec::new() };
            return Ok(marked(shown, topic.lacking));
        }
        let lacking = self.stages[0].year_lacks(topic.name).unwrap_or(topic.lacking);
        for (ours, stage) in [false, true].into_iter().zip(&mut self.stages) {
            let steps = steps(topic, stage, self.transfer, ours, control)?;
            if !steps.is_empty() {
                return Ok(marked(steps, lacking));
            }
        }
        // Not even our own scene shows it; a test sees to it that this never happens.
        Ok(Vec::new())
    }
}

/// Steps that know why they are shown elsewhere, and which of them go on with the one before.
fn marked(steps: Vec<Step>, lacking: &'static str) -> Vec<Step> {
    steps.into_iter().enumerate().map(|(i, step)| Step { lacking, goes_on: i > 0, ..step }).collect()
}

/// The steps of a topic in a scene; none if that cannot show the first of them.
fn steps(
    topic: &'static Topic,
    stage: &mut Stage,
    transfer: Transfer,
    ours: bool,
    control: &Control,
) -> Result<Vec<Step>, RenderError> {
    let one = |shown: &Shown, shot: &Shot| Picture { caption: shot.caption, layer: shown.layer.clone() };
    let mut steps: Vec<Step> = Vec::new();
    let mut last: Option<(&Shot, Shown)> = None;
    for shot in topic.shots {
        let shown = stage.show(shot, control)?;
        let many = topic.shots.len() > 2;
        let title = if many { format!("{}: {}", topic.title, shot.caption) } else { topic.title.to_string() };
        let step = |before, change, words| Step {
            topic,
            title: title.clone(),
            ours,
            lacking: topic.lacking,
            goes_on: false,
            before,
            after: one(&shown, shot),
            plan: (shot.value == Some("rays")).then(|| plan::plan(stage)),
            change,
            words,
        };
        if topic.shots.len() == 1 {
            // A quantity of another kind than the step's before: there is nothing to subtract.
            let words = stage.facts(shot, &shown);
            steps.extend(words.map(|words| step(None, None, words)));
        } else if let Some((before_shot, before)) = &last {
            let change = Change::new(&before.layer, &shown.layer, transfer);
            if !change.is_seen() {
                if steps.is_empty() {
                    return Ok(steps);
                }
                continue;
            }
            let words = change.words(stage) + &noise(before, &shown);
            steps.push(step(Some(one(before, before_shot)), Some(change), words));
        }
        last = Some((shot, shown));
    }
    Ok(steps)
}

/// What two pictures of light at random have of noise, in a sentence.
fn noise(before: &Shown, after: &Shown) -> String {
    let share = |noise: f64| format!("{:.1} %", 100.0 * noise);
    match (before.noise, after.noise) {
        (Some(before), Some(after)) => format!(
            " Its noise (the mean of the pixels' standard errors) is {} of the mean luminance; before it was {}.",
            share(after),
            share(before)
        ),
        _ => String::new(),
    }
}
