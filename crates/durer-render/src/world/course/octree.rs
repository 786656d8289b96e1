//! Octree of the course's starter code, which misses some hits.
//!
//! A ray visits the eight children of a cell in the order given by the values of `t` at which it
//! crosses the outer and middle planes of the cell. If a component of the ray direction is exactly
//! 0, the values of `t` for the outer planes are infinite, and their mean, used for the middle
//! plane, is NaN. Comparisons with NaN are false, so the children behind the middle plane of that
//! axis are never visited.
//!
//! Source: Revelles, Ureña, Lastra, *An Efficient Parametric Algorithm for Octree Traversal*, WSCG
//! 2000. The constants come from the starter code.

use durer_scene::math::{Aabb, Vec3};
use std::ops::Range;

/// Maximum number of triangles in a cell that is not divided.
const MAX_LEAF_TRIANGLES: usize = 7;
/// Deepest level at which cells are still divided.
const LAST_LEVEL: u32 = 8;
/// Number of stored triangles, summed over all cells, beyond which no more cells are divided. This
/// limits the memory use to about 64 MB: a triangle is stored in every cell that its bounding box
/// touches, which is 1180 cells on average for the course's rabbit of 1000 triangles.
const MOST_STORED: usize = 1 << 24;

/// Octree over the triangles of a mesh, as the course's starter code builds and traverses it.
#[derive(Debug)]
pub(super) struct Octree {
    bounds: Aabb,
    cells: Vec<Cell>,
    /// Triangles of the undivided cells.
    triangles: Vec<u32>,
}

/// Cell of an [`Octree`], which is either divided or holds a range of triangles.
#[derive(Clone, Debug)]
enum Cell {
    /// Index of the first of eight children. In the offset of a child from the first child, the
    /// bits 4, 2 and 1 are set if the child is in the upper half along x, y and z respectively.
    Divided(u32),
    /// Range of the cell's triangles in [`Octree::triangles`].
    Whole(Range<u32>),
}

/// Values of `t` at which a ray enters and leaves an octree cell along each axis.
#[derive(Clone, Copy)]
struct Span {
    enter: [f32; 3],
    leave: [f32; 3],
}

impl Octree {
    /// Builds the octree from the bounding boxes of a mesh's triangles.
    pub fn new(boxes: Vec<Aabb>) -> Self {
        let bounds = boxes.iter().copied().reduce(Aabb::union).unwrap_or(Aabb::EMPTY);
        let mut octree = Octree { bounds, cells: vec![Cell::Whole(0..0)], triangles: Vec::new() };
        octree.fill(0, bounds, (0..boxes.len() as u32).collect(), &boxes, 0);
        octree
    }

    /// Returns the memory used, in bytes.
    pub fn memory_usage(&self) -> usize {
        size_of_val(&*self.cells) + size_of_val(&*self.triangles)
    }

    /// Divides a cell, or stores its triangles if there are only a few.
    fn fill(&mut self, cell: usize, bounds: Aabb, triangles: Vec<u32>, boxes: &[Aabb], level: u32) {
        if triangles.len() <= MAX_LEAF_TRIANGLES || level > LAST_LEVEL || self.triangles.len() > MOST_STORED {
            let start = self.triangles.len() as u32;
            self.triangles.extend(triangles);
            self.cells[cell] = Cell::Whole(start..self.triangles.len() as u32);
            return;
        }
        let first = self.cells.len();
        self.cells[cell] = Cell::Divided(first as u32);
        self.cells.extend(vec![Cell::Whole(0..0); 8]);
        let middle = (bounds.min + bounds.max) / 2.0;
        for child in 0..8_usize {
            let pick = |upper: Vec3, lower: Vec3| {
                let half = |axis: usize| if child & (4 >> axis) != 0 { upper[axis] } else { lower[axis] };
                Vec3::new(half(0), half(1), half(2))
            };
            let child_bounds = Aabb { min: pick(middle, bounds.min), max: pick(bounds.max, middle) };
            let touches = |b: &Aabb| b.min.cmple(child_bounds.max).all() && child_bounds.min.cmple(b.max).all();
            let inside = triangles.iter().copied().filter(|&i| touches(&boxes[i as usize])).collect();
            self.fill(first + child, child_bounds, inside, boxes, level + 1);
        }
    }

