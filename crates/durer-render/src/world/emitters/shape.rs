//! The forms of emitters in world space, and how points of them are chosen as seen from a point.

use crate::world::Object;
use crate::world::object::Geometry;
use durer_scene::bsdf::{Frame, warp};
use durer_scene::math::{Aabb, Vec2, Vec3, fp};
use durer_scene::shape::Primitive;
use glam::{DVec2, DVec3};
use std::f32::consts::PI;

/// A form whose points can be chosen at random. Places are known in double precision, as those of
/// things are that rays meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A corner and two edges.
    Triangle(DVec3, [Vec3; 2]),
    /// A corner and two edges.
    Parallelogram(DVec3, [Vec3; 2]),
    /// A centre and two half axes at any angle; and the share of the radius that is cut out.
    Ellipse(DVec3, [Vec3; 2], f32),
    /// A centre and a radius.
    Sphere(DVec3, f32),
    /// The middle of one cap, the way to that of the other, and a radius.
    Cylinder(DVec3, Vec3, f32),
}

/// A chosen point of an emitter, as seen from somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Unit vector to it.
    pub wi: Vec3,
    /// How far it is.
    pub distance: f32,
    /// The cosine of the emitter's normal there to the way back; less than 0 behind it.
    pub cosine: f32,
    /// Density per solid angle with which it was chosen.
    pub pdf: f32,
}

