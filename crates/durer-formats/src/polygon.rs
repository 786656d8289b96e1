//! Splits polygons into triangles.
//!
//! A polygon with n corners becomes n - 2 triangles that have the same winding, without additional
//! vertices. Strictly convex polygons are split into fans. Other polygons are projected onto the
//! coordinate plane where their area is largest, and then split by ear clipping. Sources: Meisters,
//! *Polygons have ears*, 1975; O'Rourke, *Computational Geometry in C*, chapter 1.

use durer_scene::math::Vec3;
use std::collections::VecDeque;

/// Error that the polygons of a file are too large and too irregular to be triangulated in
/// reasonable time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TooComplex;

/// Triangulator for the polygons of one file, which limits the total amount of work. The
/// triangulator reuses its buffers for all polygons.
#[derive(Default)]
pub(super) struct Triangulator {
    /// Number of point-in-triangle tests that may still be made.
    budget: u64,
    /// Projected corners of the polygon in counter-clockwise order.
    points: Vec<[f64; 2]>,
    previous: Vec<u32>,
    next: Vec<u32>,
    /// True for each remaining corner that is not strictly convex. Only these corners can lie
    /// inside an ear.
    blocks: Vec<bool>,
    blockers: Vec<u32>,
    /// Corners that could be ears.
    candidates: VecDeque<u32>,
    waiting: Vec<bool>,
}

impl Triangulator {
    /// Creates a triangulator for a file that has this many bytes. The work limit grows with the
    /// size of the file, but it is low enough for any file to be finished in reasonable time.
    pub fn new(file_bytes: usize) -> Self {
        Triangulator { budget: (1 << 28) + 256 * file_bytes as u64, ..Triangulator::default() }
    }

    /// Triangulates a polygon with `count` corners, and calls `emit` with the three corner indices
    /// of each triangle.
    pub fn triangulate(
        &mut self,
        count: usize,
        corner: impl Fn(usize) -> Vec3,
        mut emit: impl FnMut([usize; 3]),
    ) -> Result<(), TooComplex> {
        match count {
            0..3 => {}
            3 => emit([0, 1, 2]),
            4 => {
                let start = if splits_at_first([corner(0), corner(1), corner(2), corner(3)]) { 0 } else { 1 };
                emit([start, start + 1, start + 2]);
                emit([start, start + 2, (start + 3) % 4]);
            }
            _ => {
                self.project(count, corner);
                if self.is_strictly_convex() {
                    (1..count - 1).for_each(|i| emit([0, i, i + 1]));
                } else {
                    self.cut_ears(&mut emit)?;
                }
            }
        }
        Ok(())
    }

    /// Projects the polygon along the coordinate axis for which its normal has the largest
    /// component, so that the projection has counter-clockwise winding.
    fn project(&mut self, count: usize, corner: impl Fn(usize) -> Vec3) {
        // Newell's normal is the sum of the signed areas over all edges, relative to the first
        // corner.
        let origin = corner(0).as_dvec3();
        let from_origin = |i: usize| corner(i).as_dvec3() - origin;
        let normal = (1..count - 1).fold(glam::DVec3::ZERO, |n, i| n + from_origin(i).cross(from_origin(i + 1)));
        let size = normal.abs();
        let (axis, positive) = match () {
            () if size.x >= size.y && size.x >= size.z => (0, normal.x >= 0.0),
            () if size.y >= size.z => (1, normal.y >= 0.0),
            () => (2, normal.z >= 0.0),
        };
        let (u, v) = if positive { ((axis + 1) % 3, (axis + 2) % 3) } else { ((axis + 2) % 3, (axis + 1) % 3) };
        self.points.clear();
        self.points.extend((0..count).map(|i| [from_origin(i)[u], from_origin(i)[v]]));
    }

    /// Returns true if the outline turns left at all corners and goes around only once.
    fn is_strictly_convex(&self) -> bool {
        let points = &self.points;
        let count = points.len();
        let at = |i: usize| points[i % count];
        // A pentagram also turns left at every corner, but the horizontal direction of its edges
        // changes four times.
        let rightward = |i: usize| at(i + 1)[0] > at(i)[0] || at(i + 1)[0] == at(i)[0] && at(i + 1)[1] > at(i)[1];
        let turns = (0..count).filter(|&i| rightward(i) != rightward(i + 1)).count();
        turns <= 2 && (0..count).all(|i| area(at(i), at(i + 1), at(i + 2)) > 0.0)
    }

