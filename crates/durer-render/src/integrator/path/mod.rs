//! Path tracer with next-event estimation, multiple importance sampling and Russian roulette.
//!
//! As in pbrt and Mitsuba, a path is a loop over a `PathState`. Each bounce runs the stages listed
//! below. No stage calls another bounce, so a wavefront renderer could run each stage over an array
//! of states.
//!
//! 1. `Path::propagate` moves the ray to its next vertex, through media and past surfaces that have
//!    no effect.
//! 2. `Path::add_background` and `Path::add_emission` add the light at the end of the ray, with an
//!    MIS weight that accounts for light sampling at the previous vertex.
//! 3. `Path::choose_light` and `Path::add_direct` sample a point on a light and trace its shadow
//!    ray.
//! 4. `Path::add_caustic` adds the light of photons.
//! 5. `Path::scatter` samples a direction, applies Russian roulette and starts the next ray. If
//!    there is an environment, the first glossy vertex follows several directions, which wait on
//!    the `PathStack`.
//!
//! The radiance of a camera ray is the sum of throughput · light over all terms, added in the order
//! in which they are found.
//!
//! Sources: Kajiya, *The Rendering Equation*, SIGGRAPH 1986; Veach, *Robust Monte Carlo Methods for
//! Light Transport Simulation*, 1997, chapters 9 and 10.

use super::trace::{HitRecord, NodeId, RayKind, TermKind, TraceListener};
use super::{Integrate, RenderSettings, one_by_one};
use crate::integrator::media::{MediumStack, MediumTransition};
use crate::world::{Hit, MAX_BATCH, Shading, SurfaceInteraction, World};
use durer_scene::bsdf::lobe::diffuse::Diffuse;
use durer_scene::bsdf::{Bsdf, Frame};
use durer_scene::camera::RayCone;
use durer_scene::math::{Color, Ray, Ray64, Vec3};
use durer_scene::sampler::SampleId;
use durer_scene::shape::SurfacePoint;
use durer_scene::spectrum::{Lanes, Spectrum};
use glam::DVec3;
pub use parameters::{DirectSampling, PathOptions, PhotonParameters};
pub use photons::{DensityEstimate, PhotonMap, PhotonTracer};
use propagate::PathEvent;
use radiance::PathOutput;
use smallvec::SmallVec;
use state::{PathState, SampleContext};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use vertex::{SPLIT_DIRECTIONS, VertexKind};

/// Path tracing integrator for one world, with or without photons for caustics.
#[derive(Clone, Debug)]
pub struct Path<'w> {
    /// World to render.
    pub world: &'w World,
    /// Common settings: the maximum depth, and whether objects cast shadows.
    pub settings: RenderSettings,
    /// Options for path tracing: light sampling strategy, colour mode and clamp.
    pub options: PathOptions,
    /// Photon tracer for caustics. If `None`, paths find caustics only by chance.
    pub photons: Option<Arc<PhotonTracer>>,
    /// Footprint of a camera sample, or `None` if no texture is filtered.
    pub cone: Option<RayCone>,
    /// Cancellation flag. Once the flag is set, no more rays are traced, and results are
    /// meaningless.
    pub cancel: Option<&'w AtomicBool>,
}

/// Stack of the branches of one camera path, with the branch being traced and those that are still
/// to be traced.
struct PathStack {
    active: PathState,
    /// Branches that start at the first glossy vertex and are still to be traced, of which the last
    /// is traced next.
    pending: SmallVec<[PathState; SPLIT_DIRECTIONS as usize]>,
}

