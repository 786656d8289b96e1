//! CSG solids as trees of boolean operations on closed shapes, and the division of such solids into
//! disjoint pieces according to the bounds of their parts.
//!
//! Parts with disjoint bounds do not affect each other. A union of many separate parts can
//! therefore be divided into many objects, which the world's acceleration structure handles like
//! all other objects, and a subtraction affects only the parts that it touches.

use super::Object;
use durer_scene::math::Aabb;
use std::sync::Arc;

/// Boolean operation of a CSG solid, defined by the number of parts that must contain a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoolOp {
    /// A point must be in at least one part.
    Union,
    /// A point must be in all parts and in none of the subtracted ones.
    Intersection,
    /// A point must be in an odd number of parts.
    Xor,
}

/// CSG solid before it is prepared for rendering, which is a closed shape or a boolean operation on
/// solids.
#[derive(Clone, Debug)]
pub enum CsgTree {
    /// A closed shape or mesh, with its transform to world space.
    Operand(Arc<Object>),
    /// A boolean operation.
    Operation {
        /// Operation that decides which points belong to the result.
        op: BoolOp,
        /// Operands, in file order.
        parts: Vec<CsgTree>,
        /// Subtracted operands, which exist only for [`BoolOp::Intersection`].
        subtracted: Vec<CsgTree>,
    },
}

/// Maximum number of pairs of pieces to compare when a solid is divided. If there are more pairs,
/// the solid is not divided.
const MAX_PAIRS: usize = 1 << 22;

/// Maximum number of copies of parts that the division of a solid may need. If more copies are
/// needed, the solid is not divided.
const MAX_COPIES: usize = 1 << 18;

/// Solid together with its bounds, which are `None` if it is unbounded.
type Piece = (CsgTree, Option<Aabb>);

impl CsgTree {
    /// Returns the union of solids, which is empty if there are none.
    pub fn union(parts: Vec<CsgTree>) -> CsgTree {
        CsgTree::join(BoolOp::Union, parts)
    }

    /// Returns the solid that contains the points that are in an odd number of the given solids.
    pub fn xor(parts: Vec<CsgTree>) -> CsgTree {
        CsgTree::join(BoolOp::Xor, parts)
    }

    /// Returns the intersection of `parts` minus all solids in `cut`. Nested intersections and
    /// subtractions are flattened.
    pub fn intersection(parts: Vec<CsgTree>, cut: Vec<CsgTree>) -> CsgTree {
        let (mut flat, mut flat_cut) = (Vec::new(), Vec::new());
        for part in parts {
            match part {
                CsgTree::Operation { op: BoolOp::Intersection, parts, subtracted } => {
                    flat.extend(parts);
                    flat_cut.extend(subtracted);
                }
                other => flat.push(other),
            }
        }
        for part in cut {
            match part {
                CsgTree::Operation { op: BoolOp::Union, parts, .. } => flat_cut.extend(parts),
                other => flat_cut.push(other),
            }
        }
        match (flat.len(), flat_cut.len()) {
            (1, 0) => flat.remove(0),
            _ => CsgTree::Operation { op: BoolOp::Intersection, parts: flat, subtracted: flat_cut },
        }
    }

    /// Creates an operation, and flattens operands that use the same operation.
    fn join(rule: BoolOp, parts: Vec<CsgTree>) -> CsgTree {
        let mut flat = Vec::with_capacity(parts.len());
        for part in parts {
            match part {
                CsgTree::Operation { op: inner, parts, .. } if inner == rule => flat.extend(parts),
                other => flat.push(other),
            }
        }
        if flat.len() == 1 {
            flat.remove(0)
        } else {
            CsgTree::Operation { op: rule, parts: flat, subtracted: Vec::new() }
        }
    }

    /// Returns the bounds, as tight as the operation allows. Returns `None` if the solid is
    /// unbounded.
    pub fn bounds(&self) -> Option<Aabb> {
        match self {
            CsgTree::Operand(object) => object.bounds(),
            CsgTree::Operation { op: BoolOp::Intersection, parts, .. } => {
                parts.iter().map(CsgTree::bounds).fold(None, common)
            }
            CsgTree::Operation { parts, .. } => {
                parts.iter().try_fold(Aabb::EMPTY, |all, part| Some(all.union(part.bounds()?)))
            }
        }
    }

