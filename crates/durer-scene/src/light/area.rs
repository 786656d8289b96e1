//! Area lights: emitting surfaces in world space, and methods to sample points on them.

use super::affine_body::{AffineBody, ClosedBody};
use super::emitter_point::{EmitterPoint, EmitterTransform, ON_SURFACE, one_minus_cosine};
use crate::bsdf::{Frame, warp};
use crate::math::{Aabb, Vec2, Vec3, fp};
use glam::{DVec2, DVec3};
use std::f32::consts::PI;

/// Shape of an area light in world space, on which points can be sampled. Positions have double
/// precision, as ray hits do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EmitterShape {
    /// Triangle, given by a corner and two edges.
    Triangle(DVec3, [Vec3; 2]),
    /// Parallelogram, given by a corner and two edges.
    Parallelogram(DVec3, [Vec3; 2]),
    /// Ellipse, given by its centre, two half axes at any angle, and the inner radius as a fraction
    /// of the outer radius.
    Ellipse(DVec3, [Vec3; 2], f32),
    /// Sphere, given by its centre and radius.
    Sphere(DVec3, f32),
    /// Box, ellipsoid, cone, cylinder or ring.
    Closed(AffineBody),
}

impl EmitterShape {
    /// Creates a triangle from its corners in object space. Returns it together with its unit
    /// normal in world space.
    pub fn triangle([a, b, c]: [Vec3; 3], transform: &EmitterTransform) -> (EmitterShape, Vec3) {
        let n = (b - a).as_dvec3().cross((c - a).as_dvec3()).normalize_or_zero().as_vec3();
        let edges = [transform.vector(b - a), transform.vector(c - a)];
        (EmitterShape::Triangle(transform.point(a), edges), transform.normal(n))
    }

    /// Places a body in the world. `axes` are the images of the x, y and z axes in object space.
    /// The returned normal is 0, since a body has normals in all directions. Returns `None` if the
    /// image has no volume.
    pub fn body(
        transform: &EmitterTransform,
        body: ClosedBody,
        center: Vec3,
        axes: [Vec3; 3],
    ) -> Option<(EmitterShape, Vec3)> {
        let closed = AffineBody::new(body, transform.point(center), axes.map(|axis| transform.vector(axis)))?;
        Some((EmitterShape::Closed(closed), Vec3::ZERO))
    }

    /// Creates a cone or cylinder between two points, with the given radius at each point.
    pub fn frustum(transform: &EmitterTransform, ends: [Vec3; 2], radii: [f32; 2]) -> Option<(EmitterShape, Vec3)> {
        // The larger disc is the base of the body.
        let ([base, top], [large, small]) = match radii[0] >= radii[1] {
            true => (ends, radii),
            false => ([ends[1], ends[0]], [radii[1], radii[0]]),
        };
        let frame = Frame::around((top - base).normalize_or(Vec3::Y));
        let axes = [large * frame.tangent, large * frame.bitangent, top - base];
        EmitterShape::body(transform, ClosedBody::Frustum(small / large), base, axes)
    }

    /// Surface area in world space.
    pub fn area(&self) -> f32 {
        match self {
            EmitterShape::Triangle(_, [e, f]) => 0.5 * e.cross(*f).length(),
            EmitterShape::Parallelogram(_, [e, f]) => e.cross(*f).length(),
            EmitterShape::Ellipse(_, [u, v], inner) => PI * u.cross(*v).length() * (1.0 - inner * inner),
            EmitterShape::Sphere(_, radius) => 4.0 * PI * radius * radius,
            EmitterShape::Closed(closed) => closed.area(),
        }
    }

    /// Returns true if a point is behind a flat shape, or in its plane.
    pub fn is_behind(&self, normal: Vec3, point: DVec3) -> bool {
        match *self {
            EmitterShape::Triangle(p, _) | EmitterShape::Parallelogram(p, _) | EmitterShape::Ellipse(p, ..) => {
                offset(point, p).dot(normal) <= 0.0
            }
            EmitterShape::Sphere(..) | EmitterShape::Closed(_) => false,
        }
    }

