//! What modifiers and sources become.

use super::sky::Sky;
use crate::diag::Span;
use crate::math::{Color, Vec3};
use glam::DVec3;

/// What a modifier became.
pub(super) struct Made {
    /// The number of the material in the scene; `None`: nothing is there.
    pub number: Option<u32>,
    pub kind: Kind,
    /// What a pattern multiplies, everywhere alike.
    pub tint: Color,
    pub sky: Option<Sky>,
}

impl Made {
    pub fn nothing() -> Made {
        Made { number: None, kind: Kind::Plain, tint: Vec3::ONE, sky: None }
    }

    pub fn is_glass(&self) -> bool {
        matches!(self.kind, Kind::Glass { .. })
    }
}

/// Patterns over a material.
#[derive(Clone)]
pub(super) struct Below {
    pub tint: Color,
    pub sky: Option<Sky>,
}

impl Default for Below {
    fn default() -> Self {
        Below { tint: Vec3::ONE, sky: None }
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
    Spot {
        radiance: Color,
        direction: Vec3,
        degrees: f32,
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
