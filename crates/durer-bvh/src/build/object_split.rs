//! Object splits: partitions of references into two sets, chosen by the surface area heuristic.
//!
//! Large sets of references are binned along each axis. For small sets, all possible partitions are
//! compared. Source: Wald, *On fast Construction of SAH-based Bounding Volume Hierarchies*, IEEE RT
//! 2007.

use super::builder::{Bin, Builder, MIN_PARALLEL, around_all};
use super::reference::Reference;
use super::settings::BINS;
use crate::parallel;
use glam::{IVec4, Mat4, Vec4};

/// Depth below which references are always split into two halves of equal size. This bounds the
/// depth of all trees because 2^28 primitives can be halved 28 times.
pub const HALVING_DEPTH: usize = 60;
/// Maximum number of references for which all partitions are compared.
const MAX_EXHAUSTIVE: usize = 4;
/// Minimum number of references for which each half of the list gets its own bins.
const MIN_FOR_MORE_BINS: usize = 64;

/// Intervals of equal width along each axis, into which the centres of references are binned.
#[derive(Clone, Copy)]
struct BinGrid {
    low: Vec4,
    scale: Vec4,
    bins: usize,
}

impl BinGrid {
    fn new(references: &[Reference], bins: usize) -> BinGrid {
        let [low, high] = middles(references);
        // If an extent is zero or out of range, all references fall into the first bin.
        let scale = bins as f32 * (1.0 - 1e-6) / (high - low);
        let scale = Vec4::select(scale.cmplt(Vec4::INFINITY), scale, Vec4::ZERO);
        BinGrid { low, scale, bins }
    }

    /// Returns the bins of a reference along each axis, added to 2^23 so that the lowest bit of the
    /// number counts as 1.
    #[inline(always)]
    fn at(&self, r: &Reference) -> Vec4 {
        let at = (r.double_center() - self.low) * self.scale - 0.5;
        // This also replaces NaN.
        let at = Vec4::select(at.cmpgt(Vec4::ZERO), at, Vec4::ZERO);
        at.min(Vec4::splat((self.bins - 1) as f32)) + FIRST
    }
}

const FIRST: f32 = (1 << 23) as f32;

/// Returns the bounds of [`Reference::middle`] over all references.
fn middles(references: &[Reference]) -> [Vec4; 2] {
    around_all(references, &|r| [r.double_center(); 2])
}

/// Bin of an object split for all three axes at once: one box and one number of references per
/// axis.
#[derive(Clone, Copy)]
struct Bins {
    boxes: [[Vec4; 2]; 3],
    counts: IVec4,
}

impl Bins {
    const EMPTY: Bins = Bins { boxes: [[Vec4::INFINITY, Vec4::NEG_INFINITY]; 3], counts: IVec4::ZERO };

    #[inline(always)]
    fn join(&mut self, other: &Bins) {
        for ([min, max], [low, high]) in self.boxes.iter_mut().zip(other.boxes) {
            (*min, *max) = (min.min(low), max.max(high));
        }
        self.counts += other.counts;
    }

    /// Returns the costs along all axes.
    #[inline(always)]
    fn costs(&self, scale: f32) -> Vec4 {
        let size = |axis: usize| ((self.boxes[axis][1] - self.boxes[axis][0]) * scale).max(Vec4::ZERO);
        let sizes = Mat4::from_cols(size(0), size(1), size(2), Vec4::ZERO).transpose();
        let [x, y, z] = [sizes.x_axis, sizes.y_axis, sizes.z_axis];
        (x * y + y * z + z * x) * self.counts.as_vec4()
    }

    fn get(&self, axis: usize) -> Bin {
        let [min, max] = self.boxes[axis];
        Bin { min, max, count: self.counts[axis] as u32 }
    }
}

