//! The lesson as a page for a browser.

use super::{Lesson, Written};
use crate::page::{uri, with_data};
use durer::lesson::OWN_SCENE;
use serde_json::{Map, Value, json};

/// The page without its data.
const PAGE: &str = include_str!("page.html");

/// A page that needs nothing else.
pub fn page(lesson: &Lesson) -> String {
    let pictures: Map<String, Value> =
        lesson.pictures.iter().map(|(name, png)| (name.clone(), uri(png).into())).collect();
    let ours = lesson.steps.iter().any(|written| written.step.ours);
    let data = json!({
        "scene": lesson.scene,
        "pictures": pictures,
        "steps": lesson.steps.iter().map(|written| step(written, &lesson.scene)).collect::<Vec<_>>(),
        "own_scene": ours.then_some(OWN_SCENE),
    });
    with_data(PAGE, &data)
}

fn step(written: &Written, scene: &str) -> Value {
    let step = &written.step;
    let picture = |caption: &str, file: &str| json!({ "caption": caption, "file": file });
    let before = step.before.as_ref().zip(written.before.as_ref());
    json!({
        "title": step.title,
        "elsewhere": written.elsewhere(scene),
        "words": step.topic.words,
        "equations": step.topic.equations,
        "before": before.map(|(shown, file)| picture(shown.caption, file)),
        "after": picture(step.after.caption, &written.after),
        "change": written.change,
        "plan": step.plan,
        "facts": step.words,
        "places": step.topic.places.iter().map(|place| json!([place.file, place.symbol])).collect::<Vec<_>>(),
    })
}
