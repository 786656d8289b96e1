//! Converts mixtures of two materials.

use super::args::RadPrimitive;
use super::converted::{ConvertedModifier, MaterialKind, PatternEffect};
use super::state::Reader;
use crate::number::parse_f32;
use durer_scene::material::PatternMaterial;
use durer_scene::material::mix::Mix;
use durer_scene::scene::{Material, Spanned};
use std::collections::BTreeMap;

impl Reader<'_> {
    /// Converts a mixture of two materials. The proportion of the two materials becomes a constant.
    pub fn mixture(&mut self, number: usize, primitive: &RadPrimitive, patterns: &PatternEffect) -> ConvertedModifier {
        let (at, kind) = (primitive.at(), primitive.kind.text.as_str());
        if primitive.texts.len() < 4 {
            self.report.error(at, format!("a `{kind}` needs two modifiers and a mixing function"));
            return ConvertedModifier::void();
        }
        let constant = parse_f32(primitive.texts[2].text.as_bytes()).ok().filter(|_| kind == "mixfunc");
        let share = match (kind, constant) {
            (_, Some(share)) => share.clamp(0.0, 1.0),
            // Letters cover only a small part of a surface.
            ("mixtext", _) => {
                self.report.unsupported_once(at, "text has no counterpart: the modifier around it is used");
                0.0
            }
            _ => {
                self.report.unsupported_once(
                    at,
                    format!("`{kind}` has no counterpart: both modifiers are mixed in equal parts"),
                );
                0.5
            }
        };
        let [first, second] =
            self.modifiers[number].others.map(|other| other.map(|other| self.convert_below(other, patterns)));
        let numbers = [&first, &second].map(|converted| converted.as_ref().and_then(|converted| converted.number));
        let glass =
            [&first, &second].iter().any(|converted| converted.as_ref().is_some_and(|converted| converted.is_glass()));
        let number = match numbers {
            [_, second] if share == 0.0 => second,
            [first, _] if share == 1.0 => first,
            [Some(_), Some(_)] if glass => {
                self.report.unsupported_once(at, "glass bodies cannot be mixed: the first modifier is used");
                numbers[0]
            }
            [Some(material1), Some(material2)] => {
                let solid = PatternMaterial::from(Mix { material1, material2, share, share_texture: None });
                self.scene.materials.push(Spanned { value: Material::Solid(solid, Vec::new()), span: at });
                Some((self.scene.materials.len() - 1) as u32)
            }
            [first, second] if glass => {
                self.report
                    .unsupported_once(at, "glass bodies cannot be partly transparent: the whole glass body is shown");
                first.or(second)
            }
            // If one of the two materials is missing, the result is partly transparent.
            [first, second] => {
                let share = if first.is_some() { share } else { 1.0 - share };
                first.or(second).map(|number| self.with_scaled_opacity(number, share, &mut BTreeMap::new()))
            }
        };
        let kind = if glass { MaterialKind::Glass { outside: None } } else { MaterialKind::Plain };
        ConvertedModifier { number, kind, ..ConvertedModifier::void() }
    }

    /// Returns a copy of a material after multiplying its opacity by `share`.
    fn with_scaled_opacity(&mut self, number: u32, share: f32, scaled: &mut BTreeMap<u32, u32>) -> u32 {
        if let Some(scaled) = scaled.get(&number) {
            return *scaled;
        }
        if self.is_full(self.scene.materials[number as usize].span) {
            return number;
        }
        let Spanned { mut value, span } = self.scene.materials[number as usize].clone();
        match &mut value {
            Material::Principled(layers) => layers.opacity *= share,
            Material::Solid(PatternMaterial::Mix(mix), _) => {
                mix.material1 = self.with_scaled_opacity(mix.material1, share, scaled);
                mix.material2 = self.with_scaled_opacity(mix.material2, share, scaled);
            }
            _ => {}
        }
        self.scene.materials.push(Spanned { value, span });
        let faded = (self.scene.materials.len() - 1) as u32;
        scaled.insert(number, faded);
        faded
    }
}
