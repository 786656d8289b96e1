//! A binary tree whose nodes may be cut in space, where parts of a triangle then go to both sides.
//!
//! Where the cheapest division of references into two sets leaves boxes that overlap, planes are tried too; a plane cuts the
//! triangles that it goes through, unless it is cheaper to leave one whole on one side.
//! Source: Stich, Friedrich, Dietrich, *Spatial Splits in Bounding Volume Hierarchies*, HPG 2009.

use super::Reference;
use super::binary::{self, BINS, Bin, Builder, Cut, Set, HALVING_DEPTH, Node, PARALLEL, Tree};
use crate::math::{Aabb, Vec3};

/// Planes are tried where the overlap has at least this share of the node's area.
const OVERLAP: f32 = 0.1;
/// They must cost less than this share of what the best two sets cost.
const GAIN: f32 = 0.95;

/// Builds a tree over triangles with at most `share` more references for each one that is there; also gives the references, in
/// the order of its leaves.
pub fn build<C: Fn(u32) -> [Vec3; 3] + Sync>(
    references: &mut [Reference],
    corners_of: &C,
    scale: f32,
    share: f32,
) -> (Tree, Vec<Reference>) {
    let spare = (references.len() as f32 * share) as usize;
    let cutter = Cutter { builder: Builder { scale }, corners_of };
    let mut made = Made::default();
    cutter.subtree(references, spare, 0, &mut made);
    let leaves = made.nodes.iter_mut().filter(|node| node.count() == 1);
    leaves.enumerate().for_each(|(item, leaf)| *leaf = Node::new(leaf.min, leaf.max, 1, item as u32));
    (Tree { nodes: made.nodes, scale }, made.references)
}

/// Nodes and the references of their leaves, in depth-first order.
#[derive(Default)]
struct Made {
    nodes: Vec<Node>,
    references: Vec<Reference>,
}

struct Cutter<'a, C> {
    builder: Builder,
    corners_of: &'a C,
}

/// A plane that costs so much, all areas times numbers of references.
struct Plane {
    cost: f32,
    axis: usize,
    at: f32,
}

