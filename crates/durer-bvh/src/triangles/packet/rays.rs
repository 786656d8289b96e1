//! The rays of a packet in groups of sixteen, with one ray per lane.

use super::shared::{HitTriangle, PacketAxes};
use crate::lanes::{FloatLanes, Lanes, WIDE, WIDTH, WideLanes};
use crate::math::{Doubles, Ray, Vec3};
use crate::traverse::{FAST_RANGE, MIN_MAIN_COMPONENT, PADDING};
use crate::triangles::leaf::{from_origin, project};
use crate::watertight::{Plane, PreciseLine, WatertightRay, uv_across};
use glam::Vec3A;

/// A value for each of sixteen rays of a packet.
pub type PerRay = [f32; WIDE];

/// Sixteen rays of a packet, one per lane, with the same octant and longest axis. They are prepared
/// for box tests as in [`TraversalRay`](crate::traverse::TraversalRay), with slightly less padding,
/// and for triangle tests as in [`WatertightRay`](crate::watertight::WatertightRay).
#[derive(Clone, Copy, Default)]
#[repr(align(64))]
pub struct PacketRays {
    pub origin: [PerRay; 3],
    pub dir: [PerRay; 3],
    pub inverse: [PerRay; 3],
    /// Origins moved outwards by the padding of the boxes.
    pub near_from: [PerRay; 3],
    pub far_from: [PerRay; 3],
    /// Padded origins multiplied by the negated inverse of the direction.
    pub near_origin: [PerRay; 3],
    pub far_origin: [PerRay; 3],
    pub shear: [PerRay; 2],
    /// 1 divided by the component of the direction along the longest axis.
    inverse_z: [[f64; WIDTH]; 2],
    pub t_min: PerRay,
    pub t_max: PerRay,
    /// `t` of the closest hit so far, or `t_max` before the first hit.
    pub t_last: PerRay,
    /// Heights below the first bound or above the second are certainly outside the interval.
    /// Heights above the third bound and below the fourth are certainly inside.
    pub heights: [PerRay; 4],
    /// Indices of the hit triangles in the packet's list, as bit patterns. The index 0 means no
    /// hit. For any-hit rays, the indices are meaningless.
    packet_hits: PerRay,
}

impl PacketRays {
    /// Sets eight of the rays, starting at `first`. Each row holds the origin, direction, and
    /// interval of a ray.
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

    /// Returns masks of the rays with negative directions along x, y, and z, and masks of the rays
    /// whose first or second component is the longest.
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

    /// Prepares the rays for a tree whose coordinates are at most `most`. Returns a mask of the
    /// fast rays.
    #[inline(always)]
    pub fn prepare<L: Lanes>(&mut self, lanes: L, axes: &PacketAxes, most: f32) -> u32 {
        let wide = lanes.wide();
        let (least, greatest) = (wide.splat(FAST_RANGE.start), wide.splat(FAST_RANGE.end));
        let (mut far, mut above, mut long) = (wide.splat(0.0), u32::MAX, 0);
        let mut fast = wide.lt(wide.load(&self.t_min), wide.load(&self.t_last));
        for axis in 0..3 {
            let (o, length) = (wide.abs(wide.load(&self.origin[axis])), wide.abs(wide.load(&self.dir[axis])));
            fast &= wide.lt(o, greatest) & wide.lt(length, greatest);
            above &= wide.lt(least, length);
            long |= wide.le(wide.splat(MIN_MAIN_COMPONENT), length);
            far = wide.max(far, o);
        }
        fast &= above | long;
        let reach = wide.add(far, wide.splat(most));
        fast &= wide.lt(least, reach) & wide.lt(reach, greatest);
        let pad = wide.mul(wide.splat(PADDING), reach);
        for axis in 0..3 {
            let (o, length) = (wide.load(&self.origin[axis]), wide.abs(wide.load(&self.dir[axis])));
            let sign = wide.splat(if axes.negative[axis] == 1 { -1.0 } else { 1.0 });
            let outward = wide.mul(pad, sign);
            let (near, far) = (wide.add(o, outward), wide.sub(o, outward));
            let inverse = wide.div(sign, wide.max(length, least));
            let zero = wide.splat(0.0);
            self.inverse[axis] = wide.store(inverse);
            self.near_from[axis] = wide.store(near);
            self.far_from[axis] = wide.store(far);
            self.near_origin[axis] = wide.store(wide.mul(wide.sub(zero, near), inverse));
            self.far_origin[axis] = wide.store(wide.mul(wide.sub(zero, far), inverse));
        }
        let [x, y, z] = axes.turned();
        let dz = wide.load(&self.dir[z]);
        self.shear =
            [wide.store(wide.div(wide.load(&self.dir[x]), dz)), wide.store(wide.div(wide.load(&self.dir[y]), dz))];
        for (half, inverse) in self.inverse_z.iter_mut().enumerate() {
            let dz = lanes.doubles(lanes.load(part(&self.dir[z], half)));
            *inverse = lanes.store_doubles(lanes.splat_double(1.0).div(dz));
        }
        self.t_max = self.t_last;
        self.packet_hits = PerRay::default();
        self.bound(lanes, axes);
        fast
    }

