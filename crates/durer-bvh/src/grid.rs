//! A uniform grid divides space into equal cells and lists the primitives in each cell.
//!
//! Source: Amanatides and Woo, *A Fast Voxel Traversal Algorithm for Ray Tracing*, Eurographics
//! 1987.

use super::TraversalCounter;
use super::traverse::is_valid;
use crate::math::{Aabb, Ray, Vec3};

/// Margin, in cells, by which primitive boxes are enlarged to compensate for rounding errors along
/// rays.
const PAD: f32 = 1e-2;

/// Margin, in cells, by which primitive boxes are enlarged if the grid is built for drawing. It is
/// just large enough to include primitives that touch a cell.
const DRAWING_PAD: f32 = 1e-3;

/// A uniform grid over the caller's primitives. It is an alternative to a [`Bvh`](super::Bvh) for
/// tracing rays.
#[derive(Clone, Debug)]
pub struct Grid {
    bounds: Aabb,
    resolution: [u32; 3],
    /// Margin around primitive boxes, in cells.
    pad: f32,
    /// Start of each cell's list in `items`, followed by the end of the last list.
    starts: Vec<u32>,
    items: Vec<u32>,
    /// Number of primitives.
    primitive_count: usize,
}

impl Grid {
    /// Maximum number of cells.
    pub const MAX_CELLS: u64 = 1 << 26;
    /// Maximum total number of entries in the lists of all cells.
    const MAX_ENTRIES: u64 = 1 << 28;

    /// Returns suitable numbers of cells along x, y, and z for `primitive_count` primitives in a
    /// box. There are about two nearly cubic cells per primitive.
    pub fn suggested_resolution(bounds: Aabb, primitive_count: usize) -> [u32; 3] {
        let size = bounds.size();
        let longest = size.max_element().max(f32::MIN_POSITIVE);
        // A flat box is treated as slightly thick, so that the number of cells stays bounded.
        let size = (size / longest).max(Vec3::splat(1e-3)).as_dvec3();
        let cells_per_length = libm::cbrt(2.0 * primitive_count.max(1) as f64 / size.element_product());
        (size * cells_per_length).to_array().map(|n| (n as u32).clamp(1, 256))
    }

    /// Divides `bounds` into cells and lists primitives 0, 1, 2, ... in the cells that they
    /// overlap. A primitive is listed in a cell if its box overlaps the slightly enlarged cell and
    /// `overlaps` returns true for the number of the primitive and that cell.
    ///
    /// Returns `None` if there are no cells, more cells than [`Grid::MAX_CELLS`], or too many list
    /// entries.
    pub fn build(
        bounds: Aabb,
        counts: [u32; 3],
        boxes: &[Aabb],
        overlaps: impl Fn(usize, Aabb) -> bool,
    ) -> Option<Self> {
        Self::build_padded(bounds, counts, PAD, boxes, overlaps)
    }

    /// Builds a grid with equal cells for drawing, in which primitives are listed only in the cells
    /// that they touch. Such a grid is not suitable for tracing rays because rays may miss
    /// primitives in it.
    pub fn for_drawing(&self, boxes: &[Aabb], overlaps: impl Fn(usize, Aabb) -> bool) -> Option<Self> {
        Self::build_padded(self.bounds, self.resolution, DRAWING_PAD, boxes, overlaps)
    }

    fn build_padded(
        bounds: Aabb,
        resolution: [u32; 3],
        cell_pad: f32,
        boxes: &[Aabb],
        overlaps: impl Fn(usize, Aabb) -> bool,
    ) -> Option<Self> {
        let cells = resolution.iter().try_fold(1u64, |n, &c| n.checked_mul(u64::from(c)))?;
        if cells == 0 || cells > Grid::MAX_CELLS {
            return None;
        }
        // Enlarge the bounds so that the cells of a flat box have a volume and rounding errors do
        // no harm.
        let pad = (1e-5 * bounds.size().max_element()).max(1e-5 * bounds.center().abs().max_element()).max(1e-30);
        let bounds = Aabb { min: bounds.min - pad, max: bounds.max + pad };
        let mut grid = Grid {
            bounds,
            resolution,
            pad: cell_pad,
            starts: vec![0; cells as usize + 1],
            items: Vec::new(),
            primitive_count: boxes.len(),
        };
        let entries = boxes.iter().try_fold(0u64, |sum, b| sum.checked_add(grid.cells_of(b)))?;
        if entries > Grid::MAX_ENTRIES {
            return None;
        }
        // Count the entries of each cell, then fill the lists.
        for (i, b) in boxes.iter().enumerate() {
            grid.for_cells(b, |cell| overlaps(i, cell), |grid, cell| grid.starts[cell + 1] += 1);
        }
        for i in 1..grid.starts.len() {
            grid.starts[i] += grid.starts[i - 1];
        }
        grid.items = vec![0; grid.starts[cells as usize] as usize];
        let mut next = grid.starts.clone();
        for (i, b) in boxes.iter().enumerate() {
            let inside = |cell| overlaps(i, cell);
            grid.for_cells(b, inside, |grid, cell| {
                grid.items[next[cell] as usize] = i as u32;
                next[cell] += 1;
            });
        }
        Some(grid)
    }

