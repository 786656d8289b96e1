//! Collapses a binary tree into nodes with eight children, with minimal cost by the surface area
//! heuristic.
//!
//! The cost C(n, i) of turning a subtree n into a forest of at most i roots is computed from the
//! costs of its children l and r:
//!
//!   C(n, 1) = leaf(n) or A(n) + M + min over k of C(l, k) + C(r, 8 - k),
//!   C(n, i) = min(C(n, i - 1), min over k of C(l, k) + C(r, i - k)).
//!
//! C(n, 1) has the second value if that value without M is less than leaf(n).
//!
//! Source: Ylitie, Karras, Laine, *Efficient Incoherent Ray Traversal on GPUs Through Compressed
//! Wide BVHs*, HPG 2017.

use super::binary;
use super::builder::half_area;
use super::settings::BuildSettings;
use crate::lanes::{WIDTH, parallel_vec, vec_on_large_pages};
use crate::math::Aabb;
use crate::node::{self, LEAF, LEAF_SIZE, WideNode};
use crate::parallel;
use glam::Vec3A;

/// Number of references above which subtrees are processed in parallel.
const PARALLEL: usize = 4096;

/// Plan for collapsing a binary tree into nodes with eight children: the cheapest choice for each
/// binary node, and the total cost.
pub struct CollapsePlan {
    plans: Vec<Plan>,
    pub cost: f32,
}

impl CollapsePlan {
    pub fn new(nodes: &[binary::BinaryNode], scale: f32, settings: &BuildSettings) -> Self {
        let mut plans = parallel_vec(nodes.len(), 0, |_| Plan::default());
        let all = half_area(nodes[0].min, nodes[0].max, scale);
        let node_cost = settings.memory_cost * all / nodes[0].count() as f32;
        let cost = plan(nodes, &mut plans, &CostParameters { scale, node_cost, settings })[0];
        CollapsePlan { plans, cost }
    }
}

/// Builds the wide nodes and lists the primitives of their leaves. `numbers` holds the primitive
/// numbers in the order of the binary tree's leaves.
pub fn collapse(tree: &binary::BinaryTree, numbers: &[u32], plans: CollapsePlan) -> (Vec<WideNode>, Vec<u32>) {
    let writer = NodeWriter { tree, numbers, plans: plans.plans };
    let mut cuts = CutPoints::default();
    writer.cuts(0, &mut cuts);
    let subtrees: Vec<SubtreeNodes> = parallel::map(&cuts.below, |&i| writer.subtree(i));
    let count = cuts.above + subtrees.iter().map(|subtree| subtree.nodes.len()).sum::<usize>();
    let mut all = SubtreeNodes { nodes: vec_on_large_pages(count), order: vec_on_large_pages(writer.node(0).count()) };
    // A tree that consists of one leaf still needs a node.
    all.nodes.push(WideNode::EMPTY);
    writer.fill(&mut all, 0, 0, &mut subtrees.iter());
    (all.nodes, all.order)
}

/// Costs of a subtree when it becomes a forest of at most 1, 2, ..., 7 roots.
type Costs = [f32; WIDTH - 1];

/// Cheapest way to collapse the subtree of a binary node, for each number of roots. Bit 0 is set if
/// the subtree becomes a leaf. The three bits starting at bit 3 i hold the number of roots in the
/// left child if the subtree has at most i roots. They are 0 if fewer roots do not cost more.
#[derive(Clone, Copy, Default)]
struct Plan(u32);

impl Plan {
    fn is_leaf(self) -> bool {
        self.0 & 1 == 1
    }

    fn left(self, roots: usize) -> usize {
        (self.0 >> (3 * roots) & 7) as usize
    }

    fn set_left(&mut self, roots: usize, left: usize) {
        self.0 |= (left as u32) << (3 * roots);
    }
}

/// Returns the minimal cost of two children's forests with `roots` roots in total, and the number
/// of roots in the left child.
#[inline(always)]
fn split_roots(left: &Costs, right: &Costs, roots: usize) -> (f32, usize) {
    let most = WIDTH - 1;
    let mut best = (f32::INFINITY, 1);
    for k in roots.saturating_sub(most).max(1)..=(roots - 1).min(most) {
        let cost = left[k - 1] + right[roots - k - 1];
        best = if cost < best.0 { (cost, k) } else { best };
    }
    best
}

