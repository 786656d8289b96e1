//! Builds a [`TriangleBvh`], and refits it to moved vertices.

use super::rows::{number, put};
use super::tree::TriangleBvh;
use crate::BuildError;
use crate::build::{self, BuildQuality, BuildSettings, is_finite};
use crate::lanes::{ROWS, ROWS_LEN, parallel_vec};
use crate::math::{Aabb, Vec3};
use crate::{node, parallel};
use std::mem::MaybeUninit;

/// Approximate number of triangles whose rows one parallel task writes.
const AT_ONCE: usize = 1024;

impl TriangleBvh {
    /// Builds a tree over triangles given as three vertex indices each. Triangles with a non-finite
    /// corner are never hit.
    ///
    /// The result depends only on the arguments. The tree takes about 50 bytes per triangle, or up
    /// to 100 if triangles overlap a lot. The build temporarily takes up to 140 additional bytes
    /// per triangle (340 with [`BuildQuality::Best`]). The depth of the tree is bounded for any
    /// input.
    ///
    /// # Panics
    ///
    /// Panics if [`TriangleBvh::try_build`] fails.
    pub fn build(vertices: &[Vec3], triangles: &[[u32; 3]], quality: BuildQuality) -> Self {
        Self::try_build(vertices, triangles, quality).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Builds a tree as [`TriangleBvh::build`] does, and returns an error for invalid input.
    ///
    /// # Errors
    ///
    /// Returns an error if an index is out of range or if there are 2^28 triangles or more.
    ///
    /// # Panics
    ///
    /// Panics if the tree has more than 2^26 nodes. Ordinary meshes have about 25 triangles per
    /// node.
    pub fn try_build(vertices: &[Vec3], triangles: &[[u32; 3]], quality: BuildQuality) -> Result<Self, BuildError> {
        if triangles.len() > node::MAX_ITEMS {
            return Err(BuildError::TooManyTriangles { triangles: triangles.len() });
        }
        check_indices(vertices, triangles)?;
        Ok(match triangles.len() > AT_ONCE {
            true => parallel::on_pool(|| Self::built(vertices, triangles, quality)),
            false => Self::built(vertices, triangles, quality),
        })
    }

    /// Builds a tree from flat lists, with x, y, and z of each vertex and the three indices of each
    /// triangle.
    ///
    /// # Errors
    ///
    /// Returns an error if the length of a list is not a multiple of three, if an index is out of
    /// range, or if there are 2^28 triangles or more.
    ///
    /// ```
    /// use durer_bvh::{BuildError, BuildQuality, TriangleBvh};
    ///
    /// let positions = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    /// let bvh = TriangleBvh::from_flat(&positions, &[0, 1, 2], BuildQuality::default()).unwrap();
    /// assert_eq!(bvh.triangle_count(), 1);
    /// let refused = TriangleBvh::from_flat(&positions, &[0, 1, 3], BuildQuality::default());
    /// let error = refused.unwrap_err();
    /// assert_eq!(error, BuildError::MissingVertex { triangle: 0, index: 3, vertices: 3 });
    /// ```
    pub fn from_flat(positions: &[f32], indices: &[u32], quality: BuildQuality) -> Result<Self, BuildError> {
        let (vertices, rest) = positions.as_chunks::<3>();
        if !rest.is_empty() {
            return Err(BuildError::NotMultipleOfThree { list: "positions", len: positions.len() });
        }
        let (triangles, rest) = indices.as_chunks::<3>();
        if !rest.is_empty() {
            return Err(BuildError::NotMultipleOfThree { list: "indices", len: indices.len() });
        }
        let vertices: Vec<Vec3> = vertices.iter().map(|v| Vec3::from_array(*v)).collect();
        Self::try_build(&vertices, triangles, quality)
    }

    fn built(vertices: &[Vec3], triangles: &[[u32; 3]], quality: BuildQuality) -> Self {
        let settings = BuildSettings::triangles(quality);
        let corners_of = |number: u32| triangles[number as usize].map(|i| vertices[i as usize]);
        let tree = build::build_triangles(triangles.len(), &corners_of, &settings);
        let leaves = parallel_vec(ROWS * tree.order.len() + ROWS_LEN, 0, |_| 0.0);
        let mut bvh = TriangleBvh::of(tree.nodes, leaves, tree.bounds, triangles.len());
        bvh.pack(Some(&tree.order), vertices, triangles);
        bvh
    }

    /// Fits the tree to moved vertices of the same triangles. Refitting is much faster than
    /// building, but rays become slower the farther the vertices move.
    ///
    /// # Panics
    ///
    /// Panics if [`TriangleBvh::try_refit`] fails.
    pub fn refit(&mut self, vertices: &[Vec3], triangles: &[[u32; 3]]) {
        self.try_refit(vertices, triangles).unwrap_or_else(|error| panic!("{error}"));
    }

    /// Refits the tree as [`TriangleBvh::refit`] does, and returns an error for invalid input. If
    /// there is an error, the tree is unchanged.
    ///
    /// # Errors
    ///
    /// Returns an error if an index is out of range or if the number of triangles has changed since
    /// the build.
    pub fn try_refit(&mut self, vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), BuildError> {
        if triangles.len() != self.count {
            return Err(BuildError::TriangleCountMismatch { built: self.count, refitted: triangles.len() });
        }
        check_indices(vertices, triangles)?;
        if self.heights.is_some() {
            *self = self.expanded();
        }
        self.pack(None, vertices, triangles);
        let mut nodes = std::mem::take(&mut self.nodes);
        node::refit(&mut nodes, |leaf| {
            let mut room = MaybeUninit::uninit();
            let (rows, count) = self.rows(leaf, &mut room);
            let numbers = (0..count).map(|lane| number(rows, count, lane));
            let corners = numbers.map(|number| triangles[number as usize].map(|i| vertices[i as usize]));
            Aabb::around(corners.filter(is_finite).flatten())
        });
        self.bounds = node::bounds(&nodes);
        self.reach = self.bounds.max_abs_coordinate();
        self.nodes = nodes;
        Ok(())
    }

    /// Returns the number of triangles that the tree was built over.
    pub fn triangle_count(&self) -> usize {
        self.count
    }

    /// Returns the total number of triangles in all leaves. It exceeds
    /// [`TriangleBvh::triangle_count`] if some triangles were split.
    pub(super) fn items(&self) -> usize {
        (self.leaves.len() - ROWS_LEN) / ROWS
    }

    /// Writes the rows of all leaves. The triangle numbers come from `order`, or stay as they are
    /// if it is `None`.
    fn pack(&mut self, order: Option<&[u32]>, vertices: &[Vec3], triangles: &[[u32; 3]]) {
        let items = self.items();
        // Number of triangles in each leaf, at the position of the leaf's first item.
        let mut counts = vec![0u8; items];
        for (_, _, child) in self.nodes.iter().flat_map(|node| node.children()) {
            if child & node::LEAF != 0 {
                let (first, count) = node::items(child);
                counts[first] = count as u8;
            }
        }
        // Consecutive leaves have consecutive rows.
        let (mut rest, mut first, mut parts) = (&mut self.leaves[..], 0, Vec::with_capacity(items / AT_ONCE + 1));
        while first < items {
            let mut last = first + AT_ONCE;
            while last < items && counts[last] == 0 {
                last += 1;
            }
            let last = last.min(items);
            let (part, after) = rest.split_at_mut(ROWS * (last - first));
            parts.push((first, &counts[first..last], part));
            (first, rest) = (last, after);
        }
        parallel::for_each(parts, |(first, mut counts, mut part)| {
            let numbers: Vec<u32> = match order {
                Some(order) => order[first..first + counts.len()].to_vec(),
                None => numbers(counts, part),
            };
            // Reading all indices at once allows the cache misses to overlap.
            let mut indices = numbers.iter().map(|&number| triangles[number as usize]).collect::<Vec<_>>().into_iter();
            let mut numbers = numbers.into_iter();
            while let Some(&count) = counts.first() {
                let count = usize::from(count);
                debug_assert!(count > 0, "every item is in a leaf");
                let (rows, after) = part.split_at_mut(ROWS * count);
                for (lane, (number, triangle)) in numbers.by_ref().zip(indices.by_ref()).take(count).enumerate() {
                    put(&mut rows[lane..], count, number, triangle.map(|i| vertices[i as usize]));
                }
                (counts, part) = (&counts[count..], after);
            }
        });
    }
}

fn check_indices(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), BuildError> {
    let is_wrong = |triangle: &[u32; 3]| triangle.iter().any(|i| *i as usize >= vertices.len());
    // Indices are nearly always valid, so the code searches for the first invalid index only if
    // there is one.
    if !parallel::any(triangles, 1 << 16, is_wrong) {
        return Ok(());
    }
    let wrong = triangles.iter().enumerate().find_map(|(i, triangle)| {
        let index = triangle.iter().copied().find(|i| *i as usize >= vertices.len())?;
        Some(BuildError::MissingVertex { triangle: i, index, vertices: vertices.len() })
    });
    wrong.map_or(Ok(()), Err)
}

/// Returns the triangle numbers of some leaves, given their rows and counts.
fn numbers(counts: &[u8], mut rows: &[f32]) -> Vec<u32> {
    let mut numbers = Vec::with_capacity(counts.len());
    while numbers.len() < counts.len() {
        let count = usize::from(counts[numbers.len()]);
        numbers.extend((0..count).map(|lane| number(rows, count, lane)));
        rows = &rows[ROWS * count..];
    }
    numbers
}