    /// True if the shape has normals in all directions.
    pub fn is_round(&self) -> bool {
        matches!(self, EmitterShape::Sphere(..) | EmitterShape::Closed(..))
    }

    /// True for a sphere or an ellipsoid. Their visible cap is sampled from its middle outwards.
    pub fn is_ball(&self) -> bool {
        matches!(self, EmitterShape::Sphere(..)) || matches!(self, EmitterShape::Closed(closed) if closed.is_ball())
    }

    /// Bounding box in world space.
    pub fn bounds(&self) -> Aabb {
        let near = |p: DVec3| p.as_vec3();
        match *self {
            EmitterShape::Triangle(p, [e, f]) => Aabb::around([near(p), near(p) + e, near(p) + f]),
            EmitterShape::Parallelogram(p, [e, f]) => {
                Aabb::around([near(p), near(p) + e, near(p) + f, near(p) + e + f])
            }
            EmitterShape::Ellipse(p, [u, v], _) => {
                let reach = (u * u + v * v).map(f32::sqrt);
                Aabb { min: near(p) - reach, max: near(p) + reach }
            }
            EmitterShape::Sphere(center, radius) => Aabb { min: near(center) - radius, max: near(center) + radius },
            EmitterShape::Closed(closed) => closed.bounds(),
        }
    }

    /// Samples a point as seen from the point `from`, or returns `None` if no point is visible.
    ///
    /// A rectangle whose longest edge is shorter than `area_limit` times its distance is sampled
    /// uniformly by area, which is faster than sampling by solid angle. At a limit of 0.1, the pdf
    /// deviates by less than a tenth.
    pub fn sample(&self, normal: Vec3, from: DVec3, u: Vec2, area_limit: f32) -> Option<EmitterPoint> {
        let to = match *self {
            EmitterShape::Triangle(p, [e, f]) => {
                let b = warp::triangle(u);
                offset(p, from) + b.y * e + b.z * f
            }
            EmitterShape::Parallelogram(p, [e, f]) => {
                let corner = offset(p, from);
                if let Some(window) = SphericalRectangle::new(corner, e, f, area_limit) {
                    let wi = window.sample(u);
                    let distance = wi.length();
                    let wi = wi / distance;
                    return Some(EmitterPoint {
                        wi,
                        distance,
                        cosine: -wi.dot(normal),
                        pdf: 1.0 / window.solid_angle as f32,
                    });
                }
                corner + u.x * e + u.y * f
            }
            EmitterShape::Ellipse(p, [x, y], inner) => {
                let d = sample_ring(u, inner);
                offset(p, from) + d.x * x + d.y * y
            }
            EmitterShape::Sphere(center, radius) => return sample_sphere(offset(center, from), radius, u),
            EmitterShape::Closed(closed) => return closed.sample(from, u),
        };
        let distance = to.length();
        let wi = to / distance;
        let cosine = -wi.dot(normal);
        let pdf = distance * distance / (cosine.abs() * self.area());
        (pdf.is_finite() && pdf > 0.0).then_some(EmitterPoint { wi, distance, cosine, pdf })
    }

    /// Pdf per solid angle with which [`EmitterShape::sample`] chooses a direction that hits the
    /// surface at `distance`.
    pub fn pdf(&self, normal: Vec3, from: DVec3, wi: Vec3, distance: f32, area_limit: f32) -> f32 {
        let window = match *self {
            EmitterShape::Sphere(center, radius) => {
                let to = offset(center, from);
                let (d2, r2) = (to.length_squared(), radius * radius);
                if is_in_sphere(d2, r2) {
                    return distance * distance / (self.area() * sphere_cosine(to, wi, distance, radius));
                }
                return 1.0 / (2.0 * PI * one_minus_cosine(r2 / d2));
            }
            EmitterShape::Closed(closed) => return closed.pdf(from, wi, distance),
            EmitterShape::Parallelogram(p, [e, f]) => SphericalRectangle::new(offset(p, from), e, f, area_limit),
            EmitterShape::Triangle(..) | EmitterShape::Ellipse(..) => None,
        };
        match window {
            Some(window) => 1.0 / window.solid_angle as f32,
            None => distance * distance / (wi.dot(normal).abs() * self.area()),
        }
    }

