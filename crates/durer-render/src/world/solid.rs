//! Closed shapes combined by Boolean operations, as a tree; and how such a tree falls into pieces
//! apart from each other, each as small as can be told from its parts' boxes.
//!
//! Parts in boxes that do not touch cannot change each other. So a merge of many parts in space
//! becomes many things, which the tree over the world's objects finds as fast as any others; and a
//! cut concerns only what it touches.

use super::Object;
use durer_scene::math::Aabb;
use std::sync::Arc;

/// When a point is inside, by how many parts it is inside of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoolOp {
    /// At least one.
    Any,
    /// All of them, and none of those that are cut away.
    All,
    /// An odd number.
    Odd,
}

/// A closed shape, or some combined.
#[derive(Clone, Debug)]
pub enum Solid {
    /// A closed shape or mesh, placed in the world.
    Operand(Arc<Object>),
    /// Several of them.
    Join {
        /// How they are combined.
        rule: BoolOp,
        /// In the order of writing.
        parts: Vec<Solid>,
        /// What is cut away; only of [`BoolOp::All`].
        cut: Vec<Solid>,
    },
}

/// Where more pairs of pieces than this would have to be looked at, they are left together.
const MAX_PAIRS: usize = 1 << 22;

/// And where more copies of parts than this would be made.
const MAX_COPIES: usize = 1 << 18;

/// A solid and the box around it; `None` where it has no end.
type Piece = (Solid, Option<Aabb>);

impl Solid {
    /// What is in some solid of several. One without any is nothing.
    pub fn any(parts: Vec<Solid>) -> Solid {
        Solid::join(BoolOp::Any, parts)
    }

    /// What is in an odd number of several.
    pub fn odd(parts: Vec<Solid>) -> Solid {
        Solid::join(BoolOp::Odd, parts)
    }

    /// What is in all of several, and in none of others. Neither "in all" nor "in none" changes by
    /// nesting.
    pub fn all(parts: Vec<Solid>, cut: Vec<Solid>) -> Solid {
        let (mut flat, mut flat_cut) = (Vec::new(), Vec::new());
        for part in parts {
            match part {
                Solid::Join { rule: BoolOp::All, parts, cut } => {
                    flat.extend(parts);
                    flat_cut.extend(cut);
                }
                other => flat.push(other),
            }
        }
        for part in cut {
            match part {
                Solid::Join { rule: BoolOp::Any, parts, .. } => flat_cut.extend(parts),
                other => flat_cut.push(other),
            }
        }
        match (flat.len(), flat_cut.len()) {
            (1, 0) => flat.remove(0),
            _ => Solid::Join { rule: BoolOp::All, parts: flat, cut: flat_cut },
        }
    }

    fn join(rule: BoolOp, parts: Vec<Solid>) -> Solid {
        let mut flat = Vec::with_capacity(parts.len());
        for part in parts {
            match part {
                Solid::Join { rule: inner, parts, .. } if inner == rule => flat.extend(parts),
                other => flat.push(other),
            }
        }
        if flat.len() == 1 { flat.remove(0) } else { Solid::Join { rule, parts: flat, cut: Vec::new() } }
    }

    /// The box around it, as tight as the operation tells: `None` where it has no end.
    pub fn bounds(&self) -> Option<Aabb> {
        match self {
            Solid::Operand(object) => object.bounds(),
            Solid::Join { rule: BoolOp::All, parts, .. } => parts.iter().map(Solid::bounds).fold(None, common),
            Solid::Join { parts, .. } => {
                parts.iter().try_fold(Aabb::EMPTY, |all, part| Some(all.union(part.bounds()?)))
            }
        }
    }

    /// All shapes and meshes in it.
    pub fn parts(&self) -> Vec<&Object> {
        match self {
            Solid::Operand(object) => vec![object],
            Solid::Join { parts, cut, .. } => parts.iter().chain(cut).flat_map(Solid::parts).collect(),
        }
    }

    /// The same, as solids apart from each other, in the order of their first parts. None is left
    /// of what is nowhere.
    pub fn pieces(self) -> Vec<Solid> {
        self.boxed_pieces().into_iter().map(|piece| piece.0).collect()
    }

    fn boxed_pieces(self) -> Vec<Piece> {
        match self {
            Solid::Operand(_) => vec![boxed(self)],
            Solid::Join { rule: BoolOp::All, parts, cut } => intersected(parts, cut),
            Solid::Join { rule, parts, .. } => {
                // Each piece keeps the number of the part that it comes from.
                let pieces: Vec<(usize, Piece)> = parts
                    .into_iter()
                    .enumerate()
                    .flat_map(|(i, part)| part.boxed_pieces().into_iter().map(move |piece| (i, piece)))
                    .collect();
                let boxes: Vec<Option<Aabb>> = pieces.iter().map(|(_, piece)| piece.1).collect();
                let mut clusters: Vec<Vec<(usize, Solid)>> = Vec::new();
                for ((part, (solid, _)), cluster) in pieces.into_iter().zip(clusters_of(&boxes)) {
                    clusters.resize_with(clusters.len().max(cluster + 1), Vec::new);
                    clusters[cluster].push((part, solid));
                }
                clusters.into_iter().map(|cluster| boxed(rejoined(rule, cluster))).collect()
            }
        }
    }
}

