//! A paraboloidal mirror below a lens that receives parallel rays, which gives a wide view from a
//! single viewpoint.
//!
//! The mirror z = (h² - r²) / 2h has its focus at 0, and its axis points along z, towards the lens.
//! Every ray that travels towards the focus is reflected so that it continues along the axis. A
//! direction at the angle θ from the axis is therefore seen at r = h tan(θ/2). The picture is
//! oriented like a map seen from above. For a viewer at the focus who looks up, left and right are
//! exchanged. The rim of the disc sees half the field of view, so r = 1 at θ = angle / 2. The
//! horizon of the scene is at r = h. The lens, which would hide the centre of a real picture, is
//! omitted.
//!
//! Source: Nayar, *Catadioptric Omnidirectional Camera*, CVPR 1997; Baker, Nayar, *A Theory of
//! Single-Viewpoint Catadioptric Image Formation*, IJCV 35(2), 1999.

use super::Pose;
use super::central::SingleViewpoint;
use super::fisheye::FisheyeProjection;
use crate::describe::{Constraint, described};
use crate::dialect::set;
use crate::math::{Vec2, Vec3};
use glam::{DVec2, DVec3};

described! {
    /// A camera that looks into a parabolic mirror and sees all around; the corners of the picture
    /// are black.
    ParabolicCamera ["ParabolicCamera" in set::DURER] {
        /// Focus of the mirror: the single viewpoint.
        center: Vec3 = Vec3::ZERO, required, Constraint::Any, ["center" in set::DURER];
        /// Axis of the mirror, from its focus to the lens, usually upwards; of any length.
        direction: Vec3 = Vec3::Y, required, Constraint::NonZero, ["direction" in set::DURER];
        /// Up direction of the picture; need not be perpendicular to `direction`.
        up: Vec3 = Vec3::NEG_Z, required, Constraint::NonZero, ["up" in set::DURER];
        /// Field of view around the axis, in degrees: 180 reaches the horizon, and larger values
        /// reach below it.
        angle: f32 = 210.0, optional, Constraint::Between(0.0, 360.0), ["angle" in set::DURER];
    }
}

/// The picture is the mirror image of that of a stereographic fisheye along the axis.
const PROJECTION: FisheyeProjection = FisheyeProjection::Stereographic;
const MIRROR: DVec3 = DVec3::new(-1.0, 1.0, 1.0);

impl ParabolicCamera {
    fn limit(&self) -> f64 {
        0.5 * f64::from(self.angle).to_radians()
    }
}

impl SingleViewpoint for ParabolicCamera {
    fn camera_pose(&self) -> Pose {
        Pose { center: self.center, direction: self.direction, up: self.up }
    }

    fn picture_proportions(&self) -> Option<Vec2> {
        Some(Vec2::ONE)
    }

    fn direction(&self, point: DVec2, _: DVec2) -> Option<DVec3> {
        Some(MIRROR * PROJECTION.direction(point, self.limit())?)
    }

    fn project_direction(&self, direction: DVec3, emit: &mut dyn FnMut(DVec2)) {
        PROJECTION.point(MIRROR * direction, self.limit()).into_iter().for_each(emit);
    }

    fn solid_angle(&self, point: DVec2, _: DVec2) -> f64 {
        PROJECTION.solid_angle(point, self.limit())
    }
}
