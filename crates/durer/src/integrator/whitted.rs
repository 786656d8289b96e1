//! Whitted's recursive ray tracing: local light, a mirrored and a transmitted ray.
//!
//! Source: Turner Whitted, *An Improved Illumination Model for Shaded Display*, CACM 23(6), 1980, with the
//! terms of the course.

use super::spawn::{from_surface, to_light};
use crate::bvh::Tally;
use crate::dialect::Compat;
use crate::light::{Emitter, Illumination};
use crate::math::{Color, Ray, Vec3, fp, gamma, reflect};
use crate::shape::Surface;
use crate::world::{HighlightModel, Hit, Part, Phong, World};
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
    /// A ray that counts for less than this is not traced. A colour counts by its largest part; for old programs, by its
    /// length, as in the course.
    pub least_weight: f32,
}

impl Settings {
    /// More levels than this overflow the stack.
    pub const MOST_BOUNCES: u32 = 256;
}

/// The integrator over one world.
#[derive(Clone, Copy, Debug)]
pub struct Whitted<'w> {
    /// What is seen.
    pub world: &'w World,
    /// What is taken into account.
    pub settings: Settings,
    /// Once set, no more rays are traced, and what comes out means nothing: a pixel of many mirrors may take long.
    pub cancel: Option<&'w AtomicBool>,
}

/// What a ray carries from bounce to bounce.
#[derive(Clone, Copy)]
struct Path {
    bounces: u32,
    /// Index of refraction of what the ray runs in.
    ior: f32,
    /// How much the ray counts for in the pixel.
    weight: f32,
}