/// Parameters of the cost function that decides how a binary tree is collapsed.
struct CostParameters<'a> {
    /// Factor by which sizes are multiplied before areas are computed.
    scale: f32,
    /// Cost of the memory of a node.
    node_cost: f32,
    settings: &'a BuildSettings,
}

/// Finds the cheapest choices for all nodes of a subtree.
fn plan(nodes: &[binary::BinaryNode], plans: &mut [Plan], prices: &CostParameters) -> Costs {
    let (node, &CostParameters { scale, node_cost, settings }) = (&nodes[0], prices);
    let (area, count) = (half_area(node.min, node.max, scale), node.count());
    let leaf = if count <= settings.leaf_size { area * (settings.leaf_cost)(count) } else { f32::INFINITY };
    if node.is_leaf() {
        plans[0] = Plan(1);
        return [leaf; WIDTH - 1];
    }
    let (own, rest) = plans.split_first_mut().expect("there is a node");
    let (left_plans, right_plans) = rest.split_at_mut(node.right() - 1);
    let (left_nodes, right_nodes) = nodes[1..].split_at(node.right() - 1);
    let (left, right) = if count > PARALLEL {
        parallel::join(|| plan(left_nodes, left_plans, prices), || plan(right_nodes, right_plans, prices))
    } else {
        (plan(left_nodes, left_plans, prices), plan(right_nodes, right_plans, prices))
    };
    // The number of roots is limited by the number of references.
    let most = count.min(WIDTH);
    let (opened, k) = split_roots(&left, &right, most);
    own.set_left(WIDTH, k);
    let opened = area + opened;
    // If costs are NaN, for example for infinite areas, small subtrees become leaves.
    let opens = opened < leaf;
    let is_leaf = count <= settings.leaf_size && !opens;
    own.0 |= u32::from(is_leaf);
    let mut costs = [if is_leaf { leaf } else { opened + node_cost }; WIDTH - 1];
    for roots in 2..=most.min(WIDTH - 1) {
        let (cost, k) = split_roots(&left, &right, roots);
        if cost < costs[roots - 2] {
            costs[roots - 1..].fill(cost);
            own.set_left(roots, k);
        }
    }
    costs
}

/// Writes wide nodes, given a binary tree and its [`CollapsePlan`].
struct NodeWriter<'a> {
    tree: &'a binary::BinaryTree,
    numbers: &'a [u32],
    plans: Vec<Plan>,
}

/// A finished part of the wide tree: a node, all nodes below it, and the primitives in their
/// leaves. Its offsets and positions start at 0.
struct SubtreeNodes {
    nodes: Vec<WideNode>,
    order: Vec<u32>,
}

/// The binary nodes, at most eight, that become the children of one wide node.
#[derive(Default)]
struct Children {
    list: [usize; WIDTH],
    count: usize,
}

/// Binary nodes at which the tree is divided into subtrees for parallel work, and the number of
/// wide nodes above them.
#[derive(Default)]
struct CutPoints {
    above: usize,
    below: Vec<usize>,
}

