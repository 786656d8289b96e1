//! Tracers from other Rust crates, used as their documentation shows.

use crate::rays::{BenchHit, Mesh};
use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use durer::math::{Ray, Vec3};
use glam::Vec3A;
use nalgebra::{Point3, Vector3};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh_from_tris};
use parry3d::query::RayCast;
use parry3d::shape::TriMesh;

/// Mesh in the crate obvhs: an eight-wide compressed BVH, and its triangles in the order of the
/// leaves.
pub struct Obvhs {
    tree: CwBvh,
    triangles: Vec<obvhs::triangle::Triangle>,
}

impl Obvhs {
    /// Builds the BVH of a mesh.
    pub fn build(mesh: &Mesh) -> Self {
        let corner = |i: u32| Vec3A::from(mesh.vertices[i as usize].to_array());
        let triangles: Vec<_> = mesh
            .triangles
            .iter()
            .map(|t| obvhs::triangle::Triangle { v0: corner(t[0]), v1: corner(t[1]), v2: corner(t[2]) })
            .collect();
        let tree = build_cwbvh_from_tris(&triangles, BvhBuildParams::slow_build(), &mut Default::default());
        let ordered = tree.primitive_indices.iter().map(|&i| triangles[i as usize]).collect();
        Obvhs { tree, triangles: ordered }
    }

    fn ray(ray: &Ray) -> obvhs::ray::Ray {
        let [origin, dir] = [ray.origin, ray.dir].map(|v| Vec3A::from(v.to_array()));
        obvhs::ray::Ray::new(origin, dir, ray.t_min, ray.t_max)
    }

    /// Returns the closest hit of a ray.
    pub fn closest(&self, ray: &Ray) -> BenchHit {
        let mut hit = obvhs::ray::RayHit::none();
        match self.tree.ray_traverse(Self::ray(ray), &mut hit, |ray, id| self.triangles[id].intersect(ray)) {
            true => BenchHit { t: hit.t, triangle: self.tree.primitive_indices[hit.primitive_id as usize] },
            false => BenchHit::NONE,
        }
    }

    /// Returns true if a ray hits anything.
    pub fn occluded(&self, ray: &Ray) -> bool {
        !self.tree.ray_traverse_miss(Self::ray(ray), |ray, id| self.triangles[id].intersect(ray))
    }
}

/// Mesh in the crate bvh: a binary BVH that returns candidate triangles, those in the nearest boxes
/// first.
pub struct BvhCrate {
    tree: bvh::bvh::Bvh<f32, 3>,
    triangles: Vec<Corners>,
}

/// Triangle of a mesh as the crate bvh needs it, with the index of its leaf.
struct Corners {
    points: [Point3<f32>; 3],
    number: u32,
    node: usize,
}

impl Bounded<f32, 3> for Corners {
    fn aabb(&self) -> Aabb<f32, 3> {
        self.points.iter().fold(Aabb::empty(), |b, p| b.grow(p))
    }
}

impl BHShape<f32, 3> for Corners {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }
    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl BvhCrate {
    /// Builds the BVH of a mesh.
    pub fn build(mesh: &Mesh) -> Self {
        let point = |v: Vec3| Point3::new(v.x, v.y, v.z);
        let mut triangles: Vec<Corners> = (0..mesh.triangles.len() as u32)
            .map(|number| Corners { points: mesh.corners(number).map(point), number, node: 0 })
            .collect();
        BvhCrate { tree: bvh::bvh::Bvh::build(&mut triangles), triangles }
    }

    fn ray(ray: &Ray) -> bvh::ray::Ray<f32, 3> {
        let (o, d) = (ray.origin, ray.dir);
        bvh::ray::Ray::new(Point3::new(o.x, o.y, o.z), Vector3::new(d.x, d.y, d.z))
    }

    /// Returns the distance to a triangle. Tests both sides, because the crate's test is one-sided.
    fn test(query: &bvh::ray::Ray<f32, 3>, [a, b, c]: &[Point3<f32>; 3]) -> f32 {
        query.intersects_triangle(a, b, c).distance.min(query.intersects_triangle(a, c, b).distance)
    }

    /// Returns the closest hit of a ray.
    pub fn closest(&self, ray: &Ray) -> BenchHit {
        // The crate normalises ray directions.
        let (query, unit) = (Self::ray(ray), ray.dir.length());
        let mut best = BenchHit { t: ray.t_max * unit, triangle: u32::MAX };
        for candidate in self.tree.nearest_traverse_iterator(&query, &self.triangles) {
            if query.intersection_slice_for_aabb(&candidate.aabb()).is_some_and(|(near, _)| near > best.t) {
                break;
            }
            let t = Self::test(&query, &candidate.points);
            if t < best.t && t > ray.t_min {
                best = BenchHit { t, triangle: candidate.number };
            }
        }
        if best.triangle == u32::MAX { BenchHit::NONE } else { BenchHit { t: best.t / unit, ..best } }
    }

    /// Returns true if a ray hits anything.
    pub fn occluded(&self, ray: &Ray) -> bool {
        let (query, t_max) = (Self::ray(ray), ray.t_max * ray.dir.length());
        self.tree.traverse_iterator(&query, &self.triangles).any(|c| Self::test(&query, &c.points) < t_max)
    }
}

/// Mesh in the crate parry3d, a library for collision detection.
pub struct Parry(TriMesh);

impl Parry {
    /// Builds the mesh and its BVH.
    pub fn build(mesh: &Mesh) -> Self {
        let vertices = mesh.vertices.iter().map(|v| parry3d::math::Vector::new(v.x, v.y, v.z)).collect();
        Parry(TriMesh::new(vertices, mesh.triangles.clone()).expect("the mesh has triangles"))
    }

    fn cast(&self, ray: &Ray) -> Option<BenchHit> {
        let vector = |v: Vec3| parry3d::math::Vector::new(v.x, v.y, v.z);
        let query = parry3d::query::Ray::new(vector(ray.origin), vector(ray.dir));
        let hit = self.0.cast_local_ray_and_get_normal(&query, ray.t_max, true)?;
        // Indices from `count` on are triangles that are hit from behind.
        let count = self.0.indices().len() as u32;
        let parry3d::shape::FeatureId::Face(face) = hit.feature else { return None };
        Some(BenchHit { t: hit.time_of_impact, triangle: face % count })
    }

    /// Returns the closest hit of a ray.
    pub fn closest(&self, ray: &Ray) -> BenchHit {
        self.cast(ray).unwrap_or(BenchHit::NONE)
    }

    /// Returns true if a ray hits anything.
    pub fn occluded(&self, ray: &Ray) -> bool {
        let vector = |v: Vec3| parry3d::math::Vector::new(v.x, v.y, v.z);
        let query = parry3d::query::Ray::new(vector(ray.origin), vector(ray.dir));
        self.0.intersects_local_ray(&query, ray.t_max)
    }
}
