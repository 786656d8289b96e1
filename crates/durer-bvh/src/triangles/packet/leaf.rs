//! Tests the rays of a packet against the triangles of a leaf.

use super::bundle::{Packet, RAYS};
use super::shared::HitTriangle;
use crate::lanes::{CornerColumns, FloatLanes, Lanes, WIDE, WIDTH, WideLanes};
use crate::node;
use crate::triangles::leaf::{ProjectedTriangles, by_corner, ends, from_origin};
use crate::triangles::number;
use std::mem::MaybeUninit;

/// Corners of the triangles of a leaf, with the axes permuted, from which single triangles are
/// broadcast to all lanes.
struct Corners([[[f32; WIDTH]; 3]; 3]);

impl Corners {
    #[inline(always)]
    fn new<L: Lanes>(lanes: L, corners: [[L::Floats; 3]; 3]) -> Self {
        macro_rules! stored {
            ($corner:literal, $axis:literal) => {
                lanes.store(corners[$corner][$axis])
            };
        }
        Corners(by_corner!(stored))
    }

    /// Broadcasts the corners of one triangle to all lanes.
    #[inline(always)]
    fn triangle<N: FloatLanes>(&self, numbers: N, lane: usize) -> [[N::Floats; 3]; 3] {
        macro_rules! one {
            ($corner:literal, $axis:literal) => {
                numbers.splat(self.0[$corner][$axis][lane])
            };
        }
        by_corner!(one)
    }
}

/// Projects triangles along rays. If `POINT` is true, the corners are relative to the common
/// origin.
#[inline(always)]
fn flat<N: FloatLanes, const POINT: bool>(
    numbers: N,
    triangles: [[N::Floats; 3]; 3],
    origin: [N::Floats; 3],
    shear: [N::Floats; 2],
) -> ProjectedTriangles<N> {
    match POINT {
        true => ProjectedTriangles::new_relative(numbers, triangles, shear),
        false => ProjectedTriangles::new(numbers, triangles, origin, shear),
    }
}