impl Form {
    /// The form of one part of an object, with its normal; `None` for what is found by hits alone.
    pub fn of(object: &Object, part: u32) -> Option<(Form, Vec3)> {
        let point = |p: Vec3| object.to_world.as_ref().map_or(p.as_dvec3(), |m| m.point64(p));
        let vector = |v: Vec3| object.to_world.as_ref().map_or(v, |m| m.vector(v));
        let normal = |n: Vec3| object.to_world.as_ref().map_or(n, |m| m.normal(n));
        Some(match &object.geometry {
            Geometry::Mesh(tree) => {
                let [a, b, c] = tree.mesh.corners(part);
                let n = (b - a).as_dvec3().cross((c - a).as_dvec3()).normalize_or_zero().as_vec3();
                (Form::Triangle(point(a), [vector(b - a), vector(c - a)]), normal(n))
            }
            Geometry::Primitive(Primitive::Triangle(triangle)) => {
                let [a, b, c] = triangle.corners();
                let n = (b - a).as_dvec3().cross((c - a).as_dvec3()).normalize_or_zero().as_vec3();
                (Form::Triangle(point(a), [vector(b - a), vector(c - a)]), normal(n))
            }
            Geometry::Primitive(Primitive::Rectangle(r)) => {
                let n = r.edge0.as_dvec3().cross(r.edge1.as_dvec3()).normalize_or_zero().as_vec3();
                (Form::Parallelogram(point(r.corner), [vector(r.edge0), vector(r.edge1)]), normal(n))
            }
            Geometry::Primitive(Primitive::Disc(disc)) => {
                let n = disc.normal.normalize_or(Vec3::Y);
                let frame = Frame::around(n);
                let axes = [frame.tangent, frame.bitangent].map(|axis| vector(disc.radius * axis));
                (Form::Ellipse(point(disc.center), axes, disc.inner_radius / disc.radius), normal(n))
            }
            Geometry::Primitive(Primitive::Sphere(sphere)) => {
                let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| vector(sphere.radius * axis));
                let radius = axes[0].length();
                let round = axes.iter().all(|axis| (axis.length() - radius).abs() < 1e-5 * radius)
                    && axes[0].dot(axes[1]).abs() + axes[1].dot(axes[2]).abs() + axes[2].dot(axes[0]).abs()
                        < 1e-5 * radius * radius;
                return round.then(|| (Form::Sphere(point(sphere.center), radius), Vec3::ZERO));
            }
            Geometry::Primitive(Primitive::Cylinder(cylinder)) => {
                let way = cylinder.top - cylinder.base;
                let frame = Frame::around(way.normalize_or(Vec3::Y));
                let [x, y] = [frame.tangent, frame.bitangent].map(|axis| vector(cylinder.radius * axis));
                let (way, radius) = (vector(way), x.length());
                // Only what is still round and upright can be chosen.
                let off = x.dot(y).abs()
                    + way.normalize_or(Vec3::Y).dot(x).abs() * radius
                    + way.normalize_or(Vec3::Y).dot(y).abs() * radius
                    + (y.length() - radius).abs() * radius;
                let round = off < 1e-5 * radius * radius && way != Vec3::ZERO;
                return round.then(|| (Form::Cylinder(point(cylinder.base), way, radius), Vec3::ZERO));
            }
            Geometry::Primitive(_) | Geometry::Solid(_) => return None,
        })
    }

    /// Its area.
    pub fn area(&self) -> f32 {
        match self {
            Form::Triangle(_, [e, f]) => 0.5 * e.cross(*f).length(),
            Form::Parallelogram(_, [e, f]) => e.cross(*f).length(),
            Form::Ellipse(_, [u, v], inner) => PI * u.cross(*v).length() * (1.0 - inner * inner),
            Form::Sphere(_, radius) => 4.0 * PI * radius * radius,
            Form::Cylinder(_, way, radius) => 2.0 * PI * radius * (way.length() + radius),
        }
    }

    /// Whether it has normals to all sides.
    pub fn is_round(&self) -> bool {
        matches!(self, Form::Sphere(..) | Form::Cylinder(..))
    }

    /// The box around it.
    pub fn bounds(&self) -> Aabb {
        let near = |p: DVec3| p.as_vec3();
        match *self {
            Form::Triangle(p, [e, f]) => Aabb::around([near(p), near(p) + e, near(p) + f]),
            Form::Parallelogram(p, [e, f]) => Aabb::around([near(p), near(p) + e, near(p) + f, near(p) + e + f]),
            Form::Ellipse(p, [u, v], _) => {
                let reach = (u * u + v * v).map(f32::sqrt);
                Aabb { min: near(p) - reach, max: near(p) + reach }
            }
            Form::Sphere(center, radius) => Aabb { min: near(center) - radius, max: near(center) + radius },
            Form::Cylinder(base, way, radius) => {
                let [base, top] = [near(base), near(base) + way];
                Aabb::around([base - radius, base + radius, top - radius, top + radius])
            }
        }
    }

    /// Chooses a point of it, as seen from a point; `None` where none can be seen.
    pub fn sample(&self, normal: Vec3, from: DVec3, u: Vec2) -> Option<Place> {
        let to = match *self {
            Form::Triangle(p, [e, f]) => {
                let b = warp::triangle(u);
                offset(p, from) + b.y * e + b.z * f
            }
            Form::Parallelogram(p, [e, f]) => {
                let corner = offset(p, from);
                if let Some(window) = Window::new(corner, e, f) {
                    let wi = window.sample(u);
                    let distance = wi.length();
                    let wi = wi / distance;
                    return Some(Place { wi, distance, cosine: -wi.dot(normal), pdf: 1.0 / window.solid_angle as f32 });
                }
                corner + u.x * e + u.y * f
            }
            Form::Ellipse(p, [x, y], inner) => {
                let d = in_ring(u, inner);
                offset(p, from) + d.x * x + d.y * y
            }
            Form::Sphere(center, radius) => return cone(offset(center, from), radius, u),
            Form::Cylinder(..) => {
                let (point, normal, density) = self.point(normal, u)?;
                let to = (point - from).as_vec3();
                let distance = to.length();
                let wi = to / distance;
                let cosine = -wi.dot(normal);
                let pdf = density * distance * distance / cosine.abs();
                // The far side cannot be seen.
                let seen = cosine > 0.0 && pdf.is_finite() && pdf > 0.0;
                return seen.then_some(Place { wi, distance, cosine, pdf });
            }
        };
        let distance = to.length();
        let wi = to / distance;
        let cosine = -wi.dot(normal);
        let pdf = distance * distance / (cosine.abs() * self.area());
        (pdf.is_finite() && pdf > 0.0).then_some(Place { wi, distance, cosine, pdf })
    }

    /// The density per solid angle with which [`Form::sample`] chooses a direction that meets it at
    /// a distance.
    pub fn pdf(&self, normal: Vec3, from: DVec3, wi: Vec3, distance: f32) -> f32 {
        match *self {
            Form::Sphere(center, radius) => {
                let to = offset(center, from);
                let (d2, r2) = (to.length_squared(), radius * radius);
                if d2 <= r2 {
                    return distance * distance / (self.area() * sphere_cosine(to, wi, distance, radius));
                }
                1.0 / (2.0 * PI * one_minus_cosine(r2 / d2))
            }
            Form::Cylinder(base, way, radius) => {
                let normal = outwards(distance * wi - offset(base, from), way, radius);
                distance * distance / (wi.dot(normal).abs() * self.area())
            }
            Form::Parallelogram(p, [e, f]) => match Window::new(offset(p, from), e, f) {
                Some(window) => 1.0 / window.solid_angle as f32,
                None => distance * distance / (wi.dot(normal).abs() * self.area()),
            },
            _ => distance * distance / (wi.dot(normal).abs() * self.area()),
        }
    }

    /// A point chosen evenly over its area, its normal there, and the density per area.
    pub fn point(&self, normal: Vec3, u: Vec2) -> Option<(DVec3, Vec3, f32)> {
        let (point, normal) = match *self {
            Form::Triangle(p, [e, f]) => {
                let b = warp::triangle(u);
                (p + (b.y * e + b.z * f).as_dvec3(), normal)
            }
            Form::Parallelogram(p, [e, f]) => (p + (u.x * e + u.y * f).as_dvec3(), normal),
            Form::Ellipse(p, [x, y], inner) => {
                let d = in_ring(u, inner);
                (p + (d.x * x + d.y * y).as_dvec3(), normal)
            }
            Form::Sphere(center, radius) => {
                let n = warp::sphere(u);
                (center + f64::from(radius) * n.as_dvec3(), n)
            }
            Form::Cylinder(base, way, radius) => {
                let height = way.length();
                let axis = way / height;
                let frame = Frame::around(axis);
                // First the caps, then the side.
                let caps = radius / (height + radius);
                let (at, n) = if u.x < caps {
                    let share = 2.0 * u.x / caps;
                    let (top, share) = (share >= 1.0, share.fract());
                    let d = warp::disc(Vec2::new(share, u.y)) * radius;
                    let on = d.x * frame.tangent + d.y * frame.bitangent;
                    if top { (way + on, axis) } else { (on, -axis) }
                } else {
                    let (sin, cos) = fp::sin_cos_turn(u.y);
                    let n = cos * frame.tangent + sin * frame.bitangent;
                    ((u.x - caps) / (1.0 - caps) * way + radius * n, n)
                };
                (base + at.as_dvec3(), n)
            }
        };
        let density = 1.0 / self.area();
        density.is_finite().then_some((point, normal, density))
    }
}

