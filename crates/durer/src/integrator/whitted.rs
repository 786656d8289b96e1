//! Whitted's recursive ray tracing: local light, a mirrored and a transmitted ray.
//!
//! Source: Turner Whitted, *An Improved Illumination Model for Shaded Display*, CACM 23(6), 1980,
//! with the terms of the course.

use super::media::{Body, Media, Passage};
use super::spawn::{spawn_ray, to_light};
use super::trace::{HitRecord, RayKind, Shadow, TermKind, TraceListener};
use super::{Integrate, Parameters, Setup};
use crate::describe::described;
use crate::dialect::{Compat, set};
use crate::light::Illumination;
use crate::math::{Color, Ray, Ray64, Vec3, fp, gamma, reflect};
use crate::sampler::SampleId;
use crate::shape::Surface;
use crate::world::{HighlightModel, Hit, Interaction, Material, Phong, WeightedMaterial, World};
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// What a picture takes into account.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Levels of secondary rays; 0 means local light only.
    pub bounces: u32,
    /// Whether things between a light and a surface block it.
    pub shadows: bool,
    /// Whether surfaces seen from behind are shaded with their normal turned.
    pub shade_back: bool,
    /// Whether transparent things cast coloured shadows.
    pub transparent_shadows: bool,
    /// Whether mirrored rays are traced.
    pub reflection: bool,
    /// Whether transmitted rays are traced.
    pub refraction: bool,
    /// A ray that counts for less than this is not traced. A colour counts by its largest part; for
    /// old programs, by its length, as in the course.
    pub least_weight: f32,
}

impl Settings {
    /// More levels than this overflow the stack.
    pub const MAX_BOUNCES: u32 = 256;
}

described! {
    /// local light, mirrors, glass
    WhittedParameters ["whitted" in set::DURER] {}
}

impl Copy for WhittedParameters {}

impl Parameters for WhittedParameters {
    type Integrator<'w> = Whitted<'w>;

    const IS_RANDOM: bool = false;

    fn over(self, Setup { world, settings, cancel, .. }: Setup<'_>) -> Whitted<'_> {
        Whitted { world, settings, cancel }
    }
}

/// The integrator over one world.
#[derive(Clone, Copy, Debug)]
pub struct Whitted<'w> {
    /// What is seen.
    pub world: &'w World,
    /// What is taken into account.
    pub settings: Settings,
    /// Once set, no more rays are traced, and what comes out means nothing: a pixel of many mirrors
    /// may take long.
    pub cancel: Option<&'w AtomicBool>,
}

/// What a ray carries from bounce to bounce.
#[derive(Clone, Copy)]
struct Path<'a> {
    bounces: u32,
    /// What the ray runs in.
    media: &'a Media,
    /// How much the ray counts for in the pixel.
    weight: f32,
}

/// One of the materials that make up a point, and what was worked out of it.
struct Lit<'w> {
    part: WeightedMaterial<'w>,
    /// A texture or noise is looked up once for all lights.
    diffuse: Color,
    /// What it scatters of the light that is asked for.
    scattered: Color,
}

impl Integrate for Whitted<'_> {
    fn radiance<T: TraceListener>(&self, ray: &Ray, _: SampleId, tally: &mut T) -> Color {
        self.radiance(ray, tally)
    }

    fn first_hits(&self, rays: &[Option<Ray>; 8]) -> Option<[Option<Hit>; 8]> {
        self.world.closest_of_eight(rays)
    }

    fn radiance_from<T: TraceListener>(&self, ray: &Ray, hit: Option<Hit>, _: SampleId, tally: &mut T) -> Color {
        tally.ray();
        self.camera_ray(ray, tally, |_, _| hit)
    }
}

impl<'w> Whitted<'w> {
    /// The light that comes along a camera ray.
    pub fn radiance<T: TraceListener>(&self, ray: &Ray, tally: &mut T) -> Color {
        self.camera_ray(ray, tally, |ray, tally| self.world.closest_along(ray, tally))
    }

    #[inline(always)]
    fn camera_ray<T: TraceListener>(
        &self,
        ray: &Ray,
        tally: &mut T,
        find: impl FnOnce(&mut Ray64, &mut T) -> Option<Hit>,
    ) -> Color {
        let mut along = ray.into();
        let path = Path { bounces: self.settings.bounces, media: &Media::default(), weight: 1.0 };
        tally.begin(|| TermKind::Ray { from: RayKind::Camera, ray: ray.into(), weight: 1.0, hit: None, bounce: None });
        let found = find(&mut along, tally);
        let color = self.trace(&along, found, path, tally);
        tally.end(Color::ONE, Color::ONE, color);
        color
    }

