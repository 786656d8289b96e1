//! Reads the primitives of a scene file, each of which has a modifier, a type, a name and
//! arguments.

use super::words::{Word, Words};
use crate::shared_report::SharedReport;
use durer_diag::{Diagnostic, Span};
use durer_scene::math::Vec3;
use glam::DVec3;

/// Primitive of a Radiance scene as stored in the file, which is a surface, material, pattern or
/// mixture.
#[derive(Debug)]
pub(super) struct RadPrimitive {
    pub modifier: Word,
    pub kind: Word,
    pub name: Word,
    pub texts: Vec<Word>,
    pub numbers: Vec<f64>,
}

/// Returns the next word of the primitive that starts at `start`, and reports an error if there is
/// none.
fn next_word(start: Span, words: &mut Words, report: &SharedReport) -> Option<Word> {
    let word = words.next();
    if word.is_none() {
        let error = Diagnostic::error("the file ends within this primitive").code("incomplete");
        report.push(error.at(start.join(words.end())));
    }
    word
}

impl RadPrimitive {
    /// Reads the rest of a primitive after its first word. Returns `None` after an error, because
    /// it is then unknown where the next primitive starts.
    pub fn read(modifier: Word, words: &mut Words, report: &SharedReport) -> Option<RadPrimitive> {
        let start = modifier.at;
        if modifier.text.parse::<f32>().is_ok() {
            let error = Diagnostic::error(format!("expected a primitive, found the number {}", modifier.quoted()));
            let help =
                "the primitive before it declares fewer numbers than follow it, or the name of a modifier is missing";
            report.push(error.code("bad-value").at(start).help(help));
            return None;
        }
        let mut next = || next_word(start, words, report);
        let (kind, name) = (next()?, next()?);
        if kind.text == "alias" {
            return Some(RadPrimitive { modifier, kind, name, texts: vec![next()?], numbers: Vec::new() });
        }
        let texts = (0..next()?.count(report)?).map(|_| next()).collect::<Option<_>>()?;
        let wholes = next()?;
        if wholes.count(report)? != 0 {
            report.error(wholes.at, "the number of integer arguments of a primitive must be 0");
            return None;
        }
        let declared = next()?;
        let count = declared.count(report)?;
        let mut numbers = Vec::new();
        while numbers.len() < count {
            let word = next_word(start, words, report)?;
            if !numbers.is_empty() && words.starts_line(&word) && !word.is_number() {
                let message = format!("{} declares {count} numbers, but {} follow", declared.quoted(), numbers.len());
                let error = Diagnostic::error(message).code("bad-value").at(declared.at);
                report.push(error.related(word.at, "this word is not a number"));
                return None;
            }
            numbers.push(word.number(report)?);
        }
        Some(RadPrimitive { modifier, kind, name, texts, numbers })
    }

    /// Returns the span that covers the type and the name.
    pub fn at(&self) -> Span {
        self.kind.at.join(self.name.at)
    }

    /// Returns true if the number of real arguments is one of `counts`, and otherwise reports an
    /// error.
    pub fn has(&self, counts: &[usize], report: &SharedReport) -> bool {
        let right = counts.contains(&self.numbers.len());
        if !right {
            let counts = counts.iter().map(usize::to_string).collect::<Vec<_>>().join(" or ");
            let message =
                format!("a {} needs {counts} numbers, but this one has {}", self.kind.text, self.numbers.len());
            report.error(self.at(), message);
        }
        right
    }

    /// Returns the three real arguments that start at index `first` as a point.
    pub fn point(&self, first: usize) -> DVec3 {
        let number = |i: usize| self.numbers.get(first + i).copied().unwrap_or(0.0);
        DVec3::new(number(0), number(1), number(2))
    }

    /// Returns the three real arguments that start at index `first` as a colour. Negative values
    /// are replaced with 0.
    pub fn color(&self, first: usize) -> Vec3 {
        self.point(first).as_vec3().max(Vec3::ZERO)
    }

    /// Returns the real argument with the index `i`.
    pub fn number(&self, i: usize) -> Option<f32> {
        self.numbers.get(i).map(|x| *x as f32)
    }
}
