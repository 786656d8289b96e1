//! The frame of a surface point: z is its normal.

use crate::math::Vec3;

/// Three unit vectors at right angles. Directions in it are *local*: z is the cosine to the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The local x axis: where the surface has one, the direction in which u grows.
    pub tangent: Vec3,
    /// The local y axis.
    pub bitangent: Vec3,
    /// The local z axis.
    pub normal: Vec3,
}

impl Frame {
    /// Any frame around a unit normal.
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

    /// The frame around a unit normal whose x axis is as near to a direction as can be.
    pub fn along(normal: Vec3, direction: Vec3) -> Frame {
        match (direction - normal * normal.dot(direction)).try_normalize() {
            Some(tangent) => Frame { tangent, bitangent: normal.cross(tangent), normal },
            None => Frame::around(normal),
        }
    }

    /// A direction of the world as the frame sees it.
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.tangent), v.dot(self.bitangent), v.dot(self.normal))
    }

    /// A local direction in the world.
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        v.x * self.tangent + v.y * self.bitangent + v.z * self.normal
    }
}
