//! Closed emitters: boxes, ellipsoids, cones, cylinders and rings, transformed by any affine map.
//!
//! Each emitter is the image of a body of fixed size under an affine map. Points are sampled on
//! that body. The pdf is then converted to a pdf per area in world space, based on how much the map
//! stretches the surface.

use super::emitter_point::{EmitterPoint, ON_SURFACE, one_minus_cosine};
use crate::bsdf::{Frame, warp};
use crate::math::{Aabb, Vec2, Vec3, fp};
use glam::DVec3;
use std::f32::consts::{PI, TAU};

/// Closed body of fixed size, whose image under an affine map is an area light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClosedBody {
    /// Cube that extends from -1 to 1 on each axis.
    Cube,
    /// Ball of radius 1.
    Ball,
    /// Frustum between a disc of radius 1 at z = 0 and a disc at z = 1 with this radius, which is
    /// at most 1.
    Frustum(f32),
    /// Solid torus of all points within this distance of the circle of radius 1 around the z axis.
    Ring(f32),
}

/// Area light that is the image of a [`ClosedBody`] under an affine map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AffineBody {
    center: DVec3,
    axes: [Vec3; 3],
    body: ClosedBody,
}

/// Number of points used to compute a mean over a surface.
const POINTS: u16 = 64;

/// Position of point `i` in a regular grid on the unit square.
fn spread(i: u16) -> Vec2 {
    Vec2::new(f32::from(i % 8) + 0.5, f32::from(i / 8) + 0.5) / 8.0
}

impl AffineBody {
    /// Creates the image of a body under an affine map. `axes` are the images of the x, y and z
    /// axes. Returns `None` if the image has no volume.
    pub fn new(body: ClosedBody, center: DVec3, axes: [Vec3; 3]) -> Option<AffineBody> {
        let body_image = AffineBody { center, axes, body };
        let most: f32 = axes.iter().map(|axis| axis.length()).product();
        (most.is_finite() && body_image.volume().abs() > 1e-6 * most && most > 0.0).then_some(body_image)
    }

    /// True if the body is an ellipsoid.
    pub fn is_ball(&self) -> bool {
        self.body == ClosedBody::Ball
    }

    fn volume(&self) -> f32 {
        let [x, y, z] = self.axes;
        x.cross(y).dot(z)
    }

    /// Image of a vector under the affine map.
    fn vector(&self, v: Vec3) -> Vec3 {
        v.x * self.axes[0] + v.y * self.axes[1] + v.z * self.axes[2]
    }

    /// Image of a surface element, which is given as its normal times its area.
    fn area_vector(&self, n: Vec3) -> Vec3 {
        let [x, y, z] = self.axes;
        self.volume().signum() * (n.x * y.cross(z) + n.y * z.cross(x) + n.z * x.cross(y))
    }

    /// Vector in body space whose image is `v`.
    fn inverse(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = self.axes;
        Vec3::new(y.cross(z).dot(v), z.cross(x).dot(v), x.cross(y).dot(v)) / self.volume()
    }

    /// Point in body space whose image is `from`. It is computed in double precision because the
    /// map of a needle-shaped body shrinks one axis and stretches another.
    fn origin(&self, from: DVec3) -> Vec3 {
        let ([x, y, z], v) = (self.axes.map(|axis| axis.as_dvec3()), from - self.center);
        (DVec3::new(y.cross(z).dot(v), z.cross(x).dot(v), x.cross(y).dot(v)) / x.cross(y).dot(z)).as_vec3()
    }

    /// Surface area in world space, accurate to a few percent.
    pub fn area(&self) -> f32 {
        let mean = |value: &dyn Fn(Vec2) -> f32| (0..POINTS).map(|i| value(spread(i))).sum::<f32>() / f32::from(POINTS);
        match self.body {
            ClosedBody::Cube => 2.0 * self.faces().iter().sum::<f32>(),
            ClosedBody::Ball => 4.0 * PI * mean(&|u| self.area_vector(warp::sphere(u)).length()),
            ClosedBody::Frustum(top) => {
                let [base, top, side] = self.parts(top);
                base + top + side
            }
            ClosedBody::Ring(minor) => {
                let area = |u: Vec2| {
                    let (n, stretch) = ring_normal(u, minor);
                    stretch * self.area_vector(n).length()
                };
                TAU * TAU * minor * mean(&area)
            }
        }
    }

    /// Area in world space of the box face perpendicular to each axis.
    fn faces(&self) -> [f32; 3] {
        [Vec3::X, Vec3::Y, Vec3::Z].map(|n| 4.0 * self.area_vector(n).length())
    }

