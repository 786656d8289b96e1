//! Intersection of rays with solids composed of several parts (constructive solid geometry).
//!
//! All intersections of the line along the ray with the surfaces of the parts are collected and
//! sorted. Each intersection along the line toggles the inside bit of one part, which updates the
//! operand counts of the operations above it. The line enters or leaves the solid where the bit of
//! the whole solid changes. Source: Roth, *Ray Casting for Modeling Solids*, Computer Graphics and
//! Image Processing 18, 1982. The operand counts are an addition to Roth's method that keeps
//! operations with many parts fast.
//!
//! Coincident faces need special treatment: crossings of different parts count as one if the faces
//! are nearly parallel and no farther apart than single precision can resolve, which is about 2^-19
//! of the coordinates. The bits of all these parts toggle together, so that two faces in the same
//! plane do not leave or create a thin skin. If the solid's bit changes, the visible surface is
//! that of the first part in the file that could have caused the change, either alone or as the
//! last part of the group.
//!
//! Faces that meet at an angle, as at an edge, count as one only within the rounding error of the
//! crossings, which is proportional to the size of the parts rather than to their distance. A
//! larger tolerance would lose corners near the edge and let light leak through.
//!
//! In the result, `part` is the index of a triangle or shape, counted over all parts, combined with
//! two flag bits: [`INVERTED`] if the surface is inverted, and [`ENTERS`] if the ray enters the
//! solid.

use super::solid::{BoolOp, CsgTree};
use super::{Geometry, Object, ShadingRules};
use durer_bvh::{Bvh, TraversalCounter};
use durer_scene::math::{Aabb, Ray, Ray64, Vec2, Vec3};
use durer_scene::shape::{Axis, Shape, ShapeHit, SurfacePoint};
use std::cell::RefCell;
use std::sync::Arc;

/// Flag in the `part` of a hit: the surface is inverted because it belongs to a subtracted part.
pub const INVERTED: u32 = 1 << 31;
/// Flag in the `part` of a hit: the ray enters the solid.
pub const ENTERS: u32 = 1 << 30;

/// Maximum number of bounded parts for which no BVH is built.
const MAX_LINEAR_PARTS: usize = 8;

/// Solid composed of several parts with boolean operations, prepared for ray intersection.
#[derive(Debug)]
pub struct Csg {
    /// Parts of the solid, in file order.
    leaves: Vec<SolidPart>,
    /// Operations; the first one is the root.
    joins: Vec<OperationNode>,
    /// Number of true operands of each operation at a point outside all parts, which is the number
    /// of its subtracted operands.
    start: Vec<u32>,
    /// Indices of the unbounded parts.
    unbounded: Vec<u32>,
    /// Indices of the bounded parts.
    bounded: Vec<u32>,
    /// BVH over the bounded parts, if there are more than [`MAX_LINEAR_PARTS`].
    bvh: Option<Bvh>,
    bounds: Option<Aabb>,
    /// Largest distance at which two parts can count as coincident, in world units.
    tolerance: f32,
}

/// Part of a solid, with its position in the tree of operations.
#[derive(Debug)]
struct SolidPart {
    object: Arc<Object>,
    /// Axis of the part's shape, computed once.
    axis: Option<Axis>,
    edge: ParentLink,
    /// Index of the part's first triangle or shape, counted over all parts.
    first: u32,
    /// Minimum tolerance for the position of the part's surface, in world units.
    tolerance: f32,
    /// Upper bound on the rounding error of a crossing.
    rounding: f32,
}

/// Link from a part or operation to the operation above it in a solid's tree.
#[derive(Clone, Copy, Debug)]
struct ParentLink {
    /// Index of the parent operation.
    join: u32,
    /// True for a subtracted operand, which counts as true at points outside it.
    is_subtracted: bool,
}

/// Boolean operation in a solid's tree.
#[derive(Debug)]
struct OperationNode {
    op: BoolOp,
    /// Number of operands.
    edges: u32,
    /// Link to the operation above this one; `None` for the root.
    edge: Option<ParentLink>,
}

