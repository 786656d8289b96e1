//! Shapes that a ray can hit. Each shape has its own file, and [`Primitive`] lists all of them.

mod chord;
pub mod cone;
pub mod cuboid;
pub mod cylinder;
pub mod disc;
pub mod ellipsoid;
pub mod height_field;
pub mod mesh;
mod mesh_data;
pub mod normals;
pub mod plane;
pub mod quadric;
pub mod rectangle;
pub mod sphere;
mod tangents;
pub mod tessellate;
#[cfg(any(test, feature = "testing"))]
#[doc(hidden)]
pub mod testing;
#[cfg(test)]
mod tests;
pub mod torus;
pub mod triangle;
pub mod uv;
pub mod voxels;

use crate::describe::described_list;
use crate::light::{EmitterShape, EmitterTransform};
use crate::math::{Aabb, Line, Ray, Vec2, Vec3, fp, gamma};
pub use cone::Cone;
pub use cuboid::Cuboid;
pub use cylinder::Axis;
pub use cylinder::Cylinder;
pub use disc::Disc;
pub use durer_bvh::watertight;
pub use ellipsoid::Ellipsoid;
use glam::DVec3;
pub use height_field::{HeightField, Terrain};
pub use mesh::{Mesh, MeshData, TriangleMesh};
pub use plane::Plane;
pub use quadric::Quadric;
pub use rectangle::Rectangle;
pub use sphere::Sphere;
pub use torus::Torus;
pub use triangle::Triangle;
pub use uv::Uv;
pub use voxels::VoxelGrid;

macro_rules! delegate {
    ($($variant:ident),+) => {
        // Without this lint, a method that the macro omits would silently use its default for every
        // shape.
        #[deny(clippy::missing_trait_methods)]
        impl Shape for Primitive {
            fn bounds(&self) -> Option<Aabb> {
                match self { $(Primitive::$variant(s) => s.bounds(),)+ }
            }
            fn overlaps(&self, cell: &Aabb) -> bool {
                match self { $(Primitive::$variant(s) => s.overlaps(cell),)+ }
            }
            fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
                match self { $(Primitive::$variant(s) => s.intersect(ray),)+ }
            }
            fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
                match self { $(Primitive::$variant(s) => s.crossings(line, emit),)+ }
            }
            fn axis(&self) -> Option<Axis> {
                match self { $(Primitive::$variant(s) => Shape::axis(s),)+ }
            }
            #[inline(always)]
            fn crossings_about(&self, axis: Option<&Axis>, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
                match self { $(Primitive::$variant(s) => s.crossings_about(axis, line, emit),)+ }
            }
            fn surface(&self, point: DVec3, crossing: &ShapeHit) -> SurfacePoint {
                match self { $(Primitive::$variant(s) => s.surface(point, crossing),)+ }
            }
            fn inside(&self, point: DVec3) -> Option<bool> {
                match self { $(Primitive::$variant(s) => s.inside(point),)+ }
            }
            fn starts_inside(&self, line: &Line) -> bool {
                match self { $(Primitive::$variant(s) => s.starts_inside(line),)+ }
            }
            fn centered(&self) -> Option<(Self, Vec3)> {
                match self { $(Primitive::$variant(s) => s.centered().map(|(s, moved)| (s.into(), moved)),)+ }
            }
            fn validate(&self) -> Result<(), String> {
                match self { $(Primitive::$variant(s) => s.validate(),)+ }
            }
            fn flip(&self) -> Option<Flip> {
                match self { $(Primitive::$variant(s) => s.flip(),)+ }
            }
            fn plane(&self) -> Option<&Plane> {
                match self { $(Primitive::$variant(s) => s.plane(),)+ }
            }
            fn polygons(&self) -> Vec<Vec<Vec3>> {
                match self { $(Primitive::$variant(s) => s.polygons(),)+ }
            }
            fn emitter(&self, transform: &EmitterTransform) -> Option<(EmitterShape, Vec3)> {
                match self { $(Primitive::$variant(s) => s.emitter(transform),)+ }
            }
            fn tangent(&self, point: Vec3) -> Option<Vec3> {
                match self { $(Primitive::$variant(s) => s.tangent(point),)+ }
            }
            fn to_mesh(&self) -> Option<MeshData> {
                match self { $(Primitive::$variant(s) => s.to_mesh(),)+ }
            }
            fn outline(&self, around: &Aabb) -> Option<Vec<Vec<Vec3>>> {
                match self { $(Primitive::$variant(s) => s.outline(around),)+ }
            }
        }
    };
}

