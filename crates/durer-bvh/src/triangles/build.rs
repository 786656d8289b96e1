//! Making a tree of triangles, and making it fit again when vertices have moved.

use super::{TAG, TriangleBvh, number};
use crate::build::{self, BuildQuality, BuildSettings, is_finite};
use crate::lanes::{Available, ROOM_OF_ROWS, ROWS, listed};
use crate::math::{Aabb, Vec3};
use crate::node;
use rayon::prelude::*;

/// Rows of about so many triangles are written at once.
const AT_ONCE: usize = 1024;

impl TriangleBvh {
    /// Builds over triangles given as three indices each. Those with a corner that is no finite point are never hit.
    ///
    /// The result is a function of the arguments alone. It takes about 50 bytes a triangle, up to 100 where they overlap much, and while it is
    /// built up to 140 more, with `balanced` 200 and with `best` 340; the depth is bounded, whatever the triangles.
    ///
    /// # Panics
    ///
    /// If an index leads nowhere, or there are 2^28 triangles or more, or more than 2^26 nodes (of usual triangles there are 25 for a node).
    pub fn build(vertices: &[Vec3], triangles: &[[u32; 3]], quality: BuildQuality) -> Self {
        // All of it on a thread of the pool: from outside, each step that is shared would be handed over and waited for.
        match triangles.len() > AT_ONCE {
            true => rayon::scope(|_| Self::built(vertices, triangles, quality)),
            false => Self::built(vertices, triangles, quality),
        }
    }

    fn built(vertices: &[Vec3], triangles: &[[u32; 3]], quality: BuildQuality) -> Self {
        let settings = BuildSettings::triangles(quality);
        let corners_of = |number: u32| triangles[number as usize].map(|i| vertices[i as usize]);
        let tree = build::build_triangles(triangles.len(), &corners_of, &settings);
        let mut bvh = TriangleBvh {
            leaves: listed(ROWS * tree.order.len() + ROOM_OF_ROWS, 0, |_| 0.0),
            nodes: tree.nodes,
            bounds: tree.bounds,
            reach: tree.bounds.reach(),
            level: Available::chosen(),
            least_volume: 0.0,
            culls_slivers: false,
        };
        bvh.pack(Some(&tree.order), vertices, triangles);
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
        self.pack(None, vertices, triangles);
        // Children come after their parents, so boxes are right from the end.
        for parent in (0..self.nodes.len()).rev() {
            let children: Vec<(usize, Aabb, u32)> = self.nodes[parent].children().collect();
            for (place, _, child) in children {
                let bounds = match child & node::LEAF {
                    0 => self.nodes[node::number(child)].children().fold(Aabb::EMPTY, |b, (_, c, _)| b.union(c)),
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

    /// How many triangles all leaves have together: more than there are where some were cut.
    pub(super) fn items(&self) -> usize {
        (self.leaves.len() - ROOM_OF_ROWS) / ROWS
    }

    /// Writes all leaves, with numbers in the order of items, or again with those that they have.
    fn pack(&mut self, order: Option<&[u32]>, vertices: &[Vec3], triangles: &[[u32; 3]]) {
        let items = self.items();
        // The count of each leaf, where its items begin.
        let mut counts = vec![0u8; items];
        for (_, _, child) in self.nodes.iter().flat_map(|node| node.children()) {
            if child & node::LEAF != 0 {
                let (first, count) = node::items(child);
                counts[first] = count as u8;
            }
        }
        // Leaves that follow each other have rows that do.
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
        parts.into_par_iter().for_each(|(first, mut counts, mut part)| {
            let numbers: Vec<u32> = match order {
                Some(order) => order[first..first + counts.len()].to_vec(),
                None => numbers(counts, part),
            };
            // Memory is waited for less where all are asked for at once.
            let mut indices = numbers.iter().map(|&number| triangles[number as usize]).collect::<Vec<_>>().into_iter();
            let mut numbers = numbers.into_iter();
            while let Some(&count) = counts.first() {
                let count = usize::from(count);
                debug_assert!(count > 0, "every item is in a leaf");
                let (rows, after) = part.split_at_mut(ROWS * count);
                for (lane, (number, triangle)) in numbers.by_ref().zip(indices.by_ref()).take(count).enumerate() {
                    let corners = triangle.map(|i| vertices[i as usize]);
                    let [a, b, c] = if is_finite(&corners) { corners } else { [Vec3::NAN; 3] };
                    let tagged = f32::from_bits(number | TAG);
                    let column = [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, tagged];
                    rows[lane..].iter_mut().step_by(count).zip(column).for_each(|(to, x)| *to = x);
                }
                (counts, part) = (&counts[count..], after);
            }
        });
    }
}

/// The numbers of all triangles of some leaves, by the rows and counts of these.
fn numbers(counts: &[u8], mut rows: &[f32]) -> Vec<u32> {
    let mut numbers = Vec::with_capacity(counts.len());
    while numbers.len() < counts.len() {
        let count = usize::from(counts[numbers.len()]);
        numbers.extend((0..count).map(|lane| number(rows, count, lane)));
        rows = &rows[ROWS * count..];
    }
    numbers
}
