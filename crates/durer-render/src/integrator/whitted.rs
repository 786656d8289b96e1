//! Whitted's recursive ray tracing: local light, a mirrored and a transmitted ray.
//!
//! Source: Turner Whitted, *An Improved Illumination Model for Shaded Display*, CACM 23(6), 1980,
//! with the terms of the course.

use super::media::{Media, Passage};
use super::trace::{HitRecord, NodeId, RayKind, TermKind, TraceListener};
use super::{Integrate, Parameters, Setup};
use crate::world::{Hit, Interaction, Material, WeightedMaterial, World};
use direct::direct;
use durer_scene::describe::described;
use durer_scene::dialect::set;
use durer_scene::math::{Color, Ray, Ray64, Vec3};
use durer_scene::sampler::SampleId;
use secondary::Blend;
pub use secondary::refract;
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
    /// The ray's node in the trace.
    node: NodeId,
}

/// One of the materials that make up a point, and what was worked out of it.
struct Lit<'w> {
    part: WeightedMaterial<'w>,
    /// A texture or noise is looked up once for all lights.
    diffuse: Color,
    /// What it scatters of the light that is asked for.
    scattered: Color,
}

/// The side of a surface that is shaded.
struct Side {
    /// The normal that light is reckoned with.
    n: Vec3,
    from_behind: bool,
    /// Whether an old program leaves it black.
    black: bool,
}

/// What rules and settings say of the side that is shaded.
#[derive(Clone, Copy)]
struct Facing {
    shaded_sides: bool,
    black_backs: bool,
    unit: bool,
    shade_back: bool,
}

impl Facing {
    /// The side on which a surface with normals for shading and of its own is seen.
    #[inline(always)]
    fn side(self, dir: Vec3, [n_shade, n_geo]: [Vec3; 2]) -> Side {
        let from_behind = dir.dot(if self.shaded_sides { n_shade } else { n_geo }) > 0.0;
        let black = from_behind && self.black_backs;
        let n = if from_behind && self.shade_back { -n_shade } else { n_shade };
        let n = if self.unit { n.normalize_or(n) } else { n };
        Side { n, from_behind, black }
    }
}

impl Integrate for Whitted<'_> {
    fn radiance<T: TraceListener>(&self, ray: &Ray, _: SampleId, tally: &mut T) -> Color {
        self.radiance(ray, tally)
    }

    fn radiances<T: TraceListener>(
        &self,
        rays: &[Ray64],
        begin: impl Fn(usize) -> SampleId,
        tally: &mut T,
        colors: &mut [Color],
    ) {
        self.light_together(rays, begin, tally, colors);
    }
}

impl<'w> Whitted<'w> {
    /// The light that comes along a camera ray.
    pub fn radiance<T: TraceListener>(&self, ray: &Ray, tally: &mut T) -> Color {
        let mut along = ray.into();
        let node = tally.begin(NodeId::ROOT, || TermKind::Ray {
            from: RayKind::Camera,
            ray: ray.into(),
            weight: 1.0,
            hit: None,
            bounce: None,
        });
        let found = self.world.closest_along(&mut along, tally);
        let path = Path { bounces: self.settings.bounces, media: &Media::default(), weight: 1.0, node };
        let color = self.trace(&along, found, path, tally);
        tally.end(node, Color::ONE, Color::ONE, color);
        color
    }

