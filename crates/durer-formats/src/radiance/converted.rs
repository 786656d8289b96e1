//! Results of converting modifiers and sources.

use super::sky::Sky;
use super::spread::Spread;
use durer_diag::Span;
use durer_scene::math::{Color, Vec3};
use glam::DVec3;
use std::rc::Rc;

/// A converted modifier.
pub(super) struct ConvertedModifier {
    /// Number of the material in the scene; `None` for `void`.
    pub number: Option<u32>,
    pub kind: Kind,
    /// Patterns that modify it.
    pub patterns: PatternEffect,
}

impl ConvertedModifier {
    pub fn nothing() -> ConvertedModifier {
        ConvertedModifier { number: None, kind: Kind::Plain, patterns: PatternEffect::default() }
    }

    pub fn is_glass(&self) -> bool {
        matches!(self.kind, Kind::Glass { .. })
    }
}

/// Combined effect of the patterns over a material.
#[derive(Clone)]
pub(super) struct PatternEffect {
    /// Constant factor.
    pub tint: Color,
    pub sky: Option<Sky>,
    /// Factor that depends on the direction of emission.
    pub spread: Option<Rc<Spread>>,
}

impl Default for PatternEffect {
    fn default() -> Self {
        PatternEffect { tint: Vec3::ONE, sky: None, spread: None }
    }
}

impl PatternEffect {
    /// Combines these patterns with others that come after them. Only one sky and one distribution
    /// apply.
    pub fn with(&self, others: &PatternEffect) -> PatternEffect {
        PatternEffect {
            tint: self.tint * others.tint,
            sky: self.sky.clone().or_else(|| others.sky.clone()),
            spread: self.spread.clone().or_else(|| others.spread.clone()),
        }
    }
}

/// Properties of a material that affect how surfaces are converted.
pub(super) enum Kind {
    Plain,
    /// A boundary of a dielectric; `outside` is the material for the inside of an inverted surface.
    Glass {
        outside: Option<u32>,
    },
    Shining {
        radiance: Color,
    },
    /// An emitter with a directional distribution.
    Aimed {
        radiance: Color,
        spread: Rc<Spread>,
        at: Span,
    },
}

/// A cone of directions, and the radiance from them.
pub(super) struct Distant {
    pub direction: DVec3,
    pub cosine: f64,
    pub radiance: Color,
    pub sky: Option<Sky>,
    pub at: Span,
}
