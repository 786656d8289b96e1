//! A pair of pictures, and what came of it.

use super::named;
use super::pairs::Pair;
use super::there::There;
use durer::image::compare::{Comparison, Finding, Verdict};
use durer::mistakes::Diagnosis;

/// What came of a pair.
pub enum Outcome {
    Compared(Box<Comparison>),
    /// There is a reference only.
    Missing,
    /// Why they cannot be compared.
    Failed(String),
}

/// A pair and what came of it.
pub struct Compared {
    pub pair: Pair,
    pub outcome: Outcome,
    /// The page's pictures of it, where there is a page.
    pub shown: Option<Shown>,
    /// What of the scene is at each region, where a scene is given.
    pub there: Vec<There>,
    /// Which mistakes make the picture, where a scene is given.
    pub diagnosis: Option<Diagnosis>,
    /// What was found out of the reference's options.
    pub note: Option<String>,
}

impl Compared {
    pub fn new(pair: Pair, outcome: Outcome, shown: Option<Shown>) -> Self {
        Compared { pair, outcome, shown, there: Vec::new(), diagnosis: None, note: None }
    }

    /// What explains the difference, in lines.
    pub fn causes(&self) -> Vec<String> {
        match (&self.outcome, &self.diagnosis) {
            (_, Some(diagnosis)) => named::lines(diagnosis),
            (Outcome::Compared(found), None) => told(found),
            _ => Vec::new(),
        }
    }

    /// One word.
    pub fn verdict(&self) -> &'static str {
        match &self.outcome {
            Outcome::Compared(comparison) => comparison.verdict.name(),
            Outcome::Missing => "missing",
            Outcome::Failed(_) => "error",
        }
    }
}

/// The pictures of a pair, as a page holds them: PNG in base 64.
pub struct Shown {
    pub reference: String,
    pub picture: String,
    pub heat: String,
}

/// The name of a pair, with its owner's.
pub fn name(pair: &Pair) -> String {
    pair.who.as_ref().map_or_else(|| pair.name.clone(), |who| format!("{who}/{}", pair.name))
}

/// What explains the difference, a line for each mistake.
fn told(found: &Comparison) -> Vec<String> {
    if found.verdict != Verdict::Different {
        return Vec::new();
    }
    if found.findings.is_empty() {
        return vec![
            "cannot be told from the pictures alone; give `--scene`, with the options that made the reference".into(),
        ];
    }
    let line = |(i, finding): (usize, &Finding)| {
        let percent = (1000.0 * finding.explained + 1e-6).floor() / 10.0;
        match i {
            // Where it is tells nothing of why.
            0 if finding.kind.ends_with("-parts") => {
                format!("{} ({percent:.1} % of the squared difference lie there)", finding.words)
            }
            0 => format!("{}: explains {percent:.1} % of the squared difference", finding.words),
            _ => format!("and {}: together {percent:.1} %", finding.words),
        }
    };
    found.findings.iter().enumerate().map(line).collect()
}
