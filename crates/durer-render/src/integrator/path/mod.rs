//! Path tracing with next-event estimation, multiple importance sampling and Russian roulette.
//!
//! A path is a loop over a `PathState`, as in pbrt and Mitsuba. Each bounce runs these stages. None
//! of them calls another bounce, so a wavefront can run each over an array of states:
//!
//! 1. `Path::propagate`: the ray travels to the next vertex, through media and past surfaces that
//!    have no effect.
//! 2. `Path::add_background`, `Path::add_emission`: light at the end of the ray, weighted
//!    against light sampling at the previous vertex.
//! 3. `Path::choose_light`, `Path::add_direct`: a point on a light, with its shadow ray.
//! 4. `Path::add_caustic`: light of photons.
//! 5. `Path::scatter`: a sampled direction, roulette, and the next ray. With an environment,
//!    the first glossy vertex follows several directions; they wait on the `PathStack`.
//!
//! The radiance of a camera ray is the sum of throughput · light over all terms, in the order in
//! which they are found.
//!
//! Sources: Kajiya, *The Rendering Equation*, SIGGRAPH 1986; Veach, *Robust Monte Carlo Methods for
//! Light Transport Simulation*, 1997, chapters 9 and 10.

use super::trace::{HitRecord, NodeId, RayKind, TermKind, TraceListener};
use super::{Integrate, WhittedOptions, one_by_one};
use crate::integrator::media::{Media, Passage};
use crate::world::{Hit, MAX_BATCH, Shading, SurfaceInteraction, World};
use durer_scene::bsdf::lobe::diffuse::Diffuse;
use durer_scene::bsdf::{Bsdf, Frame};
use durer_scene::camera::RayCone;
use durer_scene::math::{Color, Ray, Ray64, Vec3};
use durer_scene::sampler::SampleId;
use durer_scene::shape::Surface;
use durer_scene::spectrum::{Lanes, Spectrum};
use glam::DVec3;
pub use parameters::{Direct, PathOptions, PhotonParameters};
pub use photons::{DensityEstimate, PhotonMap, Photons};
use propagate::Event;
use radiance::Output;
use smallvec::SmallVec;
use state::{PathState, SampleContext};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use vertex::{DIRECTIONS, VertexKind};

/// Path tracer of one world.
#[derive(Clone, Debug)]
pub struct Path<'w> {
    /// Scene to render.
    pub world: &'w World,
    /// Maximum depth, and whether objects cast shadows.
    pub settings: WhittedOptions,
    /// Sampling of lights, colour mode, clamp.
    pub transport: PathOptions,
    /// Photons for caustics; without them, paths find caustics by chance.
    pub photons: Option<Arc<Photons>>,
    /// Footprint of a sample, if a texture is filtered by it.
    pub cone: Option<RayCone>,
    /// Once set, no more rays are traced and all results are meaningless.
    pub cancel: Option<&'w AtomicBool>,
}

/// Branches of a camera ray: the active one and the pending ones.
struct PathStack {
    active: PathState,
    /// Branches of the first vertex, the next one last.
    pending: SmallVec<[PathState; DIRECTIONS as usize]>,
}