impl OperationNode {
    /// Returns true if a point is inside the result, given that `holding` operands are true there.
    fn value(&self, holding: u32) -> bool {
        match self.op {
            BoolOp::Union => holding > 0,
            BoolOp::Intersection => holding == self.edges,
            BoolOp::Xor => holding % 2 == 1,
        }
    }
}

/// Intersection of the line along a ray with the surface of one part of a solid.
#[derive(Clone, Copy, Debug)]
struct SurfaceCrossing {
    t: f64,
    leaf: u32,
    part: u32,
    uv: Vec2,
}

/// Thread-local buffers for intersecting solids, reused for each ray.
#[derive(Default)]
struct Scratch {
    events: Vec<SurfaceCrossing>,
    state: State,
}

/// State of a walk through a solid along a line, recording which parts contain the current point.
#[derive(Default)]
struct State {
    /// For each operation, the number of its operands that are true.
    counts: Vec<u32>,
    /// For each part, true if it contains the point.
    inside: Vec<bool>,
    /// For each part, the id of the last group of coincident crossings that contained a crossing of
    /// this part. Group ids are never reused.
    groups: Vec<u64>,
    last_group: u64,
}

impl State {
    /// Resets the state to a point outside of all parts.
    fn begin(&mut self, parts: usize, start: &[u32]) {
        self.counts.clear();
        self.counts.extend_from_slice(start);
        self.inside.clear();
        self.inside.resize(parts, false);
        // Entries left over from other rays and solids differ from all future group ids.
        self.groups.resize(self.groups.len().max(parts), 0);
    }
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

impl Csg {
    /// Maximum number of triangles and shapes in all parts together.
    pub const MAX_PARTS: u64 = ENTERS as u64 - 1;

    /// Prepares a solid for ray intersection.
    pub fn new(solid: CsgTree) -> Self {
        let bounds = solid.bounds();
        let mut csg = Csg {
            leaves: Vec::new(),
            joins: Vec::new(),
            start: Vec::new(),
            unbounded: Vec::new(),
            bounded: Vec::new(),
            bvh: None,
            bounds,
            tolerance: 0.0,
        };
        // Turn a single part into an operation with one operand.
        let solid = match solid {
            CsgTree::Operand(_) => CsgTree::Operation { op: BoolOp::Union, parts: vec![solid], subtracted: Vec::new() },
            join => join,
        };
        csg.add(solid, None);
        csg.tolerance = csg.leaves.iter().map(|leaf| 2.0 * leaf.tolerance).fold(0.0, f32::max);
        // Parts outside the solid's bounds do not matter, except that they can coincide with parts
        // inside.
        let margin = GRAZING as f32 * csg.tolerance;
        let matters = bounds.map(|whole| Aabb { min: whole.min - margin, max: whole.max + margin });
        let mut boxes = Vec::new();
        for (i, leaf) in csg.leaves.iter().enumerate() {
            match leaf.object.bounds() {
                Some(b) => {
                    csg.bounded.push(i as u32);
                    boxes.push(matters.map_or(b, |m| Aabb { min: b.min.max(m.min), max: b.max.min(m.max) }));
                }
                None => csg.unbounded.push(i as u32),
            }
        }
        csg.bvh = (boxes.len() > MAX_LINEAR_PARTS).then(|| Bvh::build(&boxes));
        csg
    }

    /// Adds a part or an operation with all its operands.
    fn add(&mut self, solid: CsgTree, edge: Option<ParentLink>) {
        match (solid, edge) {
            (CsgTree::Operand(object), Some(edge)) => {
                let first = self.leaves.last().map_or(0, |last| last.first + last.object.parts());
                let tolerance = tolerance_of(&object);
                let size = object.bounds().map_or(0.0, |b| b.size().max_element());
                let (axis, rounding) = (object.axis(), 4.0 * f32::EPSILON * size);
                self.leaves.push(SolidPart { object, axis, edge, first, tolerance, rounding });
            }
            (CsgTree::Operand(_), None) => {}
            (CsgTree::Operation { op, parts, subtracted }, edge) => {
                let join = self.joins.len() as u32;
                self.joins.push(OperationNode { op, edges: (parts.len() + subtracted.len()) as u32, edge });
                // At a point outside all parts, only subtracted operands are true.
                self.start.push(subtracted.len() as u32);
                parts.into_iter().for_each(|part| self.add(part, Some(ParentLink { join, is_subtracted: false })));
                subtracted.into_iter().for_each(|part| self.add(part, Some(ParentLink { join, is_subtracted: true })));
            }
        }
    }

