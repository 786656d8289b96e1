//! Making a tree of triangles, and making it fit again when vertices have moved.

use super::{TAG, TriangleBvh, number};
use crate::bvh::build::{self, Preset, Settings, is_finite};
use crate::bvh::lanes::{Available, ROWS, Rows, large_pages};
use crate::bvh::node;
use crate::math::{Aabb, Vec3};
use rayon::prelude::*;

/// Rows of so many leaves are written at once.
const AT_ONCE: usize = 1024;

impl TriangleBvh {
    /// Builds over triangles given as three indices each. Those with a corner that is no finite point are never hit.
    ///
    /// The result is a function of the arguments alone. It takes about 50 bytes a triangle, and beside that about 150 while
    /// it is built; the depth is bounded, whatever the triangles.
    ///
    /// # Panics
    ///
    /// If an index leads nowhere, or there are more than 2^28 triangles.
    pub fn build(vertices: &[Vec3], triangles: &[[u32; 3]], preset: Preset) -> Self {
        let settings = Settings::triangles(preset);
        let corners_of = |number: u32| triangles[number as usize].map(|i| vertices[i as usize]);
        let tree = build::build_triangles(triangles.len(), &corners_of, &settings);
        let leaves = vec![0.0; ROWS * tree.order.len() + size_of::<Rows>() / size_of::<f32>()];
        large_pages(leaves.as_ptr(), leaves.len());
        let mut nodes = Vec::with_capacity(tree.nodes.len());
        large_pages(nodes.as_ptr(), nodes.capacity());
        nodes.extend_from_slice(&tree.nodes);
        let mut bvh = TriangleBvh {
            leaves,
            nodes,
            bounds: tree.bounds,
            reach: tree.bounds.reach(),
            level: Available::chosen(),
            least_volume: 0.0,
            blind: false,
        };
        bvh.pack(Some(&tree.order), corners_of);
        bvh
    }

    /// Makes the tree fit the same triangles with vertices that have moved. Much faster than building; but the
    /// farther they move, the slower rays become.
    ///
    /// # Panics
    ///
    /// If an index leads nowhere, or a triangle of the tree is missing.
    pub fn refit(&mut self, vertices: &[Vec3], triangles: &[[u32; 3]]) {
        let corners_of = |number: u32| triangles[number as usize].map(|i| vertices[i as usize]);
        self.pack(None, corners_of);
        // Children come after their parents, so boxes are right from the end.
        for parent in (0..self.nodes.len()).rev() {
            let children: Vec<(usize, Aabb, u32)> = self.nodes[parent].children().collect();
            for (place, _, child) in children {
                let bounds = match child & node::LEAF {
                    0 => self.nodes[child as usize].children().fold(Aabb::EMPTY, |b, (_, c, _)| b.union(c)),
                    _ => {
                        let (rows, count) = self.rows(child);
                        let corners = (0..count).map(|lane| corners_of(number(rows, count, lane)));
                        Aabb::around(corners.filter(is_finite).flatten())
                    }
                };
                // Where nothing can be hit for now, the old box keeps the place.
                if !bounds.is_empty() {
                    self.nodes[parent].set(place, bounds, child);
                }
            }
        }
        self.bounds =
            self.nodes.first().map_or(Aabb::EMPTY, |root| root.children().fold(Aabb::EMPTY, |b, c| b.union(c.1)));
        self.reach = self.bounds.reach();
    }

    /// Writes all leaves, with numbers in the order of items, or again with those that they have.
    fn pack(&mut self, order: Option<&[u32]>, corners_of: impl Fn(u32) -> [Vec3; 3] + Sync) {
        let children = self.nodes.iter().flat_map(|node| node.children().map(|(_, _, child)| child));
        let mut leaves: Vec<u32> = children.filter(|child| child & node::LEAF != 0).collect();
        leaves.par_sort_unstable_by_key(|&leaf| node::items(leaf).0);
        // Leaves that follow each other have rows that do.
        let (mut rest, mut parts) = (&mut self.leaves[..], Vec::with_capacity(leaves.len() / AT_ONCE + 1));
        for leaves in leaves.chunks(AT_ONCE) {
            let count: usize = leaves.iter().map(|&leaf| node::items(leaf).1).sum();
            let (part, after) = rest.split_at_mut(ROWS * count);
            parts.push((leaves, part));
            rest = after;
        }
        parts.into_par_iter().for_each(|(leaves, mut part)| {
            for &leaf in leaves {
                let (first, count) = node::items(leaf);
                let (rows, after) = part.split_at_mut(ROWS * count);
                for lane in 0..count {
                    let number = order.map_or_else(|| number(rows, count, lane), |order| order[first + lane]);
                    let corners = Some(corners_of(number)).filter(is_finite).unwrap_or([Vec3::NAN; 3]);
                    for row in 0..9 {
                        rows[row * count + lane] = corners[row / 3][row % 3];
                    }
                    rows[9 * count + lane] = f32::from_bits(number | TAG);
                }
                part = after;
            }
        });
    }
}