impl Integrate for Path<'_> {
    fn radiance<T: TraceListener>(&self, ray: &Ray, id: SampleId, tally: &mut T) -> Color {
        let context = self.context(id);
        tally.lanes(&context.lanes);
        let node = tally.begin(NodeId::ROOT, || TermKind::Ray {
            from: RayKind::Camera,
            ray: ray.into(),
            weight: 1.0,
            hit: None,
            bounce: None,
        });
        let [one, zero] = [Spectrum::ONE, Spectrum::ZERO].map(|value| context.term(value));
        tally.end(node, one, one, zero);
        let mut state = PathState { node, ..self.start(ray.into(), id) };
        let hit = self.world.closest_along(&mut state.ray, tally);
        context.lanes.color(self.trace(state, hit, &context, tally))
    }

    /// First hits of camera rays are found together.
    fn radiances<T: TraceListener>(
        &self,
        rays: &[Ray64],
        begin: impl Fn(usize) -> SampleId,
        tally: &mut T,
        colors: &mut [Color],
    ) {
        if T::LISTENS || T::COUNTS_WORK {
            return one_by_one(self, rays, begin, tally, colors);
        }
        let mut found = [None; MAX_BATCH];
        for (part, (rays, colors)) in rays.chunks(MAX_BATCH).zip(colors.chunks_mut(MAX_BATCH)).enumerate() {
            self.world.closest_batch(rays, &mut found[..rays.len()]);
            for (i, (ray, color)) in rays.iter().zip(colors).enumerate() {
                tally.ray();
                let id = begin(part * MAX_BATCH + i);
                let context = self.context(id);
                *color = context.lanes.color(self.trace(self.start(*ray, id), found[i], &context, tally));
            }
        }
    }

    fn prepare(&self, sample: u32) {
        if let Some(photons) = &self.photons {
            photons.prepare(self, sample);
        }
    }
}

impl<'w> Path<'w> {
    /// Path tracer without photons that is never cancelled.
    pub fn new(world: &'w World, settings: WhittedOptions, transport: PathOptions) -> Self {
        Path { world, settings, transport, photons: None, cone: None, cancel: None }
    }

    /// Irradiance at a point, on the side of a unit normal, with the random numbers of a sample: pi
    /// times the radiance of a white matte surface.
    pub fn irradiance<T: TraceListener>(&self, point: DVec3, normal: Vec3, id: SampleId, tally: &mut T) -> Color {
        self.irradiance_on(&Surface::around(point, normal), normal, id, tally)
    }

    /// Irradiance at a surface point, on the side of a unit normal for shading. See
    /// [`Path::irradiance`].
    pub fn irradiance_on<T: TraceListener>(
        &self,
        surface: &Surface,
        normal: Vec3,
        id: SampleId,
        tally: &mut T,
    ) -> Color {
        let mut bsdf = Bsdf::default();
        bsdf.push(Diffuse::lambert(Spectrum::ONE), Spectrum::ONE, 1.0);
        let n_geo = if surface.n_geo.dot(normal) < 0.0 { -surface.n_geo } else { surface.n_geo };
        let shading = Shading { frame: Frame::around(normal), n_geo, wo: Vec3::Z, bsdf };
        let context = self.context(id);
        let nowhere = Ray64::new(surface.point(), Vec3::ZERO, 0.0, 0.0);
        let active = PathState { camera_distance: None, ..self.start(nowhere, id) };
        let mut stack = PathStack { active, pending: SmallVec::new() };
        let mut output = Output { radiance: Spectrum::ZERO, tally };
        let goes_on = self.shade(VertexKind::Surface(surface, &shading, None), &mut stack, &context, &mut output);
        if let Some(hit) = self.intersect_next(goes_on, &mut stack, output.tally) {
            self.follow(hit, stack, &context, &mut output);
        }
        std::f32::consts::PI * context.lanes.color(output.radiance)
    }

    /// State shared by the branches of a camera ray.
    fn context(&self, id: SampleId) -> SampleContext {
        match &self.photons {
            Some(photons) => {
                let map = photons.map(self, id.sample);
                SampleContext { lanes: *map.lanes(), photons: Some(map) }
            }
            None => SampleContext { lanes: Lanes::new(self.transport.color, id.wavelength()), photons: None },
        }
    }

    /// State of a path that starts along a ray from any point.
    fn start(&self, ray: Ray64, id: SampleId) -> PathState {
        let media = Media::around(self.world, ray.origin().as_vec3());
        PathState::new(ray, id, media)
    }

    /// Vertices of greater depth scatter no light.
    fn max_depth(&self) -> u32 {
        self.settings.bounces
    }