/// Distributes references among the bins.
fn fill_bins<const N: usize>(references: &[Reference], grid: &BinGrid) -> [Bins; N] {
    if references.len() > MIN_PARALLEL {
        let (a, b) = references.split_at(references.len() / 2);
        let (mut a, b) = parallel::join(|| fill_bins::<N>(a, grid), || fill_bins::<N>(b, grid));
        a.iter_mut().zip(&b).for_each(|(a, b)| a.join(b));
        return a;
    }
    let mut bins = [Bins::EMPTY; N];
    let add = |bins: &mut [Bins; N], r: &Reference| {
        let at = grid.at(r).to_array();
        for axis in 0..3 {
            let bins = &mut bins[at[axis].to_bits() as usize % N];
            let [min, max] = &mut bins.boxes[axis];
            (*min, *max) = (min.min(r.min), max.max(r.max));
            bins.counts[axis] += 1;
        }
    };
    // Consecutive references often fall into the same bin, where each update would wait for the
    // previous one. Therefore the loop alternates between the two halves of the list. If there is
    // only one bin along an axis, all references fall into it.
    let (a, b) = references.split_at(references.len() / 2);
    if references.len() < MIN_FOR_MORE_BINS {
        for (a, b) in a.iter().zip(b) {
            add(&mut bins, a);
            add(&mut bins, b);
        }
        b[a.len()..].iter().for_each(|r| add(&mut bins, r));
        return bins;
    }
    let mut others = [Bins::EMPTY; N];
    for (a, b) in a.iter().zip(b) {
        add(&mut bins, a);
        add(&mut others, b);
    }
    b[a.len()..].iter().for_each(|r| add(&mut others, r));
    bins.iter_mut().zip(&others).for_each(|(a, b)| a.join(b));
    bins
}

/// An object split: a partition of references into two sets, with its cost and the boxes of both
/// sets.
pub struct ObjectSplit {
    pub cost: f32,
    pub sides: [Bin; 2],
    rule: SplitRule,
}

/// Rule that decides whether a reference goes to the left or the right set of an object split.
enum SplitRule {
    /// The left set contains the references whose bins are before a border along an axis.
    Bins { grid: BinGrid, axis: usize, border: usize },
    /// The left set contains the references whose bits are set in the mask.
    Mask(usize),
    /// The left set contains the first half of the references, sorted along the longest axis.
    Half,
}

