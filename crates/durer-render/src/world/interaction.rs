//! Surface interactions: surface points hit by rays.

use super::{Geometry, Hit, World};
use durer_bvh::TraversalCounter;
use durer_scene::math::{Ray, Ray64, StartSide, Vec2, Vec3};
use durer_scene::shape::{ShapeHit, SurfacePoint};

/// Surface point hit by a ray, in world space, with all data needed for shading.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceInteraction {
    /// Surface properties at the hit, in world space.
    pub surface: SurfacePoint,
    /// Ray that hit the surface.
    pub ray: Ray64,
    /// Distance of the hit, and the object and part that were hit.
    pub hit: Hit,
    /// Index of the material.
    pub material: u32,
    /// Width of the camera sample's footprint at the hit, measured perpendicular to the ray; 0 if
    /// unknown.
    pub width: f32,
}

impl SurfaceInteraction {
    /// Placeholder that will be overwritten.
    pub(crate) const NOWHERE: SurfaceInteraction = SurfaceInteraction {
        surface: SurfacePoint::ZERO,
        ray: Ray64 {
            rounded: Ray { t_max: 0.0, ..Ray::new(Vec3::ZERO, Vec3::ZERO) },
            origin_error: Vec3::ZERO,
            side: StartSide::UNKNOWN,
        },
        hit: Hit { t: 0.0, uv: Vec2::ZERO, object: 0, part: 0 },
        material: 0,
        width: 0.0,
    };

    /// Returns true if the ray hits the back of the surface, which is opposite to the geometric
    /// normal.
    pub fn inside(&self) -> bool {
        self.ray.dir().dot(self.surface.n_geo) > 0.0
    }
}

impl World {
    /// Returns the surface interaction at the first hit in the ray's interval.
    pub fn intersect<T: TraversalCounter>(&self, ray: impl Into<Ray64>, counter: &mut T) -> Option<SurfaceInteraction> {
        let ray = ray.into();
        self.closest(ray, counter).map(|hit| self.interaction(ray, hit))
    }

    /// Computes the surface interaction at a hit. With the arithmetic of an official program, the
    /// point is computed from the rounded ray.
    pub fn interaction(&self, ray: impl Into<Ray64>, hit: Hit) -> SurfaceInteraction {
        self.interaction_along(&ray.into(), hit)
    }

    /// Computes the surface interaction at a hit without copying the ray again. See
    /// [`World::interaction`].
    #[inline]
    pub(crate) fn interaction_along(&self, ray: &Ray64, hit: Hit) -> SurfaceInteraction {
        let mut at = SurfaceInteraction::NOWHERE;
        self.intersect_into(ray, hit, &mut at);
        at
    }

    /// Writes the surface interaction at a hit into `at` to avoid a copy. See
    /// [`World::interaction`].
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
        object.local_surface(ray, point, &crossing, hit.part, rules, &mut at.surface);
        (at.ray, at.hit, at.material, at.width) = (*ray, hit, self.material_of(&hit), 0.0);
        object.transform_surface(&mut at.surface, ray, &crossing, rules);
        if at.surface.shadow_offsets != [Vec3::ZERO; 2] && !self.has_smooth_shadows(at.material) {
            at.surface.shadow_offsets = [Vec3::ZERO; 2];
        }
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