described_list! {
    /// A geometric primitive that the scene file itself defines, such as a sphere or a box.
    Primitive: Shape => delegate {
        Sphere(sphere::Sphere),
        Plane(plane::Plane),
        Triangle(triangle::Triangle),
        Cuboid(cuboid::Cuboid),
        Cylinder(cylinder::Cylinder),
        Cone(cone::Cone),
        Torus(torus::Torus),
        Ellipsoid(ellipsoid::Ellipsoid),
        Quadric(quadric::Quadric),
        Disc(disc::Disc),
        Rectangle(rectangle::Rectangle),
    }
}

/// Edit of a scene file that swaps the front and back of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flip {
    /// Swap any two corners, such as the two corners named here.
    Corners([&'static str; 2]),
    /// Swap the two named edges.
    Edges([&'static str; 2]),
    /// Negate the named fields, the first of which is the normal.
    Negate(&'static [&'static str]),
}

/// Intersection of a ray with a shape, from which [`Shape::surface`] computes the surface
/// properties.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHit {
    /// Ray parameter.
    pub t: f32,
    /// Coordinates that [`Shape::surface`] needs. On triangles, they are the second and third
    /// barycentric coordinates. On shapes with several faces, x is the number of the face.
    pub uv: Vec2,
}

/// Point where a ray crosses the surface of a shape, in object space, with its normals and error
/// bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, rounded to single precision.
    pub position: Vec3,
    /// Rounding error of `position`; see [`SurfacePoint::point`].
    pub rounding_error: Vec3,
    /// Bound on the absolute error of the point along each axis.
    pub error: Vec3,
    /// Bound on the curvature in object space, which is 1 over the smallest radius of curvature.
    /// The bound is zero if the surface is flat.
    pub curvature: f32,
    /// Unit normal of the actual surface, in contrast to `n_shade`.
    pub n_geo: Vec3,
    /// Unit normal for shading, which is interpolated on smooth meshes.
    pub n_shade: Vec3,
    /// Texture coordinates.
    pub uv: Uv,
    /// Barycentric coordinates, which are only set on triangles.
    pub barycentric: Vec3,
    /// Offsets from the point to the curved surface that a flat triangle approximates. The first
    /// offset is for the side of `n_shade`, and the second is for the other side. On other shapes,
    /// both offsets are zero. Shadow rays start at the offset points, as described by Hanika,
    /// *Hacking the Shadow Terminator*.
    pub shadow_offsets: [Vec3; 2],
    /// Linear red, green, blue and opacity, interpolated from the vertices of the mesh; all 1 if it
    /// has no vertex colours.
    pub color: [f32; 4],
    /// Number of the solid that this surface bounds, if the solid has several parts. A ray that
    /// leaves the surface uses the number to determine on which side it starts.
    pub solid: Option<u32>,
}

impl SurfacePoint {
    /// Placeholder that consists of zeros, since zeros are the fastest values to write.
    pub const ZERO: SurfacePoint = SurfacePoint {
        position: Vec3::ZERO,
        rounding_error: Vec3::ZERO,
        error: Vec3::ZERO,
        curvature: 0.0,
        n_geo: Vec3::ZERO,
        n_shade: Vec3::ZERO,
        uv: Uv::None,
        barycentric: Vec3::ZERO,
        shadow_offsets: [Vec3::ZERO; 2],
        color: [0.0; 4],
        solid: None,
    };

