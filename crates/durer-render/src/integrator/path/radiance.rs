//! Summation of the light that a path finds along its way.

use super::Path;
use super::state::{PathState, SampleContext};
use crate::integrator::trace::{SkyLight, TermKind, TraceListener};
use durer_scene::math::{Color, Vec3};
use durer_scene::spectrum::Spectrum;

/// Output of tracing a path, with the sum of the radiance found so far and the trace listener.
pub(super) struct PathOutput<'t, T> {
    /// Sum of throughput · light over all terms so far, by lane.
    pub(super) radiance: Spectrum,
    /// Listener that counts rays and can record each term.
    pub(super) listener: &'t mut T,
}

/// Light found at a path vertex, to be added to the camera ray's radiance.
pub(super) struct Contribution {
    /// Factor at the vertex, which is MIS weight · BSDF · cosine / pdf · visibility.
    pub(super) factor: Spectrum,
    /// Radiance of the light source.
    pub(super) light: Spectrum,
    /// Number of scattering events between the light source and the camera.
    pub(super) scatterings: u32,
    /// Direction of the light, if it comes from the environment, and whether it is direct; see
    /// [`SkyLight`].
    pub(super) sky: Option<(Vec3, bool)>,
}

impl Path<'_> {
    /// Adds throughput · factor · light to the radiance of the camera ray, after clamping the
    /// product.
    #[inline(always)]
    pub(super) fn add<T: TraceListener>(
        &self,
        Contribution { factor, light, scatterings, sky }: Contribution,
        what: impl FnOnce() -> TermKind,
        state: &PathState,
        context: &SampleContext,
        output: &mut PathOutput<T>,
    ) {
        let mut factor = factor;
        let mut throughput = state.throughput * state.pixel_share * factor;
        if let Some(limit) = self.options.clamp
            && scatterings > 1
        {
            let brightest = (throughput * light).max_element();
            if brightest > limit {
                factor *= limit / brightest;
                throughput *= limit / brightest;
            }
        }
        output.radiance += throughput * light;
        let node = output.listener.begin(state.node, what);
        output.listener.end(node, context.term(factor), context.term(Spectrum::ONE), context.term(light));
        output.listener.weigh(node, context.term(Spectrum::ONE), context.term(throughput));
        if let Some((dir, is_direct)) = sky {
            let throughput = || context.lanes.color(throughput * context.lanes.light(Color::ONE));
            output.listener.sky(|| SkyLight { dir, is_direct, throughput: throughput() });
        }
    }
}