/// The normal of a cylinder at a point of it, as seen from the middle of its base.
fn outwards(point: Vec3, way: Vec3, radius: f32) -> Vec3 {
    let height = way.length();
    let axis = way / height;
    let along = point.dot(axis);
    let around = point - along * axis;
    // Whichever face is nearest.
    let (side, base, top) = ((around.length() - radius).abs(), along.abs(), (along - height).abs());
    if side <= base.min(top) { around.normalize_or(axis) } else { axis }
}

/// A point of the unit disc without its middle, evenly over the area.
fn in_ring(u: Vec2, inner: f32) -> Vec2 {
    let d = warp::disc(u);
    // The area of a ring grows with the square of its radius.
    let square = inner * inner + (1.0 - inner * inner) * d.length_squared();
    if inner > 0.0 { d.normalize_or(Vec2::X) * square.sqrt() } else { d }
}

/// From one point to another.
fn offset(to: DVec3, from: DVec3) -> Vec3 {
    (to - from).as_vec3()
}

/// 1 - cos of the angle whose sine's square is given, without cancellation.
fn one_minus_cosine(sine2: f32) -> f32 {
    sine2 / (1.0 + (1.0 - sine2).max(0.0).sqrt())
}

/// The cosine of a sphere's normal at a point seen from inside, where `to` leads to the centre.
fn sphere_cosine(to: Vec3, wi: Vec3, distance: f32, radius: f32) -> f32 {
    ((distance * wi - to) / radius).dot(wi).abs().max(1e-6)
}