    /// Areas of the two caps of a frustum, and the approximate area of its side.
    fn parts(&self, top: f32) -> [f32; 3] {
        let cap = PI * self.area_vector(Vec3::Z).length();
        let side = (0..8).map(|i| self.side_stretch(fp::sin_cos_turn(i as f32 / 8.0), top)).sum::<f32>() / 8.0;
        [cap, top * top * cap, PI * (1.0 + top) * side]
    }

    /// Area element of a frustum's side in world space, per unit of angle, height and radius.
    fn side_stretch(&self, (sin, cos): (f32, f32), top: f32) -> f32 {
        self.area_vector(Vec3::new(cos, sin, 1.0 - top)).length()
    }

    /// Bounding box in world space.
    pub fn bounds(&self) -> Aabb {
        let [x, y, z] = self.axes;
        let center = self.center.as_vec3();
        let disc = (x * x + y * y).map(f32::sqrt);
        match self.body {
            ClosedBody::Cube => around(center, x.abs() + y.abs() + z.abs()),
            ClosedBody::Ball => around(center, (x * x + y * y + z * z).map(f32::sqrt)),
            ClosedBody::Frustum(top) => around(center, disc).union(around(center + z, top * disc)),
            ClosedBody::Ring(minor) => around(center, (1.0 + minor) * disc + minor * z.abs()),
        }
    }

    /// Samples a point on the surface as seen from the point `from`.
    pub fn sample(&self, from: DVec3, u: Vec2) -> Option<EmitterPoint> {
        let origin = self.origin(from);
        if self.body == ClosedBody::Ball && !is_within_ball(origin) {
            return self.cone(origin, u);
        }
        let (point, n, density) = self.sample_body(u, Some(origin))?;
        let to = self.vector(point - origin);
        let distance = to.length();
        let wi = to / distance;
        let cosine = -wi.dot(self.area_vector(n).normalize_or_zero());
        // Only the outside of a convex body is visible from outside, and only its inside from
        // inside.
        let hidden = match self.contains(origin) {
            Some(true) => cosine > 0.0,
            Some(false) => cosine < 0.0,
            None => false,
        };
        let pdf = density * distance * distance / cosine.abs();
        (!hidden && pdf.is_finite() && pdf > 0.0).then_some(EmitterPoint { wi, distance, cosine, pdf })
    }

    /// Pdf per solid angle with which [`AffineBody::sample`] chooses a direction that hits the
    /// surface at `distance`.
    pub fn pdf(&self, from: DVec3, wi: Vec3, distance: f32) -> f32 {
        let origin = self.origin(from);
        let direction = self.inverse(wi);
        if self.body == ClosedBody::Ball && !is_within_ball(origin) {
            let all = one_minus_cosine(1.0 / origin.length_squared());
            let length = direction.length();
            return 1.0 / (TAU * all * length * length * length * self.volume().abs());
        }
        let (n, density) = self.density(origin + distance * direction, origin);
        density * distance * distance / wi.dot(self.area_vector(n).normalize_or_zero()).abs()
    }

    /// Samples a point on the entire surface. Returns the point, its normal and the pdf per area.
    pub fn point(&self, u: Vec2) -> Option<(DVec3, Vec3, f32)> {
        let (point, n, density) = self.sample_body(u, None)?;
        let normal = self.area_vector(n).try_normalize()?;
        (density.is_finite() && density > 0.0).then(|| (self.center + self.vector(point).as_dvec3(), normal, density))
    }

    /// Samples a point on an ellipsoid, uniformly over the solid angle of the ball in body space.
    fn cone(&self, origin: Vec3, u: Vec2) -> Option<EmitterPoint> {
        let d2 = origin.length_squared();
        let d = d2.sqrt();
        let all = one_minus_cosine(1.0 / d2);
        let below = all * u.x;
        let (cosine, sine2) = (1.0 - below, (below * (2.0 - below)).max(0.0));
        let (sin, cos) = fp::sin_cos_turn(u.y);
        let local = Vec3::new(sine2.sqrt() * cos, sine2.sqrt() * sin, cosine);
        let direction = Frame::around(-origin / d).to_world(local).normalize();
        let half = (1.0 - d2 * sine2).max(0.0).sqrt();
        let reach = d * cosine - half;
        let to = self.vector(direction);
        let length = to.length();
        let wi = to / length;
        let normal = self.area_vector(origin + reach * direction).normalize_or_zero();
        let pdf = length * length * length / (TAU * all * self.volume().abs());
        (pdf.is_finite() && pdf > 0.0).then(|| EmitterPoint {
            wi,
            distance: reach * length,
            cosine: (-wi.dot(normal)).max(0.0),
            pdf,
        })
    }

