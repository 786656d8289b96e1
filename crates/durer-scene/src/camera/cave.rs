//! A CAVE, which consists of screens around a viewer, each of which is a window into the scene.
//!
//! A wall is given by three corners, as seen from inside: a (lower left), b (lower right) and c
//! (upper left). The ray through the fractions (s, t) of the sides of a wall runs from the eye to
//! a + s (b - a) + t (c - a). The rays form a frustum whose apex may lie off the axis of the wall.
//! A point in space is seen along the same ray on every wall. Two walls that share an edge
//! therefore match along this edge for any eye position. The walls lie side by side in one picture,
//! with the same scale and a common baseline. For a wall with normal n, the solid angle per unit
//! area at offset r from the eye is |n·r| / |r|³.
//!
//! Source: Cruz-Neira, Sandin, DeFanti, *Surround-Screen Projection-Based Virtual Reality: The
//! Design and Implementation of the CAVE*, SIGGRAPH 1993; Kooima, *Generalized Perspective
//! Projection*, 2009.

use super::pose::world_ray;
use super::sheet::PictureSheet;
use super::{CameraBasis, CameraRules, CameraSample, Eyes, Pose, Projection};
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Ray, Vec2, Vec3};
use glam::{DMat3, DVec2, DVec3};

described! {
    /// A camera that renders several walls around a viewer into one picture, for one eye or a pair.
    CaveCamera ["CaveCamera" in set::DURER] {
        /// Position of the viewer's eye, or the midpoint of both eyes.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// Direction that the viewer faces, which determines left and right; of any length.
        direction: Vec3 = Vec3::NEG_Z, optional, Constraint::NonZero, ["direction" in set::DURER];
        /// Up direction of the viewer's head; need not be perpendicular to `direction`.
        up: Vec3 = Vec3::Y, optional, Constraint::NonZero, ["up" in set::DURER];
        /// Three corners per wall, as seen from inside: lower left, lower right, upper left. Walls
        /// are ordered from left to right.
        walls: Vec<[f32; 9]> = front_wall(), required, Constraint::Rows(1, 64), ["walls" in set::DURER];
        /// Eye to render, or layout of both eyes.
        eyes: Eyes = Eyes::Middle, optional, Constraint::Any, ["eyes" in set::DURER];
        /// Distance between the eyes, in world units.
        separation: f32 = 0.065, optional, Constraint::NonNegative, ["separation" in set::DURER];
    }
}

fn front_wall() -> Vec<[f32; 9]> {
    vec![[-1.0, -1.0, -1.0, 1.0, -1.0, -1.0, -1.0, 1.0, -1.0]]
}

/// Wall of a CAVE, given by its lower left corner, its sides, and the horizontal position of that
/// corner on the sheet.
#[derive(Clone, Copy)]
struct Wall {
    corner: DVec3,
    across: DVec3,
    upwards: DVec3,
    left: f64,
}

impl Wall {
    fn size(&self) -> DVec2 {
        DVec2::new(self.across.length(), self.upwards.length())
    }

    /// Returns the point in world space for a position on the sheet.
    fn point(&self, position: DVec2) -> DVec3 {
        let share = (position - DVec2::new(self.left, 0.0)) / self.size();
        self.corner + share.x * self.across + share.y * self.upwards
    }

    fn contains(&self, position: DVec2) -> bool {
        PictureSheet(self.size()).contains(position - DVec2::new(self.left, 0.0))
    }

    fn normal(&self) -> DVec3 {
        self.across.cross(self.upwards).normalize()
    }
}

impl CaveCamera {
    fn walls(&self) -> impl Iterator<Item = Wall> {
        let mut left = 0.0;
        self.walls.iter().map(move |row| {
            let [a, b, c] = [0, 3, 6].map(|i| Vec3::from_slice(&row[i..i + 3]).as_dvec3());
            let wall = Wall { corner: a, across: b - a, upwards: c - a, left };
            left += wall.size().x;
            wall
        })
    }

    /// Size of the sheet for one eye, which contains all walls in a row.
    fn eye_size(&self) -> DVec2 {
        self.walls().fold(DVec2::ZERO, |one, wall| DVec2::new(one.x + wall.size().x, one.y.max(wall.size().y)))
    }

    /// Returns the position of an eye in world space.
    fn eye(&self, frame: &CameraBasis, side: f64) -> DVec3 {
        frame.eye.as_dvec3() + 0.5 * side * f64::from(self.separation) * frame.right.as_dvec3()
    }

    /// Returns the eye, the wall, and the point on the wall for a sample.
    fn wall_point(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<(DVec3, Wall, DVec3)> {
        let (point, pixel) = (sample.point.as_dvec2(), sample.pixel.as_dvec2());
        let (one, sheet) = (self.eye_size(), self.eyes.sheet(self.eye_size()));
        let (view, position) = self.eyes.view(one, point, pixel)?;
        let at = sheet.position(pixel) - view.corner;
        let wall = self.walls().find(|wall| wall.contains(at))?;
        Some((self.eye(frame, view.side), wall, wall.point(position)))
    }
}

impl Projection for CaveCamera {
    fn pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn proportions(&self) -> Option<Vec2> {
        self.eyes.sheet(self.eye_size()).proportions()
    }

    fn validate(&self) -> Result<(), String> {
        if self.walls.is_empty() {
            return Err("`walls` must have at least one row".into());
        }
        let frame = CameraBasis::new(self.pose(), CameraRules::default());
        for (i, wall) in self.walls().enumerate() {
            let size = wall.size();
            if size.min_element() <= 0.0 {
                return Err(format!("wall {} has no extent: its corners must differ", i + 1));
            }
            if wall.across.dot(wall.upwards).abs() > 1e-3 * size.x * size.y {
                return Err(format!("wall {} has no right angle at its first corner", i + 1));
            }
            for view in self.eyes.views(self.eye_size()) {
                if (self.eye(&frame, view.side) - wall.corner).dot(wall.normal()).abs() < 1e-6 * size.max_element() {
                    return Err(format!("an eye is in the plane of wall {}; move `center` or the wall", i + 1));
                }
            }
        }
        Ok(())
    }

    fn ray(&self, frame: &CameraBasis, sample: &CameraSample) -> Option<Ray> {
        let (eye, _, point) = self.wall_point(frame, sample)?;
        Some(world_ray(eye, point - eye))
    }

    fn project(&self, frame: &CameraBasis, world: Vec3, _: Vec2, emit: &mut dyn FnMut(Vec2)) {
        let one = self.eye_size();
        for view in self.eyes.views(one) {
            let eye = self.eye(frame, view.side);
            for wall in self.walls() {
                // Solve corner + s across + t upwards - eye = k (world - eye) for s, t and k.
                let to_world = world.as_dvec3() - eye;
                let solved = DMat3::from_cols(wall.across, wall.upwards, -to_world).inverse() * (eye - wall.corner);
                let position = DVec2::new(wall.left, 0.0) + solved.truncate() * wall.size();
                if solved.z > 0.0 && solved.is_finite() && wall.contains(position) {
                    emit(self.eyes.point(one, view, position).as_vec2());
                }
            }
        }
    }

    fn footprint(&self, frame: &CameraBasis, sample: &CameraSample, t: f32) -> f32 {
        let Some((eye, wall, point)) = self.wall_point(frame, sample) else { return 0.0 };
        let (to_wall, unit) = (point - eye, self.eyes.sheet(self.eye_size()).unit());
        let solid_angle = wall.normal().dot(to_wall).abs() / (to_wall.length_squared() * to_wall.length());
        (f64::from(t * t) * solid_angle * unit * unit) as f32
    }
}