    /// Returns the world-space bounds, or `None` if the solid is unbounded.
    pub fn bounds(&self) -> Option<Aabb> {
        self.bounds
    }

    /// Iterates over the parts.
    pub fn parts(&self) -> impl Iterator<Item = &Object> {
        self.leaves.iter().map(|leaf| &*leaf.object)
    }

    /// Returns the object to which the `part` of a hit belongs.
    pub fn part(&self, part: u32) -> &Object {
        &self.leaves[self.leaf_of(part)].object
    }

    /// Returns the index of the hit triangle in its mesh, or 0 for other shapes.
    pub fn triangle(&self, part: u32) -> u32 {
        (part & !(INVERTED | ENTERS)) - self.leaves[self.leaf_of(part)].first
    }

    /// Returns the memory used in bytes, not counting meshes.
    pub fn bytes(&self) -> usize {
        let lists = size_of_val(&*self.leaves) + size_of_val(&*self.joins) + size_of_val(&*self.start);
        lists
            + size_of_val(&*self.unbounded)
            + size_of_val(&*self.bounded)
            + self.bvh.as_ref().map_or(0, Bvh::memory_usage)
    }

    /// Returns the index of the leaf to which the `part` of a hit belongs.
    fn leaf_of(&self, part: u32) -> usize {
        let number = part & !(INVERTED | ENTERS);
        // Fast path: if all parts before this one are shapes, its index is also the index of its
        // leaf.
        let begins = |place: usize| self.leaves.get(place).is_some_and(|leaf| leaf.first == number);
        if begins(number as usize) && !begins(number as usize + 1) {
            return number as usize;
        }
        self.leaves.partition_point(|leaf| leaf.first <= number).saturating_sub(1)
    }

    /// Computes the surface at a hit in world space. The normals of the surface point out of the
    /// solid.
    pub fn surface(&self, ray: &Ray64, crossing: &ShapeHit, part: u32, rules: &ShadingRules) -> SurfacePoint {
        let (leaf, number) = (&self.leaves[self.leaf_of(part)], self.triangle(part));
        let point = leaf.object.local_line(ray).at(f64::from(crossing.t));
        let surface = leaf.object.surface(ray, point, crossing, number, rules);
        // Use the direction in which the ray crosses the surface, because the mesh itself may be
        // inverted.
        let turned = match leaf.object.geometry {
            Geometry::Mesh(_) => (surface.n_geo.dot(ray.dir()) < 0.0) != (part & ENTERS != 0),
            _ => part & INVERTED != 0,
        };
        if !turned {
            return surface;
        }
        let [front, back] = surface.shadow_offsets;
        SurfacePoint { n_geo: -surface.n_geo, n_shade: -surface.n_shade, shadow_offsets: [back, front], ..surface }
    }

    /// Returns the first hit in the ray's interval and its part. If the ray starts on the solid's
    /// own surface, `inside` is true if it starts on the inner side.
    pub(super) fn closest<T: TraversalCounter>(
        &self,
        ray: &Ray64,
        inside: Option<bool>,
        counter: &mut T,
    ) -> Option<(ShapeHit, u32)> {
        if !durer_bvh::internal::is_valid(&ray.rounded) {
            return None;
        }
        SCRATCH.with_borrow_mut(|scratch| {
            let complete = self.collect(ray, true, scratch, counter);
            let found = self.sweep(ray, inside, scratch);
            // If the ray starts inside a union, it can enter another part before it leaves the
            // union.
            if complete < f32::INFINITY && found.is_none_or(|(crossing, _)| crossing.t > complete) {
                self.collect(ray, false, scratch, counter);
                return self.sweep(ray, inside, scratch);
            }
            found
        })
    }

