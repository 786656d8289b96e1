//! A single triangle.

use super::watertight::{self, WatertightRay};
use super::{Flip, INSET, MeshData, Plane, Shape, ShapeHit, SurfacePoint, Uv, exact_offsets, tessellate};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::light::{EmitterShape, EmitterTransform};
use crate::math::{Aabb, Line, Ray, Vec2, Vec3, gamma};
use glam::DVec3;

described! {
    /// A triangle; its corners are counter-clockwise when seen from the front.
    Triangle ["Triangle" in set::CLASSIC, "triangle" in set::F23] {
        /// Position of the first corner.
        vertex0: Vec3 = Vec3::ZERO, required, Constraint::Any, ["vertex0" in set::ALL];
        /// Position of the second corner.
        vertex1: Vec3 = Vec3::X, required, Constraint::Any, ["vertex1" in set::ALL];
        /// Position of the third corner.
        vertex2: Vec3 = Vec3::Y, required, Constraint::Any, ["vertex2" in set::ALL];
    }
}

impl Triangle {
    /// Returns the corners in order.
    pub fn corners(&self) -> [Vec3; 3] {
        [self.vertex0, self.vertex1, self.vertex2]
    }
}

impl From<watertight::Crossing> for ShapeHit {
    fn from(watertight::Crossing { t, uv }: watertight::Crossing) -> Self {
        ShapeHit { t, uv }
    }
}

impl Shape for Triangle {
    fn bounds(&self) -> Option<Aabb> {
        Some(Aabb::around(self.corners()))
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        WatertightRay::new(ray).intersect(self.corners(), ray.t_min, ray.t_max).map(ShapeHit::from)
    }

    fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        let ray = Ray::new(line.origin.as_vec3(), line.dir.as_vec3());
        let found = self.intersect(&Ray { t_min: f32::NEG_INFINITY, ..ray });
        found.into_iter().for_each(|crossing| emit(f64::from(crossing.t), crossing.uv));
    }

    /// Moves the triangle by a multiple of a power of two that is larger than its size.
    /// Neighbouring triangles are then mostly moved by the same vector, so they still share edges.
    fn centered(&self) -> Option<(Self, Vec3)> {
        let corners = self.corners();
        let size = Aabb::around(corners).size().max_element().max(f32::MIN_POSITIVE);
        let grid = 64.0 * f32::from_bits(size.to_bits() & 0x7f80_0000);
        let center = (self.vertex0 / grid).round() * grid;
        let [vertex0, vertex1, vertex2] = exact_offsets(corners, center)?;
        Some((Triangle { vertex0, vertex1, vertex2 }, center))
    }

    fn surface(&self, _point: DVec3, crossing: &ShapeHit) -> SurfacePoint {
        SurfacePoint { uv: Uv::Value(crossing.uv), ..triangle_surface(self.corners(), None, crossing.uv) }
    }

    fn inside(&self, _: DVec3) -> Option<bool> {
        None
    }

    fn starts_inside(&self, _: &Line) -> bool {
        false
    }

    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    fn flip(&self) -> Option<Flip> {
        Some(Flip::Corners(["vertex1", "vertex2"]))
    }

    fn plane(&self) -> Option<&Plane> {
        None
    }

    fn polygons(&self) -> Vec<Vec<Vec3>> {
        vec![self.corners().to_vec()]
    }

    fn emitter(&self, transform: &EmitterTransform) -> Option<(EmitterShape, Vec3)> {
        Some(EmitterShape::triangle(self.corners(), transform))
    }

    fn tangent(&self, _: Vec3) -> Option<Vec3> {
        None
    }

    fn to_mesh(&self) -> Option<MeshData> {
        Some(tessellate::triangle(self.corners()))
    }

    fn outline(&self, _: &Aabb) -> Option<Vec<Vec<Vec3>>> {
        Some(vec![vec![self.vertex0, self.vertex1, self.vertex2, self.vertex0]])
    }
}

/// Returns the point with the barycentric coordinates (1 - u - v, u, v), a bound on its error, and
/// all three coordinates. The point is kept away from the edges; see [`inset`].
///
/// Source of the bound: *Physically Based Rendering*, 4th edition, section 6.8.3.
#[inline(always)]
fn interpolate(corners: [Vec3; 3], uv: Vec2) -> (Vec3, Vec3, Vec3) {
    let barycentric = Vec3::new(1.0 - uv.x - uv.y, uv.x, uv.y);
    let (position, error) = weighted(corners, barycentric);
    match inset(corners, barycentric, error) {
        Some(moved) => (weighted(corners, moved).0, error, barycentric),
        None => (position, error, barycentric),
    }
}

