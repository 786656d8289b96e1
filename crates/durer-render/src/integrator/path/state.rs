//! State of a path between two stages of a bounce.

use super::PhotonMap;
use crate::integrator::media::MediumStack;
use crate::integrator::trace::{NodeId, TermValue};
use crate::world::emitters::Receiver;
use durer_scene::math::Ray64;
use durer_scene::sampler::SampleId;
use durer_scene::spectrum::{Lanes, Spectrum};
use std::sync::Arc;

/// Index of a pair of random numbers at a path vertex, named after the use of the pair.
#[derive(Clone, Copy)]
pub(super) enum Dimension {
    /// The x component selects the BSDF lobe, and y selects the light.
    Choices,
    /// Direction within the lobe.
    Direction,
    /// Point on the light.
    LightPoint,
    /// The x component is for Russian roulette, and y selects one of several candidate directions
    /// to the environment.
    Survival,
}

/// Number of pairs of random numbers at each vertex.
pub(super) const DIMENSIONS: usize = 4;

/// Data shared by all branches of a camera path, which is the meaning of the spectrum lanes and the
/// photon map.
pub(super) struct SampleContext {
    /// Meaning of the four lanes of a spectrum, which are RGB or wavelengths.
    pub(super) lanes: Lanes,
    /// Photon map of the sample; `None` without photon mapping.
    pub(super) photons: Option<Arc<PhotonMap>>,
}

impl SampleContext {
    /// Converts a spectrum to a value for the trace.
    pub(super) fn term(&self, light: Spectrum) -> TermValue {
        TermValue::of(&self.lanes, light)
    }
}

/// State of a path, or of one of its branches, between two stages of a bounce.
///
/// The state holds no references, so states can be stored in an array. Only the list of media
/// allocates memory, and only if more than two objects overlap.
#[derive(Clone, Debug)]
pub(super) struct PathState {
    /// Ray to the next vertex, in world space. The direction of a camera ray can have any length.
    pub(super) ray: Ray64,
    /// Product of BSDF · cosine / pdf, 1 / survival probability, and transmittance since the
    /// camera, by lane; at least 0. It affects Russian roulette and the sampling of media.
    pub(super) throughput: Spectrum,
    /// Product of the squared relative indices of refraction since the camera; greater than 0. The
    /// throughput times `squared_eta` is the fraction of light that is left: radiance is smaller in
    /// clear glass, but no light is lost there. It affects only Russian roulette.
    pub(super) squared_eta: f32,
    /// Share of the pixel that this branch represents, which is 1 / (number of branches). It is
    /// separate from `throughput` so that Russian roulette does not end branches sooner than paths
    /// that were not split.
    pub(super) pixel_share: f32,
    /// Number of scattering events since the camera. Vertices at a depth greater than `max_depth`
    /// scatter no light.
    pub(super) depth: u32,
    /// Random numbers of the path, which are different for each branch.
    pub(super) sample: SampleId,
    /// Objects that contain the ray. The last object fills the space around the ray.
    pub(super) media: MediumStack,
    /// Last vertex that sampled lights, needed for the MIS weights of lights hit by the ray. It is
    /// `None` if no light sample competes, which is the case for rays from the camera and after
    /// delta lobes.
    pub(super) prev_vertex: Option<PrevVertex>,
    /// True if photons are sent to the last surface that scattered the path.
    pub(super) prev_is_photon_target: bool,
    /// Number of scattering events from lobes that are not delta lobes.
    pub(super) rough_bounces: u32,
    /// True if delta lobes follow a rough bounce. In this case, photons account for the lights that
    /// the path hits.
    pub(super) is_caustic: bool,
    /// True after dispersion, when only the hero wavelength (in lane 0) is left.
    pub(super) monochromatic: bool,
    /// Length of the path from the camera, in world units. It is `None` after the first scattering
    /// from a lobe that is not a delta lobe.
    pub(super) camera_distance: Option<f32>,
    /// Trace node to which the next terms are added.
    pub(super) node: NodeId,
}

/// Vertex at which lights were sampled, kept for the MIS weights of lights hit by the next ray.
/// Source: Veach 1997, chapter 9.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrevVertex {
    /// Point and normal for which lights were sampled, in world space.
    pub(super) receiver: Receiver,
    /// Density of the sampled direction per steradian, multiplied by the number of directions;
    /// greater than 0.
    pub(super) pdf: f32,
    /// Number of candidate directions to the environment; at least 1.
    pub(super) tries: f32,
}

impl PathState {
    /// Creates the state at the start of a path.
    pub(super) fn new(ray: Ray64, sample: SampleId, media: MediumStack) -> Self {
        PathState {
            ray,
            throughput: Spectrum::ONE,
            squared_eta: 1.0,
            pixel_share: 1.0,
            depth: 0,
            sample,
            media,
            prev_vertex: None,
            prev_is_photon_target: false,
            rough_bounces: 0,
            is_caustic: false,
            monochromatic: false,
            camera_distance: Some(0.0),
            node: NodeId::NONE,
        }
    }

    /// Returns the random numbers for the next vertex; see [`Dimension`].
    pub(super) fn vertex_sample(&self) -> SampleId {
        self.sample.with_first_dimension(self.depth * DIMENSIONS as u32)
    }

    /// Returns branch `number` of `count` at a vertex that splits. The branches continue the
    /// pixel's sample sequence, so that all of them are stratified together.
    pub(super) fn branch(&self, number: u32, count: u32) -> Self {
        let sample = self.sample.with_sample(self.sample.sample.wrapping_mul(count).wrapping_add(number));
        PathState { sample, pixel_share: self.pixel_share / count as f32, ..self.clone() }
    }
}
