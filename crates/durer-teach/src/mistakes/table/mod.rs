//! The table of common mistakes, with one file for each family. If several mistakes produce the
//! same picture, the first one in the table is reported.

mod bounces;
mod camera;
mod geometry;
mod highlights;
mod light;
mod output;
mod patterns;
mod shadows;
mod textures;
mod transforms;

use super::SceneVariant;
use super::variant::three_factors;
use durer_scene::dialect::{DialectRules, Falloff, Highlight};
use durer_scene::scene::{Material, Scene};

/// A mistake that is common in student programs, with its description, its code, and a function
/// that applies it.
#[derive(Clone, Copy, Debug)]
pub struct Mistake {
    /// Stable name of the mistake.
    pub name: &'static str,
    /// Description without a full stop at the end. `{}` stands for the value, and `{a|b|c}` selects
    /// an alternative by the value, counted from 0.
    pub description: &'static str,
    /// The correct code.
    pub right: &'static str,
    /// The code that is probably wrong in the student's program.
    pub wrong: &'static str,
    /// Name of the lesson topic that covers the mistake.
    pub step: &'static str,
    /// Values with which the search tries the mistake.
    pub values: Values,
    /// Applies the mistake, with a value, to a variant of the scene.
    pub apply: fn(&mut SceneVariant, f32),
}

/// Values with which the search tries a mistake, such as factors or indices of lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Values {
    /// The mistake has no value.
    One,
    /// The mistake has these values, and the search fits the true value between them.
    Numbers(&'static [f32]),
    /// The mistake has exactly these values.
    Only(&'static [f32]),
    /// The mistake has the index of each light as a value, counted from 0.
    Lights,
}

impl Values {
    /// Returns the values to try in a scene with `lights` lights.
    pub fn numbers(self, lights: usize) -> Vec<f32> {
        match self {
            Values::One => vec![0.0],
            Values::Numbers(numbers) | Values::Only(numbers) => numbers.to_vec(),
            // If there are very many lights, a single one makes no visible difference.
            Values::Lights => (0..lights.min(32)).map(|light| light as f32).collect(),
        }
    }
}

/// The mistakes of Whitted's method, grouped by family.
pub const MISTAKES: [&[Mistake]; 10] = [
    light::MISTAKES,
    highlights::MISTAKES,
    shadows::MISTAKES,
    bounces::MISTAKES,
    geometry::MISTAKES,
    transforms::MISTAKES,
    textures::MISTAKES,
    patterns::MISTAKES,
    camera::MISTAKES,
    output::MISTAKES,
];

/// Finds a mistake by name.
pub fn mistake_by_name(name: &str) -> Option<&'static Mistake> {
    MISTAKES.iter().copied().flatten().find(|mistake| mistake.name == name)
}

/// Builds a table row without values to try.
pub(in crate::mistakes) const fn row(
    name: &'static str,
    step: &'static str,
    words: &'static str,
    right: &'static str,
    wrong: &'static str,
    make: fn(&mut SceneVariant, f32),
) -> Mistake {
    Mistake { name, description: words, right, wrong, step, values: Values::One, apply: make }
}

impl Mistake {
    /// Sets the values to try.
    pub(in crate::mistakes) const fn with(self, values: Values) -> Mistake {
        Mistake { values, ..self }
    }

    /// Returns true if a value was fitted and is therefore not one of the listed values.
    pub fn is_fitted(&self, value: f32) -> bool {
        matches!(self.values, Values::Numbers(numbers) if !numbers.contains(&value))
    }

    /// Returns the description with a value inserted.
    pub fn describe(&self, value: f32) -> String {
        fill_in(self.description, value)
    }

    /// Returns the correct code and the probable wrong code, with the formulas of a scene.
    pub fn code(&self, value: f32, formulas: &Formulas) -> [String; 2] {
        let messages =
            |form| fill_in(form, value).replace(ATTENUATION, formulas.fading).replace("N.H", formulas.highlight);
        [self.right, self.wrong].map(messages)
    }
}

/// Attenuation polynomial as it appears in the code of the table.
const ATTENUATION: &str = "a0 + a1 d + a2 d^2";

/// Attenuation and highlight formulas of a scene's dialect, which are inserted into the code of
/// mistakes.
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
    /// Returns the formulas that apply to a scene.
    pub fn of(scene: &Scene, rules: &DialectRules) -> Self {
        let fading = match rules.falloff {
            _ if three_factors(scene) => ATTENUATION,
            Falloff::Polynomial => "1 + f d^2",
            Falloff::InverseSquare(_) => "f d^2",
            Falloff::None => ATTENUATION,
        };
        let phong = match rules.highlight {
            Highlight::Phong => true,
            Highlight::ByKeyword => scene.materials.iter().any(
                |material| matches!(&material.value, Material::Phong(phong, _) if phong.exponent.is_none() && phong.shininess.is_some()),
            ),
            Highlight::None | Highlight::Blinn => false,
        };
        Formulas { fading, highlight: if phong { "R.L" } else { "N.H" } }
    }
}

/// Inserts a value into a text and replaces each `{a|b|c}` by the selected alternative.
fn fill_in(words: &str, value: f32) -> String {
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
