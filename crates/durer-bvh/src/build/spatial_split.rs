//! Spatial splits: planes that divide the space of a node. A triangle can end up in both children,
//! each with part of its box.
//!
//! If the two boxes of the cheapest object split overlap, split planes are also tried. A plane
//! splits the triangles that it intersects, except those that are cheaper to keep whole on one
//! side. Source: Stich, Friedrich, Dietrich, *Spatial Splits in Bounding Volume Hierarchies*, HPG
//! 2009.

use super::builder::{Bin, Builder, half_area};
use super::object_split::ObjectSplit;
use super::reference::Reference;
use super::settings::BINS;
use crate::math::Vec3;
use glam::{BVec4A, Vec4};

/// Minimum overlap of the two boxes for which planes are tried, as a fraction of the node's area.
const MIN_OVERLAP: f32 = 0.226;
/// Minimum overlap of the two boxes for which planes are tried, as a fraction of the root's area.
const MIN_ROOT_OVERLAP: f32 = 1e-5;
/// Minimum extent of the node along the normal of a plane, as a fraction of the node's longest
/// extent.
const MIN_EXTENT: f32 = 0.3;
/// Maximum cost of a plane, as a fraction of the cost of the best partition.
const MAX_RELATIVE_COST: f32 = 0.95;
/// Maximum number of references for which splits cost more than they save.
pub const MIN_REFERENCES: usize = 330;
/// Number of failed searches on the path from the root after which levels are skipped: at first one
/// level, then two, up to four.
const MAX_FAILURES: u32 = 3;

/// Counters of the failed searches for split planes above a node. They decide when the build skips
/// levels.
#[derive(Clone, Copy, Default)]
pub struct SearchHistory {
    failures: u32,
    pause: u32,
}

/// A candidate plane for a spatial split. Its cost is the sum, over both sides, of the area times
/// the number of references.
struct SplitPlane {
    cost: f32,
    axis: usize,
    at: f32,
}

