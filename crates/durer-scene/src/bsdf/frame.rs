//! Local frame at a surface point. The z axis of the frame is the normal.

use crate::math::Vec3;

/// Orthonormal basis at a surface point, used by BSDFs. Directions in this basis are called
/// *local*, and their z component is the cosine of the angle to the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x axis, which is the direction of increasing u if the surface has one.
    pub tangent: Vec3,
    /// Local y axis.
    pub bitangent: Vec3,
    /// Local z axis.
    pub normal: Vec3,
}

impl Frame {
    /// Creates a frame around a unit normal, with an arbitrary tangent.
    ///
    /// Source: Duff and others, *Building an Orthonormal Basis, Revisited*, JCGT 6(1), 2017.
    pub fn around(normal: Vec3) -> Frame {
        let sign = 1.0_f32.copysign(normal.z);
        let a = -1.0 / (sign + normal.z);
        let b = normal.x * normal.y * a;
        Frame {
            tangent: Vec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
            bitangent: Vec3::new(b, sign + normal.y * normal.y * a, -normal.y),
            normal,
        }
    }

    /// Creates a frame around a unit normal, with its x axis as close to `direction` as possible.
    pub fn along(normal: Vec3, direction: Vec3) -> Frame {
        match (direction - normal * normal.dot(direction)).try_normalize() {
            Some(tangent) => Frame { tangent, bitangent: normal.cross(tangent), normal },
            None => Frame::around(normal),
        }
    }

    /// Converts a direction from world space to the local frame.
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.tangent), v.dot(self.bitangent), v.dot(self.normal))
    }

    /// Converts a local direction to world space.
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        v.x * self.tangent + v.y * self.bitangent + v.z * self.normal
    }
}