    /// Samples a point on the surface uniformly by area. Returns the point, its normal and the pdf
    /// per area.
    pub fn point(&self, normal: Vec3, u: Vec2) -> Option<(DVec3, Vec3, f32)> {
        let (point, normal) = match *self {
            EmitterShape::Triangle(p, [e, f]) => {
                let b = warp::triangle(u);
                (p + (b.y * e + b.z * f).as_dvec3(), normal)
            }
            EmitterShape::Parallelogram(p, [e, f]) => (p + (u.x * e + u.y * f).as_dvec3(), normal),
            EmitterShape::Ellipse(p, [x, y], inner) => {
                let d = sample_ring(u, inner);
                (p + (d.x * x + d.y * y).as_dvec3(), normal)
            }
            EmitterShape::Sphere(center, radius) => {
                let n = warp::sphere(u);
                (center + f64::from(radius) * n.as_dvec3(), n)
            }
            EmitterShape::Closed(closed) => return closed.point(u),
        };
        let density = 1.0 / self.area();
        density.is_finite().then_some((point, normal, density))
    }
}

/// Maps `u` to the ring between the radii `inner` and 1, uniformly by area.
fn sample_ring(u: Vec2, inner: f32) -> Vec2 {
    let d = warp::disc(u);
    // The area of a ring grows with the square of its outer radius.
    let square = inner * inner + (1.0 - inner * inner) * d.length_squared();
    if inner > 0.0 { d.normalize_or(Vec2::X) * square.sqrt() } else { d }
}

/// Vector from one point to another.
fn offset(to: DVec3, from: DVec3) -> Vec3 {
    (to - from).as_vec3()
}

/// True if a point lies inside or on a sphere, given its squared distance from the centre and the
/// squared radius. Rounding can move a point on the surface to either side. In both cases it counts
/// as inside, from where only the inside of the sphere is visible.
fn is_in_sphere(d2: f32, r2: f32) -> bool {
    d2 <= r2 * (1.0 + ON_SURFACE)
}

/// Cosine between a direction and the normal of the sphere at the point that the direction hits
/// from inside. `to` is the vector to the centre.
fn sphere_cosine(to: Vec3, wi: Vec3, distance: f32, radius: f32) -> f32 {
    ((distance * wi - to) / radius).dot(wi).abs().max(1e-6)
}

/// Samples a point on a sphere, uniformly over the solid angle in which the sphere is visible.
///
/// Source: *Physically Based Rendering*, 4th edition, section 6.2.4.
fn sample_sphere(to: Vec3, radius: f32, u: Vec2) -> Option<EmitterPoint> {
    let (d2, r2) = (to.length_squared(), radius * radius);
    let d = d2.sqrt();
    if is_in_sphere(d2, r2) {
        // Inside the sphere, sample its surface uniformly by area.
        let at = to + radius * warp::sphere(u);
        let distance = at.length();
        let wi = at / distance;
        let cosine = sphere_cosine(to, wi, distance, radius);
        let pdf = distance * distance / (4.0 * PI * r2 * cosine);
        // The outside of the sphere is never visible from inside.
        return pdf.is_finite().then_some(EmitterPoint { wi, distance, cosine: -cosine, pdf });
    }
    let all = one_minus_cosine(r2 / d2);
    let below = all * u.x;
    let cosine = 1.0 - below;
    let sine2 = (below * (2.0 - below)).max(0.0);
    let (sin, cos) = fp::sin_cos_turn(u.y);
    let frame = Frame::around(to / d);
    let wi = frame.to_world(Vec3::new(sine2.sqrt() * cos, sine2.sqrt() * sin, cosine)).normalize();
    // Find the first point at which the direction hits the sphere.
    let half = (r2 - d2 * sine2).max(0.0).sqrt();
    let distance = d * cosine - half;
    Some(EmitterPoint { wi, distance, cosine: half / radius, pdf: 1.0 / (2.0 * PI * all) })
}