impl Builder<'_> {
    /// Returns the references on both sides of the best plane if that plane is better than `cut`
    /// and adds at most `spare` references.
    pub fn spatial_split(
        &self,
        references: &[Reference],
        spare: usize,
        all: &Bin,
        cut: &ObjectSplit,
        searches: &mut SearchHistory,
    ) -> Option<[Vec<Reference>; 2]> {
        let count = references.len();
        if count <= MIN_REFERENCES || spare == 0 {
            return None;
        }
        let [l, r] = cut.sides;
        let overlap = half_area(l.min.max(r.min), l.max.min(r.max), self.scale);
        let area = half_area(all.min, all.max, self.scale);
        if overlap < (MIN_OVERLAP * area).max(MIN_ROOT_OVERLAP * self.area) {
            return None;
        }
        if searches.pause > 0 {
            searches.pause -= 1;
            return None;
        }
        let plane = self.plane(references, all)?;
        if plane.cost >= MAX_RELATIVE_COST * cut.cost {
            searches.failures += 1;
            searches.pause = searches.failures.saturating_sub(MAX_FAILURES).min(4);
            return None;
        }
        searches.failures = 0;
        let parts = self.halves(references, &plane);
        let lens = [parts[0].len(), parts[1].len()];
        (lens.iter().all(|&len| 0 < len && len < count) && lens[0] + lens[1] <= count + spare).then_some(parts)
    }

    /// Finds the cheapest plane among the borders between bins of equal width.
    fn plane(&self, references: &[Reference], bounds: &Bin) -> Option<SplitPlane> {
        if !(bounds.max - bounds.min).truncate().is_finite() {
            return None;
        }
        let planes = [
            self.plane_across::<0>(references, bounds),
            self.plane_across::<1>(references, bounds),
            self.plane_across::<2>(references, bounds),
        ];
        planes.into_iter().flatten().reduce(|a, b| if b.cost < a.cost { b } else { a })
    }

    fn plane_across<const AXIS: usize>(&self, references: &[Reference], bounds: &Bin) -> Option<SplitPlane> {
        // A small number of references needs only a few bins.
        let count = if references.len() > 256 { BINS } else { BINS / 2 };
        let (low, high) = (bounds.min[AXIS], bounds.max[AXIS]);
        if high - low < MIN_EXTENT * (bounds.max - bounds.min).truncate().max_element() {
            return None;
        }
        let width = (high - low) / count as f32;
        // Flat nodes and extremely large nodes are not split.
        if !(width.is_normal() && low + width > low && high - width < high) {
            return None;
        }
        let at = |bin: usize| low + width * bin as f32;
        let scale = 1.0 / width;
        let bin_of = |x: f32| (((x - low) * scale) as i32).clamp(0, count as i32 - 1) as usize;
        let mut bins = [Bin::EMPTY; BINS];
        let mut ends = [0_u32; BINS];
        for r in references {
            let (first, last) = (bin_of(r.min[AXIS]), bin_of(r.max[AXIS]));
            bins[first].count += 1;
            ends[last] += 1;
            if first == last {
                bins[first] = bins[first].around(r);
                continue;
            }
            let triangle = SortedTriangle::<AXIS>::new(self.corners[r.number() as usize]);
            let mut from = triangle.section(r.min[AXIS]);
            for (bin, number) in bins[first..=last].iter_mut().zip(first..) {
                let to = triangle.section(if number < last { at(number + 1) } else { r.max[AXIS] });
                *bin = bin.around(&triangle.between(&from, &to, r));
                from = to;
            }
        }
        let mut best = None::<SplitPlane>;
        let mut right = [(0.0, 0_u32); BINS];
        let mut sum = Bin::EMPTY;
        for bin in (1..count).rev() {
            sum = sum.union(Bin { count: ends[bin], ..bins[bin] });
            right[bin] = (sum.cost(self.scale), sum.count);
        }
        let mut left = Bin::EMPTY;
        for bin in 1..count {
            left = left.union(bins[bin - 1]);
            let (right_cost, right_count) = right[bin];
            let cost = left.cost(self.scale) + right_cost;
            if left.count > 0 && right_count > 0 && best.as_ref().is_none_or(|best| cost < best.cost) {
                best = Some(SplitPlane { cost, axis: AXIS, at: at(bin) });
            }
        }
        best
    }

    /// References on both sides of a plane. References that intersect the plane are split, unless
    /// it costs less to enlarge the box of one side.
    fn halves(&self, references: &[Reference], &SplitPlane { axis, at, .. }: &SplitPlane) -> [Vec<Reference>; 2] {
        let (mut left, mut right, mut through) = (Vec::new(), Vec::new(), Vec::new());
        for r in references {
            if r.max[axis] <= at {
                left.push(*r);
                continue;
            } else if r.min[axis] >= at {
                right.push(*r);
                continue;
            }
            let corners = self.corners[r.number() as usize];
            let [a, b] = match axis {
                0 => SortedTriangle::<0>::new(corners).halves(at, r),
                1 => SortedTriangle::<1>::new(corners).halves(at, r),
                _ => SortedTriangle::<2>::new(corners).halves(at, r),
            };
            match [a, b].map(|half| half.bounds().is_empty()) {
                [false, false] => through.push((*r, [a, b])),
                [false, true] => left.push(a),
                [true, false] => right.push(b),
                [true, true] => left.push(*r),
            }
        }
        let mut sides = [&left, &right].map(|side| Bin::of(side));
        for (_, halves) in &through {
            sides.iter_mut().zip(halves).for_each(|(side, half)| *side = side.with(half));
        }
        let scale = self.scale;
        let cost = |[l, r]: &[Bin; 2]| l.cost(scale) + r.cost(scale);
        for (whole, [a, b]) in through {
            let [l, r] = sides;
            // Both sides already include the two halves of this reference.
            let all_left = [l.around(&whole), Bin { count: r.count - 1, ..r }];
            let all_right = [Bin { count: l.count - 1, ..l }, r.around(&whole)];
            if cost(&sides) < cost(&all_left).min(cost(&all_right)) {
                left.push(a);
                right.push(b);
            } else if cost(&all_left) <= cost(&all_right) {
                sides = all_left;
                left.push(whole);
            } else {
                sides = all_right;
                right.push(whole);
            }
        }
        [left, right]
    }
}

/// A triangle with its corners sorted along an axis, prepared for cutting by split planes.
struct SortedTriangle<const AXIS: usize> {
    corners: [Vec4; 3],
    /// Upper bound on the rounding error of a computed section.
    slack: Vec4,
}

/// Returns the bounding box of the line segment in which a split plane cuts a triangle.
struct Section {
    at: f32,
    min: Vec4,
    max: Vec4,
}

impl<const AXIS: usize> SortedTriangle<AXIS> {
    #[inline(always)]
    fn new(corners: [Vec3; 3]) -> Self {
        let [a, b, c] = corners.map(|p| p.extend(0.0));
        let sort = |p: Vec4, q: Vec4| if p[AXIS] > q[AXIS] { (q, p) } else { (p, q) };
        let (a, b) = sort(a, b);
        let (b, c) = sort(b, c);
        let (a, b) = sort(a, b);
        let most = a.abs().max(b.abs()).max(c.abs());
        // A section is p + (q - p) t with t = (x - p) / (q - p) along the axis. Its error is at
        // most 5 units in the last place of q - p, plus one unit of the sum. The difference q - p
        // is at most twice the largest coordinate, and a unit is half of epsilon. The remaining
        // term covers underflow.
        SortedTriangle { corners: [a, b, c], slack: 8.0 * f32::EPSILON * most + f32::MIN_POSITIVE }
    }

