//! A tree over emitters, to choose one of many by what it may bring to a point.
//!
//! Source: Conty Estévez and Kulla, *Importance Sampling of Many Lights with Adaptive Tree
//! Splitting*, HPG 2018, with the bounds of *Physically Based Rendering*, 4th edition, section
//! 12.6.3. Nodes have eight children, which are weighed together: fewer steps, and each choice is
//! among smaller groups.

use crate::math::{Aabb, Vec3, fp};
use glam::Vec4;
use std::f32::consts::PI;

/// Where some emitters are, how strong they are, and where they shine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Where they are.
    pub bounds: Aabb,
    /// Their power together, in any one unit.
    pub power: f32,
    /// The middle of their normals.
    pub axis: Vec3,
    /// Cosine of the greatest angle between that and a normal.
    pub cos_normals: f32,
    /// Cosine of the greatest angle between a normal and the light.
    pub cos_emission: f32,
    /// Whether they shine to both sides.
    pub two_sided: bool,
}

impl Bounds {
    fn union(&self, other: &Bounds) -> Bounds {
        let (axis, cos_normals) = cone_union((self.axis, self.cos_normals), (other.axis, other.cos_normals));
        Bounds {
            bounds: self.bounds.union(other.bounds),
            power: self.power + other.power,
            axis,
            cos_normals,
            cos_emission: self.cos_emission.min(other.cos_emission),
            two_sided: self.two_sided || other.two_sided,
        }
    }
}

fn sine_of(cosine: f32) -> f32 {
    (1.0 - cosine * cosine).max(0.0).sqrt()
}

fn angle(cosine: f32) -> f32 {
    fp::atan2(sine_of(cosine), cosine)
}

/// The least cone around two cones.
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

/// How much the cosines at the middle of a node count for all of it, beside the greatest anywhere
/// in it: these alone are far too much for wide nodes that are seen from the side.
const CENTER: f32 = 0.8;

/// Children of a node.
const WIDTH: usize = 8;

/// One number for each child, four and four.
type Eight = [Vec4; 2];

/// A node: what its children hold, each number for all of them, so that they are weighed in lanes.
#[derive(Clone, Debug)]
struct Node {
    middle: [Eight; 3],
    /// The square of the radius around the middle, and what of it is added to that of a distance.
    radius2: Eight,
    spread2: Eight,
    /// 0 where there is no child.
    power: Eight,
    axis: [Eight; 3],
    cos_normals: Eight,
    sin_normals: Eight,
    cos_emission: Eight,
    /// 1 where they shine to both sides, else 0.
    two_sided: Eight,
    children: [Child; WIDTH],
    /// The node above, and which of its children this is.
    parent: (u32, u8),
}

#[derive(Clone, Copy, Debug)]
enum Child {
    None,
    Node(u32),
    Emitter(u32),
}

impl Node {
    fn new(parent: (u32, u8), held: &[Bounds]) -> Self {
        let of = |number: &dyn Fn(&Bounds) -> f32| {
            let lanes: [f32; WIDTH] = std::array::from_fn(|i| held.get(i).map_or(0.0, number));
            [Vec4::from_slice(&lanes[..4]), Vec4::from_slice(&lanes[4..])]
        };
        let radius2 = |b: &Bounds| (0.5 * b.bounds.size()).length_squared();
        Node {
            middle: [0, 1, 2].map(|axis| of(&|b| b.bounds.center()[axis])),
            radius2: of(&radius2),
            // Over the middle of an even disc, its mean of 1 / distance^2 with both cosines is 1 /
            // (d^2 + r^2). A square whose corners are at the radius has 0.64 of the area of such a
            // disc.
            spread2: of(&|b| (0.64 * radius2(b)).max(f32::MIN_POSITIVE)),
            power: of(&|b| b.power),
            axis: [0, 1, 2].map(|axis| of(&|b| b.axis[axis])),
            cos_normals: of(&|b| b.cos_normals),
            sin_normals: of(&|b| sine_of(b.cos_normals)),
            cos_emission: of(&|b| b.cos_emission),
            two_sided: of(&|b| f32::from(b.two_sided)),
            children: [Child::None; WIDTH],
            parent,
        }
    }

