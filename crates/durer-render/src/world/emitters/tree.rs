//! Light tree, which chooses one of many emitters with probabilities proportional to their
//! estimated contributions to a point.
//!
//! Source: Conty Estévez and Kulla, *Importance Sampling of Many Lights with Adaptive Tree
//! Splitting*, HPG 2018, with the bounds of *Physically Based Rendering*, 4th edition, section
//! 12.6.3. Unlike in these sources, each node has eight children that are weighted together, which
//! makes the tree shallower. Within a distant group of similar emitters, the choice is uniform. If
//! there are many lights, most choices then read only the upper nodes, which stay in the CPU cache.

use super::Receiver;
use durer_bvh::internal::{PlainKernel, run_plain, vec_on_large_pages};
use durer_scene::math::{Aabb, Vec3, fp};
use std::f32::consts::PI;

/// Bounds on the position, power and directions of a group of emitters in the light tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightBounds {
    /// Bounding box.
    pub bounds: Aabb,
    /// Total power, in an arbitrary unit that is the same for all emitters.
    pub power: f32,
    /// Axis of the cone that contains all normals.
    pub axis: Vec3,
    /// Cosine of the largest angle between the axis and a normal.
    pub cos_normals: f32,
    /// Cosine of the largest angle between a normal and the directions in which light is emitted
    /// there.
    pub cos_emission: f32,
    /// True if light is emitted from both sides.
    pub two_sided: bool,
    /// Power of each emitter if all of them have similar powers and directions, otherwise 0.
    pub emitter_power: f32,
}

impl LightBounds {
    /// Returns the bounds of both groups together.
    fn union(&self, other: &LightBounds) -> LightBounds {
        let (axis, cos_normals) = cone_union((self.axis, self.cos_normals), (other.axis, other.cos_normals));
        let share = self.emitter_power.min(other.emitter_power) / self.emitter_power.max(other.emitter_power);
        let one_way = cos_normals >= MIN_SIMILAR_COSINE && self.two_sided == other.two_sided;
        let all_ways = self.cos_normals == -1.0 && other.cos_normals == -1.0;
        LightBounds {
            bounds: self.bounds.union(other.bounds),
            power: self.power + other.power,
            axis,
            cos_normals,
            cos_emission: self.cos_emission.min(other.cos_emission),
            two_sided: self.two_sided || other.two_sided,
            emitter_power: if share >= MIN_SIMILAR_RATIO && (one_way || all_ways) {
                self.emitter_power.min(other.emitter_power)
            } else {
                0.0
            },
        }
    }
}

/// Returns the angle that has the given cosine.
fn angle(cosine: f32) -> f32 {
    fp::atan2(sine(cosine), cosine)
}

/// Returns the smallest cone that contains two cones, each given by its axis and the cosine of its
/// half-angle.
fn cone_union((a, cos_a): (Vec3, f32), (b, cos_b): (Vec3, f32)) -> (Vec3, f32) {
    let (wide_a, wide_b, between) = (angle(cos_a), angle(cos_b), angle(a.dot(b).clamp(-1.0, 1.0)));
    if (between + wide_b).min(PI) <= wide_a {
        return (a, cos_a);
    }
    if (between + wide_a).min(PI) <= wide_b {
        return (b, cos_b);
    }
    let wide = 0.5 * (wide_a + between + wide_b);
    let Some(about) = a.cross(b).try_normalize().filter(|_| wide < PI) else { return (Vec3::Z, -1.0) };
    let turn = wide - wide_a;
    let axis = a * fp::cos(turn) + about.cross(a) * fp::sin(turn);
    (axis.normalize_or(a), fp::cos(wide))
}

/// Weight of the cosines at a node's centre relative to the largest cosines in the node. If only
/// the largest cosines were used, wide nodes seen from the side would be overestimated.
const CENTER: f32 = 0.8;

/// Minimum cosine between the axis and the normals at which emitters count as similar.
const MIN_SIMILAR_COSINE: f32 = 0.995;

/// Minimum ratio between two powers that count as similar.
const MIN_SIMILAR_RATIO: f32 = 0.8;

/// Number of children of a node.
const WIDTH: usize = 8;

/// One number per child of a [`Node`].
type Eight = [f32; WIDTH];

