//! Rays side by side.

use super::Axes;
use crate::bvh::lanes::{Lanes, Numbers, WIDE, WIDTH, Wide};
use crate::bvh::traverse::ORDINARY;
use crate::math::{Ray, Vec2, Vec3};
use crate::shape::watertight::{Exact, uv_across};
use glam::Vec3A;

/// A number for each of sixteen rays.
pub type PerRay = [f32; WIDE];

const ZERO: PerRay = [0.0; WIDE];

/// Sixteen rays of one octant and one longest axis, prepared for boxes as in [`RayBox`](crate::bvh::traverse::RayBox), though
/// with somewhat less padding, and for triangles as in [`Sheared`](crate::shape::watertight::Sheared).
#[derive(Clone, Copy)]
#[repr(align(64))]
pub struct Rays {
    pub origin: [PerRay; 3],
    pub dir: [PerRay; 3],
    pub inverse: [PerRay; 3],
    /// Origins, moved outwards by the padding of boxes.
    pub near_from: [PerRay; 3],
    pub far_from: [PerRay; 3],
    /// The same, times the inverse of the direction, and negated.
    pub near_origin: [PerRay; 3],
    pub far_origin: [PerRay; 3],
    pub shear: [PerRay; 2],
    pub t_min: PerRay,
    pub t_max: PerRay,
    /// The same; after a hit, its t.
    pub t_last: PerRay,
    /// Heights lower than the first or above the second are outside the interval for sure; those above the third and below the
    /// fourth are inside.
    pub heights: [PerRay; 4],
    /// Numbers of what was met, as bits.
    pub met: PerRay,
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
        t_max: ZERO,
        t_last: ZERO,
        heights: [ZERO; 4],
        met: ZERO,
    };

    /// Sets half of the rays, each given as origin, direction and interval.
    #[inline(always)]
    pub fn set<L: Lanes>(&mut self, lanes: L, first: usize, rays: [L::Floats; WIDTH]) {
        let [x, y, z, u, v, w, t_min, t_max] = lanes.transpose(rays);
        let [dx, dy, dz] = &mut self.dir;
        let [ox, oy, oz] = &mut self.origin;
        for (to, from) in
            [(ox, x), (oy, y), (oz, z), (dx, u), (dy, v), (dz, w), (&mut self.t_min, t_min), (&mut self.t_last, t_max)]
        {
            to[first..first + WIDTH].copy_from_slice(&lanes.store(from));
        }
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

    /// Prepares the rays for a tree with no coordinates greater than `most`; gives those that are tame, a bit for each.
    #[inline(always)]
    pub fn prepare<L: Lanes>(&mut self, lanes: L, axes: &Axes, most: f32) -> u32 {
        let wide = lanes.wide();
        let (least, greatest) = (wide.splat(ORDINARY.start), wide.splat(ORDINARY.end));
        let mut far = wide.splat(0.0);
        let mut tame = wide.lt(wide.load(&self.t_min), wide.load(&self.t_last));
        for axis in 0..3 {
            let (o, length) = (wide.abs(wide.load(&self.origin[axis])), wide.abs(wide.load(&self.dir[axis])));
            tame &= wide.lt(o, greatest) & wide.lt(least, length) & wide.lt(length, greatest);
            far = wide.max(far, o);
        }
        let reach = wide.add(far, wide.splat(most));
        tame &= wide.lt(least, reach) & wide.lt(reach, greatest);
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
        let [x, y, z] = axes.turned();
        let z = wide.load(&self.dir[z]);
        self.shear =
            [wide.store(wide.div(wide.load(&self.dir[x]), z)), wide.store(wide.div(wide.load(&self.dir[y]), z))];
        self.t_max = self.t_last;
        self.met = ZERO;
        self.bound(lanes, axes);
        tame
    }

    /// Sets the bounds of heights.
    #[inline(always)]
    fn bound<L: Lanes>(&mut self, lanes: L, axes: &Axes) {
        let wide = lanes.wide();
        let dz = wide.load(&self.dir[axes.turned()[2]]);
        let (near, far) = (wide.mul(wide.load(&self.t_min), dz), wide.mul(wide.load(&self.t_last), dz));
        let (low, high) = if axes.is_down() { (far, near) } else { (near, far) };
        let (low_slack, high_slack) = (slack(wide, low), slack(wide, high));
        self.heights = [
            wide.store(wide.sub(low, low_slack)),
            wide.store(wide.add(high, high_slack)),
            wide.store(wide.add(low, low_slack)),
            wide.store(wide.sub(high, high_slack)),
        ];
    }

    /// Sets that which bounds the last t, outside, after it has changed.
    #[inline(always)]
    pub fn bound_last<L: Lanes>(&mut self, lanes: L, axes: &Axes) {
        let wide = lanes.wide();
        let far = wide.mul(wide.load(&self.t_last), wide.load(&self.dir[axes.turned()[2]]));
        match axes.is_down() {
            true => self.heights[0] = wide.store(wide.sub(far, slack(wide, far))),
            false => self.heights[1] = wide.store(wide.add(far, slack(wide, far))),
        }
    }

    /// Takes note of a triangle that the lines of some rays cross, of those who meet it in their interval, and before others.
    ///
    /// `number` is that of the meeting, and `less` says whether the triangle of another is of greater number.
    #[inline(always)]
    pub fn meet<L: Lanes>(
        &mut self,
        lanes: L,
        axes: &Axes,
        corners: [Vec3A; 3],
        crossed: u32,
        number: u32,
        less: impl Fn(u32) -> bool,
    ) -> u32 {
        let [x, y, z] = axes.turned();
        let mut all_met = 0;
        for first in [0, WIDTH] {
            let crossed = crossed >> first & 255;
            if crossed == 0 {
                continue;
            }
            macro_rules! turned {
                ($v:expr) => {
                    lanes.doubles3([
                        lanes.load(half(&$v[x], first)),
                        lanes.load(half(&$v[y], first)),
                        lanes.load(half(&$v[z], first)),
                    ])
                };
            }
            let line = Exact::new(turned!(self.origin), turned!(self.dir), lanes.doubles(lanes.splat(1.0)));
            let [a, b, c] = corners;
            let [a, b, c] = [lanes.splat3(a.into()), lanes.splat3(b.into()), lanes.splat3(c.into())];
            let [t, _] = line.t([lanes.doubles3(a), lanes.doubles3(b), lanes.doubles3(c)]);
            let t = lanes.singles(t);
            let t_last = lanes.load(half(&self.t_last, first));
            // Also NaN is refused.
            let within = crossed & lanes.lt(lanes.load(half(&self.t_min, first)), t);
            let within = within & lanes.lt(t, lanes.load(half(&self.t_max, first)));
            let mut met = within & lanes.lt(t, t_last);
            let mut same = within & lanes.le(t, t_last) & !met;
            while same != 0 {
                let i = same.trailing_zeros() as usize;
                same &= same - 1;
                met |= u32::from(less(self.met[first + i].to_bits())) << i;
            }
            let numbers = lanes.select(met, lanes.splat(f32::from_bits(number)), lanes.load(half(&self.met, first)));
            self.met[first..first + WIDTH].copy_from_slice(&lanes.store(numbers));
            self.t_last[first..first + WIDTH].copy_from_slice(&lanes.store(lanes.select(met, t, t_last)));
            all_met |= met << first;
        }
        all_met
    }

    /// As [`Rays::meet`] for a single ray.
    #[inline(always)]
    pub fn meet_one(
        &mut self,
        axes: &Axes,
        corners: [Vec3A; 3],
        lane: usize,
        number: u32,
        less: impl Fn(u32) -> bool,
    ) -> bool {
        let [x, y, z] = axes.turned();
        let at = |v: &[PerRay; 3]| Vec3A::new(v[x][lane], v[y][lane], v[z][lane]);
        let t = Exact::single(at(&self.origin), at(&self.dir), corners)[0] as f32;
        let within = t > self.t_min[lane] && t < self.t_max[lane];
        let met = within && (t < self.t_last[lane] || t == self.t_last[lane] && less(self.met[lane].to_bits()));
        if met {
            (self.t_last[lane], self.met[lane]) = (t, f32::from_bits(number));
        }
        met
    }

    /// Barycentric coordinates in a triangle for each ray, by coordinate of corners.
    #[inline(always)]
    pub fn uv(&self, axes: &Axes, corners: &[[PerRay; 3]; 3]) -> [PerRay; 2] {
        let [x, y, z] = axes.turned();
        let (x, y, z) = (&self.origin[x], &self.origin[y], &self.origin[z]);
        let mut uv = [ZERO; 2];
        for i in 0..WIDE {
            let flat = |c: &[PerRay; 3]| {
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
        let at = |v: &[PerRay; 3]| Vec3::new(v[0][lane], v[1][lane], v[2][lane]);
        Ray { origin: at(&self.origin), dir: at(&self.dir), t_min: self.t_min[lane], t_max: self.t_max[lane] }
    }
}

/// Eight of the numbers.
#[inline(always)]
fn half(numbers: &PerRay, first: usize) -> &[f32; WIDTH] {
    match numbers[first..].first_chunk() {
        Some(half) => half,
        None => unreachable!("sixteen are twice eight"),
    }
}

/// By how much heights may be off by rounding.
#[inline(always)]
fn slack<W: Wide>(wide: W, height: W::Floats) -> W::Floats {
    let slack = wide.add(wide.mul(wide.splat(8.0 * f32::EPSILON), wide.abs(height)), wide.splat(f32::MIN_POSITIVE));
    // Infinity less infinity is no number.
    wide.min(slack, wide.splat(f32::MAX))
}