    /// Returns the edge lengths of a cell.
    pub fn cell_size(&self) -> Vec3 {
        self.bounds.size() / Vec3::from(self.resolution.map(|n| n as f32))
    }

    /// Returns the numbers of cells along x, y, and z.
    pub fn resolution(&self) -> [u32; 3] {
        self.resolution
    }

    /// Returns the bounding box of a cell.
    pub fn cell_bounds(&self, cell: [u32; 3]) -> Aabb {
        let min = self.bounds.min + self.cell_size() * Vec3::from(cell.map(|i| i as f32));
        Aabb { min, max: min + self.cell_size() }
    }

    /// Returns the number of primitives that overlap a cell.
    pub fn occupancy(&self, cell: [u32; 3]) -> usize {
        self.primitives(cell).len()
    }

    /// Returns the numbers of the primitives that overlap a cell.
    pub fn primitives(&self, cell: [u32; 3]) -> &[u32] {
        let i = self.number(cell);
        &self.items[self.starts[i] as usize..self.starts[i + 1] as usize]
    }

    /// Returns the size of the lists in bytes.
    pub fn memory_usage(&self) -> usize {
        size_of_val(&*self.starts) + size_of_val(&*self.items)
    }

    fn number(&self, [x, y, z]: [u32; 3]) -> usize {
        let [nx, ny, _] = self.resolution;
        (z as usize * ny as usize + y as usize) * nx as usize + x as usize
    }

    fn cell_of(&self, p: Vec3) -> [u32; 3] {
        let at = (p - self.bounds.min) / self.cell_size();
        // The cast turns negative numbers into 0.
        std::array::from_fn(|axis| (at[axis] as u32).min(self.resolution[axis] - 1))
    }

    /// Returns the range of cells that a box overlaps: the lowest and the highest cell, both
    /// inclusive.
    fn range(&self, b: &Aabb) -> ([u32; 3], [u32; 3]) {
        let pad = self.pad * self.cell_size();
        (self.cell_of(b.min - pad), self.cell_of(b.max + pad))
    }

    /// Returns the number of cells that a box overlaps.
    fn cells_of(&self, b: &Aabb) -> u64 {
        let (low, high) = self.range(b);
        if b.is_empty() { 0 } else { (0..3).map(|axis| u64::from(high[axis] - low[axis] + 1)).product() }
    }

