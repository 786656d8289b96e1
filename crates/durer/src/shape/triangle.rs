//! A single triangle.

use super::watertight::{self, WatertightRay};
use super::{INSET, Shape, ShapeHit, Surface, Uv, exactly};
use crate::describe::{Rule, described};
use crate::dialect::set;
use crate::math::{Aabb, Line, Ray, Vec2, Vec3, gamma};
use glam::DVec3;

described! {
    /// A triangle; its front is where its corners go round counter-clockwise.
    Triangle ["Triangle" in set::CLASSIC, "triangle" in set::F23] {
        /// First corner.
        vertex0: Vec3 = Vec3::ZERO, required, Rule::Any, ["vertex0" in set::ALL];
        /// Second corner.
        vertex1: Vec3 = Vec3::X, required, Rule::Any, ["vertex1" in set::ALL];
        /// Third corner.
        vertex2: Vec3 = Vec3::Y, required, Rule::Any, ["vertex2" in set::ALL];
    }
}

impl Triangle {
    /// Its corners in order.
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

    fn crossings(&self, line: &Line, offer: &mut impl FnMut(f64, Vec2)) {
        let ray = Ray::new(line.origin.as_vec3(), line.dir.as_vec3());
        let found = self.intersect(&Ray { t_min: f32::NEG_INFINITY, ..ray });
        found.into_iter().for_each(|crossing| offer(f64::from(crossing.t), crossing.uv));
    }

    /// Moved by a multiple of a power of two above its size: so neighbours are mostly moved alike,
    /// and still meet in an edge.
    fn centered(&self) -> Option<(Self, Vec3)> {
        let corners = self.corners();
        let size = Aabb::around(corners).size().max_element().max(f32::MIN_POSITIVE);
        let grid = 64.0 * f32::from_bits(size.to_bits() & 0x7f80_0000);
        let center = (self.vertex0 / grid).round() * grid;
        let [vertex0, vertex1, vertex2] = exactly(corners, center)?;
        Some((Triangle { vertex0, vertex1, vertex2 }, center))
    }

    fn surface(&self, _point: DVec3, crossing: &ShapeHit) -> Surface {
        let (position, error, barycentric) = interpolate(self.corners(), crossing.uv);
        let n_geo = face_normal(self.corners());
        Surface {
            position,
            rest: Vec3::ZERO,
            error,
            curvature: 0.0,
            n_geo,
            n_shade: n_geo,
            uv: Uv::At(crossing.uv),
            barycentric,
            shadow_offsets: [Vec3::ZERO; 2],
            color: [1.0; 4],
            solid: None,
        }
    }
}

/// The point with barycentric coordinates (1 - u - v, u, v), a bound on its error, and all three of
/// them. The point keeps off the edges: see [`inset`].
///
/// Source of the bound: *Physically Based Rendering*, 4th edition, section 6.8.3.
#[inline(always)]
pub(super) fn interpolate(corners: [Vec3; 3], uv: Vec2) -> (Vec3, Vec3, Vec3) {
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

/// Barycentric coordinates of a point that lies at least [`INSET`] errors away from all edges,
/// where the given one does not.
#[inline(always)]
fn inset([a, b, c]: [Vec3; 3], barycentric: Vec3, error: Vec3) -> Option<Vec3> {
    // The distance from an edge is the barycentric coordinate times twice the area over the edge's
    // length. All squared.
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

/// The unit normal (b - a) x (c - a); that of a triangle without area points up.
#[inline(always)]
pub(crate) fn face_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    (b - a).cross(c - a).normalize_or(DVec3::Y).as_vec3()
}
