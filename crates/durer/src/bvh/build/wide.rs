//! Eight-wide nodes from a binary tree, at the least cost by the surface area heuristic.
//!
//! The cost of a subtree as a forest of at most i roots follows from those of its two children:
//!
//!   C(n, 1) = min(leaf(n), A(n) + min over k of C(l, k) + C(r, 8 - k)),
//!   C(n, i) = min(C(n, i - 1), min over k of C(l, k) + C(r, i - k)).
//!
//! Source: Ylitie, Karras, Laine, *Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs*, HPG 2017.

use super::Reference;
use super::Settings;
use super::binary::{self, half_area};
use crate::bvh::lanes::WIDTH;
use crate::bvh::node::{self, Node};
use crate::math::Aabb;

/// Subtrees of more references than this are worked on in parallel.
const PARALLEL: u32 = 4096;

/// Costs of a subtree as a forest of at most 1, 2, ... 7 roots.
type Costs = [f32; WIDTH - 1];

pub fn collapse(tree: &binary::Tree, references: &[Reference], settings: &Settings) -> (Vec<Node>, Vec<u32>) {
    let mut costs = vec![[0.0; WIDTH - 1]; tree.nodes.len()];
    fill_costs(&tree.nodes, &mut costs, tree.scale, settings);
    let mut emitter = Emitter {
        tree,
        references,
        costs,
        settings,
        nodes: Vec::with_capacity(tree.nodes.len() / 24 + 1),
        order: Vec::with_capacity(references.len()),
    };
    // A tree of one leaf still needs a node to hold it.
    emitter.nodes.push(Node::EMPTY);
    emitter.fill(0, 0);
    (emitter.nodes, emitter.order)
}

/// Least costs of two children's forests with so many roots together, and how many of them are the left one's.
fn shared(left: &Costs, right: &Costs, roots: usize) -> (f32, usize) {
    let most = WIDTH - 1;
    (roots.saturating_sub(most).max(1)..=(roots - 1).min(most))
        .map(|k| (left[k - 1] + right[roots - k - 1], k))
        .fold((f32::INFINITY, 1), |best, c| if c.0 < best.0 { c } else { best })
}

fn leaf_cost(node: &binary::Node, area: f32, settings: &Settings) -> f32 {
    let count = node.count() as usize;
    if count <= settings.leaf_size { area * (settings.leaf_cost)(count) } else { f32::INFINITY }
}

fn fill_costs(nodes: &[binary::Node], costs: &mut [Costs], scale: f32, settings: &Settings) {
    let node = &nodes[0];
    let area = half_area(node.min, node.max, scale);
    let leaf = leaf_cost(node, area, settings);
    if node.count() == 1 {
        costs[0] = [leaf; WIDTH - 1];
        return;
    }
    let (own, rest) = costs.split_first_mut().expect("there is a node");
    let left_size = 2 * nodes[1].count() as usize - 1;
    let (left, right) = rest.split_at_mut(left_size);
    let (left_nodes, right_nodes) = nodes[1..].split_at(left_size);
    if node.count() > PARALLEL {
        rayon::join(
            || fill_costs(left_nodes, left, scale, settings),
            || fill_costs(right_nodes, right, scale, settings),
        );
    } else {
        fill_costs(left_nodes, left, scale, settings);
        fill_costs(right_nodes, right, scale, settings);
    }
    own[0] = leaf.min(area + shared(&left[0], &right[0], WIDTH).0);
    for roots in 2..WIDTH {
        own[roots - 1] = own[roots - 2].min(shared(&left[0], &right[0], roots).0);
    }
}

struct Emitter<'a> {
    tree: &'a binary::Tree,
    references: &'a [Reference],
    costs: Vec<Costs>,
    settings: &'a Settings,
    nodes: Vec<Node>,
    order: Vec<u32>,
}

/// Binary nodes that become the children of a wide one.
struct Children {
    list: [usize; WIDTH],
    count: usize,
}

