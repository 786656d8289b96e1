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
pub use account::{Account, Node, Witness};
pub use ao::AmbientOcclusion;
pub use path::Path;
use serde::{Deserialize, Serialize};
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
    Path {
        /// Light that was scattered more than once is not brighter than this.
        clamp: Option<f32>,
        /// What colours are on the way.
        color: ColorMode,
    },
    /// How much of the sky things leave free.
    Ao {
        /// How far things count.
        radius: f32,
    },
}

impl Method {
    /// All light, as it is without wishes.
    pub const PATH: Method = Method::Path { clamp: None, color: ColorMode::Rgb };

    /// Names on the command line.
    pub const NAMES: [&'static str; 3] = ["whitted", "path", "ao"];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Method::Whitted => "whitted",
            Method::Path { .. } => "path",
            Method::Ao { .. } => "ao",
        }
    }

    /// Whether a ray's light depends on random numbers, so that a pixel needs many.
    pub fn is_random(self) -> bool {
        self != Method::Whitted
    }
}

/// One of the integrators, over a world.
#[derive(Clone, Copy, Debug)]
pub enum Integrator<'w> {
    /// Whitted's.
    Whitted(Whitted<'w>),
    /// A path tracer.
    Path(Path<'w>),
    /// Ambient occlusion.
    Ao(AmbientOcclusion<'w>),
}

impl<'w> Integrator<'w> {
    /// Over a world. Once `cancel` is set, no more rays are traced, and what comes out means nothing.
    pub fn new(world: &'w World, method: Method, settings: Settings, cancel: Option<&'w AtomicBool>) -> Self {
        match method {
            Method::Whitted => Integrator::Whitted(Whitted { world, settings, cancel }),
            Method::Path { clamp, color } => Integrator::Path(Path { world, settings, clamp, color, cancel }),
            Method::Ao { radius } => Integrator::Ao(AmbientOcclusion { world, radius }),
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
