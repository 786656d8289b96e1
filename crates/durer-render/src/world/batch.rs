//! Intersection of batches of coherent rays. Tracing a batch gives the same results as tracing its
//! rays one by one.

use super::{Accel, Geometry, Hit, Object, World};
use durer_bvh::{PackHit, PrimitivePacks, TraversalCounter, TriangleHit};
use durer_scene::math::{Ray, Ray64, Vec3};
use durer_scene::shape::ShapeHit;
use std::array::from_fn;

/// Maximum number of rays in a batch.
pub(crate) const MAX_BATCH: usize = 64;

/// Objects of a small world, prepared for the intersection of batches of rays.
#[derive(Clone, Debug)]
pub(crate) struct SmallWorld {
    /// Simple shapes, packed for intersection with eight rays at once.
    pub(crate) simple: PrimitivePacks,
    /// Indices of all other objects.
    pub(crate) others: Vec<u32>,
}

/// Number of rays below which each ray is traced on its own.
const MIN_BATCH: usize = 3;

/// Ray that hits nothing, for unused slots of a batch.
const NOWHERE: Ray = Ray { t_max: 0.0, ..Ray::new(Vec3::ZERO, Vec3::X) };

impl World {
    /// Returns the number of rays to trace together. If every ray tests all objects, the number is
    /// 1, so that a render can be cancelled between two rays.
    pub(crate) fn batch_size(&self) -> usize {
        let tests_all = matches!(self.accel, Accel::None) && self.small_world.is_none();
        if tests_all { 1 } else { MAX_BATCH }
    }

    /// Computes the first hits of up to [`MAX_BATCH`] rays. The rays are modified during the call
    /// and restored at the end.
    pub(crate) fn first_hits<T: TraversalCounter>(
        &self,
        rays: &mut [Ray64],
        hits: &mut [Option<Hit>],
        counter: &mut T,
    ) {
        if T::COUNTS_WORK || rays.len() < MIN_BATCH || self.small_world.is_none() {
            return hits.iter_mut().zip(rays).for_each(|(hit, ray)| *hit = self.closest_along(ray, counter));
        }
        rays.iter().for_each(|_| counter.ray());
        self.closest_batch(rays, hits);
    }

    /// Determines which of up to [`MAX_BATCH`] rays are occluded.
    pub(crate) fn any_hits<T: TraversalCounter>(&self, rays: &[Ray64], blocked: &mut [bool], counter: &mut T) {
        if T::COUNTS_WORK || rays.len() < MIN_BATCH || self.small_world.is_none() {
            return blocked.iter_mut().zip(rays).for_each(|(hit, ray)| *hit = self.occluded_along(ray, counter));
        }
        rays.iter().for_each(|_| counter.ray());
        self.occluded_batch(rays, blocked);
    }

    /// Computes the first hits of up to [`MAX_BATCH`] rays. Returns the same results as
    /// [`World::closest`].
    pub(crate) fn closest_batch(&self, rays: &[Ray64], hits: &mut [Option<Hit>]) {
        let Some(small_world) = &self.small_world else {
            hits.iter_mut().zip(rays).for_each(|(hit, ray)| *hit = self.closest(ray, &mut ()));
            return;
        };
        let offer = |best: &mut Option<Hit>, hit: Option<Hit>| {
            if let Some(hit) = hit.filter(|hit| hit.is_before(best)) {
                *best = Some(hit);
            }
        };
        let sound = |i: usize| durer_bvh::internal::is_valid(&rays[i].rounded);
        small_world.intersect(rays, |i, pack_hit| hits[i] = pack_hit.map(|met| self.hit_of_pack(met, &rays[i])));
        for &number in &small_world.others {
            let object = &self.objects()[number as usize];
            if let Geometry::Mesh(tree) = &object.geometry {
                let mut triangle_hits = [const { None::<TriangleHit> }; MAX_BATCH];
                let mut local = local_rays(object, rays.iter());
                // Ties are resolved by comparing hits, so a ray must still reach the `t` of its
                // current hit.
                for (local, hit) in local.iter_mut().zip(&*hits) {
                    local.t_max = hit.map_or(local.t_max, |hit| hit.t.next_up());
                }
                tree.bvh.closest_batch(&local[..rays.len()], &mut triangle_hits[..rays.len()]);
                for (best, hit) in hits.iter_mut().zip(triangle_hits) {
                    offer(best, hit.map(|h| Hit { t: h.t, uv: h.uv, object: number, part: h.triangle }));
                }
                continue;
            }
            for i in (0..rays.len()).filter(|&i| sound(i)) {
                let hit = object.closest(number, &rays[i], false, &mut ());
                offer(&mut hits[i], hit.map(|(ShapeHit { t, uv }, part)| Hit { t, uv, object: number, part }));
            }
        }
    }

