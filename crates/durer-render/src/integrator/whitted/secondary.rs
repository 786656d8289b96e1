//! Mirrored and transmitted light.

use super::{Path, Whitted};
use crate::integrator::media::{Body, Media, Passage};
use crate::integrator::spawn::spawn_ray;
use crate::integrator::trace::{RayKind, TermKind, TraceListener};
use crate::world::{Interaction, Material, WeightedMaterial};
use durer_scene::math::{Color, Vec3, reflect};
use durer_scene::shape::Surface;

/// What goes on from a hit: directions, and the colours by which their light is weighed.
pub(super) struct Parted {
    pub(super) mirrored: Vec3,
    pub(super) reflective: Color,
    /// Whether something goes through: not where reflection is total, or nothing is transparent.
    pub(super) passes: bool,
    pub(super) transmitted: Vec3,
    pub(super) transparent: Color,
    /// The mirrored share, where the two divide the light by Fresnel's law.
    fresnel: Option<f32>,
}

/// What rules and settings say of how light is divided.
#[derive(Clone, Copy)]
pub(super) struct Division {
    raw_normals: bool,
    exit_r0: bool,
    /// Whether mirrored and transmitted rays are traced both.
    both: bool,
}

impl Division {
    /// How light is divided where a surface with normals for shading and of its own is met.
    #[inline(always)]
    pub(super) fn part(
        self,
        dir: Vec3,
        [n_shade, n_geo]: [Vec3; 2],
        leaving: bool,
        Blend { mut reflective, mut transparent, fresnel, .. }: Blend,
        (here, there): (f32, f32),
    ) -> Parted {
        // The normal on the ray's side.
        let (n, n_geo) = if leaving { (-n_shade, -n_geo) } else { (n_shade, n_geo) };
        // An interpolated normal may point away from the ray; the surface itself does not.
        let n = if dir.dot(n) < 0.0 { n } else { n_geo };
        // A mirror without `shade_back` reflects about the normal as it is; the direction is the
        // same.
        let mirrored = reflect(dir, n);
        // About a normal that is not of length 1 it is another one.
        let (mirrored, n) = match self.raw_normals {
            true => (mirrored.normalize_or(n_geo), n.normalize_or(n_geo)),
            false => (mirrored, n),
        };
        // All is worked out, of use or not: so compilers do it side by side for several hits.
        let (transmitted, passes) = match refract(dir, n, here / there) {
            Some(transmitted) => (transmitted, transparent != Color::ZERO),
            None => (Vec3::ZERO, false),
        };
        let share = fresnel_share(dir, n, transmitted, (here, there), leaving && self.exit_r0);
        // Total reflection weighs 1.
        let share = if passes { share } else { 1.0 };
        // With one of the two left out, the other has all the light.
        let divided = fresnel && self.both;
        if divided {
            reflective *= share;
            transparent *= 1.0 - share;
        }
        let fresnel = if divided { Some(share) } else { None };
        Parted { mirrored, reflective, passes, transmitted, transparent, fresnel }
    }
}

