//! A compared pair of pictures.

use super::mistakes;
use super::pairs::Pair;
use super::pixel_hit::PixelHit;
use durer::image::compare::{Comparison, Finding, Verdict};
use durer::mistakes::Diagnosis;

/// Outcome of a comparison.
pub enum Outcome {
    Compared(Box<Comparison>),
    /// No picture matches the reference.
    Missing,
    /// The pictures cannot be compared, for this reason.
    Failed(String),
}

/// A pair of pictures and the outcome of its comparison.
pub struct ComparedPair {
    pub pair: Pair,
    pub outcome: Outcome,
    /// Pictures for the report, if one is written.
    pub shown: Option<PairPictures>,
    /// Hit of the ray through the worst pixel of each region; empty without a scene.
    pub hits: Vec<PixelHit>,
    /// Mistakes that reproduce the picture; `None` without a scene.
    pub diagnosis: Option<Diagnosis>,
    /// Note on the options of the reference, if they were inferred.
    pub note: Option<String>,
}

impl ComparedPair {
    pub fn new(pair: Pair, outcome: Outcome, shown: Option<PairPictures>) -> Self {
        ComparedPair { pair, outcome, shown, hits: Vec::new(), diagnosis: None, note: None }
    }

    /// Returns lines that explain the difference.
    pub fn causes(&self) -> Vec<String> {
        match (&self.outcome, &self.diagnosis) {
            (_, Some(diagnosis)) => mistakes::lines(diagnosis),
            (Outcome::Compared(found), None) => explained(found),
            _ => Vec::new(),
        }
    }

    /// Returns the keywords of the mistakes that explain the difference; empty if none does.
    pub fn mistakes(&self) -> String {
        let all: Vec<&str> = match (&self.outcome, &self.diagnosis) {
            (_, Some(diagnosis)) => {
                diagnosis.named.first().into_iter().flat_map(|named| &named.mistakes).map(|one| one.0.name).collect()
            }
            (Outcome::Compared(found), None) if found.verdict == Verdict::Different => {
                found.findings.iter().map(|finding| finding.kind).collect()
            }
            _ => Vec::new(),
        };
        all.join(" + ")
    }

    /// Returns the verdict as one word.
    pub fn verdict(&self) -> &'static str {
        match &self.outcome {
            Outcome::Compared(comparison) => comparison.verdict.name(),
            Outcome::Missing => "missing",
            Outcome::Failed(_) => "error",
        }
    }
}

/// Pictures of a pair for the report: PNG in base 64.
pub struct PairPictures {
    pub reference: String,
    pub picture: String,
    pub heat: String,
}

/// Returns the name of a pair, prefixed with the student's name.
pub fn name(pair: &Pair) -> String {
    pair.who.as_ref().map_or_else(|| pair.name.clone(), |who| format!("{who}/{}", pair.name))
}

/// Explains the difference from the pictures alone, with one line per cause.
fn explained(found: &Comparison) -> Vec<String> {
    if found.verdict != Verdict::Different {
        return Vec::new();
    }
    if found.findings.is_empty() {
        return vec![
            "the pictures alone do not reveal the cause; pass `--scene` and the options that the reference was \
             rendered with"
                .into(),
        ];
    }
    let line = |(i, finding): (usize, &Finding)| {
        let percent = mistakes::percent(finding.explained);
        match i {
            // The location of a difference does not explain it.
            0 if finding.kind.ends_with("-parts") => {
                format!("{} ({percent} of the squared difference is there)", finding.words)
            }
            0 => format!("{}: explains {percent} of the squared difference", finding.words),
            _ => format!("and {}: together {percent}", finding.words),
        }
    };
    found.findings.iter().enumerate().map(line).collect()
}
