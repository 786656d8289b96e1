//! Cutting large triangles before the tree is built, where their boxes are mostly empty.
//!
//! Cuts lie in planes that halve the whole box again and again, so that those of neighbours agree. How often a
//! triangle is cut follows from how much area its box wastes.
//! Source: Karras, Aila, *Fast Parallel Construction of High-Quality Bounding Volume Hierarchies*, HPG 2013, section 4.

use super::Reference;
use crate::math::{Aabb, Vec3};
use glam::DVec3;

/// Adds at most `share` references for each one that is there.
pub fn split(references: &mut Vec<Reference>, corners_of: &(impl Fn(u32) -> [Vec3; 3] + Sync), share: f32) {
    let all = references.iter().fold(Aabb::EMPTY, |b, r| b.union(r.bounds()));
    let planes = Planes { low: all.min.as_dvec3(), size: (all.max.as_dvec3() - all.min.as_dvec3()).max_element() };
    if planes.size <= 0.0 {
        return;
    }
    let priorities: Vec<f64> =
        references.iter().map(|r| priority(&planes, r.bounds(), corners_of(r.number()))).collect();
    let budget = references.len() as f64 * f64::from(share);
    // The factor with which whole parts of all priorities add up to the budget, by halving.
    let (mut low, mut high) = (0.0, budget / priorities.iter().copied().fold(1e-300, f64::max));
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        let sum: f64 = priorities.iter().map(|p| (p * middle).floor()).sum();
        if sum <= budget { low = middle } else { high = middle }
    }
    for i in 0..priorities.len() {
        let cuts = (priorities[i] * low) as u32;
        if cuts > 0 {
            let reference = references[i];
            let corners = corners_of(reference.number());
            let mut parts = Vec::new();
            cut(&planes, corners, reference.bounds(), cuts, &mut parts);
            references[i] = Reference::new(parts[0], reference.number());
            references.extend(parts[1..].iter().map(|b| Reference::new(*b, reference.number())));
        }
    }
}

/// Planes that halve a cube, and its halves, and so on.
struct Planes {
    low: DVec3,
    size: f64,
}

/// A plane, and how many halvings it takes to get there.
struct Plane {
    axis: usize,
    at: f32,
    level: u32,
}

impl Planes {
    /// The first plane that goes through a box.
    fn first_through(&self, b: Aabb) -> Option<Plane> {
        let mut best: Option<Plane> = None;
        for axis in 0..3 {
            // Places along the axis in 2^24 steps: the highest bit that differs says which plane separates them.
            let [low, high] =
                [b.min, b.max].map(|p| ((f64::from(p[axis]) - self.low[axis]) / self.size * f64::from(1 << 24)) as u32);
            let differ = low ^ high;
            if differ == 0 {
                continue;
            }
            let bit = 31 - differ.leading_zeros();
            let at = f64::from(high >> bit << bit) / f64::from(1 << 24) * self.size + self.low[axis];
            let (at, level) = (at as f32, 24 - bit);
            let inside = at > b.min[axis] && at < b.max[axis];
            let longer = |other: &Plane| level == other.level && b.size()[axis] > b.size()[other.axis];
            if inside && best.as_ref().is_none_or(|other| level < other.level || longer(other)) {
                best = Some(Plane { axis, at, level });
            }
        }
        best
    }
}

fn priority(planes: &Planes, b: Aabb, [p, q, r]: [Vec3; 3]) -> f64 {
    let Some(plane) = planes.first_through(b) else { return 0.0 };
    let size = b.size().as_dvec3() / planes.size;
    let area = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    // Boxes around ever smaller pieces have the areas of the triangle's three shadows, from both sides.
    let (p, q, r) = (p.as_dvec3(), q.as_dvec3(), r.as_dvec3());
    let ideal = (q - p).cross(r - p).abs().element_sum() / (planes.size * planes.size);
    libm::cbrt(libm::ldexp((area - ideal).max(0.0), -(plane.level as i32)))
}

/// Cuts a triangle's box into `cuts` + 1 parts.
fn cut(planes: &Planes, corners: [Vec3; 3], b: Aabb, cuts: u32, parts: &mut Vec<Aabb>) {
    let halves = planes.first_through(b).filter(|_| cuts > 0).map(|plane| halves(&plane, corners, b));
    let Some([left, right]) = halves.filter(|halves| halves.iter().all(|half| !half.is_empty())) else {
        parts.push(b);
        return;
    };
    // What is left to cut goes where the longer part is.
    let [l, r] = [left, right].map(|half| half.size().max_element());
    let for_left = ((cuts - 1) as f32 * l / (l + r) + 0.5) as u32;
    let for_left = for_left.min(cuts - 1);
    cut(planes, corners, left, for_left, parts);
    cut(planes, corners, right, cuts - 1 - for_left, parts);
}

/// The boxes of a triangle's parts on both sides of a plane, within its present box.
fn halves(plane: &Plane, corners: [Vec3; 3], b: Aabb) -> [Aabb; 2] {
    let (axis, at) = (plane.axis, plane.at);
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