    /// Estimates of what four children bring to a point with a normal; more than zero wherever one
    /// brings any light.
    fn importances(&self, half: usize, p: Vec3, n: Vec3) -> Vec4 {
        let (one, zero) = (Vec4::ONE, Vec4::ZERO);
        let [x, y, z] = [0, 1, 2].map(|axis| Vec4::splat(p[axis]) - self.middle[axis][half]);
        let distance2 = x * x + y * y + z * z;
        let inverse = Vec4::select(distance2.cmpgt(zero), one / root(distance2), zero);
        let [x, y, z] = [x, y, z].map(|offset| offset * inverse);
        let dot = |[a, b, c]: [Vec4; 3]| a * x + b * y + c * z;
        let cosine = dot(self.axis.map(|axis| axis[half]));
        let cosine = Vec4::select(self.two_sided[half].cmpgt(zero), cosine.abs(), cosine);
        let inside = distance2.cmple(self.radius2[half]);
        let sine2 = Vec4::select(inside, zero, self.radius2[half] / distance2);
        let bounds = (Vec4::select(inside, -one, root(one - sine2)), root(sine2));
        // The least angle to a normal, and from that to the point, over all that the bounds hold.
        let least = minus((cosine, sine(cosine)), (self.cos_normals[half], self.sin_normals[half]));
        let (cos_least, _) = minus(least, bounds);
        let usual = |center: Vec4, most: Vec4| CENTER * center.max(zero) + (1.0 - CENTER) * most;
        let mut importance = self.power[half] * usual(least.0, cos_least) / (distance2 + self.spread2[half]);
        if n != Vec3::ZERO {
            let arriving = dot(n.to_array().map(Vec4::splat)).abs();
            let (cos_arriving, _) = minus((arriving, sine(arriving)), bounds);
            importance *= usual(arriving, cos_arriving.max(zero));
        }
        Vec4::select(cos_least.cmple(self.cos_emission[half]), zero, importance.max(zero))
    }

    /// The probabilities of its children; `None` where none brings any light.
    fn shares(&self, p: Vec3, n: Vec3) -> Option<[f32; WIDTH]> {
        let few = matches!(self.children[WIDTH / 2], Child::None);
        let high = if few { Vec4::ZERO } else { self.importances(1, p, n) };
        let importances = [self.importances(0, p, n), high];
        let sum = (importances[0] + importances[1]).element_sum();
        (sum > 0.0 && sum.is_finite()).then(|| {
            let [low, high] = importances.map(|four| (four / sum).to_array());
            std::array::from_fn(|i| if i < 4 { low[i] } else { high[i - 4] })
        })
    }
}

fn root(x: Vec4) -> Vec4 {
    let [a, b, c, d] = x.to_array();
    Vec4::new(a.sqrt(), b.sqrt(), c.sqrt(), d.sqrt())
}

fn sine(cosine: Vec4) -> Vec4 {
    root((Vec4::ONE - cosine * cosine).max(Vec4::ZERO))
}

/// Cosine and sine of the difference of two angles, not less than 0.
fn minus((cos_a, sin_a): (Vec4, Vec4), (cos_b, sin_b): (Vec4, Vec4)) -> (Vec4, Vec4) {
    let less = cos_a.cmpgt(cos_b);
    let difference = (cos_a * cos_b + sin_a * sin_b, sin_a * cos_b - cos_a * sin_b);
    (Vec4::select(less, Vec4::ONE, difference.0), Vec4::select(less, Vec4::ZERO, difference.1))
}

/// The tree.
#[derive(Clone, Debug, Default)]
pub struct LightTree {
    nodes: Vec<Node>,
    /// The node that holds each emitter, and which of its children it is; `None` where it has no
    /// power.
    leaves: Vec<Option<(u32, u8)>>,
}

/// A node of the tree of two children that is built first: they follow each other from `first` on,
/// or it is the emitter `first`.
struct Half {
    bounds: Bounds,
    first: usize,
    is_leaf: bool,
}

const BUCKETS: usize = 12;