impl Builder<'_> {
    /// Finds the cheapest partition of the references.
    pub fn object_split(&self, references: &[Reference], all: &Bin, depth: usize) -> ObjectSplit {
        // The boxes of both sides are not known yet, but they lie within `all`.
        let half = ObjectSplit { cost: all.cost(self.scale), sides: [*all; 2], rule: SplitRule::Half };
        let count = references.len();
        if depth >= HALVING_DEPTH {
            half
        } else if count <= MAX_EXHAUSTIVE {
            self.exhaustive(references)
        } else if count <= 64 {
            self.binned::<8>(references).unwrap_or(half)
        } else {
            self.binned::<BINS>(references).unwrap_or(half)
        }
    }

    /// Finds the cheapest border between two bins. Returns `None` if all centres are in one bin.
    fn binned<const N: usize>(&self, references: &[Reference]) -> Option<ObjectSplit> {
        let grid = BinGrid::new(references, (self.bins)(references.len()).min(N));
        let bins = fill_bins::<N>(references, &grid);
        // Compute the costs to the right of each border and then the costs to the left, for all
        // axes at once.
        let mut right_costs = [Vec4::ZERO; N];
        let mut right = Bins::EMPTY;
        for i in (1..grid.bins).rev() {
            right.join(&bins[i]);
            right_costs[i] = right.costs(self.scale);
        }
        let (mut costs, mut borders, mut left) = (Vec4::INFINITY, Vec4::ZERO, Bins::EMPTY);
        for i in 1..grid.bins {
            left.join(&bins[i - 1]);
            let count = left.counts.as_vec4();
            let both = count.cmpgt(Vec4::ZERO) & count.cmplt(Vec4::splat(references.len() as f32));
            let cost = left.costs(self.scale) + right_costs[i];
            let better = both & cost.cmplt(costs);
            costs = Vec4::select(better, cost, costs);
            borders = Vec4::select(better, Vec4::splat(i as f32), borders);
        }
        let axis = costs.truncate().min_position();
        let (cost, border) = (costs[axis], borders[axis] as usize);
        let side = |bins: &[Bins]| bins.iter().fold(Bin::EMPTY, |all, bins| all.union(bins.get(axis)));
        let sides = [side(&bins[..border]), side(&bins[border..])];
        (cost < f32::INFINITY).then_some(ObjectSplit { cost, sides, rule: SplitRule::Bins { grid, axis, border } })
    }

    /// Compares all partitions of a small number of references.
    fn exhaustive(&self, references: &[Reference]) -> ObjectSplit {
        let count = references.len();
        let full = (1 << count) - 1;
        let mut sets = [Bin::EMPTY; 1 << MAX_EXHAUSTIVE];
        let mut costs = [0.0; 1 << MAX_EXHAUSTIVE];
        for mask in 1..full {
            sets[mask] = sets[mask & (mask - 1)].with(&references[mask.trailing_zeros() as usize]);
            costs[mask] = sets[mask].cost(self.scale);
        }
        let mut best = (f32::INFINITY, 1);
        for mask in 1..=full / 2 {
            let cost = costs[mask] + costs[full - mask];
            if cost < best.0 {
                best = (cost, mask);
            }
        }
        let (cost, mask) = best;
        ObjectSplit { cost, sides: [sets[mask], sets[full - mask]], rule: SplitRule::Mask(mask) }
    }

    /// Partitions the references in place. Returns the boxes of both sets and the size of the first
    /// set.
    pub fn divide(&self, references: &mut [Reference], cut: &ObjectSplit) -> ([Bin; 2], usize) {
        let [left, right] = cut.sides;
        match cut.rule {
            SplitRule::Bins { grid, axis, border } => {
                // Along the other two axes, no bin lies before the border.
                let mut borders = Vec4::NEG_INFINITY;
                borders[axis] = FIRST + border as f32;
                partition(references, |r| grid.at(r).cmplt(borders).any());
            }
            SplitRule::Mask(mask) => {
                let mut places = [0, left.count as usize];
                let mut sorted = [references[0]; MAX_EXHAUSTIVE];
                for (i, r) in references.iter().enumerate() {
                    let side = 1 - (mask >> i & 1);
                    sorted[places[side]] = *r;
                    places[side] += 1;
                }
                references.copy_from_slice(&sorted[..references.len()]);
            }
            SplitRule::Half => {
                let (left, right) = halve(references);
                return ([Bin::of(left), Bin::of(right)], left.len());
            }
        }
        ([left, right], left.count as usize)
    }
}

/// Moves the references that satisfy the predicate to the front.
fn partition(references: &mut [Reference], is_left: impl Fn(&Reference) -> bool) {
    let mut left = 0;
    for i in 0..references.len() {
        let (here, other) = (references[i], references[left]);
        (references[i], references[left]) = (other, here);
        // The loop has no branches because a branch would be mispredicted half of the time.
        left += usize::from(is_left(&here));
    }
}

/// Sorts the references along the longest axis and splits the list in the middle.
fn halve(references: &mut [Reference]) -> (&mut [Reference], &mut [Reference]) {
    let [low, high] = middles(references);
    let axis = (high - low).truncate().max_position();
    references.sort_unstable_by(|a, b| {
        a.double_center()[axis]
            .total_cmp(&b.double_center()[axis])
            .then(a.number().cmp(&b.number()))
            .then(a.min[axis].total_cmp(&b.min[axis]))
    });
    references.split_at_mut(references.len() / 2)
}
