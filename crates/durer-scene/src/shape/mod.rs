//! Shapes that a ray can hit. Each has its own file; [`Primitive`] lists them all.

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
        // Without this lint, an omitted method would silently use its default for every shape.
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

/// Edit of a scene file that swaps the front and the back of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flip {
    /// Swap any two corners, such as these.
    Corners([&'static str; 2]),
    /// Swap the two edges.
    Edges([&'static str; 2]),
    /// Negate these fields, of which the first is the normal.
    Negate(&'static [&'static str]),
}

/// Intersection of a ray with a shape, from which [`Shape::surface`] computes the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHit {
    /// Ray parameter.
    pub t: f32,
    /// Coordinates that [`Shape::surface`] needs: on triangles the second and third barycentric
    /// coordinate; on shapes with several faces, x is the number of the face.
    pub uv: Vec2,
}

/// Point where a ray crosses the surface of a shape, with its normals and error bounds, in object
/// space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, rounded to single precision.
    pub position: Vec3,
    /// Rounding error of `position`: see [`SurfacePoint::point`].
    pub rounding_error: Vec3,
    /// Bound on the absolute error of the point, by axis.
    pub error: Vec3,
    /// Bound on the curvature in object space: 1 over the smallest radius. Zero if flat.
    pub curvature: f32,
    /// Unit normal of the true surface.
    pub n_geo: Vec3,
    /// Unit normal for shading: interpolated on smooth meshes.
    pub n_shade: Vec3,
    /// Texture coordinates.
    pub uv: Uv,
    /// Barycentric coordinates; for triangles only.
    pub barycentric: Vec3,
    /// Offsets from the point to the curved surface that a flat triangle approximates, for the side
    /// of `n_shade` and for the other side. Zero on other shapes. Shadow rays start there; after
    /// Hanika, *Hacking the Shadow Terminator*.
    pub shadow_offsets: [Vec3; 2],
    /// Linear red, green, blue and opacity of the mesh's vertices; all 1 without vertex colours.
    pub color: [f32; 4],
    /// Number of the solid whose boundary this is, if the solid has several parts; a ray that
    /// leaves it uses the number to determine the side where it starts.
    pub solid: Option<u32>,
}

impl SurfacePoint {
    /// Placeholder of zeros, which are the fastest to write.
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

    /// Creates the surface at a point that was projected onto it in double precision. Its error is
    /// its rounding plus `floor`; it is flat unless a curvature is set.
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

    /// Creates a flat surface at a point in space, accurate to a few roundings.
    pub fn around(point: DVec3, normal: Vec3) -> Self {
        let floor = gamma(4) * point.abs().max_element() as f32;
        SurfacePoint::new(point, normal.as_dvec3(), floor.max(f32::MIN_POSITIVE), Vec2::ZERO)
    }

    /// The point in full precision, which is higher than `f32` far from the origin.
    #[inline]
    pub fn point(&self) -> DVec3 {
        self.position.as_dvec3() + self.rounding_error.as_dvec3()
    }

    fn curved(self, curvature: f64) -> Self {
        SurfacePoint { curvature: curvature as f32, ..self }
    }

    /// Bound on the distance of the surface from its tangent plane within an error of the point.
    #[inline]
    pub fn bulge(&self, error: Vec3) -> Vec3 {
        0.5 * self.curvature * error.length_squared() * self.n_geo.abs()
    }
}

/// Distance that points keep from the edges of a shape, in units of their error, so that secondary
/// rays start in front of the neighbouring face too. This holds for faces that meet at more than
/// about 10 degrees, since the start moves by two errors along the normal.
const INSET: f32 = 16.0;

/// Clamps a coordinate on a face from 0 to `end`, so that it is [`INSET`] errors away from both
/// ends.
fn inset(x: f64, end: f64, error: f32) -> f64 {
    let margin = f64::from(INSET * error).min(0.25 * end);
    x.clamp(margin, end - margin)
}

/// Returns points relative to a centre, if `f32` represents them exactly.
fn exact_offsets<const N: usize>(points: [Vec3; N], center: Vec3) -> Option<[Vec3; N]> {
    let exact = |p: &Vec3| (*p - center).as_dvec3() == p.as_dvec3() - center.as_dvec3();
    points.iter().all(exact).then(|| points.map(|p| p - center))
}

