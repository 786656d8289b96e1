//! Reflected and transmitted rays of the Whitted integrator.

use super::queue::{Queue, Segment};
use super::{ShadedMaterial, ShadingPoint, Whitted};
use crate::integrator::media::{MediumEntry, MediumStack, MediumTransition};
use crate::integrator::spawn::spawn_ray;
use crate::integrator::trace::{RayKind, TermKind, TraceListener};
use crate::world::{Material, SurfaceInteraction, WeightedMaterial};
use durer_scene::math::{Color, Vec3, reflect};
use durer_scene::shape::SurfacePoint;

/// Directions and weights of the reflected ray and the transmitted ray at a hit.
struct SecondaryRays {
    mirrored: Vec3,
    reflective: Color,
    /// Direction of the transmitted ray; `None` for total internal reflection and for opaque
    /// materials.
    transmitted: Option<Vec3>,
    transparent: Color,
    /// Fraction of the light that is reflected, if Fresnel's equations split the light.
    fresnel: Option<f32>,
}

impl Whitted<'_> {
    /// Spawns the reflected ray and the transmitted ray at a point. If there are no such rays, the
    /// point's segment is finished.
    pub(super) fn secondary<T: TraceListener>(
        &self,
        point: &mut ShadingPoint,
        parts: &[ShadedMaterial],
        queue: &mut Queue,
        colors: &mut [Color],
        listener: &mut T,
    ) {
        let number = point.segment;
        let &mut Segment { node, bounces, .. } = queue.segment(number);
        let blend = || SpecularBlend::of(parts.iter().map(|lit| &lit.part));
        if !self.continues(bounces) {
            if T::LISTENS && blend().is_some() {
                let node = listener.begin(node, || TermKind::DepthLimit);
                listener.end(node, Color::ONE, Color::ONE, Color::ZERO);
            }
            return queue.finish(number, point.color, colors, listener);
        }
        let blend = blend();
        let spoiled = self.world.shading_rules().spoiled_normals && point.n.is_nan();
        if !blend.is_some() || spoiled {
            return queue.finish(number, point.color, colors, listener);
        }
        let secondary_rays = self.secondary_rays(&point.at, blend, &point.transition);
        let total = blend.transparent != Color::ZERO && secondary_rays.transmitted.is_none();
        let MediumTransition { ior_front, ior_behind, .. } = point.transition;
        let secondary = listener.begin(node, || TermKind::Secondary {
            here: ior_front,
            there: ior_behind,
            fresnel: secondary_rays.fresnel,
            total,
        });
        let segment = queue.segment(number);
        (segment.local, segment.branches, segment.pending) = (point.color, [Color::ZERO; 2], 0);
        segment.secondary = secondary;
        let surface = &point.at.surface;
        if self.settings.reflection {
            let inside = |queue: &mut Queue| queue.segment(number).media.clone();
            let branch = (secondary_rays.mirrored, secondary_rays.reflective);
            self.spawn((number, RayKind::Reflected), surface, branch, inside, queue, listener);
        }
        if let Some(dir) = secondary_rays.transmitted.filter(|_| self.settings.refraction) {
            let inside = |_: &mut Queue| std::mem::take(&mut point.transition.behind);
            self.spawn(
                (number, RayKind::Transmitted),
                surface,
                (dir, secondary_rays.transparent),
                inside,
                queue,
                listener,
            );
        }
        if queue.segment(number).pending == 0 {
            listener.end(secondary, Color::ONE, Color::ONE, Color::ZERO);
            queue.finish(number, point.color + Color::ZERO, colors, listener);
        }
    }

    /// Computes the directions and weights of the secondary rays at a hit.
    #[inline]
    fn secondary_rays(
        &self,
        at: &SurfaceInteraction,
        blend: SpecularBlend,
        &MediumTransition { ior_front, ior_behind, .. }: &MediumTransition,
    ) -> SecondaryRays {
        let SpecularBlend { mut reflective, mut transparent, fresnel, .. } = blend;
        let (rules, leaving, dir) = (self.world.shading_rules(), self.sees_back(at), at.ray.dir());
        // Use the normals on the side of the ray.
        let [n, n_geo] = [at.surface.n_shade, at.surface.n_geo].map(|n| if leaving { -n } else { n });
        // An interpolated normal may point away from the ray, whereas the geometric normal never
        // does. A NaN normal, which can occur only in the arithmetic of the official programs, is
        // passed on.
        let n = if dir.dot(n) < 0.0 || n.is_nan() { n } else { n_geo };
        // Without `shade_back`, mirrors reflect about the unflipped normal. The reflected direction
        // does not depend on the sign of the normal.
        let mirrored = reflect(dir, n);
        // If the normal is not of unit length, neither is the reflected direction.
        let mirrored = if rules.raw_normals && !rules.long_mirrors { mirrored.normalize_or(n_geo) } else { mirrored };
        let n = if rules.raw_normals && !rules.raw_refraction { n.normalize_or(n_geo) } else { n };
        let transmitted = match transparent == Color::ZERO {
            true => None,
            // If the normal is not of unit length, neither is the transmitted direction.
            false if rules.raw_refraction => {
                refract_raw(dir, n, ior_front / ior_behind).map(|through| through.normalize_or(dir))
            }
            false => refract(dir, n, ior_front / ior_behind),
        };
        // If either reflection or refraction is switched off, the other one gets all the light.
        let divides = fresnel && self.settings.reflection && self.settings.refraction;
        let share = divides.then(|| {
            // In the case of total internal reflection, the reflected ray has weight 1.
            let before = if rules.exit_r0 { 1.0 } else { ior_front };
            transmitted.map_or(1.0, |through| fresnel_share(dir, n, through, (ior_front, ior_behind), before))
        });
        if let Some(share) = share {
            reflective *= share;
            transparent *= 1.0 - share;
        }
        SecondaryRays { mirrored, reflective, transmitted, transparent, fresnel: share }
    }

    /// Returns the transition of refracted light at a hit, or `None` if the surface is opaque.
    #[inline]
    pub fn transition(&self, at: &SurfaceInteraction, media: &MediumStack) -> Option<MediumTransition> {
        if !self.world.may_enter(at) {
            return None;
        }
        let blend = match &self.world.materials()[at.material as usize] {
            Material::Phong(phong) => SpecularBlend::of(&[WeightedMaterial { phong, share: 1.0 }]),
            Material::Mix(..) => SpecularBlend::of(&self.world.materials_at(at)),
        };
        if blend.transparent == Color::ZERO {
            return None;
        }
        let leaving = self.sees_back(at);
        Some(match self.world.shading_rules().one_medium {
            true => self.official_transition(at.hit.object, blend, leaving, media),
            false => media.transition_into(self.world, (at.hit.object, at.ray.rounded.origin), blend.ior, leaving),
        })
    }

    /// Returns the transition of refracted light as in the course's programs, where a ray has only
    /// one index of refraction and there is air behind glass.
    fn official_transition(
        &self,
        object: u32,
        blend: SpecularBlend,
        leaving: bool,
        media: &MediumStack,
    ) -> MediumTransition {
        let (known, ior) = (media.ior(), blend.ior);
        let (ior_front, ior_behind) = match (leaving, blend.fresnel) {
            (true, true) if known != 1.0 || self.world.shading_rules().air_at_eye => (known, 1.0),
            (true, _) => (ior, 1.0),
            (false, true) => (known, ior),
            (false, false) => (1.0, ior),
        };
        MediumTransition {
            ior_front,
            ior_behind,
            behind: MediumStack::single(MediumEntry { object, ior: ior_behind, size: None }),
            displaced: false,
        }
    }

    /// Returns the weight of a ray after multiplying it by a colour's largest component or, in the
    /// course's programs, by the colour's length. For a grey colour, the length is greater than the
    /// fraction of the light that is left.
    pub fn weight_after(&self, before: f32, weight: Color) -> f32 {
        let by_length = self.world.shading_rules().weight_by_length;
        before * if by_length { weight.length() } else { weight.max_element() }
    }

    /// Spawns a secondary ray, unless its weight in the pixel would be too small.
    fn spawn<T: TraceListener>(
        &self,
        (parent, from): (u32, RayKind),
        surface: &SurfacePoint,
        (dir, factor): (Vec3, Color),
        media: impl FnOnce(&mut Queue) -> MediumStack,
        queue: &mut Queue,
        listener: &mut T,
    ) {
        // Schlick's formula can give values below 0 if the normal is not of unit length.
        if factor == Color::ZERO {
            return;
        }
        let &mut Segment { weight, bounces, camera, secondary, .. } = queue.segment(parent);
        let weight = self.weight_after(weight, factor);
        if weight < self.settings.min_weight {
            let node = listener.begin(secondary, || TermKind::BelowMinWeight { weight });
            listener.end(node, factor, Color::ONE, Color::ZERO);
            return;
        }
        let ray = spawn_ray(surface, dir, f32::INFINITY, self.world.shading_rules().epsilon);
        let node =
            listener.begin(secondary, || TermKind::Ray { from, ray: (&ray).into(), weight, hit: None, bounce: None });
        let media = media(queue);
        queue.segment(parent).pending += 1;
        let segment = queue.push(&ray, node);
        (segment.media, segment.bounces, segment.weight, segment.factor) = (media, bounces - 1, weight, factor);
        (segment.camera, segment.parent) = (camera, parent);
        segment.branch = usize::from(from == RayKind::Transmitted);
    }
}

