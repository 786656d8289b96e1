//! A tree over emitters, to choose one of many by what it may bring to a point.
//!
//! Source: Conty Estévez and Kulla, *Importance Sampling of Many Lights with Adaptive Tree Splitting*, HPG 2018, with the bounds
//! of *Physically Based Rendering*, 4th edition, section 12.6.3.

use crate::math::{Aabb, Vec3, fp};
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

    /// An estimate of what they bring to a point with a normal; more than zero wherever they bring any light.
    fn importance(&self, p: Vec3, n: Vec3) -> f32 {
        let middle = self.bounds.center();
        let half = 0.5 * self.bounds.size();
        let radius2 = half.length_squared();
        let offset = p - middle;
        let distance2 = offset.length_squared();
        // From inside and nearby distance says little.
        let spread = distance2.max(radius2.sqrt() * 0.5).max(f32::MIN_POSITIVE);
        let from_light = offset.normalize_or(Vec3::Z);
        let cosine = self.axis.dot(from_light);
        let cosine = if self.two_sided { cosine.abs() } else { cosine };
        let sine = sine_of(cosine);
        let (cos_bounds, sin_bounds) = match distance2 <= radius2 {
            true => (-1.0, 0.0),
            false => {
                let sine2 = radius2 / distance2;
                ((1.0 - sine2).sqrt(), sine2.sqrt())
            }
        };
        // The least angle to a normal, and from that to the point, over all that the bounds hold.
        let (cos_x, sin_x) = minus((cosine, sine), (self.cos_normals, sine_of(self.cos_normals)));
        let (cos_least, _) = minus((cos_x, sin_x), (cos_bounds, sin_bounds));
        if cos_least <= self.cos_emission {
            return 0.0;
        }
        let mut importance = self.power * cos_least / spread;
        if n != Vec3::ZERO {
            let cos_arriving = from_light.dot(n).abs();
            importance *= minus((cos_arriving, sine_of(cos_arriving)), (cos_bounds, sin_bounds)).0.max(0.0);
        }
        importance.max(0.0)
    }
}

fn sine_of(cosine: f32) -> f32 {
    (1.0 - cosine * cosine).max(0.0).sqrt()
}

/// Cosine and sine of the difference of two angles, not less than 0.
fn minus((cos_a, sin_a): (f32, f32), (cos_b, sin_b): (f32, f32)) -> (f32, f32) {
    if cos_a > cos_b { (1.0, 0.0) } else { (cos_a * cos_b + sin_a * sin_b, sin_a * cos_b - cos_a * sin_b) }
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

/// A node: its children follow each other from `first` on, or it is the emitter `first`.
#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    first: u32,
    parent: u32,
    is_leaf: bool,
}

/// The tree.
#[derive(Clone, Debug, Default)]
pub struct LightTree {
    nodes: Vec<Node>,
    /// The node of each emitter; `u32::MAX` where it has no power.
    leaves: Vec<u32>,
}

const BUCKETS: usize = 12;

impl LightTree {
    /// Over emitters; those without power are never chosen.
    pub fn new(emitters: &[Bounds]) -> Self {
        let mut order: Vec<u32> = (0..emitters.len() as u32).filter(|&i| emitters[i as usize].power > 0.0).collect();
        let mut tree = LightTree { nodes: Vec::new(), leaves: vec![u32::MAX; emitters.len()] };
        if order.is_empty() {
            return tree;
        }
        tree.nodes.push(Node { bounds: emitters[order[0] as usize], first: 0, parent: 0, is_leaf: true });
        let mut open = vec![(0_usize, 0_usize, order.len())];
        while let Some((node, start, end)) = open.pop() {
            let range = &mut order[start..end];
            let whole = range.iter().map(|&i| emitters[i as usize]).reduce(|a, b| a.union(&b));
            let Some(whole) = whole else { continue };
            tree.nodes[node].bounds = whole;
            if let [one] = *range {
                tree.nodes[node].first = one;
                tree.leaves[one as usize] = node as u32;
                continue;
            }
            let middle = start + split(emitters, range, &whole);
            let first = tree.nodes.len();
            (tree.nodes[node].first, tree.nodes[node].is_leaf) = (first as u32, false);
            for _ in 0..2 {
                tree.nodes.push(Node { bounds: whole, first: 0, parent: node as u32, is_leaf: true });
            }
            open.push((first + 1, middle, end));
            open.push((first, start, middle));
        }
        tree
    }

    /// Whether there is nothing to choose.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Chooses an emitter for a point with a normal (zero: any) by a number from 0 to 1; with its probability.
    pub fn sample(&self, p: Vec3, n: Vec3, u: f32) -> Option<(u32, f32)> {
        let (mut node, mut rest, mut probability) = (self.nodes.first()?, u, 1.0);
        while !node.is_leaf {
            let first = self.first_share(node, p, n)?;
            let children = [&self.nodes[node.first as usize], &self.nodes[node.first as usize + 1]];
            let (share, child) = if rest < first { (first, 0) } else { (1.0 - first, 1) };
            rest = if child == 0 { rest / first } else { (rest - first) / (1.0 - first) };
            rest = rest.clamp(0.0, 1.0 - f32::EPSILON * 0.5);
            (node, probability) = (children[child], probability * share);
        }
        Some((node.first, probability))
    }

    /// The probability with which [`LightTree::sample`] chooses an emitter.
    pub fn probability(&self, p: Vec3, n: Vec3, emitter: u32) -> f32 {
        let mut place = match self.leaves.get(emitter as usize) {
            Some(&place) if place != u32::MAX => place,
            _ => return 0.0,
        };
        let mut probability = 1.0;
        while place != 0 {
            let parent = &self.nodes[self.nodes[place as usize].parent as usize];
            let Some(first) = self.first_share(parent, p, n) else { return 0.0 };
            probability *= if place == parent.first { first } else { 1.0 - first };
            place = self.nodes[place as usize].parent;
        }
        probability
    }

    /// The share of a node's first child; `None` where neither brings any light.
    fn first_share(&self, node: &Node, p: Vec3, n: Vec3) -> Option<f32> {
        let [a, b] = [node.first, node.first + 1].map(|i| self.nodes[i as usize].bounds.importance(p, n));
        let sum = a + b;
        (sum > 0.0 && sum.is_finite()).then(|| a / sum)
    }
}

/// Divides emitters so that both sides are small, weak and point one way; returns how many come first.
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
