//! Objects of a world and their intersection with rays.

use super::csg::Csg;
use super::{Matrix, ShadingRules};
use durer_bvh::{BuildQuality, PrimitivePacks, TraversalCounter, TriangleBvh};
use durer_scene::dialect::MeshNormals;
use durer_scene::math::{Aabb, Affine, Line, Ray, Ray64, Vec2, Vec3, gamma};
use durer_scene::shape::{Axis, Mesh, Primitive, Shape, ShapeHit, Sphere, SurfacePoint, Uv};
use glam::{DAffine3, DVec3};
use std::sync::{Arc, OnceLock};

/// Object of a world, with geometry, a transform and a material.
#[derive(Clone, Debug)]
pub struct Object {
    /// Geometry, in object space.
    pub geometry: Geometry,
    /// Transform from object to world space; `None` for the identity.
    pub to_world: Option<Affine>,
    /// Enclosing transforms, multiplied as an official program does, outermost first. The list is
    /// empty if the arithmetic of an official program is not active. If a transform is singular,
    /// `to_world` is `None`.
    pub matrices: Vec<Matrix>,
    /// Vector by which the geometry was moved to the origin to improve precision;
    /// [`Object::to_world`] moves it back.
    pub center: Vec3,
    /// Index of the material. The parts of a solid have materials of their own instead.
    pub material: u32,
    /// Length of the surface normals, which is 1 except with [`ShadingRules::raw_normals`].
    pub normal_length: f32,
    /// Source span of the object's definition in the scene file.
    pub span: durer_diag::Span,
}

/// Geometry of an [`Object`]: a primitive, a mesh or a CSG solid.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// A shape such as a sphere or a box.
    Primitive(Primitive),
    /// A mesh, which is shared by all objects that use it.
    Mesh(Arc<MeshTree>),
    /// A CSG solid made of closed shapes and meshes. The parts of the solid are in world space.
    Solid(Arc<Csg>),
}

/// Triangle mesh with its own BVH, shared by all objects that use it.
#[derive(Debug)]
pub struct MeshTree {
    /// The mesh.
    pub mesh: Mesh,
    /// BVH over the triangles.
    pub bvh: TriangleBvh,
    /// True if the mesh is closed, computed at first use.
    closed: OnceLock<bool>,
}

impl MeshTree {
    /// Builds the BVH of a mesh.
    pub fn new(mesh: Mesh, quality: BuildQuality) -> Self {
        let bvh = mesh.tree(quality);
        MeshTree { mesh, bvh, closed: OnceLock::new() }
    }

    /// Makes rays miss triangles that they would hit edge-on; see `TriangleBvh::least_volume`.
    pub fn least_volume(self, least_volume: f64) -> Self {
        MeshTree { bvh: self.bvh.min_volume(least_volume), ..self }
    }

    /// Returns a copy of the mesh and its BVH with other normals.
    pub fn with_normals(&self, rule: MeshNormals) -> Self {
        MeshTree { mesh: self.mesh.with_normals(rule), bvh: self.bvh.clone(), closed: self.closed.clone() }
    }

    /// Returns the memory used by the mesh and its BVH, in bytes.
    pub fn bytes(&self) -> usize {
        self.mesh.bytes() + self.bvh.memory_usage()
    }

    /// Returns true if the mesh is closed and therefore has an inside.
    pub fn is_closed(&self) -> bool {
        *self.closed.get_or_init(|| self.mesh.open_edges().is_empty())
    }

    /// Calls `offer` for each point where a line crosses the mesh, in no particular order, and
    /// passes the index of the crossed triangle.
    ///
    /// Coordinates are computed relative to the point of the line that is nearest to the mesh.
    /// Rounding errors therefore depend only on the size of the mesh's own coordinates.
    pub(super) fn crossings<T: TraversalCounter>(
        &self,
        line: &Line,
        counter: &mut T,
        offer: &mut impl FnMut(f64, Vec2, u32),
    ) {
        let shift = line.nearest(self.bvh.bounds().center().as_dvec3());
        let ray = Ray::new(line.at(shift).as_vec3(), line.dir.as_vec3());
        let ray = Ray { t_min: f32::NEG_INFINITY, ..ray };
        for hit in self.bvh.all_hits_counting(&ray, counter) {
            offer(f64::from(hit.t) + shift, hit.uv, hit.triangle);
        }
    }