impl NodeWriter<'_> {
    fn node(&self, i: usize) -> &binary::BinaryNode {
        &self.tree.nodes[i]
    }

    /// Returns the children of the wide node that replaces a binary node.
    fn open(&self, i: usize) -> Children {
        let mut children = Children::default();
        match self.node(i).is_leaf() {
            true => self.forest(i, 1, &mut children),
            false => self.split(i, WIDTH, &mut children),
        }
        children
    }

    /// Adds the cheapest forest of a subtree with at most `roots` roots.
    fn forest(&self, i: usize, mut roots: usize, children: &mut Children) {
        while roots > 1 && self.plans[i].left(roots) == 0 {
            roots -= 1;
        }
        if roots > 1 {
            return self.split(i, roots, children);
        }
        children.list[children.count] = i;
        children.count += 1;
    }

    /// Adds the forests of both children of a node.
    fn split(&self, i: usize, roots: usize, children: &mut Children) {
        let left = self.plans[i].left(roots);
        self.forest(i + 1, left, children);
        self.forest(i + self.node(i).right(), roots - left, children);
    }

    /// Finds the topmost nodes that have too few references to be divided further for parallel
    /// work, in the order of [`NodeWriter::fill`].
    fn cuts(&self, i: usize, cuts: &mut CutPoints) {
        if self.node(i).count() <= PARALLEL {
            return cuts.below.push(i);
        }
        cuts.above += 1;
        let children = self.open(i);
        let inner = children.list[..children.count].iter().filter(|&&i| !self.plans[i].is_leaf());
        inner.for_each(|&i| self.cuts(i, cuts));
    }

    /// Builds the wide node for a binary node and all nodes below it.
    fn subtree(&self, i: usize) -> SubtreeNodes {
        let count = self.node(i).count();
        let mut subtree = SubtreeNodes { nodes: Vec::with_capacity(count / 16 + 1), order: Vec::with_capacity(count) };
        subtree.nodes.push(WideNode::EMPTY);
        self.fill(&mut subtree, 0, i, &mut [].iter());
        subtree
    }

    /// Fills in the wide node for a binary node, and adds all nodes below it. Subtrees are taken
    /// from `ready` until it is empty.
    fn fill(&self, all: &mut SubtreeNodes, number: usize, i: usize, ready: &mut std::slice::Iter<SubtreeNodes>) {
        if self.node(i).count() <= PARALLEL
            && let Some(subtree) = ready.next()
        {
            return all.append(number, subtree);
        }
        let (first, inner) = self.wide(all, number, i);
        for (offset, &i) in inner.list[..inner.count].iter().enumerate() {
            self.fill(all, first + offset, i, ready);
        }
    }

    /// Fills in the wide node that replaces a binary node. Returns the position reserved for its
    /// inner children, and the binary nodes of these children.
    ///
    /// Data that a ray is likely to need together is stored together. The leaves of a node come
    /// first, then its inner children side by side, then the nodes below each of those children.
    fn wide(&self, subtree: &mut SubtreeNodes, number: usize, i: usize) -> (usize, Children) {
        let children = self.open(i);
        let list = &children.list[..children.count];
        let mut bounds = [Aabb::EMPTY; WIDTH];
        bounds.iter_mut().zip(list).for_each(|(bounds, &i)| *bounds = self.node(i).bounds());
        let (reversed_octants, slots) = child_slots(&bounds[..list.len()]);
        subtree.nodes[number].reversed_octants = reversed_octants;
        let first = subtree.nodes.len();
        let mut inner = Children::default();
        for (k, &i) in list.iter().enumerate() {
            let child = if self.plans[i].is_leaf() {
                self.leaf(subtree, i)
            } else {
                inner.list[inner.count] = i;
                inner.count += 1;
                subtree.nodes[number].first = node::node_offset(first);
                node::node_offset(first + inner.count - 1)
            };
            subtree.nodes[number].set(slots[k], bounds[k], child);
        }
        subtree.nodes.resize(first + inner.count, WideNode::EMPTY);
        (first, inner)
    }

    /// Writes a leaf with all primitives below a binary node.
    fn leaf(&self, subtree: &mut SubtreeNodes, i: usize) -> u32 {
        let (mut items, mut count) = ([0; LEAF_SIZE], 0);
        let most = self.node(i).count();
        for leaf in self.tree.nodes[i..].iter().filter(|node| node.is_leaf()) {
            let own = &self.numbers[leaf.first()..][..leaf.count()];
            items[count..][..own.len()].copy_from_slice(own);
            count += own.len();
            if count == most {
                break;
            }
        }
        if self.tree.has_splits {
            // If several parts of a split primitive are in the same leaf, they count only once.
            items[..count].sort_unstable();
            let mut different = 1;
            for i in 1..count {
                if items[i] != items[different - 1] {
                    items[different] = items[i];
                    different += 1;
                }
            }
            count = different;
        }
        let first = subtree.order.len();
        subtree.order.extend_from_slice(&items[..count]);
        node::leaf(first, count)
    }
}

impl SubtreeNodes {
    /// Copies the root of a subtree to position `number`, and appends its other nodes.
    fn append(&mut self, number: usize, other: &SubtreeNodes) {
        // Checks that the offset of the last node is within the allowed range.
        node::node_offset(self.nodes.len() + other.nodes.len() - 2);
        let (nodes, items) = (node::node_offset(self.nodes.len() - 1), self.order.len() as u32);
        let moved = |node: &WideNode| {
            let mut moved = *node;
            moved.first += nodes;
            for (place, _, child) in node.children() {
                moved.children[place] += if child & LEAF == 0 { nodes } else { items };
            }
            moved
        };
        let mut moved = other.nodes.iter().map(moved);
        self.nodes[number] = moved.next().expect("a subtree starts with its root");
        self.nodes.extend(moved);
        self.order.extend_from_slice(&other.order);
    }
}

