//! Camera rays that are neighbours: what they hit, and whether lamps see it, is asked for together.

use super::direct::direct;
use super::secondary::Blend;
use super::{Side, Whitted};
use crate::dialect::Compat;
use crate::integrator::media::{Media, Passage};
use crate::integrator::trace::TraceListener;
use crate::math::{Color, Ray, Ray64};
use crate::sampler::SampleId;
use crate::world::{Interaction, Material, Phong, TOGETHER, WeightedMaterial};
use std::cell::RefCell;

/// Of more lamps, what waits for them would be more than is near.
const MOST_LAMPS: usize = 16;

/// A hit whose lamps are not known yet to see it.
struct Waiting {
    /// The number of its ray.
    ray: usize,
    /// Where its shadow rays end in the list of all.
    end: usize,
    /// Its number in the list of those that mirror.
    mirror: Option<usize>,
}

/// What a hit scatters of a lamp.
struct Lit {
    /// The lamp's number.
    lamp: usize,
    /// The ray that asks whether anything is in the way.
    shadow: Ray64,
    light: Color,
}

/// What is used anew for each few rays, one a thread.
#[derive(Default)]
struct Scratch {
    along: Vec<Ray64>,
    waiting: Vec<Waiting>,
    mirrors: Vec<(Interaction, Blend)>,
    lit: Vec<Lit>,
    shadows: Vec<Ray64>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

impl Whitted<'_> {
    /// The light along each of some camera rays, with the same bits as [`Whitted::radiance`].
    pub(super) fn light_together<T: TraceListener>(
        &self,
        rays: &[(Ray, SampleId)],
        begin: impl Fn(usize),
        tally: &mut T,
        colors: &mut [Color],
    ) {
        if T::LISTENS || T::COUNTS_WORK || !self.world.answers_together() {
            for (i, ((ray, _), color)) in rays.iter().zip(colors).enumerate() {
                begin(i);
                *color = self.radiance(ray, tally);
            }
            return;
        }
        let mut scratch = SCRATCH.take();
        for (part, (rays, colors)) in rays.chunks(TOGETHER).zip(colors.chunks_mut(TOGETHER)).enumerate() {
            self.light_few(rays, |i| begin(TOGETHER * part + i), tally, colors, &mut scratch);
        }
        SCRATCH.set(scratch);
    }

    /// Of not more than [`TOGETHER`].
    fn light_few<T: TraceListener>(
        &self,
        rays: &[(Ray, SampleId)],
        begin: impl Fn(usize),
        tally: &mut T,
        colors: &mut [Color],
        Scratch { along, waiting, mirrors, lit, shadows }: &mut Scratch,
    ) {
        waiting.clear();
        mirrors.clear();
        lit.clear();
        along.clear();
        along.extend(rays.iter().map(|(ray, _)| Ray64::from(ray)));
        let mut hits = [None; TOGETHER];
        self.world.closest_together(along, &mut hits[..rays.len()]);
        let air = Media::default();
        let path = self.camera_path(&air);
        let waits = self.settings.shadows
            && self.world.lights().len() <= MOST_LAMPS
            && !self.settings.transparent_shadows
            && !self.world.rules().has(Compat::ShadowFronts);
        for (i, ray) in along.iter().enumerate() {
            begin(i);
            tally.ray();
            let opaque = hits[i].filter(|_| waits).and_then(|hit| {
                match &self.world.materials()[self.world.material_of(&hit) as usize] {
                    Material::Phong(phong) if phong.transparent == Color::ZERO => Some((hit, phong)),
                    _ => None,
                }
            });
            let Some((hit, phong)) = opaque else {
                colors[i] = self.trace(ray, hits[i], path, tally);
                continue;
            };
            let at = self.world.interaction_along(ray, hit);
            colors[i] = self.unshadowed(&at, phong, tally, |lamp, shadow, light| {
                lit.push(Lit { lamp, shadow, light });
            });
            let mirror = (phong.reflective != Color::ZERO).then(|| {
                mirrors.push((at, Blend::of(&[WeightedMaterial { phong, share: 1.0 }])));
                mirrors.len() - 1
            });
            waiting.push(Waiting { ray: i, end: lit.len(), mirror });
        }
        lit.iter().for_each(|_| tally.ray());
        // Rays to one lamp are the most alike.
        for lamp in 0..self.world.lights().len() {
            shadows.clear();
            shadows.extend(lit.iter().filter(|lit| lit.lamp == lamp).map(|lit| lit.shadow));
            let mut blocked = [false; TOGETHER];
            self.world.occluded_together(shadows, &mut blocked[..shadows.len()]);
            for (lit, blocked) in lit.iter_mut().filter(|lit| lit.lamp == lamp).zip(blocked) {
                lit.light = if blocked { Color::ZERO } else { lit.light };
            }
        }
        let mut start = 0;
        for Waiting { ray, end, mirror } in waiting.iter() {
            begin(*ray);
            let color = &mut colors[*ray];
            lit[start..*end].iter().for_each(|lit| *color += lit.light);
            start = *end;
            if let Some((at, blend)) = mirror.map(|i| &mirrors[i]).filter(|_| self.goes_on(path)) {
                *color += self.secondary(at, *blend, Passage::default(), path, tally);
            }
        }
    }

    /// Ambient light at a hit; and the light of each lamp that it scatters if nothing is in the
    /// way, with the ray that asks for that.
    #[inline]
    fn unshadowed<T: TraceListener>(
        &self,
        at: &Interaction,
        phong: &Phong,
        tally: &mut T,
        mut offer: impl FnMut(usize, Ray64, Color),
    ) -> Color {
        let Side { n, black, .. } = self.side(at);
        if black {
            return Color::ZERO;
        }
        let diffuse = self.world.diffuse_color(phong, &at.surface);
        for number in 0..self.world.lights().len() {
            let seen = self.world.illuminate(number, at.surface.point());
            let light = direct(phong, diffuse, n, at.ray.dir(), &seen, tally);
            if light != Color::ZERO {
                offer(number, self.shadow_ray(&at.surface, &seen), light);
            }
        }
        self.world.ambient() * phong.ambient.unwrap_or(diffuse)
    }
}