    /// True if a point in body space lies inside the body or on its surface, so that only the
    /// inside is visible from it. `None` for a ring, for which this does not determine the visible
    /// side.
    fn contains(&self, p: Vec3) -> Option<bool> {
        match self.body {
            ClosedBody::Cube => Some(is_within_cube(p)),
            ClosedBody::Ball => Some(is_within_ball(p)),
            ClosedBody::Frustum(top) => {
                let radius = 1.0 + (top - 1.0) * p.z;
                let (low, high) = (-ON_SURFACE, 1.0 + ON_SURFACE);
                Some(p.z >= low && p.z <= high && Vec2::new(p.x, p.y).length() <= radius + ON_SURFACE)
            }
            ClosedBody::Ring(_) => None,
        }
    }

    /// Areas of the faces of a box that are visible from a point in body space, for each sign of
    /// each axis.
    fn visible(&self, from: Option<Vec3>) -> [[f32; 2]; 3] {
        let faces = self.faces();
        let from = from.filter(|p| !is_within_cube(*p));
        std::array::from_fn(|axis| {
            [-1.0, 1.0].map(|sign| {
                let seen = from.is_none_or(|p| sign * p[axis] > 1.0);
                if seen { faces[axis] } else { 0.0 }
            })
        })
    }

    /// Samples a point on the body. Returns the point, its normal, and the pdf per area in world
    /// space. On a box, only the faces visible from the point `from` are sampled.
    fn sample_body(&self, u: Vec2, from: Option<Vec3>) -> Option<(Vec3, Vec3, f32)> {
        match self.body {
            ClosedBody::Cube => {
                let visible = self.visible(from);
                let all: f32 = visible.iter().flatten().sum();
                let mut rest = u.x * all;
                let chosen = (0..6).filter(|i| visible[i / 2][i % 2] > 0.0).find(|i| {
                    let own = visible[i / 2][i % 2];
                    let found = rest < own;
                    rest -= if found { 0.0 } else { own };
                    found
                })?;
                let (axis, high) = (chosen / 2, chosen % 2 == 1);
                let across = [2.0 * rest / visible[axis][usize::from(high)] - 1.0, 2.0 * u.y - 1.0];
                let sign = if high { 1.0 } else { -1.0 };
                let mut point = Vec3::splat(sign);
                point[(axis + 1) % 3] = across[0];
                point[(axis + 2) % 3] = across[1];
                Some((point, sign * Vec3::AXES[axis], 1.0 / all))
            }
            ClosedBody::Ball => {
                let n = warp::sphere(u);
                Some((n, n, 1.0 / (4.0 * PI * self.area_vector(n).length())))
            }
            ClosedBody::Frustum(top) => {
                let [base, lid, side] = self.parts(top);
                let all = base + lid + side;
                let rest = u.x * all;
                if rest < base + lid {
                    let is_base = rest < base;
                    let share = if is_base { rest / base } else { (rest - base) / lid };
                    let d = warp::disc(Vec2::new(share, u.y)) * if is_base { 1.0 } else { top };
                    let z = if is_base { 0.0 } else { 1.0 };
                    return Some((Vec3::new(d.x, d.y, z), if is_base { -Vec3::Z } else { Vec3::Z }, 1.0 / all));
                }
                let share = ((rest - base - lid) / side).min(1.0);
                let growth = top - 1.0;
                // Sample heights with a density proportional to the radius at each height.
                let mean = 0.5 * (1.0 + top);
                let height = 2.0 * share * mean / (1.0 + (1.0 + 2.0 * growth * share * mean).max(0.0).sqrt());
                let (sin, cos) = fp::sin_cos_turn(u.y);
                let radius = 1.0 + growth * height;
                let density = side / all / (TAU * mean * self.side_stretch((sin, cos), top));
                Some((Vec3::new(radius * cos, radius * sin, height), Vec3::new(cos, sin, -growth), density))
            }
            ClosedBody::Ring(minor) => {
                let (n, stretch) = ring_normal(u, minor);
                let (sin, cos) = fp::sin_cos_turn(u.x);
                let point = Vec3::new(cos, sin, 0.0) + minor * n;
                let density = 1.0 / (TAU * TAU * minor * stretch * self.area_vector(n).length());
                Some((point, n, density))
            }
        }
    }

