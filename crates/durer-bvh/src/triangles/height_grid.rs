//! Height grids, whose triangles are computed on demand.

use super::rows::TAG;
use crate::BuildError;
use crate::lanes::{ROWS, Rows};
use crate::math::{Aabb, Vec3};
use crate::node::{self, LEAF_SIZE};

/// Maximum number of cells of a block along either axis.
const SIDE: usize = 2;
const _: () = assert!(2 * SIDE * SIDE == LEAF_SIZE);

/// A height field such as terrain. It stores heights y at the crossings of grid lines with constant
/// x and z, and a [`TriangleBvh`](super::TriangleBvh) computes triangles from it.
///
/// Crossings and cells are numbered along x first. A cell lies between four crossings and has two
/// triangles. Let a be the crossing at the lower x and z, b the one at the next z, c the one at the
/// next x, and d the one at the next x and z. Then cell i has the triangles (a, b, d) with number 2
/// i and (a, d, c) with number 2 i + 1.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightGrid {
    xs: Vec<f32>,
    zs: Vec<f32>,
    heights: Vec<f32>,
}

impl HeightGrid {
    /// Creates a grid from the x and z coordinates of its lines and the heights at the crossings,
    /// listed along x first.
    ///
    /// # Errors
    ///
    /// Returns an error if there are fewer than two lines along an axis, if the number of heights
    /// differs from the number of crossings, if a number is not finite, or if there are 2^28
    /// triangles or more.
    pub fn new(xs: Vec<f32>, zs: Vec<f32>, heights: Vec<f32>) -> Result<Self, BuildError> {
        let (columns, rows) = (xs.len(), zs.len());
        if columns < 2 || rows < 2 || columns.checked_mul(rows) != Some(heights.len()) {
            return Err(BuildError::InvalidGridSize { columns, rows, heights: heights.len() });
        }
        if [&xs, &zs, &heights].iter().any(|list| list.iter().any(|x| !x.is_finite())) {
            return Err(BuildError::NotFinite);
        }
        let grid = HeightGrid { xs, zs, heights };
        match grid.triangle_count() > node::MAX_ITEMS {
            true => Err(BuildError::TooManyTriangles { triangles: grid.triangle_count() }),
            false => Ok(grid),
        }
    }

    /// Returns the x coordinates of the lines along z.
    pub fn xs(&self) -> &[f32] {
        &self.xs
    }

    /// Returns the z coordinates of the lines along x.
    pub fn zs(&self) -> &[f32] {
        &self.zs
    }

    /// Heights of the crossings, listed along x first.
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// Applies a function to all coordinates. `coordinate` takes an axis (0 to 2) and a coordinate
    /// and returns the new coordinate.
    pub fn map(&self, mut coordinate: impl FnMut(usize, f32) -> f32) -> Self {
        let mut along = |axis: usize, list: &[f32]| list.iter().map(|x| coordinate(axis, *x)).collect();
        HeightGrid { xs: along(0, &self.xs), zs: along(2, &self.zs), heights: along(1, &self.heights) }
    }

    /// Returns the number of triangles.
    pub fn triangle_count(&self) -> usize {
        2 * (self.xs.len() - 1) * (self.zs.len() - 1)
    }

    /// Returns the position of a crossing.
    #[inline]
    pub fn point(&self, crossing: usize) -> Vec3 {
        let (number, columns) = (crossing as u32, self.xs.len() as u32);
        let row = number / columns;
        Vec3::new(self.xs[(number - row * columns) as usize], self.heights[crossing], self.zs[row as usize])
    }

    /// Returns the crossings at the corners of a triangle.
    #[inline]
    pub fn triangle(&self, number: usize) -> [u32; 3] {
        let [column, row] = self.cell(number);
        let columns = self.xs.len() as u32;
        let a = row * columns + column;
        let b = a + columns;
        if number.is_multiple_of(2) { [a, b, b + 1] } else { [a, b + 1, a + 1] }
    }