    /// Sets the bounds of heights.
    #[inline(always)]
    fn bound<L: Lanes>(&mut self, lanes: L, axes: &PacketAxes) {
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

    /// Updates the outer bound of heights that depends on `t_last`.
    #[inline(always)]
    pub fn bound_last<L: Lanes>(&mut self, lanes: L, axes: &PacketAxes) {
        let wide = lanes.wide();
        let far = wide.mul(wide.load(&self.t_last), wide.load(&self.dir[axes.turned()[2]]));
        match axes.is_down() {
            true => self.heights[0] = wide.store(wide.sub(far, slack(wide, far))),
            false => self.heights[1] = wide.store(wide.add(far, slack(wide, far))),
        }
    }

    /// Records triangle `number` of the packet's list as the closest hit of some rays. These are
    /// the rays in the mask `crossed` that hit it within their interval and before any other
    /// triangle. Returns a mask of these rays.
    #[inline(always)]
    pub fn intersect_node<L: Lanes>(
        &mut self,
        lanes: L,
        axes: &PacketAxes,
        packet_hits: &[HitTriangle],
        number: u32,
        crossed: u32,
    ) -> u32 {
        let [x, y, z] = axes.turned();
        let splat3 = |v: [f64; 3]| [lanes.splat_double(v[0]), lanes.splat_double(v[1]), lanes.splat_double(v[2])];
        let HitTriangle { plane, triangle, .. } = &packet_hits[number as usize];
        let [low, high] = plane.heights;
        let plane = Plane {
            normal: splat3(plane.normal),
            corner: splat3(plane.corner),
            heights: [lanes.splat_double(low), lanes.splat_double(high)],
        };
        let wide = lanes.wide();
        let mut halves = [lanes.splat(0.0); 2];
        for half in [0, 1] {
            if crossed >> (WIDTH * half) & 255 == 0 {
                continue;
            }
            macro_rules! turned {
                ($v:expr) => {
                    lanes.doubles3([
                        lanes.load(part(&$v[x], half)),
                        lanes.load(part(&$v[y], half)),
                        lanes.load(part(&$v[z], half)),
                    ])
                };
            }
            let inverse = lanes.load_doubles(&self.inverse_z[half]);
            let line = PreciseLine::with_inverse(turned!(self.origin), turned!(self.dir), inverse);
            halves[half] = lanes.singles(line.t(&plane)[0]);
        }
        let (t, t_last) = (lanes.join(halves), wide.load(&self.t_last));
        // The comparison also rejects NaN.
        let within = crossed & wide.lt(wide.load(&self.t_min), t) & wide.lt(t, wide.load(&self.t_max));
        let mut hits = within & wide.lt(t, t_last);
        let mut same = within & wide.le(t, t_last) & !hits;
        while same != 0 {
            let i = same.trailing_zeros();
            same &= same - 1;
            hits |= u32::from(*triangle < packet_hits[self.packet_hits[i as usize].to_bits() as usize].triangle) << i;
        }
        self.packet_hits =
            wide.store(wide.select(hits, wide.splat(f32::from_bits(number)), wide.load(&self.packet_hits)));
        self.t_last = wide.store(wide.select(hits, t, t_last));
        hits
    }

    /// Tests a single ray as [`PacketRays::intersect_node`] does. The triangle is appended to the
    /// list if the ray hits it.
    #[inline(always)]
    pub fn intersect_one(
        &mut self,
        axes: &PacketAxes,
        packet_hits: &[HitTriangle],
        next: &HitTriangle,
        lane: usize,
    ) -> bool {
        let [x, y, z] = axes.turned();
        let at = |v: &[PerRay; 3]| [v[x][lane], v[y][lane], v[z][lane]].map(f64::from);
        let inverse = self.inverse_z[lane / WIDTH][lane % WIDTH];
        let t = PreciseLine::with_inverse(at(&self.origin), at(&self.dir), inverse).t(&next.plane)[0] as f32;
        let (t_last, last) = (self.t_last[lane], &packet_hits[self.packet_hits[lane].to_bits() as usize]);
        let within = t > self.t_min[lane] && t < self.t_max[lane];
        let hits = within && (t < t_last || t == t_last && next.triangle < last.triangle);
        if hits {
            (self.t_last[lane], self.packet_hits[lane]) = (t, f32::from_bits(packet_hits.len() as u32));
        }
        hits
    }

    /// Returns the barycentric coordinates of the hits for half of the rays.
    #[inline(always)]
    pub fn uv<L: Lanes>(
        &self,
        lanes: L,
        axes: &PacketAxes,
        half: usize,
        corners: [[L::Floats; 3]; 3],
    ) -> [[f32; WIDTH]; 2] {
        macro_rules! half {
            ($v:expr) => {
                lanes.load(part(&$v, half))
            };
        }
        let [x, y, z] = axes.turned();
        let origin = [half!(self.origin[x]), half!(self.origin[y]), half!(self.origin[z])];
        let shear = [half!(self.shear[0]), half!(self.shear[1])];
        let corners = from_origin(lanes, corners, origin);
        macro_rules! flat {
            ($corner:literal) => {{
                let [x, y, _] = project(lanes, corners[$corner], shear);
                [lanes.doubles(x), lanes.doubles(y)]
            }};
        }
        let [u, v] = uv_across([flat!(0), flat!(1), flat!(2)]);
        [lanes.store(lanes.singles(u)), lanes.store(lanes.singles(v))]
    }

    /// Returns the indices of the triangles that half of the rays have hit, as bit patterns.
    #[inline(always)]
    pub fn packet_hits(&self, half: usize) -> &[f32; WIDTH] {
        part(&self.packet_hits, half)
    }

    /// Returns a mask of the rays that cross a triangle with permuted axes, according to the exact
    /// test.
    #[cold]
    #[inline(never)]
    pub fn crossing(&self, mut rays: u32, corners: [Vec3A; 3]) -> u32 {
        let mut crossing = 0;
        while rays != 0 {
            let ray = rays.trailing_zeros();
            rays &= rays - 1;
            crossing |= u32::from(WatertightRay::new(&self.ray(ray as usize)).crosses(corners)) << ray;
        }
        crossing
    }

    /// Extracts one ray.
    pub fn ray(&self, lane: usize) -> Ray {
        let at = |v: &[PerRay; 3]| Vec3::new(v[0][lane], v[1][lane], v[2][lane]);
        Ray { origin: at(&self.origin), dir: at(&self.dir), t_min: self.t_min[lane], t_max: self.t_max[lane] }
    }
}

/// Returns the first or second half of the values.
#[inline(always)]
fn part(numbers: &PerRay, half: usize) -> &[f32; WIDTH] {
    match numbers[WIDTH * half..].first_chunk() {
        Some(half) => half,
        None => unreachable!("sixteen are twice eight"),
    }
}

/// Returns an upper bound on the rounding error of heights.
#[inline(always)]
fn slack<W: WideLanes>(wide: W, height: W::Floats) -> W::Floats {
    let slack = wide.add(wide.mul(wide.splat(8.0 * f32::EPSILON), wide.abs(height)), wide.splat(f32::MIN_POSITIVE));
    // Infinity minus infinity would be NaN.
    wide.min(slack, wide.splat(f32::MAX))
}
