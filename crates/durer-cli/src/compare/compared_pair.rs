//! A pair of pictures and the result of its comparison.

use super::mistakes;
use super::pairs::Pair;
use super::pixel_hit::PixelHit;
use crate::page::PairPictures;
use durer::image::compare::{Comparison, Finding, Verdict};
use durer::mistakes::Diagnosis;

/// Result of comparing one pair of pictures in `durer compare`.
pub enum Outcome {
    Compared(Box<Comparison>),
    /// There is no picture to compare with the reference.
    Missing,
    /// The pictures cannot be compared. The string states the reason.
    Failed(String),
}

/// A pair of pictures after its comparison, with the causes of the difference.
pub struct ComparedPair {
    pub pair: Pair,
    pub outcome: Outcome,
    /// Pictures for the report, if a report is written.
    pub pictures: Option<PairPictures>,
    /// For each region, the hit of the ray through the pixel that differs most. The list is empty
    /// if there is no scene.
    pub hits: Vec<PixelHit>,
    /// Result of the search for mistakes, or `None` if there is no scene.
    pub diagnosis: Option<Diagnosis>,
    /// Note about the options of the reference if they were inferred.
    pub note: Option<String>,
    /// True unless the reference seems to show distances or normals, which `--scene` cannot
    /// explain.
    pub shows_color: bool,
}

impl ComparedPair {
    /// Creates a compared pair without hits or a diagnosis.
    pub fn new(pair: Pair, outcome: Outcome, pictures: Option<PairPictures>) -> Self {
        ComparedPair { pair, outcome, pictures, hits: Vec::new(), diagnosis: None, note: None, shows_color: true }
    }

    /// Returns lines that explain the difference.
    pub fn causes(&self) -> Vec<String> {
        match (&self.outcome, &self.diagnosis) {
            // If the scene explains nothing, report what the pictures alone explain.
            (Outcome::Compared(comparison), Some(diagnosis)) if has_only_findings(comparison, diagnosis) => {
                let mut lines = explained(comparison, None);
                if !comparison.has_cause() {
                    lines.extend(mistakes::lines(diagnosis));
                }
                lines
            }
            (_, Some(diagnosis)) => mistakes::lines(diagnosis),
            (Outcome::Compared(comparison), None) => explained(comparison, Some(self.shows_color)),
            _ => Vec::new(),
        }
    }

    /// Returns the names of the mistakes that explain the difference. The list is empty if there
    /// are none.
    pub fn mistakes(&self) -> String {
        let all: Vec<&str> = match (&self.outcome, &self.diagnosis) {
            (Outcome::Compared(comparison), Some(diagnosis)) if has_only_findings(comparison, diagnosis) => {
                comparison.findings.iter().map(|finding| finding.kind).collect()
            }
            (_, Some(diagnosis)) => diagnosis
                .explanations
                .first()
                .into_iter()
                .flat_map(|explanation| &explanation.mistakes)
                .map(|one| one.0.name)
                .collect(),
            (Outcome::Compared(comparison), None) if comparison.verdict == Verdict::Different => {
                comparison.findings.iter().map(|finding| finding.kind).collect()
            }
            _ => Vec::new(),
        };
        all.join(" + ")
    }

    /// Returns the verdict as a single word.
    pub fn verdict(&self) -> &'static str {
        match &self.outcome {
            Outcome::Compared(comparison) => comparison.verdict.name(),
            Outcome::Missing => "missing",
            Outcome::Failed(_) => "error",
        }
    }
}

/// Returns the name of a pair, preceded by the student's name.
pub fn name(pair: &Pair) -> String {
    pair.student.as_ref().map_or_else(|| pair.name.clone(), |who| format!("{who}/{}", pair.name))
}

/// Returns true if the pictures alone explain a difference, but the search in the scene does not.
fn has_only_findings(comparison: &Comparison, diagnosis: &Diagnosis) -> bool {
    let is_unknown = diagnosis.explanations.is_empty() && diagnosis.nearly.is_none() && diagnosis.remark.is_none();
    is_unknown && comparison.verdict == Verdict::Different && !comparison.findings.is_empty()
}

/// Explains a difference from the pictures alone, with one line per cause. `scene` is `None` if the
/// scene was already given, and otherwise true if it would help.
fn explained(comparison: &Comparison, scene: Option<bool>) -> Vec<String> {
    if comparison.verdict != Verdict::Different {
        return Vec::new();
    }
    if comparison.findings.is_empty() {
        let advice = match scene {
            Some(true) => "; pass `--scene` and the options that the reference was rendered with",
            _ => "",
        };
        return vec![format!("the pictures alone do not reveal the cause{advice}")];
    }
    let line = |(i, finding): (usize, &Finding)| {
        let percent = mistakes::percent(finding.explained);
        match i {
            // The location of a difference does not explain it.
            0 if !comparison.has_cause() => {
                let advice = match scene {
                    Some(true) => ": the pictures alone do not show the cause; pass `--scene` to try common mistakes",
                    Some(false) => ": the pictures alone do not show the cause",
                    None => "",
                };
                format!(
                    "{}{advice} ({percent} of the squared difference lies in this part of the picture)",
                    finding.description
                )
            }
            0 => format!("{}: explains {percent} of the squared difference", finding.description),
            _ => format!("and {}: the causes so far explain {percent}", finding.description),
        }
    };
    comparison.findings.iter().enumerate().map(line).collect()
}
