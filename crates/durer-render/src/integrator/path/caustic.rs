//! Caustics, computed from the photons near a path vertex.

use super::Path;
use super::photons::DensityEstimate;
use super::radiance::{Contribution, PathOutput};
use super::state::{PathState, SampleContext};
use super::vertex::{Vertex, VertexKind};
use crate::integrator::trace::{TermKind, TraceListener};
use durer_scene::spectrum::Spectrum;

impl Path<'_> {
    /// Adds the light of photons near a vertex to the path's radiance.
    pub(super) fn add_caustic<T: TraceListener>(
        &self,
        vertex: &Vertex,
        state: &PathState,
        context: &SampleContext,
        output: &mut PathOutput<T>,
    ) {
        let Some(map) = &context.photons else { return };
        let max_bounces = self.max_depth() - state.depth;
        let DensityEstimate { radiance: light, photons, radius } = match &vertex.kind {
            VertexKind::Surface(surface, shading, _) => map.on_surface(surface, shading, max_bounces),
            VertexKind::Medium(point, dir, phase) => {
                map.in_medium((point.as_vec3(), *dir), state.media.object(), phase, max_bounces)
            }
        };
        if photons > 0 {
            let contribution = Contribution { factor: Spectrum::ONE, light, scatterings: state.depth + 1, sky: None };
            self.add(contribution, || TermKind::Photons { radius, photons }, state, context, output);
        }
    }
}
