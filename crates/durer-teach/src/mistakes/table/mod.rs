//! The table of usual mistakes. One file a family; the order within it is the order in which equals
//! are named.

mod bounces;
mod camera;
mod highlights;
mod light;
mod output;
mod shadows;
mod things;

use super::Variant;
use super::variant::three_factors;
use durer_scene::dialect::{Falloff, Highlight, Rules};
use durer_scene::scene::Scene;

/// A usual mistake.
#[derive(Clone, Copy, Debug)]
pub struct Mistake {
    /// Its keyword.
    pub name: &'static str,
    /// What the program does, without a full stop; `{}` stands for the value, and `{a|b|c}` for
    /// what that chooses, from 0.
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

    /// How the code should be, and how it probably is, in a scene's formulas.
    pub fn forms(&self, value: f32, formulas: &Formulas) -> [String; 2] {
        let said = |form| filled(form, value).replace(ATTENUATION, formulas.fading).replace("N.H", formulas.highlight);
        [self.right, self.wrong].map(said)
    }
}

/// What a light is divided by, with all that it can be.
const ATTENUATION: &str = "a0 + a1 d + a2 d^2";

/// The formulas of a scene and its year, in whose words mistakes are told.
#[derive(Clone, Copy, Debug)]
pub struct Formulas {
    fading: &'static str,
    highlight: &'static str,
}

impl Default for Formulas {
    fn default() -> Self {
        Formulas { fading: ATTENUATION, highlight: "N.H" }
    }
}

impl Formulas {
    /// Of a scene by its rules.
    pub fn of(scene: &Scene, rules: &Rules) -> Self {
        let fading = match rules.falloff {
            _ if three_factors(scene) => ATTENUATION,
            Falloff::OnePlus => "1 + f d^2",
            Falloff::Bare(_) => "f d^2",
            Falloff::None => ATTENUATION,
        };
        Formulas { fading, highlight: if rules.highlight == Highlight::Phong { "R.L" } else { "N.H" } }
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
