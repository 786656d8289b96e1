//! What a ray met, and the surface there.

use super::{Geometry, Hit, World};
use durer_bvh::TraversalCounter;
use durer_scene::math::{Ray, Ray64, Side, Vec2, Vec3};
use durer_scene::shape::{ShapeHit, Surface};

/// What a ray met: made once, by [`World::interaction`], and asked by all that shades it.
#[derive(Clone, Copy, Debug)]
pub struct Interaction {
    /// What the thing is like there, in world space.
    pub surface: Surface,
    /// The ray.
    pub ray: Ray64,
    /// Where it met what.
    pub hit: Hit,
    /// The number of the material there.
    pub material: u32,
    /// How wide what a sample stands for is there, across the ray; 0 where nobody knows.
    pub width: f32,
}

impl Interaction {
    /// Nothing yet.
    pub(crate) const NOWHERE: Interaction = Interaction {
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

    /// Whether the ray comes from the side that the true normal does not point to.
    pub fn inside(&self) -> bool {
        self.ray.dir().dot(self.surface.n_geo) > 0.0
    }
}

impl World {
    /// What a ray meets first in its interval.
    pub fn intersect<T: TraversalCounter>(&self, ray: impl Into<Ray64>, counter: &mut T) -> Option<Interaction> {
        let ray = ray.into();
        self.closest(ray, counter).map(|hit| self.interaction(ray, hit))
    }

    /// What a ray met at a hit of its. The official programs take the point from the ray as it is.
    pub fn interaction(&self, ray: impl Into<Ray64>, hit: Hit) -> Interaction {
        self.interaction_along(&ray.into(), hit)
    }

    /// The same with one copy of the ray.
    #[inline]
    pub(crate) fn interaction_along(&self, ray: &Ray64, hit: Hit) -> Interaction {
        let mut at = Interaction::NOWHERE;
        self.meet(ray, hit, &mut at);
        at
    }

    /// The same, in its place: a copy of what was just written would take long.
    #[inline]
    pub(crate) fn meet(&self, ray: &Ray64, hit: Hit, at: &mut Interaction) {
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
        if let Geometry::Solid(_) = &object.geometry {
            at.surface.solid = Some(hit.object);
        }
    }

    /// The number of the material at a hit.
    #[inline]
    pub(crate) fn material_of(&self, hit: &Hit) -> u32 {
        let object = &self.objects()[hit.object as usize];
        match &object.geometry {
            Geometry::Solid(solid) => solid.part(hit.part).material,
            _ => object.material,
        }
    }
}
