//! The things in a world, and how a ray meets them.

use crate::bvh::{Preset, Tally, TriangleBvh};
use crate::math::{Aabb, Affine, Ray, Vec2};
use crate::shape::{Crossing, Mesh, Primitive, Shape};
use std::sync::Arc;

/// One thing in the world.
#[derive(Debug)]
pub struct Object {
    /// What it is, in object space.
    pub geometry: Geometry,
    /// From object to world space; `None` where they are the same.
    pub to_world: Option<Affine>,
    /// Number of its material.
    pub material: u32,
    /// Where it is written.
    pub span: crate::diag::Span,
}

/// The form of an object.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// A shape of one part.
    Primitive(Primitive),
    /// A mesh, shared by all objects that show it.
    Mesh(Arc<MeshTree>),
}

/// A mesh with its own tree.
#[derive(Debug)]
pub struct MeshTree {
    /// The mesh.
    pub mesh: Mesh,
    /// Its triangles' tree.
    pub bvh: TriangleBvh,
}

impl MeshTree {
    /// Builds the tree.
    pub fn new(mesh: Mesh) -> Self {
        let bvh = TriangleBvh::build(mesh.positions(), mesh.triangles(), Preset::Balanced);
        MeshTree { mesh, bvh }
    }

    /// The same, blind to triangles seen from their sides: see [`TriangleBvh::least_volume`].
    pub fn least_volume(self, least_volume: f64) -> Self {
        MeshTree { bvh: self.bvh.least_volume(least_volume), ..self }
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        self.mesh.bytes() + self.bvh.bytes()
    }

    /// The first hit in the ray's interval; `any` ends at the first found.
    #[inline]
    fn closest<T: Tally>(&self, ray: &Ray, any: bool, tally: &mut T) -> Option<(Crossing, u32)> {
        if any {
            let found = self.bvh.occluded_counting(ray, tally);
            return found.then_some((Crossing { t: ray.t_min, uv: Vec2::ZERO }, 0));
        }
        let hit = self.bvh.closest_counting(ray, tally)?;
        Some((Crossing { t: hit.t, uv: hit.uv }, hit.triangle))
    }
}

impl Object {
    pub(super) fn local_ray(&self, ray: &Ray) -> Ray {
        self.to_world.as_ref().map_or(*ray, |to_world| to_world.inverse_ray(ray))
    }

    /// The object's first hit in the ray's interval.
    pub(super) fn closest<T: Tally>(&self, ray: &Ray, any: bool, tally: &mut T) -> Option<(Crossing, u32)> {
        let ray = self.local_ray(ray);
        match &self.geometry {
            Geometry::Primitive(shape) => {
                tally.test();
                shape.intersect(&ray).map(|crossing| (crossing, 0))
            }
            Geometry::Mesh(tree) => tree.closest(&ray, any, tally),
        }
    }

    /// The crossing with one part, tested directly.
    pub(super) fn part<T: Tally>(&self, ray: &Ray, part: u32, tally: &mut T) -> Option<Crossing> {
        tally.test();
        let ray = self.local_ray(ray);
        match &self.geometry {
            Geometry::Primitive(shape) => shape.intersect(&ray),
            // Refused like by the tree: such a ray hits nothing.
            Geometry::Mesh(_) if !crate::bvh::is_sound(&ray) => None,
            Geometry::Mesh(tree) => tree.bvh.sheared(&ray).intersect(tree.mesh.corners(part), ray.t_min, ray.t_max),
        }
    }

    /// How many parts it has.
    pub fn parts(&self) -> u32 {
        match &self.geometry {
            Geometry::Primitive(_) => 1,
            Geometry::Mesh(tree) => tree.mesh.len() as u32,
        }
    }

    /// Bounds in world space; `None` for a shape without end.
    pub fn bounds(&self) -> Option<Aabb> {
        let local = match &self.geometry {
            Geometry::Primitive(shape) => shape.bounds()?,
            Geometry::Mesh(tree) => tree.bvh.bounds(),
        };
        Some(self.moved(local))
    }

    /// Bounds of one part in world space.
    pub fn part_bounds(&self, part: u32) -> Option<Aabb> {
        match &self.geometry {
            Geometry::Primitive(_) => self.bounds(),
            Geometry::Mesh(tree) => {
                let corners = tree.mesh.corners(part);
                let Some(to_world) = &self.to_world else { return Some(Aabb::around(corners)) };
                // Tighter than the box of the box, and padded for rounding by a box without size at each corner.
                let images = corners.map(|c| to_world.bounds(Aabb { min: c, max: c }));
                Some(images.into_iter().fold(Aabb::EMPTY, Aabb::union))
            }
        }
    }

    /// Whether some of it may lie in a box of world space that overlaps its bounds.
    pub fn overlaps(&self, cell: &Aabb) -> bool {
        match (&self.geometry, &self.to_world) {
            (Geometry::Primitive(shape), None) => shape.overlaps(cell),
            _ => true,
        }
    }

    fn moved(&self, bounds: Aabb) -> Aabb {
        match &self.to_world {
            Some(to_world) if !bounds.is_empty() => to_world.bounds(bounds),
            _ => bounds,
        }
    }
}