/// Rectangular light as seen from a shading point, for uniform sampling by solid angle.
///
/// Source: Ureña, Fajardo and King, *An Area-Preserving Parametrization for Spherical Rectangles*,
/// EGSR 2013.
struct SphericalRectangle {
    axes: [DVec3; 3],
    near: DVec3,
    far: DVec3,
    solid_angle: f64,
    b: [f64; 2],
    /// Cosine and sine of the angle at which sampling starts.
    k: DVec2,
}

impl SphericalRectangle {
    /// Returns `None` for a parallelogram without right angles, or for one that appears so small or
    /// so flat that sampling by area suffices; see [`EmitterShape::sample`].
    fn new(corner: Vec3, e: Vec3, f: Vec3, area_limit: f32) -> Option<SphericalRectangle> {
        let middle = corner + 0.5 * (e + f);
        if e.length_squared().max(f.length_squared()) < area_limit * area_limit * middle.length_squared() {
            return None;
        }
        let (e, f, corner) = (e.as_dvec3(), f.as_dvec3(), corner.as_dvec3());
        let (le, lf) = (e.length(), f.length());
        if e.dot(f).abs() > 1e-6 * le * lf {
            return None;
        }
        let (x, y) = (e / le, f / lf);
        let z = x.cross(y);
        let z = if corner.dot(z) > 0.0 { -z } else { z };
        let near = DVec3::new(corner.dot(x), corner.dot(y), corner.dot(z));
        let far = DVec3::new(near.x + le, near.y + lf, near.z);
        if near.z > -1e-4 * le.max(lf) {
            return None;
        }
        // Cosines of the angles between the normals of the four planes through the edges.
        let nz = |a: f64| a / (a * a + near.z * near.z).sqrt();
        let [n0, n1, n2, n3] = [-nz(near.y), nz(far.x), nz(far.y), -nz(near.x)];
        // Represent angles as complex numbers, so that a product adds the angles modulo full turns.
        let angle = |cosine: f64| DVec2::new(cosine, ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt());
        let [g0, g1, g2, g3] = [angle(-n0 * n1), angle(-n1 * n2), angle(-n2 * n3), angle(-n3 * n0)];
        let right = g2.rotate(g3);
        let all = g0.rotate(g1).rotate(right);
        let turns = fp::atan2_turn_f64(all.y, all.x);
        let solid_angle = std::f64::consts::TAU * if turns < 0.0 { turns + 1.0 } else { turns };
        let k = DVec2::new(right.x, -right.y);
        // `turns` has an error of 2e-9, which is too large for small angles. A slightly negative
        // result would also wrap around to a full turn.
        let known = turns.abs() > 1e-4;
        known.then_some(SphericalRectangle { axes: [x, y, z], near, far, solid_angle, b: [n0, n2], k })
    }

    /// Samples a point on the rectangle, relative to the viewpoint.
    fn sample(&self, u: Vec2) -> Vec3 {
        let (near, far, [b0, b1]) = (self.near, self.far, self.b);
        let (sin, cos) = fp::sin_cos_f64(f64::from(u.x) * self.solid_angle);
        let around = self.k.rotate(DVec2::new(cos, sin));
        let fu = (around.x * b0 - b1) / around.y;
        let cu = (1.0 / (fu * fu + b0 * b0).sqrt()).copysign(fu).clamp(-1.0, 1.0);
        let x = (-(cu * near.z) / (1.0 - cu * cu).max(1e-30).sqrt()).clamp(near.x, far.x);
        let d2 = x * x + near.z * near.z;
        let (h0, h1) = (near.y / (d2 + near.y * near.y).sqrt(), far.y / (d2 + far.y * far.y).sqrt());
        let h = h0 + f64::from(u.y) * (h1 - h0);
        let y = if h * h < 1.0 - 1e-12 { h * d2.sqrt() / (1.0 - h * h).sqrt() } else { far.y };
        (x * self.axes[0] + y.clamp(near.y, far.y) * self.axes[1] + near.z * self.axes[2]).as_vec3()
    }
}
