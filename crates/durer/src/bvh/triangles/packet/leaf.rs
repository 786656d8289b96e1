//! A packet among the triangles of a leaf.

use super::{Meeting, Packet};
use crate::bvh::lanes::{Columns, Lanes, Numbers, WIDE, WIDTH, Wide};
use crate::bvh::node;
use crate::bvh::triangles::leaf::Flat;
use crate::bvh::triangles::number;
use crate::shape::watertight::Sheared;

impl Packet<'_> {
    /// Shows the triangles of a leaf to some rays: side by side are either those or these, whichever is less work.
    #[inline(always)]
    pub(super) fn leaf<L: Lanes, const ANY: bool>(&mut self, lanes: L, leaf: u32, rays: u64) {
        let (_, count) = node::items(leaf);
        let mut groups = 0;
        for group in 0..self.groups {
            groups += usize::from(rays >> (group * WIDE) & 0xffff != 0);
        }
        // Found by measurement: where few rays of a group are left, or triangles are many, rays go one by one.
        let met = match 2 * (rays.count_ones() as usize) < groups * (count + 4) {
            true => self.ray_by_ray::<L, ANY>(lanes, leaf, rays),
            false => self.one_by_one::<L, ANY>(lanes, leaf, rays),
        };
        self.met |= met;
        if ANY {
            self.alive &= !met;
        } else if met != 0 {
            for group in 0..self.groups {
                if met >> (group * WIDE) & 0xffff != 0 {
                    self.sixteens[group].bound_last(lanes, &self.axes);
                }
            }
            self.limit = self.last(lanes);
        }
    }

    /// Sixteen rays at once with each triangle; gives the rays that met one.
    #[inline(always)]
    fn one_by_one<L: Lanes, const ANY: bool>(&mut self, lanes: L, leaf: u32, rays: u64) -> u64 {
        let wide = lanes.wide();
        let (rows, count) = self.bvh.rows(leaf);
        let [x, y, z] = self.axes.turned();
        let columns = Columns::new(&self.axes.turn, count);
        let mut all_met = 0;
        // The number of each triangle's meeting, if there is one.
        let mut meetings = [0; WIDTH];
        for group in 0..self.groups {
            let mut active = (rays >> (group * WIDE)) as u32 & 0xffff;
            if active == 0 {
                continue;
            }
            let e = &mut self.sixteens[group];
            let origin = [wide.load(&e.origin[x]), wide.load(&e.origin[y]), wide.load(&e.origin[z])];
            let shear = [wide.load(&e.shear[0]), wide.load(&e.shear[1])];
            for (lane, meeting) in meetings.iter_mut().enumerate().take(count) {
                let [a, b, c] = columns.triangle(rows, lane);
                let triangle = [wide.splat3(a.into()), wide.splat3(b.into()), wide.splat3(c.into())];
                let flat = Flat::new(wide, triangle, origin, shear);
                let missed = flat.missed(wide);
                if !missed & active == 0 {
                    continue;
                }
                let [lowest, highest] = flat.heights(wide);
                let beside = wide.lt(wide.load(&e.heights[1]), lowest) | wide.lt(highest, wide.load(&e.heights[0]));
                let candidates = !(missed | beside) & active;
                if candidates == 0 {
                    continue;
                }
                let mut crossed = candidates & flat.crossed(wide);
                let mut met = 0;
                if ANY {
                    // Where any hit will do, it need not be known where it is.
                    met = crossed
                        & wide.lt(wide.load(&e.heights[2]), lowest)
                        & wide.lt(highest, wide.load(&e.heights[3]));
                    crossed &= !met;
                }
                let mut unsure = candidates & !(crossed | met);
                // Hidden, or the compiler would prepare this for every triangle.
                let corners = std::hint::black_box([a, b, c]);
                while unsure != 0 {
                    let lane = unsure.trailing_zeros();
                    unsure &= unsure - 1;
                    crossed |= u32::from(Sheared::new(&e.ray(lane as usize)).crosses(corners)) << lane;
                }
                if !ANY || crossed != 0 {
                    if *meeting == 0 {
                        *meeting = self.meetings.len() as u32;
                        self.meetings.push(Meeting::new(corners, number(rows, count, lane)));
                    }
                    met |= e.meet(lanes, &self.axes, &self.meetings, *meeting, crossed);
                }
                all_met |= u64::from(met) << (group * WIDE);
                if ANY {
                    active &= !met;
                }
            }
        }
        all_met
    }

    /// All triangles at once with each ray.
    #[inline(always)]
    fn ray_by_ray<L: Lanes, const ANY: bool>(&mut self, lanes: L, leaf: u32, mut rays: u64) -> u64 {
        let (rows, count) = self.bvh.rows(leaf);
        let [x, y, z] = self.axes.turned();
        let columns = Columns::new(&self.axes.turn, count);
        let triangles = lanes.corners(rows, columns);
        let mut all_met = 0;
        while rays != 0 {
            let ray = rays.trailing_zeros() as usize;
            rays &= rays - 1;
            let (e, i) = (&mut self.sixteens[ray / WIDE], ray % WIDE);
            let origin = lanes.splat3([e.origin[x][i], e.origin[y][i], e.origin[z][i]]);
            let shear = [lanes.splat(e.shear[0][i]), lanes.splat(e.shear[1][i])];
            let flat = Flat::new(lanes, triangles, origin, shear);
            let [lowest, highest] = flat.heights(lanes);
            let beside =
                lanes.lt(lanes.splat(e.heights[1][i]), lowest) | lanes.lt(highest, lanes.splat(e.heights[0][i]));
            let mut candidates = !(flat.missed(lanes) | beside) & ((1 << count) - 1);
            if candidates == 0 {
                continue;
            }
            let crossed = flat.crossed(lanes);
            if ANY {
                let inside =
                    lanes.lt(lanes.splat(e.heights[2][i]), lowest) & lanes.lt(highest, lanes.splat(e.heights[3][i]));
                if candidates & crossed & inside != 0 {
                    all_met |= 1 << ray;
                    continue;
                }
            }
            while candidates != 0 {
                let lane = candidates.trailing_zeros() as usize;
                candidates &= candidates - 1;
                let corners = columns.triangle(rows, lane);
                if crossed >> lane & 1 == 0 && !Sheared::new(&e.ray(i)).crosses(corners) {
                    continue;
                }
                let meeting = Meeting::new(corners, number(rows, count, lane));
                if e.meet_one(&self.axes, &self.meetings, &meeting, i) {
                    self.meetings.push(meeting);
                    all_met |= 1 << ray;
                }
            }
        }
        all_met
    }
}
