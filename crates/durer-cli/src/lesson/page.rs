//! Writes a lesson as an HTML page.

use super::step_files::{Figure, Lesson, StepFiles};
use crate::failure::Failure;
use crate::page::{LessonFigure, LessonReport, LessonStep, Report, uri, with_data};
use durer::lesson::OWN_SCENE;

/// Returns a self-contained HTML page.
pub fn page(lesson: &Lesson) -> Result<String, Failure> {
    with_data(&Report::Lesson(LessonReport {
        scene: lesson.scene.clone(),
        steps: lesson.steps.iter().map(|written| step(written, &lesson.scene)).collect(),
        pictures: lesson.pictures.iter().map(|(name, png)| (name.clone(), uri(png))).collect(),
        own_scene: lesson.shows_ours().then(|| OWN_SCENE.into()),
    }))
}

fn step(step: &StepFiles, scene: &str) -> LessonStep {
    let figure = |figure: &Figure| LessonFigure { caption: figure.caption.into(), file: figure.file.clone() };
    // Print the text of a topic only once, at its first step.
    let topic = (!step.continues_topic).then_some(step.topic);
    LessonStep {
        title: step.title.clone(),
        elsewhere: step.elsewhere(scene),
        words: topic.map(|topic| topic.words.into()),
        equations: topic.iter().flat_map(|topic| topic.equations).map(|equation| equation.to_string()).collect(),
        before: step.before.as_ref().map(figure),
        after: figure(&step.after),
        change: step.change.clone(),
        plan: step.plan.as_ref().map(|plan| plan.0.clone()),
        facts: step.effect.clone(),
        places: topic
            .iter()
            .flat_map(|topic| topic.places)
            .map(|place| [place.file.to_string(), place.symbol.to_string()])
            .collect(),
    }
}