impl LightTree {
    /// Over emitters; those without power are never chosen.
    pub fn new(emitters: &[Bounds]) -> Self {
        let mut tree = LightTree { nodes: Vec::new(), leaves: vec![None; emitters.len()] };
        let halves = halved(emitters);
        let Some(root) = halves.first() else { return tree };
        let mut open = vec![(if root.is_leaf { vec![0] } else { vec![root.first, root.first + 1] }, (0, 0))];
        while let Some((mut held, parent)) = open.pop() {
            // The largest are opened until there is no more room.
            while held.len() < WIDTH {
                let inner = (0..held.len()).filter(|&i| !halves[held[i]].is_leaf);
                let largest = inner.max_by(|&a, &b| {
                    let [a, b] = [a, b].map(|i| cost(&halves[held[i]].bounds));
                    a.total_cmp(&b)
                });
                let Some(i) = largest else { break };
                let first = halves[held[i]].first;
                held.splice(i..=i, [first, first + 1]);
            }
            let number = tree.nodes.len() as u32;
            let bounds: Vec<Bounds> = held.iter().map(|&half| halves[half].bounds).collect();
            let mut node = Node::new(parent, &bounds);
            for (slot, half) in (0..).zip(held.iter().map(|&half| &halves[half])) {
                if half.is_leaf {
                    node.children[usize::from(slot)] = Child::Emitter(half.first as u32);
                    tree.leaves[half.first] = Some((number, slot));
                } else {
                    open.push((vec![half.first, half.first + 1], (number, slot)));
                }
            }
            if number > 0 {
                let (above, slot) = node.parent;
                tree.nodes[above as usize].children[usize::from(slot)] = Child::Node(number);
            }
            tree.nodes.push(node);
        }
        tree
    }

    /// Whether there is nothing to choose.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// About what irradiance all of it brings to a point with a normal (zero: any).
    pub fn importance(&self, p: Vec3, n: Vec3) -> f32 {
        let Some(root) = self.nodes.first() else { return 0.0 };
        (root.importances(0, p, n) + root.importances(1, p, n)).element_sum()
    }

    /// Chooses an emitter for a point with a normal (zero: any) by a number from 0 to 1; with its
    /// probability.
    pub fn sample(&self, p: Vec3, n: Vec3, u: f32) -> Option<(u32, f32)> {
        let (mut node, mut rest, mut probability) = (self.nodes.first()?, u, 1.0);
        loop {
            let shares = node.shares(p, n)?;
            // The last that has a share takes what rounding leaves.
            let last = shares.iter().rposition(|&share| share > 0.0)?;
            let (mut slot, mut before) = (0, 0.0);
            while slot < last && (shares[slot] == 0.0 || rest >= before + shares[slot]) {
                before += shares[slot];
                slot += 1;
            }
            rest = ((rest - before) / shares[slot]).clamp(0.0, 1.0 - f32::EPSILON * 0.5);
            probability *= shares[slot];
            match node.children[slot] {
                Child::Node(next) => node = &self.nodes[next as usize],
                Child::Emitter(emitter) => return Some((emitter, probability)),
                Child::None => return None,
            }
        }
    }

    /// The probability with which [`LightTree::sample`] chooses an emitter.
    pub fn probability(&self, p: Vec3, n: Vec3, emitter: u32) -> f32 {
        let Some((mut place, mut slot)) = self.leaves.get(emitter as usize).copied().flatten() else { return 0.0 };
        let mut probability = 1.0;
        loop {
            let node = &self.nodes[place as usize];
            let Some(shares) = node.shares(p, n) else { return 0.0 };
            probability *= shares[usize::from(slot)];
            if place == 0 || probability == 0.0 {
                return probability;
            }
            (place, slot) = node.parent;
        }
    }
}

/// A tree of two children a node.
fn halved(emitters: &[Bounds]) -> Vec<Half> {
    let mut order: Vec<u32> = (0..emitters.len() as u32).filter(|&i| emitters[i as usize].power > 0.0).collect();
    if order.is_empty() {
        return Vec::new();
    }
    let mut halves = vec![Half { bounds: emitters[order[0] as usize], first: 0, is_leaf: true }];
    let mut open = vec![(0_usize, 0_usize, order.len())];
    while let Some((node, start, end)) = open.pop() {
        let range = &mut order[start..end];
        let whole = range.iter().map(|&i| emitters[i as usize]).reduce(|a, b| a.union(&b));
        let Some(whole) = whole else { continue };
        halves[node].bounds = whole;
        if let [one] = *range {
            halves[node].first = one as usize;
            continue;
        }
        let middle = start + split(emitters, range, &whole);
        let first = halves.len();
        (halves[node].first, halves[node].is_leaf) = (first, false);
        for _ in 0..2 {
            halves.push(Half { bounds: whole, first: 0, is_leaf: true });
        }
        open.push((first + 1, middle, end));
        open.push((first, start, middle));
    }
    halves
}

