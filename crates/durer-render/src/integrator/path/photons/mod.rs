//! Photon mapping for caustics, which is light that mirrors and glass focus on other objects.
//!
//! Paths from the camera find such light rarely or never. Therefore, photons are sent from the
//! lights to all objects that mirror or refract light. Each photon is followed over delta lobes and
//! stored on the first surface with another kind of lobe, or where a medium scatters it. The light
//! at a point is then estimated from the density of the photons. Each sample of a pixel traces new
//! photons and uses a smaller radius than the sample before, so the mean over all samples converges
//! to the true value.
//!
//! Sources: Hachisuka and Jensen, *Stochastic Progressive Photon Mapping*, 2009; Knaus and Zwicker,
//! *Progressive Photon Mapping: A Probabilistic Approach*, 2011, for radii that do not depend on
//! pixel statistics; Jensen and Christensen, *Efficient Simulation of Light Transport in Scenes
//! with Participating Media using Photon Maps*, 1998, for media.

use super::Path;
use super::propagate::PathEvent;
use super::state::{DIMENSIONS, PathState, SampleContext};
use super::vertex::VertexKind;
use crate::integrator::media::MediumTransition;
use crate::world::emitters::LightId;
use crate::world::emitters::emission::PhotonEmitter;
use crate::world::{SurfaceInteraction, World};
use durer_scene::math::Color;
use durer_scene::sampler::SampleId;
use durer_scene::spectrum::{Lanes, Spectrum};
use map::{Absorber, Photon, PhotonGrid};
pub use map::{DensityEstimate, PhotonMap};
use rayon::prelude::*;
use std::collections::VecDeque;
use std::f32::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

/// Fraction of a new sample's photons that remain within the shrinking radius. The error decreases
/// fastest at 2/3; source: Kaplanyan and Dachsbacher, *Adaptive Progressive Photon Mapping*, 2013.
const ALPHA: f64 = 2.0 / 3.0;

/// Maximum number of cached photon maps.
const MAX_CACHED: usize = 32;

/// Photon tracer of a render, which builds one photon map per sample index on demand and caches it.
#[derive(Debug)]
pub struct PhotonTracer {
    beams: PhotonEmitter,
    seed: u64,
    count: u32,
    /// Search radius of the first sample, in world units.
    radius: f32,
    /// True if the estimate's bias is removed to second order.
    corrected: bool,
    cache: Mutex<MapCache>,
}

/// Cached photon maps with their sample indices, oldest first.
type MapCache = VecDeque<(u32, Arc<PhotonMap>)>;

/// Number of pairs of random numbers used to emit a photon.
const FIRST_DIMENSION: u32 = 3;

/// Ratio of the search radius in media, where photons are sparser, to the search radius on
/// surfaces.
const MEDIUM_RADIUS: f32 = 3.0;

impl PhotonTracer {
    /// Creates a photon tracer with `count` photons per sample. `radius` is the search radius of
    /// the first sample, in world units; its default depends on the smallest object to which
    /// photons are sent.
    pub fn new(world: &World, seed: u64, count: u32, radius: Option<f32>) -> Self {
        let beams = PhotonEmitter::new(world);
        let usual = 0.05 * beams.min_target_radius();
        let radius = radius.unwrap_or(if usual.is_finite() { usual } else { 1.0 });
        PhotonTracer { beams, seed, count, radius, corrected: false, cache: Mutex::default() }
    }

    /// Removes the bias of the estimates to second order in the radius, which increases noise. The
    /// difference from the uncorrected light is an estimate of the bias.
    pub fn corrected(self) -> Self {
        PhotonTracer { corrected: true, ..self }
    }

    /// Returns true if photons are sent to an object.
    pub(super) fn reaches(&self, object: u32) -> bool {
        self.beams.reaches(object)
    }

    /// Returns the search radius of a sample, where r_(i+1)^2 = r_i^2 (i + alpha) / (i + 1).
    fn radius(&self, sample: u32) -> f32 {
        let square = (1..=sample).map(f64::from).fold(1.0, |square, i| square * (i + ALPHA) / (i + 1.0));
        self.radius * square.sqrt() as f32
    }

    /// Returns the photon map of a sample, which is built if it is not cached.
    pub(super) fn map(&self, path: &Path, sample: u32) -> Arc<PhotonMap> {
        let mut cache = self.cache.lock().unwrap_or_else(PoisonError::into_inner);
        // A single thread builds the map. In a parallel job, a thread could steal work that waits
        // for the lock.
        Self::find(&cache, sample).unwrap_or_else(|| Self::keep(&mut cache, sample, self.make(path, sample, false)))
    }

    /// Builds the photon map of a sample in advance, using all threads.
    pub fn prepare(&self, path: &Path, sample: u32) {
        let lock = || self.cache.lock().unwrap_or_else(PoisonError::into_inner);
        if Self::find(&lock(), sample).is_none() {
            let map = self.make(path, sample, true);
            Self::keep(&mut lock(), sample, map);
        }
    }

    /// Returns the photon map of a sample if it is cached.
    fn find(cache: &MapCache, sample: u32) -> Option<Arc<PhotonMap>> {
        cache.iter().find(|(number, _)| *number == sample).map(|(_, map)| map.clone())
    }

