//! Camera rays that are neighbours, and what becomes of them: what rays of one depth hit, and what
//! lamps see of that, is asked for together.

use super::branches::{Branches, Carried, Partings};
use super::lamps::LampHits;
use super::secondary::Blend;
use super::{Path, Whitted};
use crate::integrator::media::{Media, Passage};
use crate::integrator::one_by_one;
use crate::integrator::trace::{NodeId, TraceListener};
use crate::world::{Geometry, Hit, Kind, Material, Phong, Surfaces, TOGETHER, WeightedMaterial};
use durer_scene::math::{Color, Ray64};
use durer_scene::sampler::SampleId;
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

/// What hits of an object have in common, and of which object; of a solid, whose parts differ, only
/// what one has.
struct Alike {
    object: u32,
    material: u32,
    /// How surfaces are found out, where lamps can be asked about together.
    kind: Option<Kind>,
}

/// The number of no object, and of no material.
const NONE: u32 = u32::MAX;

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
}

/// Hits of one depth after the other.
#[derive(Default)]
struct Hits {
    surfaces: Box<Surfaces>,
    lit: LampHits,
    partings: Box<Partings>,
    /// All that rays run in: what one carries of it is a number. The first is air.
    media: Vec<Media>,
}

impl Hits {
    /// The path that a ray is part of.
    fn path(&self, Carried { media, weight, .. }: Carried, bounces: u32) -> Path<'_> {
        Path { bounces, media: &self.media[media as usize], weight, node: NodeId::NONE }
    }

    /// Keeps what rays run in; gives its number.
    fn keep(&mut self, media: Media) -> u32 {
        if media.is_air() {
            return AIR;
        }
        self.media.push(media);
        self.media.len() as u32 - 1
    }
}

/// The number of air among what rays run in.
const AIR: u32 = 0;

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