    /// Returns the first hit in the ray's interval. With `any`, the search stops at the first hit
    /// found.
    #[inline]
    fn closest<T: TraversalCounter>(&self, ray: &Ray, any: bool, counter: &mut T) -> Option<(ShapeHit, u32)> {
        if any {
            let found = self.bvh.occluded_counting(ray, counter);
            return found.then_some((ShapeHit { t: ray.t_min, uv: Vec2::ZERO }, 0));
        }
        let hit = self.bvh.closest_counting(ray, counter)?;
        Some((ShapeHit { t: hit.t, uv: hit.uv }, hit.triangle))
    }
}

impl Object {
    /// Returns the ray in object space.
    pub(super) fn local_ray(&self, ray: &Ray64) -> Ray {
        self.to_world.as_ref().map_or_else(|| ray.rounded, |to_world| to_world.inverse_ray(ray))
    }

    /// Returns the ray in the coordinates in which the object was defined, if the object has a
    /// transform.
    pub fn own_ray(&self, ray: &Ray64) -> Option<Ray> {
        let local = self.to_world.as_ref()?.inverse_ray(ray);
        Some(Ray { origin: local.origin + self.center, ..local })
    }

    /// Returns the line of a ray, transformed to object space.
    pub(super) fn local_line(&self, ray: &Ray64) -> Line {
        self.to_world.as_ref().map_or(ray.line(), |to_world| to_world.inverse_line(ray))
    }

    /// Returns the axis of a shape of revolution; see [`Object::crossings`].
    pub(super) fn axis(&self) -> Option<Axis> {
        if let Geometry::Primitive(shape) = &self.geometry { shape.axis() } else { None }
    }

    /// Calls `offer` for each point where a ray's line crosses the object, in no particular order,
    /// and passes the index of the crossed part.
    pub(super) fn crossings<T: TraversalCounter>(
        &self,
        axis: Option<&Axis>,
        ray: &Ray64,
        counter: &mut T,
        offer: &mut impl FnMut(f64, Vec2, u32),
    ) {
        let line = self.local_line(ray);
        match &self.geometry {
            Geometry::Primitive(shape) => {
                counter.count_work(0, 1);
                shape.crossings_about(axis, &line, &mut |t, uv| offer(t, uv, 0));
            }
            Geometry::Mesh(tree) => tree.crossings(&line, counter, offer),
            // Solids nested in solids have already been flattened.
            Geometry::Solid(_) => {}
        }
    }

    /// Replaces the object's transform.
    pub fn set_transform(&mut self, place: DAffine3) {
        // First undo the translation that moved the geometry to the origin.
        let centered = place * DAffine3::from_translation(self.center.as_dvec3());
        self.to_world = Affine::new(centered).filter(|affine| !affine.is_identity());
        if !self.matrices.is_empty() {
            self.matrices = vec![Matrix::from(place)];
        }
    }

    /// Transforms a point from object space to world space.
    pub fn world_point(&self, p: Vec3) -> Vec3 {
        self.to_world.as_ref().map_or(p, |to_world| to_world.point(p))
    }

    /// Computes the surface in world space at a hit near a given point in object space.
    pub(super) fn surface(
        &self,
        ray: &Ray64,
        point: DVec3,
        crossing: &ShapeHit,
        part: u32,
        rules: &ShadingRules,
    ) -> SurfacePoint {
        let mut surface = SurfacePoint::ZERO;
        self.local_surface(ray, point, crossing, part, rules, &mut surface);
        self.transform_surface(&mut surface, ray, crossing, rules);
        surface
    }