/// Divides emitters so that both sides are small, weak and point one way; returns how many come
/// first.
fn split(emitters: &[Bounds], range: &mut [u32], whole: &Bounds) -> usize {
    let middle = |i: u32| emitters[i as usize].bounds.center();
    let middles = Aabb::around(range.iter().map(|&i| middle(i)));
    let size = middles.size();
    let mut best: Option<(f32, usize, usize)> = None;
    let bucket = |axis: usize, i: u32| {
        let share = (middle(i)[axis] - middles.min[axis]) / size[axis];
        ((share * BUCKETS as f32) as usize).min(BUCKETS - 1)
    };
    for axis in (0..3).filter(|&axis| size[axis] > 0.0) {
        let mut buckets: [Option<Bounds>; BUCKETS] = [None; BUCKETS];
        for &i in range.iter() {
            let place = &mut buckets[bucket(axis, i)];
            *place = Some(place.map_or(emitters[i as usize], |known| known.union(&emitters[i as usize])));
        }
        let join = |a: Option<Bounds>, b: Option<Bounds>| match (a, b) {
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
            // Long boxes are better divided across.
            let stretch = whole.bounds.size().max_element() / whole.bounds.size()[axis];
            let cost = stretch * (cost(&low) + cost(&high));
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, i));
            }
        }
    }
    let half = range.len() / 2;
    let Some((_, axis, last)) = best else { return half };
    // The order within each side stays, so that trees are the same everywhere.
    let (low, high): (Vec<u32>, Vec<u32>) = range.iter().partition(|&&i| bucket(axis, i) <= last);
    range[..low.len()].copy_from_slice(&low);
    range[low.len()..].copy_from_slice(&high);
    low.len()
}

/// Power times the solid angle in which it goes times the area that it comes from.
fn cost(b: &Bounds) -> f32 {
    let (normals, emission) = (angle(b.cos_normals), angle(b.cos_emission));
    let wide = (normals + emission).min(PI);
    let sine = sine_of(b.cos_normals);
    let measure = 2.0 * PI * (1.0 - b.cos_normals)
        + 0.5 * PI * (2.0 * wide * sine - fp::cos(normals - 2.0 * wide) - 2.0 * normals * sine + b.cos_normals);
    b.power * measure.max(0.0) * b.bounds.half_area().max(f32::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    fn lights(random: &mut Random, count: usize) -> Vec<Bounds> {
        (0..count)
            .map(|i| {
                let p = 10.0 * random.point();
                Bounds {
                    bounds: Aabb { min: p, max: p + 0.1 },
                    power: random.between(0.0, 2.0) * f32::from(i % 7 != 3),
                    axis: random.direction(),
                    cos_normals: if i % 3 == 0 { -1.0 } else { 1.0 },
                    cos_emission: 0.0,
                    two_sided: i % 5 == 0,
                }
            })
            .collect()
    }

    #[test]
    fn probabilities_are_those_of_sampling_and_sum_to_one() {
        let mut random = Random(5);
        for count in [1, 2, 3, 17, 400] {
            let all = lights(&mut random, count);
            let tree = LightTree::new(&all);
            for _ in 0..20 {
                let (p, n) = (12.0 * random.point(), random.direction());
                let sum: f32 = (0..count as u32).map(|i| tree.probability(p, n, i)).sum();
                // Where a node's children both bring nothing, nothing is chosen.
                assert!(sum < 1.0 + 1e-4, "{sum}");
                for _ in 0..50 {
                    let Some((i, probability)) = tree.sample(p, n, random.between(0.0, 1.0)) else { continue };
                    let again = tree.probability(p, n, i);
                    assert!((again - probability).abs() <= 1e-5 * probability, "{again} {probability}");
                    assert!(all[i as usize].power > 0.0);
                }
            }
        }
    }

    #[test]
    fn whatever_can_shine_on_a_point_can_be_chosen() {
        let mut random = Random(6);
        let all = lights(&mut random, 300);
        let tree = LightTree::new(&all);
        for _ in 0..50 {
            let p = 12.0 * random.point();
            for (i, light) in all.iter().enumerate().filter(|(_, light)| light.power > 0.0) {
                let to_point = p - light.bounds.center();
                let shines = light.cos_normals < 0.0
                    || light.axis.dot(to_point) > 0.2
                    || (light.two_sided && light.axis.dot(to_point).abs() > 0.2);
                let probability = tree.probability(p, Vec3::ZERO, i as u32);
                assert!(!shines || probability > 0.0, "{i} of {light:?} at {p}");
            }
        }
    }
}
