//! Making a tree of triangles, and making it fit again when vertices have moved.

use super::TriangleBvh;
use crate::bvh::build::{self, Preset, Settings};
use crate::bvh::lanes::{Available, WIDTH};
use crate::bvh::node::{self, Node};
use crate::math::{Aabb, Vec3};
use rayon::prelude::*;
use std::cmp::Reverse;

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
    fn pack(&mut self, corners_of: impl Fn(u32) -> [Vec3; 3] + Sync) {
        let packer = Packer { nodes: &self.nodes, order: &self.order, corners_of };
        if !self.nodes.is_empty() {
            packer.pack(0, 0, &mut self.corners[..9 * self.order.len()]);
        }
    }
}

/// So many numbers are written in parallel.
const PARALLEL: usize = 9 * 4096;

struct Packer<'a, C> {
    nodes: &'a [Node],
    order: &'a [u32],
    corners_of: C,
}

impl<C: Fn(u32) -> [Vec3; 3] + Sync> Packer<'_, C> {
    /// Writes the corners of all leaves below a node, into those of the items from number `first` on.
    fn pack(&self, number: u32, first: usize, mut corners: &mut [f32]) {
        let node = &self.nodes[number as usize];
        let mut children: Vec<(usize, u32)> = node.children().map(|(_, _, child)| (self.first(child), child)).collect();
        // Items of a child follow each other, so each child gets a part, from the last to the first.
        children.sort_unstable_by_key(|&(start, _)| Reverse(start));
        let mut parts = Vec::with_capacity(children.len());
        for (start, child) in children {
            let (before, part) = corners.split_at_mut(9 * (start - first));
            parts.push((start, child, part));
            corners = before;
        }
        parts.into_par_iter().for_each(|(start, child, part)| match (child & node::LEAF, part.len()) {
            (0, ..PARALLEL) => self.pack_few(child, start, part),
            (0, _) => self.pack(child, start, part),
            _ => self.leaf(child, part),
        });
    }

    /// The same without parts.
    fn pack_few(&self, number: u32, first: usize, corners: &mut [f32]) {
        for (_, _, child) in self.nodes[number as usize].children() {
            match child & node::LEAF {
                0 => self.pack_few(child, first, corners),
                _ => {
                    let (start, count) = node::items(child);
                    self.leaf(child, &mut corners[9 * (start - first)..][..9 * count]);
                }
            }
        }
    }

    /// The first item of a child: its own items come before those of its inner children, and these by number.
    fn first(&self, mut child: u32) -> usize {
        while child & node::LEAF == 0 {
            let children = self.nodes[child as usize].children().map(|(_, _, child)| child);
            let place = |&child: &u32| match child & node::LEAF {
                0 => (1, child as usize),
                _ => (0, node::items(child).0),
            };
            child = children.min_by_key(place).expect("a node has children");
        }
        node::items(child).0
    }

    fn leaf(&self, leaf: u32, rows: &mut [f32]) {
        let (first, count) = node::items(leaf);
        for (lane, &number) in self.order[first..first + count].iter().enumerate() {
            let corners = (self.corners_of)(number);
            for row in 0..9 {
                rows[row * count + lane] = corners[row / 3][row % 3];
            }
        }
    }
}
