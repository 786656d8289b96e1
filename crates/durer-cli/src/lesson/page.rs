//! Writes a lesson as an HTML page.

use super::step_files::{Figure, Lesson, StepFiles};
use crate::page::{uri, with_data};
use durer::lesson::OWN_SCENE;
use serde_json::{Map, Value, json};

/// Template of the page, without data.
const PAGE: &str = include_str!("page.html");

/// Returns a self-contained HTML page.
pub fn page(lesson: &Lesson) -> String {
    let pictures: Map<String, Value> =
        lesson.pictures.iter().map(|(name, png)| (name.clone(), uri(png).into())).collect();
    let data = json!({
        "scene": lesson.scene,
        "pictures": pictures,
        "steps": lesson.steps.iter().map(|written| step(written, &lesson.scene)).collect::<Vec<_>>(),
        "own_scene": lesson.shows_ours().then_some(OWN_SCENE),
    });
    with_data(PAGE, &data)
}

fn step(step: &StepFiles, scene: &str) -> Value {
    let figure = |figure: &Figure| json!({ "caption": figure.caption, "file": figure.file });
    json!({
        "title": step.title,
        "elsewhere": step.elsewhere(scene),
        // Print the text of a topic only once, at its first step.
        "words": (!step.continues_topic).then_some(step.topic.words),
        "equations": (!step.continues_topic).then_some(step.topic.equations),
        "before": step.before.as_ref().map(figure),
        "after": figure(&step.after),
        "change": step.change,
        "plan": step.plan.as_ref().map(|plan| &plan.0),
        "facts": step.effect,
        "places": step.topic.places.iter().filter(|_| !step.continues_topic).map(|place| json!([place.file, place.symbol])).collect::<Vec<_>>(),
    })
}
