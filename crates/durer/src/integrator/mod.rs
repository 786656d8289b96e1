//! Integrators: how much light comes along a ray. One file each; the list is [`Integrator`].

pub mod account;
pub mod ao;
pub mod media;
pub mod path;
pub mod spawn;
pub mod whitted;

use crate::math::{Color, Ray};
use crate::sampler::SampleId;
use crate::spectrum::ColorMode;
use crate::world::World;
pub use account::{Account, Node, Tree, Witness};
pub use ao::AmbientOcclusion;
pub use path::{Path, Photons};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
pub use whitted::{Settings, Whitted, refract};

/// Which integrator makes a picture, with what it alone knows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Local light, mirrors and glass.
    #[default]
    Whitted,
    /// All light.
    Path(Transport),
    /// All light, and photons for what mirrors and glass throw on things.
    Photons {
        /// As for paths alone.
        #[serde(flatten)]
        transport: Transport,
        /// How many photons each sample sends out.
        count: u32,
        /// How far the first sample looks for photons, in units of the world.
        radius: Option<f32>,
        /// Whether their bias is taken out to second order, with more noise: see
        /// [`Photons::corrected`].
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        corrected: bool,
    },
    /// How much of the sky things leave free.
    Ao {
        /// How far things count.
        radius: f32,
    },
}

/// What all that follows paths of light knows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Transport {
    /// Light that was scattered more than once is not brighter than this. It removes bright specks,
    /// and light with them.
    pub clamp: Option<f32>,
    /// What colours are on the way.
    pub color: ColorMode,
    /// How light straight from lamps is found.
    #[serde(default, skip_serializing_if = "Direct::is_both")]
    pub direct: Direct,
}

/// How paths find light that comes straight from lamps and surroundings with an extent. All but
/// [`Direct::Middle`] have the same mean; they differ in noise.
///
/// Source: Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, chapter 9.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direct {
    /// Points of lights and directions of the surface are chosen; what both can find is weighed by
    /// the power heuristic.
    #[default]
    Both,
    /// Points of lights alone; a direction counts only where it meets what is never chosen.
    Lights,
    /// Directions alone; points only of lights that no direction meets.
    Bsdf,
    /// As [`Direct::Lights`], but always the same point of a surface that shines, the middle of a
    /// sphere, disc or rectangle. Shadows are hard: wrong, and for lessons alone.
    Middle,
}

impl Direct {
    /// Those that can be asked for.
    pub const CHOICES: [Direct; 3] = [Direct::Both, Direct::Lights, Direct::Bsdf];

    /// The one of a name that can be asked for.
    pub fn from_name(name: &str) -> Option<Self> {
        Direct::CHOICES.into_iter().find(|direct| direct.name() == name)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Direct::Both => "both",
            Direct::Lights => "lights",
            Direct::Bsdf => "bsdf",
            Direct::Middle => "middle",
        }
    }

    fn is_both(&self) -> bool {
        *self == Direct::Both
    }
}

impl Method {
    /// All light, as it is without wishes.
    pub const PATH: Method = Method::Path(Transport { clamp: None, color: ColorMode::Rgb, direct: Direct::Both });

    /// Names on the command line.
    pub const NAMES: &'static [&'static str] = &["whitted", "path", "photons", "ao"];

    /// Photons of a sample, where nothing else is wished.
    pub const PHOTONS: u32 = 100_000;

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Method::Whitted => "whitted",
            Method::Path(_) => "path",
            Method::Photons { .. } => "photons",
            Method::Ao { .. } => "ao",
        }
    }

    /// How light is carried along paths, by methods that follow it over any number of surfaces.
    pub fn transport(self) -> Option<Transport> {
        match self {
            Method::Path(transport) | Method::Photons { transport, .. } => Some(transport),
            Method::Whitted | Method::Ao { .. } => None,
        }
    }

    /// What colours are while light is transported.
    pub fn color_mode(self) -> ColorMode {
        self.transport().unwrap_or_default().color
    }

    /// Whether a ray's light depends on random numbers, so that a pixel needs many.
    pub fn is_random(self) -> bool {
        self != Method::Whitted
    }
}

/// One of the integrators, over a world.
#[derive(Clone, Debug)]
pub enum Integrator<'w> {
    /// Whitted's.
    Whitted(Whitted<'w>),
    /// A path tracer.
    Path(Path<'w>),
    /// Ambient occlusion.
    Ao(AmbientOcclusion<'w>),
}

impl<'w> Integrator<'w> {
    /// Over a world. Once `cancel` is set, no more rays are traced, and what comes out means
    /// nothing.
    ///
    /// Photons are random by the seed.
    pub fn new(
        world: &'w World,
        method: Method,
        settings: Settings,
        seed: u64,
        cancel: Option<&'w AtomicBool>,
    ) -> Self {
        match method {
            Method::Whitted => Integrator::Whitted(Whitted { world, settings, cancel }),
            Method::Path(transport) => Integrator::Path(Path { cancel, ..Path::new(world, settings, transport) }),
            Method::Photons { transport, count, radius, corrected } => {
                let photons = Photons::new(world, seed, count, radius);
                let photons = Some(Arc::new(if corrected { photons.corrected() } else { photons }));
                Integrator::Path(Path { photons, cancel, ..Path::new(world, settings, transport) })
            }
            Method::Ao { radius } => Integrator::Ao(AmbientOcclusion { world, radius }),
        }
    }

    /// Makes what the samples of some number need, by all threads, before they are taken.
    pub fn prepare(&self, sample: u32) {
        if let Integrator::Path(path @ Path { photons: Some(photons), .. }) = self {
            photons.prepare(path, sample);
        }
    }

    /// The light that comes along a camera ray, by the random numbers of a sample.
    pub fn radiance<T: Witness>(&self, ray: &Ray, id: SampleId, tally: &mut T) -> Color {
        match self {
            Integrator::Whitted(whitted) => whitted.radiance(ray, tally),
            Integrator::Path(path) => path.radiance(ray, id, tally),
            Integrator::Ao(ao) => ao.radiance(ray, id, tally),
        }
    }
}