    /// Calls `offer` with the triangles in the cells that a ray visits, in visiting order. Some
    /// triangles are passed several times.
    pub fn walk(&self, mut origin: Vec3, mut dir: Vec3, offer: &mut impl FnMut(u32)) {
        // Mirror the octree along each axis on which the ray direction is negative.
        let mut mirrored = 0;
        for axis in 0..3 {
            if dir[axis] < 0.0 {
                origin[axis] = (self.bounds.max + self.bounds.min)[axis] - origin[axis];
                dir[axis] = -dir[axis];
                mirrored |= 4 >> axis;
            }
        }
        let at = |planes: Vec3| [0, 1, 2].map(|axis| (planes[axis] - origin[axis]) * (1.0 / dir[axis]));
        let span = Span { enter: at(self.bounds.min), leave: at(self.bounds.max) };
        // Compare as C++ does: if one operand is NaN, the first operand is returned.
        let larger = |a: f32, b: f32| if a < b { b } else { a };
        let smaller = |a: f32, b: f32| if b < a { b } else { a };
        let [x, y, z] = span.enter;
        let [u, v, w] = span.leave;
        if larger(larger(x, y), z) <= smaller(smaller(u, v), w) {
            self.visit(0, mirrored, span, offer);
        }
    }

    /// Visits a cell and its children.
    fn visit(&self, cell: usize, mirrored: usize, Span { enter, leave }: Span, offer: &mut impl FnMut(u32)) {
        if leave.iter().any(|&t| t < 0.0) {
            return;
        }
        let children = match &self.cells[cell] {
            Cell::Whole(range) => {
                return self.triangles[range.start as usize..range.end as usize].iter().for_each(|&i| offer(i));
            }
            Cell::Divided(first) => *first as usize,
        };
        let middle = [0, 1, 2].map(|axis| 0.5 * (enter[axis] + leave[axis]));
        let mut child = first_child(enter, middle);
        loop {
            let is_upper = [0, 1, 2].map(|axis| child & (4 >> axis) != 0);
            let child_span = Span {
                enter: [0, 1, 2].map(|axis| if is_upper[axis] { middle[axis] } else { enter[axis] }),
                leave: [0, 1, 2].map(|axis| if is_upper[axis] { leave[axis] } else { middle[axis] }),
            };
            self.visit(children + (child ^ mirrored), mirrored, child_span, offer);
            // Leave the cell through the nearest exit plane. There are no more children behind an
            // outer plane.
            let axis = first_plane(child_span.leave);
            if is_upper[axis] {
                return;
            }
            child |= 4 >> axis;
        }
    }
}

/// Returns the child that a ray enters first. Each plane is given by the `t` at which the ray
/// crosses it.
fn first_child([x, y, z]: [f32; 3], middle: [f32; 3]) -> usize {
    // Find the axis whose entry plane is crossed last. All comparisons with NaN are false, as in
    // the official programs.
    let (axis, t) = match (x > y, x > z, y > z) {
        (true, true, _) => (0, x),
        (false, _, true) => (1, y),
        _ => (2, z),
    };
    (0..3).filter(|&other| other != axis && middle[other] < t).map(|other| 4 >> other).sum()
}

/// Returns the axis of the plane through which a ray leaves a cell first.
fn first_plane([x, y, z]: [f32; 3]) -> usize {
    match (x < y, x < z, y < z) {
        (true, true, _) => 0,
        (false, _, true) => 1,
        _ => 2,
    }
}

#[cfg(test)]
mod tests;