    /// Returns all shapes and meshes that the solid consists of.
    pub fn parts(&self) -> Vec<&Object> {
        match self {
            CsgTree::Operand(object) => vec![object],
            CsgTree::Operation { parts, subtracted, .. } => {
                parts.iter().chain(subtracted).flat_map(CsgTree::parts).collect()
            }
        }
    }

    /// Divides the solid into disjoint pieces, ordered by their first parts. An empty solid has no
    /// pieces.
    pub fn pieces(self) -> Vec<CsgTree> {
        self.boxed_pieces().into_iter().map(|piece| piece.0).collect()
    }

    /// Divides the solid into disjoint pieces with their bounds.
    fn boxed_pieces(self) -> Vec<Piece> {
        match self {
            CsgTree::Operand(_) => vec![boxed(self)],
            CsgTree::Operation { op: BoolOp::Intersection, parts, subtracted } => intersected(parts, subtracted),
            CsgTree::Operation { op, parts, .. } => {
                // Store the index of the part with each of its pieces.
                let pieces: Vec<(usize, Piece)> = parts
                    .into_iter()
                    .enumerate()
                    .flat_map(|(i, part)| part.boxed_pieces().into_iter().map(move |piece| (i, piece)))
                    .collect();
                let boxes: Vec<Option<Aabb>> = pieces.iter().map(|(_, piece)| piece.1).collect();
                let mut clusters: Vec<Vec<(usize, CsgTree)>> = Vec::new();
                for ((part, (solid, _)), cluster) in pieces.into_iter().zip(clusters_of(&boxes)) {
                    clusters.resize_with(clusters.len().max(cluster + 1), Vec::new);
                    clusters[cluster].push((part, solid));
                }
                clusters.into_iter().map(|cluster| boxed(rejoined(op, cluster))).collect()
            }
        }
    }
}

/// Computes the bounds of a solid.
fn boxed(solid: CsgTree) -> Piece {
    let bounds = solid.bounds();
    (solid, bounds)
}

/// Combines pieces of several parts into one solid. Pieces of the same part do not overlap.
fn rejoined(op: BoolOp, cluster: Vec<(usize, CsgTree)>) -> CsgTree {
    let mut parts: Vec<(usize, Vec<CsgTree>)> = Vec::new();
    for (part, solid) in cluster {
        match parts.last_mut().filter(|last| last.0 == part) {
            Some(last) => last.1.push(solid),
            None => parts.push((part, vec![solid])),
        }
    }
    CsgTree::join(op, parts.into_iter().map(|(_, pieces)| CsgTree::union(pieces)).collect())
}

/// Intersects each piece of the first part with those pieces of the other parts that it touches,
/// and subtracts the pieces of `cut`.
fn intersected(parts: Vec<CsgTree>, subtracted: Vec<CsgTree>) -> Vec<Piece> {
    let mut parts = parts.into_iter();
    let first = parts.next().map_or(Vec::new(), CsgTree::boxed_pieces);
    // Build the operations at the end, because adding one part at a time would take quadratic time.
    let mut found: Vec<(Vec<CsgTree>, Option<Aabb>)> =
        first.into_iter().map(|(solid, bounds)| (vec![solid], bounds)).collect();
    let whole = |pieces: Vec<Piece>| CsgTree::union(pieces.into_iter().map(|piece| piece.0).collect());
    let joined = |(all, bounds): (Vec<CsgTree>, Option<Aabb>)| (CsgTree::intersection(all, Vec::new()), bounds);
    for part in parts {
        let others = part.boxed_pieces();
        let boxes: Vec<Option<Aabb>> = found.iter().map(|(_, bounds)| *bounds).collect();
        let Some(near) = touching(&boxes, &others) else {
            let (one, other) = (boxed(whole(found.into_iter().map(joined).collect())), boxed(whole(others)));
            found = vec![(vec![one.0, other.0], common(one.1, other.1))];
            continue;
        };
        let meet = |((mut all, bounds), near): ((Vec<CsgTree>, Option<Aabb>), Vec<usize>)| {
            let (solid, others) = boxed(CsgTree::union(copies(&others, &near)));
            all.push(solid);
            (!near.is_empty()).then(|| (all, common(bounds, others)))
        };
        found = found.into_iter().zip(near).filter_map(meet).collect();
    }
    let mut found: Vec<Piece> = found.into_iter().map(joined).collect();
    found.retain(|(_, bounds)| bounds.is_none_or(|b| !b.is_empty()));
    let boxes: Vec<Option<Aabb>> = found.iter().map(|piece| piece.1).collect();
    let cut: Vec<Piece> = subtracted.into_iter().flat_map(CsgTree::boxed_pieces).collect();
    let Some(near) = touching(&boxes, &cut) else {
        return vec![boxed(CsgTree::intersection(vec![whole(found)], vec![whole(cut)]))];
    };
    let cut_off = |((solid, bounds), near): (Piece, Vec<usize>)| {
        (CsgTree::intersection(vec![solid], copies(&cut, &near)), bounds)
    };
    found.into_iter().zip(near).map(cut_off).collect()
}

