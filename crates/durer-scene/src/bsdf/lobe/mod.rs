//! Lobes, which are the parts of a BSDF. Each lobe has its own file, and [`Lobe`] lists all of
//! them.

pub mod blinn;
pub mod diffuse;
pub mod disney;
pub mod fuzz;
pub mod glass;
pub mod hair;
pub mod rough;
pub mod rough_glass;

use crate::math::{Vec2, Vec3};
use crate::spectrum::Spectrum;

/// Direction sampled from a single lobe, as returned by [`Scatter::sample`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeSample {
    /// Local direction to the incident light.
    pub wi: Vec3,
    /// Throughput factor of a delta lobe. The factor is ignored for other lobes.
    pub value: Spectrum,
}

/// Value and pdf for a direction in which a lobe does not scatter.
const NO_SCATTERING: (Spectrum, f32) = (Spectrum::ZERO, 0.0);

/// Interface for evaluating and sampling a BSDF lobe. Directions are local and point away from the
/// surface. `wo` is above the surface (`wo.z` > 0).
pub trait Scatter {
    /// Returns the value times |cos| of `wi`, and the pdf per solid angle with which
    /// [`Scatter::sample`] chooses `wi`. Both results are 0 for a delta lobe.
    fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32);

    /// Samples a direction. `choice` and `u` are uniform in [0, 1]. Returns `None` if the sample
    /// fails.
    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<LobeSample>;

    /// Returns the properties that decide how a path tracer samples lights for the lobe.
    fn kind(&self) -> LobeKind;

    /// True if the lobe scatters only into single directions.
    #[inline]
    fn is_delta(&self) -> bool {
        self.kind().spread == Spread::Delta
    }
}

/// Angular spread of a BSDF lobe, which decides how lights are sampled for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spread {
    /// Single directions, as for a perfect mirror or clear glass.
    Delta,
    /// Mostly a narrow cone of directions, which light samples rarely hit.
    Glossy,
    /// All directions, with equal or nearly equal values.
    Diffuse,
}

/// Properties of a BSDF lobe that decide how lights are sampled for it. Every lobe returns these
/// properties from [`Scatter::kind`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeKind {
    /// Angular spread.
    pub spread: Spread,
    /// True if the lobe scatters light that arrives from behind the surface.
    pub transmits: bool,
    /// True if the light keeps its direction, as if there were no surface.
    pub is_straight: bool,
    /// True for a fibre, which scatters light from any side to any side.
    pub is_fibre: bool,
    /// Index of refraction behind the surface, relative to the index in front of it, or `None`
    /// without refraction.
    pub eta: Option<f32>,
}

impl LobeKind {
    /// Perfect mirror.
    pub const MIRROR: LobeKind = LobeKind::reflection(Spread::Delta);
    /// Rough mirror or highlight.
    pub const GLOSSY: LobeKind = LobeKind::reflection(Spread::Glossy);
    /// Diffuse surface.
    pub const DIFFUSE: LobeKind = LobeKind::reflection(Spread::Diffuse);

    const fn reflection(spread: Spread) -> LobeKind {
        LobeKind { spread, transmits: false, is_straight: false, is_fibre: false, eta: None }
    }

    /// Returns the kind of a lobe that scatters light from behind the surface, possibly in addition
    /// to light from the front.
    pub const fn transmitting(self) -> LobeKind {
        LobeKind { transmits: true, ..self }
    }

    /// Returns the kind of a transmitting lobe that refracts light with the relative index `eta`.
    pub const fn refracting(self, eta: f32) -> LobeKind {
        LobeKind { transmits: true, eta: Some(eta), ..self }
    }
}

macro_rules! lobes {
    ($($(#[doc = $doc:literal])+ $name:ident($type:ty),)+) => {
        /// Scattering lobe of a BSDF, of any type.
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
            fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<LobeSample> {
                match self { $(Lobe::$name(lobe) => lobe.sample(wo, choice, u),)+ }
            }
            #[inline]
            fn kind(&self) -> LobeKind {
                match self { $(Lobe::$name(lobe) => lobe.kind(),)+ }
            }
        }

        impl Lobe<'_> {
            /// Names of all types of lobes.
            pub const NAMES: &'static [&'static str] = &[$(stringify!($name)),+];

            /// Name of the type of the lobe, for explanations.
            pub fn name(&self) -> &'static str {
                match self { $(Lobe::$name(_) => stringify!($name),)+ }
            }
        }
    };
}

lobes! {
    /// Diffuse reflection by the energy-preserving Oren-Nayar model, which is Lambertian at
    /// roughness 0.
    Diffuse(diffuse::Diffuse<'a>),
    /// Diffuse transmission.
    DiffuseTransmission(diffuse::DiffuseTransmission),
    /// Blinn or Phong highlight, as in the course.
    Blinn(blinn::Blinn),
    /// Rough reflection, as by metal, a coat or the surface of plastic.
    Rough(rough::RoughReflection),
    /// Rough glass.
    RoughGlass(rough_glass::RoughGlass),
    /// Perfect mirror.
    Mirror(glass::Mirror),
    /// Perfect refraction.
    Refraction(glass::Refraction),
    /// Transmission that keeps the direction of the light, as if there were no surface.
    Through(glass::StraightTransmission),
    /// Fuzz made of short fibres, as on velvet.
    Fuzz(fuzz::Fuzz),
    /// Diffuse base and sheen of Disney's material.
    DisneyDiffuse(disney::DisneyDiffuse),
    /// Clear coat of Disney's material.
    DisneyCoat(disney::DisneyCoat),
    /// Single hair fibre.
    Hair(hair::Hair<'a>),
}