impl Whitted<'_> {
    /// The light that comes along a camera ray.
    pub fn radiance<T: Tally>(&self, ray: &Ray, tally: &mut T) -> Color {
        self.trace(ray, Path { bounces: self.settings.bounces, ior: 1.0, weight: 1.0 }, tally)
    }

    fn trace<T: Tally>(&self, ray: &Ray, path: Path, tally: &mut T) -> Color {
        match self.world.closest(ray, tally) {
            Some(hit) => self.shade(ray, &hit, path, tally),
            None => self.world.sky(ray.dir),
        }
    }

    /// The light that leaves a hit against the ray: of each material that makes it up, by its share.
    fn shade<T: Tally>(&self, ray: &Ray, hit: &Hit, path: Path, tally: &mut T) -> Color {
        let surface = self.world.surface(ray, hit);
        let from_behind = self.sees_back(ray.dir, &surface);
        let black = from_behind && !self.settings.shade_back && self.world.rules.has(Compat::BlackBacks);
        let n = if from_behind && self.settings.shade_back { -surface.n_shade } else { surface.n_shade };
        let parts = self.world.parts(hit, surface.position);
        let mut color = Color::ZERO;
        if !black {
            // A texture or noise is looked up once for all lights.
            let diffuse: SmallVec<[Color; 2]> = parts.iter().map(|p| self.diffuse_color(p.phong, &surface)).collect();
            for (part, &diffuse) in parts.iter().zip(&diffuse) {
                let met = if part.phong.ambient_textured { diffuse } else { part.phong.diffuse };
                color += part.share * self.world.ambient * met;
            }
            for light in &self.world.lights {
                let seen = light.illuminate(surface.position);
                let visible = self.visible(&surface, &seen, tally);
                if visible == Color::ZERO {
                    continue;
                }
                for (part, &diffuse) in parts.iter().zip(&diffuse) {
                    color += part.share * visible * direct(part.phong, diffuse, n, ray.dir, &seen);
                }
            }
        }
        let cancelled = self.cancel.is_some_and(|cancel| cancel.load(Relaxed));
        if path.bounces > 0 && !cancelled {
            color += self.secondary(ray, &surface, &parts, path, tally);
        }
        color
    }

    /// Whether a ray meets a surface on the side that its normal does not point to.
    fn sees_back(&self, dir: Vec3, surface: &Surface) -> bool {
        let shaded = self.world.rules.has(Compat::ShadedSides);
        dir.dot(if shaded { surface.n_shade } else { surface.n_geo }) > 0.0
    }

    /// The diffuse colour at a hit, of each material that makes it up by its share: its albedo, without any light.
    pub fn albedo(&self, hit: &Hit, surface: &Surface) -> Color {
        let parts = self.world.parts(hit, surface.position);
        parts.iter().map(|part| part.share * self.diffuse_color(part.phong, surface)).sum()
    }

    /// Noise, else texture, else the diffuse colour.
    pub(crate) fn diffuse_color(&self, phong: &Phong, surface: &Surface) -> Color {
        let texture = phong.texture.zip(surface.uv).map(|(i, uv)| self.world.textures[i as usize].at(uv));
        let noise = phong.noise.as_ref().map(|noise| noise.color(surface.position));
        noise.or(texture).unwrap_or(phong.diffuse)
    }

    /// The share of a light that arrives: nothing behind a thing, or what transparent things let through.
    fn visible<T: Tally>(&self, surface: &Surface, seen: &Illumination, tally: &mut T) -> Color {
        if !self.settings.shadows || seen.color == Color::ZERO {
            return Color::ONE;
        }
        let epsilon = self.world.rules.epsilon;
        // What stands exactly at the light does not block it.
        let reach = if self.world.rules.is_official() { seen.distance } else { seen.distance * (1.0 - gamma(16)) };
        let mut ray = to_light(surface, seen.to_light, reach, epsilon);
        if self.world.rules.has(Compat::ShadowFronts) {
            let nearest = self.world.closest(&ray, tally).map(|hit| self.world.surface(&ray, &hit));
            let blocked = nearest.is_some_and(|blocker| blocker.n_shade.dot(ray.dir) <= 0.0);
            return if blocked { Color::ZERO } else { Color::ONE };
        }
        if !self.settings.transparent_shadows {
            return if self.world.occluded(&ray, tally) { Color::ZERO } else { Color::ONE };
        }
        let mut share = Color::ONE;
        // A thing with many layers is followed only so far.
        for _ in 0..64 {
            let Some(hit) = self.world.closest(&ray, tally) else { return share };
            let blocker = self.world.surface(&ray, &hit);
            let parts = self.world.parts(&hit, blocker.position);
            share *= parts.iter().map(|part| part.share * part.phong.transparent).sum::<Color>();
            if share == Color::ZERO {
                break;
            }
            ray = from_surface(&blocker, seen.to_light, ray.t_max - hit.t, epsilon);
        }
        Color::ZERO
    }

    /// Mirrored and transmitted light.
    fn secondary<T: Tally>(&self, ray: &Ray, surface: &Surface, parts: &[Part], path: Path, tally: &mut T) -> Color {
        // Weights of a mix are mixed; its index is that of the part that weighs most.
        let (mut reflective, mut transparent, mut ior, mut most, mut fresnel) =
            (Color::ZERO, Color::ZERO, 1.0, 0.0, false);
        for &Part { phong, share } in parts {
            reflective += share * phong.reflective;
            transparent += share * phong.transparent;
            if share > most {
                (most, ior, fresnel) = (share, phong.ior, phong.fresnel);
            }
        }
        // The normal on the ray's side, and the indices before and behind the surface.
        let leaving = self.sees_back(ray.dir, surface);
        let [n, n_geo] = [surface.n_shade, surface.n_geo].map(|n| if leaving { -n } else { n });
        // An interpolated normal may point away from the ray; the surface itself does not.
        let n = if ray.dir.dot(n) < 0.0 { n } else { n_geo };
        let (here, there) = match (leaving, fresnel) {
            (true, true) if path.ior != 1.0 => (path.ior, 1.0),
            (true, _) => (ior, 1.0),
            (false, true) => (path.ior, ior),
            (false, false) => (1.0, ior),
        };
        // A mirror without `shade_back` reflects about the normal as it is; the direction is the same.
        let mirrored = reflect(ray.dir, n);
        let transmitted = if transparent == Color::ZERO { None } else { refract(ray.dir, n, here / there) };
        // With one of the two left out, the other has all the light.
        if fresnel && self.settings.reflection && self.settings.refraction {
            // Total reflection weighs 1.
            let r = transmitted.map_or(1.0, |t| self.fresnel(ray.dir, n, t, here, there));
            reflective *= r;
            transparent *= 1.0 - r;
        }
        let mut color = Color::ZERO;
        if self.settings.reflection {
            color += self.bounce(surface, mirrored, reflective, Path { ior: path.ior, ..path }, tally);
        }
        if let Some(transmitted) = transmitted.filter(|_| self.settings.refraction) {
            color += self.bounce(surface, transmitted, transparent, Path { ior: there, ..path }, tally);
        }
        color
    }

    /// One secondary ray, weighed by a colour.
    fn bounce<T: Tally>(&self, surface: &Surface, dir: Vec3, weight: Color, path: Path, tally: &mut T) -> Color {
        // The course takes the length of the colour, which for grey is more than what is left of the light.
        let old = self.world.rules.is_official();
        let total = path.weight * if old { weight.length() } else { weight.max_element() };
        if weight.max_element() <= 0.0 || total < self.settings.least_weight {
            return Color::ZERO;
        }
        let ray = from_surface(surface, dir, f32::INFINITY, self.world.rules.epsilon);
        weight * self.trace(&ray, Path { bounces: path.bounces - 1, weight: total, ..path }, tally)
    }

    /// The mirrored share, by Schlick's approximation: R0 + (1 - R0) (1 - c)^5.
    ///
    /// c is the cosine on the side of the lower index. Source: Schlick, *An Inexpensive BRDF Model for
    /// Physically-based Rendering*, Eurographics 1994.
    fn fresnel(&self, dir: Vec3, n: Vec3, transmitted: Vec3, here: f32, there: f32) -> f32 {
        let ratio = (there - here) / (there + here);
        let zero = self.world.rules.has(Compat::ExitR0) && there < here;
        let r0 = if zero { 0.0 } else { ratio * ratio };
        let cosine = if here <= there { dir.dot(n).abs() } else { transmitted.dot(n).abs() };
        let rest = 1.0 - cosine;
        let square = rest * rest;
        r0 + (1.0 - r0) * square * square * rest
    }
}