impl Whitted<'_> {
    /// Mirrored and transmitted light.
    pub(super) fn secondary<T: TraceListener>(
        &self,
        at: &Interaction,
        blend: Blend,
        passage: Passage,
        path: Path,
        tally: &mut T,
    ) -> Color {
        let parted = self.parted(at, blend, &passage);
        let total = blend.transparent != Color::ZERO && !parted.passes;
        let Passage { here, there, .. } = passage;
        let node = tally.begin(path.node, || TermKind::Secondary { here, there, fresnel: parted.fresnel, total });
        let path = Path { node, ..path };
        let mut color = Color::ZERO;
        if let Some((dir, weight)) = self.mirrored(&parted) {
            color += self.bounce(RayKind::Reflected, &at.surface, dir, weight, path, tally);
        }
        if let Some((dir, weight)) = self.transmitted(&parted) {
            let path = Path { media: &passage.behind, ..path };
            color += self.bounce(RayKind::Transmitted, &at.surface, dir, weight, path, tally);
        }
        tally.end(node, Color::ONE, Color::ONE, color);
        color
    }

    /// The mirrored ray's direction and weight, if it is asked for.
    fn mirrored(&self, parted: &Parted) -> Option<(Vec3, Color)> {
        self.settings.reflection.then_some((parted.mirrored, parted.reflective))
    }

    /// The same of the transmitted one.
    fn transmitted(&self, parted: &Parted) -> Option<(Vec3, Color)> {
        (parted.passes && self.settings.refraction).then_some((parted.transmitted, parted.transparent))
    }

    /// How light is divided at a hit.
    #[inline(always)]
    fn parted(&self, at: &Interaction, blend: Blend, &Passage { here, there, .. }: &Passage) -> Parted {
        let normals = [at.surface.n_shade, at.surface.n_geo];
        self.division().part(at.ray.dir(), normals, self.sees_back(at), blend, (here, there))
    }

    /// What divides light.
    pub(super) fn division(&self) -> Division {
        let (rules, settings) = (self.world.shading_rules(), &self.settings);
        Division {
            raw_normals: rules.raw_normals,
            exit_r0: rules.exit_r0,
            both: settings.reflection && settings.refraction,
        }
    }

    /// How light that may go through at a hit does; `None` where none may.
    #[inline]
    pub fn passage(&self, at: &Interaction, media: &Media) -> Option<Passage> {
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
        Some(self.passage_through(at.hit.object, at.ray.rounded.origin, blend, self.sees_back(at), media))
    }

    /// How light goes through the surface of an object, which it sets out for from a point.
    #[inline]
    pub(super) fn passage_through(
        &self,
        object: u32,
        start: Vec3,
        blend: Blend,
        leaving: bool,
        media: &Media,
    ) -> Passage {
        match self.world.shading_rules().one_medium {
            true => self.official_passage(object, blend, leaving, media),
            false => media.passage_into(self.world, (object, start), blend.ior, leaving),
        }
    }

    /// The course's: one index is carried along, and behind glass there is air.
    fn official_passage(&self, object: u32, blend: Blend, leaving: bool, media: &Media) -> Passage {
        let (known, ior) = (media.ior(), blend.ior);
        let (here, there) = match (leaving, blend.fresnel) {
            (true, true) if known != 1.0 || self.world.shading_rules().air_at_eye => (known, 1.0),
            (true, _) => (ior, 1.0),
            (false, true) => (known, ior),
            (false, false) => (1.0, ior),
        };
        Passage { here, there, behind: Media::only(Body { object, ior: there, size: None }), hidden: false }
    }

    /// How much a ray counts for that a colour weighs. The course takes the length of the colour,
    /// which for grey is more than what is left of the light.
    pub fn weight_after(&self, before: f32, weight: Color) -> f32 {
        let by_length = self.world.shading_rules().weight_by_length;
        before * if by_length { weight.length() } else { weight.max_element() }
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
        let total = self.weight_after(path.weight, weight);
        if total < self.settings.least_weight {
            let node = tally.begin(path.node, || TermKind::Cut { weight: total });
            tally.end(node, weight, Color::ONE, Color::ZERO);
            return Color::ZERO;
        }
        let mut ray = spawn_ray(surface, dir, f32::INFINITY, self.world.shading_rules().epsilon);
        let node = tally.begin(path.node, || TermKind::Ray {
            from,
            ray: (&ray).into(),
            weight: total,
            hit: None,
            bounce: None,
        });
        let found = self.world.closest_along(&mut ray, tally);
        let color = self.trace(&ray, found, Path { bounces: path.bounces - 1, weight: total, node, ..path }, tally);
        tally.end(node, weight, Color::ONE, color);
        weight * color
    }
}

/// Reflectance and transmittance of all materials at a point, weighted by their shares. The index
/// of refraction is that of the material with the largest share.
#[derive(Clone, Copy)]
pub struct Blend {
    /// Fraction of the light that a mirror reflects, per channel.
    pub reflective: Color,
    /// Fraction of the light that passes through, per channel.
    pub transparent: Color,
    /// Index of refraction.
    pub ior: f32,
    /// Whether Schlick's Fresnel term splits the light between the two.
    pub fresnel: bool,
}

impl Blend {
    /// Blends the materials of a point.
    #[inline]
    pub fn of<'a, 'w: 'a>(parts: impl IntoIterator<Item = &'a WeightedMaterial<'w>>) -> Self {
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
#[inline(always)]
pub fn fresnel_share(dir: Vec3, n: Vec3, transmitted: Vec3, (here, there): (f32, f32), zero: bool) -> f32 {
    let ratio = (there - here) / (there + here);
    let r0 = if zero { 0.0 } else { ratio * ratio };
    let cosine = if here <= there { dir.dot(n).abs() } else { transmitted.dot(n).abs() };
    let rest = 1.0 - cosine;
    let square = rest * rest;
    r0 + (1.0 - r0) * square * square * rest
}

/// Snell's law: the direction behind a surface whose normal `n` is on the ray's side; `None` for
/// total reflection.
///
/// eta is the index before over the index behind; t = eta (d - n (d·n)) - n sqrt(1 - eta^2 (1 -
/// (d·n)^2)).
#[inline(always)]
pub fn refract(d: Vec3, n: Vec3, eta: f32) -> Option<Vec3> {
    let cosine = d.dot(n);
    let radicand = 1.0 - eta * eta * (1.0 - cosine * cosine);
    if radicand >= 0.0 { Some(eta * (d - cosine * n) - radicand.sqrt() * n) } else { None }
}