    /// The light along a ray that has hit this first.
    fn trace<T: TraceListener>(&self, ray: &Ray64, mut found: Option<Hit>, path: Path, tally: &mut T) -> Color {
        // What it runs in behind surfaces that are none.
        let mut inside = None;
        while let Some(hit) = found {
            let at = self.world.interaction_along(ray, hit);
            let media = inside.as_ref().unwrap_or(path.media);
            match self.passage(&at, media) {
                Some(Passage { hidden: true, behind, .. }) => {
                    let mut rest = *ray;
                    (inside, rest.rounded.t_min) = (Some(behind), hit.t);
                    found = self.world.closest_along(&mut rest, tally);
                }
                passage => return self.shade(&at, passage, Path { media, ..path }, tally),
            }
        }
        let sky = self.world.sky(ray.dir());
        tally.begin(|| TermKind::Sky);
        tally.end(Color::ONE, Color::ONE, sky);
        sky
    }

    /// The light that leaves a hit against the ray: of each material that makes it up, by its
    /// share.
    #[inline]
    fn shade<T: TraceListener>(&self, at: &Interaction, passage: Option<Passage>, path: Path, tally: &mut T) -> Color {
        let lit = |part: WeightedMaterial<'w>| {
            let diffuse = self.world.diffuse_color(part.phong, &at.surface);
            Lit { part, diffuse, scattered: Color::ZERO }
        };
        match &self.world.materials()[at.material as usize] {
            // Nearly always; what is known of one stays in registers.
            Material::Phong(phong) => {
                self.shade_all(at, &mut [lit(WeightedMaterial { phong, share: 1.0 })], passage, path, tally)
            }
            Material::Solid(..) => {
                let mut all: SmallVec<[Lit; 2]> = self.world.parts(at).into_iter().map(lit).collect();
                self.shade_all(at, &mut all, passage, path, tally)
            }
        }
    }

    #[inline(always)]
    fn shade_all<T: TraceListener>(
        &self,
        at: &Interaction,
        all: &mut [Lit],
        passage: Option<Passage>,
        path: Path,
        tally: &mut T,
    ) -> Color {
        let Interaction { ray, surface, .. } = at;
        let from_behind = self.sees_back(at);
        let black = from_behind && !self.settings.shade_back && self.world.rules().has(Compat::BlackBacks);
        let n = if from_behind && self.settings.shade_back { -surface.n_shade } else { surface.n_shade };
        let n = if self.world.rules().has(Compat::UnitLight) { n.normalize_or(n) } else { n };
        tally.hit(|| hit_record(self.world, at, n, from_behind, black));
        let mut color = Color::ZERO;
        if !black {
            for Lit { part, diffuse, .. } in all.iter() {
                let met = part.phong.ambient.unwrap_or(*diffuse);
                let ambient = part.share * self.world.ambient();
                tally.begin(|| TermKind::Ambient { share: part.share });
                tally.end(ambient, Color::ONE, met);
                color += ambient * met;
            }
            for number in 0..self.world.lights().len() {
                let seen = self.world.illuminate(number, surface.point());
                // Where nothing of a light would be scattered, nobody asks whether it arrives.
                if !T::LISTENS {
                    let mut dark = true;
                    for Lit { part, diffuse, scattered } in all.iter_mut() {
                        *scattered = direct(part.phong, *diffuse, n, ray.dir(), &seen, tally);
                        dark &= *scattered == Color::ZERO;
                    }
                    if dark {
                        continue;
                    }
                }
                let visible = self.visible(surface, &seen, tally);
                for Lit { part, diffuse, scattered } in all.iter() {
                    let share = part.share;
                    tally.begin(|| {
                        let shadow = self.settings.shadows.then(|| self.shadow(surface, &seen, visible));
                        let (to_light, distance) = (seen.to_light, seen.distance);
                        TermKind::Light { light: number, to_light, distance, share, shadow }
                    });
                    // In the dark nothing is computed.
                    let direct = match visible == Color::ZERO {
                        true => Color::ZERO,
                        false if T::LISTENS => direct(part.phong, *diffuse, n, ray.dir(), &seen, tally),
                        false => *scattered,
                    };
                    tally.end(share * visible, seen.color, direct);
                    color += share * visible * direct;
                }
            }
        }
        let cancelled = self.cancel.is_some_and(|cancel| cancel.load(Relaxed));
        if path.bounces > 0 && !cancelled {
            let blend = Blend::of(all.iter().map(|lit| &lit.part));
            color += match blend.reflective == Color::ZERO && blend.transparent == Color::ZERO {
                true => Color::ZERO,
                false => self.secondary(at, blend, passage.unwrap_or_default(), path, tally),
            };
        } else if all.iter().any(|Lit { part, .. }| part.phong.reflective + part.phong.transparent != Color::ZERO) {
            tally.begin(|| TermKind::Spent);
            tally.end(Color::ONE, Color::ONE, Color::ZERO);
        }
        color
    }

    /// What a witness is told of a shadow ray.
    fn shadow(&self, surface: &Surface, seen: &Illumination, share: Color) -> Shadow {
        let ray = self.shadow_ray(surface, seen);
        let blocker = self.world.closest(&ray, &mut ()).map(|hit| (hit.object, hit.t));
        Shadow { ray: (&ray).into(), blocker, share: share.into() }
    }

    #[inline]
    fn shadow_ray(&self, surface: &Surface, seen: &Illumination) -> Ray64 {
        let rules = self.world.rules();
        // What stands exactly at the light does not block it.
        let reach = if rules.is_official() { seen.distance } else { seen.distance * (1.0 - gamma(16)) };
        to_light(surface, seen.to_light, reach, rules.epsilon)
    }

    /// Whether a ray meets a surface on the side that its normal does not point to.
    #[inline]
    pub(crate) fn sees_back(&self, at: &Interaction) -> bool {
        let shaded = self.world.rules().has(Compat::ShadedSides);
        at.ray.dir().dot(if shaded { at.surface.n_shade } else { at.surface.n_geo }) > 0.0
    }

    /// The diffuse colour at a hit, of each material that makes it up by its share: its albedo,
    /// without any light.
    pub fn albedo(&self, at: &Interaction) -> Color {
        let parts = self.world.parts(at);
        parts.iter().map(|part| part.share * self.world.diffuse_color(part.phong, &at.surface)).sum()
    }

    /// The share of a light that arrives: nothing behind a thing, or what transparent things let
    /// through.
    fn visible<T: TraceListener>(&self, surface: &Surface, seen: &Illumination, tally: &mut T) -> Color {
        if !self.settings.shadows || seen.color == Color::ZERO {
            return Color::ONE;
        }
        let mut ray = self.shadow_ray(surface, seen);
        if self.world.rules().has(Compat::ShadowFronts) {
            let nearest = self.world.intersect(&ray, tally);
            let blocked = nearest.is_some_and(|blocker| blocker.surface.n_shade.dot(ray.dir()) <= 0.0);
            return if blocked { Color::ZERO } else { Color::ONE };
        }
        if !self.settings.transparent_shadows {
            return if self.world.occluded_along(&ray, tally) { Color::ZERO } else { Color::ONE };
        }
        let mut share = Color::ONE;
        // A thing with many layers is followed only so far.
        for _ in 0..64 {
            let Some(hit) = self.world.closest_along(&mut ray, tally) else { return share };
            // What lets nothing through need not be looked at.
            match &self.world.materials()[self.world.material_of(&hit) as usize] {
                Material::Phong(phong) if phong.transparent == Color::ZERO => break,
                _ => {}
            }
            let blocker = self.world.interaction_along(&ray, hit);
            let parts = self.world.parts(&blocker);
            share *= parts.iter().map(|part| part.share * part.phong.transparent).sum::<Color>();
            if share == Color::ZERO {
                break;
            }
            let rest = ray.rounded.t_max - blocker.hit.t;
            ray = spawn_ray(&blocker.surface, seen.to_light, rest, self.world.rules().epsilon);
        }
        Color::ZERO
    }

    /// Mirrored and transmitted light.
    fn secondary<T: TraceListener>(
        &self,
        at: &Interaction,
        Blend { mut reflective, mut transparent, fresnel, .. }: Blend,
        passage: Passage,
        path: Path,
        tally: &mut T,
    ) -> Color {
        // The normal on the ray's side.
        let Interaction { ray, surface, .. } = at;
        let leaving = self.sees_back(at);
        let [n, n_geo] = [surface.n_shade, surface.n_geo].map(|n| if leaving { -n } else { n });
        // An interpolated normal may point away from the ray; the surface itself does not.
        let n = if ray.dir().dot(n) < 0.0 { n } else { n_geo };
        // A mirror without `shade_back` reflects about the normal as it is; the direction is the
        // same.
        let mirrored = reflect(ray.dir(), n);
        // About a normal that is not of length 1 it is another one.
        let (mirrored, n) = match self.world.rules().has(Compat::RawNormals) {
            true => (mirrored.normalize_or(n_geo), n.normalize_or(n_geo)),
            false => (mirrored, n),
        };
        let Passage { here, there, .. } = passage;
        let transmitted = if transparent == Color::ZERO { None } else { refract(ray.dir(), n, here / there) };
        let total = transparent != Color::ZERO && transmitted.is_none();
        // With one of the two left out, the other has all the light.
        let divided = fresnel && self.settings.reflection && self.settings.refraction;
        // Total reflection weighs 1.
        let r = divided.then(|| {
            let zero = leaving && self.world.rules().has(Compat::ExitR0);
            transmitted.map_or(1.0, |t| fresnel_share(ray.dir(), n, t, (here, there), zero))
        });
        if let Some(r) = r {
            reflective *= r;
            transparent *= 1.0 - r;
        }
        tally.begin(|| TermKind::Secondary { here, there, fresnel: r, total });
        let mut color = Color::ZERO;
        if self.settings.reflection {
            color += self.bounce(RayKind::Reflected, surface, mirrored, reflective, path, tally);
        }
        if let Some(transmitted) = transmitted.filter(|_| self.settings.refraction) {
            let path = Path { media: &passage.behind, ..path };
            color += self.bounce(RayKind::Transmitted, surface, transmitted, transparent, path, tally);
        }
        tally.end(Color::ONE, Color::ONE, color);
        color
    }

    /// How light that may go through at a hit does; `None` where none may.
    #[inline]
    pub(crate) fn passage(&self, at: &Interaction, media: &Media) -> Option<Passage> {
        if !self.world.may_enter(at) {
            return None;
        }
        let blend = match &self.world.materials()[at.material as usize] {
            Material::Phong(phong) => Blend::of(&[WeightedMaterial { phong, share: 1.0 }]),
            Material::Solid(..) => Blend::of(&self.world.parts(at)),
        };
        if blend.transparent == Color::ZERO {
            return None;
        }
        let leaving = self.sees_back(at);
        Some(match self.world.rules().is_official() {
            true => self.official_passage(at.hit.object, blend, leaving, media),
            false => media.nested_passage(self.world, at, blend.ior, leaving),
        })
    }

    /// The course's: one index is carried along, and behind glass there is air.
    fn official_passage(&self, object: u32, blend: Blend, leaving: bool, media: &Media) -> Passage {
        let (known, ior) = (media.ior(), blend.ior);
        let (here, there) = match (leaving, blend.fresnel) {
            (true, true) if known != 1.0 || self.world.rules().has(Compat::AirAtEye) => (known, 1.0),
            (true, _) => (ior, 1.0),
            (false, true) => (known, ior),
            (false, false) => (1.0, ior),
        };
        Passage { here, there, behind: Media::only(Body { object, ior: there, size: None }), hidden: false }
    }

    /// One secondary ray, weighed by a colour.
    fn bounce<T: TraceListener>(
        &self,
        from: RayKind,
        surface: &Surface,
        dir: Vec3,
        weight: Color,
        path: Path,
        tally: &mut T,
    ) -> Color {
        if weight.max_element() <= 0.0 {
            return Color::ZERO;
        }
        // The course takes the length of the colour, which for grey is more than what is left of
        // the light.
        let old = self.world.rules().is_official();
        let total = path.weight * if old { weight.length() } else { weight.max_element() };
        if total < self.settings.least_weight {
            tally.begin(|| TermKind::Cut { weight: total });
            tally.end(weight, Color::ONE, Color::ZERO);
            return Color::ZERO;
        }
        let mut ray = spawn_ray(surface, dir, f32::INFINITY, self.world.rules().epsilon);
        tally.begin(|| TermKind::Ray { from, ray: (&ray).into(), weight: total, hit: None, bounce: None });
        let found = self.world.closest_along(&mut ray, tally);
        let color = self.trace(&ray, found, Path { bounces: path.bounces - 1, weight: total, ..path }, tally);
        tally.end(weight, Color::ONE, color);
        weight * color
    }
}