/// Mirror and glass properties at a point, for the Whitted integrator, averaged over the materials
/// according to their shares. The index of refraction is that of the material with the largest
/// share.
#[derive(Clone, Copy)]
pub struct SpecularBlend {
    /// Fraction of the light that is reflected as in a mirror, per channel.
    pub reflective: Color,
    /// Fraction of the light that is transmitted, per channel.
    pub transparent: Color,
    /// Index of refraction.
    pub ior: f32,
    /// True if the light is split between reflection and transmission by Schlick's approximation of
    /// Fresnel's equations.
    pub fresnel: bool,
}

impl SpecularBlend {
    /// Returns true if any light is reflected or transmitted.
    fn is_some(&self) -> bool {
        self.reflective != Color::ZERO || self.transparent != Color::ZERO
    }

    /// Averages the properties of the materials at a point.
    #[inline]
    pub fn of<'a, 'w: 'a>(parts: impl IntoIterator<Item = &'a WeightedMaterial<'w>>) -> Self {
        let mut blend = SpecularBlend { reflective: Color::ZERO, transparent: Color::ZERO, ior: 1.0, fresnel: false };
        let mut most = 0.0;
        for &WeightedMaterial { phong, share } in parts {
            blend.reflective += share * phong.reflective;
            blend.transparent += share * phong.transparent;
            if share > most {
                (most, blend.ior, blend.fresnel) = (share, phong.ior, phong.fresnel);
            }
        }
        blend
    }
}