    fn cut_ears(&mut self, emit: &mut impl FnMut([usize; 3])) -> Result<(), TooComplex> {
        let count = self.points.len() as u32;
        self.start_ring(count);
        let mut left = count;
        while left > 3 {
            let Some(tip) = self.next_ear(left)? else { continue };
            let (before, after) = (self.previous[tip as usize], self.next[tip as usize]);
            emit([before, tip, after].map(|i| i as usize));
            // Remove the tip of the ear from the ring of corners. Removing the tip affects only its
            // two neighbours.
            self.next[before as usize] = after;
            self.previous[after as usize] = before;
            self.next[tip as usize] = u32::MAX;
            self.blocks[tip as usize] = false;
            left -= 1;
            for neighbour in [before, after] {
                if self.blocks[neighbour as usize] {
                    self.blocks[neighbour as usize] = !self.is_convex(neighbour);
                }
                if !self.waiting[neighbour as usize] {
                    self.waiting[neighbour as usize] = true;
                    self.candidates.push_back(neighbour);
                }
            }
        }
        let last = self.any_left();
        emit([self.previous[last as usize], last, self.next[last as usize]].map(|i| i as usize));
        Ok(())
    }

    fn start_ring(&mut self, count: u32) {
        let refill = |list: &mut Vec<u32>, make: &dyn Fn(u32) -> u32| {
            list.clear();
            list.extend((0..count).map(make));
        };
        refill(&mut self.previous, &|i| (i + count - 1) % count);
        refill(&mut self.next, &|i| (i + 1) % count);
        self.blocks.clear();
        for i in 0..count {
            let convex = self.is_convex(i);
            self.blocks.push(!convex);
        }
        self.blockers.clear();
        self.blockers.extend((0..count).filter(|&i| self.blocks[i as usize]));
        // Start with every other corner, because cutting off neighbouring ears would create
        // slivers.
        self.candidates.clear();
        self.candidates.extend((0..count).step_by(2).chain((1..count).step_by(2)));
        self.waiting.clear();
        self.waiting.resize(count as usize, true);
    }

    /// Returns the next corner to cut off, or `None` if the next candidate is not an ear.
    fn next_ear(&mut self, left: u32) -> Result<Option<u32>, TooComplex> {
        let Some(tip) = self.candidates.pop_front() else {
            // Outlines that intersect themselves can run out of ears; in this case, cut off the
            // least harmful corner.
            self.spend_budget(self.points.len() as u64)?;
            return Ok(Some(self.least_harmful(left)));
        };
        self.waiting[tip as usize] = false;
        let gone = self.next[tip as usize] == u32::MAX;
        Ok((!gone && self.is_ear(tip)?).then_some(tip))
    }

    /// Returns true if a corner is strictly convex and no other corner lies inside its triangle.
    fn is_ear(&mut self, tip: u32) -> Result<bool, TooComplex> {
        let [a, b, c] = self.triangle(tip);
        if area(a, b, c) <= 0.0 {
            return Ok(false);
        }
        let mut i = 0;
        while i < self.blockers.len() {
            self.spend_budget(1)?;
            let blocker = self.blockers[i] as usize;
            if !self.blocks[blocker] {
                self.blockers.swap_remove(i);
                continue;
            }
            let p = self.points[blocker];
            // Outlines with holes visit some points twice, so a point that equals a corner of the
            // triangle does not count as inside.
            let inside = area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0;
            if inside && p != a && p != b && p != c {
                return Ok(false);
            }
            i += 1;
        }
        Ok(true)
    }

    /// Returns a corner whose triangle has zero area, or else a convex corner, or else any corner.
    fn least_harmful(&self, left: u32) -> u32 {
        let first = self.any_left();
        let ring = || std::iter::successors(Some(first), |&i| Some(self.next[i as usize])).take(left as usize);
        let area_at = |i: u32| {
            let [a, b, c] = self.triangle(i);
            area(a, b, c)
        };
        ring().find(|&i| area_at(i) == 0.0).or_else(|| ring().find(|&i| area_at(i) > 0.0)).unwrap_or(first)
    }

    fn any_left(&self) -> u32 {
        self.next.iter().position(|&next| next != u32::MAX).unwrap_or(0) as u32
    }

    fn triangle(&self, tip: u32) -> [[f64; 2]; 3] {
        let tip = tip as usize;
        [self.previous[tip] as usize, tip, self.next[tip] as usize].map(|i| self.points[i])
    }

    fn is_convex(&self, tip: u32) -> bool {
        let [a, b, c] = self.triangle(tip);
        area(a, b, c) > 0.0
    }

    fn spend_budget(&mut self, work: u64) -> Result<(), TooComplex> {
        self.budget = self.budget.checked_sub(work).ok_or(TooComplex)?;
        Ok(())
    }
}

/// Returns true if a quadrilateral should be split along the diagonal that starts at its first
/// corner. This diagonal is used unless only the other one lies inside the quadrilateral.
fn splits_at_first(corners: [Vec3; 4]) -> bool {
    let [a, b, c, d] = corners.map(|p| p.as_dvec3());
    let normal = (c - a).cross(d - b);
    let turns_left = |p: glam::DVec3, q: glam::DVec3, r: glam::DVec3| (q - p).cross(r - q).dot(normal) > 0.0;
    let first = turns_left(a, b, c) && turns_left(c, d, a);
    let second = turns_left(b, c, d) && turns_left(d, a, b);
    first || !second
}

/// Returns twice the signed area of a triangle, which is positive if its winding is
/// counter-clockwise.
fn area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
#[path = "polygon_tests.rs"]
mod tests;