    /// Radiance along the ray of a state, by lane, from its first hit on.
    fn trace<T: TraceListener>(
        &self,
        active: PathState,
        hit: Option<Hit>,
        context: &SampleContext,
        tally: &mut T,
    ) -> Spectrum {
        let mut output = Output { radiance: Spectrum::ZERO, tally };
        self.follow(hit, PathStack { active, pending: SmallVec::new() }, context, &mut output);
        output.radiance
    }

    /// Follows all branches to their end, one bounce at a time, depth first.
    fn follow<T: TraceListener>(
        &self,
        hit: Option<Hit>,
        mut stack: PathStack,
        context: &SampleContext,
        output: &mut Output<T>,
    ) {
        let mut at = SurfaceInteraction::NOWHERE;
        let mut next = Some(hit);
        while let Some(hit) = next {
            let goes_on = self.bounce(hit, &mut at, &mut stack, context, output);
            next = self.intersect_next(goes_on, &mut stack, output.tally);
        }
    }

    /// First hit of the active ray, or of the next pending one if the active path has ended; `None`
    /// when all have ended.
    fn intersect_next<T: TraceListener>(
        &self,
        goes_on: bool,
        stack: &mut PathStack,
        tally: &mut T,
    ) -> Option<Option<Hit>> {
        if !goes_on {
            stack.active = stack.pending.pop()?;
        }
        Some(self.world.closest_along(&mut stack.active.ray, tally))
    }

    /// Runs one bounce: traces the ray to the next vertex, adds the light found there, and turns
    /// the active state into that of the next ray. Returns false when the active path has ended.
    fn bounce<T: TraceListener>(
        &self,
        hit: Option<Hit>,
        at: &mut SurfaceInteraction,
        stack: &mut PathStack,
        context: &SampleContext,
        output: &mut Output<T>,
    ) -> bool {
        let state = &mut stack.active;
        match self.propagate(hit, at, state, context, output.tally) {
            Event::Absorbed => false,
            Event::Escaped => {
                self.add_background(state, context, output);
                false
            }
            Event::Medium(point, dir, phase) => {
                self.shade(VertexKind::Medium(point, dir, phase), stack, context, output)
            }
            Event::Surface(passage) => {
                let shading = self.world.shading(at, passage.as_ref().map_or(1.0, Passage::eta), &context.lanes);
                output
                    .tally
                    .hit(state.node, || HitRecord::new(self.world, at, shading.frame.normal, at.inside(), false));
                self.add_emission(at, state, context, output);
                if shading.bsdf.is_black() {
                    return false;
                }
                self.select_hero(at, state, context, output.tally);
                state.prev_is_target = self.is_photon_target(at);
                let kind = VertexKind::Surface(&at.surface, &shading, passage.as_ref());
                self.shade(kind, stack, context, output)
            }
        }
    }

    /// Adds the light that reaches a vertex from lights and photons, and scatters the path. Returns
    /// false when the active path has ended.
    fn shade<T: TraceListener>(
        &self,
        kind: VertexKind<'_, 'w>,
        stack: &mut PathStack,
        context: &SampleContext,
        output: &mut Output<T>,
    ) -> bool {
        let state = &stack.active;
        if state.depth > self.max_depth() || self.is_cancelled() {
            return false;
        }
        let vertex = self.vertex(kind, state);
        let is_broad = kind.is_broad();
        // With many lights, the chosen one is rarely in the cache; the direction is sampled while
        // it is fetched.
        let light = if is_broad { self.choose_light(&vertex) } else { None };
        let sample = if vertex.directions == 1 { vertex.sample_bsdf() } else { None };
        if let Some(light) = light {
            self.add_direct(&light, &vertex, state, context, output);
        }
        if is_broad {
            self.add_caustic(&vertex, state, context, output);
        }
        self.scatter(&vertex, sample, stack, context, output.tally)
    }
}

mod caustic;
mod chance;
mod direct;
mod emission;
mod parameters;
mod photons;
mod propagate;
mod radiance;
mod scatter;
mod state;
#[cfg(test)]
mod tests;
mod vertex;