/// Node of the light tree, which stores the bounds of its eight children as arrays for SIMD. Nodes
/// are often read from main memory, so values that can be computed are not stored.
#[derive(Clone, Debug)]
struct Node {
    /// Centre of the bounds of each child.
    middle: [Eight; 3],
    /// Squared radius of each child's bounding sphere, which has the same centre.
    radius2: Eight,
    /// Power of each child; 0 if the child is missing, negative if the emission is two-sided.
    power: Eight,
    axis: [Eight; 3],
    cos_normals: Eight,
    cos_emission: Eight,
    children: [Child; WIDTH],
    /// Start of each child's emitters in the tree's order, followed by the end of the last child's
    /// emitters.
    ends: [u32; WIDTH + 1],
    /// Bit mask of the children that contain several similar emitters.
    alike: u8,
}

/// Index of a child node or, if the bit [`Child::EMITTER`] is set, of an emitter.
#[derive(Clone, Copy, Debug)]
struct Child(u32);

impl Child {
    const EMITTER: u32 = 1 << 31;
}

impl Node {
    fn new(child_indices: &[LightBounds]) -> Self {
        let of =
            |number: &dyn Fn(&LightBounds) -> f32| std::array::from_fn(|i| child_indices.get(i).map_or(0.0, number));
        Node {
            middle: [0, 1, 2].map(|axis| of(&|b| b.bounds.center()[axis])),
            radius2: of(&|b| (0.5 * b.bounds.size()).length_squared()),
            power: of(&|b| if b.two_sided { -b.power } else { b.power }),
            axis: [0, 1, 2].map(|axis| of(&|b| b.axis[axis])),
            cos_normals: of(&|b| b.cos_normals),
            cos_emission: of(&|b| b.cos_emission),
            children: [Child(0); WIDTH],
            ends: [0; WIDTH + 1],
            alike: 0,
        }
    }

    /// Estimates the contribution of each child to a point. The estimate is greater than zero
    /// wherever the child contributes any light. The second result is true for each child that is
    /// distant.
    ///
    /// Must be called within [`run_plain`]. The loop has no branches.
    #[inline(always)]
    fn importances(&self, to: &Receiver) -> (Eight, [bool; WIDTH]) {
        if to.n == Vec3::ZERO { self.importances_of::<false>(to) } else { self.importances_of::<true>(to) }
    }

    /// Implements [`Node::importances`]. `FACING` is true if the receiver has a normal.
    #[inline(always)]
    fn importances_of<const FACING: bool>(&self, to: &Receiver) -> (Eight, [bool; WIDTH]) {
        let (p, n, far2) = (to.point.as_vec3(), to.n, to.uniform_threshold() * to.uniform_threshold());
        let (mut importances, mut far) = ([0.0; WIDTH], [false; WIDTH]);
        for i in 0..WIDTH {
            let (x, y, z) = (p.x - self.middle[0][i], p.y - self.middle[1][i], p.z - self.middle[2][i]);
            let (distance2, radius2) = (x * x + y * y + z * z, self.radius2[i]);
            let inverse = 1.0 / distance2.sqrt();
            let inverse = if distance2 > 0.0 { inverse } else { 0.0 };
            let (x, y, z) = (x * inverse, y * inverse, z * inverse);
            let cosine = self.axis[0][i] * x + self.axis[1][i] * y + self.axis[2][i] * z;
            let power = self.power[i];
            let cosine = if power < 0.0 { cosine.abs() } else { cosine };
            let sine2 = radius2 / distance2;
            let cos_bounds = (1.0 - sine2).sqrt();
            let inside = distance2 <= radius2;
            let bounds = (if inside { -1.0 } else { cos_bounds }, if inside { 0.0 } else { sine2.sqrt() });
            // Lower bound on the angle between the direction to the point and any normal of the
            // child's emitters.
            let least = subtract_angles((cosine, sine(cosine)), (self.cos_normals[i], sine(self.cos_normals[i])));
            let (cos_least, _) = subtract_angles(least, bounds);
            // On the axis of a uniform disc, the mean of 1 / distance^2 times both cosines is 1 /
            // (d^2 + r^2). A square whose corners lie on a circle has 0.64 times the area of the
            // disc inside the circle.
            let spread2 = largest(0.64 * radius2, f32::MIN_POSITIVE);
            let mut importance = power.abs() * blend_cosines(least.0, cos_least) / (distance2 + spread2);
            let mut across = least.0;
            if FACING {
                let arriving = -(n.x * x + n.y * y + n.z * z);
                let (cos_arriving, _) = subtract_angles((arriving, sine(arriving)), bounds);
                importance *= blend_cosines(arriving, largest(cos_arriving, 0.0));
                across = if across < arriving { across } else { arriving };
            }
            far[i] = across > 0.0 && radius2 < far2 * distance2 * across * across;
            importances[i] = if cos_least <= self.cos_emission[i] { 0.0 } else { largest(importance, 0.0) };
        }
        (importances, far)
    }
}

