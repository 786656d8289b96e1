//! Integrators, which estimate the radiance along camera rays by Whitted ray tracing, path tracing,
//! photon mapping or ambient occlusion. All integrators are listed in [`IntegratorKind`].

pub mod ao;
pub mod media;
pub mod path;
pub mod separate_terms;
pub mod spawn;
pub mod trace;
pub mod whitted;

use crate::world::World;
pub use ao::{AmbientOcclusion, AoParameters};
use durer_scene::camera::RayCone;
use durer_scene::describe::{Describe, DescribedKind, described_list};
use durer_scene::math::{Color, Ray, Ray64};
use durer_scene::sampler::SampleId;
use durer_scene::spectrum::ColorMode;
pub use path::{DirectSampling, Path, PathOptions, PhotonParameters, PhotonTracer};
use std::sync::atomic::AtomicBool;
pub use trace::{NodeId, TraceListener, TraceNode, TraceRecorder, Tree};
pub use whitted::{RenderSettings, Whitted, WhittedParameters, refract};

/// Options of one kind of integrator, from which the integrator is created for a world. The command
/// line gets the integrator's name and its options from [`Describe`].
pub trait IntegratorOptions: Describe + Copy {
    /// Integrator that these options create.
    type Integrator<'w>: Integrate;

    /// True if the radiance depends on random numbers, so that each pixel needs many samples.
    const IS_STOCHASTIC: bool = true;

    /// True if the integrator has work to do before the samples of a pass are taken; see
    /// [`Integrate::prepare`].
    const PREPARES: bool = false;

    /// Creates the integrator for a world.
    fn create(self, context: IntegratorContext<'_>) -> Self::Integrator<'_>;

    /// Returns the path tracing options, or `None` if the integrator does not trace paths.
    fn path_options(&self) -> Option<PathOptions> {
        None
    }
}

/// World and common settings from which every integrator is created.
#[derive(Clone, Copy, Debug)]
pub struct IntegratorContext<'w> {
    /// World to render.
    pub world: &'w World,
    /// Settings common to all integrators, such as the maximum depth.
    pub settings: RenderSettings,
    /// Footprint of a camera sample, for texture filtering. It is `None` if there are no pixels.
    pub cone: Option<RayCone>,
    /// Seed for random numbers that do not belong to a sample, such as those of photons.
    pub seed: u64,
    /// Cancellation flag. Once the flag is set, no more rays are traced, and results are
    /// meaningless.
    pub cancel: Option<&'w AtomicBool>,
}

/// Integrator, which computes the radiance along camera rays.
pub trait Integrate {
    /// Returns the radiance along a camera ray. `id` selects the random numbers.
    fn radiance<T: TraceListener>(&self, ray: &Ray, id: SampleId, listener: &mut T) -> Color;

    /// Computes the radiance of a batch of neighbouring camera rays. The results are the same as if
    /// the rays were traced one at a time. Before a ray is shaded, `begin` is called with its index
    /// and returns its sample.
    fn radiances<T: TraceListener>(
        &self,
        rays: &[Ray64],
        begin: impl Fn(usize) -> SampleId,
        listener: &mut T,
        colors: &mut [Color],
    ) {
        one_by_one(self, rays, begin, listener, colors);
    }

    /// Prepares all samples with the given index before they are taken, using all threads.
    fn prepare(&self, _sample: u32) {}
}

/// Implements [`Integrate::radiances`] for integrators that gain nothing from batches.
fn one_by_one<T: TraceListener>(
    integrator: &(impl Integrate + ?Sized),
    rays: &[Ray64],
    begin: impl Fn(usize) -> SampleId,
    listener: &mut T,
    colors: &mut [Color],
) {
    for (i, (ray, color)) in rays.iter().zip(colors).enumerate() {
        *color = integrator.radiance(&ray.rounded, begin(i), listener);
    }
}

macro_rules! delegate {
    ($($variant:ident),+) => {
        impl IntegratorKind {
            /// Returns the path tracing options, or `None` if the integrator does not trace paths.
            pub fn path_options(self) -> Option<PathOptions> {
                match self { $(IntegratorKind::$variant(it) => it.path_options(),)+ }
            }

            /// Returns true if the radiance depends on random numbers.
            pub fn is_stochastic(self) -> bool {
                fn of<P: IntegratorOptions>(_: P) -> bool { P::IS_STOCHASTIC }
                match self { $(IntegratorKind::$variant(it) => of(it),)+ }
            }

            /// Returns true if the integrator has work to do before the samples of a pass are
            /// taken.
            pub fn prepares(self) -> bool {
                fn of<P: IntegratorOptions>(_: P) -> bool { P::PREPARES }
                match self { $(IntegratorKind::$variant(it) => of(it),)+ }
            }

            /// Creates the integrator for a world.
            pub fn create(self, context: IntegratorContext<'_>) -> Integrator<'_> {
                match self { $(IntegratorKind::$variant(it) => Integrator::$variant(it.create(context)),)+ }
            }
        }

        impl Integrate for Integrator<'_> {
            fn radiance<T: TraceListener>(&self, ray: &Ray, id: SampleId, listener: &mut T) -> Color {
                match self { $(Integrator::$variant(it) => Integrate::radiance(it, ray, id, listener),)+ }
            }
            fn radiances<T: TraceListener>(
                &self,
                rays: &[Ray64],
                begin: impl Fn(usize) -> SampleId,
                listener: &mut T,
                colors: &mut [Color],
            ) {
                match self { $(Integrator::$variant(it) => it.radiances(rays, begin, listener, colors),)+ }
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
            /// Kind of integrator that renders a picture, with its own options.
            IntegratorKind: IntegratorOptions => delegate { $($variant($type),)+ }
        }

        /// Integrator for one world, of any kind.
        #[derive(Clone, Debug)]
        pub enum Integrator<'w> {
            $(#[doc = concat!("Integrator for `", stringify!($variant), "`.")]
            $variant(<$type as IntegratorOptions>::Integrator<'w>),)+
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
    /// Whitted ray tracing: direct lighting, mirrors and glass.
    pub const WHITTED: IntegratorKind = IntegratorKind::Whitted(WhittedParameters {});

    /// Path tracing with default options.
    pub const PATH: IntegratorKind =
        IntegratorKind::Path(PathOptions { clamp: None, color: ColorMode::Rgb, direct: DirectSampling::Both });

    /// Returns the integrator's name on the command line.
    pub fn name(&self) -> &'static str {
        self.own_keyword()
    }
}