    /// The light along a ray that has hit this first.
    fn trace<T: TraceListener>(&self, ray: &Ray64, mut found: Option<Hit>, path: Path, tally: &mut T) -> Color {
        // What it runs in behind surfaces that are none.
        let mut inside = None;
        let mut at = Interaction::NOWHERE;
        while let Some(hit) = found {
            self.world.meet(ray, hit, &mut at);
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
        let node = tally.begin(path.node, || TermKind::Sky);
        tally.end(node, Color::ONE, Color::ONE, sky);
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
        let Side { n, from_behind, black } = self.side(at);
        tally.hit(path.node, || HitRecord::new(self.world, at, n, from_behind, black));
        let mut color = Color::ZERO;
        if !black {
            for Lit { part, diffuse, .. } in all.iter() {
                let met = part.phong.ambient.unwrap_or(*diffuse);
                let ambient = part.share * self.world.ambient();
                let node = tally.begin(path.node, || TermKind::Ambient { share: part.share });
                tally.end(node, ambient, Color::ONE, met);
                color += ambient * met;
            }
            for number in 0..self.world.lights().len() {
                let seen = self.world.illuminate(number, surface.point());
                // Where nothing of a light would be scattered, nobody asks whether it arrives.
                if !T::LISTENS {
                    let mut dark = true;
                    for Lit { part, diffuse, scattered } in all.iter_mut() {
                        *scattered = direct(part.phong, *diffuse, n, ray.dir(), &seen, NodeId::NONE, tally);
                        dark &= *scattered == Color::ZERO;
                    }
                    if dark {
                        continue;
                    }
                }
                let visible = self.visible(surface, &seen, tally);
                for Lit { part, diffuse, scattered } in all.iter() {
                    let share = part.share;
                    let node = tally.begin(path.node, || {
                        let shadow = self.settings.shadows.then(|| self.shadow(surface, &seen, visible));
                        let (to_light, distance) = (seen.to_light, seen.distance);
                        TermKind::Light { light: number, to_light, distance, share, shadow }
                    });
                    // In the dark nothing is computed.
                    let direct = match visible == Color::ZERO {
                        true => Color::ZERO,
                        false if T::LISTENS => direct(part.phong, *diffuse, n, ray.dir(), &seen, node, tally),
                        false => *scattered,
                    };
                    tally.end(node, share * visible, seen.color, direct);
                    color += share * visible * direct;
                }
            }
        }
        if self.goes_on(path.bounces) {
            let blend = Blend::of(all.iter().map(|lit| &lit.part));
            color += match blend.reflective == Color::ZERO && blend.transparent == Color::ZERO {
                true => Color::ZERO,
                false => self.secondary(at, blend, passage.unwrap_or_default(), path, tally),
            };
        } else if all.iter().any(|Lit { part, .. }| part.phong.reflective + part.phong.transparent != Color::ZERO) {
            let node = tally.begin(path.node, || TermKind::Spent);
            tally.end(node, Color::ONE, Color::ONE, Color::ZERO);
        }
        color
    }

    /// Whether mirrored and transmitted rays are traced yet.
    fn goes_on(&self, bounces: u32) -> bool {
        bounces > 0 && !self.cancel.is_some_and(|cancel| cancel.load(Relaxed))
    }

    /// The side of a surface that is shaded.
    #[inline(always)]
    fn side(&self, at: &Interaction) -> Side {
        self.facing().side(at.ray.dir(), [at.surface.n_shade, at.surface.n_geo])
    }

    /// What decides which side of a surface is shaded.
    fn facing(&self) -> Facing {
        let (rules, shade_back) = (self.world.shading_rules(), self.settings.shade_back);
        Facing {
            shaded_sides: rules.shaded_sides,
            black_backs: !shade_back && rules.black_backs,
            unit: rules.unit_light,
            shade_back,
        }
    }

    /// Whether a ray meets a surface on the side that its normal does not point to.
    #[inline]
    pub fn sees_back(&self, at: &Interaction) -> bool {
        let shaded = self.world.shading_rules().shaded_sides;
        at.ray.dir().dot(if shaded { at.surface.n_shade } else { at.surface.n_geo }) > 0.0
    }

    /// The diffuse colour at a hit, of each material that makes it up by its share: its albedo,
    /// without any light.
    pub fn albedo(&self, at: &Interaction) -> Color {
        let parts = self.world.parts(at);
        parts.iter().map(|part| part.share * self.world.diffuse_color(part.phong, &at.surface)).sum()
    }
}

mod branches;
mod direct;
mod lamps;
pub mod secondary;
#[cfg(test)]
mod tests;
mod together;
