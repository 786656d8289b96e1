//! Ray intersection as performed by the course's programs of 2012 to 2023: object by object, in
//! single precision, and with the same order of operations. Differences in the last bit are visible
//! in pictures of objects that are distant, seen at a grazing angle, or as large as the ground.
//!
//! The sources are the starter code of the assignments, whose spheres, groups, cameras and octree
//! the official programs share, and, for everything else, pictures rendered by these programs.

mod matrix;
mod octree;
mod shapes;

use super::{Accel, Geometry, Hit, MeshTree, Object, World};
use durer_bvh::{Bvh, TraversalCounter};
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::math::{Aabb, Ray, Ray64, Vec3};
use durer_scene::shape::Primitive;
pub use matrix::Matrix;
use octree::Octree;
use shapes::{Crossing, HitInterval};
use std::collections::HashMap;
use std::sync::Arc;

/// Vector library whose arithmetic an official program uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VectorLibrary {
    /// The course's own library vecmath, used from 2012 to 2019.
    Vecmath,
    /// The library glm, used since 2020.
    Glm,
}

impl VectorLibrary {
    /// Returns the initial value of a sum, given its first term. The course's own library starts
    /// each sum with 0, so its sums are never -0. The sign of a zero decides whether a ray passes
    /// through an octree cell.
    fn sum_from(self, first: f32) -> f32 {
        match self {
            VectorLibrary::Vecmath => 0.0 + first,
            VectorLibrary::Glm => first,
        }
    }

    /// Returns the ray direction that is used to traverse an octree. It has unit length in the
    /// arithmetic of the course's own library.
    fn traversal_direction(self, dir: Vec3) -> Vec3 {
        match self {
            VectorLibrary::Vecmath => self.unit(dir),
            VectorLibrary::Glm => dir,
        }
    }

    /// Normalizes a vector. Returns NaN for a zero vector.
    pub fn unit(self, v: Vec3) -> Vec3 {
        match self {
            VectorLibrary::Vecmath => v / v.length(),
            VectorLibrary::Glm => v * (1.0 / v.dot(v).sqrt()),
        }
    }
}

/// Ray intersection rules of an official program, which the dialect selects when a scene is
/// compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HitRules {
    /// Arithmetic used to transform rays and to compute directions to lights. With glm, every
    /// object transforms the ray as the difference of two points, even if its transform is the
    /// identity.
    pub vectors: VectorLibrary,
    /// True if triangles are intersected by inverting a matrix, false if their plane and areas are
    /// used.
    pub triangle_matrix: bool,
    /// True if a triangle takes precedence over earlier objects hit at the same distance.
    pub tied_triangles: bool,
    /// True if a hit on a plane exactly at the start of a ray counts.
    pub closed_planes: bool,
    /// True if a hit on a sphere exactly at the start of a ray counts, as in the starter code of
    /// 2020. If false, such a hit is placed at distance 10000, as in earlier starter code.
    pub closed_spheres: bool,
    /// True if the normal of an untransformed plane keeps the length that it has in the scene file.
    pub raw_normals: bool,
    /// True if meshes are traversed with an octree that misses the far half of some cells.
    pub octree: bool,
}

/// Objects of a world, prepared for intersection with the arithmetic of an official program of the
/// course.
#[derive(Clone, Debug)]
pub struct CourseAccel {
    rules: HitRules,
    objects: Vec<CourseObject>,
}

/// Object of a world, prepared for intersection with the arithmetic of an official program.
#[derive(Clone, Debug)]
struct CourseObject {
    /// Inverses of the enclosing transforms, outermost first.
    inverses: Vec<Matrix>,
    /// Order in which the triangles of a mesh are tested; `None` for other shapes.
    walk: Option<Arc<MeshOrder>>,
}

/// Order in which the triangles of a mesh are visited to reproduce an official program's hits.
#[derive(Debug)]
enum MeshOrder {
    /// BVH of all triangles, for programs in which the order of visits does not matter.
    Boxes(Bvh),
    /// Octree of the starter code, which does not visit all triangles.
    Octree(Octree),
}

