//! Heights over a grid: a landscape whose triangles need not be in memory.

use super::rows::TAG;
use crate::BuildError;
use crate::lanes::{ROWS, Rows};
use crate::math::{Aabb, Vec3};
use crate::node::{self, LEAF_SIZE};

/// So many cells a block has along either axis, at most.
const SIDE: usize = 2;
const _: () = assert!(2 * SIDE * SIDE == LEAF_SIZE);

/// A landscape: heights y over the crossings of lines of constant x and lines of constant z.
///
/// Crossings are numbered along x first. Between four neighbours lies a cell, of two triangles: of
/// the corners a at the lesser numbers of both lines, b at the next z, c at the next x, and d at
/// both, the triangles are (a, b, d) and (a, d, c), with the numbers 2 i and 2 i + 1 in cell i.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightGrid {
    xs: Vec<f32>,
    zs: Vec<f32>,
    heights: Vec<f32>,
}

impl HeightGrid {
    /// Lines at these x and z, and the heights of their crossings.
    ///
    /// # Errors
    ///
    /// If there are fewer than two lines either way, or not as many heights as crossings, or
    /// numbers that are not finite, or 2^28 triangles or more.
    pub fn new(xs: Vec<f32>, zs: Vec<f32>, heights: Vec<f32>) -> Result<Self, BuildError> {
        let (columns, rows) = (xs.len(), zs.len());
        if columns < 2 || rows < 2 || columns.checked_mul(rows) != Some(heights.len()) {
            return Err(BuildError::NoGrid { columns, rows, heights: heights.len() });
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

    /// The x of the lines that go along z.
    pub fn xs(&self) -> &[f32] {
        &self.xs
    }

    /// The z of the lines that go along x.
    pub fn zs(&self) -> &[f32] {
        &self.zs
    }

    /// The heights of all crossings.
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// The same with other coordinates: what is given makes one of each, by axis.
    pub fn map(&self, mut coordinate: impl FnMut(usize, f32) -> f32) -> Self {
        let mut along = |axis: usize, list: &[f32]| list.iter().map(|x| coordinate(axis, *x)).collect();
        HeightGrid { xs: along(0, &self.xs), zs: along(2, &self.zs), heights: along(1, &self.heights) }
    }

    /// How many triangles lie between the crossings.
    pub fn triangle_count(&self) -> usize {
        2 * (self.xs.len() - 1) * (self.zs.len() - 1)
    }

    /// A crossing.
    #[inline]
    pub fn point(&self, crossing: usize) -> Vec3 {
        let (number, columns) = (crossing as u32, self.xs.len() as u32);
        let row = number / columns;
        Vec3::new(self.xs[(number - row * columns) as usize], self.heights[crossing], self.zs[row as usize])
    }

    /// The crossings at the corners of a triangle.
    #[inline]
    pub fn triangle(&self, number: usize) -> [u32; 3] {
        let [column, row] = self.cell(number);
        let columns = self.xs.len() as u32;
        let a = row * columns + column;
        let b = a + columns;
        if number.is_multiple_of(2) { [a, b, b + 1] } else { [a, b + 1, a + 1] }
    }

    /// The corners of a triangle.
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

    /// The column and the row of a triangle's cell.
    #[inline]
    fn cell(&self, triangle: usize) -> [u32; 2] {
        // Division of short numbers takes less time.
        let (cell, wide) = ((triangle / 2) as u32, (self.xs.len() - 1) as u32);
        let row = cell / wide;
        [cell - row * wide, row]
    }

    /// The box around all crossings.
    pub fn bounds(&self) -> Aabb {
        let ends =
            |list: &[f32]| list.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
        let [[x, x1], [y, y1], [z, z1]] = [&self.xs, &self.heights, &self.zs].map(|list| ends(list));
        Aabb { min: Vec3::new(x, y, z), max: Vec3::new(x1, y1, z1) }
    }

    /// Bytes in memory.
    pub fn memory_usage(&self) -> usize {
        size_of_val(&*self.xs) + size_of_val(&*self.zs) + size_of_val(&*self.heights)
    }

    /// How many blocks lie beside each other, and how many behind.
    pub(super) fn blocks(&self) -> [usize; 2] {
        [&self.xs, &self.zs].map(|lines| (lines.len() - 1).div_ceil(SIDE))
    }

    /// The first column and row of a block, and how many cells it has along x and along z.
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

    /// Writes the rows of a block as those of any leaf.
    pub(super) fn write_rows(&self, block: usize, rows: &mut Rows) {
        let [first, cells] = self.cells(block);
        match cells {
            // Known when this is compiled, so that there are no loops.
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