impl Packet<'_> {
    /// Returns the corners relative to the common origin of the rays.
    #[inline(always)]
    fn relative_corners<L: Lanes>(&self, lanes: L, corners: [[L::Floats; 3]; 3]) -> [[L::Floats; 3]; 3] {
        let [x, y, z] = self.axes.turned();
        let [e, ..] = &self.sixteens;
        from_origin(lanes, corners, lanes.splat3([e.origin[x][0], e.origin[y][0], e.origin[z][0]]))
    }

    /// Tests the triangles of a leaf against some of the rays. The lanes hold either triangles or
    /// rays, whichever takes less work.
    #[inline(always)]
    pub(super) fn leaf<L: Lanes, const ANY: bool>(&mut self, lanes: L, leaf: u32, rays: u64) {
        let (_, count) = node::items(leaf);
        let mut groups = 0;
        for group in 0..self.groups {
            groups += usize::from(rays >> (group * WIDE) & 0xffff != 0);
        }
        // If few rays are left in the groups, or if there are many triangles, test ray by ray. The
        // condition was tuned by measurement.
        let hits = match 2 * (rays.count_ones() as usize) < groups * (count + 4) {
            true if self.has_common_origin => self.ray_by_ray::<L, ANY, true>(lanes, leaf, rays),
            true => self.ray_by_ray::<L, ANY, false>(lanes, leaf, rays),
            false if self.has_common_origin => self.one_by_one::<L, ANY, true>(lanes, leaf, rays),
            false => self.one_by_one::<L, ANY, false>(lanes, leaf, rays),
        };
        self.hit_mask |= hits;
        if ANY {
            self.alive &= !hits;
        } else if hits != 0 {
            for group in 0..self.groups {
                if hits >> (group * WIDE) & 0xffff != 0 {
                    self.sixteens[group].bound_last(lanes, &self.axes);
                }
            }
            self.limit = self.last(lanes);
        }
    }

    /// Tests each triangle against sixteen rays at once. Returns a mask of the rays that hit a
    /// triangle. If `POINT` is true, corners relative to the common origin are computed only once.
    #[inline(always)]
    fn one_by_one<L: Lanes, const ANY: bool, const POINT: bool>(&mut self, lanes: L, leaf: u32, rays: u64) -> u64 {
        let wide = lanes.wide();
        let mut room = MaybeUninit::uninit();
        let (rows, count) = self.bvh.rows(leaf, &mut room);
        let [x, y, z] = self.axes.turned();
        let columns = CornerColumns::new(&self.axes.turn, count);
        let triangles = lanes.corners(rows, columns);
        let triangles = Corners::new(lanes, if POINT { self.relative_corners(lanes, triangles) } else { triangles });
        let mut all_hit = 0;
        // Index of each triangle in the list of hits, or 0.
        let mut packet_hits = [0; WIDTH];
        for group in 0..self.groups {
            let mut active = (rays >> (group * WIDE)) as u32 & 0xffff;
            if active == 0 {
                continue;
            }
            let e = &mut self.sixteens[group];
            let origin = [wide.load(&e.origin[x]), wide.load(&e.origin[y]), wide.load(&e.origin[z])];
            let shear = [wide.load(&e.shear[0]), wide.load(&e.shear[1])];
            // Run all tests first, so that none of them waits for the result of another.
            let (mut masks, mut some) = ([[0; 2]; WIDTH], 0);
            for (lane, masks) in masks.iter_mut().enumerate().take(count) {
                let flat = flat::<_, POINT>(wide, triangles.triangle(wide, lane), origin, shear);
                let candidates = !flat.missed(wide) & active;
                *masks = [candidates, flat.crossed(wide)];
                some |= u32::from(candidates != 0) << lane;
            }
            while some != 0 {
                let lane = some.trailing_zeros() as usize & (WIDTH - 1);
                some &= some - 1;
                let [candidates, crossed] = masks[lane];
                if candidates & active == 0 {
                    continue;
                }
                let corners = columns.triangle(rows, lane);
                let [a, b, c] = corners;
                let z = wide.splat3([a.z, b.z, c.z]);
                let z = [wide.sub(z[0], origin[2]), wide.sub(z[1], origin[2]), wide.sub(z[2], origin[2])];
                let [lowest, highest] = ends(wide, z);
                let beside = wide.lt(wide.load(&e.heights[1]), lowest) | wide.lt(highest, wide.load(&e.heights[0]));
                let candidates = candidates & active & !beside;
                let mut crossed = candidates & crossed;
                let mut hits = 0;
                if ANY {
                    // Any-hit rays do not need the exact distance.
                    hits = crossed
                        & wide.lt(wide.load(&e.heights[2]), lowest)
                        & wide.lt(highest, wide.load(&e.heights[3]));
                    crossed &= !hits;
                }
                let unsure = candidates & !(crossed | hits);
                if unsure != 0 {
                    crossed |= e.crossing(unsure, corners);
                }
                if crossed != 0 {
                    let meeting = &mut packet_hits[lane];
                    if *meeting == 0 {
                        *meeting = self.packet_hits.len() as u32;
                        self.packet_hits.push(HitTriangle::new(corners, number(rows, count, lane)));
                    }
                    hits |= e.intersect_node(lanes, &self.axes, self.packet_hits, *meeting, crossed);
                }
                all_hit |= u64::from(hits) << (group * WIDE);
                if ANY {
                    active &= !hits;
                }
            }
        }
        all_hit
    }

    /// Tests each ray against all triangles at once. Returns a mask of the rays that hit a
    /// triangle.
    #[inline(always)]
    fn ray_by_ray<L: Lanes, const ANY: bool, const POINT: bool>(&mut self, lanes: L, leaf: u32, rays: u64) -> u64 {
        let mut room = MaybeUninit::uninit();
        let (rows, count) = self.bvh.rows(leaf, &mut room);
        let [x, y, z] = self.axes.turned();
        let columns = CornerColumns::new(&self.axes.turn, count);
        let triangles = lanes.corners(rows, columns);
        let triangles = if POINT { self.relative_corners(lanes, triangles) } else { triangles };
        let (mut all_hit, mut some) = (0, 0);
        let mut masks = [[0u8; 2]; RAYS];
        let mut left = rays;
        while left != 0 {
            let ray = left.trailing_zeros() as usize & (RAYS - 1);
            left &= left - 1;
            let (e, i) = (&self.sixteens[ray / WIDE], ray % WIDE);
            let origin = lanes.splat3([e.origin[x][i], e.origin[y][i], e.origin[z][i]]);
            let shear = [lanes.splat(e.shear[0][i]), lanes.splat(e.shear[1][i])];
            let flat = flat::<_, POINT>(lanes, triangles, origin, shear);
            let [lowest, highest] = flat.heights(lanes);
            let beside =
                lanes.lt(lanes.splat(e.heights[1][i]), lowest) | lanes.lt(highest, lanes.splat(e.heights[0][i]));
            let candidates = !(flat.missed(lanes) | beside) & ((1 << count) - 1);
            let crossed = flat.crossed(lanes);
            masks[ray] = [candidates as u8, crossed as u8];
            some |= u64::from(candidates != 0) << ray;
            if ANY {
                let inside =
                    lanes.lt(lanes.splat(e.heights[2][i]), lowest) & lanes.lt(highest, lanes.splat(e.heights[3][i]));
                all_hit |= u64::from(candidates & crossed & inside != 0) << ray;
            }
        }
        some &= !all_hit;
        while some != 0 {
            let ray = some.trailing_zeros() as usize & (RAYS - 1);
            some &= some - 1;
            let (e, i) = (&mut self.sixteens[ray / WIDE], ray % WIDE);
            let [mut candidates, crossed] = masks[ray].map(u32::from);
            while candidates != 0 {
                let lane = candidates.trailing_zeros() as usize;
                candidates &= candidates - 1;
                let corners = columns.triangle(rows, lane);
                if crossed >> lane & 1 == 0 && e.crossing(1 << i, corners) == 0 {
                    continue;
                }
                let meeting = HitTriangle::new(corners, number(rows, count, lane));
                if e.intersect_one(&self.axes, self.packet_hits, &meeting, i) {
                    self.packet_hits.push(meeting);
                    all_hit |= 1 << ray;
                }
            }
        }
        all_hit
    }
}
