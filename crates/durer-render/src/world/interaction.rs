//! Surface interactions of rays.

use super::{Geometry, Hit, World};
use durer_bvh::TraversalCounter;
use durer_scene::math::{Ray, Ray64, Side, Vec2, Vec3};
use durer_scene::shape::{ShapeHit, Surface};

/// Surface point hit by a ray, computed once by [`World::interaction`] for all shading.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceInteraction {
    /// Surface at the hit, in world space.
    pub surface: Surface,
    /// The ray.
    pub ray: Ray64,
    /// The hit.
    pub hit: Hit,
    /// Index of the material.
    pub material: u32,
    /// Width of a sample's footprint across the ray; 0 if unknown.
    pub width: f32,
}

impl SurfaceInteraction {
    /// Placeholder without a hit.
    pub(crate) const NOWHERE: SurfaceInteraction = SurfaceInteraction {
        surface: Surface::NOWHERE,
        ray: Ray64 {
            rounded: Ray { t_max: 0.0, ..Ray::new(Vec3::ZERO, Vec3::ZERO) },
            rest: Vec3::ZERO,
            side: Side::ANY,
        },
        hit: Hit { t: 0.0, uv: Vec2::ZERO, object: 0, part: 0 },
        material: 0,
        width: 0.0,
    };

    /// Returns true if the ray hits the side opposite to the geometric normal.
    pub fn inside(&self) -> bool {
        self.ray.dir().dot(self.surface.n_geo) > 0.0
    }
}

impl World {
    /// Finds the first hit in the ray's interval, with its surface.
    pub fn intersect<T: TraversalCounter>(&self, ray: impl Into<Ray64>, counter: &mut T) -> Option<SurfaceInteraction> {
        let ray = ray.into();
        self.closest(ray, counter).map(|hit| self.interaction(ray, hit))
    }

    /// Computes the interaction at `hit`. Official programs take the point from the rounded ray.
    pub fn interaction(&self, ray: impl Into<Ray64>, hit: Hit) -> SurfaceInteraction {
        self.interaction_along(&ray.into(), hit)
    }

    /// Computes the interaction without copying the ray twice. See [`World::interaction`].
    #[inline]
    pub(crate) fn interaction_along(&self, ray: &Ray64, hit: Hit) -> SurfaceInteraction {
        let mut at = SurfaceInteraction::NOWHERE;
        self.intersect_into(ray, hit, &mut at);
        at
    }

    /// Writes the interaction at a hit into `at`, without a copy. See [`World::interaction`].
    #[inline]
    pub(crate) fn intersect_into(&self, ray: &Ray64, hit: Hit, at: &mut SurfaceInteraction) {
        let object = &self.objects()[hit.object as usize];
        let t = f64::from(hit.t);
        let point = match &object.to_world {
            None => ray.rounded.line().at(t),
            Some(to_world) => to_world.inverse_ray(ray).line().at(t),
        };
        let crossing = ShapeHit { t: hit.t, uv: hit.uv };
        let rules = self.shading_rules();
        object.own_surface(ray, point, &crossing, hit.part, rules, &mut at.surface);
        (at.ray, at.hit, at.material, at.width) = (*ray, hit, self.material_of(&hit), 0.0);
        object.place(&mut at.surface, ray, &crossing, rules);
        if let Some(n) = self.course_normal(&ray.rounded, &hit) {
            at.surface.n_shade = n;
        }
        if let Geometry::Solid(_) = &object.geometry {
            at.surface.solid = Some(hit.object);
        }
    }

    /// Returns the index of the material at a hit.
    #[inline]
    pub(crate) fn material_of(&self, hit: &Hit) -> u32 {
        let object = &self.objects()[hit.object as usize];
        match &object.geometry {
            Geometry::Solid(solid) => solid.part(hit.part).material,
            _ => object.material,
        }
    }
}
