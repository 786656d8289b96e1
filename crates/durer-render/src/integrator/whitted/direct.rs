//! Direct light in the Whitted integrator, with shadow rays, diffuse terms and highlights.

use super::{ShadedMaterial, ShadingPoint, Whitted};
use crate::integrator::spawn::{spawn_ray, to_light};
use crate::integrator::trace::{NodeId, Shadow, TermKind, TraceListener};
use crate::world::{HighlightModel, Hit, MAX_BATCH, Material, Phong};
use durer_bvh::internal::{PlainKernel, run_plain};
use durer_scene::light::LightLiSample;
use durer_scene::math::{Color, Ray64, Vec3, fp, gamma, reflect};
use durer_scene::shape::SurfacePoint;

/// Maximum number of transparent surfaces along a shadow ray.
const MOST_LAYERS: u32 = 64;

impl Whitted<'_> {
    /// Returns a record of the shadow ray to a light for the trace.
    pub(super) fn shadow(
        &self,
        surface: &SurfacePoint,
        light: usize,
        light_sample: &LightLiSample,
        share: Color,
    ) -> Shadow {
        let ray = self.shadow_ray(surface, light, light_sample);
        let blocker = self.world.closest(&ray, &mut ()).map(|hit| (hit.object, hit.t));
        Shadow { ray: (&ray).into(), blocker, share: share.into() }
    }

    /// Returns the shadow ray to a light.
    #[inline(always)]
    pub(super) fn shadow_ray(&self, surface: &SurfacePoint, light: usize, light_sample: &LightLiSample) -> Ray64 {
        let epsilon = self.world.shading_rules().epsilon;
        if epsilon.is_none() {
            // End the ray before the light, so that objects exactly at the light do not block it.
            return to_light(surface, light_sample.to_light, light_sample.distance * (1.0 - gamma(16)), None);
        }
        let light_direction = self.world.course_light_direction(light, surface.position);
        let (dir, distance) = light_direction.unwrap_or((light_sample.to_light, light_sample.distance));
        to_light(surface, dir, distance, epsilon)
    }

    /// Computes the visibility of lights along shadow rays, which is 0 if the light is occluded and
    /// otherwise the transmittance of the transparent objects in between.
    pub(super) fn visible<T: TraceListener>(&self, shadows: &mut [Ray64], shares: &mut [Color], listener: &mut T) {
        let mut hits = [None; MAX_BATCH];
        if self.world.shading_rules().shadow_fronts {
            self.world.first_hits(shadows, &mut hits[..shadows.len()], listener);
            for ((ray, share), hit) in shadows.iter().zip(shares).zip(hits) {
                let blocker = hit.map(|hit| self.world.interaction_along(ray, hit));
                let blocked = blocker.is_some_and(|blocker| blocker.surface.n_shade.dot(ray.dir()) <= 0.0);
                *share = if blocked { Color::ZERO } else { Color::ONE };
            }
        } else if self.settings.transparent_shadows {
            self.world.first_hits(shadows, &mut hits[..shadows.len()], listener);
            for ((ray, share), hit) in shadows.iter().zip(shares).zip(hits) {
                *share = self.shadow_transmittance(*ray, hit, listener);
            }
        } else {
            let mut blocked = [false; MAX_BATCH];
            self.world.any_hits(shadows, &mut blocked[..shadows.len()], listener);
            for (share, blocked) in shares.iter_mut().zip(blocked) {
                *share = if blocked { Color::ZERO } else { Color::ONE };
            }
        }
    }

    /// Returns the transmittance of the transparent objects along a shadow ray. `next_hit` is the
    /// first hit of the ray.
    fn shadow_transmittance<T: TraceListener>(
        &self,
        mut ray: Ray64,
        mut next_hit: Option<Hit>,
        listener: &mut T,
    ) -> Color {
        let (to_light, mut share) = (ray.dir(), Color::ONE);
        // The loop limits the number of layers.
        for layer in 1.. {
            let Some(hit) = next_hit else { return share };
            // An opaque material ends the search early, before the surface is computed.
            match &self.world.materials()[self.world.material_of(&hit) as usize] {
                Material::Phong(phong) if phong.transparent == Color::ZERO => break,
                _ => {}
            }
            let blocker = self.world.interaction_along(&ray, hit);
            let parts = self.world.materials_at(&blocker);
            share *= parts.iter().map(|part| part.share * part.phong.transparent).sum::<Color>();
            if share == Color::ZERO || layer == MOST_LAYERS || self.world.contact(&blocker).is_some() {
                break;
            }
            let rest = ray.rounded.t_max - blocker.hit.t;
            ray = spawn_ray(&blocker.surface, to_light, rest, self.world.shading_rules().epsilon);
            next_hit = self.world.closest_along(&mut ray, listener);
        }
        Color::ZERO
    }
}

/// Diffuse and highlight terms of one light at a shaded point, ignoring occlusion.
#[derive(Clone, Copy, Default)]
pub(super) struct LightTerms {
    /// Cosine between the normal and the direction to the light.
    cosine: f32,
    /// Cosine that is raised to the highlight's exponent, which may be negative. It is `None` if
    /// there is no highlight.
    base: Option<f32>,
    /// The cosine raised to the highlight's exponent, computed by [`compute_powers`].
    strength: f32,
    diffuse: Color,
}

