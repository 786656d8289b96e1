//! The table of usual mistakes. One file a family; the order within it is the order in which equals are named.

mod bounces;
mod camera;
mod highlights;
mod light;
mod output;
mod shadows;
mod things;

use super::Variant;
use crate::dialect::{Falloff, Highlight, Rules};

/// A usual mistake.
#[derive(Clone, Copy, Debug)]
pub struct Mistake {
    /// Its keyword.
    pub name: &'static str,
    /// What the program does, without a full stop; `{}` stands for the value, and `{a|b|c}` for what that chooses, from 0.
    pub words: &'static str,
    /// How the code should be.
    pub right: &'static str,
    /// How it probably is.
    pub wrong: &'static str,
    /// The name of the lesson's step about it.
    pub step: &'static str,
    /// With which values it is tried.
    pub values: Values,
    /// Makes it.
    pub make: fn(&mut Variant, f32),
}

/// With which values a mistake is tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Values {
    /// It has none.
    One,
    /// With each of these; the true value may lie between them.
    Numbers(&'static [f32]),
    /// With each of these, and no others.
    Only(&'static [f32]),
    /// With the number of each light, counted from 0.
    Lights,
}

impl Values {
    /// The numbers for a scene of some lights.
    pub fn numbers(self, lights: usize) -> Vec<f32> {
        match self {
            Values::One => vec![0.0],
            Values::Numbers(numbers) | Values::Only(numbers) => numbers.to_vec(),
            // Of very many lights one alone is not seen.
            Values::Lights => (0..lights.min(32)).map(|light| light as f32).collect(),
        }
    }
}

/// All families.
pub const MISTAKES: [&[Mistake]; 7] = [
    light::MISTAKES,
    highlights::MISTAKES,
    shadows::MISTAKES,
    bounces::MISTAKES,
    things::MISTAKES,
    camera::MISTAKES,
    output::MISTAKES,
];

/// The mistake of a name.
pub fn of_name(name: &str) -> Option<&'static Mistake> {
    MISTAKES.iter().copied().flatten().find(|mistake| mistake.name == name)
}

/// A row without values.
const fn row(
    name: &'static str,
    step: &'static str,
    words: &'static str,
    right: &'static str,
    wrong: &'static str,
    make: fn(&mut Variant, f32),
) -> Mistake {
    Mistake { name, words, right, wrong, step, values: Values::One, make }
}

impl Mistake {
    /// The same, tried with values.
    const fn with(self, values: Values) -> Mistake {
        Mistake { values, ..self }
    }

    /// Whether a value lies between those with which it is tried.
    pub fn is_fitted(&self, value: f32) -> bool {
        matches!(self.values, Values::Numbers(numbers) if !numbers.contains(&value))
    }

    /// Its words for a value.
    pub fn told(&self, value: f32) -> String {
        filled(self.words, value)
    }

    /// How the code should be, and how it probably is, in the formulas of a year's rules.
    pub fn forms(&self, value: f32, rules: Option<&Rules>) -> [String; 2] {
        let fading = match rules.map(|rules| rules.falloff) {
            Some(Falloff::OnePlus) => "1 + f d^2",
            Some(Falloff::Bare(_)) => "f d^2",
            Some(Falloff::None) | None => "a0 + a1 d + a2 d^2",
        };
        let is_phong = rules.is_some_and(|rules| rules.highlight == Highlight::Phong);
        let base = if is_phong { "R.L" } else { "N.H" };
        [self.right, self.wrong]
            .map(|form| filled(form, value).replace("a0 + a1 d + a2 d^2", fading).replace("N.H", base))
    }
}

/// Words with a value in them, and of each `{a|b|c}` what that chooses.
fn filled(words: &str, value: f32) -> String {
    let mut text = String::new();
    let mut rest = words;
    while let Some((before, after)) = rest.split_once('{') {
        let (inner, after) = after.split_once('}').unwrap_or((after, ""));
        text += before;
        match inner {
            "" => text += &format!("{}", (f64::from(value) * 1000.0).round() / 1000.0),
            _ if inner.contains('|') => text += inner.split('|').nth(value as usize).unwrap_or_default(),
            _ => text += &format!("{{{inner}}}"),
        }
        rest = after;
    }
    text + rest
}
