//! Texture coordinates, computed lazily: most surfaces have no texture.

use super::turn;
use crate::math::{Vec2, Vec3, fp};

/// Texture coordinates of a surface point, or the data to compute them from when they are needed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Uv {
    /// The shape has no texture coordinates.
    #[default]
    None,
    /// Already computed.
    At(Vec2),
    /// Angle of a point in a plane, measured from -x, and the coordinate along the axis.
    Turned(Vec2, f32),
    /// Longitude from -z over +x, and latitude from the south pole upwards, of a unit vector.
    Globe(Vec3),
    /// Coordinates along two axes of a plane, from its unit normal and the point.
    Sheet(Vec3, Vec3),
}

impl Uv {
    /// Computes the coordinates, if there are any.
    pub fn get(self) -> Option<Vec2> {
        use std::f32::consts::{PI, TAU};
        Some(match self {
            Uv::None => return None,
            Uv::At(uv) => uv,
            Uv::Turned(around, v) => Vec2::new(turn(around.x.into(), around.y.into()), v),
            Uv::Globe(n) => {
                let (around, up) = (fp::atan2(n.x, -n.z), fp::asin(n.y.clamp(-1.0, 1.0)));
                Vec2::new(around / TAU + 0.5, up / PI + 0.5)
            }
            Uv::Sheet(normal, point) => {
                let (tangent, bitangent) = normal.any_orthonormal_pair();
                Vec2::new(tangent.dot(point), bitangent.dot(point))
            }
        })
    }
}

impl From<Vec2> for Uv {
    fn from(uv: Vec2) -> Self {
        Uv::At(uv)
    }
}

impl From<Option<Vec2>> for Uv {
    fn from(uv: Option<Vec2>) -> Self {
        uv.map_or(Uv::None, Uv::At)
    }
}