    /// Returns the section at a coordinate along the axis. Outside the triangle, the section is the
    /// first or last corner.
    #[inline(always)]
    fn section(&self, at: f32) -> Section {
        let [a, b, c] = self.corners;
        let point = |p: Vec4, q: Vec4| p + (q - p) * ((at - p[AXIS]) / (q[AXIS] - p[AXIS]));
        let (p, q) = match () {
            () if at <= a[AXIS] => return Section { at, min: a, max: a },
            () if at >= c[AXIS] => return Section { at, min: c, max: c },
            () if at < b[AXIS] => (point(a, c), point(a, b)),
            () if at > b[AXIS] => (point(a, c), point(b, c)),
            () => (point(a, c), b),
        };
        Section { at, min: p.min(q) - self.slack, max: p.max(q) + self.slack }
    }

    /// Returns the bounding box of the part of a reference between two sections. The box is empty
    /// if there is no such part.
    #[inline(always)]
    fn between(&self, from: &Section, to: &Section, r: &Reference) -> Reference {
        let middle = self.corners[1];
        let (mut min, mut max) = (from.min.min(to.min), from.max.max(to.max));
        if from.at <= middle[AXIS] && middle[AXIS] <= to.at {
            (min, max) = (min.min(middle), max.max(middle));
        }
        let across = BVec4A::new(AXIS == 0, AXIS == 1, AXIS == 2, false);
        let low = Vec4::select(across, Vec4::splat(from.at), r.min);
        let high = Vec4::select(across, Vec4::splat(to.at), r.max);
        // The fourth lane, which holds the number of the primitive, does not change: it is larger
        // than any slack.
        Reference { min: min.max(low), max: max.min(high) }
    }

    /// Returns the parts of a reference on both sides of a plane.
    fn halves(&self, at: f32, r: &Reference) -> [Reference; 2] {
        let [from, middle, to] = [r.min[AXIS], at, r.max[AXIS]].map(|x| self.section(x));
        [self.between(&from, &middle, r), self.between(&middle, &to, r)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Aabb;
    use crate::math::random::{Random, rounds};

    /// Checks that random points of a triangle lie in the box of the half on their side of the
    /// plane, for any triangle and any reference box.
    fn check<const AXIS: usize>(random: &mut Random, corners: [Vec3; 3], within: Aabb) -> usize {
        let r = Reference::new(within, 7);
        let (low, high) = (within.min[AXIS], within.max[AXIS]);
        let at = low + random.unit() * (high - low);
        if !(low < at && at < high) {
            return 0;
        }
        let halves = SortedTriangle::<AXIS>::new(corners).halves(at, &r);
        let mut inside = 0;
        for _ in 0..50 {
            let [u, v] = [random.unit(), random.unit()].map(f64::from);
            let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
            let [a, b, c] = corners.map(|p| p.as_dvec3());
            let p = a * (1.0 - u - v) + b * u + c * v;
            // This is the rounding error of the point itself. The error of a section is far
            // greater.
            let slack = 1e-14 * (a.abs().max(b.abs()).max(c.abs())).max_element();
            let is_in =
                |b: Aabb, slack: f64| (p.cmpge(b.min.as_dvec3() - slack) & p.cmple(b.max.as_dvec3() + slack)).all();
            if is_in(within, -slack) {
                inside += 1;
                let half = halves[usize::from(p[AXIS] > f64::from(at))];
                assert_eq!(half.number(), 7);
                assert!(is_in(half.bounds(), slack), "{corners:?} {within:?} {AXIS} {at}: {p} {half:?}");
            }
        }
        inside
    }

    #[test]
    fn halves_of_a_triangle_cover_their_sides() {
        let (mut random, mut inside) = (Random(1), 0);
        for round in 0..rounds(20_000) {
            let scale = [1.0, 1e-30, 1e30, 1e-5][round % 4];
            let offset = [0.0, 1e4, 0.0, 3.0][round % 4] * random.point();
            // Test slivers, flat triangles, and triangles with several corners at the same height.
            let mut corners = [(); 3].map(|()| scale * (random.point() + offset));
            match random.below(4) {
                0 => corners[2] = corners[0].midpoint(corners[1]) + 1e-6 * scale * random.point(),
                1 => corners[1][random.below(3)] = corners[0][random.below(3)],
                2 => corners = corners.map(|p| Vec3 { y: corners[0].y, ..p }),
                _ => {}
            }
            let all = Aabb::around(corners);
            let mix = |random: &mut Random| all.min + random.unit() * (all.max - all.min);
            let (p, q) = (mix(&mut random), mix(&mut random));
            let within = [all, Aabb { min: p.min(q), max: p.max(q) }][random.below(2)];
            inside += check::<0>(&mut random, corners, within);
            inside += check::<1>(&mut random, corners, within);
            inside += check::<2>(&mut random, corners, within);
        }
        assert!(inside > 100_000, "{inside}");
    }
}
