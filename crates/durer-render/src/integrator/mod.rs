//! Integrators: how much light comes along a ray. One file each; the list is [`Method`].

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
pub use path::{Direct, Path, PhotonParameters, Photons, Transport};
use std::sync::atomic::AtomicBool;
pub use trace::{NodeId, TraceListener, TraceNode, TraceRecorder, Tree};
pub use whitted::{Settings, Whitted, WhittedParameters, refract};

/// What an integrator is told that it alone knows: a name and options, stated in a `described!`
/// block, which the command line walks.
pub trait Parameters: Describe + Copy {
    /// What does it.
    type Integrator<'w>: Integrate;

    /// Whether a ray's light depends on random numbers, so that a pixel needs many.
    const IS_RANDOM: bool = true;

    /// Whether the samples of some number are better taken all together: see
    /// [`Integrate::prepare`].
    const PREPARES: bool = false;

    /// The integrator.
    fn over(self, setup: Setup<'_>) -> Self::Integrator<'_>;

    /// How light is carried, if it is followed over any number of surfaces.
    fn transport(&self) -> Option<Transport> {
        None
    }
}

/// What every integrator knows.
#[derive(Clone, Copy, Debug)]
pub struct Setup<'w> {
    /// What is seen.
    pub world: &'w World,
    /// What light does.
    pub settings: Settings,
    /// How wide what a sample stands for is, if there are pixels.
    pub cone: Option<RayCone>,
    /// Decides random numbers that are no sample's.
    pub seed: u64,
    /// Once set, no more rays are traced, and what comes out means nothing.
    pub cancel: Option<&'w AtomicBool>,
}

/// What every integrator does.
pub trait Integrate {
    /// The light that comes along a camera ray, by the random numbers of a sample.
    fn radiance<T: TraceListener>(&self, ray: &Ray, id: SampleId, tally: &mut T) -> Color;

    /// The same for some camera rays that are neighbours, as it is for each: for those who can do
    /// better with several. `begin` hears the number of the ray that comes next, and gives the
    /// sample that it is of.
    fn radiances<T: TraceListener>(
        &self,
        rays: &[Ray64],
        begin: impl Fn(usize) -> SampleId,
        tally: &mut T,
        colors: &mut [Color],
    ) {
        one_by_one(self, rays, begin, tally, colors);
    }

    /// Makes what the samples of some number need, by all threads, before they are taken.
    fn prepare(&self, _sample: u32) {}
}

/// [`Integrate::radiances`] of an integrator that gains nothing from several.
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
        impl Method {
            /// How light is carried along paths, by methods that follow it over any number of
            /// surfaces.
            pub fn transport(self) -> Option<Transport> {
                match self { $(Method::$variant(it) => it.transport(),)+ }
            }

            /// Whether a ray's light depends on random numbers, so that a pixel needs many.
            pub fn is_random(self) -> bool {
                fn of<P: Parameters>(_: P) -> bool { P::IS_RANDOM }
                match self { $(Method::$variant(it) => of(it),)+ }
            }

            /// Whether the samples of some number are better taken all together.
            pub fn prepares(self) -> bool {
                fn of<P: Parameters>(_: P) -> bool { P::PREPARES }
                match self { $(Method::$variant(it) => of(it),)+ }
            }

            /// The integrator over a world.
            pub fn over(self, setup: Setup<'_>) -> Integrator<'_> {
                match self { $(Method::$variant(it) => Integrator::$variant(it.over(setup)),)+ }
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
            /// Which integrator makes a picture, with what it alone is told.
            Method: Parameters => delegate { $($variant($type),)+ }
        }

        /// One of the integrators, over a world.
        #[derive(Clone, Debug)]
        pub enum Integrator<'w> {
            $(#[doc = concat!("What `", stringify!($variant), "` asks for.")]
            $variant(<$type as Parameters>::Integrator<'w>),)+
        }
    };
}

integrators! {
    Whitted(whitted::WhittedParameters),
    Path(path::Transport),
    Photons(path::PhotonParameters),
    Ao(ao::AoParameters),
}

impl Copy for Method {}

impl Default for Method {
    fn default() -> Self {
        Method::WHITTED
    }
}

impl Method {
    /// Local light, mirrors and glass.
    pub const WHITTED: Method = Method::Whitted(WhittedParameters {});

    /// All light, as it is without wishes.
    pub const PATH: Method = Method::Path(Transport { clamp: None, color: ColorMode::Rgb, direct: Direct::Both });

    /// Its name.
    pub fn name(&self) -> &'static str {
        self.own_keyword()
    }
}