    /// Creates the surface at a point that was projected onto it in double precision. The error of
    /// the point is its rounding error plus `floor`. The surface is flat unless a curvature is set.
    pub fn new(point: DVec3, normal: DVec3, floor: f32, uv: impl Into<Uv>) -> Self {
        let position = point.as_vec3();
        let n = normal.normalize_or(DVec3::Y).as_vec3();
        let error = gamma(2) * position.abs() + floor;
        SurfacePoint {
            position,
            rounding_error: Vec3::ZERO,
            error,
            curvature: 0.0,
            n_geo: n,
            n_shade: n,
            uv: uv.into(),
            barycentric: Vec3::ZERO,
            shadow_offsets: [Vec3::ZERO; 2],
            color: [1.0; 4],
            solid: None,
        }
    }

    /// Creates a flat surface at a point in space that is accurate to a few roundings.
    pub fn around(point: DVec3, normal: Vec3) -> Self {
        let floor = gamma(4) * point.abs().max_element() as f32;
        SurfacePoint::new(point, normal.as_dvec3(), floor.max(f32::MIN_POSITIVE), Vec2::ZERO)
    }

    /// Returns the point in full precision, which is higher than that of `f32` far from the origin.
    #[inline]
    pub fn point(&self) -> DVec3 {
        self.position.as_dvec3() + self.rounding_error.as_dvec3()
    }

    fn curved(self, curvature: f64) -> Self {
        SurfacePoint { curvature: curvature as f32, ..self }
    }

    /// Returns a bound on the distance between the surface and its tangent plane within `error` of
    /// the point.
    #[inline]
    pub fn bulge(&self, error: Vec3) -> Vec3 {
        0.5 * self.curvature * error.length_squared() * self.n_geo.abs()
    }
}

/// Distance that points keep from the edges of a shape, in units of their error, so that secondary
/// rays also start in front of the neighbouring face. This distance suffices for faces that meet at
/// an angle of more than about 10 degrees, since the start of a ray moves by two errors along the
/// normal.
const INSET: f32 = 16.0;

/// Clamps a coordinate that runs from 0 to `end` across a face, so that it stays [`INSET`] errors
/// away from both ends.
fn inset(x: f64, end: f64, error: f32) -> f64 {
    let margin = f64::from(INSET * error).min(0.25 * end);
    x.clamp(margin, end - margin)
}

/// Returns the points relative to a centre, or `None` if `f32` cannot represent them exactly.
fn exact_offsets<const N: usize>(points: [Vec3; N], center: Vec3) -> Option<[Vec3; N]> {
    let exact = |p: &Vec3| (*p - center).as_dvec3() == p.as_dvec3() - center.as_dvec3();
    points.iter().all(exact).then(|| points.map(|p| p - center))
}

/// Operations that every shape implements. A method has a default only if the default is correct
/// for every shape. A shape overrides such a method only to make it faster.
pub trait Shape {
    /// Returns the bounds in object space, or `None` for an infinite shape.
    fn bounds(&self) -> Option<Aabb>;

    /// True if the shape may intersect a box that overlaps the bounds of the shape.
    fn overlaps(&self, _cell: &Aabb) -> bool {
        true
    }

