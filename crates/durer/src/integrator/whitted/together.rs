//! Camera rays that are neighbours, and what becomes of them: what rays of one depth hit, and what
//! lamps see of that, is asked for together.

use super::lamps::LampHits;
use super::secondary::Blend;
use super::{Path, Whitted};
use crate::dialect::Compat;
use crate::integrator::media::{Media, Passage};
use crate::integrator::spawn::spawn_ray;
use crate::integrator::trace::TraceListener;
use crate::math::{Color, Ray, Ray64};
use crate::sampler::SampleId;
use crate::world::{Hit, Interaction, Material, Phong, TOGETHER, WeightedMaterial};
use smallvec::SmallVec;
use std::cell::RefCell;

/// Fewer rays are followed one by one.
const FEWEST: usize = 3;

/// A hit whose rays that go on are not known yet.
struct Waiting {
    /// The number of its ray.
    ray: usize,
    /// Where its rays that go on end in the list of all.
    branches: usize,
}

/// Rays that go on from hits.
#[derive(Default)]
struct Branches {
    rays: Vec<Ray64>,
    carried: Vec<Carried>,
    /// The colour that weighs the light of each, and once that is known, what it brings.
    lights: Vec<Color>,
}

/// What a ray that goes on carries.
struct Carried {
    /// The number of the camera ray from which it comes.
    camera: usize,
    /// What it runs in.
    media: Media,
    /// How much it counts for in the pixel.
    weight: f32,
}

/// What is used anew for each few rays of one depth.
#[derive(Default)]
struct Level {
    waiting: Vec<Waiting>,
    branches: Branches,
}

/// What is used anew for each few camera rays, one a thread.
#[derive(Default)]
struct Scratch {
    /// By depth.
    levels: Vec<Level>,
    /// Of one depth after the other.
    lit: LampHits,
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
        let air = Media::default();
        SCRATCH.with_borrow_mut(|Scratch { levels, lit }| {
            levels.resize_with(levels.len().max(self.settings.bounces as usize + 1), Level::default);
            for (part, (rays, colors)) in rays.chunks(TOGETHER).zip(colors.chunks_mut(TOGETHER)).enumerate() {
                let along: SmallVec<[Ray64; TOGETHER]> = rays.iter().map(|(ray, _)| Ray64::from(ray)).collect();
                let path = |i: usize| (TOGETHER * part + i, self.camera_path(&air));
                self.light_level(&along, path, &begin, (levels, lit), tally, |i, color| colors[i] = color);
            }
        });
    }

    /// The light along not more than [`TOGETHER`] rays of one depth. `path` says from which camera
    /// ray each comes, and what it carries; `take` gets the light of each; `levels` are of this
    /// depth and those below.
    fn light_level<'a, T: TraceListener>(
        &self,
        rays: &[Ray64],
        path: impl Fn(usize) -> (usize, Path<'a>),
        begin: &impl Fn(usize),
        (levels, lit): (&mut [Level], &mut LampHits),
        tally: &mut T,
        mut take: impl FnMut(usize, Color),
    ) {
        let Some((Level { waiting, branches }, deeper)) = levels.split_first_mut() else { return };
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
            colors[i] = self.unlit(&at, phong, i, lit);
            let blend = Blend::of(&[WeightedMaterial { phong, share: 1.0 }]);
            if self.goes_on(path) && (blend.reflective != Color::ZERO || blend.transparent != Color::ZERO) {
                self.branch(&at, blend, passage.unwrap_or_default(), camera, path, branches);
                waiting.push(Waiting { ray: i, branches: branches.rays.len() });
            }
        }
        (0..self.world.lights().len()).for_each(|lamp| self.add_lamp(lamp, lit, &mut colors, tally));
        if !branches.rays.is_empty() {
            self.follow(branches, begin, (deeper, lit), path(0).1.bounces - 1, tally);
        }
        let mut first = 0;
        for &Waiting { ray, branches: end } in waiting.iter() {
            colors[ray] += branches.lights[first..end].iter().fold(Color::ZERO, |sum, light| sum + *light);
            first = end;
        }
        (0..rays.len()).for_each(|i| take(i, colors[i]));
    }

    /// What a hit is made of, if its lamps can be asked about together with those of others.
    fn plain(&self, hit: &Hit) -> Option<&Phong> {
        let waits = self.settings.shadows && !self.world.rules().has(Compat::ShadowFronts);
        match &self.world.materials()[self.world.material_of(hit) as usize] {
            Material::Phong(phong) if waits => Some(phong),
            _ => None,
        }
    }

    /// Adds the rays that go on from a hit to a list.
    #[inline(always)]
    fn branch(
        &self,
        at: &Interaction,
        blend: Blend,
        passage: Passage,
        camera: usize,
        path: Path,
        branches: &mut Branches,
    ) {
        let parted = self.parted(at, blend, &passage);
        let ways = [
            self.mirrored(&parted).map(|mirrored| (mirrored, path.media)),
            self.transmitted(&parted).map(|transmitted| (transmitted, &passage.behind)),
        ];
        for ((dir, color), media) in ways.into_iter().flatten() {
            let weight = self.weight_after(path.weight, color);
            if color.max_element() > 0.0 && weight >= self.settings.least_weight {
                branches.rays.push(spawn_ray(&at.surface, dir, f32::INFINITY, self.world.rules().epsilon));
                branches.carried.push(Carried { camera, media: media.clone(), weight });
                branches.lights.push(color);
            }
        }
    }

    /// Finds the light along rays that go on.
    fn follow<T: TraceListener>(
        &self,
        branches: &mut Branches,
        begin: &impl Fn(usize),
        (levels, lit): (&mut [Level], &mut LampHits),
        bounces: u32,
        tally: &mut T,
    ) {
        let Branches { rays, carried, lights } = branches;
        for (part, (rays, lights)) in rays.chunks_mut(TOGETHER).zip(lights.chunks_mut(TOGETHER)).enumerate() {
            let path = |i: usize| {
                let Carried { camera, media, weight } = &carried[TOGETHER * part + i];
                (*camera, Path { bounces, media, weight: *weight })
            };
            if rays.len() >= FEWEST {
                self.light_level(rays, path, begin, (levels, lit), tally, |i, light| lights[i] *= light);
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
        self.carried.clear();
        self.lights.clear();
    }
}