impl Emitter<'_> {
    fn split(&self, i: usize) -> (usize, usize) {
        (i + 1, i + 2 * self.tree.nodes[i + 1].count() as usize)
    }

    /// The children of a node that is opened.
    fn open(&self, i: usize) -> Children {
        let mut children = Children { list: [0; WIDTH], count: 0 };
        if self.tree.nodes[i].count() == 1 {
            self.forest(i, 1, &mut children);
            return children;
        }
        let (left, right) = self.split(i);
        let (_, k) = shared(&self.costs[left], &self.costs[right], WIDTH);
        self.forest(left, k, &mut children);
        self.forest(right, WIDTH - k, &mut children);
        children
    }

    /// Adds a subtree's best forest of at most so many roots.
    fn forest(&self, i: usize, mut roots: usize, children: &mut Children) {
        let costs = &self.costs[i];
        while roots > 1 && costs[roots - 1] >= costs[roots - 2] {
            roots -= 1;
        }
        if roots == 1 {
            children.list[children.count] = i;
            children.count += 1;
            return;
        }
        let (left, right) = self.split(i);
        let (_, k) = shared(&self.costs[left], &self.costs[right], roots);
        self.forest(left, k, children);
        self.forest(right, roots - k, children);
    }

    /// Fills a node with the children of a binary one, and all below.
    ///
    /// What a ray is likely to need together lies together: first the leaves of a node, then its inner children, side
    /// by side, and then what is below each of them.
    fn fill(&mut self, number: usize, i: usize) {
        let children = self.open(i);
        let list = &children.list[..children.count];
        let bounds: Vec<Aabb> = list.iter().map(|&i| self.tree.nodes[i].bounds()).collect();
        let (axis, places) = places(&bounds);
        self.nodes[number].axis = 1 << axis;
        let (leaves, inner): (Vec<usize>, Vec<usize>) = (0..list.len()).partition(|&k| self.is_leaf(list[k]));
        for &k in &leaves {
            let leaf = self.leaf(list[k]);
            self.nodes[number].set(places[k], bounds[k], leaf);
        }
        let first = self.nodes.len();
        self.nodes.resize(first + inner.len(), Node::EMPTY);
        for (offset, &k) in inner.iter().enumerate() {
            self.nodes[number].set(places[k], bounds[k], (first + offset) as u32);
        }
        for (offset, &k) in inner.iter().enumerate() {
            self.fill(first + offset, list[k]);
        }
    }

    fn is_leaf(&self, i: usize) -> bool {
        let node = &self.tree.nodes[i];
        let count = node.count() as usize;
        let area = half_area(node.min, node.max, self.tree.scale);
        // Where costs are no numbers, as with infinite areas, small subtrees are leaves.
        let dearer = self.costs[i][0] < leaf_cost(node, area, self.settings);
        count == 1 || (count <= self.settings.leaf_size && !dearer)
    }

    /// Writes a leaf of everything below a binary node.
    fn leaf(&mut self, i: usize) -> u32 {
        let count = self.tree.nodes[i].count() as usize;
        let below = &self.tree.nodes[i..i + 2 * count - 1];
        let items = below.iter().filter(|node| node.count() == 1).map(|node| node.item() as usize);
        let mut items: Vec<u32> = items.map(|item| self.references[item].number()).collect();
        // Parts of a thing that was cut, when together again, count once.
        items.sort_unstable();
        items.dedup();
        let first = self.order.len();
        self.order.extend(&items);
        node::leaf(first, items.len())
    }
}

/// The axis along which children lie apart best, and a place for each in that order.
///
/// Two that are apart are met in the right order by every ray; that they both are met is the likelier the greater they are.
fn places(bounds: &[Aabb]) -> (usize, Vec<usize>) {
    let greatest = bounds.iter().map(Aabb::half_area).fold(f32::MIN_POSITIVE, f32::max);
    let apart = |axis: usize| -> f32 {
        let pairs = bounds.iter().enumerate().flat_map(|(i, a)| bounds[i + 1..].iter().map(move |b| (a, b)));
        let apart = pairs.filter(|(a, b)| a.max[axis] <= b.min[axis] || b.max[axis] <= a.min[axis]);
        apart.map(|(a, b)| a.half_area() / greatest * (b.half_area() / greatest)).sum()
    };
    let axis = (1..3).fold((0, apart(0)), |best, axis| if apart(axis) > best.1 { (axis, apart(axis)) } else { best }).0;
    let mut order: Vec<usize> = (0..bounds.len()).collect();
    order.sort_by(|&a, &b| bounds[a].center()[axis].total_cmp(&bounds[b].center()[axis]));
    let mut places = vec![0; bounds.len()];
    order.into_iter().enumerate().for_each(|(place, child)| places[child] = place);
    (axis, places)
}
