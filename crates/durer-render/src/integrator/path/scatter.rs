//! Scattering at a path vertex, with direction sampling, Russian roulette and the next ray.

use super::state::{Dimension, PathState, PrevVertex, SampleContext};
use super::vertex::{BsdfSample, Vertex};
use super::{Path, PathStack};
use crate::integrator::trace::{Bounce, RayKind, TermKind, TraceListener};
use crate::world::SurfaceInteraction;
use durer_scene::spectrum::Spectrum;

/// Maximum survival probability in Russian roulette.
const MAX_SURVIVAL: f32 = 0.95;

/// Returns the probability that a path survives Russian roulette. `fraction` is the fraction of
/// light that is left after the next scattering event.
///
/// Roulette starts after three rough bounces. Mirrors and smooth glass do not count, because the
/// path still has to reach the surfaces behind them: a glass of water then takes a third of the
/// time to equal error. Starting after five rough bounces takes longer, also in a Cornell box.
fn survival(state: &PathState, fraction: f32) -> f32 {
    match (state.depth, state.rough_bounces) {
        (0..3, _) => 1.0,
        // Reflections between mirrors need not continue once hardly any light is left.
        (_, 0..3) => (10.0 * fraction).min(1.0),
        _ => fraction.min(MAX_SURVIVAL),
    }
}

impl Path<'_> {
    /// Continues the path in the sampled direction or, if the vertex splits, in several directions,
    /// which become pending branches. Returns true if the active branch continues afterwards.
    pub(super) fn scatter<T: TraceListener>(
        &self,
        vertex: &Vertex,
        sample: Option<BsdfSample>,
        stack: &mut PathStack,
        context: &SampleContext,
        listener: &mut T,
    ) -> bool {
        if vertex.directions == 1 {
            return sample.is_some_and(|sample| self.spawn(vertex, &sample, &mut stack.active, context, listener));
        }
        for number in 0..vertex.directions {
            let mut branch = stack.active.branch(number, vertex.directions);
            let vertex = Vertex { random: branch.vertex_sample().pairs(), ..*vertex };
            if let Some(sample) = vertex.sample_bsdf()
                && self.spawn(&vertex, &sample, &mut branch, context, listener)
            {
                stack.pending.push(branch);
            }
        }
        // Trace the branches depth first, in ascending order.
        stack.pending.reverse();
        false
    }

    /// Turns the state of a path into that of the ray that leaves in a sampled direction. Returns
    /// false if Russian roulette ends the path, in which case the state is undefined.
    fn spawn<T: TraceListener>(
        &self,
        vertex: &Vertex,
        sample: &BsdfSample,
        state: &mut PathState,
        context: &SampleContext,
        listener: &mut T,
    ) -> bool {
        let throughput = state.throughput * sample.weight;
        let squared_eta = state.squared_eta * vertex.kind.squared_eta(sample);
        let survival = survival(state, throughput.max_element() * squared_eta);
        if survival < 1.0 && vertex.random(Dimension::Survival).x >= survival {
            return false;
        }
        let is_delta = sample.pdf == 0.0;
        if is_delta {
            // Light samples do not compete with a delta lobe, unless the lobe transmits light
            // straight through the surface.
            state.prev_vertex = state.prev_vertex.filter(|_| self.sees_through(vertex, sample.lobe, state));
            state.is_caustic |= state.rough_bounces > 0;
        } else {
            let pdf = vertex.directions as f32 * sample.pdf;
            state.prev_vertex = Some(PrevVertex { receiver: vertex.receiver, pdf, tries: vertex.candidates });
            state.is_caustic = false;
            state.rough_bounces += 1;
            state.camera_distance = None;
        }
        if let Some(media) = vertex.kind.media_behind(sample.wi) {
            state.media = media.clone();
        }
        state.throughput = throughput / survival;
        state.squared_eta = squared_eta;
        state.depth += 1;
        state.ray = vertex.kind.spawn(sample.wi);
        let node = listener.begin(state.node, || TermKind::Ray {
            from: match (is_delta, sample.transmits) {
                (true, false) => RayKind::Reflected,
                (true, true) => RayKind::Transmitted,
                (false, _) => RayKind::Scattered,
            },
            ray: (&state.ray).into(),
            weight: (state.throughput * state.pixel_share).max_element(),
            hit: None,
            bounce: Some({
                let (lobe, probability) = vertex.kind.lobe(sample.lobe);
                Bounce { lobe, probability, pdf: sample.pdf, survival, directions: vertex.directions }
            }),
        });
        let factor = sample.weight / (survival * vertex.directions as f32);
        listener.end(node, context.term(factor), context.term(Spectrum::ONE), context.term(Spectrum::ZERO));
        state.node = node;
        true
    }

    /// At a dispersive surface, ends all wavelengths except the hero wavelength, because each
    /// wavelength is refracted in a different direction. The weight of the hero wavelength is
    /// multiplied by four to make up for the others.
    pub(super) fn select_hero<T: TraceListener>(
        &self,
        at: &SurfaceInteraction,
        state: &mut PathState,
        context: &SampleContext,
        listener: &mut T,
    ) {
        let Some(nm) = context.lanes.hero().filter(|_| !state.monochromatic && self.world.disperses(at)) else {
            return;
        };
        let kept = Spectrum::X * 4.0;
        state.throughput *= kept;
        state.monochromatic = true;
        let node = listener.begin(state.node, || TermKind::Dispersion { nm });
        let [one, zero] = [Spectrum::ONE, Spectrum::ZERO].map(|value| context.term(value));
        listener.end(node, context.term(kept), one, zero);
        listener.weigh(node, one, context.term(state.throughput * state.pixel_share));
        state.node = node;
    }
}