    /// Determines which of up to [`MAX_BATCH`] rays are occluded. Returns the same results as
    /// [`World::occluded`].
    pub(crate) fn occluded_batch(&self, rays: &[Ray64], blocked: &mut [bool]) {
        let Some(small_world) = &self.small_world else {
            blocked.iter_mut().zip(rays).for_each(|(blocked, ray)| *blocked = self.occluded_along(ray, &mut ()));
            return;
        };
        let sound = |i: usize| durer_bvh::internal::is_valid(&rays[i].rounded);
        small_world.intersect(rays, |i, pack_hit| blocked[i] = pack_hit.is_some());
        // Skip rays that are already occluded.
        let others = || small_world.others.iter().map(|&number| (number, &self.objects()[number as usize]));
        let is_mesh = |object: &Object| matches!(object.geometry, Geometry::Mesh(_));
        for (number, object) in others().filter(|(_, object)| !is_mesh(object)) {
            for i in (0..rays.len()).filter(|&i| sound(i)) {
                blocked[i] = blocked[i] || object.closest(number, &rays[i], true, &mut ()).is_some();
            }
        }
        for (_, object) in others() {
            let Geometry::Mesh(tree) = &object.geometry else { continue };
            let (mut open, mut count) = ([0; MAX_BATCH], 0);
            for i in (0..rays.len()).filter(|&i| !blocked[i]) {
                open[count] = i;
                count += 1;
            }
            let mut occluded = [false; MAX_BATCH];
            let local = local_rays(object, open[..count].iter().map(|&i| &rays[i]));
            tree.bvh.occluded_batch(&local[..count], &mut occluded[..count]);
            open[..count].iter().zip(occluded).for_each(|(&i, found)| blocked[i] = found);
        }
    }

    /// Converts a hit on packed shapes to a world hit.
    #[inline]
    fn hit_of_pack(&self, PackHit { t, number }: PackHit, ray: &Ray64) -> Hit {
        let ShapeHit { t, uv } = self.objects()[number as usize].crossing_at(t, ray);
        Hit { t, uv, object: number, part: 0 }
    }
}

impl SmallWorld {
    /// Calls `take` for each ray that hits a simple shape, with the first such hit.
    fn intersect(&self, rays: &[Ray64], mut take: impl FnMut(usize, Option<PackHit>)) {
        if self.simple.is_empty() {
            return (0..rays.len()).for_each(|i| take(i, None));
        }
        for start in (0..rays.len()).step_by(8) {
            let ray = |i: usize| rays.get(start + i).map_or(&NOWHERE, |ray| &ray.rounded);
            let pack_hits = self.simple.closest_of_eight(from_fn(ray));
            pack_hits.into_iter().enumerate().take(rays.len() - start).for_each(|(i, hit)| take(start + i, hit));
        }
    }
}

/// Transforms rays into an object's space.
fn local_rays<'r>(object: &Object, rays: impl Iterator<Item = &'r Ray64>) -> [Ray; MAX_BATCH] {
    let mut local = [NOWHERE; MAX_BATCH];
    let rays = local.iter_mut().zip(rays);
    match &object.to_world {
        None => rays.for_each(|(local, ray)| *local = ray.rounded),
        Some(to_world) => rays.for_each(|(local, ray)| *local = to_world.inverse_ray(ray)),
    }
    local
}
