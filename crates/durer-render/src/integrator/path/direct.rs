//! Direct light at a path vertex, from a point sampled on a light, with its MIS weight and shadow
//! ray.
//!
//! Paths find lights in two ways: by sampling a point on a light and by sampling a direction from
//! the BSDF. Lights that can be found in both ways are weighted by the power heuristic. Source:
//! Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, chapter 9.

use super::Path;
use super::radiance::{Contribution, PathOutput};
use super::state::{Dimension, PathState, SampleContext};
use super::vertex::{CANDIDATES, Vertex, VertexKind};
use crate::integrator::DirectSampling;
use crate::integrator::media::MediumStack;
use crate::integrator::trace::{Shadow, TermKind, TermValue, TraceListener};
use crate::world::emitters::{LightChoice, LightId, LightSample};
use crate::world::{PassedSurfaces, SurfaceInteraction};
use durer_scene::math::{Color, Ray64, Vec2, Vec3};
use durer_scene::medium::Segment;
use durer_scene::sampler::SampleId;
use durer_scene::shape::SurfacePoint;
use durer_scene::spectrum::Spectrum;
use glam::DVec3;

/// Point sampled on a light, with the BSDF value and the densities for the direction from a path
/// vertex to that point.
struct LightLiSample {
    light: LightSample,
    /// BSDF times cosine at the vertex.
    value: Spectrum,
    /// Density per steradian with which BSDF sampling chooses the direction.
    bsdf_pdf: f32,
    /// Density of the light sample per steradian, or its probability if the light has no extent.
    pdf: f32,
    /// Density per steradian of all candidates together, before one of them is selected. MIS
    /// weights use this density.
    candidate_pdf: f32,
}

/// Offset between the random numbers of successive candidates (R2 sequence), which stratifies them.
///
/// Source: Martin Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences*, 2018.
const R2_STEP: Vec2 = Vec2::new(0.754_877_7, 0.569_840_3);

