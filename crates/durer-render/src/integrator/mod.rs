//! Integrators: estimators of the radiance along a ray. One file each; the list is
//! [`IntegratorKind`].

pub mod ao;
pub mod media;
pub mod path;
pub mod spawn;
pub mod trace;
pub mod whitted;

use crate::world::World;
pub use ao::{AmbientOcclusion, AoParameters};
use durer_scene::camera::RayCone;
use durer_scene::describe::{Describe, DescribedList, described_list};
use durer_scene::math::{Color, Ray, Ray64};
use durer_scene::sampler::SampleId;
use durer_scene::spectrum::ColorMode;
pub use path::{Direct, Path, PathOptions, PhotonParameters, Photons};
use std::sync::atomic::AtomicBool;
pub use trace::{NodeId, TraceListener, TraceNode, TraceRecorder, Tree};
pub use whitted::{Whitted, WhittedOptions, WhittedParameters, refract};

/// Parameters of an integrator: a name and options, stated in a `described!` block. The command
/// line derives its options from it.
pub trait Parameters: Describe + Copy {
    /// The integrator type.
    type Integrator<'w>: Integrate;

    /// True if the radiance depends on random numbers, so that a pixel needs many samples.
    const IS_RANDOM: bool = true;

    /// True if the integrator prepares samples in advance: see [`Integrate::prepare`].
    const PREPARES: bool = false;

    /// Creates the integrator.
    fn over(self, setup: IntegratorContext<'_>) -> Self::Integrator<'_>;

    /// Returns the path tracing options, if the method traces paths.
    fn transport(&self) -> Option<PathOptions> {
        None
    }
}

/// Data for every integrator.
#[derive(Clone, Copy, Debug)]
pub struct IntegratorContext<'w> {
    /// The world.
    pub world: &'w World,
    /// Common settings.
    pub settings: WhittedOptions,
    /// Footprint of a sample, if there are pixels.
    pub cone: Option<RayCone>,
    /// Seed of random numbers that do not belong to a sample.
    pub seed: u64,
    /// Once set, no more rays are traced, and results are meaningless.
    pub cancel: Option<&'w AtomicBool>,
}

/// Interface of integrators.
pub trait Integrate {
    /// Returns the radiance along a camera ray, with the random numbers of a sample.
    fn radiance<T: TraceListener>(&self, ray: &Ray, id: SampleId, tally: &mut T) -> Color;

    /// Computes the radiance of neighbouring camera rays, with the same results as tracing them one
    /// by one. `begin` is called with the index of the next ray and returns its sample.
    fn radiances<T: TraceListener>(
        &self,
        rays: &[Ray64],
        begin: impl Fn(usize) -> SampleId,
        tally: &mut T,
        colors: &mut [Color],
    ) {
        one_by_one(self, rays, begin, tally, colors);
    }

    /// Prepares the samples with a given index, on all threads, before they are taken.
    fn prepare(&self, _sample: u32) {}
}

/// [`Integrate::radiances`] for integrators that do not benefit from batches.
fn one_by_one<T: TraceListener>(
    integrator: &(impl Integrate + ?Sized),
    rays: &[Ray64],
    begin: impl Fn(usize) -> SampleId,
    tally: &mut T,
    colors: &mut [Color],
) {
    for (i, (ray, color)) in rays.iter().zip(colors).enumerate() {
        *color = integrator.radiance(&ray.rounded, begin(i), tally);
    }
}

macro_rules! delegate {
    ($($variant:ident),+) => {
        impl IntegratorKind {
            /// Returns the path tracing options, if the method traces paths.
            pub fn transport(self) -> Option<PathOptions> {
                match self { $(IntegratorKind::$variant(it) => it.transport(),)+ }
            }

            /// Returns true if the radiance depends on random numbers.
            pub fn is_random(self) -> bool {
                fn of<P: Parameters>(_: P) -> bool { P::IS_RANDOM }
                match self { $(IntegratorKind::$variant(it) => of(it),)+ }
            }

            /// Returns true if the method prepares samples in advance.
            pub fn prepares(self) -> bool {
                fn of<P: Parameters>(_: P) -> bool { P::PREPARES }
                match self { $(IntegratorKind::$variant(it) => of(it),)+ }
            }

            /// Creates the integrator of a world.
            pub fn over(self, setup: IntegratorContext<'_>) -> Integrator<'_> {
                match self { $(IntegratorKind::$variant(it) => Integrator::$variant(it.over(setup)),)+ }
            }
        }

        impl Integrate for Integrator<'_> {
            fn radiance<T: TraceListener>(&self, ray: &Ray, id: SampleId, tally: &mut T) -> Color {
                match self { $(Integrator::$variant(it) => Integrate::radiance(it, ray, id, tally),)+ }
            }
            fn radiances<T: TraceListener>(
                &self,
                rays: &[Ray64],
                begin: impl Fn(usize) -> SampleId,
                tally: &mut T,
                colors: &mut [Color],
            ) {
                match self { $(Integrator::$variant(it) => it.radiances(rays, begin, tally, colors),)+ }
            }
            fn prepare(&self, sample: u32) {
                match self { $(Integrator::$variant(it) => it.prepare(sample),)+ }
            }
        }
    };
}

macro_rules! integrators {
    ($($variant:ident($type:ty),)+) => {
        described_list! {
            /// Integrator of a picture, with its own options.
            IntegratorKind: Parameters => delegate { $($variant($type),)+ }
        }

        /// Integrator for a world.
        #[derive(Clone, Debug)]
        pub enum Integrator<'w> {
            $(#[doc = concat!("Integrator of `", stringify!($variant), "`.")]
            $variant(<$type as Parameters>::Integrator<'w>),)+
        }
    };
}

integrators! {
    Whitted(whitted::WhittedParameters),
    Path(path::PathOptions),
    Photons(path::PhotonParameters),
    Ao(ao::AoParameters),
}

impl Copy for IntegratorKind {}

impl Default for IntegratorKind {
    fn default() -> Self {
        IntegratorKind::WHITTED
    }
}

impl IntegratorKind {
    /// Direct lighting, mirrors and glass.
    pub const WHITTED: IntegratorKind = IntegratorKind::Whitted(WhittedParameters {});

    /// Path tracing with default options.
    pub const PATH: IntegratorKind =
        IntegratorKind::Path(PathOptions { clamp: None, color: ColorMode::Rgb, direct: Direct::Both });

    /// Returns the method's name.
    pub fn name(&self) -> &'static str {
        self.own_keyword()
    }
}