impl Integrate for Path<'_> {
    fn radiance<T: TraceListener>(&self, ray: &Ray, id: SampleId, listener: &mut T) -> Color {
        let context = self.context(id);
        listener.lanes(&context.lanes);
        let node = listener.begin(NodeId::ROOT, || TermKind::Ray {
            from: RayKind::Camera,
            ray: ray.into(),
            weight: 1.0,
            hit: None,
            bounce: None,
        });
        let [one, zero] = [Spectrum::ONE, Spectrum::ZERO].map(|value| context.term(value));
        listener.end(node, one, one, zero);
        let mut state = PathState { node, ..self.start(ray.into(), id) };
        let hit = self.world.closest_along(&mut state.ray, listener);
        context.lanes.color(self.trace(state, hit, &context, listener))
    }

    /// Traces a batch of camera rays. The first hits of all rays in the batch are computed
    /// together.
    fn radiances<T: TraceListener>(
        &self,
        rays: &[Ray64],
        begin: impl Fn(usize) -> SampleId,
        listener: &mut T,
        colors: &mut [Color],
    ) {
        if T::LISTENS || T::COUNTS_WORK {
            return one_by_one(self, rays, begin, listener, colors);
        }
        let (mut hits, size) = ([None; MAX_BATCH], self.world.batch_size());
        for (part, (rays, colors)) in rays.chunks(size).zip(colors.chunks_mut(size)).enumerate() {
            if self.is_cancelled() {
                return;
            }
            self.world.closest_batch(rays, &mut hits[..rays.len()]);
            for (i, (ray, color)) in rays.iter().zip(colors).enumerate() {
                listener.ray();
                let id = begin(part * size + i);
                let context = self.context(id);
                *color = context.lanes.color(self.trace(self.start(*ray, id), hits[i], &context, listener));
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
    /// Creates a path tracer without photons or cancellation.
    pub fn new(world: &'w World, settings: RenderSettings, options: PathOptions) -> Self {
        Path { world, settings, options, photons: None, cone: None, cancel: None }
    }

    /// Returns the irradiance at a point, on the side to which a unit normal points. It is pi times
    /// the radiance of a white matte surface there. `id` selects the random numbers.
    pub fn irradiance<T: TraceListener>(&self, point: DVec3, normal: Vec3, id: SampleId, listener: &mut T) -> Color {
        self.irradiance_on(&SurfacePoint::around(point, normal), normal, id, listener)
    }

    /// Returns the irradiance at a surface point, on the side to which a unit shading normal
    /// points. See [`Path::irradiance`].
    pub fn irradiance_on<T: TraceListener>(
        &self,
        surface: &SurfacePoint,
        normal: Vec3,
        id: SampleId,
        listener: &mut T,
    ) -> Color {
        let (shading, context) = (Self::white_matte(surface, normal), self.context(id));
        let mut stack = PathStack { active: self.start_at(surface, id), pending: SmallVec::new() };
        let mut output = PathOutput { radiance: Spectrum::ZERO, listener };
        let goes_on = self.shade(VertexKind::Surface(surface, &shading, None), &mut stack, &context, &mut output);
        if let Some(hit) = self.intersect_next(goes_on, &mut stack, output.listener) {
            self.trace_branches(hit, stack, &context, &mut output);
        }
        std::f32::consts::PI * context.lanes.color(output.radiance)
    }

    /// Returns the shading of a white matte surface with a unit shading normal.
    fn white_matte(surface: &SurfacePoint, normal: Vec3) -> Shading<'w> {
        let mut bsdf = Bsdf::default();
        bsdf.push(Diffuse::lambert(Spectrum::ONE), Spectrum::ONE, 1.0);
        let n_geo = if surface.n_geo.dot(normal) < 0.0 { -surface.n_geo } else { surface.n_geo };
        Shading { frame: Frame::around(normal), n_geo, wo: Vec3::Z, bsdf, shadowing: None }
    }

    /// Returns the state of a path that starts at a surface point instead of a camera.
    fn start_at(&self, surface: &SurfacePoint, id: SampleId) -> PathState {
        let nowhere = Ray64::new(surface.point(), Vec3::ZERO, 0.0, 0.0);
        PathState { camera_distance: None, ..self.start(nowhere, id) }
    }

    /// Returns the data that all branches of a camera path share.
    fn context(&self, id: SampleId) -> SampleContext {
        match &self.photons {
            Some(photons) => {
                let map = photons.map(self, id.sample);
                SampleContext { lanes: *map.lanes(), photons: Some(map) }
            }
            None => SampleContext { lanes: Lanes::new(self.options.color, id.wavelength()), photons: None },
        }
    }

    /// Returns the state of a path that starts with a ray from an arbitrary point.
    fn start(&self, ray: Ray64, id: SampleId) -> PathState {
        let media = MediumStack::around(self.world, ray.origin().as_vec3());
        PathState::new(ray, id, media)
    }

    /// Returns the maximum depth of vertices that scatter light.
    fn max_depth(&self) -> u32 {
        self.settings.bounces
    }

    /// Returns the radiance along the ray of a path state, by lane. `hit` is the first hit of that
    /// ray.
    fn trace<T: TraceListener>(
        &self,
        active: PathState,
        hit: Option<Hit>,
        context: &SampleContext,
        listener: &mut T,
    ) -> Spectrum {
        let mut output = PathOutput { radiance: Spectrum::ZERO, listener };
        self.trace_branches(hit, PathStack { active, pending: SmallVec::new() }, context, &mut output);
        output.radiance
    }

    /// Traces all branches to their ends, one bounce at a time, depth first.
    fn trace_branches<T: TraceListener>(
        &self,
        hit: Option<Hit>,
        mut stack: PathStack,
        context: &SampleContext,
        output: &mut PathOutput<T>,
    ) {
        let mut at = SurfaceInteraction::NOWHERE;
        let mut next = Some(hit);
        while let Some(hit) = next {
            let goes_on = self.bounce(hit, &mut at, &mut stack, context, output);
            next = self.intersect_next(goes_on, &mut stack, output.listener);
        }
    }

    /// Returns the first hit of the active branch's ray. If that branch has ended, the function
    /// continues with a pending branch, or returns `None` if there is none.
    fn intersect_next<T: TraceListener>(
        &self,
        goes_on: bool,
        stack: &mut PathStack,
        listener: &mut T,
    ) -> Option<Option<Hit>> {
        if !goes_on {
            stack.active = stack.pending.pop()?;
        }
        Some(self.world.closest_along(&mut stack.active.ray, listener))
    }

    /// Runs one bounce, which moves the ray to its next vertex, adds the light there, and turns the
    /// active state into the state of the next ray. Returns false if the active branch has ended.
    fn bounce<T: TraceListener>(
        &self,
        hit: Option<Hit>,
        at: &mut SurfaceInteraction,
        stack: &mut PathStack,
        context: &SampleContext,
        output: &mut PathOutput<T>,
    ) -> bool {
        let state = &mut stack.active;
        match self.propagate(hit, at, state, context, output.listener) {
            PathEvent::Absorbed => false,
            PathEvent::Escaped => {
                self.add_background(state, context, output);
                false
            }
            PathEvent::Medium(point, dir, phase) => {
                self.shade(VertexKind::Medium(point, dir, phase), stack, context, output)
            }
            PathEvent::Surface(transition) => {
                let shading =
                    self.world.shading(at, transition.as_ref().map_or(1.0, MediumTransition::eta), &context.lanes);
                output
                    .listener
                    .hit(state.node, || HitRecord::new(self.world, at, shading.frame.normal, at.inside(), false));
                self.add_emission(at, state, context, output);
                if shading.bsdf.is_black() {
                    return false;
                }
                self.select_hero(at, state, context, output.listener);
                state.prev_is_photon_target = self.is_photon_target(at);
                let kind = VertexKind::Surface(&at.surface, &shading, transition.as_ref());
                self.shade(kind, stack, context, output)
            }
        }
    }

    /// Adds the light that a vertex scatters from lights and photons, and continues the path.
    /// Returns false if the active branch has ended.
    fn shade<T: TraceListener>(
        &self,
        kind: VertexKind<'_, 'w>,
        stack: &mut PathStack,
        context: &SampleContext,
        output: &mut PathOutput<T>,
    ) -> bool {
        let state = &stack.active;
        if state.depth > self.max_depth() || self.is_cancelled() {
            return false;
        }
        let vertex = self.vertex(kind, state);
        let is_broad = kind.is_broad();
        // If there are many lights, the data of the chosen one is rarely in the CPU cache. Sample
        // the direction while that data is being fetched.
        let light = if is_broad { self.choose_light(&vertex) } else { None };
        let sample = if vertex.directions == 1 { vertex.sample_bsdf() } else { None };
        if let Some(light) = light {
            self.add_direct(&light, &vertex, state, context, output);
        }
        if is_broad {
            self.add_caustic(&vertex, state, context, output);
        }
        self.scatter(&vertex, sample, stack, context, output.listener)
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
