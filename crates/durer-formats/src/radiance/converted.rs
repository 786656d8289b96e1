//! Data types for the results of converting modifiers and sources.

use super::distribution::DirectionalDistribution;
use super::sky::Sky;
use durer_diag::Span;
use durer_scene::math::{Color, Vec3};
use glam::DVec3;
use std::rc::Rc;

/// Result of converting a Radiance modifier, which is a material in the scene and the patterns that
/// apply to it.
pub(super) struct ConvertedModifier {
    /// Index of the material in the scene, or `None` for `void`.
    pub number: Option<u32>,
    pub kind: MaterialKind,
    /// Combined effect of the patterns that modify the material.
    pub patterns: PatternEffect,
}

impl ConvertedModifier {
    /// Returns the result of converting the modifier `void`.
    pub fn void() -> ConvertedModifier {
        ConvertedModifier { number: None, kind: MaterialKind::Plain, patterns: PatternEffect::default() }
    }

    /// Returns true if surfaces with this modifier are the boundary of a glass body.
    pub fn is_glass(&self) -> bool {
        matches!(self.kind, MaterialKind::Glass { .. })
    }
}

/// Combined effect of the Radiance patterns that apply to a material: a tint, a sky and a
/// directional distribution.
#[derive(Clone)]
pub(super) struct PatternEffect {
    /// Constant factor.
    pub tint: Color,
    pub sky: Option<Sky>,
    /// Factor that depends on the direction in which light is emitted.
    pub spread: Option<Rc<DirectionalDistribution>>,
}

impl Default for PatternEffect {
    fn default() -> Self {
        PatternEffect { tint: Vec3::ONE, sky: None, spread: None }
    }
}

impl PatternEffect {
    /// Combines these patterns with others that come after them. If both have a sky or both have a
    /// distribution, only the first one applies.
    pub fn with(&self, others: &PatternEffect) -> PatternEffect {
        PatternEffect {
            tint: self.tint * others.tint,
            sky: self.sky.clone().or_else(|| others.sky.clone()),
            spread: self.spread.clone().or_else(|| others.spread.clone()),
        }
    }
}

/// Kind of a converted material, which affects how surfaces and sources are converted.
pub(super) enum MaterialKind {
    Plain,
    /// Boundary of a dielectric body. `outside` is the material that inverted surfaces use.
    Glass {
        outside: Option<u32>,
    },
    Emitter {
        radiance: Color,
    },
    /// Emitter that has a directional distribution.
    DirectionalEmitter {
        radiance: Color,
        spread: Rc<DirectionalDistribution>,
        at: Span,
    },
}

/// Radiance `source` that becomes part of the environment map, with its cone of directions and the
/// radiance from them.
pub(super) struct DistantSource {
    pub direction: DVec3,
    pub cosine: f64,
    pub radiance: Color,
    pub sky: Option<Sky>,
    pub at: Span,
}
