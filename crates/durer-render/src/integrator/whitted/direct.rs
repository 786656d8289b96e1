//! Light that comes straight from lamps.

use super::Whitted;
use crate::integrator::spawn::{spawn_ray, to_light};
use crate::integrator::trace::{NodeId, Shadow, TermKind, TraceListener};
use crate::world::{HighlightModel, Hit, Material, Phong};
use durer_scene::light::Illumination;
use durer_scene::math::{Color, Ray64, Vec3, fp, gamma, reflect};
use durer_scene::shape::Surface;

/// So many transparent surfaces are looked through.
const MOST_LAYERS: u32 = 64;

impl Whitted<'_> {
    /// What a witness is told of a shadow ray.
    pub(super) fn shadow(&self, surface: &Surface, seen: &Illumination, share: Color) -> Shadow {
        let ray = self.shadow_ray(surface, seen);
        let blocker = self.world.closest(&ray, &mut ()).map(|hit| (hit.object, hit.t));
        Shadow { ray: (&ray).into(), blocker, share: share.into() }
    }

    #[inline(always)]
    pub(super) fn shadow_ray(&self, surface: &Surface, seen: &Illumination) -> Ray64 {
        let epsilon = self.world.shading_rules().epsilon;
        // What stands exactly at the light does not block it.
        let reach = if epsilon.is_some() { seen.distance } else { seen.distance * (1.0 - gamma(16)) };
        to_light(surface, seen.to_light, reach, epsilon)
    }

    /// The share of a light that arrives: nothing behind a thing, or what transparent things let
    /// through.
    pub(super) fn visible<T: TraceListener>(&self, surface: &Surface, seen: &Illumination, tally: &mut T) -> Color {
        if !self.settings.shadows || seen.color == Color::ZERO {
            return Color::ONE;
        }
        let mut ray = self.shadow_ray(surface, seen);
        if self.world.shading_rules().shadow_fronts {
            let nearest = self.world.intersect(&ray, tally);
            let blocked = nearest.is_some_and(|blocker| blocker.surface.n_shade.dot(ray.dir()) <= 0.0);
            return if blocked { Color::ZERO } else { Color::ONE };
        }
        if !self.settings.transparent_shadows {
            return if self.world.occluded_along(&ray, tally) { Color::ZERO } else { Color::ONE };
        }
        let first = self.world.closest_along(&mut ray, tally);
        self.let_through(ray, first, seen.to_light, tally)
    }

    /// What things in the way of a light let through, from the first hit of the ray to it on.
    pub(super) fn let_through<T: TraceListener>(
        &self,
        mut ray: Ray64,
        mut found: Option<Hit>,
        to_light: Vec3,
        tally: &mut T,
    ) -> Color {
        let mut share = Color::ONE;
        // A thing with many layers is followed only so far.
        for layer in 1.. {
            let Some(hit) = found else { return share };
            // What lets nothing through need not be looked at.
            match &self.world.materials()[self.world.material_of(&hit) as usize] {
                Material::Phong(phong) if phong.transparent == Color::ZERO => break,
                _ => {}
            }
            let blocker = self.world.interaction_along(&ray, hit);
            let parts = self.world.parts(&blocker);
            share *= parts.iter().map(|part| part.share * part.phong.transparent).sum::<Color>();
            if share == Color::ZERO || layer == MOST_LAYERS {
                break;
            }
            let rest = ray.rounded.t_max - blocker.hit.t;
            ray = spawn_ray(&blocker.surface, to_light, rest, self.world.shading_rules().epsilon);
            found = self.world.closest_along(&mut ray, tally);
        }
        Color::ZERO
    }
}

/// Diffuse term and highlight of one light.
#[inline(always)]
pub(super) fn direct<T: TraceListener>(
    phong: &Phong,
    diffuse: Color,
    n: Vec3,
    view: Vec3,
    seen: &Illumination,
    node: NodeId,
    tally: &mut T,
) -> Color {
    let base = |model| match model {
        HighlightModel::Blinn => blinn(n, view, seen.to_light),
        HighlightModel::Phong { .. } => reflect(view, n).dot(seen.to_light),
    };
    scattered(phong.highlight, diffuse, n.dot(seen.to_light), base, node, tally) * seen.color
}

/// The cosine of the angle between the normal and what is halfway between light and eye.
#[inline(always)]
pub(super) fn blinn(n: Vec3, view: Vec3, to_light: Vec3) -> f32 {
    n.dot((to_light - view).normalize_or_zero())
}

/// What is scattered of white light that comes in at an angle of a cosine; `base` is the cosine
/// that a highlight is a power of. `parent` is the light's node in the trace.
#[inline(always)]
pub(super) fn scattered<T: TraceListener>(
    highlight: Option<(Color, f32, HighlightModel)>,
    diffuse: Color,
    cosine: f32,
    base: impl FnOnce(HighlightModel) -> f32,
    parent: NodeId,
    tally: &mut T,
) -> Color {
    let node = tally.begin(parent, || TermKind::Diffuse { cosine });
    tally.end(node, Color::splat(cosine.max(0.0)), Color::ONE, diffuse);
    let shines = highlight.filter(|&(.., model)| cosine > 0.0 || model == HighlightModel::Phong { behind: true });
    let Some((specular, exponent, model)) = shines else { return sum(cosine, diffuse, false, 0.0, Color::ZERO) };
    let base = base(model);
    let strength = fp::pow(base.max(0.0), exponent);
    let node = tally.begin(parent, || TermKind::Highlight { model: TermKind::highlight(model), base, exponent });
    tally.end(node, Color::splat(strength), Color::ONE, specular);
    sum(cosine, diffuse, true, strength, specular)
}

/// The diffuse term and, where it shines, the highlight.
#[inline(always)]
pub(super) fn sum(cosine: f32, diffuse: Color, shines: bool, strength: f32, specular: Color) -> Color {
    let matte = cosine.max(0.0) * diffuse;
    if shines { matte + strength * specular } else { matte }
}
