//! Light at the end of a ray: the background, suns, and the emission of surfaces.

use super::Path;
use super::radiance::{Contribution, Output};
use super::state::{PathState, PrevVertex, SampleContext};
use crate::integrator::trace::{TermKind, TraceListener};
use crate::world::SurfaceInteraction;
use durer_scene::math::Color;
use durer_scene::spectrum::Spectrum;

impl Path<'_> {
    /// Adds the background and suns in the direction of a ray that left the scene.
    pub(super) fn add_background<T: TraceListener>(
        &self,
        state: &PathState,
        context: &SampleContext,
        output: &mut Output<T>,
    ) {
        let emitters = self.world.emitters();
        let dir = state.ray.dir();
        let (sky, pdf) = emitters.sky(self.world, dir);
        let mut light = context.lanes.light(sky);
        // The camera sees suns, also through delta lobes; elsewhere they are sampled as lights.
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
        let contribution = Contribution { factor: Spectrum::splat(weight), light, scatterings: state.depth };
        self.add(contribution, || TermKind::Sky, state, context, output);
    }

    /// Adds the light that a hit surface emits.
    pub(super) fn add_emission<T: TraceListener>(
        &self,
        at: &SurfaceInteraction,
        state: &PathState,
        context: &SampleContext,
        output: &mut Output<T>,
    ) {
        let color = self.world.emission(at);
        if color == Color::ZERO {
            return;
        }
        let light = context.lanes.light_of(color, || self.world.own_illuminant(at.material));
        let is_sampled = self.world.emitters().chooses(&at.hit, at.ray.dir());
        let mis = self.hit_weight(state, is_sampled, |prev| self.pdf_of_hit(at, prev));
        let contribution = Contribution { factor: Spectrum::splat(mis), light, scatterings: state.depth };
        self.add(contribution, || TermKind::Emission { mis }, state, context, output);
    }

    /// MIS weight of a light hit by a sampled direction. `is_sampled`: photons are sent from it;
    /// `light_pdf`: density per steradian with which it is sampled as a light.
    fn hit_weight(&self, state: &PathState, is_sampled: bool, light_pdf: impl Fn(&PrevVertex) -> f32) -> f32 {
        match &state.prev_vertex {
            Some(prev) => self.transport.direct.of_direction(prev.pdf, light_pdf(prev)),
            None if is_sampled && state.is_caustic && state.prev_is_target => 0.0,
            None => 1.0,
        }
    }

    /// Density per steradian with which light sampling at the previous vertex chooses a hit.
    fn pdf_of_hit(&self, at: &SurfaceInteraction, prev: &PrevVertex) -> f32 {
        let SurfaceInteraction { ray, hit, .. } = at;
        let way = ray.origin() + f64::from(hit.t) * ray.dir().as_dvec3() - prev.receiver.point;
        let (wi, distance) = (ray.dir().normalize(), way.length() as f32);
        self.world.emitters().pdf_of_hit(self.world, hit, &prev.receiver, wi, distance)
    }
}
