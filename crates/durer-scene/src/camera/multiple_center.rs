//! A multiple-centre-of-projection image, in which every column has its own eye on a path.
//!
//! The eyes e(u) and their targets c(u) move along Catmull-Rom splines through the rows of `path`,
//! with the same step in u from each row to the next. With w = c - e, right = norm(w x up) and v =
//! right x norm(w), a column is a fan of rays. Their directions are norm(w) + h v, with |h| <=
//! tan(angle / 2). A picture taken on a path around an object shows all sides of the object at
//! once.
//!
//! A point X is seen in the columns whose plane contains it. These columns satisfy (w(u) x up)·(X -
//! e(u)) = 0, where the left side is a polynomial of degree 6 in each piece of the spline.
//! `roots.rs` finds all roots of this polynomial, so a point may be seen several times.
//!
//! The area across a ray at distance t is t / (1 + h²) |dX/du·right| per du dh, where dX/du·right =
//! e'·right + t (w'·right / |w| + h v'·right) / sqrt(1 + h²) and v'·right = -v·(w' x up) / |w x
//! up|.
//!
//! Source: Rademacher, Bishop, *Multiple-Center-of-Projection Images*, SIGGRAPH 1998. Source of the
//! splines: Catmull, Rom, *A Class of Local Interpolating Splines*, Computer Aided Geometric
//! Design, 1974.

mod roots;

use super::perspective::half_width;
use super::pose::world_ray;
use super::sheet::PictureSheet;
use super::{CameraBasis, CameraSample, Pose, Projection};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Ray, Vec2, Vec3};
use glam::{DVec2, DVec3};

described! {
    /// A camera that moves along a path and renders each column of the picture from the next point.
    MultipleCenterCamera ["MultipleCenterCamera" in set::DURER] {
        /// One row per point of the path, from the left of the picture to the right: the eye and
        /// its target. If the last row equals the first, the path is a smooth loop.
        path: Vec<[f32; 6]> = straight(), required, Constraint::Rows(2, 1024), ["path" in set::DURER];
        /// Up direction of every column; need not be perpendicular to the view direction.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::DURER];
        /// Field of view from bottom to top, in degrees.
        angle: f32 = 60.0, required, Constraint::Between(0.0, 180.0), ["angle" in set::DURER];
        /// Ratio of the picture's width to its height.
        aspect: f32 = 2.0, optional, Constraint::Positive, ["aspect" in set::DURER];
    }
}

fn straight() -> Vec<[f32; 6]> {
    vec![[-1.0, 0.0, 0.0, -1.0, 0.0, -1.0], [1.0, 0.0, 0.0, 1.0, 0.0, -1.0]]
}

/// Cubic segment of the path of the eyes or of the targets, given by its Bézier control points.
type Piece = [DVec3; 4];

fn at(piece: &Piece, s: f64) -> DVec3 {
    let r = 1.0 - s;
    piece[0] * (r * r * r) + piece[1] * (3.0 * r * r * s) + piece[2] * (3.0 * r * s * s) + piece[3] * (s * s * s)
}

fn derivative(piece: &Piece, s: f64) -> DVec3 {
    let (r, [a, b, c, d]) = (1.0 - s, *piece);
    ((b - a) * (r * r) + (c - b) * (2.0 * r * s) + (d - c) * (s * s)) * 3.0
}

/// Column of a multiple-centre-of-projection picture, with its eye, its axes, and their derivatives
/// with respect to u from 0 to 1.
struct Column {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Value of e'·right in the formula of the module.
    eye_moves: f64,
    /// Value of w'·right / |w| in the formula of the module.
    forward_turns: f64,
    /// Value of v'·right in the formula of the module.
    up_turns: f64,
}

impl MultipleCenterCamera {
    fn sheet(&self) -> PictureSheet {
        PictureSheet(DVec2::new(f64::from(self.aspect), 1.0))
    }

    fn pieces(&self) -> usize {
        self.path.len() - 1
    }

    /// Returns a piece of the path of the eyes (if `column` is 0) or of the targets (if `column` is
    /// 3).
    fn piece(&self, index: usize, column: usize) -> Piece {
        let last = self.pieces();
        let position = |i: usize| Vec3::from_slice(&self.path[i][column..column + 3]).as_dvec3();
        let closed = self.path[0] == self.path[last] && last > 2;
        let tangent = |i: usize| match (i, closed) {
            (0, true) => 0.5 * (position(1) - position(last - 1)),
            (i, true) if i == last => 0.5 * (position(1) - position(last - 1)),
            (0, false) => position(1) - position(0),
            (i, false) if i == last => position(last) - position(last - 1),
            (i, _) => 0.5 * (position(i + 1) - position(i - 1)),
        };
        let (a, d) = (position(index), position(index + 1));
        [a, a + tangent(index) / 3.0, d - tangent(index + 1) / 3.0, d]
    }

