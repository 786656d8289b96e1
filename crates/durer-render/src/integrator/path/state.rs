//! State of a path between two stages.

use super::PhotonMap;
use crate::integrator::media::Media;
use crate::integrator::trace::{NodeId, TermValue};
use crate::world::emitters::Receiver;
use durer_scene::math::Ray64;
use durer_scene::sampler::SampleId;
use durer_scene::spectrum::{Lanes, Spectrum};
use std::sync::Arc;

/// Random numbers of one vertex, by what they decide: pairs of a sample's dimensions.
#[derive(Clone, Copy)]
pub(super) enum Dimension {
    /// x: lobe of the BSDF; y: light.
    Choices,
    /// Direction within the lobe.
    Direction,
    /// Point on the light.
    LightPoint,
    /// x: Russian roulette; y: one of several tried directions to the environment.
    Survival,
}

/// Pairs of random numbers that a vertex takes.
pub(super) const DIMENSIONS: usize = 4;

/// What all branches of a camera ray share.
pub(super) struct SampleContext {
    /// What the four lanes of a spectrum are: RGB, or wavelengths.
    pub(super) lanes: Lanes,
    /// Photons of the sample; `None` for an integrator without photons.
    pub(super) photons: Option<Arc<PhotonMap>>,
}

impl SampleContext {
    /// Spectrum as the trace has it.
    pub(super) fn term(&self, light: Spectrum) -> TermValue {
        TermValue::of(&self.lanes, light)
    }
}

/// State of a path, or of one branch of it, between two stages.
///
/// Holds no references, so that states can lie in an array; only the list of media goes to the heap
/// when more than two objects overlap.
#[derive(Clone, Debug)]
pub(super) struct PathState {
    /// Ray to the next vertex; world space. Camera rays may have a direction of any length.
    pub(super) ray: Ray64,
    /// Product of BSDF · cosine / pdf, 1 / survival and transmittance since the camera, by lane.
    /// Dimensionless, at least 0. Roulette and media sample by it.
    pub(super) throughput: Spectrum,
    /// Fraction of the pixel that this branch stands for, in (0, 1]: 1 / (number of branches). It is
    /// not part of `throughput`, since roulette must not end branches sooner for being several.
    pub(super) share: f32,
    /// Number of scatterings since the camera, from 0; vertices deeper than `max_depth` scatter no
    /// light.
    pub(super) depth: u32,
    /// Sample whose random numbers decide; one for each branch.
    pub(super) sample: SampleId,
    /// Objects that the ray runs in, by number; the last one fills the place.
    pub(super) media: Media,
    /// Last vertex at which lights were sampled too, for MIS with light that the ray hits. `None`
    /// where no light sample competes: from the camera, and after delta lobes.
    pub(super) prev_vertex: Option<PrevVertex>,
    /// Whether photons are sent to the surface that scattered the path last.
    pub(super) prev_is_target: bool,
    /// Whether a lobe with a density has scattered the path since the camera.
    pub(super) had_rough_bounce: bool,
    /// Whether delta lobes follow a rough bounce: photons account for lights that are seen so.
    pub(super) is_caustic: bool,
    /// Whether dispersion has ended all wavelengths but the hero, lane 0.
    pub(super) monochromatic: bool,
    /// Length of the path from the camera in units of the world, at least 0, as long as only delta
    /// lobes scattered it; `None` after that.
    pub(super) camera_distance: Option<f32>,
    /// Node of the trace that terms found next belong to.
    pub(super) node: NodeId,
}

/// Vertex at which lights were sampled, as MIS needs it later. Source: Veach 1997, chapter 9.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrevVertex {
    /// Point and normal that lights were sampled for; world space.
    pub(super) receiver: Receiver,
    /// Density of the sampled direction per steradian, times the number of directions; above 0.
    pub(super) pdf: f32,
    /// Number of directions to the environment that were tried for one that was taken; at least 1.
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

    /// Branch `number` of `count` at a vertex that splits. Branches extend the sequence of the
    /// pixel's samples, so that all of them together stay stratified.
    pub(super) fn branch(&self, number: u32, count: u32) -> Self {
        let sample = self.sample.of_sample(self.sample.sample.wrapping_mul(count).wrapping_add(number));
        PathState { sample, share: self.share / count as f32, ..self.clone() }
    }
}
