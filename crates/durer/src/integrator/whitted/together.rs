//! Camera rays that are neighbours, and what becomes of them: what rays of one depth hit, and what
//! lamps see of that, is asked for together.

use super::branches::{Branches, Carried, Partings};
use super::lamps::LampHits;
use super::secondary::Blend;
use super::{Path, Whitted};
use crate::dialect::Compat;
use crate::integrator::media::Media;
use crate::integrator::trace::TraceListener;
use crate::math::{Color, Ray, Ray64};
use crate::sampler::SampleId;
use crate::world::{Hit, Material, Phong, Surfaces, TOGETHER, WeightedMaterial};
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
    hits: Hits,
    camera_rays: Vec<Ray64>,
}

/// Hits of one depth after the other.
#[derive(Default)]
struct Hits {
    surfaces: Box<Surfaces>,
    lit: LampHits,
    partings: Box<Partings>,
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
        if T::LISTENS || T::COUNTS_WORK {
            for (i, ((ray, _), color)) in rays.iter().zip(colors).enumerate() {
                begin(i);
                *color = self.radiance(ray, tally);
            }
            return;
        }
        let air = Media::default();
        SCRATCH.with_borrow_mut(|Scratch { levels, hits, camera_rays }| {
            levels.resize_with(levels.len().max(self.settings.bounces as usize + 1), Level::default);
            for (part, (rays, colors)) in rays.chunks(TOGETHER).zip(colors.chunks_mut(TOGETHER)).enumerate() {
                camera_rays.clear();
                camera_rays.extend(rays.iter().map(|(ray, _)| Ray64::from(ray)));
                let path = |i: usize| (TOGETHER * part + i, self.camera_path(&air));
                self.light_level(camera_rays, path, &begin, (levels, hits), tally, |i, color| colors[i] = color);
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
        (levels, hits): (&mut [Level], &mut Hits),
        tally: &mut T,
        mut take: impl FnMut(usize, Color),
    ) {
        let Some((Level { waiting, branches }, deeper)) = levels.split_first_mut() else { return };
        let Hits { surfaces, lit, partings } = hits;
        waiting.clear();
        branches.clear();
        surfaces.clear();
        partings.clear();
        let (mut found, mut colors) = ([None; TOGETHER], [Color::ZERO; TOGETHER]);
        self.world.closest_together(rays, &mut found[..rays.len()]);
        for (i, ray) in rays.iter().enumerate() {
            let (camera, path) = path(i);
            begin(camera);
            tally.ray();
            let Some(hit) = &found[i] else {
                colors[i] = self.world.sky(ray.dir());
                continue;
            };
            match self.plain(hit) {
                Some(phong) => self.world.add_met(i, hit, phong, surfaces),
                None => colors[i] = self.trace(ray, found[i], path, tally),
            }
        }
        self.world.meet_together(rays, &found, surfaces);
        self.find_sides(surfaces, lit);
        for &met in surfaces.met() {
            let (i, place) = (met.ray(), met.place());
            let Some((hit, phong)) = found[i].as_ref().and_then(|hit| Some((hit, self.plain(hit)?))) else { continue };
            let (ray, (camera, path)) = (&rays[i], path(i));
            let (blend, leaving) = (Blend::of(&[WeightedMaterial { phong, share: 1.0 }]), lit.sees_back(place));
            let passage = (blend.transparent != Color::ZERO)
                .then(|| self.passage_through(hit.object, ray.rounded.origin, blend, leaving, path.media));
            if passage.as_ref().is_some_and(|passage| passage.hidden) {
                begin(camera);
                colors[i] = self.trace(ray, found[i], path, tally);
                continue;
            }
            colors[i] = self.unlit(met, surfaces.diffuse(place, phong), phong, lit);
            if self.goes_on(path) && (blend.reflective != Color::ZERO || blend.transparent != Color::ZERO) {
                partings.push(met, blend, leaving, passage);
            }
        }
        (0..self.world.lights().len()).for_each(|lamp| self.add_lamp(lamp, surfaces, lit, &mut colors, tally));
        if !partings.is_empty() {
            let bounces = path(0).1.bounces - 1;
            self.branch(surfaces, partings, path, branches, |ray, branches| waiting.push(Waiting { ray, branches }));
            self.follow(branches, begin, (deeper, hits), bounces, tally);
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

    /// Finds the light along rays that go on.
    fn follow<T: TraceListener>(
        &self,
        branches: &mut Branches,
        begin: &impl Fn(usize),
        (levels, hits): (&mut [Level], &mut Hits),
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
                self.light_level(rays, path, begin, (levels, hits), tally, |i, light| lights[i] *= light);
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