/// A point of a sphere, evenly over the solid angle in which it is seen.
///
/// Source: *Physically Based Rendering*, 4th edition, section 6.2.4.
fn cone(to: Vec3, radius: f32, u: Vec2) -> Option<Place> {
    let (d2, r2) = (to.length_squared(), radius * radius);
    let d = d2.sqrt();
    if d2 <= r2 {
        // From inside, evenly over the area.
        let at = to + radius * warp::sphere(u);
        let distance = at.length();
        let wi = at / distance;
        let cosine = sphere_cosine(to, wi, distance, radius);
        let pdf = distance * distance / (4.0 * PI * r2 * cosine);
        // Its outside cannot be seen.
        return pdf.is_finite().then_some(Place { wi, distance, cosine: -cosine, pdf });
    }
    let all = one_minus_cosine(r2 / d2);
    let below = all * u.x;
    let cosine = 1.0 - below;
    let sine2 = (below * (2.0 - below)).max(0.0);
    let (sin, cos) = fp::sin_cos_turn(u.y);
    let frame = Frame::around(to / d);
    let wi = frame.to_world(Vec3::new(sine2.sqrt() * cos, sine2.sqrt() * sin, cosine)).normalize();
    // Where that direction first meets the sphere.
    let half = (r2 - d2 * sine2).max(0.0).sqrt();
    let distance = d * cosine - half;
    Some(Place { wi, distance, cosine: half / radius, pdf: 1.0 / (2.0 * PI * all) })
}

/// A rectangle whose edges are less than this share of its distance is sampled evenly over its area:
/// over it the density differs by a deviation of less than a tenth, and that is much faster.
const SMALL: f32 = 0.1;

/// A rectangle seen from a point, to be sampled evenly over its solid angle.
///
/// Source: Ureña, Fajardo and King, *An Area-Preserving Parametrization for Spherical Rectangles*,
/// EGSR 2013.
struct Window {
    axes: [DVec3; 3],
    near: DVec3,
    far: DVec3,
    solid_angle: f64,
    b: [f64; 2],
    /// Cosine and sine of the angle from which points are counted.
    k: DVec2,
}

impl Window {
    /// `None` for what has no right angles, or is seen so small or so flat that its area does as
    /// well.
    fn new(corner: Vec3, e: Vec3, f: Vec3) -> Option<Window> {
        let middle = corner + 0.5 * (e + f);
        if e.length_squared().max(f.length_squared()) < SMALL * SMALL * middle.length_squared() {
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
        // Angles as complex numbers: those of products are sums, which are whole turns off.
        let angle = |cosine: f64| DVec2::new(cosine, ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt());
        let [g0, g1, g2, g3] = [angle(-n0 * n1), angle(-n1 * n2), angle(-n2 * n3), angle(-n3 * n0)];
        let right = g2.rotate(g3);
        let all = g0.rotate(g1).rotate(right);
        let turns = fp::atan2_turn_f64(all.y, all.x);
        let solid_angle = std::f64::consts::TAU * if turns < 0.0 { turns + 1.0 } else { turns };
        let k = DVec2::new(right.x, -right.y);
        // Turns are known to 2e-9, which is too much of few, and a rounding below none looks like a
        // whole one.
        let known = turns.abs() > 1e-4;
        known.then_some(Window { axes: [x, y, z], near, far, solid_angle, b: [n0, n2], k })
    }

    /// A point of it.
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