/// Returns the reflected fraction of the light, by Schlick's approximation
/// R0 + (1 - R0) (1 - c)^5.
///
/// In this formula, c is the cosine on the side with the lower index of refraction. R0 is computed
/// from the indices `before` and `there`, so it is 0 if they are equal. Source: Schlick, *An
/// Inexpensive BRDF Model for Physically-based Rendering*, Eurographics 1994.
#[inline(always)]
pub fn fresnel_share(dir: Vec3, n: Vec3, transmitted: Vec3, (here, there): (f32, f32), before: f32) -> f32 {
    let ratio = (there - before) / (there + before);
    let r0 = ratio * ratio;
    let cosine = if here <= there { dir.dot(n).abs() } else { transmitted.dot(n).abs() };
    let rest = 1.0 - cosine;
    let square = rest * rest;
    r0 + (1.0 - r0) * square * square * rest
}

/// Computes [`refract`] with the order of operations used by the program of 2012, which rounds
/// differently.
fn refract_raw(d: Vec3, n: Vec3, eta: f32) -> Option<Vec3> {
    let cosine = -d.dot(n);
    let radicand = 1.0 - eta * eta * (1.0 - cosine * cosine);
    if radicand >= 0.0 { Some((eta * cosine - radicand.sqrt()) * n + eta * d) } else { None }
}

/// Refracts a direction according to Snell's law. The normal `n` must be on the ray's side. Returns
/// `None` for total internal reflection.
///
/// With eta = index in front / index behind, the result is t = eta (d - n (d·n)) - n sqrt(1 - eta^2
/// (1 - (d·n)^2)).
#[inline(always)]
pub fn refract(d: Vec3, n: Vec3, eta: f32) -> Option<Vec3> {
    let cosine = d.dot(n);
    let radicand = 1.0 - eta * eta * (1.0 - cosine * cosine);
    if radicand >= 0.0 { Some(eta * (d - cosine * n) - radicand.sqrt() * n) } else { None }
}