/// Returns copies of the pieces with the given indices.
fn copies(pieces: &[Piece], which: &[usize]) -> Vec<CsgTree> {
    which.iter().map(|&i| pieces[i].0.clone()).collect()
}

/// Intersects two boxes. `None` stands for the whole space.
fn common(a: Option<Aabb>, b: Option<Aabb>) -> Option<Aabb> {
    a.zip(b).map(|(a, b)| Aabb { min: a.min.max(b.min), max: a.max.min(b.max) }).or(a).or(b)
}

/// Returns the indices of the pieces that touch each box. Returns `None` if there are too many.
fn touching(boxes: &[Option<Aabb>], others: &[Piece]) -> Option<Vec<Vec<usize>>> {
    if boxes.len() * others.len() > MAX_PAIRS {
        return None;
    }
    let sizes: Vec<usize> = others.iter().map(|other| other.0.parts().len()).collect();
    let mut copied = 0;
    let near = |bounds: &Option<Aabb>| -> Option<Vec<usize>> {
        let near: Vec<usize> = (0..others.len()).filter(|&i| touch(*bounds, others[i].1)).collect();
        copied += near.iter().map(|&i| sizes[i]).sum::<usize>();
        (copied <= MAX_COPIES).then_some(near)
    };
    boxes.iter().map(near).collect()
}

/// Returns true if two boxes touch each other to within single precision. `None` stands for the
/// whole space.
fn touch(a: Option<Aabb>, b: Option<Aabb>) -> bool {
    let (Some(a), Some(b)) = (a, b) else { return true };
    let reach = |b: &Aabb| b.min.abs().max(b.max.abs()).max_element();
    let pad = 16.0 * f32::EPSILON * reach(&a).max(reach(&b));
    (a.min - pad).cmple(b.max).all() && (b.min - pad).cmple(a.max).all()
}

/// Returns the index of the cluster to which each box belongs. Boxes belong to the same cluster if
/// they touch each other directly or through other boxes. Clusters are numbered in the order of
/// their first boxes.
fn clusters_of(boxes: &[Option<Aabb>]) -> Vec<usize> {
    // Union-find forest. The root of each cluster in the forest is the cluster's first box.
    let mut parents: Vec<usize> = (0..boxes.len()).collect();
    fn root(parents: &mut [usize], mut i: usize) -> usize {
        while parents[i] != i {
            parents[i] = parents[parents[i]];
            i = parents[i];
        }
        i
    }
    // Sweep along x: only active boxes can touch the next one. Unbounded boxes always stay active.
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    let begin = |i: usize| boxes[i].map_or(f32::NEG_INFINITY, |b| b.min.x);
    order.sort_by(|&a, &b| begin(a).total_cmp(&begin(b)).then(a.cmp(&b)));
    let mut active: Vec<usize> = Vec::new();
    let mut pairs = 0;
    for i in order {
        let begun = begin(i);
        let pad = |b: &Aabb| 16.0 * f32::EPSILON * b.max.x.abs().max(begun.abs()).max(b.size().max_element());
        active.retain(|&j| boxes[j].is_none_or(|b| b.max.x + pad(&b) >= begun || touch(Some(b), boxes[i])));
        pairs += active.len();
        if pairs > MAX_PAIRS {
            return vec![0; boxes.len()];
        }
        for &j in &active {
            if touch(boxes[i], boxes[j]) {
                let (a, b) = (root(&mut parents, i), root(&mut parents, j));
                parents[a.max(b)] = a.min(b);
            }
        }
        active.push(i);
    }
    let mut numbers = vec![usize::MAX; boxes.len()];
    let mut count = 0;
    (0..boxes.len())
        .map(|i| {
            let first = root(&mut parents, i);
            if numbers[first] == usize::MAX {
                numbers[first] = count;
                count += 1;
            }
            numbers[first]
        })
        .collect()
}