    /// Returns the corners of a triangle.
    #[inline]
    pub fn corners(&self, number: usize) -> [Vec3; 3] {
        let ([column, row], columns) = (self.cell(number).map(|line| line as usize), self.xs.len());
        let ([x, next_x], [z, next_z]) = ([0, 1].map(|i| self.xs[column + i]), [0, 1].map(|i| self.zs[row + i]));
        let at = |i: usize, j: usize| self.heights[(row + j) * columns + column + i];
        let (a, d) = (Vec3::new(x, at(0, 0), z), Vec3::new(next_x, at(1, 1), next_z));
        match number.is_multiple_of(2) {
            true => [a, Vec3::new(x, at(0, 1), next_z), d],
            false => [a, d, Vec3::new(next_x, at(1, 0), z)],
        }
    }

    /// Returns the column and row of the cell that contains a triangle.
    #[inline]
    fn cell(&self, triangle: usize) -> [u32; 2] {
        // A 32-bit division is faster.
        let (cell, wide) = ((triangle / 2) as u32, (self.xs.len() - 1) as u32);
        let row = cell / wide;
        [cell - row * wide, row]
    }

    /// Returns the bounding box of some crossings.
    pub fn bounds(&self) -> Aabb {
        let ends =
            |list: &[f32]| list.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
        let [[x, x1], [y, y1], [z, z1]] = [&self.xs, &self.heights, &self.zs].map(|list| ends(list));
        Aabb { min: Vec3::new(x, y, z), max: Vec3::new(x1, y1, z1) }
    }

    /// Returns the size of the lists in bytes.
    pub fn memory_usage(&self) -> usize {
        size_of_val(&*self.xs) + size_of_val(&*self.zs) + size_of_val(&*self.heights)
    }

    /// Returns the numbers of blocks along x and z.
    pub(super) fn blocks(&self) -> [usize; 2] {
        [&self.xs, &self.zs].map(|lines| (lines.len() - 1).div_ceil(SIDE))
    }

    /// Returns the first column and row of a block, and its numbers of cells along x and z.
    pub(super) fn cells(&self, block: usize) -> [[usize; 2]; 2] {
        let beside = self.blocks()[0];
        let first = [SIDE * (block % beside), SIDE * (block / beside)];
        [first, [SIDE.min(self.xs.len() - 1 - first[0]), SIDE.min(self.zs.len() - 1 - first[1])]]
    }

    pub(super) fn block_bounds(&self, block: usize) -> Aabb {
        let [[column, row], [wide, deep]] = self.cells(block);
        let crossings = (row..=row + deep).flat_map(|row| (column..=column + wide).map(move |column| (row, column)));
        Aabb::around(crossings.map(|(row, column)| self.point(row * self.xs.len() + column)))
    }

    /// Writes the triangles of a block as the rows of a leaf.
    pub(super) fn write_rows(&self, block: usize, rows: &mut Rows) {
        let [first, cells] = self.cells(block);
        match cells {
            // If the sizes are known at compile time, the compiler can remove the loops.
            [SIDE, SIDE] => self.write_cells(first, [SIDE, SIDE], rows),
            _ => self.write_cells(first, cells, rows),
        }
    }

    #[inline(always)]
    fn write_cells(&self, [column, row]: [usize; 2], [wide, deep]: [usize; 2], rows: &mut Rows) {
        let columns = self.xs.len();
        let (count, xs) = (2 * wide * deep, &self.xs[column..column + wide + 1]);
        for r in 0..deep {
            let [near, far] = [row + r, row + r + 1];
            let [z, next_z] = [self.zs[near], self.zs[far]];
            let [y, next_y] = [near, far].map(|row| &self.heights[row * columns + column..][..wide + 1]);
            let cell = (near * (columns - 1) + column) as u32;
            for c in 0..wide {
                let (a, b) = ([xs[c], y[c], z], [xs[c], next_y[c], next_z]);
                let (d, e) = ([xs[c + 1], next_y[c + 1], next_z], [xs[c + 1], y[c + 1], z]);
                for (half, corners) in [[a, b, d], [a, d, e]].into_iter().enumerate() {
                    let lane = (2 * r + half) * wide + c;
                    for (i, x) in corners.as_flattened().iter().enumerate() {
                        rows[i * count + lane] = *x;
                    }
                    rows[(ROWS - 1) * count + lane] = f32::from_bits((2 * (cell + c as u32) + half as u32) | TAG);
                }
            }
        }
    }
}
