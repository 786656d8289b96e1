//! Eight rays side by side.

use super::Axes;
use crate::bvh::lanes::{Lanes, WIDTH};
use crate::math::{Aabb, Ray, Vec2, Vec3};
use crate::shape::watertight::{distance_along, uv_across};

/// A number for each of eight rays.
pub type Numbers = [f32; WIDTH];

/// What was met first by each ray so far.
#[derive(Clone, Copy)]
pub struct Met {
    pub triangle: [u32; WIDTH],
    pub leaf: [u32; WIDTH],
    pub lane: [u32; WIDTH],
}

/// Eight rays of one octant and one longest axis, prepared for boxes as in [`RayBox`](crate::bvh::traverse::RayBox), and for triangles
/// as in [`Sheared`](crate::shape::watertight::Sheared).
#[derive(Clone, Copy)]
#[repr(align(64))]
pub struct Eight {
    pub origin: [Numbers; 3],
    pub dir: [Numbers; 3],
    pub inverse: [Numbers; 3],
    /// Origins, moved outwards by the padding of boxes.
    pub near_from: [Numbers; 3],
    pub far_from: [Numbers; 3],
    /// The same, times the inverse of the direction, and negated.
    pub near_origin: [Numbers; 3],
    pub far_origin: [Numbers; 3],
    pub shear: [Numbers; 2],
    pub t_min: Numbers,
    /// The last t inside the interval; after a hit, its t.
    pub t_last: Numbers,
    /// Bounds of the heights that belong to the interval, but for rounding.
    pub heights: [Numbers; 2],
    pub met: Met,
}

impl Eight {
    pub const EMPTY: Eight = Eight {
        origin: [[0.0; WIDTH]; 3],
        dir: [[0.0; WIDTH]; 3],
        inverse: [[0.0; WIDTH]; 3],
        near_from: [[0.0; WIDTH]; 3],
        far_from: [[0.0; WIDTH]; 3],
        near_origin: [[0.0; WIDTH]; 3],
        far_origin: [[0.0; WIDTH]; 3],
        shear: [[0.0; WIDTH]; 2],
        t_min: [0.0; WIDTH],
        t_last: [0.0; WIDTH],
        heights: [[0.0; WIDTH]; 2],
        met: Met { triangle: [0; WIDTH], leaf: [0; WIDTH], lane: [0; WIDTH] },
    };

    #[inline(always)]
    pub fn set(&mut self, lane: usize, ray: &Ray) {
        for axis in 0..3 {
            self.origin[axis][lane] = ray.origin[axis];
            self.dir[axis][lane] = ray.dir[axis];
        }
        (self.t_min[lane], self.t_last[lane]) = (ray.t_min, ray.t_max);
    }

    /// Prepares the rays for a tree with these bounds; gives those that are tame, a bit for each.
    #[inline(always)]
    pub fn prepare<L: Lanes>(&mut self, lanes: L, axes: &Axes, bounds: Aabb) -> u32 {
        let (least, most) = (lanes.splat(1e-15), lanes.splat(1e15));
        let mut reach = lanes.splat(0.0);
        let mut tame = lanes.lt(lanes.load(&self.t_min), lanes.load(&self.t_last));
        for axis in 0..3 {
            let o = lanes.load(&self.origin[axis]);
            let length = lanes.abs(lanes.load(&self.dir[axis]));
            tame &= lanes.lt(least, length) & lanes.lt(length, most) & lanes.lt(lanes.abs(o), most);
            let below = lanes.abs(lanes.sub(o, lanes.splat(bounds.min[axis])));
            let above = lanes.abs(lanes.sub(o, lanes.splat(bounds.max[axis])));
            reach = lanes.max(lanes.max(below, above), lanes.max(lanes.abs(o), reach));
        }
        tame &= lanes.lt(reach, most) & lanes.lt(least, reach);
        let pad = lanes.add(lanes.mul(lanes.splat(8.0 * f32::EPSILON), reach), lanes.splat(f32::MIN_POSITIVE));
        for axis in 0..3 {
            let (o, d) = (lanes.load(&self.origin[axis]), lanes.load(&self.dir[axis]));
            let outward = lanes.mul(pad, lanes.splat(if axes.negative[axis] == 1 { -1.0 } else { 1.0 }));
            let (near, far) = (lanes.add(o, outward), lanes.sub(o, outward));
            let inverse = lanes.div(lanes.splat(1.0), d);
            let zero = lanes.splat(0.0);
            self.inverse[axis] = lanes.store(inverse);
            self.near_from[axis] = lanes.store(near);
            self.far_from[axis] = lanes.store(far);
            self.near_origin[axis] = lanes.store(lanes.mul(lanes.sub(zero, near), inverse));
            self.far_origin[axis] = lanes.store(lanes.mul(lanes.sub(zero, far), inverse));
        }
        let [x, y, z] = axes.turned;
        let z = lanes.load(&self.dir[z]);
        self.shear = [
            lanes.store(lanes.div(lanes.load(&self.dir[x]), z)),
            lanes.store(lanes.div(lanes.load(&self.dir[y]), z)),
        ];
        // The interval is open.
        self.t_last = self.t_last.map(f32::next_down);
        self.met.triangle = [u32::MAX; WIDTH];
        self.bound(lanes, axes);
        tame
    }

