//! A height field: a terrain whose heights are the pixels of an image, represented as a closed
//! mesh.

use super::MeshData;
use super::mesh_data::Triangles;
use crate::describe::{Constraint, FileName, described};
use crate::dialect::set;
use crate::math::{Aabb, Vec2, Vec3};
use crate::source::Digest;
use durer_bvh::{BuildQuality, HeightGrid, TriangleBvh};
use std::sync::Arc;

described! {
    /// A block whose top is a terrain. The grey values of an image are the heights, and its lower
    /// edge is towards +z.
    HeightField ["HeightField" in set::DURER] {
        /// Path of the height image. Black is lowest; white, or 1 in floating-point images, is
        /// highest.
        picture: FileName = FileName::default(), required, Constraint::Any, ["picture" in set::DURER];
        /// Corner of the terrain's box with the smallest coordinates; heights there are 0.
        min: Vec3 = Vec3::splat(-1.0), required, Constraint::Any, ["min" in set::DURER];
        /// Corner of the terrain's box with the largest coordinates; heights there are 1.
        max: Vec3 = Vec3::ONE, required, Constraint::Any, ["max" in set::DURER];
        /// Depth of the block below `min`.
        depth: f32 = 1.0, optional, Constraint::Positive, ["depth" in set::DURER];
    }
}

impl HeightField {
    /// Maximum number of pixels in a height image.
    pub const MAX_PIXELS: usize = 1 << 24;

    /// Checks that the fields are valid in combination.
    ///
    /// # Errors
    ///
    /// Fails if `min` is not less than `max` in some coordinate.
    pub fn validate(&self) -> Result<(), String> {
        let wide = self.min.cmplt(self.max).all();
        match wide {
            true => Ok(()),
            false => Err("`min` of a `HeightField` must be less than its `max` in x, y and z".into()),
        }
    }

    /// Builds the terrain. The mesh has two triangles between each group of four neighbouring
    /// pixels, walls around them, and a floor below.
    ///
    /// `heights` holds rows of `columns` values, starting with the top row. The terrain must have
    /// at least 2 rows and 2 columns. Returns `None` if any coordinate exceeds the range of `f32`.
    pub fn terrain(&self, columns: usize, mut heights: Vec<f32>) -> Option<Terrain> {
        let rows = heights.len() / columns;
        let size = self.max - self.min;
        let line =
            |axis: usize, count: usize| (0..count).map(|i| self.min[axis] + size[axis] * share(i, count)).collect();
        heights.iter_mut().for_each(|height| *height = self.min.y + size.y * *height);
        let floor_center = (self.min + 0.5 * size).with_y(self.min.y - self.depth);
        let grid = HeightGrid::new(line(0, columns), line(2, rows), heights).ok()?;
        floor_center.is_finite().then(|| Terrain { grid: Arc::new(grid), floor_center })
    }
}

/// Returns the relative position of item `i` of `count`, from 0 for the first item to 1 for the
/// last.
fn share(i: usize, count: usize) -> f32 {
    i as f32 / (count - 1) as f32
}

/// Closed mesh of a height field, made of the terrain, walls that go down from its border, and a
/// floor. The triangles are computed on demand.
///
/// The vertices of the terrain come first, followed by one vertex on the floor below each border
/// vertex, and the centre of the floor. The triangles of the terrain come first, followed by two
/// wall triangles for each step along the border, and one floor triangle for each step.
#[derive(Clone, Debug)]
pub struct Terrain {
    /// The terrain.
    grid: Arc<HeightGrid>,
    /// Centre of the floor.
    floor_center: Vec3,
}

impl Terrain {
    /// Returns the terrain without its walls and floor.
    pub fn grid(&self) -> &HeightGrid {
        &self.grid
    }

    /// Builds a BVH over the triangles.
    pub fn tree(&self, quality: BuildQuality) -> TriangleBvh {
        let others = self.grid.triangle_count()..self.len();
        let others: Vec<[Vec3; 3]> = others.map(|i| self.corners(i)).collect();
        match TriangleBvh::over_heights(self.grid.clone(), &others, quality) {
            Ok(tree) => tree,
            Err(error) => unreachable!("{error}"),
        }
    }

    /// Returns the bounds of the terrain, walls and floor.
    pub fn bounds(&self) -> Aabb {
        let bounds = self.grid.bounds();
        Aabb { min: bounds.min.min(self.floor_center), ..bounds }
    }

    /// Returns, for each axis, true if `holds` is true for every coordinate along that axis.
    pub fn all_along(&self, holds: impl Fn(usize, f32) -> bool) -> [bool; 3] {
        let lists = [self.grid.xs(), self.grid.heights(), self.grid.zs()];
        [0, 1, 2].map(|axis| holds(axis, self.floor_center[axis]) && lists[axis].iter().all(|x| holds(axis, *x)))
    }

    /// Returns the terrain translated by `-by`.
    pub fn translated(&self, by: Vec3) -> Self {
        Terrain { grid: Arc::new(self.grid.map(|axis, x| x - by[axis])), floor_center: self.floor_center - by }
    }

    fn sides(&self) -> [usize; 2] {
        [self.grid.xs().len(), self.grid.zs().len()]
    }

