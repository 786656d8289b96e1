//! Light at the end of a path's ray, from the background, suns and emissive surfaces.

use super::Path;
use super::radiance::{Contribution, PathOutput};
use super::state::{PathState, PrevVertex, SampleContext};
use crate::integrator::trace::{TermKind, TraceListener};
use crate::world::SurfaceInteraction;
use durer_scene::math::Color;
use durer_scene::spectrum::Spectrum;

impl Path<'_> {
    /// Adds the light of the background and the suns in the direction of a ray that left the scene.
    pub(super) fn add_background<T: TraceListener>(
        &self,
        state: &PathState,
        context: &SampleContext,
        output: &mut PathOutput<T>,
    ) {
        if self.hides_emitters(state) {
            return;
        }
        let emitters = self.world.emitters();
        let dir = state.ray.dir();
        let (sky, pdf) = emitters.sky(self.world, dir);
        let mut light = context.lanes.light(sky);
        // Suns are visible to the camera, either directly or through delta lobes. Other path
        // vertices sample suns as lights.
        if state.camera_distance.is_some() {
            let suns = emitters.suns(dir);
            light += suns
                .map(|(light, color)| context.lanes.light_of(color, || self.world.illuminant(light)))
                .sum::<Spectrum>();
        }
        let is_sampled = self.world.environment().is_some();
        let weight = self.hit_weight(state, is_sampled, |prev| {
            pdf * (prev.tries * emitters.chance_of_sky(self.world, &prev.receiver))
        });
        // The previous vertex is the first one, except for panes in between.
        let is_direct = state.rough_bounces == 1 && state.prev_vertex.is_some();
        let contribution = Contribution {
            factor: Spectrum::splat(weight),
            light,
            scatterings: state.depth,
            sky: is_sampled.then_some((dir, is_direct)),
        };
        self.add(contribution, || TermKind::Sky, state, context, output);
    }

    /// Adds the light that a surface emits at the point hit by a ray.
    pub(super) fn add_emission<T: TraceListener>(
        &self,
        at: &SurfaceInteraction,
        state: &PathState,
        context: &SampleContext,
        output: &mut PathOutput<T>,
    ) {
        let color = self.world.emission(at);
        if color == Color::ZERO {
            return;
        }
        let light = context.lanes.light_of(color, || self.world.material_illuminant(at.material));
        let is_sampled = self.world.emitters().can_choose(&at.hit, at.ray.dir());
        let mis = self.hit_weight(state, is_sampled, |prev| self.pdf_of_hit(at, prev));
        let contribution = Contribution { factor: Spectrum::splat(mis), light, scatterings: state.depth, sky: None };
        self.add(contribution, || TermKind::Emission { mis }, state, context, output);
    }

    /// Returns the MIS weight of a light hit by a BSDF sample. `is_sampled` is true if photons are
    /// sent from the light. `light_pdf` returns the density per steradian with which light sampling
    /// finds the light.
    fn hit_weight(&self, state: &PathState, is_sampled: bool, light_pdf: impl Fn(&PrevVertex) -> f32) -> f32 {
        match &state.prev_vertex {
            Some(prev) => self.options.direct.of_direction(prev.pdf, light_pdf(prev)),
            None if is_sampled && state.is_caustic && state.prev_is_photon_target => 0.0,
            None => 1.0,
        }
    }

    /// Returns the density per steradian with which light sampling at the previous vertex finds the
    /// hit point.
    fn pdf_of_hit(&self, at: &SurfaceInteraction, prev: &PrevVertex) -> f32 {
        let SurfaceInteraction { ray, hit, .. } = at;
        let to_hit = ray.origin() + f64::from(hit.t) * ray.dir().as_dvec3() - prev.receiver.point;
        let (wi, distance) = (ray.dir().normalize(), to_hit.length() as f32);
        self.world.emitters().pdf_of_hit(self.world, hit, &prev.receiver, wi, distance)
    }
}
