//! Writes a lesson as Markdown that links to picture files.

use super::folder::MARK;
use super::step_files::{Lesson, PAGE, StepFiles};
use durer::lesson::OWN_SCENE_NAME;
use std::fmt::Write;

/// Returns the Markdown text of the lesson.
pub fn text(lesson: &Lesson) -> String {
    let scene = &lesson.scene;
    let mut text = format!(
        "{MARK}\n# {}, in the order of the lecture\n\nFor a version with sliders, open [{PAGE}]({PAGE}) in a \
         browser.\n",
        plain(scene)
    );
    for (number, written) in (1..).zip(&lesson.steps) {
        step(&mut text, number, written, scene);
    }
    text + "\n`durer explain` explains the colour of any pixel.\n"
}

/// Appends one step. Writing to a string cannot fail.
fn step(text: &mut String, number: usize, step: &StepFiles, scene: &str) {
    let _ = writeln!(text, "\n## {number}. {}\n", step.title);
    if let Some(elsewhere) = step.elsewhere(scene) {
        let link = format!("[{OWN_SCENE_NAME}]({OWN_SCENE_NAME})");
        let _ = writeln!(text, "> {}\n", plain(&elsewhere).replace(OWN_SCENE_NAME, &link));
    }
    if !step.continues_topic {
        let _ = writeln!(text, "{}\n\n```text\n{}\n```\n", step.topic.words, step.topic.equations.join("\n"));
    }
    // Show the pictures side by side in a table, with captions above.
    let mut columns: Vec<(&str, &str)> =
        step.before.iter().chain([&step.after]).map(|figure| (figure.caption, figure.file.as_str())).collect();
    columns.extend(step.change.as_ref().map(|file| ("the change, lighter or darker than grey", file.as_str())));
    columns.extend(step.plan.as_ref().map(|plan| ("rays of the middle row, seen from above", plan.1.as_str())));
    let row = |cells: Vec<String>| format!("| {} |", cells.join(" | "));
    let _ = writeln!(text, "{}", row(columns.iter().map(|column| column.0.to_string()).collect()));
    let _ = writeln!(text, "{}", row(columns.iter().map(|_| ":-:".to_string()).collect()));
    let _ =
        writeln!(text, "{}\n", row(columns.iter().map(|column| format!("![{}]({})", column.0, column.1)).collect()));
    let _ = writeln!(text, "{}\n", plain(&step.effect));
    if step.continues_topic {
        return;
    }
    let places: Vec<String> = step.topic.places.iter().map(|p| format!("`{}`: `{}`", p.file, p.symbol)).collect();
    let _ = writeln!(text, "In the source:\n\n- {}", places.join("\n- "));
}

/// Escapes text that contains the name of a user's file, so that the name cannot create a link or
/// an HTML element.
fn plain(text: &str) -> String {
    text.replace('[', "&#91;").replace(']', "&#93;").replace('<', "&lt;")
}
