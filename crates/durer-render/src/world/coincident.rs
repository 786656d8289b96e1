//! Surfaces of different objects at one place.
//!
//! A ray that passes a surface, such as glass, a hole of a cutout or the boundary of smoke,
//! continues behind it. Another surface can lie exactly there: the floor below a glass box, or the
//! wall behind a decal. It must not be passed with the first one.

use super::{Accel, Hit, SurfaceInteraction, World};
use durer_bvh::TraversalCounter;
use durer_scene::math::{Ray64, gamma};
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

    /// Returns a hit of the ray at exactly the position of the surfaces that it has passed.
    pub(crate) fn coincident(&self, world: &World, ray: &Ray64) -> Option<Hit> {
        if self.objects.is_empty() { None } else { world.coincident(ray, self.t, &self.objects) }
    }

    /// Returns the next hit of a ray behind the surfaces that it has passed. The start of the ray's
    /// interval is moved to the last of them.
    pub(crate) fn next_hit<T: TraversalCounter>(&self, world: &World, ray: &mut Ray64, counter: &mut T) -> Option<Hit> {
        if let Some(hit) = self.coincident(world, ray) {
            return Some(hit);
        }
        if !self.objects.is_empty() {
            ray.rounded.t_min = self.t;
        }
        world.closest_along(ray, counter)
    }
}

/// Smallest cosine for which [`World::contact`] takes into account that a ray needs a longer way
/// between two surfaces if it is inclined.
const MIN_COSINE: f32 = 0.05;

impl World {
    /// Returns the hit with the lowest object index at exactly the position `t` of a ray, except on
    /// the objects in `passed`.
    fn coincident(&self, ray: &Ray64, t: f32, passed: &[u32]) -> Option<Hit> {
        let mut at = *ray;
        (at.rounded.t_min, at.rounded.t_max) = (t.next_down(), t.next_up());
        let mut best: Option<Hit> = None;
        self.for_each_near(&at, |object| {
            if passed.contains(&object) || best.is_some_and(|best| best.object <= object) {
                return;
            }
            if let Some(hit) = self.hit_of(object, &at).filter(|hit| hit.t == t) {
                best = Some(hit);
            }
        });
        best
    }

    /// Returns the hit on an opaque surface that touches the surface that a ray hit, if that lets
    /// light pass. The distance between both is at most the rounding errors.
    ///
    /// A glass box stands on a floor, for example. A ray that leaves the glass would start behind
    /// the floor, because secondary rays start at a small distance from the surface. Which of both
    /// is in front is unknown, and the floor ends the ray in any case.
    pub(crate) fn contact(&self, at: &SurfaceInteraction) -> Option<Hit> {
        if self.is_opaque(at.material) || matches!(self.accel, Accel::Course(_)) {
            return None;
        }
        let SurfaceInteraction { ray, hit, surface, .. } = at;
        let dir = ray.dir();
        let cosine = dir.dot(surface.n_geo).abs().max(MIN_COSINE * dir.length());
        let reach = 4.0 * surface.error.element_sum() / cosine + gamma(4) * hit.t;
        let mut near = *ray;
        near.rounded.t_min = hit.t.next_down();
        near.rounded.t_max = near.rounded.t_max.min((hit.t + reach).next_up());
        let mut best: Option<Hit> = None;
        self.for_each_near(&near, |object| {
            if object == hit.object {
                return;
            }
            let found = self.hit_of(object, &near).filter(|found| self.is_opaque(self.material_of(found)));
            if let Some(found) = found.filter(|found| found.is_before(&best)) {
                best = Some(found);
            }
        });
        best
    }

    /// Writes the surface interaction at a hit into `at`, or that at the surface which touches it;
    /// see [`World::contact`]. Returns the hit that counts.
    #[inline]
    pub(crate) fn intersect_touching(&self, ray: &Ray64, hit: Hit, at: &mut SurfaceInteraction) -> Hit {
        self.intersect_into(ray, hit, at);
        let Some(contact) = self.contact(at) else { return hit };
        self.intersect_into(ray, contact, at);
        contact
    }

    /// Calls `visit` with the indices of all objects that a ray may hit in its interval.
    fn for_each_near(&self, ray: &Ray64, mut visit: impl FnMut(u32)) {
        self.packs.numbers().for_each(&mut visit);
        self.outside_accel.iter().copied().for_each(&mut visit);
        match &self.accel {
            Accel::Bvh(bvh) if bvh.is_empty() => {}
            Accel::Bvh(bvh) => bvh.traverse(&ray.rounded, &mut (), |item, t_max, _| {
                visit(bvh.primitive_indices()[item]);
                t_max
            }),
            Accel::Grid { grid, parts, wide } => {
                wide.iter().for_each(|&(object, _)| visit(object));
                grid.traverse(&ray.rounded, &mut (), |item, t_max, _| {
                    visit(parts[item].0);
                    t_max
                });
            }
            Accel::None => (0..self.objects().len() as u32).for_each(visit),
            // The official programs lose such surfaces.
            Accel::Course(_) => {}
        }
    }
}

#[cfg(test)]
mod tests;