impl CourseAccel {
    /// Prepares the objects of a world.
    pub(crate) fn new(rules: HitRules, objects: &[Object]) -> Self {
        // Several objects can share one mesh.
        let mut walks: HashMap<*const MeshTree, Arc<MeshOrder>> = HashMap::new();
        let objects = objects.iter().map(|object| {
            let walk = match &object.geometry {
                Geometry::Mesh(tree) => {
                    let make = || Arc::new(MeshOrder::new(rules, tree));
                    Some(walks.entry(Arc::as_ptr(tree)).or_insert_with(make).clone())
                }
                _ => None,
            };
            let inverses = object.matrices.iter().map(|matrix| matrix.inverse(rules.vectors)).collect();
            CourseObject { inverses, walk }
        });
        CourseAccel { rules, objects: objects.collect() }
    }

    /// Returns the first hit in a ray's interval.
    pub(crate) fn closest<T: TraversalCounter>(&self, objects: &[Object], ray: &Ray64, counter: &mut T) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        for (number, (prepared, object)) in (0..).zip(self.objects.iter().zip(objects)) {
            let local = self.local(prepared, &ray.rounded);
            let limits =
                HitInterval { t_min: ray.rounded.t_min, t_max: ray.rounded.t_max, best: best.map(|hit| hit.t) };
            let mut offer = |crossing: Option<Crossing>, part: u32| {
                if let Some(Crossing { t, uv }) = crossing {
                    best = Some(Hit { t, uv, object: number, part });
                }
            };
            match &object.geometry {
                Geometry::Primitive(Primitive::Sphere(sphere)) => {
                    counter.count_work(0, 1);
                    offer(shapes::sphere(sphere, &local, limits, self.rules), 0);
                }
                Geometry::Primitive(Primitive::Plane(plane)) => {
                    counter.count_work(0, 1);
                    offer(shapes::plane(plane, &local, limits, self.rules.closed_planes), 0);
                }
                Geometry::Primitive(Primitive::Triangle(triangle)) => {
                    counter.count_work(0, 1);
                    offer(shapes::triangle(triangle.corners(), &local, limits, self.rules), 0);
                }
                Geometry::Mesh(tree) => {
                    if let Some((crossing, part)) = prepared.mesh(tree, &local, limits, self.rules, counter) {
                        offer(Some(crossing), part);
                    }
                }
                // The course has no such shapes.
                Geometry::Primitive(_) | Geometry::Solid(_) => {
                    let found = object.closest(number, ray, false, counter);
                    let found = found.filter(|(crossing, _)| limits.takes(crossing.t, false));
                    if let Some((crossing, part)) = found {
                        offer(Some(Crossing { t: crossing.t, uv: crossing.uv }), part);
                    }
                }
            }
        }
        best
    }

    /// Transforms a ray into the space of an object.
    fn local(&self, object: &CourseObject, ray: &Ray) -> Ray {
        let mut local = *ray;
        match self.rules.vectors {
            VectorLibrary::Vecmath => {
                for inverse in &object.inverses {
                    local.origin = inverse.point(local.origin, VectorLibrary::Vecmath);
                    local.dir = inverse.vector(local.dir);
                }
            }
            VectorLibrary::Glm => {
                let inverse = object.inverses.first().unwrap_or(&Matrix::IDENTITY);
                local.origin = inverse.point(ray.origin, VectorLibrary::Glm);
                local.dir = inverse.point(ray.origin + ray.dir, VectorLibrary::Glm) - local.origin;
            }
        }
        local
    }

    /// Returns the normal of a sphere or plane in world space, or `None` for other shapes. The
    /// rounding of the normal decides where mirrored rays hit the ground again if the ground is a
    /// sphere of radius 1000 or a plane whose normal is not of unit length.
    fn normal(&self, objects: &[Object], ray: &Ray, hit: &Hit) -> Option<Vec3> {
        let (object, vectors) = (&self.objects[hit.object as usize], self.rules.vectors);
        let own = match &objects[hit.object as usize].geometry {
            Geometry::Primitive(Primitive::Sphere(sphere)) => {
                let local = self.local(object, ray);
                vectors.unit(local.origin + hit.t * local.dir - sphere.center)
            }
            Geometry::Primitive(Primitive::Plane(plane)) if self.rules.raw_normals || vectors == VectorLibrary::Glm => {
                plane.normal
            }
            Geometry::Primitive(Primitive::Plane(plane)) => vectors.unit(plane.normal),
            _ => return None,
        };
        let moved = |n, inverse: &Matrix| vectors.unit(inverse.across(n, vectors));
        let n = match vectors {
            VectorLibrary::Vecmath => object.inverses.iter().rev().fold(own, moved),
            VectorLibrary::Glm => moved(own, object.inverses.first().unwrap_or(&Matrix::IDENTITY)),
        };
        n.is_finite().then_some(n)
    }

    /// Returns the memory used, in bytes.
    pub fn memory_usage(&self) -> usize {
        let walk = |object: &CourseObject| match object.walk.as_deref() {
            Some(MeshOrder::Boxes(bvh)) => bvh.memory_usage(),
            Some(MeshOrder::Octree(octree)) => octree.memory_usage(),
            None => 0,
        };
        self.objects.iter().map(|object| size_of::<CourseObject>() + walk(object)).sum()
    }
}

