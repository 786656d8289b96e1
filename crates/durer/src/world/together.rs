//! Rays that go nearly the same way, asked about together: with the answers that each has alone.

use super::{Accel, Geometry, Hit, Object, World};
use crate::bvh::{PackHit, TriangleHit};
use crate::math::{Ray, Ray64, Vec2, Vec3};
use crate::shape::ShapeHit;
use std::array::from_fn;

/// As many rays are asked about together at most.
pub(crate) const TOGETHER: usize = 64;

/// A ray that meets nothing.
const NOWHERE: Ray = Ray { t_max: 0.0, ..Ray::new(Vec3::ZERO, Vec3::X) };

impl World {
    /// The first hits of up to [`TOGETHER`] rays, as [`World::closest`] has them one by one.
    pub(crate) fn closest_together(&self, rays: &[Ray64], hits: &mut [Option<Hit>]) {
        if !self.is_loose() {
            hits.iter_mut().zip(rays).for_each(|(hit, ray)| *hit = self.closest(ray, &mut ()));
            return;
        }
        let offer = |best: &mut Option<Hit>, hit: Option<Hit>| {
            if let Some(hit) = hit.filter(|hit| hit.is_before(best)) {
                *best = Some(hit);
            }
        };
        let sound = |i: usize| crate::bvh::is_sound(&rays[i].rounded);
        if !self.few.is_empty() {
            self.few_together(rays, |i, met| hits[i] = met.map(hit_of));
        } else {
            for (i, hit) in hits.iter_mut().enumerate() {
                let found = if sound(i) { self.packs.closest(&rays[i].rounded, &mut ()) } else { None };
                *hit = found.map(hit_of);
            }
        }
        for (number, object) in self.others() {
            if let Geometry::Mesh(tree) = &object.geometry {
                let mut found = [const { None::<TriangleHit> }; TOGETHER];
                let local = local_rays(object, rays.iter());
                tree.bvh.closest_batch(&local[..rays.len()], &mut found[..rays.len()]);
                for (best, found) in hits.iter_mut().zip(found) {
                    offer(best, found.map(|h| Hit { t: h.t, uv: h.uv, object: number, part: h.triangle }));
                }
                continue;
            }
            for i in (0..rays.len()).filter(|&i| sound(i)) {
                let found = object.closest(number, &rays[i], false, &mut ());
                offer(&mut hits[i], found.map(|(ShapeHit { t, uv }, part)| Hit { t, uv, object: number, part }));
            }
        }
    }

    /// Whether anything is hit by each of up to [`TOGETHER`] rays, as [`World::occluded`] has it one
    /// by one.
    pub(crate) fn occluded_together(&self, rays: &[Ray64], blocked: &mut [bool]) {
        if !self.is_loose() {
            blocked.iter_mut().zip(rays).for_each(|(blocked, ray)| *blocked = self.occluded_along(ray, &mut ()));
            return;
        }
        let sound = |i: usize| crate::bvh::is_sound(&rays[i].rounded);
        if !self.few.is_empty() {
            self.few_together(rays, |i, met| blocked[i] = met.is_some());
        } else {
            for (i, blocked) in blocked.iter_mut().enumerate() {
                *blocked = sound(i) && self.packs.occluded(&rays[i].rounded, &mut ());
            }
        }
        // Those that are in the dark already need not be asked about.
        let is_mesh = |object: &Object| matches!(object.geometry, Geometry::Mesh(_));
        for (number, object) in self.others().filter(|(_, object)| !is_mesh(object)) {
            for i in (0..rays.len()).filter(|&i| sound(i)) {
                blocked[i] = blocked[i] || object.closest(number, &rays[i], true, &mut ()).is_some();
            }
        }
        for (_, object) in self.others() {
            let Geometry::Mesh(tree) = &object.geometry else { continue };
            let (mut open, mut count) = ([0; TOGETHER], 0);
            for i in (0..rays.len()).filter(|&i| !blocked[i]) {
                open[count] = i;
                count += 1;
            }
            let mut found = [false; TOGETHER];
            let local = local_rays(object, open[..count].iter().map(|&i| &rays[i]));
            tree.bvh.occluded_batch(&local[..count], &mut found[..count]);
            open[..count].iter().zip(found).for_each(|(&i, found)| blocked[i] = found);
        }
    }

    /// What stands outside the structure beside planes and spheres that are tested together, with
    /// numbers.
    fn others(&self) -> impl Iterator<Item = (u32, &Object)> {
        let object = |&number: &u32| (number, &self.objects()[number as usize]);
        self.loose.iter().map(object).filter(|(_, object)| self.few.is_empty() || !object.fits_packs())
    }

    /// Whether all things stand outside the structure, as a few do.
    fn is_loose(&self) -> bool {
        matches!(&self.accel, Accel::Bvh(bvh) if bvh.is_empty())
    }

    fn few_together(&self, rays: &[Ray64], mut take: impl FnMut(usize, Option<PackHit>)) {
        for start in (0..rays.len()).step_by(8) {
            let ray = |i: usize| rays.get(start + i).map_or(&NOWHERE, |ray| &ray.rounded);
            let met = self.few.closest_of_eight(from_fn(ray));
            met.into_iter().enumerate().take(rays.len() - start).for_each(|(i, met)| take(start + i, met));
        }
    }
}

fn hit_of(met: PackHit) -> Hit {
    Hit { t: met.t, uv: Vec2::ZERO, object: met.number, part: 0 }
}

/// Rays in the space of an object.
fn local_rays<'r>(object: &Object, rays: impl Iterator<Item = &'r Ray64>) -> [Ray; TOGETHER] {
    let mut local = [NOWHERE; TOGETHER];
    let rays = local.iter_mut().zip(rays);
    match &object.to_world {
        None => rays.for_each(|(local, ray)| *local = ray.rounded),
        Some(to_world) => rays.for_each(|(local, ray)| *local = to_world.inverse_ray(ray)),
    }
    local
}