    /// Returns the normal and the sampling pdf per area in world space for a point near the
    /// surface. Both match the values of [`AffineBody::sample_body`].
    fn density(&self, p: Vec3, from: Vec3) -> (Vec3, f32) {
        match self.body {
            ClosedBody::Cube => {
                let axis = p.abs().max_position();
                let visible = self.visible(Some(from));
                (p[axis].signum() * Vec3::AXES[axis], 1.0 / visible.iter().flatten().sum::<f32>())
            }
            ClosedBody::Ball => {
                let n = p.normalize_or(Vec3::Z);
                (n, 1.0 / (4.0 * PI * self.area_vector(n).length()))
            }
            ClosedBody::Frustum(top) => {
                let [base, lid, side] = self.parts(top);
                let all = base + lid + side;
                let across = Vec2::new(p.x, p.y);
                let beside = (across.length() - (1.0 + (top - 1.0) * p.z)).abs();
                if beside > p.z.abs().min((p.z - 1.0).abs()) {
                    return (if p.z < 0.5 { -Vec3::Z } else { Vec3::Z }, 1.0 / all);
                }
                let d = across.normalize_or(Vec2::X);
                let mean = 0.5 * (1.0 + top);
                let density = side / all / (TAU * mean * self.side_stretch((d.y, d.x), top));
                (Vec3::new(d.x, d.y, 1.0 - top), density)
            }
            ClosedBody::Ring(minor) => {
                let across = Vec2::new(p.x, p.y);
                let (radius, d) = (across.length(), across.normalize_or(Vec2::X));
                // In a ring without a hole, the far side of the ring can be closer to the point
                // than the near side.
                let off = |radius: f32| (Vec2::new(radius - 1.0, p.z).length() - minor).abs();
                let (radius, d) = if off(radius) <= off(-radius) { (radius, d) } else { (-radius, -d) };
                let to = Vec2::new(radius - 1.0, p.z).normalize_or(Vec2::X);
                let n = Vec3::new(to.x * d.x, to.x * d.y, to.y);
                let stretch = (1.0 + minor * to.x).abs();
                (n, 1.0 / (TAU * TAU * minor * stretch * self.area_vector(n).length()))
            }
        }
    }
}

fn is_within_cube(p: Vec3) -> bool {
    p.abs().max_element() <= 1.0 + ON_SURFACE
}

fn is_within_ball(p: Vec3) -> bool {
    p.length_squared() <= 1.0 + ON_SURFACE
}

/// Returns the normal of a ring at two angles in turns, and the length of the circle through that
/// point around the axis, relative to the middle circle of the ring.
fn ring_normal(u: Vec2, minor: f32) -> (Vec3, f32) {
    let ((sin, cos), (up, out)) = (fp::sin_cos_turn(u.x), fp::sin_cos_turn(u.y));
    (Vec3::new(out * cos, out * sin, up), (1.0 + minor * out).abs())
}

fn around(center: Vec3, reach: Vec3) -> Aabb {
    Aabb { min: center - reach, max: center + reach }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler;

    fn bodies() -> Vec<AffineBody> {
        let maps = [
            [Vec3::X, Vec3::Y, Vec3::Z],
            [Vec3::new(0.5, 0.1, 0.0), Vec3::new(-0.3, 2.0, 0.2), Vec3::new(0.4, 0.0, -0.7)],
        ];
        let kinds = [
            ClosedBody::Cube,
            ClosedBody::Ball,
            ClosedBody::Frustum(0.0),
            ClosedBody::Frustum(0.6),
            ClosedBody::Frustum(1.0),
            ClosedBody::Ring(0.3),
        ];
        let all =
            kinds.iter().flat_map(|&body| maps.map(|axes| AffineBody::new(body, DVec3::new(0.3, -0.2, 0.1), axes)));
        all.map(|body_image| body_image.expect("the body has a volume")).collect()
    }

    #[test]
    fn sample_and_pdf_agree() {
        for body_image in bodies() {
            for from in [DVec3::new(2.5, 3.0, -1.5), DVec3::new(0.35, -0.15, 0.1), DVec3::new(-4.0, 0.0, 0.0)] {
                for i in 0..200 {
                    let Some(seen) = body_image.sample(from, sampler::sample_2d(5, 0, 0, i, 0)) else { continue };
                    let again = body_image.pdf(from, seen.wi, seen.distance);
                    // The pdf is unbounded when the surface is seen edge on, so rounding errors
                    // dominate.
                    let near = (again / seen.pdf - 1.0).abs() < 2e-3 / seen.cosine.abs().max(1e-3);
                    assert!(near, "{body_image:?} from {from}: {seen:?}, {again}");
                }
            }
        }
    }

    #[test]
    fn uniform_points_integrate_to_the_area() {
        const COUNT: u32 = 1 << 14;
        for body_image in bodies() {
            // Compute the integrals of 1 and of the normal over the surface. The integral of the
            // normal is 0 for a closed surface.
            let (mut area, mut normals) = (0.0_f64, DVec3::ZERO);
            for i in 0..COUNT {
                let Some((_, n, density)) = body_image.point(sampler::sample_2d(6, 0, 0, i, 0)) else { continue };
                area += 1.0 / f64::from(density);
                normals += n.as_dvec3() / f64::from(density);
            }
            let (area, normals) = (area / f64::from(COUNT), normals / f64::from(COUNT));
            assert!(
                (area / f64::from(body_image.area()) - 1.0).abs() < 0.02,
                "{body_image:?}: {area} {}",
                body_image.area()
            );
            assert!(normals.length() < 0.01 * area, "{body_image:?}: {normals} of {area}");
        }
    }
}