    /// Collects the crossings of all parts that can matter up to the first hit.
    ///
    /// A ray that starts outside a union enters it where it first enters a part. If `shrink` is
    /// true, parts beyond that point are therefore omitted. Returns the `t` up to which all
    /// crossings were collected, or infinity.
    fn collect<T: TraversalCounter>(&self, ray: &Ray64, shrink: bool, scratch: &mut Scratch, counter: &mut T) -> f32 {
        let Scratch { events, .. } = scratch;
        events.clear();
        let take = |i: u32, events: &mut Vec<SurfaceCrossing>, counter: &mut T| {
            let offer = &mut |t, uv, part| events.push(SurfaceCrossing { t, leaf: i, part, uv });
            let SolidPart { object, axis, .. } = &self.leaves[i as usize];
            object.crossings(axis.as_ref(), ray, counter, offer);
        };
        self.unbounded.iter().for_each(|&i| take(i, events, counter));
        let Some(bvh) = &self.bvh else {
            self.bounded.iter().for_each(|&i| take(i, events, counter));
            events.sort_unstable_by(order);
            return f32::INFINITY;
        };
        // Crossings within the tolerance outside the interval matter too.
        let reach = self.tolerance + 4.0 * f32::EPSILON * ray.rounded.origin.abs().max_element();
        // The largest component is a lower bound on the length of the direction and needs no square
        // root.
        let pad = GRAZING as f32 * reach / ray.dir().abs().max_element();
        // Move the ray origin back, because traversal is faster for rays that start at their
        // origin. The rounding error of the new origin is a thousandth of the distance moved.
        let Ray { origin, dir, t_min, t_max } = ray.rounded;
        let wide = Ray { origin: origin - pad * dir, dir, t_min, t_max: t_max + 2.0 * pad };
        let shrink = shrink && self.joins[0].op == BoolOp::Union;
        let mut complete = f32::INFINITY;
        bvh.traverse(&wide, counter, |item, t_max, counter| {
            let (i, from) = (self.bounded[bvh.primitive_indices()[item] as usize], events.len());
            take(i, events, counter);
            if !shrink || self.leaves[i as usize].edge.join != 0 {
                return t_max;
            }
            let own = &mut events[from..];
            // Sorting one or two crossings would stall on memory that was just written.
            if own.len() > 2 {
                own.sort_unstable_by(order);
            }
            for pair in own.chunks(2) {
                let way_in = pair.iter().fold(f64::INFINITY, |t, event| t.min(event.t)) as f32;
                if way_in > ray.rounded.t_min {
                    complete = complete.min(way_in);
                    break;
                }
            }
            t_max.min(complete.next_up() + 2.0 * pad)
        });
        events.sort_unstable_by(order);
        complete
    }

    /// Walks through the sorted crossings to the first one in the interval at which the solid's bit
    /// changes.
    ///
    /// If the ray starts on the solid's own surface, it is known on which side it starts. If the
    /// crossings contradict this, the ray starts closer to an edge than single precision can
    /// resolve, and some face is on the wrong side of the origin. If that face should be in front
    /// of the origin, the ray hits it at once; if the face should be behind the origin, it is
    /// ignored.
    fn sweep(&self, ray: &Ray64, inside: Option<bool>, scratch: &mut Scratch) -> Option<(ShapeHit, u32)> {
        let Scratch { events, state } = scratch;
        if events.is_empty() {
            return None;
        }
        state.begin(self.leaves.len(), &self.start);
        let mut whole = self.joins[0].value(state.counts[0]);
        for &i in &self.unbounded {
            let Geometry::Primitive(shape) = &self.leaves[i as usize].object.geometry else { continue };
            if shape.starts_inside(&self.leaves[i as usize].object.local_line(ray)) {
                whole ^= self.toggle(i, state);
            }
        }
        let at_once = |(crossing, part): (ShapeHit, u32)| {
            let t = f32::MIN_POSITIVE;
            ray.rounded.contains(t).then_some((ShapeHit { t, ..crossing }, part))
        };
        // Last crossing behind the origin that leads to the wrong side of the surface.
        let mut behind: Option<(ShapeHit, u32)> = None;
        let mut known = inside;
        let (apart, speed) = self.coincidence_bound(ray, events);
        let mut from = 0;
        while from < events.len() {
            // Fast path: most crossings are far from the next one.
            let to = match events.get(from + 1) {
                Some(next) if (next.t - events[from].t) * speed > apart => from + 1,
                _ => self.coincident(ray, events, from, state),
            };
            let (group, before) = (&events[from..to], whole);
            from = to;
            for event in group {
                whole ^= self.toggle(event.leaf, state);
            }
            if let (Some(inside), true) = (known, group[0].t <= 0.0) {
                let leads = |event: &&SurfaceCrossing| self.adds(event.leaf, state) != inside;
                behind = group.iter().rfind(leads).map(|event| self.change(event, state, !inside)).or(behind);
            }
            if whole == before {
                continue;
            }
            let chosen = if let [one] = group { one } else { self.choose(group, state) };
            let change = self.change(chosen, state, whole);
            let t = change.0.t;
            if t.is_nan() {
                return None;
            }
            if t > 0.0 && known.take().is_some_and(|inside| inside != before) {
                let Some(last) = behind.filter(|(last, _)| -last.t <= t) else { continue };
                if let Some(met) = at_once(last) {
                    return Some(met);
                }
            }
            if t > ray.rounded.t_min {
                return (t < ray.rounded.t_max).then_some(change);
            }
        }
        behind.filter(|_| known.is_some_and(|inside| inside != whole)).and_then(at_once)
    }