/// Returns the sum of eight numbers, in a fixed order.
#[inline(always)]
fn sum(x: &Eight) -> f32 {
    ((x[0] + x[4]) + (x[1] + x[5])) + ((x[2] + x[6]) + (x[3] + x[7]))
}

/// Converts estimated contributions to probabilities. The results are NaN if no child contributes.
#[inline(always)]
fn shares(mut importances: Eight) -> Eight {
    let sum = sum(&importances);
    let sum = if sum > 0.0 && sum < f32::INFINITY { sum } else { f32::NAN };
    for importance in &mut importances {
        *importance /= sum;
    }
    importances
}

/// Returns the greater of two numbers, neither of which is NaN, with one instruction.
#[inline(always)]
fn largest(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Returns the sine of the angle between 0 and pi that has the given cosine.
#[inline(always)]
fn sine(cosine: f32) -> f32 {
    largest(1.0 - cosine * cosine, 0.0).sqrt()
}

/// Combines the cosine at the centre of a node with the largest cosine in the node.
#[inline(always)]
fn blend_cosines(center: f32, most: f32) -> f32 {
    CENTER * largest(center, 0.0) + (1.0 - CENTER) * most
}

/// Returns the cosine and sine of the difference of two angles, or of 0 if the difference is
/// negative.
#[inline(always)]
fn subtract_angles((cos_a, sin_a): (f32, f32), (cos_b, sin_b): (f32, f32)) -> (f32, f32) {
    let (cosine, sine) = (cos_a * cos_b + sin_a * sin_b, sin_a * cos_b - cos_a * sin_b);
    let is_less = cos_a > cos_b;
    (if is_less { 1.0 } else { cosine }, if is_less { 0.0 } else { sine })
}

/// SIMD kernel that estimates the contributions of a node's children to a point.
struct Estimate<'a> {
    node: &'a Node,
    to: &'a Receiver,
}

impl PlainKernel for Estimate<'_> {
    /// Result of [`Node::importances`].
    type Output = (Eight, [bool; WIDTH]);

    #[inline(always)]
    fn run(self) -> Self::Output {
        self.node.importances(self.to)
    }
}

/// SIMD kernel that chooses an emitter; see [`LightTree::sample`].
struct Sample<'a> {
    nodes: &'a [Node],
    to: &'a Receiver,
    u: f32,
}

impl PlainKernel for Sample<'_> {
    type Output = Option<(u32, f32)>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Sample { nodes, to, u } = self;
        let (mut place, mut rest, mut probability) = (0, u, 1.0);
        loop {
            let node = nodes.get(place)?;
            let (importances, far) = node.importances(to);
            let shares = shares(importances);
            // Find the first child whose cumulative probability exceeds the random number, without
            // branches, since the branches would be unpredictable.
            let (mut slot, mut sum, mut before) = (0, 0.0, 0.0);
            for share in shares {
                sum += share;
                let is_passed = rest >= sum;
                slot += usize::from(is_passed);
                before = if is_passed { sum } else { before };
            }
            if slot == WIDTH {
                // Because of rounding, no child was found: take the last child with a probability
                // above 0.
                slot = shares.iter().rposition(|&share| share > 0.0)?;
                before = shares[..slot].iter().sum();
            } else if shares[0].is_nan() {
                return None;
            }
            rest = ((rest - before) / shares[slot]).clamp(0.0, 1.0 - f32::EPSILON * 0.5);
            probability *= shares[slot];
            if far[slot] && node.alike >> slot & 1 == 1 {
                let [from, to] = [node.ends[slot], node.ends[slot + 1]];
                let count = (to - from) as f32;
                return Some(((from + (rest * count) as u32).min(to - 1), probability / count));
            }
            let Child(next) = node.children[slot];
            match next & !Child::EMITTER {
                emitter if emitter != next => return Some((emitter, probability)),
                next => place = next as usize,
            }
        }
    }
}

/// Light tree over the emitters of a world, which chooses an emitter with a probability
/// proportional to its estimated contribution to a point.
#[derive(Clone, Debug, Default)]
pub struct LightTree {
    nodes: Vec<Node>,
    /// Parent of each node, and the node's slot in the parent.
    parents: Vec<(u32, u8)>,
    /// Node that contains each emitter, and the emitter's slot in the node.
    leaves: Vec<(u32, u8)>,
}