impl LightTerms {
    /// Computes all terms except the power needed for the highlight.
    #[inline(always)]
    pub(super) fn of(phong: &Phong, diffuse: Color, n: Vec3, view: Vec3, light_sample: &LightLiSample) -> Self {
        let cosine = n.dot(light_sample.to_light);
        let emits = |model| cosine > 0.0 || model == HighlightModel::Phong { behind: true };
        let highlight = phong.highlight.filter(|highlight| emits(highlight.2));
        let base = highlight.map(|(_, _, model)| match model {
            // Cosine between the normal and the half vector of the directions to the light and to
            // the eye.
            HighlightModel::Blinn => n.dot((light_sample.to_light - view).normalize_or_zero()),
            HighlightModel::Phong { .. } => reflect(view, n).dot(light_sample.to_light),
        });
        LightTerms { cosine, base, strength: 0.0, diffuse: cosine.max(0.0) * diffuse }
    }

    /// Returns true if both terms are 0, whatever the colour of the light.
    #[inline(always)]
    pub(super) fn is_dark(&self, phong: &Phong) -> bool {
        let highlight = |(specular, exponent, _)| {
            // An exponent of 0 gives a power of 1. A base greater than 1, caused by a normal longer
            // than 1, can give infinity.
            let shows = |base: f32| base > if specular == Color::ZERO { 1.0 } else { 0.0 };
            self.base.is_some_and(shows) || specular != Color::ZERO && exponent <= 0.0
        };
        self.diffuse == Color::ZERO && !(self.base.is_some() && phong.highlight.is_some_and(highlight))
    }

    /// Returns the radiance that the point scatters towards the ray's origin.
    #[inline(always)]
    pub(super) fn color(&self, phong: &Phong, light_sample: &LightLiSample) -> Color {
        match (self.base, phong.highlight) {
            (Some(_), Some((specular, ..))) => (self.diffuse + self.strength * specular) * light_sample.color,
            _ => self.diffuse * light_sample.color,
        }
    }

    /// Reports both terms to a listener. `parent` is the light's node in the trace.
    pub(super) fn report<T: TraceListener>(&self, phong: &Phong, diffuse: Color, parent: NodeId, listener: &mut T) {
        let cosine = self.cosine;
        let node = listener.begin(parent, || TermKind::Diffuse { cosine });
        listener.end(node, Color::splat(cosine.max(0.0)), Color::ONE, diffuse);
        if let (Some(base), Some((specular, exponent, model))) = (self.base, phong.highlight) {
            let node =
                listener.begin(parent, || TermKind::Highlight { model: TermKind::highlight(model), base, exponent });
            listener.end(node, Color::splat(self.strength), Color::ONE, specular);
        }
    }
}

/// Computes the powers for the highlights of several points with SIMD.
pub(super) fn compute_powers(points: &[ShadingPoint], parts: &mut [ShadedMaterial], some: impl Iterator<Item = usize>) {
    let mut powers = Powers { bases: [0.0; MAX_BATCH], exponents: [1.0; MAX_BATCH], count: 0 };
    let mut places = [0; MAX_BATCH];
    for point in some.map(|i| &points[i]) {
        for place in point.first_part..point.first_part + point.parts {
            let ShadedMaterial { part, direct, .. } = &mut parts[place];
            let (Some(base), Some((_, exponent, _))) = (direct.base, part.phong.highlight) else { continue };
            if base.is_nan() || base <= 0.0 {
                direct.strength = if exponent > 0.0 { 0.0 } else { fp::pow(0.0, exponent) };
                continue;
            }
            let at = powers.count;
            (powers.bases[at], powers.exponents[at], places[at]) = (base, exponent, place);
            powers.count += 1;
            if powers.count == MAX_BATCH {
                powers.flush(&places, parts);
            }
        }
    }
    powers.flush(&places, parts);
}

/// Batch of bases and exponents of highlights, whose powers are computed with SIMD.
struct Powers {
    bases: [f32; MAX_BATCH],
    exponents: [f32; MAX_BATCH],
    count: usize,
}

impl Powers {
    /// Computes the powers of the batch, stores them in `parts` and empties the batch.
    fn flush(&mut self, places: &[usize; MAX_BATCH], parts: &mut [ShadedMaterial]) {
        let count = std::mem::take(&mut self.count);
        if count == 0 {
            return;
        }
        let powers = run_plain(PowerKernel(self, count));
        for (i, &place) in places[..count].iter().enumerate() {
            let power = powers[i];
            // The scalar function handles special values.
            let power = if power.is_nan() { fp::pow(self.bases[i], self.exponents[i]) } else { power };
            parts[place].direct.strength = power;
        }
    }
}

/// Kernel that computes a batch of powers with the best instruction set of the CPU.
struct PowerKernel<'p>(&'p Powers, usize);

impl PlainKernel for PowerKernel<'_> {
    type Output = [f32; MAX_BATCH];

    #[inline(always)]
    fn run(self) -> [f32; MAX_BATCH] {
        let PowerKernel(Powers { bases, exponents, .. }, count) = self;
        let mut powers = [0.0; MAX_BATCH];
        for start in (0..count).step_by(8) {
            for i in start..start + 8 {
                powers[i] = fp::fast_pow(bases[i], exponents[i]);
            }
        }
        powers
    }
}
