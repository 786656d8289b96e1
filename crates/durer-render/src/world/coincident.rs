//! Surfaces of different objects at one position of a ray.
//!
//! A ray that passes a surface, such as a hole of a cutout or the boundary of smoke, continues
//! behind it. Another surface can lie exactly there: the floor below a box of smoke, or the wall
//! behind a decal. It must not be passed with the first one.

use super::{Accel, Hit, World};
use durer_bvh::TraversalCounter;
use durer_scene::math::Ray64;
use smallvec::SmallVec;

/// Surfaces that a ray has passed at its current position.
#[derive(Debug, Default)]
pub(crate) struct PassedSurfaces {
    /// Position along the ray, which is meaningful if there are objects.
    t: f32,
    /// Indices of the objects.
    objects: SmallVec<[u32; 4]>,
}

impl PassedSurfaces {
    /// Records that the ray passes a surface.
    pub(crate) fn pass(&mut self, hit: &Hit) {
        if hit.t != self.t {
            self.objects.clear();
        }
        self.t = hit.t;
        self.objects.push(hit.object);
    }

    /// Returns the next hit of a ray behind the surfaces that it has passed. The start of the ray's
    /// interval is moved to the last of them.
    pub(crate) fn next_hit<T: TraversalCounter>(&self, world: &World, ray: &mut Ray64, counter: &mut T) -> Option<Hit> {
        if !self.objects.is_empty() {
            if let Some(hit) = world.coincident(ray, self.t, &self.objects) {
                return Some(hit);
            }
            ray.rounded.t_min = self.t;
        }
        world.closest_along(ray, counter)
    }
}

impl World {
    /// Returns the hit with the lowest object index at exactly the position `t` of a ray, except on
    /// the objects in `passed`.
    pub(crate) fn coincident(&self, ray: &Ray64, t: f32, passed: &[u32]) -> Option<Hit> {
        let mut at = *ray;
        (at.rounded.t_min, at.rounded.t_max) = (t.next_down(), t.next_up());
        let mut best: Option<Hit> = None;
        let mut offer = |object: u32| {
            if passed.contains(&object) || best.is_some_and(|best| best.object <= object) {
                return;
            }
            if let Some(hit) = self.hit_of(object, &at).filter(|hit| hit.t == t) {
                best = Some(hit);
            }
        };
        self.packs.numbers().for_each(&mut offer);
        self.outside_accel.iter().copied().for_each(&mut offer);
        match &self.accel {
            Accel::Bvh(bvh) if bvh.is_empty() => {}
            Accel::Bvh(bvh) => bvh.traverse(&at.rounded, &mut (), |item, t_max, _| {
                offer(bvh.primitive_indices()[item]);
                t_max
            }),
            Accel::Grid { grid, parts, wide } => {
                wide.iter().for_each(|&(object, _)| offer(object));
                grid.traverse(&at.rounded, &mut (), |item, t_max, _| {
                    offer(parts[item].0);
                    t_max
                });
            }
            Accel::None => (0..self.objects().len() as u32).for_each(offer),
            // The official programs lose such surfaces.
            Accel::Course(_) => {}
        }
        best
    }
}

#[cfg(test)]
mod tests;