impl CourseObject {
    /// Returns the first hit on a mesh and the index of its triangle.
    fn mesh<T: TraversalCounter>(
        &self,
        tree: &MeshTree,
        ray: &Ray,
        mut limits: HitInterval,
        rules: HitRules,
        counter: &mut T,
    ) -> Option<(Crossing, u32)> {
        let mut best: Option<(Crossing, u32)> = None;
        match self.walk.as_deref()? {
            MeshOrder::Octree(octree) => {
                octree.walk(ray.origin, rules.vectors.traversal_direction(ray.dir), &mut |part| {
                    counter.count_work(0, 1);
                    if let Some(crossing) = shapes::triangle(tree.mesh.corners(part), ray, limits, rules) {
                        limits.best = Some(crossing.t);
                        best = Some((crossing, part));
                    }
                })
            }
            MeshOrder::Boxes(bvh) => bvh.traverse(ray, counter, |item, t_max, _| {
                let part = bvh.primitive_indices()[item];
                let Some(crossing) = shapes::triangle(tree.mesh.corners(part), ray, limits, rules) else {
                    return t_max;
                };
                // The result is the same as if all triangles were tested in file order.
                let wins = best.is_none_or(|(hit, known)| {
                    crossing.t < hit.t || crossing.t == hit.t && (part > known) == rules.tied_triangles
                });
                if wins {
                    best = Some((crossing, part));
                }
                t_max.min(crossing.t.next_up())
            }),
        }
        best
    }
}

impl MeshOrder {
    fn new(rules: HitRules, tree: &MeshTree) -> Self {
        let corners = |part| tree.mesh.corners(part);
        let boxes = (0..tree.mesh.len() as u32).map(|part| Aabb::around(corners(part)));
        if rules.octree {
            return MeshOrder::Octree(Octree::new(boxes.collect()));
        }
        // In this arithmetic, a ray can hit a triangle slightly outside the triangle's bounding
        // box.
        let whole = tree.bvh.bounds();
        let pad = 1e-5 * (whole.min.abs().max(whole.max.abs()) + whole.size());
        let padded: Vec<Aabb> = boxes.map(|b| Aabb { min: b.min - pad, max: b.max + pad }).collect();
        MeshOrder::Boxes(Bvh::build(&padded))
    }
}

impl World {
    /// Returns the normal at a hit in an official program's arithmetic, if the rounding of the
    /// normal matters.
    pub(super) fn course_normal(&self, ray: &Ray, hit: &Hit) -> Option<Vec3> {
        match self.accel() {
            Accel::Course(hits) => hits.normal(self.objects(), ray, hit),
            _ => None,
        }
    }

    /// Returns the direction and distance to a light in an official program's arithmetic. Returns
    /// `None` for Dürer's own arithmetic and for lights that the course does not have.
    pub fn course_light_direction(&self, light: usize, point: Vec3) -> Option<(Vec3, f32)> {
        let vectors = self.hit_rules()?.vectors;
        match &self.lights()[light] {
            Light::Point(emitter) => {
                let to_emitter = emitter.position - point;
                Some((vectors.unit(to_emitter), to_emitter.length()))
            }
            Light::Directional(sun) => Some((-vectors.unit(sun.direction().unwrap_or(Vec3::NEG_Y)), f32::MAX)),
            _ => None,
        }
    }
}
