//! State of a path between two stages.

use super::PhotonMap;
use crate::integrator::media::Media;
use crate::integrator::trace::{NodeId, TermValue};
use crate::world::emitters::Receiver;
use durer_scene::math::Ray64;
use durer_scene::sampler::SampleId;
use durer_scene::spectrum::{Lanes, Spectrum};
use std::sync::Arc;

/// Pairs of random numbers of one vertex, by their purpose.
#[derive(Clone, Copy)]
pub(super) enum Dimension {
    /// x: lobe of the BSDF; y: light.
    Choices,
    /// Direction within the lobe.
    Direction,
    /// Point on the light.
    LightPoint,
    /// x: Russian roulette; y: choice among several candidate directions to the environment.
    Survival,
}

/// Pairs of random numbers per vertex.
pub(super) const DIMENSIONS: usize = 4;

/// Data shared by all branches of a camera ray.
pub(super) struct SampleContext {
    /// Meaning of the four lanes of a spectrum: RGB, or wavelengths.
    pub(super) lanes: Lanes,
    /// Photons of the sample; `None` for an integrator without photons.
    pub(super) photons: Option<Arc<PhotonMap>>,
}

impl SampleContext {
    /// Spectrum for the trace.
    pub(super) fn term(&self, light: Spectrum) -> TermValue {
        TermValue::of(&self.lanes, light)
    }
}

/// State of a path, or of one branch of it, between two stages.
///
/// Holds no references, so that states can be stored in an array. Only the list of media allocates,
/// if more than two objects overlap.
#[derive(Clone, Debug)]
pub(super) struct PathState {
    /// Ray to the next vertex; world space. Camera rays may have a direction of any length.
    pub(super) ray: Ray64,
    /// Product of BSDF · cosine / pdf, 1 / survival and transmittance since the camera, by lane.
    /// Dimensionless, at least 0. Roulette and media sample by it.
    pub(super) throughput: Spectrum,
    /// Fraction of the pixel that this branch represents, in (0, 1]: 1 / (number of branches).
    /// Separate from `throughput`, so that splitting does not make roulette end branches sooner.
    pub(super) share: f32,
    /// Number of scatterings since the camera, from 0; vertices deeper than `max_depth` scatter no
    /// light.
    pub(super) depth: u32,
    /// Source of the random numbers; each branch has its own.
    pub(super) sample: SampleId,
    /// Objects that contain the ray, by number; the last one fills the space.
    pub(super) media: Media,
    /// Last vertex with light sampling, for MIS with lights that the ray hits. `None` if no light
    /// sample competes: from the camera, and after delta lobes.
    pub(super) prev_vertex: Option<PrevVertex>,
    /// True if photons are sent to the last surface that scattered the path.
    pub(super) prev_is_target: bool,
    /// True after a bounce off a lobe with a density.
    pub(super) had_rough_bounce: bool,
    /// True if delta lobes follow a rough bounce: photons account for the lights that the path
    /// sees.
    pub(super) is_caustic: bool,
    /// True if dispersion has ended all wavelengths but the hero, lane 0.
    pub(super) monochromatic: bool,
    /// Length of the path from the camera in units of the world, at least 0, while only delta lobes
    /// scattered it; `None` after that.
    pub(super) camera_distance: Option<f32>,
    /// Parent node in the trace for the next terms.
    pub(super) node: NodeId,
}

/// Vertex at which lights were sampled, for later MIS. Source: Veach 1997, chapter 9.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrevVertex {
    /// Point and normal that lights were sampled for; world space.
    pub(super) receiver: Receiver,
    /// Density of the sampled direction per steradian, times the number of directions; above 0.
    pub(super) pdf: f32,
    /// Number of candidate directions to the environment; at least 1.
    pub(super) tries: f32,
}

impl PathState {
    /// Start of a path along a ray.
    pub(super) fn new(ray: Ray64, sample: SampleId, media: Media) -> Self {
        PathState {
            ray,
            throughput: Spectrum::ONE,
            share: 1.0,
            depth: 0,
            sample,
            media,
            prev_vertex: None,
            prev_is_target: false,
            had_rough_bounce: false,
            is_caustic: false,
            monochromatic: false,
            camera_distance: Some(0.0),
            node: NodeId::NONE,
        }
    }

    /// Random numbers of the next vertex; see [`Dimension`].
    pub(super) fn vertex_sample(&self) -> SampleId {
        self.sample.at(self.depth * DIMENSIONS as u32)
    }

    /// Branch `number` of `count` at a vertex that splits. Branches extend the pixel's sequence of
    /// samples, so that all of them together stay stratified.
    pub(super) fn branch(&self, number: u32, count: u32) -> Self {
        let sample = self.sample.of_sample(self.sample.sample.wrapping_mul(count).wrapping_add(number));
        PathState { sample, share: self.share / count as f32, ..self.clone() }
    }
}
