//! Chains of modifiers: a surface names a pattern, which names a material, which names a pattern,
//! and so on.

use super::made::{Below, Made};
use super::state::{MIXTURES, Modifier, PATTERNS, Reader};
use std::rc::Rc;

impl Reader<'_> {
    /// Converts a modifier.
    pub fn made(&mut self, number: usize) -> Rc<Made> {
        self.below(number, &Below::default())
    }

    /// Converts a modifier below the patterns that a surface names before it.
    pub fn below(&mut self, number: usize, patterns: &Below) -> Rc<Made> {
        // Modifiers below skies and light distributions are few, so they are not cached.
        let plain = patterns.sky.is_none() && patterns.spread.is_none();
        let key = plain.then(|| (number, patterns.tint.to_array().map(f32::to_bits)));
        if let Some(made) = key.as_ref().and_then(|key| self.made.get(key)) {
            return made.clone();
        }
        let made = self.make(number, patterns);
        self.made.extend(key.map(|key| (key, made.clone())));
        made
    }

    fn make(&mut self, number: usize, patterns: &Below) -> Rc<Made> {
        let Modifier { thing, parent, map, .. } = &self.modifiers[number];
        let (thing, parent, map) = (thing.clone(), *parent, *map);
        if self.is_full(thing.at()) {
            return Rc::new(Made::nothing());
        }
        self.missing(&thing);
        let kind = thing.kind.text.as_str();
        if PATTERNS.contains(&kind) {
            let all = patterns.with(&self.pattern(number, &thing, &map));
            return match parent {
                Some(parent) => self.below(parent, &all),
                None => Made { patterns: all, ..Made::nothing() }.into(),
            };
        }
        if MIXTURES.contains(&kind) {
            let patterns = Below { sky: None, spread: None, ..*patterns };
            return self.mixture(number, &thing, &patterns).into();
        }
        let above = parent.map_or(Rc::new(Made::nothing()), |parent| self.made(parent));
        self.material(number, &thing, &patterns.with(&above.patterns)).into()
    }
}