/// What a witness is told of a hit.
pub(super) fn hit_record(world: &World, at: &Interaction, n: Vec3, from_behind: bool, black: bool) -> HitRecord {
    let Interaction { ray, hit, surface, material, .. } = at;
    let object = &world.objects()[hit.object as usize];
    HitRecord {
        object: hit.object,
        part: world.triangle(hit),
        t: hit.t,
        position: surface.position,
        n_geo: surface.n_geo,
        n_shade: surface.n_shade,
        n,
        from_behind,
        black,
        uv: surface.uv.get(),
        barycentric: surface.barycentric,
        local: object.own_ray(ray).as_ref().map(Into::into),
        material: *material,
    }
}

/// What the materials of a point reflect and let through together. Weights are mixed; the index is
/// that of the part that weighs most.
#[derive(Clone, Copy)]
pub(crate) struct Blend {
    pub(crate) reflective: Color,
    pub(crate) transparent: Color,
    pub(crate) ior: f32,
    pub(crate) fresnel: bool,
}

impl Blend {
    #[inline]
    pub(crate) fn of<'a, 'w: 'a>(parts: impl IntoIterator<Item = &'a WeightedMaterial<'w>>) -> Self {
        let mut blend = Blend { reflective: Color::ZERO, transparent: Color::ZERO, ior: 1.0, fresnel: false };
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

/// The mirrored share, by Schlick's approximation: R0 + (1 - R0) (1 - c)^5; `zero` takes 0 for R0.
///
/// c is the cosine on the side of the lower index. Source: Schlick, *An Inexpensive BRDF Model for
/// Physically-based Rendering*, Eurographics 1994.
pub(crate) fn fresnel_share(dir: Vec3, n: Vec3, transmitted: Vec3, (here, there): (f32, f32), zero: bool) -> f32 {
    let ratio = (there - here) / (there + here);
    let r0 = if zero { 0.0 } else { ratio * ratio };
    let cosine = if here <= there { dir.dot(n).abs() } else { transmitted.dot(n).abs() };
    let rest = 1.0 - cosine;
    let square = rest * rest;
    r0 + (1.0 - r0) * square * square * rest
}

/// Diffuse term and highlight of one light.
#[inline(always)]
fn direct<T: TraceListener>(
    phong: &Phong,
    diffuse: Color,
    n: Vec3,
    view: Vec3,
    seen: &Illumination,
    tally: &mut T,
) -> Color {
    let cosine = n.dot(seen.to_light);
    tally.begin(|| TermKind::Diffuse { cosine });
    tally.end(Color::splat(cosine.max(0.0)), Color::ONE, diffuse);
    let mut color = cosine.max(0.0) * diffuse;
    if let Some((specular, exponent, model)) = phong.highlight {
        let base = match model {
            HighlightModel::Blinn => (cosine > 0.0).then(|| n.dot((seen.to_light - view).normalize_or_zero())),
            HighlightModel::Phong { behind } => (behind || cosine > 0.0).then(|| reflect(view, n).dot(seen.to_light)),
        };
        if let Some(base) = base {
            let strength = fp::pow(base.max(0.0), exponent);
            tally.begin(|| TermKind::Highlight { model: TermKind::highlight(model), base, exponent });
            tally.end(Color::splat(strength), Color::ONE, specular);
            color += strength * specular;
        }
    }
    color * seen.color
}

/// Snell's law: the direction behind a surface whose normal `n` is on the ray's side; `None` for
/// total reflection.
///
/// eta is the index before over the index behind; t = eta (d - n (d·n)) - n sqrt(1 - eta^2 (1 -
/// (d·n)^2)).
pub fn refract(d: Vec3, n: Vec3, eta: f32) -> Option<Vec3> {
    let cosine = d.dot(n);
    let radicand = 1.0 - eta * eta * (1.0 - cosine * cosine);
    (radicand >= 0.0).then(|| eta * (d - cosine * n) - radicand.sqrt() * n)
}

#[cfg(test)]
mod tests;
