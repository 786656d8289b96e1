//! Converts chains of modifiers. For example, a surface names a pattern, the pattern names a
//! material, and the material names another pattern.

use super::converted::{ConvertedModifier, PatternEffect};
use super::state::{MIXTURES, Modifier, PATTERNS, Reader};
use std::rc::Rc;

impl Reader<'_> {
    /// Converts the modifier that has the given index.
    pub fn convert(&mut self, number: usize) -> Rc<ConvertedModifier> {
        self.convert_below(number, &PatternEffect::default())
    }

    /// Converts a modifier to which `patterns` apply. The patterns come from a surface or from a
    /// pattern earlier in the chain.
    pub fn convert_below(&mut self, number: usize, patterns: &PatternEffect) -> Rc<ConvertedModifier> {
        // Modifiers to which skies or directional distributions apply are rare, so they are not
        // cached.
        let plain = patterns.sky.is_none() && patterns.spread.is_none();
        let key = plain.then(|| (number, patterns.tint.to_array().map(f32::to_bits)));
        if let Some(converted) = key.as_ref().and_then(|key| self.converted.get(key)) {
            return converted.clone();
        }
        let converted = self.convert_uncached(number, patterns);
        self.converted.extend(key.map(|key| (key, converted.clone())));
        converted
    }

    fn convert_uncached(&mut self, number: usize, patterns: &PatternEffect) -> Rc<ConvertedModifier> {
        let Modifier { primitive, parent, map, .. } = &self.modifiers[number];
        let (primitive, parent, map) = (primitive.clone(), *parent, *map);
        if self.is_full(primitive.at()) {
            return Rc::new(ConvertedModifier::void());
        }
        self.warn_missing_files(&primitive);
        let kind = primitive.kind.text.as_str();
        if PATTERNS.contains(&kind) {
            let all = patterns.with(&self.pattern(number, &primitive, &map));
            return match parent {
                Some(parent) => self.convert_below(parent, &all),
                None => ConvertedModifier { patterns: all, ..ConvertedModifier::void() }.into(),
            };
        }
        if MIXTURES.contains(&kind) {
            let patterns = PatternEffect { sky: None, spread: None, ..*patterns };
            return self.mixture(number, &primitive, &patterns).into();
        }
        let above = parent.map_or(Rc::new(ConvertedModifier::void()), |parent| self.convert(parent));
        self.material(number, &primitive, &patterns.with(&above.patterns)).into()
    }
}
