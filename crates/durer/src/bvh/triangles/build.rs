//! Making a tree of triangles, and making it fit again when vertices have moved.

use super::TriangleBvh;
use crate::bvh::build::{self, Preset, Settings};
use crate::bvh::lanes::{Available, WIDTH};
use crate::bvh::node;
use crate::math::{Aabb, Vec3};

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
        let mut bvh = TriangleBvh {
            corners: vec![0.0; 9 * tree.order.len() + WIDTH],
            nodes: tree.nodes,
            order: tree.order,
            bounds: tree.bounds,
            reach: tree.bounds.reach(),
            level: Available::chosen(),
            least_volume: 0.0,
        };
        bvh.pack(corners_of);
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
        self.pack(corners_of);
        // Children come after their parents, so boxes are right from the end.
        for number in (0..self.nodes.len()).rev() {
            let children: Vec<(usize, Aabb, u32)> = self.nodes[number].children().collect();
            for (place, _, child) in children {
                let bounds = match child & node::LEAF {
                    0 => self.nodes[child as usize].children().fold(Aabb::EMPTY, |b, (_, c, _)| b.union(c)),
                    _ => {
                        let (first, count) = node::items(child);
                        Aabb::around(self.order[first..first + count].iter().flat_map(|&i| corners_of(i)))
                    }
                };
                self.nodes[number].set(place, bounds, child);
            }
        }
        self.bounds =
            self.nodes.first().map_or(Aabb::EMPTY, |root| root.children().fold(Aabb::EMPTY, |b, c| b.union(c.1)));
        self.reach = self.bounds.reach();
    }

    /// Writes the corners of all leaves.
    fn pack(&mut self, corners_of: impl Fn(u32) -> [Vec3; 3]) {
        for node in &self.nodes {
            for (_, _, child) in node.children().filter(|(_, _, child)| child & node::LEAF != 0) {
                let (first, count) = node::items(child);
                for lane in 0..count {
                    let corners = corners_of(self.order[first + lane]);
                    for (corner, p) in corners.into_iter().enumerate() {
                        for axis in 0..3 {
                            self.corners[9 * first + (3 * corner + axis) * count + lane] = p[axis];
                        }
                    }
                }
            }
        }
    }
}
