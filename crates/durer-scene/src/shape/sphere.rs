//! A sphere with the equation |p - center|^2 = radius^2.

use super::{Flip, MeshData, Plane, Shape, ShapeHit, SurfacePoint, Uv, tessellate};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::light::{ClosedBody, EmitterShape, EmitterTransform};
use crate::math::{Aabb, Line, Ray, Vec2, Vec3, fp, gamma};
use glam::DVec3;

described! {
    /// A sphere.
    Sphere ["Sphere" in set::CLASSIC, "sphere" in set::F23] {
        /// Centre of the sphere.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::CLASSIC];
        /// Radius, in world units.
        radius: f32 = 1.0, required, Constraint::Positive, ["radius" in set::ALL];
    }
}

impl Sphere {
    /// Solves |origin + t dir - center|^2 = radius^2 in double precision.
    ///
    /// The discriminant is computed from the point of the ray that is nearest to the centre, so it
    /// is accurate even for small, distant spheres. Source: Haines, Günther, Akenine-Möller, *Ray
    /// Tracing Gems* (2019), chapter 7.
    fn roots(&self, line: &Line) -> Option<[f64; 2]> {
        let o = line.origin - self.center.as_dvec3();
        let d = line.dir;
        let r = f64::from(self.radius);
        let dd = d.dot(d);
        let b = -o.dot(d);
        let nearest = o + (b / dd) * d;
        let discriminant = r * r - nearest.dot(nearest);
        // A direction of zero gives NaN.
        if discriminant.is_nan() || discriminant < 0.0 {
            return None;
        }
        // Give q the sign of b, so that neither root suffers from cancellation.
        let c = o.dot(o) - r * r;
        let q = b + (dd * discriminant).sqrt().copysign(b);
        let (t0, t1) = if q == 0.0 { (0.0, 0.0) } else { (c / q, q / dd) };
        Some(if t0 < t1 { [t0, t1] } else { [t1, t0] })
    }
}

impl Shape for Sphere {
    fn bounds(&self) -> Option<Aabb> {
        let pad = gamma(2) * (self.center.abs() + self.radius);
        Some(Aabb { min: self.center - self.radius - pad, max: self.center + self.radius + pad })
    }

    /// True if the bounding sphere of the box intersects this sphere. This box test is the one used
    /// in the course, and it has false positives.
    fn overlaps(&self, cell: &Aabb) -> bool {
        let reach = self.radius + 0.5 * cell.size().length();
        (cell.center() - self.center).length() <= reach * (1.0 + gamma(8))
    }

    fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        for t in self.roots(line).into_iter().flatten() {
            emit(t, Vec2::ZERO);
        }
    }

    fn intersect(&self, ray: &Ray) -> Option<ShapeHit> {
        let [near, far] = self.roots(&ray.line())?.map(|t| t as f32);
        let t = if ray.contains(near) { near } else { far };
        ray.contains(t).then_some(ShapeHit { t, uv: Vec2::ZERO })
    }

    fn inside(&self, point: DVec3) -> Option<bool> {
        let r = f64::from(self.radius);
        Some((point - self.center.as_dvec3()).length_squared() < r * r)
    }

    fn centered(&self) -> Option<(Self, Vec3)> {
        Some((Sphere { center: Vec3::ZERO, ..self.clone() }, self.center))
    }

    #[inline(always)]
    fn surface(&self, point: DVec3, _crossing: &ShapeHit) -> SurfacePoint {
        let offset = point - self.center.as_dvec3();
        let normal = offset.normalize_or(DVec3::Z).as_vec3();
        // Project the point back onto the sphere, so that it is as accurate as its coordinates can
        // be.
        let position = self.center + self.radius * normal;
        let error = gamma(3) * (self.center.abs() + self.radius * normal.abs());
        SurfacePoint {
            position,
            rounding_error: Vec3::ZERO,
            error,
            curvature: 1.0 / self.radius,
            n_geo: normal,
            n_shade: normal,
            uv: Uv::Sphere(normal),
            barycentric: Vec3::ZERO,
            shadow_offsets: [Vec3::ZERO; 2],
            color: [1.0; 4],
            solid: None,
        }
    }

    fn starts_inside(&self, _: &Line) -> bool {
        false
    }

    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    fn flip(&self) -> Option<Flip> {
        None
    }

    fn plane(&self) -> Option<&Plane> {
        None
    }

    fn polygons(&self) -> Vec<Vec<Vec3>> {
        Vec::new()
    }

    fn emitter(&self, transform: &EmitterTransform) -> Option<(EmitterShape, Vec3)> {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| transform.vector(self.radius * axis));
        let radius = axes[0].length();
        // A transform can turn the sphere into an ellipsoid, which is sampled as an affine body.
        let round = axes.iter().all(|axis| (axis.length() - radius).abs() < 1e-5 * radius)
            && axes[0].dot(axes[1]).abs() + axes[1].dot(axes[2]).abs() + axes[2].dot(axes[0]).abs()
                < 1e-5 * radius * radius;
        match round {
            true => Some((EmitterShape::Sphere(transform.point(self.center), radius), Vec3::ZERO)),
            false => EmitterShape::body(
                transform,
                ClosedBody::Ball,
                self.center,
                [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| self.radius * axis),
            ),
        }
    }

    fn tangent(&self, point: Vec3) -> Option<Vec3> {
        Some(Vec3::Y.cross(point - self.center))
    }

    fn to_mesh(&self) -> Option<MeshData> {
        Some(tessellate::ball(self.center, self.radius))
    }

    fn outline(&self, _: &Aabb) -> Option<Vec<Vec<Vec3>>> {
        /// Number of segments in a circle.
        const STEPS: u32 = 32;
        let circle = |u: Vec3, v: Vec3| {
            let point = |i: u32| {
                let (sin, cos) = fp::sin_cos_degrees(360.0 * f64::from(i) / f64::from(STEPS));
                self.center + self.radius * (cos as f32 * u + sin as f32 * v)
            };
            (0..=STEPS).map(point).collect()
        };
        Some(vec![circle(Vec3::X, Vec3::Y), circle(Vec3::Y, Vec3::Z), circle(Vec3::Z, Vec3::X)])
    }
}