    /// Returns the column at the fraction `u` of the path.
    fn column(&self, u: f64) -> Column {
        let count = self.pieces() as f64;
        let index = (u * count).floor().clamp(0.0, count - 1.0);
        let (s, up) = (u * count - index, self.up.as_dvec3());
        let [eyes, targets] = [0, 3].map(|column| self.piece(index as usize, column));
        let (eye, eye_slope) = (at(&eyes, s), count * derivative(&eyes, s));
        let (w, w_slope) = (at(&targets, s) - eye, count * derivative(&targets, s) - eye_slope);
        let (across, forward) = (w.cross(up), w.normalize());
        let right = across.normalize();
        let v = right.cross(forward);
        Column {
            eye,
            right,
            up: v,
            forward,
            eye_moves: eye_slope.dot(right),
            forward_turns: w_slope.dot(right) / w.length(),
            up_turns: -v.dot(w_slope.cross(up)) / across.length(),
        }
    }

    /// Returns the column that contains a sample, and the height of the sample in the fan of the
    /// column.
    fn column_of(&self, sample: &CameraSample) -> Option<(Column, f64)> {
        let sheet = self.sheet();
        let position = sheet.position(sample.point.as_dvec2());
        let within = sheet.contains(sheet.position(sample.pixel.as_dvec2()));
        within.then(|| (self.column(position.x / sheet.0.x), (2.0 * position.y - 1.0) * half_width(self.angle)))
    }
}

impl Projection for MultipleCenterCamera {
    /// Returns the pose of the middle column.
    fn pose(&self) -> Pose {
        let Column { eye, forward, .. } = self.column(0.5);
        Pose { center: eye.as_vec3(), direction: forward.as_vec3(), up: self.up }
    }

    fn proportions(&self) -> Option<Vec2> {
        self.sheet().proportions()
    }

    fn validate(&self) -> Result<(), String> {
        if self.path.len() < 2 {
            return Err("`path` must have at least 2 rows".into());
        }
        // Check between the rows as well, since the spline may degenerate there.
        let steps = 16 * self.pieces();
        (0..=steps).try_for_each(|step| {
            let column = self.column(step as f64 / steps as f64);
            let row = step as f64 / 16.0 + 1.0;
            let wrong =
                !column.right.is_finite() || column.forward.cross(self.up.as_dvec3().normalize()).length() < 1e-6;
            match wrong {
                true => Err(format!(
                    "at row {row} of `path`, the eye must differ from its target, and the viewing \
                     direction must not be parallel to `up`"
                )),
                false => Ok(()),
            }
        })
    }

    fn ray(&self, _: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        let (column, height) = self.column_of(sample)?;
        Some(world_ray(column.eye, column.forward + height * column.up))
    }

    fn project(&self, _: &CameraBasis, world: Vec3, _: Vec2, emit: &mut dyn FnMut(Vec2)) {
        let (sheet, up, world) = (self.sheet(), self.up.as_dvec3(), world.as_dvec3());
        for index in 0..self.pieces() {
            let [eyes, targets] = [0, 3].map(|column| self.piece(index, column));
            let normals: [DVec3; 4] = std::array::from_fn(|i| (targets[i] - eyes[i]).cross(up));
            let from_eyes: [DVec3; 4] = std::array::from_fn(|i| world - eyes[i]);
            roots::for_each_root(roots::dot(&normals, &from_eyes), &mut |s| {
                let u = (index as f64 + s) / self.pieces() as f64;
                let column = self.column(u);
                let to_point = world - column.eye;
                let height = to_point.dot(column.up) / to_point.dot(column.forward) / half_width(self.angle);
                let position = DVec2::new(u * sheet.0.x, 0.5 * (height + 1.0));
                if to_point.dot(column.forward) > 0.0 && sheet.contains(position) {
                    emit(sheet.point(position).as_vec2());
                }
            });
        }
    }

    fn footprint(&self, _: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
        let Some((column, height)) = self.column_of(sample) else { return 0.0 };
        let (t, square, unit) = (f64::from(t), 1.0 + height * height, self.sheet().unit());
        let turns = (column.forward_turns + height * column.up_turns) / square.sqrt();
        let per_place = 2.0 * half_width(self.angle) / self.sheet().0.x;
        (t / square * (column.eye_moves + t * turns).abs() * per_place * unit * unit) as f32
    }
}