/// Node of the binary light tree that is built first, before nodes are merged into nodes with eight
/// children. If the node is not a single emitter, its children are at `first` and `first + 1`.
struct BuildNode {
    bounds: LightBounds,
    first: usize,
    /// Range of the node's emitters in the tree's order.
    range: (u32, u32),
}

impl BuildNode {
    fn is_leaf(&self) -> bool {
        self.range.1 - self.range.0 == 1
    }
}

const BUCKETS: usize = 12;

impl LightTree {
    /// Builds a tree over all emitters whose power is greater than zero. The result includes the
    /// indices of these emitters in the tree's order; the other functions identify an emitter by
    /// its position in that order.
    pub fn new(emitters: &[LightBounds]) -> (Self, Vec<u32>) {
        let (halves, order) = build_binary(emitters);
        let mut tree = LightTree { leaves: vec![(0, 0); order.len()], ..LightTree::default() };
        let Some(root) = halves.first() else { return (tree, order) };
        let mut open = vec![(if root.is_leaf() { vec![0] } else { vec![root.first, root.first + 1] }, (0, 0))];
        while let Some((mut child_indices, parent)) = open.pop() {
            // Replace the most expensive nodes by their children until all slots are used.
            while child_indices.len() < WIDTH {
                let inner = (0..child_indices.len()).filter(|&i| !halves[child_indices[i]].is_leaf());
                let largest = inner.max_by(|&a, &b| {
                    let [a, b] = [a, b].map(|i| cost(&halves[child_indices[i]].bounds));
                    a.total_cmp(&b)
                });
                let Some(i) = largest else { break };
                let first = halves[child_indices[i]].first;
                child_indices.splice(i..=i, [first, first + 1]);
            }
            let number = tree.nodes.len() as u32;
            let bounds: Vec<LightBounds> = child_indices.iter().map(|&half| halves[half].bounds).collect();
            let mut node = Node::new(&bounds);
            for (slot, half) in (0..).zip(child_indices.iter().map(|&half| &halves[half])) {
                (node.ends[usize::from(slot)], node.ends[usize::from(slot) + 1]) = half.range;
                node.alike |= u8::from(half.bounds.emitter_power > 0.0 && !half.is_leaf()) << slot;
                if half.is_leaf() {
                    node.children[usize::from(slot)] = Child(Child::EMITTER | half.range.0);
                    tree.leaves[half.range.0 as usize] = (number, slot);
                } else {
                    open.push((vec![half.first, half.first + 1], (number, slot)));
                }
            }
            if number > 0 {
                let (above, slot) = parent;
                tree.nodes[above as usize].children[usize::from(slot)] = Child(number);
            }
            tree.nodes.push(node);
            tree.parents.push(parent);
        }
        // Move the nodes to aligned memory, which is faster to read.
        let mut placed = vec_on_large_pages(tree.nodes.len());
        placed.append(&mut tree.nodes);
        tree.nodes = placed;
        (tree, order)
    }

    /// Returns true if the tree has no emitters.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Estimates the irradiance from all emitters at a point.
    pub fn importance(&self, to: &Receiver) -> f32 {
        self.nodes.first().map_or(0.0, |node| sum(&run_plain(Estimate { node, to }).0))
    }

    /// Chooses an emitter for a point. `u` in [0, 1) is a random number. The result includes the
    /// probability of the choice.
    pub fn sample(&self, to: &Receiver, u: f32) -> Option<(u32, f32)> {
        if self.leaves.len() == 1 {
            // A sample of the only emitter costs less than the estimate.
            return Some((0, 1.0));
        }
        run_plain(Sample { nodes: &self.nodes, to, u })
    }

    /// Returns the probability with which [`LightTree::sample`] chooses an emitter.
    pub fn probability(&self, to: &Receiver, emitter: u32) -> f32 {
        if self.leaves.len() == 1 {
            return 1.0;
        }
        self.leaves.get(emitter as usize).map_or(0.0, |&(place, slot)| self.reached(place, slot, to).0)
    }

    /// Returns the probability of reaching a child of a node. The second result is true if a
    /// uniform choice within a group ends the descent before that child.
    fn reached(&self, place: u32, slot: u8, to: &Receiver) -> (f32, bool) {
        let mut before = 1.0;
        if place > 0 {
            let (above, slot) = self.parents[place as usize];
            let (probability, is_last) = self.reached(above, slot, to);
            if is_last || probability == 0.0 {
                return (probability, is_last);
            }
            before = probability;
        }
        let slot = usize::from(slot);
        let node = &self.nodes[place as usize];
        let (importances, far) = run_plain(Estimate { node, to });
        let share = shares(importances)[slot];
        if share.is_nan() {
            return (0.0, true);
        }
        let probability = before * share;
        if !far[slot] || node.alike >> slot & 1 == 0 {
            return (probability, false);
        }
        let [from, to] = [node.ends[slot], node.ends[slot + 1]];
        (probability / (to - from) as f32, true)
    }
}

