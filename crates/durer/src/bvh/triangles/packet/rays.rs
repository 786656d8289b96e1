//! Rays side by side.

use super::Axes;
use crate::bvh::lanes::{Lanes, WIDE, Wide};
use crate::math::{Aabb, Ray, Vec2, Vec3};
use crate::shape::watertight::{Along, uv_across};

/// A number for each of sixteen rays.
pub type Numbers = [f32; WIDE];

const ZERO: Numbers = [0.0; WIDE];

/// Sixteen rays of one octant and one longest axis, prepared for boxes as in [`RayBox`](crate::bvh::traverse::RayBox), and for
/// triangles as in [`Sheared`](crate::shape::watertight::Sheared).
#[derive(Clone, Copy)]
#[repr(align(64))]
pub struct Rays {
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
    /// Heights lower than the first or above the second are outside the interval for sure; those above the third and below the
    /// fourth are inside.
    pub heights: [Numbers; 4],
    /// Numbers of what was met.
    pub met: [u32; WIDE],
}

impl Rays {
    pub const EMPTY: Rays = Rays {
        origin: [ZERO; 3],
        dir: [ZERO; 3],
        inverse: [ZERO; 3],
        near_from: [ZERO; 3],
        far_from: [ZERO; 3],
        near_origin: [ZERO; 3],
        far_origin: [ZERO; 3],
        shear: [ZERO; 2],
        t_min: ZERO,
        t_last: ZERO,
        heights: [ZERO; 4],
        met: [0; WIDE],
    };

    #[inline(always)]
    pub fn set(&mut self, lane: usize, ray: &Ray) {
        for axis in 0..3 {
            self.origin[axis][lane] = ray.origin[axis];
            self.dir[axis][lane] = ray.dir[axis];
        }
        (self.t_min[lane], self.t_last[lane]) = (ray.t_min, ray.t_max);
    }

    /// By axis, a bit for each ray whose direction is negative there; and those of which the first, or the second component is the
    /// longest.
    #[inline(always)]
    pub fn signs<L: Lanes>(&self, lanes: L) -> [u32; 5] {
        let wide = lanes.wide();
        let [x, y, z] = &self.dir;
        let (x, y, z) = (wide.load(x), wide.load(y), wide.load(z));
        let zero = wide.splat(0.0);
        let negative = [wide.lt(x, zero), wide.lt(y, zero), wide.lt(z, zero)];
        let (x, y, z) = (wide.abs(x), wide.abs(y), wide.abs(z));
        let first = wide.lt(y, x) & wide.lt(z, x);
        [negative[0], negative[1], negative[2], first, wide.lt(z, y) & !first]
    }

    /// Prepares the rays for a tree with these bounds; gives those that are tame, a bit for each.
    #[inline(always)]
    pub fn prepare<L: Lanes>(&mut self, lanes: L, axes: &Axes, bounds: Aabb) -> u32 {
        let wide = lanes.wide();
        let (least, most) = (wide.splat(1e-15), wide.splat(1e15));
        let mut reach = wide.splat(0.0);
        let mut tame = wide.lt(wide.load(&self.t_min), wide.load(&self.t_last));
        for axis in 0..3 {
            let o = wide.load(&self.origin[axis]);
            let length = wide.abs(wide.load(&self.dir[axis]));
            tame &= wide.lt(least, length) & wide.lt(length, most) & wide.lt(wide.abs(o), most);
            let below = wide.abs(wide.sub(o, wide.splat(bounds.min[axis])));
            let above = wide.abs(wide.sub(o, wide.splat(bounds.max[axis])));
            reach = wide.max(wide.max(below, above), wide.max(wide.abs(o), reach));
        }
        tame &= wide.lt(reach, most) & wide.lt(least, reach);
        let pad = wide.add(wide.mul(wide.splat(8.0 * f32::EPSILON), reach), wide.splat(f32::MIN_POSITIVE));
        for axis in 0..3 {
            let (o, d) = (wide.load(&self.origin[axis]), wide.load(&self.dir[axis]));
            let outward = wide.mul(pad, wide.splat(if axes.negative[axis] == 1 { -1.0 } else { 1.0 }));
            let (near, far) = (wide.add(o, outward), wide.sub(o, outward));
            let inverse = wide.div(wide.splat(1.0), d);
            let zero = wide.splat(0.0);
            self.inverse[axis] = wide.store(inverse);
            self.near_from[axis] = wide.store(near);
            self.far_from[axis] = wide.store(far);
            self.near_origin[axis] = wide.store(wide.mul(wide.sub(zero, near), inverse));
            self.far_origin[axis] = wide.store(wide.mul(wide.sub(zero, far), inverse));
        }
        let [x, y, z] = axes.turned;
        let z = wide.load(&self.dir[z]);
        self.shear =
            [wide.store(wide.div(wide.load(&self.dir[x]), z)), wide.store(wide.div(wide.load(&self.dir[y]), z))];
        // The interval is open.
        self.t_last = self.t_last.map(f32::next_down);
        self.met = [0; WIDE];
        self.bound(lanes, axes);
        tame
    }

