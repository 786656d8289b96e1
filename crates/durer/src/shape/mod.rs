//! Shapes: what a ray can hit. One file each; the list is [`Primitive`].

pub mod mesh;
pub mod normals;
pub mod plane;
pub mod sphere;
#[cfg(test)]
mod tests;
pub mod triangle;
pub mod voxels;
pub mod watertight;

use crate::described_list;
use crate::math::{Aabb, Ray, Vec2, Vec3};
pub use mesh::{Mesh, MeshData, TriangleMesh};
pub use plane::Plane;
pub use sphere::Sphere;
pub use triangle::Triangle;
pub use voxels::VoxelGrid;

described_list! {
    /// A shape that is given in the scene file itself.
    Primitive {
        Sphere(sphere::Sphere),
        Plane(plane::Plane),
        Triangle(triangle::Triangle),
    }
}

/// Where a ray meets a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Position along the ray.
    pub t: f32,
    /// Coordinates on the shape, from which [`Shape::surface`] knows the place: the second and third
    /// barycentric coordinate on triangles, unused elsewhere.
    pub uv: Vec2,
}

/// What a shape is like at a crossing, in object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point.
    pub position: Vec3,
    /// Bound on the absolute error of the point, by axis.
    pub error: Vec3,
    /// Bound on the curvature, in object space: one over the least radius. Zero on what is flat.
    pub curvature: f32,
    /// Unit normal of the true surface.
    pub n_geo: Vec3,
    /// Unit normal for shading: interpolated on smooth meshes.
    pub n_shade: Vec3,
    /// Texture coordinates; `None` where the shape has none.
    pub uv: Option<Vec2>,
    /// Barycentric coordinates; of use on triangles.
    pub barycentric: Vec3,
    /// From the point to the bent surface that a flat triangle stands for: where it is seen from the side of `n_shade`,
    /// and from the other. Zero on what is as it looks. A shadow ray starts there; after Hanika, *Hacking the Shadow Terminator*.
    pub lifts: [Vec3; 2],
}

impl Surface {
    /// How far the surface may fall away from its tangent plane within an error of the point.
    pub fn bulge(&self, error: Vec3) -> Vec3 {
        0.5 * self.curvature * error.length_squared() * self.n_geo.abs()
    }
}

/// What every shape can do.
pub trait Shape {
    /// Bounds in object space; `None` for a shape without end.
    fn bounds(&self) -> Option<Aabb>;

    /// Whether some of it may lie in a box that overlaps its bounds.
    fn overlaps(&self, _cell: &Aabb) -> bool {
        true
    }

    /// The crossing of least `t` inside the ray's open interval.
    fn intersect(&self, ray: &Ray) -> Option<Crossing>;

    /// The surface at a crossing that `intersect` found on this ray.
    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface;
}

macro_rules! delegate {
    ($($variant:ident),+) => {
        impl Shape for Primitive {
            fn bounds(&self) -> Option<Aabb> {
                match self { $(Primitive::$variant(s) => s.bounds(),)+ }
            }
            fn overlaps(&self, cell: &Aabb) -> bool {
                match self { $(Primitive::$variant(s) => s.overlaps(cell),)+ }
            }
            fn intersect(&self, ray: &Ray) -> Option<Crossing> {
                match self { $(Primitive::$variant(s) => s.intersect(ray),)+ }
            }
            fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
                match self { $(Primitive::$variant(s) => s.surface(ray, crossing),)+ }
            }
        }
    };
}
delegate!(Sphere, Plane, Triangle);