/// Operations that every shape implements. A method has a default only if the default is correct
/// for every shape, and overrides are merely faster.
pub trait Shape {
    /// Bounds in object space; `None` for an infinite shape.
    fn bounds(&self) -> Option<Aabb>;

    /// True if the shape may intersect a box that overlaps its bounds.
    fn overlaps(&self, _cell: &Aabb) -> bool {
        true
    }

    /// Offers every crossing of a line with the surface, as `t` and coordinates on the shape, in
    /// any order.
    ///
    /// A closed shape is crossed only where the line enters or leaves. A line that touches it does
    /// not count, so that entries and exits alternate along the line.
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

    /// Axis of a solid of revolution, computed once for many rays: see [`Shape::crossings_about`].
    fn axis(&self) -> Option<Axis> {
        None
    }

    /// Offers crossings as [`Shape::crossings`] does, given the result of [`Shape::axis`].
    #[inline(always)]
    fn crossings_about(&self, _axis: Option<&Axis>, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        self.crossings(line, emit);
    }

    /// Computes the surface at a crossing; `point` is on it up to rounding.
    fn surface(&self, point: DVec3, crossing: &ShapeHit) -> SurfacePoint;

    /// True if a point is inside; `None` for shapes that are surfaces only.
    fn inside(&self, point: DVec3) -> Option<bool>;

    /// True if a line is inside the shape at t = -infinity; `false` for every bounded shape.
    fn starts_inside(&self, line: &Line) -> bool;

    /// Returns the shape translated to the origin, and the translation; `None` if it has no
    /// position, or if `f32` cannot represent the result exactly.
    fn centered(&self) -> Option<(Self, Vec3)>
    where
        Self: Sized;

    /// Checks combinations of fields. The constraints in the description check each field
    /// separately.
    ///
    /// # Errors
    ///
    /// A message that names the fields.
    fn validate(&self) -> Result<(), String>;

    /// Returns the edit that flips a flat shape; `None` for shapes that are not flat.
    fn flip(&self) -> Option<Flip>;

    /// Returns the shape itself if it is an infinite plane, which divides space into two half
    /// spaces.
    fn plane(&self) -> Option<&Plane>;

    /// Returns the flat convex faces, each by its corners in order, in object space. Empty for
    /// shapes that are infinite or have a curved face or edge.
    fn polygons(&self) -> Vec<Vec<Vec3>>;

    /// Returns the surface to sample as a light, in world space, and its outward unit normal; the
    /// normal is zero if it varies. With `None`, only rays that hit the shape by chance find its
    /// light, which is noisy.
    fn emitter(&self, transform: &EmitterTransform) -> Option<(EmitterShape, Vec3)>;

    /// Direction of the texture coordinate u at a point, in object space, of any length; the
    /// direction of anisotropic highlights. `None`: horizontal and perpendicular to the normal.
    fn tangent(&self, point: Vec3) -> Option<Vec3>;

    /// Returns triangles that approximate the shape, in object space; `None` for an infinite shape.
    fn to_mesh(&self) -> Option<MeshData>;

    /// Returns polylines that depict the shape in a drawing, in object space. An infinite shape
    /// draws its part near `around`. With `None`, the box of its bounds is drawn.
    fn outline(&self, around: &Aabb) -> Option<Vec<Vec<Vec3>>>;
}

/// Angle of (x, y) about an axis as a fraction of a full turn, in [0, 1], measured from -x.
fn angle_fraction(x: f64, y: f64) -> f32 {
    (fp::atan2(y as f32, x as f32) / std::f32::consts::TAU + 0.5).clamp(0.0, 1.0)
}

/// Box of points in double precision, enlarged by their rounding to `f32`.
fn padded_box(min: DVec3, max: DVec3) -> Aabb {
    let pad = gamma(6) * min.abs().max(max.abs()).max_element() as f32;
    Aabb { min: min.as_vec3() - pad, max: max.as_vec3() + pad }
}

/// Half the size of the bounds of a unit disc.
fn disc_reach(normal: DVec3) -> DVec3 {
    (DVec3::ONE - normal * normal).max(DVec3::ZERO).map(f64::sqrt)
}