    /// Number of vertices along the border.
    fn border_len(&self) -> usize {
        let [columns, rows] = self.sides();
        2 * (columns + rows) - 4
    }

    /// Returns the index of the i-th border vertex, counted counter-clockwise as seen from above.
    fn border(&self, i: usize) -> u32 {
        let [columns, rows] = self.sides();
        let [wide, deep] = [columns - 1, rows - 1];
        let (column, row) = match i {
            _ if i < deep => (0, i),
            _ if i < deep + wide => (i - deep, deep),
            _ if i < 2 * deep + wide => (wide, 2 * deep + wide - i),
            _ => (2 * (deep + wide) - i, 0),
        };
        (row * columns + column) as u32
    }

    /// Returns the index of the grid point at or directly above a vertex, or `None` for the centre
    /// of the floor.
    fn grid_point(&self, vertex: u32) -> Option<usize> {
        match (vertex as usize).checked_sub(self.grid.heights().len()) {
            None => Some(vertex as usize),
            Some(below) => (below < self.border_len()).then(|| self.border(below) as usize),
        }
    }

    /// Returns the texture coordinates of a vertex, which run from 0 to 1 across the image. A wall
    /// vertex has the texture coordinates of the border vertex above it.
    pub fn uv(&self, vertex: u32) -> Vec2 {
        let [columns, rows] = self.sides();
        let Some(vertex) = self.grid_point(vertex) else { return Vec2::splat(0.5) };
        Vec2::new(share(vertex % columns, columns), 1.0 - share(vertex / columns, rows))
    }

    /// Converts the terrain to lists of vertices and triangles.
    pub fn to_data(&self) -> MeshData {
        let triangles: Vec<[u32; 3]> = (0..self.len()).map(|i| self.triangle(i)).collect();
        let vertices = 0..self.vertices() as u32;
        MeshData {
            positions: vertices.clone().map(|i| self.position(i)).collect(),
            uvs: vertices.map(|i| self.uv(i)).collect(),
            triangle_uvs: triangles.clone(),
            triangles,
            ..MeshData::default()
        }
    }

    /// Computes a hash of the whole terrain.
    pub fn digest(&self) -> Digest {
        let mut hasher = Digest::hasher();
        for list in [self.grid.xs(), self.grid.zs(), self.grid.heights(), &self.floor_center.to_array()] {
            hasher.add_u64(list.len() as u64);
            list.iter().for_each(|x| hasher.add_u32(x.to_bits()));
        }
        hasher.finish()
    }
}

impl Triangles for Terrain {
    fn len(&self) -> usize {
        self.grid.triangle_count() + 3 * self.border_len()
    }

    fn vertices(&self) -> usize {
        self.grid.heights().len() + self.border_len() + 1
    }

    #[inline]
    fn triangle(&self, number: usize) -> [u32; 3] {
        let (crossings, around) = (self.grid.heights().len(), self.border_len());
        let Some(other) = number.checked_sub(self.grid.triangle_count()) else { return self.grid.triangle(number) };
        // Find the step along the border, and the vertices below both of its ends.
        let step = if other < 2 * around { other / 2 } else { other - 2 * around };
        let ends = [step, (step + 1) % around];
        let ([p, q], [below_p, below_q]) = (ends.map(|i| self.border(i)), ends.map(|i| (crossings + i) as u32));
        match other {
            _ if other >= 2 * around => [(crossings + around) as u32, below_q, below_p],
            _ if other % 2 == 0 => [p, below_p, below_q],
            _ => [p, below_q, q],
        }
    }

    #[inline]
    fn position(&self, vertex: u32) -> Vec3 {
        match self.grid_point(vertex) {
            Some(crossing) if crossing == vertex as usize => self.grid.point(crossing),
            Some(crossing) => self.grid.point(crossing).with_y(self.floor_center.y),
            None => self.floor_center,
        }
    }

    #[inline]
    fn corners(&self, number: usize) -> [Vec3; 3] {
        match number < self.grid.triangle_count() {
            true => self.grid.corners(number),
            false => self.triangle(number).map(|vertex| self.position(vertex)),
        }
    }

    fn ordered_count(&self) -> usize {
        self.grid.triangle_count()
    }

    fn ordered_around(&self, vertex: u32, mut emit: impl FnMut(u32)) {
        let ([columns, rows], vertex) = (self.sides(), vertex as usize);
        let (column, row) = (vertex % columns, vertex / columns);
        // Each entry describes a cell that touches the vertex. The entry holds the offset of the
        // cell, and the corner at which each of the two triangles in the cell touches the vertex.
        for (across, down, corners) in
            [(1, 1, [Some(2), Some(1)]), (0, 1, [Some(1), None]), (1, 0, [None, Some(2)]), (0, 0, [Some(0); 2])]
        {
            if let (Some(x), Some(y)) = (column.checked_sub(across), row.checked_sub(down))
                && x + 1 < columns
                && y + 1 < rows
            {
                let cell = y * (columns - 1) + x;
                let both = corners.into_iter().enumerate();
                both.for_each(|(half, corner)| _ = corner.map(|k| emit((3 * (2 * cell + half) + k) as u32)));
            }
        }
    }
}