/// Returns the value of [`WideNode::from_last`] for children sorted along an axis, given the areas
/// of the first and last child.
///
/// Closest-hit rays visit children from near to far. Any-hit rays visit them from far to near. The
/// reason is that a ray usually starts on a surface, and this surface is then the nearest geometry.
/// If the farthest box is much smaller than the nearest one, a hit there is less likely, and
/// any-hit rays also go from near to far.
fn reversed_octants(axis: usize, [first, last]: [f32; 2]) -> [u32; 2] {
    const NEGATIVE: [u32; 3] = [0b1010_1010, 0b1100_1100, 0b1111_0000];
    const SMALL: f32 = 0.5;
    let negative = NEGATIVE[axis];
    let any = if last < SMALL * first { 0 } else { !negative } | if first < SMALL * last { negative } else { 0 };
    [negative, any & 255]
}

/// Returns the value of [`WideNode::from_last`] and a slot for each child.
///
/// Children are sorted along the axis that separates them best. Every ray visits two children in
/// the right order if they are separated along that axis. The larger the two are, the more likely a
/// ray is to hit both.
fn child_slots(bounds: &[Aabb]) -> ([u32; 2], [usize; WIDTH]) {
    let mut areas = [0.0; WIDTH];
    areas.iter_mut().zip(bounds).for_each(|(area, bounds)| *area = bounds.half_area());
    let greatest = areas.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
    let mut apart = Vec3A::ZERO;
    for (i, a) in bounds.iter().enumerate() {
        let (min, max, area) = (Vec3A::from(a.min), Vec3A::from(a.max), areas[i] / greatest);
        for (b, other) in bounds[..i].iter().zip(areas) {
            let are_apart = max.cmple(b.min.into()) | Vec3A::from(b.max).cmple(min);
            apart += Vec3A::select(are_apart, Vec3A::splat(area * other / greatest), Vec3A::ZERO);
        }
    }
    let axis = (1..3).fold(0, |best, axis| if apart[axis] > apart[best] { axis } else { best });
    // If two axes are equally good, the children keep their order.
    let mut slots = [0; WIDTH];
    for (i, a) in bounds.iter().enumerate() {
        let center = a.center()[axis];
        for (j, b) in bounds[..i].iter().enumerate() {
            let after = b.center()[axis].total_cmp(&center).is_gt();
            slots[if after { j } else { i }] += 1;
        }
    }
    let ends = [0, bounds.len() - 1].map(|end| {
        let child = slots.iter().position(|slot| *slot == end);
        areas[child.expect("each slot is in use")]
    });
    (reversed_octants(axis, ends), slots)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If two children are separated along an axis, closest-hit rays visit the nearer one first.
    /// Any-hit rays visit the farther one first, unless it is less than half as large as the nearer
    /// one.
    #[test]
    fn children_are_in_traversal_order() {
        let child = |axis: usize, at: f32, size: f32| {
            let (mut min, mut max) = ([0.0; 3], [size; 3]);
            (min[axis], max[axis]) = (at, at + size);
            Aabb { min: min.into(), max: max.into() }
        };
        // Returns the sizes of the lower and upper child, and a flag for each that is true if it is
        // small compared to the other.
        let pairs =
            [(1.0, 1.0, [false; 2]), (1.0, 0.9, [false; 2]), (0.5, 1.0, [true, false]), (1.0, 0.5, [false, true])];
        for (axis, (lower, upper, small)) in (0..3).flat_map(|axis| pairs.map(|pair| (axis, pair))) {
            for (swapped, octant) in [false, true].into_iter().flat_map(|swapped| (0..8).map(move |o| (swapped, o))) {
                let mut bounds = [child(axis, -2.0, lower), child(axis, 2.0, upper)];
                if swapped {
                    bounds.reverse();
                }
                let (reversed_octants, slots) = child_slots(&bounds);
                assert_eq!(slots[..2], if swapped { [1, 0] } else { [0, 1] });
                let negative = octant >> axis & 1;
                let far = 1 - negative;
                let first = if small[far] { negative } else { far };
                let expected = [negative, first].map(|first| first as u32);
                assert_eq!(
                    reversed_octants.map(|octants| octants >> octant & 1),
                    expected,
                    "{axis} {lower} {upper} {octant}"
                );
            }
        }
    }
}