/// Diffuse term and highlight of one light.
fn direct(phong: &Phong, diffuse: Color, n: Vec3, view: Vec3, seen: &Illumination) -> Color {
    let cosine = n.dot(seen.to_light);
    let mut color = cosine.max(0.0) * diffuse;
    if let Some((specular, exponent, model)) = phong.highlight {
        let base = match model {
            HighlightModel::Blinn => (cosine > 0.0).then(|| n.dot((seen.to_light - view).normalize_or_zero())),
            HighlightModel::Phong { behind } => (behind || cosine > 0.0).then(|| reflect(view, n).dot(seen.to_light)),
        };
        if let Some(base) = base {
            color += fp::pow(base.max(0.0), exponent) * specular;
        }
    }
    color * seen.color
}

/// Snell's law: the direction behind a surface whose normal `n` is on the ray's side; `None` for total reflection.
///
/// eta is the index before over the index behind; t = eta (d - n (d·n)) - n sqrt(1 - eta^2 (1 - (d·n)^2)).
pub fn refract(d: Vec3, n: Vec3, eta: f32) -> Option<Vec3> {
    let cosine = d.dot(n);
    let radicand = 1.0 - eta * eta * (1.0 - cosine * cosine);
    (radicand >= 0.0).then(|| eta * (d - cosine * n) - radicand.sqrt() * n)
}

#[cfg(test)]
mod tests;
