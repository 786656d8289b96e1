//! Propagation of a path's ray to its next vertex, through media and past surfaces that have no
//! effect.

use super::Path;
use super::state::{PathState, SampleContext};
use crate::integrator::media::{MediumStack, MediumTransition};
use crate::integrator::trace::TraceListener;
use crate::world::{Hit, PassedSurfaces, SurfaceInteraction};
use durer_scene::math::{Ray64, Vec3, gamma};
use durer_scene::medium::{DistanceSample, HenyeyGreenstein, Segment};
use durer_scene::spectrum::{Lanes, Spectrum};
use glam::DVec3;
use std::sync::atomic::Ordering::Relaxed;

/// Next event along a path's ray, which is a surface hit, scattering in a medium, or the end of the
/// path.
pub(super) enum PathEvent {
    /// The path ended inside a medium, either by Russian roulette or after scattering too often.
    Absorbed,
    /// The ray left the scene.
    Escaped,
    /// The ray was scattered at a point in an open medium, in which lights are visible. The vector
    /// is the unit direction of the ray.
    Medium(DVec3, Vec3, HenyeyGreenstein),
    /// The ray hit a surface. The transition is `None` if light cannot enter or leave the object at
    /// that point.
    Surface(Option<MediumTransition>),
}

/// Maximum number of scattering events inside one object before the path ends.
const MAX_WALK: u32 = 10_000;

impl Path<'_> {
    /// Follows the ray of a path state from its first hit to the next vertex. The ray, throughput,
    /// media and camera distance of the state are updated. The surface that was hit is written to
    /// `at`, which is reused because copies are slow.
    pub(super) fn propagate<T: TraceListener>(
        &self,
        hit: Option<Hit>,
        at: &mut SurfaceInteraction,
        state: &mut PathState,
        context: &SampleContext,
        listener: &mut T,
    ) -> PathEvent {
        let (event, transmittance) = self.propagate_inner(hit, at, state, context, listener);
        listener.weigh(state.node, context.term(transmittance), context.term(state.throughput * state.pixel_share));
        event
    }

    /// Implements [`Path::propagate`] and also returns the transmittance.
    #[inline(always)]
    fn propagate_inner<T: TraceListener>(
        &self,
        mut hit: Option<Hit>,
        at: &mut SurfaceInteraction,
        state: &mut PathState,
        context: &SampleContext,
        listener: &mut T,
    ) -> (PathEvent, Spectrum) {
        let lanes = &context.lanes;
        // Ray that starts at the last scattering event and skips the surfaces passed since then.
        let mut rest = state.ray;
        let mut transmittance = Spectrum::ONE;
        let mut passed = PassedSurfaces::default();
        let (mut traversed, mut layers, mut scatterings) = (0.0, 0, 0);
        let mut numbers = state.sample.stream(state.depth, 0);
        let before = state.throughput;
        loop {
            'passed: {
                let ray = &state.ray;
                let stretch = ray.dir().length();
                let length = hit.map_or(f32::INFINITY, |hit| hit.t * stretch);
                if let Some(medium) = self.world.medium(state.media.object()) {
                    let segment =
                        Segment { origin: ray.origin(), dir: ray.dir() / stretch, from: traversed, to: length };
                    match medium.sample_distance(&segment, state.throughput, lanes, &mut || numbers.number()) {
                        DistanceSample::Passed(left) => transmittance *= left,
                        DistanceSample::Scattered(distance, left) => {
                            transmittance *= left;
                            state.throughput = before * transmittance;
                            // Stay in front of the surface around the medium.
                            let distance = distance.min(length * (1.0 - gamma(16)));
                            let point = segment.origin + f64::from(distance) * segment.dir.as_dvec3();
                            if self.world.is_directly_lit(state.media.object()) {
                                return (PathEvent::Medium(point, segment.dir, medium.phase), transmittance);
                            }
                            // Lights are not visible from inside this object, so continue the
                            // random walk until it leaves the object.
                            scatterings += 1;
                            let survival = match scatterings {
                                0..16 => 1.0,
                                _ => state.throughput.max_element().min(1.0),
                            };
                            let is_cancelled = scatterings % 256 == 0 && self.is_cancelled();
                            if scatterings > MAX_WALK || is_cancelled || numbers.number() >= survival {
                                return (PathEvent::Absorbed, transmittance);
                            }
                            transmittance /= survival;
                            let dir = medium.phase.sample(segment.dir, numbers.pair());
                            state.ray = Ray64::new(point, dir, 0.0, f32::INFINITY);
                            (rest, traversed) = (state.ray, 0.0);
                            passed = PassedSurfaces::default();
                            (state.prev_vertex, state.camera_distance) = (None, None);
                            state.throughput = before * transmittance;
                            break 'passed;
                        }
                    }
                    state.throughput = before * transmittance;
                }
                let Some(hit) = hit else { return (PathEvent::Escaped, transmittance) };
                traversed = length;
                let hit = self.world.intersect_touching(ray, hit, at);
                if let (Some(cone), Some(before)) = (&self.cone, state.camera_distance) {
                    at.width = cone.width_at(before + length);
                }
                if self.world.hides_backs() && state.depth == 0 && self.world.is_hidden(ray.dir(), at) {
                    passed.pass(&hit);
                    break 'passed;
                }
                if state.depth == 0 && state.camera_distance.is_some() && self.world.is_unseen(at) {
                    passed.pass(&hit);
                    break 'passed;
                }
                if self.hides_emitters(state) && self.world.emits(at.material) {
                    passed.pass(&hit);
                    break 'passed;
                }
                if self.world.has_cutouts() {
                    let opacity = self.world.opacity(at);
                    layers += 1;
                    // Passing through a cutout does not count as a bounce.
                    if opacity < 1.0 && state.sample.layer(state.depth, layers) >= opacity {
                        passed.pass(&hit);
                        break 'passed;
                    }
                }
                match self.transition(at, &state.media, lanes) {
                    Some(transition) if self.has_no_effect(at, &transition) => {
                        state.media = transition.behind;
                        passed.pass(&hit);
                    }
                    transition => {
                        state.camera_distance = state.camera_distance.map(|before| before + length);
                        return (PathEvent::Surface(transition), transmittance);
                    }
                }
            }
            hit = passed.next_hit(self.world, &mut rest, listener);
        }
    }

    /// Returns true if a ray comes directly from the camera, which does not see the emitters.
    pub(super) fn hides_emitters(&self, state: &PathState) -> bool {
        self.world.hides_emitters() && state.depth == 0 && state.camera_distance.is_some()
    }

    /// Returns true if the render was cancelled.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(|cancel| cancel.load(Relaxed))
    }

    /// Returns the transition of a ray through a surface, or `None` if light cannot enter the
    /// object.
    pub(super) fn transition(
        &self,
        at: &SurfaceInteraction,
        media: &MediumStack,
        lanes: &Lanes,
    ) -> Option<MediumTransition> {
        let ior = self.world.refraction_index(at, lanes)?;
        let transition = media.nested_transition(self.world, at, ior, at.inside());
        Some(match self.world.ignores_surroundings(at) {
            true => transition.without_surroundings(ior, at.inside()),
            false => transition,
        })
    }

    /// Returns true if a surface has no effect on the ray, apart from a change of medium.
    pub(super) fn has_no_effect(&self, at: &SurfaceInteraction, transition: &MediumTransition) -> bool {
        transition.displaced || transition.ior_front == transition.ior_behind && self.world.is_interface(at)
    }
}