    /// Caches a photon map, and removes the oldest one if there are too many.
    fn keep(cache: &mut MapCache, sample: u32, map: PhotonMap) -> Arc<PhotonMap> {
        let map = Arc::new(map);
        cache.push_back((sample, map.clone()));
        if cache.len() > MAX_CACHED {
            cache.pop_front();
        }
        map
    }

    /// Traces the photons of a sample and builds their map.
    fn make(&self, path: &Path, sample: u32, parallel: bool) -> PhotonMap {
        // The photons have the same wavelengths as the paths of the sample.
        let lanes = Lanes::new(path.options.color, SampleId::new(self.seed, (0, 0), sample).wavelength());
        let one = |number: u32| self.trace(path, sample, number, lanes);
        let photons: Vec<Photon> = match parallel {
            true => (0..self.count).into_par_iter().flat_map_iter(one).collect(),
            false => (0..self.count).flat_map(one).collect(),
        };
        let (surfaces, media): (Vec<_>, Vec<_>) =
            photons.into_iter().partition(|photon| photon.absorber == Absorber::Surface);
        let radius = self.radius(sample);
        PhotonMap {
            lanes,
            on_surfaces: PhotonGrid::new(&surfaces, radius, self.corrected),
            in_media: PhotonGrid::new(&media, MEDIUM_RADIUS * radius, self.corrected),
        }
    }

    /// Traces one photon until it is absorbed. Returns `None` if the photon is not stored.
    fn trace(&self, path: &Path, pass: u32, number: u32, lanes: Lanes) -> Option<Photon> {
        // The photons of a sample are stratified over lights and directions.
        let id = SampleId::new(self.seed ^ OTHER_SEED, (pass, 0), number);
        let [light, point, direction] = [0, 1, 2].map(|dimension| id.pair(dimension));
        let emitted = self.beams.emit(path.world, light, point, direction)?;
        let power = emitted.power / self.count as f32;
        let context = SampleContext { lanes, photons: None };
        let mut state = path.start(emitted.ray, id);
        let mut at = SurfaceInteraction::NOWHERE;
        let mut is_first = true;
        loop {
            let hit = path.world.closest_along(&mut state.ray, &mut ());
            let event = path.propagate(hit, &mut at, &mut state, &context, &mut ());
            // Light that a medium scatters before any delta lobe is already found by paths.
            if let PathEvent::Medium(point, dir, _) = event
                && !is_first
            {
                let object = state.media.object();
                let scattering = path.world.medium(object)?.scattering(point, &lanes);
                let power =
                    Spectrum::select(scattering.cmpgt(Spectrum::ZERO), state.throughput / scattering, Spectrum::ZERO);
                return Photon::new(point.as_vec3(), -dir, power, state.depth, Absorber::Medium(object));
            }
            let PathEvent::Surface(transition) = event else { return None };
            if is_first {
                // Light that reaches other objects is already found by light sampling.
                if !self.beams.reaches(at.hit.object) {
                    return None;
                }
                // The intensity of a light with a position can be computed only for a given point,
                // which here is the hit point.
                let color = match emitted.light {
                    Some(light) => {
                        let light_sample = path.world.illuminate(light as usize, at.surface.point());
                        PI * light_sample.color * light_sample.distance * light_sample.distance
                    }
                    None => Color::ONE,
                };
                let of_light = || emitted.light.and_then(|light| path.world.illuminant(LightId::Light(light)));
                let of_material = || emitted.material.and_then(|material| path.world.material_illuminant(material));
                state.throughput *= lanes.light_of(power * color, || of_light().or_else(of_material));
            }
            let eta = transition.as_ref().map_or(1.0, MediumTransition::eta);
            let shading = path.world.shading(&at, eta, &lanes);
            path.select_hero(&at, &mut state, &context, &mut ());
            // Black surfaces reflect nothing, but the irradiance on them can be measured.
            if !is_first && (shading.bsdf.has_non_delta() || shading.bsdf.is_black()) {
                let wi = -state.ray.dir().normalize();
                return Photon::new(at.surface.position, wi, state.throughput, state.depth, Absorber::Surface);
            }
            let vertex = VertexKind::Surface(&at.surface, &shading, transition.as_ref());
            let numbers = id.with_first_dimension(FIRST_DIMENSION + state.depth * DIMENSIONS as u32);
            let sample = vertex.sample(numbers.pair(0).x, numbers.pair(1))?;
            if sample.pdf != 0.0 || state.depth > path.max_depth() {
                return None;
            }
            // Radiance scales with the square of the index of refraction, but power does not.
            let weight = sample.weight * vertex.squared_eta(&sample);
            let survival = (state.throughput * weight).max_element() / state.throughput.max_element();
            let survival = survival.clamp(0.0, 1.0);
            if numbers.pair(2).x >= survival || survival.is_nan() {
                return None;
            }
            state = PathState {
                throughput: state.throughput * weight / survival,
                depth: state.depth + 1,
                monochromatic: state.monochromatic,
                ..PathState::new(
                    vertex.spawn(sample.wi),
                    state.sample,
                    vertex.media_behind(sample.wi).cloned().unwrap_or(state.media),
                )
            };
            is_first = false;
        }
    }
}

/// Seed that makes the random numbers of photons different from those of paths.
const OTHER_SEED: u64 = 0x7068_6f74_6f6e_7321;

mod map;
