//! A cylinder between two points, including its caps.

use super::chord::Chord;
use super::{
    Flip, INSET, MeshData, Plane, Shape, ShapeHit, SurfacePoint, Uv, disc_reach, exact_offsets, inset, padded_box,
    tessellate,
};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::light::{EmitterShape, EmitterTransform};
use crate::math::{Aabb, Line, Vec2, Vec3, gamma};
use glam::{DVec2, DVec3};

described! {
    /// A cylinder with caps, around the line between two points.
    Cylinder ["Cylinder" in set::DURER] {
        /// Centre of the cap at one end.
        base: Vec3 = Vec3::ZERO, required, Constraint::Any, ["base" in set::DURER];
        /// Centre of the cap at the other end.
        top: Vec3 = Vec3::Y, required, Constraint::Any, ["top" in set::DURER];
        /// Radius, in world units.
        radius: f32 = 1.0, required, Constraint::Positive, ["radius" in set::DURER];
    }
}

/// Axis of a solid of revolution (a cylinder or a cone). Heights are measured along this axis.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// Point where the axis starts and the height is 0.
    pub base: DVec3,
    /// Unit direction.
    pub dir: DVec3,
    /// Length of the axis.
    pub height: f64,
}

/// Numbers that identify the faces of a solid of revolution.
pub(super) const BASE: u32 = 0;
pub(super) const TOP: u32 = 1;
pub(super) const SIDE: u32 = 2;

impl Axis {
    pub(super) fn new(base: Vec3, top: Vec3) -> Self {
        let (base, along) = (base.as_dvec3(), top.as_dvec3() - base.as_dvec3());
        Axis { base, dir: along.normalize_or(DVec3::Y), height: along.length() }
    }

    /// Splits a vector into its component along the axis and the remainder.
    pub(super) fn split(&self, v: DVec3) -> (f64, DVec3) {
        let along = v.dot(self.dir);
        (along, v - along * self.dir)
    }

    /// Moves the origin of a line to the point nearest to the middle of the axis, and returns the
    /// line relative to the base together with the `t` of that point. This avoids cancellation for
    /// distant lines.
    pub(super) fn near(&self, line: &Line) -> (f64, Line) {
        let shift = line.nearest(self.base + 0.5 * self.height * self.dir);
        (shift, Line { origin: line.at(shift) - self.base, dir: line.dir })
    }

    /// Returns a bound on the error of a point that is at most `radius` away from the axis.
    pub(super) fn error(&self, radius: f64) -> f32 {
        gamma(4) * (self.base.abs().max_element() + self.height + radius) as f32
    }

    /// Returns the bounds of two discs with the given radii, one at each end of the axis.
    pub(super) fn bounds(&self, [base_radius, top_radius]: [f64; 2]) -> Aabb {
        let reach = disc_reach(self.dir);
        let top = self.base + self.height * self.dir;
        let (a, b) = (base_radius * reach, top_radius * reach);
        padded_box((self.base - a).min(top - b), (self.base + a).max(top + b))
    }

    /// Returns texture coordinates, where u is the angle around the axis and `v` is passed in.
    pub(super) fn uv(&self, around: DVec3, v: f64) -> Uv {
        let (x, z) = self.dir.any_orthonormal_pair();
        Uv::Angle(DVec2::new(around.dot(x), around.dot(z)).as_vec2(), v.clamp(0.0, 1.0) as f32)
    }

    /// Returns the surface of a cap, which is a plane perpendicular to the axis.
    pub(super) fn cap(&self, point: DVec3, face: u32, radius: f64) -> SurfacePoint {
        let (height, normal) = if face == TOP { (self.height, self.dir) } else { (0.0, -self.dir) };
        let (_, around) = self.split(point - self.base);
        let within = radius - f64::from(INSET * self.error(radius)).min(0.25 * radius);
        let position = self.base + height * self.dir + around.clamp_length_max(within);
        // Points on a plane perpendicular to a tilted axis are accurate to double precision.
        let floor = 1e-14 * (self.base.abs().max_element() + self.height + radius);
        SurfacePoint::new(position, normal, floor as f32, self.uv(around, around.length() / radius))
    }
}

impl Cylinder {
    fn own_axis(&self) -> Axis {
        Axis::new(self.base, self.top)
    }

    /// Solves |q - (q·a) a|^2 = radius^2 between two planes perpendicular to the axis a, where q is
    /// relative to the base.
    fn cut(&self, axis: &Axis, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        let (shift, near) = axis.near(line);
        let ((y, o), (slope, d)) = (axis.split(near.origin), axis.split(near.dir));
        let r = f64::from(self.radius);
        // Treat a line as parallel to the axis if its perpendicular component is merely rounding
        // error.
        let across = d.length_squared();
        let across = if across > 1e-30 * near.dir.length_squared() { across } else { 0.0 };
        let chord = Chord::LINE.quadratic(across, o.dot(d), o.length_squared() - r * r, SIDE);
        if chord.ends().is_none() {
            return;
        }
        let chord = chord.slab(y, slope, [0.0, axis.height], [BASE, TOP]);
        chord.emit_ends(&mut |t, uv| emit(t + shift, uv));
    }
}

impl Shape for Cylinder {
    fn bounds(&self) -> Option<Aabb> {
        Some(self.own_axis().bounds([f64::from(self.radius); 2]))
    }

    fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        self.cut(&self.own_axis(), line, emit);
    }

    fn axis(&self) -> Option<Axis> {
        Some(self.own_axis())
    }

    #[inline(always)]
    fn crossings_about(&self, axis: Option<&Axis>, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        match axis {
            Some(axis) => self.cut(axis, line, emit),
            None => self.crossings(line, emit),
        }
    }

    fn centered(&self) -> Option<(Self, Vec3)> {
        let [base, top] = exact_offsets([self.base, self.top], self.base)?;
        Some((Cylinder { base, top, ..self.clone() }, self.base))
    }

    fn surface(&self, point: DVec3, crossing: &ShapeHit) -> SurfacePoint {
        let (axis, r) = (self.own_axis(), f64::from(self.radius));
        if crossing.uv.x != SIDE as f32 {
            return axis.cap(point, crossing.uv.x as u32, r);
        }
        let (y, around) = axis.split(point - axis.base);
        let (y, normal) =
            (inset(y, axis.height, axis.error(r)), around.normalize_or(axis.dir.any_orthonormal_vector()));
        let position = axis.base + y * axis.dir + r * normal;
        let uv = axis.uv(normal, y / axis.height);
        SurfacePoint::new(position, normal, gamma(2) * self.radius, uv).curved(1.0 / r)
    }

    fn inside(&self, point: DVec3) -> Option<bool> {
        let axis = self.own_axis();
        let (y, around) = axis.split(point - axis.base);
        Some(y > 0.0 && y < axis.height && around.length() < f64::from(self.radius))
    }

    fn validate(&self) -> Result<(), String> {
        match self.own_axis().height > 0.0 {
            true => Ok(()),
            false => Err("`base` and `top` of a `Cylinder` must not be the same point".into()),
        }
    }

    fn starts_inside(&self, _: &Line) -> bool {
        false
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
        EmitterShape::frustum(transform, [self.base, self.top], [self.radius; 2])
    }

    fn tangent(&self, point: Vec3) -> Option<Vec3> {
        Some((self.top - self.base).cross(point - self.base))
    }

    fn to_mesh(&self) -> Option<MeshData> {
        Some(tessellate::frustum([(self.base, self.radius), (self.top, self.radius)]))
    }

    fn outline(&self, _: &Aabb) -> Option<Vec<Vec<Vec3>>> {
        None
    }
}
