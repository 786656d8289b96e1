//! A cone or frustum between two points, including its caps.

use super::chord::Chord;
use super::cylinder::{Axis, BASE, SIDE, TOP};
use super::{Flip, MeshData, Plane, Shape, ShapeHit, SurfacePoint, exact_offsets, inset, tessellate};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::light::{EmitterShape, EmitterTransform};
use crate::math::{Aabb, Line, Vec2, Vec3, gamma, roots};
use glam::DVec3;

described! {
    /// A cone with a cap, or a frustum with both caps if the top has a radius too.
    Cone ["Cone" in set::DURER] {
        /// Centre of the cap at the base.
        base: Vec3 = Vec3::ZERO, required, Constraint::Any, ["base" in set::DURER];
        /// The tip, or the centre of the cap at the top.
        top: Vec3 = Vec3::Y, required, Constraint::Any, ["top" in set::DURER];
        /// Radius at the base; can be 0 if the radius at the top is not.
        base_radius: f32 = 1.0, required, Constraint::NonNegative, ["baseRadius" in set::DURER];
        /// Radius at the top; default 0 for a tip.
        top_radius: f32 = 0.0, optional, Constraint::NonNegative, ["topRadius" in set::DURER];
    }
}

impl Cone {
    fn own_axis(&self) -> Axis {
        Axis::new(self.base, self.top)
    }

    fn radii(&self) -> [f64; 2] {
        [f64::from(self.base_radius), f64::from(self.top_radius)]
    }

    /// Derivative of the radius with respect to the height.
    fn growth(&self, axis: &Axis) -> f64 {
        let [base, top] = self.radii();
        (top - base) / axis.height
    }

    fn radius_at(&self, axis: &Axis, y: f64) -> f64 {
        let [base, top] = self.radii();
        let share = y / axis.height;
        base * (1.0 - share) + top * share
    }

    /// Solves |q - (q·a) a|^2 = r(q·a)^2, where q is relative to the base, a is the axis, and the
    /// radius r is linear in the height.
    ///
    /// A steep line can lie inside both nappes of the double cone. Only the nappe where r > 0 is
    /// kept.
    fn cut(&self, axis: &Axis, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        let (shift, near) = axis.near(line);
        let ((y, o), (slope, d)) = (axis.split(near.origin), axis.split(near.dir));
        let (r, dr) = (self.radius_at(axis, y), self.growth(axis) * slope);
        let (a, b, c) = (d.length_squared() - dr * dr, o.dot(d) - r * dr, o.length_squared() - r * r);
        let slabbed = Chord::LINE.slab(y, slope, [0.0, axis.height], [BASE, TOP]);
        let chord = match roots::quadratic(a, b, c).filter(|_| a != 0.0) {
            Some((first, second)) if a > 0.0 => slabbed.clip(first, second, [SIDE; 2]),
            Some((_, second)) if dr > 0.0 => slabbed.clip(second, f64::INFINITY, [SIDE; 2]),
            Some((first, _)) => slabbed.clip(f64::NEG_INFINITY, first, [SIDE; 2]),
            // The line is parallel to the side, so there is only one crossing.
            None if a == 0.0 && b > 0.0 => slabbed.clip(f64::NEG_INFINITY, -0.5 * c / b, [SIDE; 2]),
            None if a == 0.0 && b < 0.0 => slabbed.clip(-0.5 * c / b, f64::INFINITY, [SIDE; 2]),
            None if a < 0.0 || a == 0.0 && c < 0.0 => slabbed,
            None => return,
        };
        chord.emit_ends(&mut |t, uv| emit(t + shift, uv));
    }
}

impl Shape for Cone {
    fn bounds(&self) -> Option<Aabb> {
        Some(self.own_axis().bounds(self.radii()))
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
        Some((Cone { base, top, ..self.clone() }, self.base))
    }

    fn surface(&self, point: DVec3, crossing: &ShapeHit) -> SurfacePoint {
        let (axis, [base, top]) = (self.own_axis(), self.radii());
        if crossing.uv.x != SIDE as f32 {
            let face = crossing.uv.x as u32;
            return axis.cap(point, face, if face == TOP { top } else { base });
        }
        let (y, around) = axis.split(point - axis.base);
        let (y, around) =
            (inset(y, axis.height, axis.error(base.max(top))), around.normalize_or(axis.dir.any_orthonormal_vector()));
        let r = self.radius_at(&axis, y);
        let normal = around - self.growth(&axis) * axis.dir;
        let largest = base.max(top);
        // The curvature is unbounded at a tip, but the error of the point is far larger than the
        // limit used here.
        let curvature = 1.0 / r.max(1e-6 * largest);
        let position = axis.base + y * axis.dir + r * around;
        let floor = gamma(2) * (largest + axis.height) as f32;
        SurfacePoint::new(position, normal, floor, axis.uv(around, y / axis.height)).curved(curvature)
    }

    fn inside(&self, point: DVec3) -> Option<bool> {
        let axis = self.own_axis();
        let (y, around) = axis.split(point - axis.base);
        Some(y > 0.0 && y < axis.height && around.length() < self.radius_at(&axis, y))
    }

    fn validate(&self) -> Result<(), String> {
        if self.own_axis().height == 0.0 {
            Err("`base` and `top` of a `Cone` must not be the same point".into())
        } else if self.base_radius == 0.0 && self.top_radius == 0.0 {
            Err("one of the radii of a `Cone` must be more than 0".into())
        } else {
            Ok(())
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
        EmitterShape::frustum(transform, [self.base, self.top], [self.base_radius, self.top_radius])
    }

    fn tangent(&self, point: Vec3) -> Option<Vec3> {
        Some((self.top - self.base).cross(point - self.base))
    }

    fn to_mesh(&self) -> Option<MeshData> {
        Some(tessellate::frustum([(self.base, self.base_radius), (self.top, self.top_radius)]))
    }

    fn outline(&self, _: &Aabb) -> Option<Vec<Vec<Vec3>>> {
        None
    }
}
