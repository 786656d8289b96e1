//! An axis-aligned box.

use super::chord::Chord;
use super::{Flip, MeshData, Plane, Shape, ShapeHit, SurfacePoint, exact_offsets, inset, padded_box, tessellate};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::light::{ClosedBody, EmitterShape, EmitterTransform};
use crate::math::{Aabb, Line, Vec2, Vec3, gamma};
use glam::DVec3;

described! {
    /// A box whose faces are parallel to the coordinate planes.
    Cuboid ["Box" in set::DURER] {
        /// Corner with the smallest coordinates.
        min: Vec3 = Vec3::splat(-1.0), required, Constraint::Any, ["min" in set::DURER];
        /// Corner with the largest coordinates.
        max: Vec3 = Vec3::ONE, required, Constraint::Any, ["max" in set::DURER];
    }
}

impl Shape for Cuboid {
    fn bounds(&self) -> Option<Aabb> {
        Some(padded_box(self.min.as_dvec3(), self.max.as_dvec3()))
    }

    /// Clips the line by the three slabs of the box. Source: Kay and Kajiya, *Ray Tracing Complex
    /// Scenes*, SIGGRAPH 1986.
    fn crossings(&self, line: &Line, emit: &mut impl FnMut(f64, Vec2)) {
        let (min, max) = (self.min.as_dvec3(), self.max.as_dvec3());
        let cut = |chord: Chord, axis: usize| {
            let faces = [2 * axis as u32, 2 * axis as u32 + 1];
            chord.slab(line.origin[axis], line.dir[axis], [min[axis], max[axis]], faces)
        };
        (0..3).fold(Chord::LINE, cut).emit_ends(emit);
    }

    fn centered(&self) -> Option<(Self, Vec3)> {
        let [min, max] = exact_offsets([self.min, self.max], self.min)?;
        Some((Cuboid { min, max }, self.min))
    }

    fn surface(&self, point: DVec3, crossing: &ShapeHit) -> SurfacePoint {
        let face = crossing.uv.x as usize;
        let (axis, high) = (face / 2 % 3, face % 2 == 1);
        let (min, max) = (self.min.as_dvec3(), self.max.as_dvec3());
        let error = gamma(2) * self.min.abs().max(self.max.abs()).max_element();
        let size = max - min;
        let mut p = DVec3::from_array([0, 1, 2].map(|i| min[i] + inset(point[i] - min[i], size[i], error)));
        p[axis] = if high { max[axis] } else { min[axis] };
        let normal = if high { DVec3::AXES[axis] } else { -DVec3::AXES[axis] };
        let share = (p - min) / size;
        let uv = [(2, 1), (0, 2), (0, 1)].map(|(u, v)| Vec2::new(share[u] as f32, share[v] as f32))[axis];
        SurfacePoint::new(p, normal, 0.0, uv)
    }

    fn inside(&self, point: DVec3) -> Option<bool> {
        Some((point.cmpgt(self.min.as_dvec3()) & point.cmplt(self.max.as_dvec3())).all())
    }

    fn validate(&self) -> Result<(), String> {
        let thick = self.min.cmplt(self.max).all();
        match thick {
            true => Ok(()),
            false => Err("`min` of a `Box` must be less than its `max` in x, y and z".into()),
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
        let corner = |i: usize| {
            let pick = |axis: usize| if i >> axis & 1 == 1 { self.max[axis] } else { self.min[axis] };
            Vec3::new(pick(0), pick(1), pick(2))
        };
        let sides = [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6], [0, 1, 3, 2], [4, 5, 7, 6]];
        sides.map(|side| side.map(corner).to_vec()).to_vec()
    }

    fn emitter(&self, transform: &EmitterTransform) -> Option<(EmitterShape, Vec3)> {
        let half = 0.5 * (self.max - self.min);
        let axes = [half.x * Vec3::X, half.y * Vec3::Y, half.z * Vec3::Z];
        EmitterShape::body(transform, ClosedBody::Cube, 0.5 * (self.min + self.max), axes)
    }

    fn tangent(&self, _: Vec3) -> Option<Vec3> {
        None
    }

    fn to_mesh(&self) -> Option<MeshData> {
        Some(tessellate::cuboid(self.min, self.max))
    }

    fn outline(&self, _: &Aabb) -> Option<Vec<Vec<Vec3>>> {
        None
    }
}