impl<C: Fn(u32) -> [Vec3; 3] + Sync> Cutter<'_, C> {
    /// Builds over some references, of which so many more may be made.
    fn subtree(&self, references: &mut [Reference], spare: usize, depth: usize, made: &mut Made) {
        let set = Set::of(references);
        let bounds = set.bounds;
        let (place, first) = (made.nodes.len(), made.references.len());
        made.nodes.push(Node::new(bounds.min, bounds.max, 1, 0));
        if let [only] = references {
            made.references.push(*only);
            return;
        }
        let cut = self.builder.cut(references, &set, depth);
        let parts = if spare > 0 { self.parts(references, &bounds, &cut, spare, depth) } else { None };
        match parts {
            Some([mut left, mut right]) => {
                let spare = spare + references.len() - left.len() - right.len();
                self.both(&mut left, &mut right, spare, depth, made);
            }
            None => {
                let (left, _) = self.builder.divide(references, &cut);
                let (left, right) = references.split_at_mut(left.bounds.count as usize);
                self.both(left, right, spare, depth, made);
            }
        }
        let count = made.references.len() - first;
        made.nodes[place] = Node::new(bounds.min, bounds.max, count as u32, 0);
    }

    fn both(&self, left: &mut [Reference], right: &mut [Reference], spare: usize, depth: usize, made: &mut Made) {
        // What is to spare goes where more references are.
        let all = left.len() + right.len();
        let for_left = (spare as u64 * left.len() as u64 / all as u64) as usize;
        if all <= PARALLEL {
            self.subtree(left, for_left, depth + 1, made);
            self.subtree(right, spare - for_left, depth + 1, made);
            return;
        }
        let mut other = Made::default();
        rayon::join(
            || self.subtree(left, for_left, depth + 1, made),
            || self.subtree(right, spare - for_left, depth + 1, &mut other),
        );
        made.nodes.append(&mut other.nodes);
        made.references.append(&mut other.references);
    }

    /// The references on both sides of a plane, if that is better than the two sets before and after `cut`.
    fn parts(
        &self,
        references: &[Reference],
        bounds: &Bin,
        cut: &Cut,
        spare: usize,
        depth: usize,
    ) -> Option<[Vec<Reference>; 2]> {
        let count = references.len();
        // A few references are likely to be a leaf, in which cuts are in vain.
        if count <= 8 || depth >= HALVING_DEPTH {
            return None;
        }
        let scale = self.builder.scale;
        let [l, r] = cut.sides;
        let overlap = binary::half_area(l.min.max(r.min), l.max.min(r.max), scale);
        if overlap < OVERLAP * binary::half_area(bounds.min, bounds.max, scale) {
            return None;
        }
        let plane = self.plane(references, bounds)?;
        if plane.cost >= GAIN * (l.cost(scale) + r.cost(scale)) {
            return None;
        }
        let parts = self.divide(references, &plane);
        let lens = [parts[0].len(), parts[1].len()];
        let smaller = lens.iter().all(|&len| 0 < len && len < count);
        (smaller && lens[0] + lens[1] <= count + spare).then_some(parts)
    }

    /// The cheapest plane between bins of equal width.
    fn plane(&self, references: &[Reference], bounds: &Bin) -> Option<Plane> {
        let mut best = None::<Plane>;
        // Few references fill few bins, and each border costs a cut.
        let count = if references.len() > 256 { BINS } else { BINS / 2 };
        for axis in 0..3 {
            let (low, high) = (bounds.min[axis], bounds.max[axis]);
            let width = (high - low) / count as f32;
            // Flat and immense things are not cut.
            if !(width.is_normal() && low + width > low && high - width < high) {
                continue;
            }
            let at = |bin: usize| low + width * bin as f32;
            let bin_of = |x: f32| (((x - low) / width) as usize).min(count - 1);
            let mut bins = [Bin::EMPTY; BINS];
            let mut ends = [0_u32; BINS];
            for r in references {
                let (first, last) = (bin_of(r.min[axis]), bin_of(r.max[axis]));
                let mut rest = *r;
                for (bin, number) in bins[first..last].iter_mut().zip(first + 1..) {
                    let [left, right] = self.halves(axis, at(number), &rest);
                    *bin = bin.around(&left);
                    rest = right;
                }
                bins[last] = bins[last].around(&rest);
                bins[first].count += 1;
                ends[last] += 1;
            }
            let mut right = [(0.0, 0_u32); BINS];
            let mut sum = Bin::EMPTY;
            for bin in (1..count).rev() {
                sum = sum.union(Bin { count: ends[bin], ..bins[bin] });
                right[bin] = (sum.cost(self.builder.scale), sum.count);
            }
            let mut left = Bin::EMPTY;
            for bin in 1..count {
                left = left.union(bins[bin - 1]);
                let (right_cost, right_count) = right[bin];
                let cost = left.cost(self.builder.scale) + right_cost;
                if left.count > 0 && right_count > 0 && best.as_ref().is_none_or(|best| cost < best.cost) {
                    best = Some(Plane { cost, axis, at: at(bin) });
                }
            }
        }
        best
    }

    /// The references on both sides of a plane. Those that it goes through are cut, unless the boxes that grow when one stays whole
    /// cost less.
    fn divide(&self, references: &[Reference], &Plane { axis, at, .. }: &Plane) -> [Vec<Reference>; 2] {
        let (mut left, mut right, mut through) = (Vec::new(), Vec::new(), Vec::new());
        for r in references {
            match () {
                () if r.max[axis] <= at => left.push(*r),
                () if r.min[axis] >= at => right.push(*r),
                () => through.push((*r, self.halves(axis, at, r))),
            }
        }
        let mut sides = [&left, &right].map(|side| side.iter().fold(Bin::EMPTY, Bin::with));
        for (_, halves) in &through {
            sides.iter_mut().zip(halves).for_each(|(side, half)| *side = side.with(half));
        }
        let scale = self.builder.scale;
        let cost = |[l, r]: &[Bin; 2]| l.cost(scale) + r.cost(scale);
        for (whole, [a, b]) in through {
            let [l, r] = sides;
            // Its own half is among those counted on either side.
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

    /// What of a reference lies on both sides of a plane.
    fn halves(&self, axis: usize, at: f32, r: &Reference) -> [Reference; 2] {
        let boxes = halves(axis, at, (self.corners_of)(r.number()), r.bounds());
        // Of a part that only touches the plane nothing may be left.
        boxes.map(|half| if half.is_empty() { *r } else { Reference::new(half, r.number()) })
    }
}

/// The boxes of a triangle's parts on both sides of a plane, within its present box.
fn halves(axis: usize, at: f32, corners: [Vec3; 3], b: Aabb) -> [Aabb; 2] {
    let mut halves = [Aabb::EMPTY; 2];
    for (p, q) in [(corners[0], corners[1]), (corners[1], corners[2]), (corners[2], corners[0])] {
        if p[axis] <= at {
            halves[0] = halves[0].with(p);
        }
        if p[axis] >= at {
            halves[1] = halves[1].with(p);
        }
        if (p[axis] < at && q[axis] > at) || (p[axis] > at && q[axis] < at) {
            let (p, q) = (p.as_dvec3(), q.as_dvec3());
            let crossing = (p + (q - p) * ((f64::from(at) - p[axis]) / (q[axis] - p[axis]))).as_vec3();
            // Outwards by one rounding, so that the part is inside.
            let (low, high) = (crossing.map(f32::next_down), crossing.map(f32::next_up));
            for half in &mut halves {
                *half = half.with(low).with(high);
            }
        }
    }
    halves[0].max[axis] = at;
    halves[1].min[axis] = at;
    halves.map(|half| Aabb { min: half.min.max(b.min), max: half.max.min(b.max) })
}