    /// Computes the surface at a hit in object space or, for a solid, in world space.
    pub(super) fn local_surface(
        &self,
        ray: &Ray64,
        point: DVec3,
        crossing: &ShapeHit,
        part: u32,
        rules: &ShadingRules,
        surface: &mut SurfacePoint,
    ) {
        // Each match arm writes directly into the result, because a shared temporary value would
        // have to be copied.
        match &self.geometry {
            Geometry::Primitive(Primitive::Sphere(sphere)) => *surface = sphere.surface(point, crossing),
            Geometry::Primitive(Primitive::Plane(plane)) => *surface = plane.surface(point, crossing),
            Geometry::Primitive(shape) => *surface = shape.surface(point, crossing),
            Geometry::Mesh(tree) => {
                *surface = tree.mesh.surface(part, crossing);
                let spoiled =
                    || tree.mesh.corner_normals(part).is_some_and(|corners| corners.iter().any(|n| n.is_nan()));
                if rules.spoiled_normals && spoiled() {
                    surface.n_shade = Vec3::NAN;
                }
            }
            Geometry::Solid(solid) => *surface = solid.surface(ray, crossing, part, rules),
        }
    }

    /// Transforms a surface to world space in place, which avoids a slow copy.
    #[inline]
    pub(super) fn transform_surface(
        &self,
        surface: &mut SurfacePoint,
        ray: &Ray64,
        crossing: &ShapeHit,
        rules: &ShadingRules,
    ) {
        if matches!(self.geometry, Geometry::Solid(_)) {
            return;
        }
        let shading = |to_world: &Affine, n: Vec3| match rules.moved_normals {
            true => to_world.vector(n).normalize_or(n),
            false => to_world.normal(n),
        };
        if rules.points_on_ray {
            if let Some(to_world) = &self.to_world {
                surface.n_geo = to_world.normal(surface.n_geo);
                surface.n_shade = shading(to_world, surface.n_shade);
            }
            surface.position = ray.rounded.at(crossing.t);
            surface.rounding_error = Vec3::ZERO;
            surface.n_shade *= self.normal_length;
            if rules.mesh_textures && matches!(self.geometry, Geometry::Primitive(_)) {
                surface.uv = Uv::None;
            }
        } else if let Some(to_world) = &self.to_world {
            let error = to_world.point_error(surface.position, surface.error);
            let point = to_world.point64(surface.position);
            surface.position = point.as_vec3();
            surface.rounding_error = (point - surface.position.as_dvec3()).as_vec3();
            // A curved surface also deviates from its tangent plane, by an amount that grows with
            // the square of the error.
            surface.error = error + to_world.error_bound(surface.bulge(to_world.inverse_error_bound(error)));
            surface.n_geo = to_world.normal(surface.n_geo);
            surface.n_shade = shading(to_world, surface.n_shade);
            surface.shadow_offsets = surface.shadow_offsets.map(|lift| to_world.vector(lift));
        } else {
            surface.error += surface.bulge(surface.error);
        }
    }

    /// Returns the object's first hit in the ray's interval. `number` is the object's index. With
    /// `any`, the result may be a hit other than the first.
    #[inline]
    pub(super) fn closest<T: TraversalCounter>(
        &self,
        number: u32,
        ray: &Ray64,
        any: bool,
        counter: &mut T,
    ) -> Option<(ShapeHit, u32)> {
        let moved;
        let local = match &self.to_world {
            Some(to_world) => {
                moved = to_world.inverse_ray(ray);
                &moved
            }
            None => &ray.rounded,
        };
        match &self.geometry {
            Geometry::Primitive(shape) => {
                counter.count_work(0, 1);
                shape.intersect(local).map(|crossing| (crossing, 0))
            }
            Geometry::Mesh(tree) => tree.closest(local, any, counter),
            Geometry::Solid(solid) => solid.closest(ray, ray.side.inside(number), counter),
        }
    }