/// Builds a binary tree. The result includes the emitters in the tree's order.
fn build_binary(emitters: &[LightBounds]) -> (Vec<BuildNode>, Vec<u32>) {
    let mut order: Vec<u32> = (0..emitters.len() as u32).filter(|&i| emitters[i as usize].power > 0.0).collect();
    if order.is_empty() {
        return (Vec::new(), order);
    }
    let mut halves = vec![BuildNode { bounds: emitters[order[0] as usize], first: 0, range: (0, order.len() as u32) }];
    let mut open = vec![0];
    while let Some(node) = open.pop() {
        let (start, end) = halves[node].range;
        let range = &mut order[start as usize..end as usize];
        let whole = range.iter().map(|&i| emitters[i as usize]).reduce(|a, b| a.union(&b));
        let Some(whole) = whole else { continue };
        halves[node].bounds = whole;
        if halves[node].is_leaf() {
            continue;
        }
        let middle = start + split(emitters, range, &whole) as u32;
        let first = halves.len();
        halves[node].first = first;
        halves.extend([(start, middle), (middle, end)].map(|range| BuildNode { bounds: whole, first: 0, range }));
        open.extend([first + 1, first]);
    }
    (halves, order)
}

/// Splits emitters into two groups such that each group is compact, has little power and emits in
/// similar directions. Returns the number of emitters in the first group.
fn split(emitters: &[LightBounds], range: &mut [u32], whole: &LightBounds) -> usize {
    let middle = |i: u32| emitters[i as usize].bounds.center();
    let middles = Aabb::around(range.iter().map(|&i| middle(i)));
    let size = middles.size();
    let mut best: Option<(f32, usize, usize)> = None;
    let bucket = |axis: usize, i: u32| {
        let share = (middle(i)[axis] - middles.min[axis]) / size[axis];
        ((share * BUCKETS as f32) as usize).min(BUCKETS - 1)
    };
    for axis in (0..3).filter(|&axis| size[axis] > 0.0) {
        let mut buckets: [Option<LightBounds>; BUCKETS] = [None; BUCKETS];
        for &i in range.iter() {
            let place = &mut buckets[bucket(axis, i)];
            *place = Some(place.map_or(emitters[i as usize], |known| known.union(&emitters[i as usize])));
        }
        let join = |a: Option<LightBounds>, b: Option<LightBounds>| match (a, b) {
            (Some(a), Some(b)) => Some(a.union(&b)),
            (a, b) => a.or(b),
        };
        let mut above = [None; BUCKETS];
        for i in (0..BUCKETS - 1).rev() {
            above[i] = join(above[i + 1], buckets[i + 1]);
        }
        let mut below = None;
        for i in 0..BUCKETS - 1 {
            below = join(below, buckets[i]);
            let (Some(low), Some(high)) = (below, above[i]) else { continue };
            // Prefer splits across the longest side of a long box.
            let stretch = whole.bounds.size().max_element() / whole.bounds.size()[axis];
            let cost = stretch * (cost(&low) + cost(&high));
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, i));
            }
        }
    }
    let half = range.len() / 2;
    let Some((_, axis, last)) = best else { return half };
    // The partition is stable so that the tree is reproducible.
    let (low, high): (Vec<u32>, Vec<u32>) = range.iter().partition(|&&i| bucket(axis, i) <= last);
    range[..low.len()].copy_from_slice(&low);
    range[low.len()..].copy_from_slice(&high);
    low.len()
}

/// Returns the cost of a node, which is power times solid angle of emission times surface area.
fn cost(b: &LightBounds) -> f32 {
    let (normals, emission) = (angle(b.cos_normals), angle(b.cos_emission));
    let wide = (normals + emission).min(PI);
    let sine = sine(b.cos_normals);
    let measure = 2.0 * PI * (1.0 - b.cos_normals)
        + 0.5 * PI * (2.0 * wide * sine - fp::cos(normals - 2.0 * wide) - 2.0 * normals * sine + b.cos_normals);
    b.power * measure.max(0.0) * b.bounds.half_area().max(f32::MIN_POSITIVE)
}

#[cfg(test)]
mod tests;
