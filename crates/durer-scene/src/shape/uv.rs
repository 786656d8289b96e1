//! Texture coordinates that are computed only on demand, since most surfaces have no texture.

use super::angle_fraction;
use crate::math::{Vec2, Vec3, fp};

/// Texture coordinates of a surface point, or the data from which they are computed when they are
/// needed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Uv {
    /// The shape has no texture coordinates.
    #[default]
    None,
    /// Coordinates that have already been computed.
    Value(Vec2),
    /// Point whose angle around the axis, measured from -x, gives the u coordinate, and the v
    /// coordinate.
    Angle(Vec2, f32),
    /// Unit vector that gives the longitude, measured from -z towards +x, and the latitude,
    /// measured upwards from the south pole.
    Sphere(Vec3),
    /// Unit normal of a plane and a point on it, which give the coordinates along two axes of the
    /// plane.
    Plane(Vec3, Vec3),
}

impl Uv {
    /// Computes the coordinates, if there are any.
    pub fn get(self) -> Option<Vec2> {
        use std::f32::consts::{PI, TAU};
        Some(match self {
            Uv::None => return None,
            Uv::Value(uv) => uv,
            Uv::Angle(around, v) => Vec2::new(angle_fraction(around.x.into(), around.y.into()), v),
            Uv::Sphere(n) => {
                let (around, up) = (fp::atan2(n.x, -n.z), fp::asin(n.y.clamp(-1.0, 1.0)));
                Vec2::new(around / TAU + 0.5, up / PI + 0.5)
            }
            Uv::Plane(normal, point) => {
                let (tangent, bitangent) = normal.any_orthonormal_pair();
                Vec2::new(tangent.dot(point), bitangent.dot(point))
            }
        })
    }
}

impl From<Vec2> for Uv {
    fn from(uv: Vec2) -> Self {
        Uv::Value(uv)
    }
}

impl From<Option<Vec2>> for Uv {
    fn from(uv: Option<Vec2>) -> Self {
        uv.map_or(Uv::None, Uv::Value)
    }
}
