//! Sum of all that a path finds.

use super::Path;
use super::state::{PathState, SampleContext};
use crate::integrator::trace::{TermKind, TraceListener};
use durer_scene::spectrum::Spectrum;

/// Radiance along a camera ray as a path accumulates it, and who listens.
pub(super) struct Output<'t, T> {
    /// Sum of throughput · light over all terms so far, by lane.
    pub(super) radiance: Spectrum,
    /// Counts rays, and may keep every term.
    pub(super) tally: &'t mut T,
}

/// Light that reaches the present vertex.
pub(super) struct Contribution {
    /// What the light is multiplied by at the vertex: MIS weight, BSDF · cosine / pdf, visibility.
    pub(super) factor: Spectrum,
    /// Radiance of the source.
    pub(super) light: Spectrum,
    /// How often the light was scattered on its way from the source to the camera.
    pub(super) scatterings: u32,
}

impl Path<'_> {
    /// Adds light to the sum: throughput · factor · light, clamped.
    #[inline(always)]
    pub(super) fn add<T: TraceListener>(
        &self,
        Contribution { factor, light, scatterings }: Contribution,
        what: impl FnOnce() -> TermKind,
        state: &PathState,
        context: &SampleContext,
        output: &mut Output<T>,
    ) {
        let mut factor = factor;
        let mut throughput = state.throughput * state.share * factor;
        if let Some(limit) = self.transport.clamp
            && scatterings > 1
        {
            let brightest = (throughput * light).max_element();
            if brightest > limit {
                factor *= limit / brightest;
                throughput *= limit / brightest;
            }
        }
        output.radiance += throughput * light;
        let node = output.tally.begin(state.node, what);
        output.tally.end(node, context.term(factor), context.term(Spectrum::ONE), context.term(light));
        output.tally.weigh(node, context.term(Spectrum::ONE), context.term(throughput));
    }
}
