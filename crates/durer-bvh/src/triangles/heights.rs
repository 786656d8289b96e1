//! Trees over height grids.
//!
//! The leaves are blocks of two by two cells of a [`HeightGrid`]. The rows of a leaf are computed
//! whenever a ray visits it. Everything else works as for other triangles.

use super::height_grid::HeightGrid;
use super::rows::put;
use super::tree::TriangleBvh;
use crate::build::{self, BuildQuality, BuildSettings, is_finite};
use crate::lanes::{ROWS, ROWS_LEN};
use crate::math::{Aabb, Vec3};
use crate::node::{self, LEAF, LEAF_SIZE};
use crate::{BuildError, parallel};
use std::sync::{Arc, OnceLock};

impl TriangleBvh {
    /// Builds a tree over a height grid and other triangles, for example walls around it. The other
    /// triangles are numbered after those of the grid. Each leaf holds eight consecutive triangles
    /// of `others`, so neighbouring triangles should be close to each other in that list.
    ///
    /// Hits have the same bits as in a tree that stores all triangles. In addition to the heights,
    /// the tree takes about 5 bytes per triangle of the grid, and the build takes up to 20 more.
    ///
    /// # Errors
    ///
    /// Returns [`BuildError::TooManyTriangles`] if there are 2^28 triangles or more.
    ///
    /// ```
    /// use durer_bvh::math::{Ray, Vec3};
    /// use durer_bvh::{BuildQuality, HeightGrid, TriangleBvh};
    /// use std::sync::Arc;
    ///
    /// // A slope of two cells: y = x.
    /// let heights = vec![0.0, 1.0, 2.0, 0.0, 1.0, 2.0];
    /// let grid = HeightGrid::new(vec![0.0, 1.0, 2.0], vec![0.0, 1.0], heights)?;
    /// let tree = TriangleBvh::over_heights(Arc::new(grid), &[], BuildQuality::default())?;
    /// let hit = tree.closest(&Ray::new(Vec3::new(1.5, 5.0, 0.25), Vec3::NEG_Y)).unwrap();
    /// assert_eq!((hit.t, hit.triangle), (3.5, 3));
    /// # Ok::<(), durer_bvh::BuildError>(())
    /// ```
    pub fn over_heights(
        grid: Arc<HeightGrid>,
        others: &[[Vec3; 3]],
        quality: BuildQuality,
    ) -> Result<Self, BuildError> {
        let count = grid.triangle_count() + others.len();
        if count > node::MAX_ITEMS {
            return Err(BuildError::TooManyTriangles { triangles: count });
        }
        Ok(parallel::on_pool(|| Self::built_over_heights(grid, others, quality)))
    }

    fn built_over_heights(grid: Arc<HeightGrid>, others: &[[Vec3; 3]], quality: BuildQuality) -> Self {
        let blocks = grid.blocks().iter().product();
        let mut boxes: Vec<Aabb> = (0..blocks).map(|block| grid.block_bounds(block)).collect();
        let is_hit = |corners: &&[Vec3; 3]| is_finite(corners);
        boxes.extend(others.chunks(LEAF_SIZE).map(|some| Aabb::around(some.iter().filter(is_hit).flatten().copied())));
        let tree = build::build(build::references(&boxes), &BuildSettings::blocks(quality));
        drop(boxes);
        let mut leaves = vec![0.0; ROWS * others.len()];
        for (number, some) in others.chunks(LEAF_SIZE).enumerate() {
            let first = LEAF_SIZE * number;
            let rows = &mut leaves[ROWS * first..];
            for (lane, corners) in some.iter().enumerate() {
                put(&mut rows[lane..], some.len(), (grid.triangle_count() + first + lane) as u32, *corners);
            }
        }
        leaves.resize(ROWS * others.len() + ROWS_LEN, 0.0);
        let count = grid.triangle_count() + others.len();
        let mut bvh = TriangleBvh::of(tree.nodes, leaves, tree.bounds, count);
        let first_block = bvh.first_block();
        bvh.change_leaves(|leaf| {
            let item = tree.order[node::items(leaf).0] as usize;
            match item.checked_sub(blocks) {
                None => node::leaf(first_block + item, 2 * grid.cells(item)[1].iter().product::<usize>()),
                Some(some) => {
                    let first = LEAF_SIZE * some;
                    node::leaf(first, LEAF_SIZE.min(others.len() - first))
                }
            }
        });
        TriangleBvh { heights: Some(grid), ..bvh }
    }

    /// Returns the item number of the first block. Blocks are numbered after all items whose rows
    /// are in memory.
    pub(super) fn first_block(&self) -> usize {
        self.items() + 1
    }

    fn change_leaves(&mut self, mut change: impl FnMut(u32) -> u32) {
        for node in &mut self.nodes {
            let leaves: Vec<(usize, u32)> = node.children().map(|(place, _, child)| (place, child)).collect();
            for (place, leaf) in leaves.into_iter().filter(|(_, child)| child & LEAF != 0) {
                node.children[place] = change(leaf);
            }
        }
    }

    /// Returns a copy of the tree with the rows of all leaves in memory.
    pub(super) fn expanded(&self) -> Self {
        let Some(grid) = &self.heights else { return self.clone() };
        let (first_block, mut items) = (self.first_block(), self.items());
        let mut all = TriangleBvh { heights: None, leaf_of: OnceLock::new(), ..self.clone() };
        let mut leaves = self.leaves[..ROWS * items].to_vec();
        all.change_leaves(|leaf| {
            let (first, count) = node::items(leaf);
            let Some(block) = first.checked_sub(first_block) else { return leaf };
            let mut rows = [0.0; ROWS_LEN];
            grid.write_rows(block, &mut rows);
            leaves.extend(&rows[..ROWS * count]);
            items += count;
            node::leaf(items - count, count)
        });
        leaves.resize(ROWS * items + ROWS_LEN, 0.0);
        TriangleBvh { leaves, ..all }
    }
}