    /// Calls `emit` for every crossing of a line with the surface, in any order, with the `t` of
    /// the crossing and its coordinates on the shape.
    ///
    /// A line crosses a closed shape only where it enters or leaves the shape. Points where a line
    /// merely touches the shape do not count, so that entries and exits alternate along the line.
    fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2));

    /// Returns the crossing with the smallest `t` inside the ray's open interval.
    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let line = ray.line();
        let mut first: Option<ShapeHit> = None;
        if line.is_valid() {
            self.crossings(&line, &mut |t, uv| {
                let t = t as f32;
                if ray.contains(t) && first.is_none_or(|first| t < first.t) {
                    first = Some(ShapeHit { t, uv });
                }
            });
        }
        first
    }

    /// Returns the axis of a solid of revolution, which is computed once for many rays; see
    /// [`Shape::crossings_about`].
    fn axis(&self) -> Option<Axis> {
        None
    }

    /// Reports crossings as [`Shape::crossings`] does, but reuses the result of [`Shape::axis`].
    #[inline(always)]
    fn crossings_about(&self, _axis: Option<&Axis>, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        self.crossings(line, emit);
    }

    /// Computes the surface properties at a crossing. Apart from rounding, `point` lies on the
    /// surface.
    fn surface(&self, point: DVec3, crossing: &ShapeHit) -> SurfacePoint;

    /// True if the point is inside the shape; `None` for shapes that have no inside.
    fn inside(&self, point: DVec3) -> Option<bool>;

    /// True if the line is inside the shape at t = -infinity, which is never the case for a bounded
    /// shape.
    fn starts_inside(&self, line: &Line) -> bool;

    /// Returns the shape moved to the origin, and the translation that moves it back. Returns
    /// `None` if the shape has no position, or if `f32` cannot represent the result exactly.
    fn centered(&self) -> Option<(Self, Vec3)>
    where
        Self: Sized;

    /// Checks that the fields are valid in combination. The constraints in the description check
    /// each field separately.
    ///
    /// # Errors
    ///
    /// Returns a message that names the fields.
    fn validate(&self) -> Result<(), String>;

    /// Returns the edit that flips the shape, or `None` if the shape is not flat.
    fn flip(&self) -> Option<Flip>;

    /// Returns the shape itself if it is an infinite plane, which divides space into two
    /// half-spaces.
    fn plane(&self) -> Option<&Plane>;

    /// Returns the faces, which are flat and convex, in object space. Each face is a list of its
    /// corners in order. The result is empty for shapes that are infinite or have a curved face or
    /// edge.
    fn polygons(&self) -> Vec<Vec<Vec3>>;

    /// Returns the surface to sample as a light, in world space, and its outward unit normal. The
    /// normal is zero if it varies over the surface. If the result is `None`, only rays that hit
    /// the shape by chance find its light, which causes noise.
    fn emitter(&self, transform: &EmitterTransform) -> Option<(EmitterShape, Vec3)>;

    /// Returns the direction in which the texture coordinate u increases at a point, in object
    /// space. The vector can have any length, and it defines the direction of anisotropic
    /// highlights. If the result is `None`, a direction that is horizontal and perpendicular to the
    /// normal is used.
    fn tangent(&self, point: Vec3) -> Option<Vec3>;

    /// Returns triangles that approximate the shape in object space, or `None` for an infinite
    /// shape.
    fn to_mesh(&self) -> Option<MeshData>;

    /// Returns polylines that depict the shape in a drawing, in object space. For an infinite
    /// shape, only the part near `around` is drawn. If the result is `None`, the bounding box is
    /// drawn.
    fn outline(&self, around: &Aabb) -> Option<Vec<Vec<Vec3>>>;
}

/// Returns the angle of (x, y) around an axis as a fraction of a full turn, in [0, 1], measured
/// from -x.
fn angle_fraction(x: f64, y: f64) -> f32 {
    (fp::atan2(y as f32, x as f32) / std::f32::consts::TAU + 0.5).clamp(0.0, 1.0)
}

/// Returns the bounding box of points in double precision, enlarged by the error of rounding them
/// to `f32`.
fn padded_box(min: DVec3, max: DVec3) -> Aabb {
    let pad = gamma(6) * min.abs().max(max.abs()).max_element() as f32;
    Aabb { min: min.as_vec3() - pad, max: max.as_vec3() + pad }
}

/// Returns half the size of the bounding box of a unit disc.
fn disc_reach(normal: DVec3) -> DVec3 {
    (DVec3::ONE - normal * normal).max(DVec3::ZERO).map(f64::sqrt)
}
