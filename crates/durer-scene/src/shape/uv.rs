//! Texture coordinates, computed lazily: most surfaces have no texture.

use super::angle_fraction;
use crate::math::{Vec2, Vec3, fp};

/// Texture coordinates of a surface point, or the data to compute them from when they are needed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Uv {
    /// The shape has no texture coordinates.
    #[default]
    None,
    /// Already computed.
    Value(Vec2),
    /// Angle of a point in a plane, measured from -x, and the coordinate along the axis.
    Angle(Vec2, f32),
    /// Longitude from -z over +x, and latitude from the south pole upwards, of a unit vector.
    Sphere(Vec3),
    /// Coordinates along two axes of a plane, from its unit normal and the point.
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
