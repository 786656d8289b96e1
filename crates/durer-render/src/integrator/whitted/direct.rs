//! Light that comes straight from the scene's lights.

use super::Whitted;
use crate::integrator::spawn::{spawn_ray, to_light};
use crate::integrator::trace::{NodeId, Shadow, TermKind, TraceListener};
use crate::world::{HighlightModel, Hit, Material, Phong, TOGETHER};
use durer_scene::light::Illumination;
use durer_scene::math::{Color, Ray64, Vec3, fp, gamma, reflect};
use durer_scene::shape::Surface;

/// So many transparent surfaces are looked through.
const MOST_LAYERS: u32 = 64;

impl Whitted<'_> {
    /// The shadow ray to a light, for listeners.
    pub(super) fn shadow(&self, surface: &Surface, light: usize, seen: &Illumination, share: Color) -> Shadow {
        let ray = self.shadow_ray(surface, light, seen);
        let blocker = self.world.closest(&ray, &mut ()).map(|hit| (hit.object, hit.t));
        Shadow { ray: (&ray).into(), blocker, share: share.into() }
    }

    #[inline(always)]
    pub(super) fn shadow_ray(&self, surface: &Surface, light: usize, seen: &Illumination) -> Ray64 {
        let epsilon = self.world.shading_rules().epsilon;
        if epsilon.is_none() {
            // What stands exactly at the light does not block it.
            return to_light(surface, seen.to_light, seen.distance * (1.0 - gamma(16)), None);
        }
        let way = self.world.course_way(light, surface.position);
        let (dir, distance) = way.unwrap_or((seen.to_light, seen.distance));
        to_light(surface, dir, distance, epsilon)
    }

    /// The shares of lights that arrive along shadow rays: nothing behind a thing, or what
    /// transparent things let through.
    pub(super) fn visible<T: TraceListener>(&self, shadows: &mut [Ray64], shares: &mut [Color], tally: &mut T) {
        let mut found = [None; TOGETHER];
        if self.world.shading_rules().shadow_fronts {
            self.world.first_hits(shadows, &mut found[..shadows.len()], tally);
            for ((ray, share), hit) in shadows.iter().zip(shares).zip(found) {
                let blocker = hit.map(|hit| self.world.interaction_along(ray, hit));
                let blocked = blocker.is_some_and(|blocker| blocker.surface.n_shade.dot(ray.dir()) <= 0.0);
                *share = if blocked { Color::ZERO } else { Color::ONE };
            }
        } else if self.settings.transparent_shadows {
            self.world.first_hits(shadows, &mut found[..shadows.len()], tally);
            for ((ray, share), hit) in shadows.iter().zip(shares).zip(found) {
                *share = self.let_through(*ray, hit, tally);
            }
        } else {
            let mut blocked = [false; TOGETHER];
            self.world.any_hits(shadows, &mut blocked[..shadows.len()], tally);
            for (share, blocked) in shares.iter_mut().zip(blocked) {
                *share = if blocked { Color::ZERO } else { Color::ONE };
            }
        }
    }

    /// What things in the way of a light let through, from the first hit of the ray to it on.
    fn let_through<T: TraceListener>(&self, mut ray: Ray64, mut found: Option<Hit>, tally: &mut T) -> Color {
        let (to_light, mut share) = (ray.dir(), Color::ONE);
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

/// Diffuse term and highlight of one light, if nothing is in the way. `parent`: the light's node in
/// the trace.
#[inline(always)]
pub(super) fn direct<T: TraceListener>(
    phong: &Phong,
    diffuse: Color,
    n: Vec3,
    view: Vec3,
    seen: &Illumination,
    parent: NodeId,
    tally: &mut T,
) -> Color {
    let cosine = n.dot(seen.to_light);
    let matte = cosine.max(0.0) * diffuse;
    let node = tally.begin(parent, || TermKind::Diffuse { cosine });
    tally.end(node, Color::splat(cosine.max(0.0)), Color::ONE, diffuse);
    let shines = |model| cosine > 0.0 || model == HighlightModel::Phong { behind: true };
    let Some((specular, exponent, model)) = phong.highlight.filter(|highlight| shines(highlight.2)) else {
        return matte * seen.color;
    };
    let base = match model {
        // Cosine of the angle between the normal and the direction halfway between light and eye.
        HighlightModel::Blinn => n.dot((seen.to_light - view).normalize_or_zero()),
        HighlightModel::Phong { .. } => reflect(view, n).dot(seen.to_light),
    };
    let strength = fp::pow(base.max(0.0), exponent);
    let node = tally.begin(parent, || TermKind::Highlight { model: TermKind::highlight(model), base, exponent });
    tally.end(node, Color::splat(strength), Color::ONE, specular);
    (matte + strength * specular) * seen.color
}