    /// Sets the bounds of heights.
    #[inline(always)]
    pub fn bound<L: Lanes>(&mut self, lanes: L, axes: &Axes) {
        let dz = lanes.load(&self.dir[axes.turned[2]]);
        let (near, far) = (lanes.mul(lanes.load(&self.t_min), dz), lanes.mul(lanes.load(&self.t_last), dz));
        let (low, high) = if axes.negative[axes.turned[2]] == 1 { (far, near) } else { (near, far) };
        self.heights = [
            lanes.store(lanes.sub(low, slack(lanes, low))),
            lanes.store(lanes.add(high, slack(lanes, high))),
        ];
    }

    /// Takes note of a triangle that the lines of some rays cross: those that meet it in their interval, and before others.
    #[inline(always)]
    pub fn meet(&mut self, axes: &Axes, corners: [Vec3; 3], crossed: u32, triangle: u32, leaf: u32, place: u32) -> u32 {
        let [x, y, z] = axes.turned;
        let (origin, dir) = ([&self.origin[x], &self.origin[y], &self.origin[z]], [&self.dir[x], &self.dir[y], &self.dir[z]]);
        let mut t = [0.0; WIDTH];
        for i in 0..WIDTH {
            let at = |v: [&Numbers; 3]| Vec3::new(v[0][i], v[1][i], v[2][i]);
            t[i] = distance_along(at(origin), at(dir), corners);
        }
        let mut first = 0;
        for i in 0..WIDTH {
            // Also NaN is refused.
            let before = t[i] < self.t_last[i] || t[i] == self.t_last[i] && triangle < self.met.triangle[i];
            first |= u32::from(t[i] > self.t_min[i] && before) << i;
        }
        first &= crossed;
        for i in 0..WIDTH {
            let wanted = first >> i & 1 == 1;
            self.t_last[i] = if wanted { t[i] } else { self.t_last[i] };
            self.met.triangle[i] = if wanted { triangle } else { self.met.triangle[i] };
            self.met.leaf[i] = if wanted { leaf } else { self.met.leaf[i] };
            self.met.lane[i] = if wanted { place } else { self.met.lane[i] };
        }
        first
    }

    /// Barycentric coordinates in a triangle for each ray, by coordinate of corners.
    #[inline(always)]
    pub fn uv(&self, axes: &Axes, corners: &[[Numbers; 3]; 3]) -> [Numbers; 2] {
        let [x, y, z] = axes.turned;
        let (x, y, z) = (&self.origin[x], &self.origin[y], &self.origin[z]);
        let mut uv = [[0.0; WIDTH]; 2];
        for i in 0..WIDTH {
            let flat = |c: &[Numbers; 3]| {
                let height = c[2][i] - z[i];
                Vec2::new(c[0][i] - x[i] - self.shear[0][i] * height, c[1][i] - y[i] - self.shear[1][i] * height)
            };
            let found = uv_across([flat(&corners[0]), flat(&corners[1]), flat(&corners[2])]);
            (uv[0][i], uv[1][i]) = (found.x, found.y);
        }
        uv
    }

    /// One of the rays.
    pub fn ray(&self, lane: usize) -> Ray {
        let at = |v: &[Numbers; 3]| Vec3::new(v[0][lane], v[1][lane], v[2][lane]);
        Ray { origin: at(&self.origin), dir: at(&self.dir), t_min: self.t_min[lane], t_max: self.t_last[lane] }
    }
}

/// By how much heights may be off by rounding.
#[inline(always)]
fn slack<L: Lanes>(lanes: L, height: L::Floats) -> L::Floats {
    lanes.add(lanes.mul(lanes.splat(8.0 * f32::EPSILON), lanes.abs(height)), lanes.splat(f32::MIN_POSITIVE))
}