    /// Intersects a single part of the object. A solid counts as a single part.
    pub(super) fn part<T: TraversalCounter>(
        &self,
        (number, part): (u32, u32),
        ray: &Ray64,
        counter: &mut T,
    ) -> Option<(ShapeHit, u32)> {
        counter.count_work(0, 1);
        let local = self.local_ray(ray);
        let crossing = match &self.geometry {
            Geometry::Primitive(shape) => shape.intersect(&local),
            // The BVH rejects invalid rays, which cannot hit anything.
            Geometry::Mesh(_) if !durer_bvh::internal::is_valid(&local) => None,
            Geometry::Mesh(tree) => tree
                .bvh
                .watertight_ray(&local)
                .intersect(tree.mesh.corners(part), local.t_min, local.t_max)
                .map(ShapeHit::from),
            Geometry::Solid(solid) => return solid.closest(ray, ray.side.inside(number), counter),
        };
        crossing.map(|crossing| (crossing, part))
    }

    /// Returns the cost of intersecting the object, relative to the cost of a sphere, if the object
    /// is a simple shape that can be packed with others. Returns `None` for other shapes and for
    /// transformed objects.
    pub(crate) fn packing_cost(&self) -> Option<usize> {
        use Primitive::{Cuboid, Disc, Plane, Rectangle, Sphere};
        match &self.geometry {
            Geometry::Primitive(Plane(_) | Sphere(_)) if self.to_world.is_none() => Some(1),
            Geometry::Primitive(Disc(_) | Rectangle(_) | Cuboid(_)) if self.to_world.is_none() => Some(2),
            _ => None,
        }
    }

    /// Returns [`Object::packing_cost`] for packs that are tested with a single ray. Boxes are
    /// excluded because they need six divisions each, so a tree is faster for them.
    pub(crate) fn single_ray_packing_cost(&self) -> Option<usize> {
        self.packing_cost().filter(|_| !matches!(&self.geometry, Geometry::Primitive(Primitive::Cuboid(_))))
    }

    /// Returns the hit on a packed shape at a given distance.
    #[inline]
    pub(super) fn crossing_at(&self, t: f32, ray: &Ray64) -> ShapeHit {
        match &self.geometry {
            // Only hits on rectangles and boxes have surface coordinates.
            Geometry::Primitive(shape @ (Primitive::Rectangle(_) | Primitive::Cuboid(_))) => {
                shape.intersect(&ray.rounded).unwrap_or(ShapeHit { t, uv: Vec2::ZERO })
            }
            _ => ShapeHit { t, uv: Vec2::ZERO },
        }
    }

    /// Returns the object's sphere if it is an untransformed sphere, otherwise a sphere with radius
    /// 0.
    pub(crate) fn sphere(&self) -> Sphere {
        match &self.geometry {
            Geometry::Primitive(Primitive::Sphere(sphere)) if self.to_world.is_none() => sphere.clone(),
            _ => Sphere { center: Vec3::ZERO, radius: 0.0 },
        }
    }

    /// Adds a [simple](Object::simple) object to packs. `number` identifies the object in hits.
    pub(crate) fn add_to(&self, packs: &mut PrimitivePacks, number: u32) {
        match &self.geometry {
            Geometry::Primitive(Primitive::Plane(plane)) => packs.push_plane(number, plane.normal, plane.offset),
            Geometry::Primitive(Primitive::Sphere(sphere)) => packs.push_sphere(number, sphere.center, sphere.radius),
            Geometry::Primitive(Primitive::Disc(disc)) => {
                packs.push_disc(number, disc.center, disc.unit_normal(), [disc.inner_radius, disc.radius]);
            }
            Geometry::Primitive(Primitive::Rectangle(r)) => packs.push_rectangle(number, r.corner, [r.edge0, r.edge1]),
            Geometry::Primitive(Primitive::Cuboid(cuboid)) => packs.push_box(number, cuboid.min, cuboid.max),
            _ => {}
        }
    }

    /// Returns true if the object is closed, so that it can contain points.
    fn is_closed(&self) -> bool {
        match &self.geometry {
            Geometry::Primitive(shape) => shape.inside(DVec3::ZERO).is_some(),
            Geometry::Mesh(tree) => tree.is_closed(),
            Geometry::Solid(_) => true,
        }
    }

