//! Materials: what a surface does with light. One file each; the list is [`Solid`] beside
//! [`PhongMaterial`], [`PrincipledMaterial`] and [`HairMaterial`].

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
        impl Pattern for Solid {
            fn weight(&self, q: Vec3) -> f32 {
                match self { $(Solid::$variant(s) => s.weight(q),)+ }
            }
            fn materials(&self) -> [u32; 2] {
                match self { $(Solid::$variant(s) => s.materials(),)+ }
            }
        }
    };
}

described_list! {
    /// A material made of two earlier ones, mixed by a pattern in space.
    Solid: Pattern => delegate {
        Checkerboard(checkerboard::Checkerboard),
        Noise(solid_noise::SolidNoise),
        Marble(marble::Marble),
        Wood(wood::Wood),
        Mix(mix::Mix),
        TwoSided(two_sided::TwoSided),
    }
}

impl Solid {
    /// Share of the first material at a point of pattern space, from 0 to 1. `conic_rings`: wood has
    /// the rings of the program of 2004, cones whose grain is stretched along the axis.
    pub fn share(&self, q: Vec3, conic_rings: bool) -> f32 {
        match self {
            Solid::Wood(wood) if conic_rings => wood.conic(q),
            _ => self.weight(q),
        }
    }
}

/// What every pattern in space can do.
pub trait Pattern {
    /// The share of the first material at a point of pattern space, from 0 to 1; on the front of a
    /// surface, where that matters.
    fn weight(&self, q: Vec3) -> f32;

    /// Numbers of the two materials.
    fn materials(&self) -> [u32; 2];
}

/// The most octaves that noise may have: beyond, they are finer than numbers can tell.
pub const MAX_OCTAVES: u32 = 32;

/// Whether a field holds the number of another material.
pub fn is_material_index(field: &Field) -> bool {
    field.name.starts_with("material")
}

#[cfg(test)]
mod tests;