    /// Sets the bounds of heights.
    #[inline(always)]
    pub fn bound<L: Lanes>(&mut self, lanes: L, axes: &Axes) {
        let wide = lanes.wide();
        let dz = wide.load(&self.dir[axes.turned[2]]);
        let (near, far) = (wide.mul(wide.load(&self.t_min), dz), wide.mul(wide.load(&self.t_last), dz));
        let (low, high) = if axes.negative[axes.turned[2]] == 1 { (far, near) } else { (near, far) };
        let (low_slack, high_slack) = (slack(wide, low), slack(wide, high));
        self.heights = [
            wide.store(wide.sub(low, low_slack)),
            wide.store(wide.add(high, high_slack)),
            wide.store(wide.add(low, low_slack)),
            wide.store(wide.sub(high, high_slack)),
        ];
    }

    /// Takes note of a triangle that the lines of some rays cross, of those who meet it in their interval, and before others.
    ///
    /// `number` is that of the meeting, and `less` says whether the triangle of another is of greater number.
    #[inline(always)]
    pub fn meet(
        &mut self,
        axes: &Axes,
        corners: [Vec3; 3],
        crossed: u32,
        number: u32,
        less: impl Fn(u32) -> bool,
    ) -> u32 {
        const HALF: usize = WIDE / 2;
        let mut met = 0;
        for (half, crossed) in [(0, crossed & 255), (1, crossed >> HALF)] {
            if crossed != 0 {
                met |= self.meet_half(axes, corners, half * HALF, crossed, number, &less) << (half * HALF);
            }
        }
        met
    }

    #[inline(always)]
    fn meet_half(
        &mut self,
        axes: &Axes,
        corners: [Vec3; 3],
        first: usize,
        crossed: u32,
        number: u32,
        less: &impl Fn(u32) -> bool,
    ) -> u32 {
        const HALF: usize = WIDE / 2;
        let [x, y, z] = axes.turned;
        let half = |numbers: &Numbers| -> [f32; HALF] { std::array::from_fn(|i| numbers[first + i]) };
        let (ox, oy, oz) = (half(&self.origin[x]), half(&self.origin[y]), half(&self.origin[z]));
        let (dx, dy, dz) = (half(&self.dir[x]), half(&self.dir[y]), half(&self.dir[z]));
        let (mut t, mut inside) = ([0.0; HALF], [0; HALF]);
        for i in 0..HALF {
            let along = Along::new(Vec3::new(ox[i], oy[i], oz[i]), Vec3::new(dx[i], dy[i], dz[i]), corners);
            (t[i], inside[i]) = (along.t as f32, u32::from(along.is_inside()) << i);
        }
        if inside.iter().fold(0, |all, bit| all | bit) & crossed != crossed {
            for i in 0..HALF {
                let along = Along::new(Vec3::new(ox[i], oy[i], oz[i]), Vec3::new(dx[i], dy[i], dz[i]), corners);
                t[i] = along.bounded();
            }
        }
        let (t_min, t_last) = (half(&self.t_min), half(&self.t_last));
        let (mut before, mut same) = ([0; HALF], [0; HALF]);
        for i in 0..HALF {
            // Also NaN is refused.
            before[i] = u32::from((t[i] > t_min[i]) & (t[i] < t_last[i])) << i;
            same[i] = u32::from((t[i] > t_min[i]) & (t[i] == t_last[i])) << i;
        }
        let mut met = before.iter().fold(0, |all, bit| all | bit) & crossed;
        let mut same = same.iter().fold(0, |all, bit| all | bit) & crossed;
        while same != 0 {
            let i = same.trailing_zeros() as usize;
            same &= same - 1;
            met |= u32::from(less(self.met[first + i])) << i;
        }
        for i in 0..HALF {
            let wanted = met >> i & 1 == 1;
            self.t_last[first + i] = if wanted { t[i] } else { t_last[i] };
            self.met[first + i] = if wanted { number } else { self.met[first + i] };
        }
        met
    }

    /// As [`Rays::meet`] for a single ray.
    #[inline(always)]
    pub fn meet_one(
        &mut self,
        axes: &Axes,
        corners: [Vec3; 3],
        lane: usize,
        number: u32,
        less: impl Fn(u32) -> bool,
    ) -> bool {
        let [x, y, z] = axes.turned;
        let at = |v: &[Numbers; 3]| Vec3::new(v[x][lane], v[y][lane], v[z][lane]);
        let along = Along::new(at(&self.origin), at(&self.dir), corners);
        let t = if along.is_inside() { along.t as f32 } else { along.bounded() };
        let met = t > self.t_min[lane] && (t < self.t_last[lane] || t == self.t_last[lane] && less(self.met[lane]));
        if met {
            (self.t_last[lane], self.met[lane]) = (t, number);
        }
        met
    }

    /// Barycentric coordinates in a triangle for each ray, by coordinate of corners.
    #[inline(always)]
    pub fn uv(&self, axes: &Axes, corners: &[[Numbers; 3]; 3]) -> [Numbers; 2] {
        let [x, y, z] = axes.turned;
        let (x, y, z) = (&self.origin[x], &self.origin[y], &self.origin[z]);
        let mut uv = [ZERO; 2];
        for i in 0..WIDE {
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
fn slack<W: Wide>(wide: W, height: W::Floats) -> W::Floats {
    wide.add(wide.mul(wide.splat(8.0 * f32::EPSILON), wide.abs(height)), wide.splat(f32::MIN_POSITIVE))
}
