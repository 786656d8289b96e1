//! What the parts of a packet's way share: the axes and triangles of all its rays.

use crate::watertight::{AxisOrder, Plane, turned_axes};
use glam::Vec3A;

/// What the rays of a packet have in common.
#[derive(Clone, Copy)]
pub struct Axes {
    /// As those of [`WatertightRay`](crate::watertight::WatertightRay).
    pub turn: AxisOrder,
    /// By axis: 1 where directions are negative, else 0.
    pub negative: [usize; 3],
}

impl Axes {
    /// A key is a longest axis and signs.
    pub fn of_key(key: usize) -> Self {
        let negative = [key & 1, key >> 1 & 1, key >> 2 & 1];
        let longest = key >> 3;
        Axes { turn: turned_axes(longest, negative[longest]), negative }
    }

    /// Which axes are the first, second, and third of turned vectors.
    #[inline(always)]
    pub fn turned(&self) -> [usize; 3] {
        let [x, y, z, _] = self.turn;
        [x as usize, y as usize, z as usize]
    }

    /// Whether directions are negative along their longest axis.
    #[inline(always)]
    pub fn is_down(&self) -> bool {
        self.negative[self.turned()[2]] == 1
    }
}

/// A triangle that some ray met.
pub struct Meeting {
    /// Turned, as the rays are.
    pub corners: [[f32; 3]; 3],
    pub triangle: u32,
    pub plane: Plane<[f64; 3]>,
}

impl Meeting {
    #[inline(always)]
    pub fn new(corners: [Vec3A; 3], triangle: u32) -> Self {
        Meeting { corners: corners.map(|corner| corner.to_array()), triangle, plane: Plane::single(corners) }
    }
}
