//! Selects the hit along a ray, with the mistakes of a student's tracer.

use super::BuggyTracer;
use crate::mistakes::bugs::{BehindOrigin, HitChoice, Roots};
use crate::mistakes::variant::{CourseShape, course_shape};
use durer_render::world::{Geometry, Hit};
use durer_scene::math::{Ray64, Vec2};
use durer_scene::shape::Primitive;
use smallvec::SmallVec;

impl BuggyTracer<'_> {
    /// Returns the selected hit and the `t` that the tracer computes for it.
    pub(super) fn closest(&self, ray: &Ray64) -> Option<(Hit, f32)> {
        if self.bugs.local_unit {
            let mut whole = *ray;
            whole.rounded.t_max = f32::INFINITY;
            let hits = self.world.hits_of_each(&whole);
            let seen = hits.map(|hit| (hit, self.own_t(ray, &hit)));
            return seen.filter(|(_, t)| *t < ray.rounded.t_max).min_by(|a, b| a.1.total_cmp(&b.1));
        }
        if self.bugs.behind == Some(BehindOrigin::Beyond) {
            let near = ray.rounded.t_min.max(0.0);
            let mut whole = *ray;
            whole.rounded.t_min = f32::NEG_INFINITY;
            return self.world.all_hits(&whole).find(|hit| hit.t.abs() > near).map(|hit| (hit, hit.t));
        }
        let hit = match self.bugs.hit_choice {
            HitChoice::Nearest => self.world.closest(ray, &mut ()),
            HitChoice::Last => self.world.all_hits(ray).last(),
            HitChoice::FarthestObject => self.world.hits_of_each(ray).max_by(|a, b| a.t.total_cmp(&b.t)),
            HitChoice::LastInFile => self.world.hits_of_each(ray).max_by_key(|hit| hit.object),
            HitChoice::FirstInFile => self.world.hits_of_each(ray).min_by_key(|hit| hit.object),
            HitChoice::FarthestTriangle => self.faces(ray).max_by(|a, b| a.t.total_cmp(&b.t)),
            HitChoice::LastTriangle => self.faces(ray).max_by_key(|hit| (hit.object, hit.part)),
            HitChoice::NearRoots => self.world.all_hits(ray).find(|hit| !self.leaves_sphere(ray, hit)),
            HitChoice::Fronts(triangles) => self.world.all_hits(ray).find(|hit| {
                let kind = course_shape(&self.world.objects()[hit.object as usize].geometry);
                let tested = !triangles || matches!(kind, Some(CourseShape::Triangle | CourseShape::Mesh));
                !tested || !self.world.interaction(ray, *hit).inside()
            }),
            HitChoice::FirstOfMesh => self.of_meshes(ray, |hit| hit.part),
            HitChoice::LastOfMesh => self.of_meshes(ray, |hit| u32::MAX - hit.part),
            HitChoice::Roots(roots) => {
                let own = |object| self.with_roots(ray, object, roots);
                (0..self.world.objects().len() as u32).filter_map(own).min_by(|a, b| a.t.total_cmp(&b.t))
            }
            HitChoice::MovedDirection => {
                let own = |object| self.world.hit_of(object, &self.own_ray(ray, object));
                (0..self.world.objects().len() as u32).filter_map(own).min_by(|a, b| a.t.total_cmp(&b.t))
            }
            HitChoice::FarSpheres => {
                let far = |hit: Hit| {
                    let object = &self.world.objects()[hit.object as usize].geometry;
                    let sphere = course_shape(object) == Some(CourseShape::Sphere);
                    let mut rest = *ray;
                    rest.rounded.t_min = hit.t;
                    let beyond = |hit: &Hit| self.world.hits_of_each(&rest).find(|other| other.object == hit.object);
                    sphere.then(|| beyond(&hit)).flatten().unwrap_or(hit)
                };
                self.world.hits_of_each(ray).map(far).min_by(|a, b| a.t.total_cmp(&b.t))
            }
        };
        hit.map(|hit| (hit, hit.t))
    }

    /// Returns the ray used for the intersection with an object.
    pub(super) fn own_ray(&self, ray: &Ray64, object: u32) -> Ray64 {
        let object = &self.world.objects()[object as usize];
        if self.bugs.hit_choice != HitChoice::MovedDirection || object.to_world.is_none() {
            return *ray;
        }
        // The wrong M^-1 (d, 1) is equal to M^-1 (d - t, 0), where t is the translation of M.
        let by = object.world_point(-object.center);
        let mut own = *ray;
        own.rounded.dir -= by;
        own
    }

    /// Returns the hit of the nearest object. For a mesh, this is the hit with the smallest key.
    fn of_meshes(&self, ray: &Ray64, key: impl Fn(&Hit) -> u32) -> Option<Hit> {
        let mut best: SmallVec<[Hit; 16]> = SmallVec::new();
        for hit in self.faces(ray) {
            match best.iter_mut().find(|known| known.object == hit.object) {
                Some(known) if key(&hit) < key(known) => *known = hit,
                Some(_) => {}
                None => best.push(hit),
            }
        }
        best.into_iter().min_by(|a, b| a.t.total_cmp(&b.t))
    }

    /// Returns the nearest hit of an object, using wrong roots for spheres.
    fn with_roots(&self, ray: &Ray64, object: u32, roots: Roots) -> Option<Hit> {
        let own = &self.world.objects()[object as usize];
        let Geometry::Primitive(Primitive::Sphere(sphere)) = &own.geometry else {
            return self.world.hit_of(object, ray);
        };
        let local = own.to_world.as_ref().map_or(ray.rounded, |to_world| to_world.inverse_ray(&ray.rounded));
        let off = local.origin - sphere.center;
        let (a, b, c) =
            (local.dir.length_squared(), local.dir.dot(off), off.length_squared() - sphere.radius * sphere.radius);
        let (radicand, divisor) = match roots {
            Roots::FourHalf => (b * b - 4.0 * a * c, 2.0 * a),
            Roots::FourWhole => (b * b - 4.0 * a * c, a),
            Roots::TwiceA => (b * b - a * c, 2.0 * a),
            Roots::Unit => (b * b - c, 1.0),
            Roots::UnitDivisor => (b * b - a * c, 1.0),
        };
        let root = radicand.sqrt();
        let both = [(-b - root) / divisor, (-b + root) / divisor];
        let t = both.into_iter().find(|t| *t > ray.rounded.t_min && *t < ray.rounded.t_max)?;
        Some(Hit { t, uv: Vec2::ZERO, object, part: 0 })
    }

    /// Iterates over the nearest hit of each object. For a mesh, the iteration includes all of its
    /// hits.
    fn faces<'r>(&'r self, ray: &'r Ray64) -> impl Iterator<Item = Hit> + 'r {
        let mut known = SmallVec::<[u32; 16]>::new();
        self.world.all_hits(ray).filter(move |hit| {
            let is_mesh = matches!(self.world.objects()[hit.object as usize].geometry, Geometry::Mesh(_));
            let is_new = !is_mesh && !known.contains(&hit.object);
            if is_new {
                known.push(hit.object);
            }
            is_mesh || is_new
        })
    }

    /// Returns true if a ray hits a sphere from inside.
    fn leaves_sphere(&self, ray: &Ray64, hit: &Hit) -> bool {
        let object = &self.world.objects()[hit.object as usize].geometry;
        course_shape(object) == Some(CourseShape::Sphere) && self.world.interaction(ray, *hit).inside()
    }

    /// Returns the distance to a hit, measured in object space.
    fn own_t(&self, ray: &Ray64, hit: &Hit) -> f32 {
        let to_world = self.world.objects()[hit.object as usize].to_world.as_ref();
        hit.t * to_world.map_or(1.0, |to_world| to_world.inverse_ray(ray).dir.length())
    }

    /// Returns true if the ray hits anything.
    pub(super) fn occluded(&self, ray: &Ray64) -> bool {
        let own_hits = matches!(
            self.bugs.hit_choice,
            HitChoice::NearRoots | HitChoice::Fronts(_) | HitChoice::Roots(_) | HitChoice::MovedDirection
        );
        let beyond = self.bugs.behind == Some(BehindOrigin::Beyond);
        if self.bugs.local_unit || own_hits || beyond {
            return self.closest(ray).is_some();
        }
        let mut ray = *ray;
        if self.bugs.behind == Some(BehindOrigin::All) {
            ray.rounded.t_min = f32::NEG_INFINITY;
        }
        self.world.occluded(&ray, &mut ())
    }
}