#[inline(always)]
fn weighted([a, b, c]: [Vec3; 3], weights: Vec3) -> (Vec3, Vec3) {
    let (wa, ub, vc) = (weights.x * a, weights.y * b, weights.z * c);
    (wa + ub + vc, gamma(7) * (wa.abs() + ub.abs() + vc.abs()))
}

/// Returns the barycentric coordinates of a nearby point that is at least [`INSET`] errors away
/// from all edges, or `None` if the given point already is.
#[inline(always)]
fn inset([a, b, c]: [Vec3; 3], barycentric: Vec3, error: Vec3) -> Option<Vec3> {
    // The distance from an edge is the barycentric coordinate times twice the area, divided by the
    // length of the edge. The comparison uses squares.
    let areas = (b - a).cross(c - a).length_squared();
    let lengths = Vec3::new((c - b).length_squared(), (a - c).length_squared(), (b - a).length_squared());
    let least = lengths * (INSET * INSET * error.length_squared());
    if !(areas * barycentric * barycentric).cmplt(least).any() {
        return None;
    }
    let Vec3 { x, y, z } = least / areas;
    let moved = barycentric.max(Vec3::new(x.sqrt(), y.sqrt(), z.sqrt()).min(Vec3::splat(0.25)));
    Some(moved / moved.element_sum())
}

/// Returns the unit normal of (b - a) x (c - a), or +y for a degenerate triangle.
#[inline(always)]
pub fn face_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    (b - a).cross(c - a).normalize_or(DVec3::Y).as_vec3()
}

/// Computes the surface of a triangle at a crossing, without texture coordinates or colour. If the
/// shading normal is zero, it is replaced by the geometric normal.
#[inline(always)]
pub fn triangle_surface(corners: [Vec3; 3], normals: Option<[Vec3; 3]>, uv: Vec2) -> SurfacePoint {
    let (position, error, barycentric) = interpolate(corners, uv);
    let n_geo = face_normal(corners);
    let (mut n_shade, mut shadow_offsets) = (n_geo, [Vec3::ZERO; 2]);
    // Closures passed to `map_or` would not be inlined here.
    if let Some(normals) = normals {
        n_shade = interpolate_vectors(normals, barycentric).normalize_or(n_geo);
        let [front, back] = corner_offsets(position, corners, normals);
        shadow_offsets = [interpolate_vectors(front, barycentric), interpolate_vectors(back, barycentric)];
    }
    // The stored normals define the outside, regardless of the order of the corners.
    let n_geo = if n_geo.dot(n_shade) < 0.0 { -n_geo } else { n_geo };
    SurfacePoint {
        position,
        rounding_error: Vec3::ZERO,
        error,
        curvature: 0.0,
        n_geo,
        n_shade,
        uv: Uv::None,
        barycentric,
        shadow_offsets,
        color: [1.0; 4],
        solid: None,
    }
}

#[inline(always)]
fn interpolate_vectors([a, b, c]: [Vec3; 3], barycentric: Vec3) -> Vec3 {
    barycentric.x * a + barycentric.y * b + barycentric.z * c
}

/// Returns, for each corner, the offset from a point on the triangle up to the tangent plane at the
/// corner. The offset is zero if the point is above that plane. The second array contains the
/// offsets for the other side of the triangle.
///
/// The barycentric mean of the offsets leads to the curved surface that the normals imply. A shadow
/// ray that starts on the curved surface does not hit the flat neighbouring triangles. Such hits
/// would darken whole triangles of a coarse mesh along the terminator. Source: Johannes Hanika,
/// *Hacking the Shadow Terminator*, Ray Tracing Gems II (2021), chapter 4.
#[inline(always)]
fn corner_offsets(point: Vec3, corners: [Vec3; 3], normals: [Vec3; 3]) -> [[Vec3; 3]; 2] {
    let mut shadow_offsets = [[Vec3::ZERO; 3]; 2];
    for i in 0..3 {
        let n = normals[i].normalize_or_zero();
        let height = (corners[i] - point).dot(n);
        let way = height * n;
        (shadow_offsets[0][i], shadow_offsets[1][i]) = if height < 0.0 { (Vec3::ZERO, way) } else { (way, Vec3::ZERO) };
    }
    shadow_offsets
}