    fn for_cells(&mut self, b: &Aabb, overlaps: impl Fn(Aabb) -> bool, mut f: impl FnMut(&mut Self, usize)) {
        if b.is_empty() {
            return;
        }
        let (low, high) = self.range(b);
        let pad = self.pad * self.cell_size();
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                for x in low[0]..=high[0] {
                    let cell = self.cell_bounds([x, y, z]);
                    if overlaps(Aabb { min: cell.min - pad, max: cell.max + pad }) {
                        let number = self.number([x, y, z]);
                        f(self, number);
                    }
                }
            }
        }
    }

    /// Calls `test` for the primitives in every cell that the ray crosses before `t_max`, in the
    /// order of the cells; see [`super::Bvh::traverse`]. A primitive that is in several cells is
    /// tested several times.
    #[inline]
    pub fn traverse<T: TraversalCounter>(
        &self,
        ray: &Ray,
        counter: &mut T,
        mut test: impl FnMut(usize, f32, &mut T) -> f32,
    ) {
        let is_done = self.visit_cells(ray, &mut |items, t_max| {
            counter.count_work(1, 0);
            items.iter().fold(t_max, |t_max, item| test(*item as usize, t_max, counter))
        });
        if !is_done {
            counter.count_work(1, 0);
            (0..self.primitive_count).fold(ray.t_max, |t_max, primitive| test(primitive, t_max, counter));
        }
    }

    /// Calls `visit` with the primitives of each cell on the ray. Returns false without calling it
    /// if the caller should test all primitives instead. `visit` is a trait object so that the
    /// traversal is compiled only once and not once per caller.
    fn visit_cells(&self, ray: &Ray, visit: &mut dyn FnMut(&[u32], f32) -> f32) -> bool {
        // Far from the grid, rounding moves a ray by more than the padding, so neighbouring cells
        // are visited too.
        let reach = [self.bounds.min, self.bounds.max].map(|c| (ray.origin - c).abs().max(c.abs()).max_element());
        let cut = |axis: &usize| self.resolution[*axis] > 1;
        let finest = (0..3).filter(cut).map(|axis| self.cell_size()[axis]).fold(f32::INFINITY, f32::min);
        let rounding_error = 16.0 * f32::EPSILON * reach[0].max(reach[1]);
        if rounding_error > PAD * finest && is_valid(ray) {
            return self.traverse_wide(ray, rounding_error.into(), visit);
        }
        self.traverse_cells(ray, |grid, cell, t_max| visit(grid.primitives(cell), t_max));
        true
    }

    /// Calls `visit` for all cells within distance `rounding_error` of a ray, in layers
    /// perpendicular to the ray's main axis. Returns false without calling it if testing all
    /// primitives is less work.
    fn traverse_wide(&self, ray: &Ray, rounding_error: f64, visit: &mut dyn FnMut(&[u32], f32) -> f32) -> bool {
        let (line, size, min) = (ray.line(), self.cell_size().as_dvec3(), self.bounds.min.as_dvec3());
        let main = line.dir.abs().max_position();
        let [a, b] = [(main + 1) % 3, (main + 2) % 3];
        let across = |axis: usize| (2.0 * rounding_error / size[axis] + 3.0).min(f64::from(self.resolution[axis]));
        if f64::from(self.resolution[main]) * across(a) * across(b) > self.primitive_count as f64 {
            return false;
        }
        let pad = rounding_error / line.dir[main].abs();
        let (begin, mut end) = (f64::from(ray.t_min) - pad, f64::from(ray.t_max) + pad);
        for layer in 0..self.resolution[main] {
            let layer = if line.dir[main] > 0.0 { layer } else { self.resolution[main] - 1 - layer };
            let [low, high] = [0.0, 1.0].map(|wall| min[main] + (f64::from(layer) + wall) * size[main]);
            let [t, u] =
                [low - rounding_error, high + rounding_error].map(|wall| (wall - line.origin[main]) / line.dir[main]);
            let (near, far) = (t.min(u).max(begin), t.max(u).min(end));
            if near > end {
                break;
            }
            // Cells of this layer that the ray passes through. The range is empty if the ray is
            // outside the grid.
            let range = |axis: usize| {
                let [p, q] = [near, far].map(|t| line.origin[axis] + t * line.dir[axis]);
                let cell = |at: f64| (at - min[axis]) / size[axis];
                let (low, high) = (cell(p.min(q) - rounding_error), cell(p.max(q) + rounding_error));
                let count = f64::from(self.resolution[axis]);
                // The range is empty if the interval ends before the grid or begins beyond it.
                if near > far || !(high >= 0.0 && low < count) {
                    return 0..0;
                }
                low.max(0.0) as u32..high.min(count - 1.0) as u32 + 1
            };
            for i in range(a) {
                for j in range(b) {
                    let mut cell = [layer; 3];
                    (cell[a], cell[b]) = (i, j);
                    let number = self.number(cell);
                    let items = &self.items[self.starts[number] as usize..self.starts[number + 1] as usize];
                    end = end.min(f64::from(visit(items, end.min(f64::from(ray.t_max)) as f32)) + pad);
                }
            }
        }
        true
    }

    /// Visits the cells along a ray in order. `visit` takes a cell and the current `t_max`, and
    /// returns the new `t_max`.
    pub fn traverse_cells(&self, ray: &Ray, mut visit: impl FnMut(&Self, [u32; 3], f32) -> f32) {
        let Some((enter, leave)) = self.bounds.clip(ray.origin, ray.dir).filter(|_| is_valid(ray)) else { return };
        let (enter, leave) = (enter.max(ray.t_min), leave.min(ray.t_max));
        if enter > leave {
            return;
        }
        let mut cell = self.cell_of(ray.at(enter));
        let size = self.cell_size();
        // `t` of the next cell wall along each axis. It is computed from the index of the wall so
        // that rounding errors do not accumulate.
        let wall_t = |cell: [u32; 3], axis: usize| {
            if ray.dir[axis] == 0.0 {
                return f32::INFINITY;
            }
            let wall = cell[axis] as f32 + if ray.dir[axis] > 0.0 { 1.0 } else { 0.0 };
            (self.bounds.min[axis] + wall * size[axis] - ray.origin[axis]) / ray.dir[axis]
        };
        let mut next: [f32; 3] = std::array::from_fn(|axis| wall_t(cell, axis));
        let mut t_max = leave;
        let mut limit = ray.t_max;
        loop {
            limit = visit(self, cell, limit);
            t_max = t_max.min(limit);
            let axis = if next[0] <= next[1] && next[0] <= next[2] {
                0
            } else if next[1] <= next[2] {
                1
            } else {
                2
            };
            // Primitives in the padding of a wall are in both cells, so a hit before the wall ends
            // the traversal.
            if next[axis] > t_max {
                return;
            }
            let up = ray.dir[axis] > 0.0;
            if if up { cell[axis] + 1 == self.resolution[axis] } else { cell[axis] == 0 } {
                return;
            }
            cell[axis] = if up { cell[axis] + 1 } else { cell[axis] - 1 };
            next[axis] = wall_t(cell, axis);
        }
    }
}
