//! A cube map, which shows every direction on the six faces of a cube, in one picture.
//!
//! The `cross` layout has four faces in a row (left, front, right, back), with the up face above
//! the front face and the down face below it. Every fold is therefore an edge of the cube. The
//! `strip` layout has the faces in one row: right, left, up, down, back, front. In axes, the order
//! is +x, -x, +y, -y, +z, -z for a camera that looks along -z. Each face is a square view of 90
//! degrees, and it is upright as in the cross. On a face whose coordinates run from -1 to 1, the
//! solid angle per unit area is 1 / |direction|³.
//!
//! Source: Greene, *Environment Mapping and Other Applications of World Projections*, CG&A 6(11),
//! 1986.

use super::Pose;
use super::central::SingleViewpoint;
use super::sheet::PictureSheet;
use crate::describe::{Constraint, described, described_words};
use crate::dialect::set;
use crate::math::{Vec2, Vec3};
use glam::{DVec2, DVec3};

described_words! {
    /// Layout of the six faces of a cube map in one picture.
    Layout { Cross = "cross", Strip = "strip" }
}

described! {
    /// A camera that sees all directions, on the six faces of a cube.
    CubeMapCamera ["CubeMapCamera" in set::DURER] {
        /// Position of the eye.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// Direction to the centre of the front face; of any length.
        direction: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["direction" in set::DURER];
        /// Up direction of the front face; need not be perpendicular to `direction`.
        up: Vec3 = Vec3::Y, required, Constraint::NonZero, ["up" in set::DURER];
        /// Layout of the faces in the picture.
        layout: Layout = Layout::Cross, optional, Constraint::Any, ["layout" in set::DURER];
    }
}

/// Face of the cube. `axes` holds the directions of the centre, right and up of the face in camera
/// space. `cross` and `strip` hold the column and row of the face in each layout, counted from the
/// lower left corner.
struct Face {
    axes: [DVec3; 3],
    cross: [f64; 2],
    strip: [f64; 2],
}

const FACES: [Face; 6] = [
    Face { axes: [DVec3::X, DVec3::NEG_Z, DVec3::Y], cross: [2.0, 1.0], strip: [0.0, 0.0] },
    Face { axes: [DVec3::NEG_X, DVec3::Z, DVec3::Y], cross: [0.0, 1.0], strip: [1.0, 0.0] },
    Face { axes: [DVec3::Y, DVec3::X, DVec3::NEG_Z], cross: [1.0, 2.0], strip: [2.0, 0.0] },
    Face { axes: [DVec3::NEG_Y, DVec3::X, DVec3::Z], cross: [1.0, 0.0], strip: [3.0, 0.0] },
    Face { axes: [DVec3::NEG_Z, DVec3::NEG_X, DVec3::Y], cross: [3.0, 1.0], strip: [4.0, 0.0] },
    Face { axes: [DVec3::Z, DVec3::X, DVec3::Y], cross: [1.0, 1.0], strip: [5.0, 0.0] },
];

impl CubeMapCamera {
    /// Returns the sheet of the picture, whose unit is one face.
    fn sheet(&self) -> PictureSheet {
        PictureSheet(match self.layout {
            Layout::Cross => DVec2::new(4.0, 3.0),
            Layout::Strip => DVec2::new(6.0, 1.0),
        })
    }

    fn corner(&self, face: &Face) -> DVec2 {
        DVec2::from(match self.layout {
            Layout::Cross => face.cross,
            Layout::Strip => face.strip,
        })
    }
}

impl SingleViewpoint for CubeMapCamera {
    fn camera_pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn picture_proportions(&self) -> Option<Vec2> {
        self.sheet().proportions()
    }

    fn direction(&self, point: DVec2, pixel: DVec2) -> Option<DVec3> {
        let (at, position) = (self.sheet().position(pixel), self.sheet().position(point));
        let face = FACES.iter().find(|face| PictureSheet(DVec2::ONE).contains(at - self.corner(face)))?;
        let on_face = 2.0 * (position - self.corner(face)) - 1.0;
        let [middle, right, up] = face.axes;
        Some(middle + on_face.x * right + on_face.y * up)
    }

    fn project_direction(&self, direction: DVec3, emit: &mut dyn FnMut(DVec2)) {
        // Find the face whose centre is nearest to the direction.
        let nearest = |best: &'static Face, face: &'static Face| match direction.dot(face.axes[0])
            > direction.dot(best.axes[0])
        {
            true => face,
            false => best,
        };
        let face = FACES.iter().fold(&FACES[0], nearest);
        let [depth, x, y] = face.axes.map(|axis| direction.dot(axis));
        emit(self.sheet().point(self.corner(face) + 0.5 * (DVec2::new(x, y) / depth + 1.0)));
    }

    fn solid_angle(&self, point: DVec2, pixel: DVec2) -> f64 {
        let Some(direction) = self.direction(point, pixel) else { return 0.0 };
        // A face is 2 wide in camera space and 1 wide on the sheet.
        let unit = 2.0 * self.sheet().unit();
        unit * unit / (direction.length_squared() * direction.length())
    }
}
