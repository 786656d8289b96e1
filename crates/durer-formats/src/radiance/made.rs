//! What modifiers and sources become.

use super::sky::Sky;
use super::spread::Spread;
use durer_diag::Span;
use durer_scene::math::{Color, Vec3};
use glam::DVec3;
use std::rc::Rc;

/// What a modifier became.
pub(super) struct Made {
    /// The number of the material in the scene; `None`: nothing is there.
    pub number: Option<u32>,
    pub kind: Kind,
    /// The patterns above it.
    pub patterns: Below,
}

impl Made {
    pub fn nothing() -> Made {
        Made { number: None, kind: Kind::Plain, patterns: Below::default() }
    }

    pub fn is_glass(&self) -> bool {
        matches!(self.kind, Kind::Glass { .. })
    }
}

/// Patterns over a material.
#[derive(Clone)]
pub(super) struct Below {
    /// What they multiply, everywhere alike.
    pub tint: Color,
    pub sky: Option<Sky>,
    /// What they multiply by the direction of light.
    pub spread: Option<Rc<Spread>>,
}

impl Default for Below {
    fn default() -> Self {
        Below { tint: Vec3::ONE, sky: None, spread: None }
    }
}

impl Below {
    /// These and others, which come after them: of skies and spreads there is one.
    pub fn with(&self, others: &Below) -> Below {
        Below {
            tint: self.tint * others.tint,
            sky: self.sky.clone().or_else(|| others.sky.clone()),
            spread: self.spread.clone().or_else(|| others.spread.clone()),
        }
    }
}

/// What matters of a material to surfaces.
pub(super) enum Kind {
    Plain,
    /// The skin of a body; `outside`: the material of what is inside of a surface turned inside
    /// out.
    Glass {
        outside: Option<u32>,
    },
    Shining {
        radiance: Color,
    },
    /// Shining otherwise in each direction.
    Aimed {
        radiance: Color,
        spread: Rc<Spread>,
        at: Span,
    },
}

/// A cone of directions, and the light that comes from them.
pub(super) struct Distant {
    pub direction: DVec3,
    pub cosine: f64,
    pub radiance: Color,
    pub sky: Option<Sky>,
    pub at: Span,
}