impl Whitted<'_> {
    /// The light along each of some camera rays, with the same bits as [`Whitted::radiance`].
    pub(super) fn light_together<T: TraceListener>(
        &self,
        rays: &[Ray64],
        begin: impl Fn(usize) -> SampleId,
        tally: &mut T,
        colors: &mut [Color],
    ) {
        if T::LISTENS || T::COUNTS_WORK {
            return one_by_one(self, rays, begin, tally, colors);
        }
        let bounces = self.settings.bounces;
        SCRATCH.with_borrow_mut(|Scratch { levels, hits }| {
            levels.resize_with(levels.len().max(bounces as usize + 1), Level::default);
            for (part, (rays, colors)) in rays.chunks(TOGETHER).zip(colors.chunks_mut(TOGETHER)).enumerate() {
                hits.media.clear();
                hits.media.push(Media::default());
                let carried = |i: usize| Carried { camera: (TOGETHER * part + i) as u32, media: AIR, weight: 1.0 };
                let ways = (bounces, carried, &begin);
                self.light_level(rays, ways, (levels, hits), tally, |i, color| colors[i] = color);
            }
        });
    }

    /// The light along not more than [`TOGETHER`] rays of one depth. They have so many bounces left;
    /// then what each carries; `begin` is told the camera ray that is worked for. `take` gets the
    /// light of each; `levels` are of this depth and those below.
    fn light_level<T: TraceListener>(
        &self,
        rays: &[Ray64],
        (bounces, carried, begin): (u32, impl Fn(usize) -> Carried, &impl Fn(usize) -> SampleId),
        (levels, hits): (&mut [Level], &mut Hits),
        tally: &mut T,
        mut take: impl FnMut(usize, Color),
    ) {
        let Some((Level { waiting, branches }, deeper)) = levels.split_first_mut() else { return };
        waiting.clear();
        branches.clear();
        hits.surfaces.clear();
        hits.partings.clear();
        let (mut found, mut colors) = ([None; TOGETHER], [Color::ZERO; TOGETHER]);
        let mut materials = [0; TOGETHER];
        self.world.closest_together(rays, &mut found[..rays.len()]);
        let mut alike = Alike { object: NONE, material: NONE, kind: None };
        for (i, ray) in rays.iter().enumerate() {
            begin(carried(i).camera as usize);
            tally.ray();
            let Some(hit) = &found[i] else {
                colors[i] = self.world.sky(ray.dir());
                continue;
            };
            if hit.object != alike.object {
                alike = self.alike(hit);
            }
            materials[i] = alike.material;
            match alike.kind {
                Some(kind) => hits.surfaces.add(i, kind),
                None => colors[i] = self.trace(ray, found[i], hits.path(carried(i), bounces), tally),
            }
        }
        self.world.meet_together(rays, &found, &mut hits.surfaces);
        self.find_sides(&hits.surfaces, &mut hits.lit);
        let goes_on = self.goes_on(bounces);
        // Most hits are of the same as the one before.
        let (mut of, mut mixed) = (NONE, None);
        for n in 0..hits.surfaces.met().len() {
            let met = hits.surfaces.met()[n];
            let (i, place) = (met.ray(), met.place());
            if materials[i] != of {
                of = materials[i];
                mixed = self.plain(of).map(|phong| {
                    let blend = Blend::of(&[WeightedMaterial { phong, share: 1.0 }]);
                    (phong, blend, blend.reflective != Color::ZERO, blend.transparent != Color::ZERO)
                });
            }
            let (Some(hit), Some((phong, blend, reflects, transmits))) = (&found[i], mixed) else { continue };
            let (path, leaving) = (hits.path(carried(i), bounces), hits.lit.sees_back(place));
            let mut passage = (1.0, 1.0, AIR);
            if transmits {
                let Passage { here, there, behind, hidden } =
                    self.passage_through(hit.object, rays[i].rounded.origin, blend, leaving, path.media);
                if hidden {
                    begin(carried(i).camera as usize);
                    colors[i] = self.trace(&rays[i], found[i], path, tally);
                    continue;
                }
                passage = (here, there, hits.keep(behind));
            }
            let Hits { surfaces, lit, partings, .. } = hits;
            colors[i] = self.unlit(met, surfaces.diffuse(place, phong), phong, lit);
            if goes_on && (reflects || transmits) {
                partings.push(met, blend, leaving, passage);
            }
        }
        let Hits { surfaces, lit, partings, .. } = hits;
        (0..self.world.lights().len()).for_each(|lamp| self.add_lamp(lamp, surfaces, lit, &mut colors, tally));
        if !partings.is_empty() {
            self.branch(surfaces, partings, carried, branches, |ray, branches| waiting.push(Waiting { ray, branches }));
            self.follow(branches, (bounces - 1, begin), (deeper, hits), tally);
        }
        let mut first = 0;
        for &Waiting { ray, branches: end } in waiting.iter() {
            colors[ray] += branches.lights[first..end].iter().fold(Color::ZERO, |sum, light| sum + *light);
            first = end;
        }
        (0..rays.len()).for_each(|i| take(i, colors[i]));
    }

    /// What hits have in common with one.
    fn alike(&self, hit: &Hit) -> Alike {
        let (object, material) = (&self.world.objects()[hit.object as usize], self.world.material_of(hit));
        let is_solid = matches!(object.geometry, Geometry::Solid(_));
        let kind = self.plain(material).map(|phong| self.world.kind_of(hit, phong));
        Alike { object: if is_solid { NONE } else { hit.object }, material, kind }
    }

    /// A material, by number, if the lamps of what is made of it can be asked about together with
    /// those of others.
    #[inline]
    fn plain(&self, material: u32) -> Option<&Phong> {
        let waits = self.settings.shadows && !self.world.shading_rules().shadow_fronts;
        match &self.world.materials()[material as usize] {
            Material::Phong(phong) if waits => Some(phong),
            _ => None,
        }
    }

    /// Finds the light along rays that go on.
    fn follow<T: TraceListener>(
        &self,
        branches: &mut Branches,
        (bounces, begin): (u32, &impl Fn(usize) -> SampleId),
        (levels, hits): (&mut [Level], &mut Hits),
        tally: &mut T,
    ) {
        let Branches { rays, carried, lights } = branches;
        let parts = rays.chunks_mut(TOGETHER).zip(carried.chunks(TOGETHER)).zip(lights.chunks_mut(TOGETHER));
        for ((rays, carried), lights) in parts {
            if rays.len() >= FEWEST {
                let ways = (bounces, |i: usize| carried[i], begin);
                self.light_level(rays, ways, (levels, hits), tally, |i, light| lights[i] *= light);
                continue;
            }
            for ((ray, carried), light) in rays.iter_mut().zip(carried).zip(lights) {
                begin(carried.camera as usize);
                let found = self.world.closest_along(ray, tally);
                *light *= self.trace(ray, found, hits.path(*carried, bounces), tally);
            }
        }
    }
}