    /// Returns the hit at a crossing. `whole` is the solid's bit after the crossing.
    fn change(&self, event: &SurfaceCrossing, state: &State, whole: bool) -> (ShapeHit, u32) {
        let turned = state.inside[event.leaf as usize] != whole;
        let bits = if turned { INVERTED } else { 0 } | if whole { ENTERS } else { 0 };
        let part = (self.leaves[event.leaf as usize].first + event.part) | bits;
        (ShapeHit { t: event.t as f32, uv: event.uv }, part)
    }

    /// Returns true if a part, in its current state, makes the solid larger: either the point is
    /// inside the part, or the part is subtracted and the point is outside it.
    fn adds(&self, leaf: u32, state: &State) -> bool {
        let mut adds = state.inside[leaf as usize];
        let mut edge = Some(self.leaves[leaf as usize].edge);
        while let Some(ParentLink { join, is_subtracted }) = edge {
            adds ^= is_subtracted;
            edge = self.joins[join as usize].edge;
        }
        adds
    }

    /// Toggles the inside bit of a part. Returns true if the solid's bit changed.
    fn toggle(&self, leaf: u32, state: &mut State) -> bool {
        let bit = &mut state.inside[leaf as usize];
        *bit = !*bit;
        let (mut value, mut edge) = (*bit, self.leaves[leaf as usize].edge);
        loop {
            let join = &self.joins[edge.join as usize];
            let count = &mut state.counts[edge.join as usize];
            let before = join.value(*count);
            *count = if value != edge.is_subtracted { *count + 1 } else { *count - 1 };
            value = join.value(*count);
            if value == before {
                return false;
            }
            match join.edge {
                Some(above) => edge = above,
                None => return true,
            }
        }
    }

    /// Returns an upper bound on the distance between coincident crossings (see [`Csg::coincide`])
    /// and a lower bound on the length of the ray's direction.
    fn coincidence_bound(&self, ray: &Ray64, events: &[SurfaceCrossing]) -> (f64, f64) {
        let (line, speed) = (ray.line(), f64::from(ray.dir().abs().max_element()));
        let farthest = events.first().map_or(0.0, |e| e.t.abs()) + events.last().map_or(0.0, |e| e.t.abs());
        let reach = line.origin.abs().max_element() + farthest * speed;
        // The factor 1.001 allows for the different rounding in `coincide`.
        (1.001 * GRAZING * (f64::from(self.tolerance) + 4.0 * f64::from(f32::EPSILON) * reach), speed)
    }