    /// Returns half the surface area of the object's bounds, which is infinite for unbounded
    /// objects, or `None` if the object is open.
    pub fn half_area(&self) -> Option<f32> {
        self.is_closed().then(|| self.bounds().map_or(f32::INFINITY, |bounds| bounds.half_area()))
    }

    /// Returns true if the object is closed and contains a point in world space.
    pub fn contains(&self, point: Vec3) -> bool {
        if !self.is_closed() {
            return false;
        }
        if let Geometry::Primitive(shape) = &self.geometry {
            let local = self.to_world.as_ref().map_or(point, |to_world| to_world.inverse_point(point));
            return shape.inside(local.as_dvec3()) == Some(true);
        }
        // A line that starts inside crosses a closed surface an odd number of times.
        let mut ray = Ray64::from(Ray::new(point, Vec3::new(0.48, 0.6, 0.64)));
        let next =
            |ray: &mut Ray64| self.closest(0, ray, false, &mut ()).map(|(crossing, _)| ray.rounded.t_min = crossing.t);
        std::iter::from_fn(|| next(&mut ray)).count() % 2 == 1
    }

    /// Returns the number of parts that can be intersected separately.
    pub fn parts(&self) -> u32 {
        match &self.geometry {
            Geometry::Primitive(_) | Geometry::Solid(_) => 1,
            Geometry::Mesh(tree) => tree.mesh.len() as u32,
        }
    }

    /// Returns the bounds in world space, or `None` for an unbounded object.
    pub fn bounds(&self) -> Option<Aabb> {
        let local = self.local_bounds()?;
        Some(if let Geometry::Solid(_) = self.geometry { local } else { self.world_bounds(local) })
    }

    /// Returns the bounds in object space or, for a solid, in world space.
    pub(super) fn local_bounds(&self) -> Option<Aabb> {
        match &self.geometry {
            Geometry::Primitive(shape) => shape.bounds(),
            Geometry::Mesh(tree) => Some(tree.bvh.bounds()),
            Geometry::Solid(solid) => solid.bounds(),
        }
    }

    /// Returns the bounds of one part in world space.
    pub fn part_bounds(&self, part: u32) -> Option<Aabb> {
        match &self.geometry {
            Geometry::Primitive(_) | Geometry::Solid(_) => self.bounds(),
            Geometry::Mesh(tree) => {
                let corners = tree.mesh.corners(part);
                let Some(to_world) = &self.to_world else { return Some(Aabb::around(corners)) };
                // These bounds are tighter than the transformed bounds of the triangle. The empty
                // box around each vertex adds padding for rounding errors.
                let images = corners.map(|c| to_world.bounds(Aabb { min: c, max: c }));
                Some(images.into_iter().fold(Aabb::EMPTY, Aabb::union))
            }
        }
    }

    /// Returns an upper bound on the distance between the true surface and computed hits that can
    /// result from rounded coordinates.
    pub(super) fn rounding_error(&self) -> f32 {
        let reach = self.local_bounds().map_or(Vec3::ZERO, |b| b.min.abs().max(b.max.abs()));
        let error = match &self.to_world {
            Some(to_world) => 8.0 * to_world.point_error(reach, Vec3::ZERO),
            None => gamma(16) * reach,
        };
        error.max_element()
    }

    /// Returns false if the object certainly does not overlap a box in world space. The box must
    /// overlap the object's bounds.
    pub fn overlaps(&self, cell: &Aabb) -> bool {
        match (&self.geometry, &self.to_world) {
            (Geometry::Primitive(shape), None) => shape.overlaps(cell),
            _ => true,
        }
    }

    /// Transforms bounds to world space.
    fn world_bounds(&self, bounds: Aabb) -> Aabb {
        match &self.to_world {
            Some(to_world) if !bounds.is_empty() => to_world.bounds(bounds),
            _ => bounds,
        }
    }
}
