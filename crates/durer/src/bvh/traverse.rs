//! Walking a ray through the tree, nearest boxes first.

use super::{Bvh, COUNT_SHIFT, EMPTY, FIRST_MASK, LEAF_BIT, Tally, WIDTH};
use crate::math::{Aabb, Ray, Vec3};
use glam::Vec4;

/// A ray prepared for boxes: conservative, so that rounding never loses a box that the exact ray meets.
///
/// The near and far side of each slab are chosen by the sign of the direction. Each side is moved outwards by
/// several roundings of the largest distance that occurs, which also covers the rounding of the triangle test.
pub struct RayBox {
    inverse: [Vec4; 3],
    near_origin: [Vec4; 3],
    far_origin: [Vec4; 3],
    negative: [bool; 3],
    t_min: f32,
}

impl RayBox {
    /// Prepares a ray for a tree with these bounds.
    pub fn new(ray: &Ray, bounds: Aabb) -> Self {
        // Half of the largest number: products with it overflow to infinity, never to NaN.
        const LARGEST: f32 = f32::MAX * 0.5;
        let inverse =
            ray.dir.to_array().map(|d| if d == 0.0 { LARGEST.copysign(d) } else { (1.0 / d).clamp(-LARGEST, LARGEST) });
        // Coordinates themselves count too: a ray that was moved into object space is off by their rounding.
        let reach = (ray.origin - bounds.min).abs().max((ray.origin - bounds.max).abs()).max(ray.origin.abs());
        let pad = 8.0 * f32::EPSILON * reach.max_element() + f32::MIN_POSITIVE;
        let negative = inverse.map(|i| i < 0.0);
        let moved = |sign: f32| {
            std::array::from_fn(|axis| {
                let step = if negative[axis] { -sign * pad } else { sign * pad };
                Vec4::splat(ray.origin[axis] + step)
            })
        };
        RayBox {
            inverse: inverse.map(Vec4::splat),
            near_origin: moved(1.0),
            far_origin: moved(-1.0),
            negative,
            t_min: ray.t_min,
        }
    }
}

/// The deepest a stack can get: 28 levels of halving below 40 of any kind, three siblings each.
const STACK: usize = 3 * 72;

impl Bvh {
    /// Offers every thing that the ray may meet before `t_max` to `test`, roughly from near to far.
    ///
    /// `test` gets the place of a thing in [`Bvh::order`] and the present `t_max`, and gives the new one: at
    /// most the old. Things whose boxes begin exactly at `t_max` are still offered. Minus infinity ends the walk.
    #[inline]
    pub fn walk<T: Tally>(&self, ray: &Ray, tally: &mut T, mut test: impl FnMut(usize, f32, &mut T) -> f32) {
        if self.nodes.is_empty() || !is_sound(ray) {
            return;
        }
        let boxes = RayBox::new(ray, self.bounds);
        let mut t_max = ray.t_max;
        let mut stack = [(0u32, 0.0f32); STACK];
        stack[0] = (0, f32::NEG_INFINITY);
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (child, near) = stack[height];
            if near > t_max {
                continue;
            }
            if child & LEAF_BIT != 0 {
                let first = (child & FIRST_MASK) as usize;
                let count = ((child & !LEAF_BIT) >> COUNT_SHIFT) as usize + 1;
                for item in first..first + count {
                    t_max = test(item, t_max, tally);
                }
                continue;
            }
            tally.node();
            let node = &self.nodes[child as usize];
            let slab = |axis: usize| {
                let (near, far) = match boxes.negative[axis] {
                    true => (node.max[axis], node.min[axis]),
                    false => (node.min[axis], node.max[axis]),
                };
                (
                    (near - boxes.near_origin[axis]) * boxes.inverse[axis],
                    (far - boxes.far_origin[axis]) * boxes.inverse[axis],
                )
            };
            let ((x0, x1), (y0, y1), (z0, z1)) = (slab(0), slab(1), slab(2));
            let enter = x0.max(y0).max(z0.max(Vec4::splat(boxes.t_min)));
            let leave = x1.min(y1).min(z1.min(Vec4::splat(t_max)));
            let mut mask = enter.cmple(leave).bitmask();
            // The hit boxes are pushed so that the nearest is on top.
            let base = height;
            while mask != 0 {
                let i = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                if node.children[i] == EMPTY {
                    continue;
                }
                let entry = (node.children[i], enter[i]);
                let mut at = height;
                while at > base && stack[at - 1].1 < entry.1 {
                    stack[at] = stack[at - 1];
                    at -= 1;
                }
                stack[at] = entry;
                height += 1;
            }
        }
    }
}

/// Whether a ray can hit anything: NaN and infinite ones, and those without direction, cannot.
pub(crate) fn is_sound(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.dir.is_finite() && ray.dir != Vec3::ZERO && ray.t_min < ray.t_max
}

const _: () = assert!(WIDTH == 4);
