//! Materials, which describe how surfaces scatter light. Each has its own file: [`PhongMaterial`],
//! [`PrincipledMaterial`], [`HairMaterial`], and the patterns listed by [`PatternMaterial`].

pub mod checkerboard;
pub mod hair;
pub mod marble;
pub mod mix;
pub mod parameters;
pub mod phong;
pub mod presets;
pub mod principled;
pub mod solid_noise;
pub mod two_sided;
pub mod wood;

use crate::describe::{Field, described_list};
use crate::math::Vec3;
pub use hair::HairMaterial;
pub use parameters::Parameters;
pub use phong::{ColorNoise, PhongMaterial};
pub use principled::PrincipledMaterial;

macro_rules! delegate {
    ($($variant:ident),+) => {
        impl Pattern for PatternMaterial {
            fn weight(&self, q: Vec3) -> f32 {
                match self { $(PatternMaterial::$variant(s) => s.weight(q),)+ }
            }
            fn materials(&self) -> [u32; 2] {
                match self { $(PatternMaterial::$variant(s) => s.materials(),)+ }
            }
        }
    };
}

described_list! {
    /// Material that mixes two previously defined materials by a pattern in space.
    PatternMaterial: Pattern => delegate {
        Checkerboard(checkerboard::Checkerboard),
        Noise(solid_noise::SolidNoise),
        Marble(marble::Marble),
        Wood(wood::Wood),
        Mix(mix::Mix),
        TwoSided(two_sided::TwoSided),
    }
}

impl PatternMaterial {
    /// Share of the first material at a point in pattern space, from 0 to 1. With `conic_rings`,
    /// wood has the rings of the 2004 program, which are cones with grain stretched along the axis.
    pub fn share(&self, q: Vec3, conic_rings: bool) -> f32 {
        match self {
            PatternMaterial::Wood(wood) if conic_rings => wood.conic(q),
            _ => self.weight(q),
        }
    }
}

/// Pattern in space that determines the shares of the two materials of a [`PatternMaterial`].
pub trait Pattern {
    /// Share of the first material at a point in pattern space, from 0 to 1. For a two-sided
    /// material, it is the share on the front.
    fn weight(&self, q: Vec3) -> f32;

    /// Indices of the two materials.
    fn materials(&self) -> [u32; 2];
}

/// Maximum number of noise octaves. Finer octaves are below the precision of `f32`.
pub const MAX_OCTAVES: u32 = 32;

/// True if the value of a field is the index of another material.
pub fn is_material_index(field: &Field) -> bool {
    field.name.starts_with("material")
}

#[cfg(test)]
mod tests;
