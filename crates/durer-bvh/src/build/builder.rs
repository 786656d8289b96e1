//! Parameters of a build, and the growing boxes used for both object splits and spatial splits.

use super::reference::Reference;
use crate::math::{Aabb, Vec3};
use crate::parallel;
use glam::Vec4;

/// Number of references above which they are processed in parallel.
pub const MIN_PARALLEL: usize = 1 << 15;

/// Returns half the surface area of a scaled box.
#[inline]
pub fn half_area(min: Vec4, max: Vec4, scale: f32) -> f32 {
    let d = ((max - min) * scale).max(Vec4::ZERO);
    d.x * d.y + d.y * d.z + d.z * d.x
}

/// Parameters for building a binary tree: scale, root area, and limits on leaves and bins.
pub struct Builder<'a> {
    pub scale: f32,
    /// Half the surface area of the root node.
    pub area: f32,
    /// Maximum number of references that may stay together in one leaf.
    pub whole: usize,
    /// Returns the maximum number of bins for a number of references.
    pub bins: fn(usize) -> usize,
    /// Corners of the triangles that may be split. The slice is empty for other primitives.
    pub corners: &'a [[Vec3; 3]],
}

/// A box that grows with each added reference, and the number of references in it.
#[derive(Clone, Copy)]
pub struct Bin {
    pub min: Vec4,
    pub max: Vec4,
    pub count: u32,
}

impl Bin {
    pub const EMPTY: Bin = Bin { min: Vec4::INFINITY, max: Vec4::NEG_INFINITY, count: 0 };

    pub fn of(references: &[Reference]) -> Bin {
        let [min, max] = around_all(references, &|r| [r.min, r.max]);
        Bin { min, max, count: references.len() as u32 }
    }

    pub fn bounds(&self) -> Aabb {
        Aabb { min: self.min.truncate(), max: self.max.truncate() }
    }

    #[inline]
    pub fn with(self, r: &Reference) -> Bin {
        Bin { count: self.count + 1, ..self.around(r) }
    }

    /// Grows the box without counting the reference.
    #[inline]
    pub fn around(self, r: &Reference) -> Bin {
        Bin { min: self.min.min(r.min), max: self.max.max(r.max), ..self }
    }

    #[inline]
    pub fn union(self, other: Bin) -> Bin {
        Bin { min: self.min.min(other.min), max: self.max.max(other.max), count: self.count + other.count }
    }

    /// Returns the cost by the surface area heuristic: the scaled area of the box times the number
    /// of references.
    #[inline]
    pub fn cost(&self, scale: f32) -> f32 {
        half_area(self.min, self.max, scale) * self.count as f32
    }
}

/// Returns the bounding box of the values that `of` returns for all references. The function grows
/// four boxes in turn because each step of one box has to wait for the previous step of the same
/// box.
pub fn around_all(references: &[Reference], of: &(impl Fn(&Reference) -> [Vec4; 2] + Sync)) -> [Vec4; 2] {
    if references.len() > MIN_PARALLEL {
        let (a, b) = references.split_at(references.len() / 2);
        let (a, b) = parallel::join(|| around_all(a, of), || around_all(b, of));
        return [a[0].min(b[0]), a[1].max(b[1])];
    }
    let mut boxes = [[Vec4::INFINITY, Vec4::NEG_INFINITY]; 4];
    let grow = |[min, max]: &mut [Vec4; 2], r: &Reference| {
        let [low, high] = of(r);
        (*min, *max) = (min.min(low), max.max(high));
    };
    let (fours, rest) = references.as_chunks::<4>();
    for four in fours {
        boxes.iter_mut().zip(four).for_each(|(all, r)| grow(all, r));
    }
    boxes.iter_mut().zip(rest).for_each(|(all, r)| grow(all, r));
    let [a, b, c, d] = boxes;
    [a[0].min(b[0]).min(c[0].min(d[0])), a[1].max(b[1]).max(c[1].max(d[1]))]
}
