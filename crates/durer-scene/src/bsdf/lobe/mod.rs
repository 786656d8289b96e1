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

    /// What a path tracer must know of it beyond its values.
    fn kind(&self) -> LobeKind;

    /// Whether it scatters into single directions only.
    #[inline]
    fn is_delta(&self) -> bool {
        self.kind().spread == Spread::Delta
    }
}

/// How widely a lobe scatters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spread {
    /// Into single directions: a perfect mirror, clear glass.
    Delta,
    /// Mostly into a narrow cone, which many samples of a light would miss.
    Glossy,
    /// Into all directions alike, or nearly.
    Diffuse,
}

/// The properties of a lobe that decide how lights are sampled for it. [`Scatter::kind`] states them
/// for every lobe, so none can be forgotten.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeKind {
    /// How widely it scatters.
    pub spread: Spread,
    /// Whether it scatters light that arrives from behind the surface.
    pub transmits: bool,
    /// Whether light goes on in its direction, as if nothing were there.
    pub is_straight: bool,
    /// Whether it is a fibre, which scatters light from any side to any side.
    pub is_fibre: bool,
    /// Index of refraction behind the surface over that before it; `None` where nothing is refracted.
    pub eta: Option<f32>,
}

impl LobeKind {
    /// A perfect mirror.
    pub const MIRROR: LobeKind = LobeKind::reflection(Spread::Delta);
    /// A rough mirror, or a highlight.
    pub const GLOSSY: LobeKind = LobeKind::reflection(Spread::Glossy);
    /// A matte surface.
    pub const DIFFUSE: LobeKind = LobeKind::reflection(Spread::Diffuse);

    const fn reflection(spread: Spread) -> LobeKind {
        LobeKind { spread, transmits: false, is_straight: false, is_fibre: false, eta: None }
    }

    /// The kind of a lobe that scatters light from behind the surface as well, or only that.
    pub const fn transmitting(self) -> LobeKind {
        LobeKind { transmits: true, ..self }
    }

    /// The kind of a transmitting lobe that refracts by the relative index `eta`.
    pub const fn refracting(self, eta: f32) -> LobeKind {
        LobeKind { transmits: true, eta: Some(eta), ..self }
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
            #[inline]
            fn kind(&self) -> LobeKind {
                match self { $(Lobe::$name(lobe) => lobe.kind(),)+ }
            }
        }

        impl Lobe<'_> {
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
