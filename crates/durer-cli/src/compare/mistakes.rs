//! Formats the result of the search for a student's mistakes as text and JSON.

use super::stage::ReferenceScene;
use crate::progress;
use durer::image::compare::Picture;
use durer::mistakes::{Diagnosis, DiagnosisInput, Explanation, diagnose};
use serde_json::{Value, json};

/// Searches for the mistakes that explain the difference between two pictures.
pub fn find_mistakes(stage: &ReferenceScene, reference: &Picture, test: &Picture) -> Diagnosis {
    let ReferenceScene { compiled, job, transfer, .. } = stage;
    let scene = &compiled.loaded.scene;
    let input = DiagnosisInput { scene, world: &compiled.world, job, transfer: *transfer, reference, test };
    progress::show_progress("trying mistakes", |share| diagnose(&input, share))
}

/// Formats a diagnosis as lines, with the mistake first and the code after it.
pub fn lines(diagnosis: &Diagnosis) -> Vec<String> {
    if !diagnosis.reference_matches_scene() {
        return vec![format!(
            "cause unknown: if the scene is rendered with the given options, {:.0} % of the pixels differ from the \
             reference; pass the options that the reference was rendered with (--dialect, --shadows, --bounces, \
             --samples, --transfer)",
            100.0 * diagnosis.reference_difference
        )];
    }
    if let Some(nearly) = &diagnosis.nearly {
        return vec![format!(
            "{}: explains {} of the squared difference, but another difference remains",
            words(nearly),
            percent(nearly.explained)
        )];
    }
    if let Some(remark) = &diagnosis.remark {
        return vec![remark.clone()];
    }
    let Some(first) = diagnosis.explanations.first() else {
        return vec!["cause unknown: none of the known mistakes explains the difference".into()];
    };
    let mut lines = vec![format!("{}: explains {} of the squared difference", words(first), percent(first.explained))];
    for (mistake, value) in &first.mistakes {
        let [right, wrong] = mistake.code(*value, &diagnosis.formulas);
        lines.push(format!("  should be:  {right}"));
        lines.push(format!("  may be:     {wrong}"));
        lines.push(format!("  see the step `{}` of `durer lesson`", mistake.step));
    }
    lines.extend(
        diagnosis
            .explanations
            .iter()
            .skip(1)
            .filter(|explanation| words(explanation) != words(first))
            .take(4)
            .map(|explanation| format!("  or, equivalent in this scene: {}", words(explanation))),
    );
    lines
}

/// Formats a fraction as a percentage, rounded down so that only 1 becomes 100 %.
pub fn percent(share: f64) -> String {
    format!("{:.1} %", (1000.0 * share + 1e-6).floor() / 10.0)
}

/// Describes one or two mistakes.
pub fn words(explanation: &Explanation) -> String {
    let each: Vec<String> = explanation.mistakes.iter().map(|(mistake, value)| mistake.describe(*value)).collect();
    each.join("; and ")
}

/// Returns the diagnosis as JSON.
pub fn json(diagnosis: &Diagnosis) -> Value {
    let one = |explanation: &Explanation| {
        let mistake = |(mistake, value): &(&durer::mistakes::Mistake, f32)| {
            let [right, wrong] = mistake.code(*value, &diagnosis.formulas);
            json!({
                "name": mistake.name, "words": mistake.describe(*value), "value": value,
                "right": right, "wrong": wrong, "step": mistake.step,
            })
        };
        json!({
            "mistakes": explanation.mistakes.iter().map(mistake).collect::<Vec<_>>(),
            "words": words(explanation), "explained": explanation.explained, "matched": explanation.matched,
        })
    };
    json!({
        "reference_off": diagnosis.reference_difference,
        "told": !diagnosis.explanations.is_empty(),
        "nearest": diagnosis.closest_trials.iter().map(|n| json!([words(n), n.explained, n.matched])).collect::<Vec<_>>(),
        "remark": diagnosis.remark,
        "nearly": diagnosis.nearly.as_ref().map(one),
        "named": diagnosis.explanations.iter().map(one).collect::<Vec<_>>(),
        "lines": lines(diagnosis),
    })
}