fn boxed(solid: Solid) -> Piece {
    let bounds = solid.bounds();
    (solid, bounds)
}

/// One solid of the pieces of several parts; pieces of the same part are apart from each other.
fn rejoined(rule: BoolOp, cluster: Vec<(usize, Solid)>) -> Solid {
    let mut parts: Vec<(usize, Vec<Solid>)> = Vec::new();
    for (part, solid) in cluster {
        match parts.last_mut().filter(|last| last.0 == part) {
            Some(last) => last.1.push(solid),
            None => parts.push((part, vec![solid])),
        }
    }
    Solid::join(rule, parts.into_iter().map(|(_, pieces)| Solid::any(pieces)).collect())
}

/// Pieces of the first part, each with those of the others that it touches.
fn intersected(parts: Vec<Solid>, cut: Vec<Solid>) -> Vec<Piece> {
    let mut parts = parts.into_iter();
    let first = parts.next().map_or(Vec::new(), Solid::boxed_pieces);
    // What is in all of several is joined in the end: to do it part by part would take the square of
    // their number.
    let mut found: Vec<(Vec<Solid>, Option<Aabb>)> =
        first.into_iter().map(|(solid, bounds)| (vec![solid], bounds)).collect();
    let whole = |pieces: Vec<Piece>| Solid::any(pieces.into_iter().map(|piece| piece.0).collect());
    let joined = |(all, bounds): (Vec<Solid>, Option<Aabb>)| (Solid::all(all, Vec::new()), bounds);
    for part in parts {
        let others = part.boxed_pieces();
        let boxes: Vec<Option<Aabb>> = found.iter().map(|(_, bounds)| *bounds).collect();
        let Some(near) = touching(&boxes, &others) else {
            let (one, other) = (boxed(whole(found.into_iter().map(joined).collect())), boxed(whole(others)));
            found = vec![(vec![one.0, other.0], common(one.1, other.1))];
            continue;
        };
        let meet = |((mut all, bounds), near): ((Vec<Solid>, Option<Aabb>), Vec<usize>)| {
            let (solid, others) = boxed(Solid::any(copies(&others, &near)));
            all.push(solid);
            (!near.is_empty()).then(|| (all, common(bounds, others)))
        };
        found = found.into_iter().zip(near).filter_map(meet).collect();
    }
    let mut found: Vec<Piece> = found.into_iter().map(joined).collect();
    found.retain(|(_, bounds)| bounds.is_none_or(|b| !b.is_empty()));
    let boxes: Vec<Option<Aabb>> = found.iter().map(|piece| piece.1).collect();
    let cut: Vec<Piece> = cut.into_iter().flat_map(Solid::boxed_pieces).collect();
    let Some(near) = touching(&boxes, &cut) else {
        return vec![boxed(Solid::all(vec![whole(found)], vec![whole(cut)]))];
    };
    let cut_off = |((solid, bounds), near): (Piece, Vec<usize>)| (Solid::all(vec![solid], copies(&cut, &near)), bounds);
    found.into_iter().zip(near).map(cut_off).collect()
}

fn copies(pieces: &[Piece], which: &[usize]) -> Vec<Solid> {
    which.iter().map(|&i| pieces[i].0.clone()).collect()
}

/// What is in both of two boxes, of which one without end changes nothing.
fn common(a: Option<Aabb>, b: Option<Aabb>) -> Option<Aabb> {
    a.zip(b).map(|(a, b)| Aabb { min: a.min.max(b.min), max: a.max.min(b.max) }).or(a).or(b)
}

/// For each box the pieces whose own boxes touch it; `None` where these are too many to be told
/// apart.
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

/// Whether two boxes touch, or nearly, for all that single precision can tell.
fn touch(a: Option<Aabb>, b: Option<Aabb>) -> bool {
    let (Some(a), Some(b)) = (a, b) else { return true };
    let reach = |b: &Aabb| b.min.abs().max(b.max.abs()).max_element();
    let pad = 16.0 * f32::EPSILON * reach(&a).max(reach(&b));
    (a.min - pad).cmple(b.max).all() && (b.min - pad).cmple(a.max).all()
}

/// For each box the number of its cluster: boxes that touch, directly or by others between them,
/// are in one. Clusters are numbered by their first box.
fn clusters_of(boxes: &[Option<Aabb>]) -> Vec<usize> {
    // The parent of each in a forest whose trees are the clusters; a root is the first of its
    // cluster.
    let mut parents: Vec<usize> = (0..boxes.len()).collect();
    fn root(parents: &mut [usize], mut i: usize) -> usize {
        while parents[i] != i {
            parents[i] = parents[parents[i]];
            i = parents[i];
        }
        i
    }
    // Sweeps over x: only what has begun and not ended yet may touch the next. What has no end
    // never ends.
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
