//! Lobes: the ways in which a surface scatters light. One file each; the list is [`Lobe`].

pub mod blinn;
pub mod diffuse;
pub mod fuzz;
pub mod glass;
pub mod hair;
pub mod rough;
pub mod rough_glass;

use crate::math::{Vec2, Vec3};
use crate::spectrum::Spectrum;

/// A direction that a lobe chose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattered {
    /// Where the light comes from, locally.
    pub wi: Vec3,
    /// Of a lobe of single directions, what it multiplies light by; of others this is not asked.
    pub value: Spectrum,
}

/// The value and the density of what a lobe never does.
const NOTHING: (Spectrum, f32) = (Spectrum::ZERO, 0.0);

/// What every lobe can do. Directions are local and point away from the surface; `wo` is above it
/// (`wo.z` > 0).
pub trait Scatter {
    /// The lobe's value times |cos| of `wi`, and the density per solid angle with which
    /// [`Scatter::sample`] chooses it; both 0 for a lobe of single directions.
    fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32);

    /// A direction; `choice` and `u` are uniform from 0 to 1. `None` where none comes of these
    /// numbers.
    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<Scattered>;

    /// Whether it scatters into single directions only.
    fn is_delta(&self) -> bool {
        false
    }
}

macro_rules! lobes {
    ($($(#[doc = $doc:literal])+ $name:ident($type:ty),)+) => {
        /// One way of scattering.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Lobe<'a> { $($(#[doc = $doc])+ $name($type),)+ }

        $(impl<'a> From<$type> for Lobe<'a> {
            fn from(lobe: $type) -> Self { Lobe::$name(lobe) }
        })+

        impl Scatter for Lobe<'_> {
            #[inline]
            fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
                match self { $(Lobe::$name(lobe) => lobe.eval(wo, wi),)+ }
            }
            fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<Scattered> {
                match self { $(Lobe::$name(lobe) => lobe.sample(wo, choice, u),)+ }
            }
            fn is_delta(&self) -> bool {
                match self { $(Lobe::$name(lobe) => lobe.is_delta(),)+ }
            }
        }

        impl Lobe<'_> {
            /// Whether it scatters light from behind the surface into many directions.
            pub fn passes_light(&self) -> bool {
                matches!(self, Lobe::DiffuseTransmission(_) | Lobe::RoughGlass(_) | Lobe::Hair(_))
                    || matches!(self, Lobe::Rough(rough) if rough.behind)
            }

            /// Whether it may scatter much into a narrow part of all directions.
            pub fn is_glossy(&self) -> bool {
                matches!(self, Lobe::Rough(_) | Lobe::RoughGlass(_) | Lobe::Blinn(_))
            }

            /// Its name, for explanations.
            pub fn name(&self) -> &'static str {
                match self { $(Lobe::$name(_) => stringify!($name),)+ }
            }
        }
    };
}

lobes! {
    /// Matte: energy-preserving Oren-Nayar; Lambert where it is not rough.
    Diffuse(diffuse::Diffuse<'a>),
    /// Matte, on the other side.
    DiffuseTransmission(diffuse::DiffuseTransmission),
    /// The course's highlight.
    Blinn(blinn::Blinn),
    /// A rough mirror: metal, a coat, the skin of plastic.
    Rough(rough::Rough),
    /// Rough glass.
    RoughGlass(rough_glass::RoughGlass),
    /// A perfect mirror.
    Mirror(glass::Mirror),
    /// Perfect refraction.
    Refraction(glass::Refraction),
    /// Light that goes straight on.
    Through(glass::Through),
    /// Fibres that stand out.
    Fuzz(fuzz::Fuzz),
    /// One fibre.
    Hair(hair::Hair<'a>),
}
