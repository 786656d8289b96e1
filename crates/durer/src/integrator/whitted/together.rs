//! Camera rays that are neighbours, and what becomes of them: what rays of one depth hit, and what
//! lamps see of that, is asked for together.

use super::direct::direct;
use super::secondary::Blend;
use super::{Path, Side, Whitted};
use crate::dialect::Compat;
use crate::integrator::media::{Media, Passage};
use crate::integrator::spawn::spawn_ray;
use crate::integrator::trace::TraceListener;
use crate::math::{Color, Ray, Ray64, Vec3};
use crate::sampler::SampleId;
use crate::world::{Hit, Interaction, Material, Phong, TOGETHER, WeightedMaterial};
use smallvec::SmallVec;
use std::cell::RefCell;

/// Of more lamps, what waits for them would be more than is near.
const MOST_LAMPS: usize = 16;

/// Fewer rays are followed one by one.
const FEWEST: usize = 3;

/// A hit whose lamps and rays that go on are not known yet.
struct Waiting {
    /// The number of its ray.
    ray: usize,
    /// Where what it scatters ends in the list of all.
    lit: usize,
    /// Where its rays that go on end in the list of all; `None` where none do.
    branches: Option<usize>,
}

/// What a hit scatters of a lamp.
struct Lit {
    /// The lamp's number.
    lamp: usize,
    /// The ray that asks what is in the way.
    shadow: Ray64,
    to_light: Vec3,
    light: Color,
}

/// Rays that go on from hits.
#[derive(Default)]
struct Branches {
    rays: Vec<Ray64>,
    /// The number of the camera ray from which each comes.
    cameras: Vec<usize>,
    /// What each runs in.
    media: Vec<Media>,
    /// How much each counts for in the pixel.
    weights: Vec<f32>,
    /// The colour that weighs the light of each, and once that is known, what it brings.
    lights: Vec<Color>,
}

/// What is used anew for each few rays of one depth.
#[derive(Default)]
struct Level {
    waiting: Vec<Waiting>,
    lit: Vec<Lit>,
    shadows: Vec<Ray64>,
    branches: Branches,
}