impl Path<'_> {
    /// Returns the fraction of the light from a direction at infinity that reaches a point, per
    /// channel. Light passes thin sheets such as panes, but no surfaces that refract or reflect it.
    /// `dir` and `normal` are unit vectors; `id` selects the random numbers for media.
    pub fn visibility_of_direction(&self, point: DVec3, normal: Vec3, dir: Vec3, id: SampleId) -> Color {
        let surface = SurfacePoint::around(point, normal);
        let (shading, context, state) =
            (Self::white_matte(&surface, normal), self.context(id), self.start_at(&surface, id));
        let vertex = self.vertex(VertexKind::Surface(&surface, &shading, None), &state);
        let light = LightSample {
            light: LightId::Environment,
            wi: dir,
            reach: f32::INFINITY,
            error: 0.0,
            cosine: 1.0,
            radiance: Color::ONE,
            choice: 1.0,
            pdf: 1.0,
        };
        let (visible, _) = self.visibility(&light, &vertex, &state, &context, &mut ());
        context.lanes.color(visible * context.lanes.light(Color::ONE))
    }

    /// Chooses one light for a vertex at random, or `None` if no light can reach it.
    pub(super) fn choose_light(&self, vertex: &Vertex) -> Option<LightChoice> {
        self.world.emitters().choose(self.world, &vertex.receiver, vertex.random(Dimension::Choices).y)
    }

    /// Samples a point on the chosen light and adds the light from that point that the vertex
    /// scatters.
    pub(super) fn add_direct<T: TraceListener>(
        &self,
        choice: &LightChoice,
        vertex: &Vertex,
        state: &PathState,
        context: &SampleContext,
        output: &mut PathOutput<T>,
    ) {
        let Some(LightLiSample { light, value, bsdf_pdf, pdf, candidate_pdf }) = self.sample_li(choice, vertex) else {
            return;
        };
        if value == Spectrum::ZERO || light.radiance == Color::ZERO {
            return;
        }
        // BSDF sampling never hits a light without extent.
        let bsdf_pdf = if light.pdf > 0.0 { bsdf_pdf } else { 0.0 };
        let weight_of = |bsdf_pdf| self.options.direct.of_light(candidate_pdf, bsdf_pdf);
        if weight_of(bsdf_pdf) == 0.0 && !self.world.has_sheets() {
            return;
        }
        let (visibility, sheets) = self.visibility(&light, vertex, state, context, output.listener);
        // A path needs one bounce for each thin sheet. If too few bounces are left, BSDF sampling
        // never hits the light.
        let mis = weight_of(if state.depth + sheets > self.max_depth() { 0.0 } else { bsdf_pdf });
        let contribution = Contribution {
            factor: value * (mis / pdf) * visibility,
            light: context.lanes.light_of(light.radiance, || self.world.illuminant(light.light)),
            scatterings: state.depth + 1,
            sky: (light.light == LightId::Environment).then_some((light.wi, state.rough_bounces == 0)),
        };
        let what = || TermKind::Direct {
            light: light.light,
            to_light: light.wi,
            distance: light.reach,
            choice: light.choice,
            pdf: light.pdf,
            bsdf: context.term(value),
            mis,
            shadow: self.settings.shadows.then(|| self.shadow(&vertex.kind, &light, context.term(visibility))),
        };
        self.add(contribution, what, state, context, output);
    }

    /// Samples a point on the chosen light.
    fn sample_li(&self, choice: &LightChoice, vertex: &Vertex) -> Option<LightLiSample> {
        if choice.is_sky() && vertex.candidates > 1.0 {
            return self.resample_environment(choice, vertex);
        }
        let emitters = self.world.emitters();
        let at = |u| emitters.sample(self.world, choice, &vertex.receiver, u);
        let u = vertex.random(Dimension::LightPoint);
        let light = match (at(u)?, self.options.direct) {
            (any, DirectSampling::Center) => at(emitters.center_sample(any.light).unwrap_or(u))?,
            (any, _) => any,
        };
        let (value, bsdf_pdf) = vertex.eval(light.wi);
        let pdf = if light.pdf > 0.0 { light.choice * light.pdf } else { light.choice };
        Some(LightLiSample { light, value, bsdf_pdf, pdf, candidate_pdf: pdf })
    }

    /// Samples several directions towards the environment and selects one with a probability
    /// proportional to its MIS-weighted contribution, ignoring occlusion.
    ///
    /// Source: Talbot, Cline and Egbert, *Importance Resampling for Global Illumination*, EGSR
    /// 2005.
    fn resample_environment(&self, choice: &LightChoice, vertex: &Vertex) -> Option<LightLiSample> {
        let sky = self.world.environment()?;
        let (tries, mut u) = (vertex.candidates, vertex.random(Dimension::LightPoint));
        let (mut best, mut sum, mut rest) = (None, 0.0, vertex.random(Dimension::Survival).y);
        for _ in 0..CANDIDATES {
            let direction = sky.direction(u);
            u = (u + R2_STEP).map(|x| if x < 1.0 { x } else { x - 1.0 });
            let Some((wi, place, density)) = direction else { continue };
            let (value, bsdf_pdf) = vertex.eval(wi);
            if value == Spectrum::ZERO {
                continue;
            }
            let (density, radiance) = (choice.probability() * density, sky.light(&place));
            let candidate_pdf = tries * density;
            let mis = self.options.direct.of_light(candidate_pdf, bsdf_pdf);
            let target = mis * value.max_element() * radiance.max_element();
            let weight = target / density;
            if !(weight > 0.0 && weight.is_finite()) {
                continue;
            }
            sum += weight;
            let chance = weight / sum;
            if rest < chance {
                (rest, best) = (rest / chance, Some((wi, radiance, value, bsdf_pdf, candidate_pdf, target)));
            } else {
                rest = (rest - chance) / (1.0 - chance);
            }
        }
        let (wi, radiance, value, bsdf_pdf, candidate_pdf, target) = best?;
        let pdf = target * tries / sum;
        let light = LightSample::of_sky(choice, wi, radiance, pdf / choice.probability());
        Some(LightLiSample { light, value, bsdf_pdf, pdf, candidate_pdf })
    }

    /// Returns the fraction of the light from a light source that reaches a vertex, by lane, and
    /// the number of thin sheets in between.
    fn visibility<T: TraceListener>(
        &self,
        light: &LightSample,
        vertex: &Vertex,
        state: &PathState,
        context: &SampleContext,
        listener: &mut T,
    ) -> (Spectrum, u32) {
        if !self.settings.shadows {
            return (Spectrum::ONE, 0);
        }
        let media = vertex.kind.media_behind(light.wi).unwrap_or(&state.media);
        let mut ray = vertex.kind.shadow_ray(light);
        // Skip surfaces that are closer than the rounding errors, such as another point on the same
        // sphere.
        if ray.rounded.t_max <= ray.rounded.t_min {
            return (Spectrum::ZERO, 0);
        }
        let (mut left, mut sheets) = (Spectrum::ONE, 0);
        let mut numbers = state.sample.stream(state.depth, 1);
        let mut pass = |media: &MediumStack, ray: &Ray64, from: f32, to: f32| match self.world.medium(media.object()) {
            Some(medium) => {
                let segment = Segment { origin: ray.origin(), dir: light.wi, from, to };
                medium.transmittance(&segment, &context.lanes, &mut || numbers.number())
            }
            None => Spectrum::ONE,
        };
        // A BSDF sample can hit a light from both sides, so light samples must reach both sides
        // too.
        let hides_backs = self.world.hides_backs() && light.pdf == 0.0;
        if !self.world.has_cutouts() && !self.world.has_interfaces() && !self.world.has_sheets() {
            match self.world.occluded(&ray, listener) {
                true if hides_backs => {}
                true => return (Spectrum::ZERO, 0),
                false => return (pass(media, &ray, 0.0, ray.rounded.t_max), 0),
            }
        }
        let (mut media, mut passed, mut from) = (media.clone(), PassedSurfaces::default(), 0.0);
        // After 64 layers, the light counts as occluded.
        for _ in 0..64 {
            let Some(hit) = passed.next_hit(self.world, &mut ray, listener) else {
                return (left * pass(&media, &ray, from, ray.rounded.t_max), sheets);
            };
            left *= pass(&media, &ray, from, hit.t);
            let blocker = self.world.interaction(ray, hit);
            match self.transition(&blocker, &media, &context.lanes) {
                Some(transition) if self.has_no_effect(&blocker, &transition) => media = transition.behind,
                _ if hides_backs && self.world.is_hidden(-ray.dir(), &blocker) => {}
                None if self.world.has_sheets() => {
                    left *= self.straight_transmittance(&blocker, context);
                    sheets += 1;
                }
                _ => left *= 1.0 - self.world.opacity(&blocker),
            }
            if left == Spectrum::ZERO {
                break;
            }
            passed.pass(&hit);
            from = hit.t;
        }
        (Spectrum::ZERO, 0)
    }

    /// Returns the fraction of light that passes straight through an open surface, such as a pane.
    /// If photons are sent to the surface, they account for this light instead.
    fn straight_transmittance(&self, at: &SurfaceInteraction, context: &SampleContext) -> Spectrum {
        let opacity = self.world.opacity(at);
        let around = Spectrum::splat(1.0 - opacity);
        if !self.world.may_enter(at) || self.is_photon_target(at) {
            return around;
        }
        around + opacity * self.world.shading(at, 1.0, &context.lanes).bsdf.straight_transmittance()
    }

    /// Returns true if the given lobe transmits light as in [`Path::straight_transmittance`]. If
    /// so, light samples at the previous vertex already include the lights behind the surface.
    pub(super) fn sees_through(&self, vertex: &Vertex, lobe: usize, state: &PathState) -> bool {
        self.world.has_sheets() && !state.prev_is_photon_target && vertex.kind.transmits_straight(lobe)
    }

    /// Returns true if photons are sent to the object that was hit.
    pub(super) fn is_photon_target(&self, at: &SurfaceInteraction) -> bool {
        self.photons.as_ref().is_some_and(|photons| photons.reaches(at.hit.object))
    }

    /// Returns a record of a light sample's shadow ray for the trace.
    fn shadow(&self, vertex: &VertexKind, light: &LightSample, share: TermValue) -> Shadow {
        let ray = vertex.shadow_ray(light);
        let blocker = self.world.closest(&ray, &mut ()).map(|hit| (hit.object, hit.t));
        Shadow { ray: (&ray).into(), blocker, share }
    }
}

impl DirectSampling {
    /// Returns the MIS weight of a light sample with density `light`, given the density `bsdf` of
    /// its direction in BSDF sampling.
    fn of_light(self, light: f32, bsdf: f32) -> f32 {
        match self {
            DirectSampling::Both => power_heuristic(light, bsdf),
            DirectSampling::Lights | DirectSampling::Center => 1.0,
            // Light samples count only for lights that BSDF sampling cannot hit.
            DirectSampling::Bsdf => f32::from(u8::from(bsdf == 0.0)),
        }
    }

    /// Returns the MIS weight of a light hit by a BSDF sample with density `bsdf`, given the
    /// density `light` of the hit point in light sampling.
    pub(super) fn of_direction(self, bsdf: f32, light: f32) -> f32 {
        match self {
            DirectSampling::Both => power_heuristic(bsdf, light),
            DirectSampling::Lights | DirectSampling::Center => f32::from(u8::from(light == 0.0)),
            DirectSampling::Bsdf => 1.0,
        }
    }
}

/// Returns the MIS weight, according to the power heuristic, of a strategy with density `a` when
/// the other strategy has density `b`.
fn power_heuristic(a: f32, b: f32) -> f32 {
    if b == 0.0 {
        return 1.0;
    }
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}