    /// Returns the end of a group of coincident crossings, all of which belong to different parts.
    /// The comment at the start of this file explains coincident faces.
    fn coincident(&self, ray: &Ray64, events: &[SurfaceCrossing], from: usize, state: &mut State) -> usize {
        state.last_group += 1;
        let State { groups, last_group: group, .. } = state;
        groups[events[from].leaf as usize] = *group;
        let mut to = from + 1;
        while to < events.len()
            && groups[events[to].leaf as usize] != *group
            && self.coincide(ray, &events[from], &events[to])
        {
            groups[events[to].leaf as usize] = *group;
            to += 1;
        }
        to
    }

    /// Returns true if two crossings coincide, as explained at the start of this file.
    fn coincide(&self, ray: &Ray64, a: &SurfaceCrossing, b: &SurfaceCrossing) -> bool {
        let line = ray.line();
        let speed = line.dir.length();
        let gap = (b.t - a.t) * speed;
        let [s, u] = [a, b].map(|event| self.leaves[event.leaf as usize].tolerance);
        let tolerance = f64::from(s + u) + 0.5 * f64::from(f32::EPSILON) * line.at(a.t).abs().max_element();
        let [r, q] = [a, b].map(|event| self.leaves[event.leaf as usize].rounding);
        if gap.is_nan() || gap <= f64::from(r + q).min(tolerance) || gap > GRAZING * tolerance {
            return gap <= tolerance;
        }
        let [m, n] = [a, b].map(|event| {
            let object = &self.leaves[event.leaf as usize].object;
            let crossing = ShapeHit { t: event.t as f32, uv: event.uv };
            let at = object.local_line(ray).at(event.t);
            object.surface(ray, at, &crossing, event.part, &ShadingRules::default()).n_geo.as_dvec3()
        });
        // A grazing ray travels farther from one face to the other than the distance between the
        // faces.
        let cosine = m.dot(line.dir).abs().max(n.dot(line.dir).abs()) / speed;
        m.dot(n).abs() >= MIN_COPLANAR_COSINE && gap * cosine <= tolerance
    }

    /// Returns the crossing whose surface is visible, from a group of crossings that together
    /// changed the solid's bit.
    fn choose<'e>(&self, events: &'e [SurfaceCrossing], state: &mut State) -> &'e SurfaceCrossing {
        let mut could: Vec<&SurfaceCrossing> = Vec::new();
        // Find the crossings without which the change would not happen.
        for event in events {
            if self.toggle(event.leaf, state) {
                could.push(event);
            }
            self.toggle(event.leaf, state);
        }
        // Find the crossings that cause the change alone: undo all crossings, then try each one on
        // its own.
        for event in events {
            self.toggle(event.leaf, state);
        }
        for event in events {
            if self.toggle(event.leaf, state) {
                could.push(event);
            }
            self.toggle(event.leaf, state);
        }
        let mut last = &events[0];
        for event in events {
            if self.toggle(event.leaf, state) {
                last = event;
            }
        }
        could.into_iter().min_by_key(|event| event.leaf).unwrap_or(last)
    }
}

/// Reciprocal of the sine of the flattest angle at which the tolerance is sufficient.
const GRAZING: f64 = 1000.0;

/// Cosine of the largest angle between coincident faces, which is 3.6 degrees. Rounding of vertices
/// at 10^6 can rotate faces of size 1 that should be in the same plane by this angle.
const MIN_COPLANAR_COSINE: f64 = 0.998;

/// Compares crossings by their position on the line, then by their part.
fn order(a: &SurfaceCrossing, b: &SurfaceCrossing) -> std::cmp::Ordering {
    a.t.total_cmp(&b.t).then(a.leaf.cmp(&b.leaf)).then(a.part.cmp(&b.part))
}

/// Returns an upper bound on the sum of the rounding errors of an object's coordinates in world
/// space and in object space.
fn tolerance_of(object: &Object) -> f32 {
    let (Some(world), Some(local)) = (object.bounds(), object.local_bounds()) else { return 0.0 };
    let reach = |b: Aabb| b.min.abs().max(b.max.abs());
    let moved = object.to_world.as_ref().map_or(Vec3::ZERO, |to_world| to_world.error_bound(reach(local)));
    0.5 * f32::EPSILON * reach(world).max_element() + f32::EPSILON * moved.max_element()
}

#[cfg(test)]
mod tests;