thread_local! {
    /// By depth.
    static LEVELS: RefCell<Vec<Level>> = RefCell::default();
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
        let mut levels = LEVELS.take();
        levels.resize_with(levels.len().max(self.settings.bounces as usize + 1), Level::default);
        let air = Media::default();
        for (part, (rays, colors)) in rays.chunks(TOGETHER).zip(colors.chunks_mut(TOGETHER)).enumerate() {
            let along: SmallVec<[Ray64; TOGETHER]> = rays.iter().map(|(ray, _)| Ray64::from(ray)).collect();
            let path = |i: usize| (TOGETHER * part + i, self.camera_path(&air));
            self.light_level(&along, path, &begin, &mut levels, tally, |i, color| colors[i] = color);
        }
        LEVELS.set(levels);
    }

    /// The light along not more than [`TOGETHER`] rays of one depth. `path` says from which camera
    /// ray each comes, and what it carries; `take` gets the light of each; `levels` are of this
    /// depth and those below.
    fn light_level<'a, T: TraceListener>(
        &self,
        rays: &[Ray64],
        path: impl Fn(usize) -> (usize, Path<'a>),
        begin: &impl Fn(usize),
        levels: &mut [Level],
        tally: &mut T,
        mut take: impl FnMut(usize, Color),
    ) {
        let Some((Level { waiting, lit, shadows, branches }, deeper)) = levels.split_first_mut() else { return };
        waiting.clear();
        lit.clear();
        branches.clear();
        let (mut hits, mut colors) = ([None; TOGETHER], [Color::ZERO; TOGETHER]);
        self.world.closest_together(rays, &mut hits[..rays.len()]);
        let mut at = Interaction::NOWHERE;
        for (i, ray) in rays.iter().enumerate() {
            let (camera, path) = path(i);
            begin(camera);
            tally.ray();
            let Some((hit, phong)) = hits[i].and_then(|hit| Some((hit, self.plain(&hit)?))) else {
                colors[i] = self.trace(ray, hits[i], path, tally);
                continue;
            };
            self.world.meet(ray, hit, &mut at);
            let passage = self.passage(&at, path.media);
            if passage.as_ref().is_some_and(|passage| passage.hidden) {
                colors[i] = self.trace(ray, hits[i], path, tally);
                continue;
            }
            colors[i] = self.unshadowed(&at, phong, lit, tally);
            let blend = Blend::of(&[WeightedMaterial { phong, share: 1.0 }]);
            let parts = self.goes_on(path) && (blend.reflective != Color::ZERO || blend.transparent != Color::ZERO);
            let branches = parts.then(|| {
                self.branch(&at, blend, passage.unwrap_or_default(), path, branches);
                branches.cameras.resize(branches.rays.len(), camera);
                branches.rays.len()
            });
            waiting.push(Waiting { ray: i, lit: lit.len(), branches });
        }
        self.ask_lamps(lit, shadows, tally);
        if !branches.rays.is_empty() {
            self.follow(branches, begin, deeper, path(0).1.bounces - 1, tally);
        }
        let (mut first_lit, mut first_branch) = (0, 0);
        for waiting in waiting.iter() {
            let color = &mut colors[waiting.ray];
            lit[first_lit..waiting.lit].iter().for_each(|lit| *color += lit.light);
            first_lit = waiting.lit;
            if let Some(end) = waiting.branches {
                *color += branches.lights[first_branch..end].iter().fold(Color::ZERO, |sum, light| sum + *light);
                first_branch = end;
            }
        }
        (0..rays.len()).for_each(|i| take(i, colors[i]));
    }

    /// What a hit is made of, if its lamps can be asked about together with those of others.
    fn plain(&self, hit: &Hit) -> Option<&Phong> {
        let waits = self.settings.shadows
            && self.world.lights().len() <= MOST_LAMPS
            && !self.world.rules().has(Compat::ShadowFronts);
        match &self.world.materials()[self.world.material_of(hit) as usize] {
            Material::Phong(phong) if waits => Some(phong),
            _ => None,
        }
    }

    /// Ambient light at a hit; what it scatters of each lamp if nothing is in the way is added to a
    /// list.
    #[inline]
    fn unshadowed<T: TraceListener>(
        &self,
        at: &Interaction,
        phong: &Phong,
        lit: &mut Vec<Lit>,
        tally: &mut T,
    ) -> Color {
        let Side { n, black, .. } = self.side(at);
        if black {
            return Color::ZERO;
        }
        let diffuse = self.world.diffuse_color(phong, &at.surface);
        for lamp in 0..self.world.lights().len() {
            let seen = self.world.illuminate(lamp, at.surface.point());
            let light = direct(phong, diffuse, n, at.ray.dir(), &seen, tally);
            if light != Color::ZERO {
                lit.push(Lit { lamp, shadow: self.shadow_ray(&at.surface, &seen), to_light: seen.to_light, light });
            }
        }
        self.world.ambient() * phong.ambient.unwrap_or(diffuse)
    }

    /// Adds the rays that go on from a hit to a list.
    fn branch(&self, at: &Interaction, blend: Blend, passage: Passage, path: Path, branches: &mut Branches) {
        let parted = self.parted(at, blend, &passage);
        let mut add = |(dir, color): (Vec3, Color), media: Media| {
            let weight = self.weight_after(path.weight, color);
            if color.max_element() > 0.0 && weight >= self.settings.least_weight {
                let ray = spawn_ray(&at.surface, dir, f32::INFINITY, self.world.rules().epsilon);
                branches.rays.push(ray);
                branches.media.push(media);
                branches.weights.push(weight);
                branches.lights.push(color);
            }
        };
        if let Some(mirrored) = self.mirrored(&parted) {
            add(mirrored, path.media.clone());
        }
        if let Some(transmitted) = self.transmitted(&parted) {
            add(transmitted, passage.behind);
        }
    }

    /// Takes from what is scattered what does not arrive.
    fn ask_lamps<T: TraceListener>(&self, lit: &mut [Lit], shadows: &mut Vec<Ray64>, tally: &mut T) {
        lit.iter().for_each(|_| tally.ray());
        // Rays to one lamp are the most alike.
        for lamp in 0..self.world.lights().len() {
            shadows.clear();
            shadows.extend(lit.iter().filter(|lit| lit.lamp == lamp).map(|lit| lit.shadow));
            let of_lamp = lit.iter_mut().filter(|lit| lit.lamp == lamp);
            if self.settings.transparent_shadows {
                let mut hits = [None; TOGETHER];
                self.world.closest_together(shadows, &mut hits[..shadows.len()]);
                for (lit, hit) in of_lamp.zip(hits) {
                    let share = self.let_through(lit.shadow, hit, lit.to_light, tally);
                    lit.light = if share == Color::ZERO { Color::ZERO } else { share * lit.light };
                }
            } else {
                let mut blocked = [false; TOGETHER];
                self.world.occluded_together(shadows, &mut blocked[..shadows.len()]);
                for (lit, blocked) in of_lamp.zip(blocked) {
                    lit.light = if blocked { Color::ZERO } else { lit.light };
                }
            }
        }
    }

    /// Finds the light along rays that go on.
    fn follow<T: TraceListener>(
        &self,
        branches: &mut Branches,
        begin: &impl Fn(usize),
        levels: &mut [Level],
        bounces: u32,
        tally: &mut T,
    ) {
        let Branches { rays, cameras, media, weights, lights } = branches;
        for (part, (rays, lights)) in rays.chunks_mut(TOGETHER).zip(lights.chunks_mut(TOGETHER)).enumerate() {
            let path = |i: usize| {
                let i = TOGETHER * part + i;
                (cameras[i], Path { bounces, media: &media[i], weight: weights[i] })
            };
            if rays.len() >= FEWEST {
                self.light_level(rays, path, begin, levels, tally, |i, light| lights[i] *= light);
                continue;
            }
            for (i, (ray, light)) in rays.iter_mut().zip(lights).enumerate() {
                let (camera, path) = path(i);
                begin(camera);
                let found = self.world.closest_along(ray, tally);
                *light *= self.trace(ray, found, path, tally);
            }
        }
    }
}

impl Branches {
    fn clear(&mut self) {
        self.rays.clear();
        self.cameras.clear();
        self.media.clear();
        self.weights.clear();
        self.lights.clear();
    }
}
