//! Axes of a packet and triangles that it has hit.

use crate::watertight::{AxisOrder, Plane, axis_order_for};
use glam::Vec3A;

/// Axis order and direction signs that are common to all rays of a packet.
#[derive(Clone, Copy)]
pub struct PacketAxes {
    /// Axis order, as in [`WatertightRay`](crate::watertight::WatertightRay).
    pub turn: AxisOrder,
    /// 1 for axes along which directions are negative, and 0 for the others.
    pub negative: [usize; 3],
}

impl PacketAxes {
    /// Decodes a key, which combines signs and the longest axis.
    pub fn of_key(key: usize) -> Self {
        let negative = [key & 1, key >> 1 & 1, key >> 2 & 1];
        let longest = key >> 3;
        PacketAxes { turn: axis_order_for(longest, negative[longest]), negative }
    }

    /// Returns the indices of the first, second, and third axis of permuted vectors.
    #[inline(always)]
    pub fn turned(&self) -> [usize; 3] {
        let [x, y, z, _] = self.turn;
        [x as usize, y as usize, z as usize]
    }

    /// Returns true if the directions are negative along their longest axis.
    #[inline(always)]
    pub fn is_down(&self) -> bool {
        self.negative[self.turned()[2]] == 1
    }
}

/// A triangle that at least one ray of a packet has hit, prepared for computing `t` and barycentric
/// coordinates.
pub struct HitTriangle {
    /// Corners of the triangle, with the axes permuted.
    pub corners: [[f32; 3]; 3],
    pub triangle: u32,
    pub plane: Plane<[f64; 3]>,
}

impl HitTriangle {
    #[inline(always)]
    pub fn new(corners: [Vec3A; 3], triangle: u32) -> Self {
        HitTriangle { corners: corners.map(|corner| corner.to_array()), triangle, plane: Plane::single(corners) }
    }
}
