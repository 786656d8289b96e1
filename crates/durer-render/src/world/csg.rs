//! Intersection of rays with solids of several parts (constructive solid geometry).
//!
//! All crossings of the ray's line with the surfaces of the parts are collected and sorted. Along
//! the line, each crossing toggles one part's inside bit, and with it the counts of the operations
//! above it. Where the bit of the whole changes, the line enters or leaves the solid. Source: Roth,
//! *Ray Casting for Modeling Solids*, Computer Graphics and Image Processing 18, 1982; with counts
//! for the operations, so that an operation with many parts is not slower.
//!
//! Coincident faces: crossings of different parts count as one if the faces are nearly parallel and
//! their distance across the surfaces is at most what single precision can resolve there, about
//! 2^-19 of the coordinates. All their bits toggle together, so no thin skin remains or appears
//! where two faces share a plane. If the bit of the solid changes, the surface belongs to the first
//! part in the file that could have made the change: alone, or as the last.
//!
//! Faces that meet at an angle, as at an edge, count as one only within the rounding of the
//! crossings, which is proportional to the parts' own size however far away they are. A larger
//! tolerance would lose corners near the edge, and light would leak in.
//!
//! A hit's `part` is the index of a triangle or shape among those of all parts, with two flag bits:
//! the surface is inverted, and the ray enters the solid.

use super::solid::{BoolOp, Solid};
use super::{Geometry, Object, ShadingRules};
use durer_bvh::{Bvh, TraversalCounter};
use durer_scene::math::{Aabb, Ray, Ray64, Vec2, Vec3};
use durer_scene::shape::{Axis, Shape, ShapeHit, Surface};
use std::cell::RefCell;
use std::sync::Arc;

/// Flag in a hit's part: the surface is inverted, as for subtracted parts.
pub const TURNED: u32 = 1 << 31;
/// Flag in a hit's part: the ray enters the solid.
pub const ENTERS: u32 = 1 << 30;

/// Number of parts up to which all are tested; more have their own tree.
const FEW: usize = 8;

/// A solid of several parts.
#[derive(Debug)]
pub struct Csg {
    leaves: Vec<Leaf>,
    /// Operations; the first one is the root.
    joins: Vec<Join>,
    /// Initial count for each operation: its edges that hold outside all parts.
    start: Vec<u32>,
    /// Unbounded parts.
    unbounded: Vec<u32>,
    /// Indices of the bounded parts, and a tree over them if there are many.
    bounded: Vec<u32>,
    bvh: Option<Bvh>,
    bounds: Option<Aabb>,
    /// Largest tolerance of two parts.
    slack: f32,
}

/// A part and its place in the tree.
#[derive(Debug)]
struct Leaf {
    object: Arc<Object>,
    /// The part's axis, computed once.
    axis: Option<Axis>,
    edge: Edge,
    /// Index of its first triangle.
    first: u32,
    /// Minimum tolerance for the position of its surface.
    slack: f32,
    /// Bound of the error of a crossing.
    rounding: f32,
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    /// Index of the parent operation.
    join: u32,
    /// True for a subtracted part, whose edge holds outside of it.
    cut: bool,
}

#[derive(Debug)]
struct Join {
    rule: BoolOp,
    edges: u32,
    /// `None` for the root.
    edge: Option<Edge>,
}

impl Join {
    fn value(&self, holding: u32) -> bool {
        match self.rule {
            BoolOp::Any => holding > 0,
            BoolOp::All => holding == self.edges,
            BoolOp::Odd => holding % 2 == 1,
        }
    }
}

/// A crossing of a part's surface.
#[derive(Clone, Copy, Debug)]
struct Event {
    t: f64,
    leaf: u32,
    part: u32,
    uv: Vec2,
}

/// Thread-local buffers, reused for each ray.
#[derive(Default)]
struct Scratch {
    events: Vec<Event>,
    state: State,
}

/// For the current point, the parts that contain it.
#[derive(Default)]
struct State {
    counts: Vec<u32>,
    inside: Vec<bool>,
    /// For each part, id of the last group of coincident crossings that includes a crossing of this
    /// part. Ids are never reused.
    groups: Vec<u64>,
    last_group: u64,
}

impl State {
    /// Starts outside all parts.
    fn begin(&mut self, parts: usize, start: &[u32]) {
        self.counts.clear();
        self.counts.extend_from_slice(start);
        self.inside.clear();
        self.inside.resize(parts, false);
        // Stale entries of other rays and solids match no future group id.
        self.groups.resize(self.groups.len().max(parts), 0);
    }
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

impl Csg {
    /// Maximum number of triangles and shapes in all parts together.
    pub const MAX_PARTS: u64 = ENTERS as u64 - 1;

    /// Prepares a solid for ray queries.
    pub fn new(solid: Solid) -> Self {
        let bounds = solid.bounds();
        let mut csg = Csg {
            leaves: Vec::new(),
            joins: Vec::new(),
            start: Vec::new(),
            unbounded: Vec::new(),
            bounded: Vec::new(),
            bvh: None,
            bounds,
            slack: 0.0,
        };
        // A single part becomes a join of one.
        let solid = match solid {
            Solid::Operand(_) => Solid::Join { rule: BoolOp::Any, parts: vec![solid], cut: Vec::new() },
            join => join,
        };
        csg.add(solid, None);
        csg.slack = csg.leaves.iter().map(|leaf| 2.0 * leaf.slack).fold(0.0, f32::max);
        // Parts do not matter beyond the bounds of the whole, except that they may coincide with
        // parts that do.
        let margin = GRAZING as f32 * csg.slack;
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
        csg.bvh = (boxes.len() > FEW).then(|| Bvh::build(&boxes));
        csg
    }

    fn add(&mut self, solid: Solid, edge: Option<Edge>) {
        match (solid, edge) {
            (Solid::Operand(object), Some(edge)) => {
                let first = self.leaves.last().map_or(0, |last| last.first + last.object.parts());
                let slack = slack_of(&object);
                let size = object.bounds().map_or(0.0, |b| b.size().max_element());
                let (axis, rounding) = (object.axis(), 4.0 * f32::EPSILON * size);
                self.leaves.push(Leaf { object, axis, edge, first, slack, rounding });
            }
            (Solid::Operand(_), None) => {}
            (Solid::Join { rule, parts, cut }, edge) => {
                let join = self.joins.len() as u32;
                self.joins.push(Join { rule, edges: (parts.len() + cut.len()) as u32, edge });
                // Initially, only edges of subtracted parts hold.
                self.start.push(cut.len() as u32);
                parts.into_iter().for_each(|part| self.add(part, Some(Edge { join, cut: false })));
                cut.into_iter().for_each(|part| self.add(part, Some(Edge { join, cut: true })));
            }
        }
    }

    /// Returns the bounds.
    pub fn bounds(&self) -> Option<Aabb> {
        self.bounds
    }

    /// Iterates over the parts.
    pub fn parts(&self) -> impl Iterator<Item = &Object> {
        self.leaves.iter().map(|leaf| &*leaf.object)
    }

    /// Returns the part of a hit.
    pub fn part(&self, part: u32) -> &Object {
        &self.leaves[self.leaf_of(part)].object
    }

    /// Returns the index of the triangle in that part, or 0.
    pub fn triangle(&self, part: u32) -> u32 {
        (part & !(TURNED | ENTERS)) - self.leaves[self.leaf_of(part)].first
    }

    /// Returns the size in bytes, without meshes.
    pub fn bytes(&self) -> usize {
        let lists = size_of_val(&*self.leaves) + size_of_val(&*self.joins) + size_of_val(&*self.start);
        lists
            + size_of_val(&*self.unbounded)
            + size_of_val(&*self.bounded)
            + self.bvh.as_ref().map_or(0, Bvh::memory_usage)
    }

    fn leaf_of(&self, part: u32) -> usize {
        let number = part & !(TURNED | ENTERS);
        // Fast path: with only shapes before it, the index is the position.
        let begins = |place: usize| self.leaves.get(place).is_some_and(|leaf| leaf.first == number);
        if begins(number as usize) && !begins(number as usize + 1) {
            return number as usize;
        }
        self.leaves.partition_point(|leaf| leaf.first <= number).saturating_sub(1)
    }

    /// Computes the surface at a hit in world space; its normals point out of the solid.
    pub fn surface(&self, ray: &Ray64, crossing: &ShapeHit, part: u32, rules: &ShadingRules) -> Surface {
        let (leaf, number) = (&self.leaves[self.leaf_of(part)], self.triangle(part));
        let point = leaf.object.local_line(ray).at(f64::from(crossing.t));
        let surface = leaf.object.surface(ray, point, crossing, number, rules);
        // A mesh may be inverted itself, so use the ray's direction of crossing.
        let turned = match leaf.object.geometry {
            Geometry::Mesh(_) => (surface.n_geo.dot(ray.dir()) < 0.0) != (part & ENTERS != 0),
            _ => part & TURNED != 0,
        };
        if !turned {
            return surface;
        }
        let [front, back] = surface.shadow_offsets;
        Surface { n_geo: -surface.n_geo, n_shade: -surface.n_shade, shadow_offsets: [back, front], ..surface }
    }

    /// Returns the first hit in the ray's interval, and its part. `inside`: for a ray that leaves
    /// the solid's surface, true if it starts inside.
    pub(super) fn closest<T: TraversalCounter>(
        &self,
        ray: &Ray64,
        inside: Option<bool>,
        counter: &mut T,
    ) -> Option<(ShapeHit, u32)> {
        if !durer_bvh::internal::is_sound(&ray.rounded) {
            return None;
        }
        SCRATCH.with_borrow_mut(|scratch| {
            let complete = self.collect(ray, true, scratch, counter);
            let found = self.sweep(ray, inside, scratch);
            // If the ray starts inside of a merge, the exit may be farther than the next part's
            // entry.
            if complete < f32::INFINITY && found.is_none_or(|(crossing, _)| crossing.t > complete) {
                self.collect(ray, false, scratch, counter);
                return self.sweep(ray, inside, scratch);
            }
            found
        })
    }

    /// Collects the crossings of all parts that may matter up to the first hit.
    ///
    /// A ray from outside a merge enters it at the first entry into a part: with `shrink`, parts
    /// beyond such an entry may be omitted. Returns the `t` up to which the crossings are complete,
    /// or infinity.
    fn collect<T: TraversalCounter>(&self, ray: &Ray64, shrink: bool, scratch: &mut Scratch, counter: &mut T) -> f32 {
        let Scratch { events, .. } = scratch;
        events.clear();
        let take = |i: u32, events: &mut Vec<Event>, counter: &mut T| {
            let offer = &mut |t, uv, part| events.push(Event { t, leaf: i, part, uv });
            let Leaf { object, axis, .. } = &self.leaves[i as usize];
            object.crossings(axis.as_ref(), ray, counter, offer);
        };
        self.unbounded.iter().for_each(|&i| take(i, events, counter));
        let Some(bvh) = &self.bvh else {
            self.bounded.iter().for_each(|&i| take(i, events, counter));
            events.sort_unstable_by(order);
            return f32::INFINITY;
        };
        // Crossings within the tolerance of the interval's ends matter too.
        let reach = self.slack + 4.0 * f32::EPSILON * ray.rounded.origin.abs().max_element();
        // Largest component as a lower bound of the direction's length, without a square root.
        let pad = GRAZING as f32 * reach / ray.dir().abs().max_element();
        // Move the origin back, because traversal is faster for rays that start at their origin.
        // The rounding of the origin is a thousandth of the pad.
        let Ray { origin, dir, t_min, t_max } = ray.rounded;
        let wide = Ray { origin: origin - pad * dir, dir, t_min, t_max: t_max + 2.0 * pad };
        let shrink = shrink && self.joins[0].rule == BoolOp::Any;
        let mut complete = f32::INFINITY;
        bvh.traverse(&wide, counter, |item, t_max, counter| {
            let (i, from) = (self.bounded[bvh.primitive_indices()[item] as usize], events.len());
            take(i, events, counter);
            if !shrink || self.leaves[i as usize].edge.join != 0 {
                return t_max;
            }
            let own = &mut events[from..];
            // Skip the sort for one or two events, which would stall on the fresh writes.
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

    /// Walks the sorted crossings to the first in the interval at which the whole changes.
    ///
    /// A ray that leaves the solid knows its starting side. If the crossings disagree, it starts
    /// closer to an edge than single precision can resolve, and a face is on the wrong side of its
    /// origin. Then the ray hits a face that it should hit at once, and ignores a face that should
    /// be behind it.
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
        // Last crossing behind the origin that leads to the other side.
        let mut behind: Option<(ShapeHit, u32)> = None;
        let mut known = inside;
        let (apart, speed) = self.apart(ray, events);
        let mut from = 0;
        while from < events.len() {
            // Fast path: most crossings are isolated.
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
                let leads = |event: &&Event| self.adds(event.leaf, state) != inside;
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

    /// Returns the hit at a crossing after which the whole is present or not.
    fn change(&self, event: &Event, state: &State, whole: bool) -> (ShapeHit, u32) {
        let turned = state.inside[event.leaf as usize] != whole;
        let bits = if turned { TURNED } else { 0 } | if whole { ENTERS } else { 0 };
        let part = (self.leaves[event.leaf as usize].first + event.part) | bits;
        (ShapeHit { t: event.t as f32, uv: event.uv }, part)
    }

    /// Returns true if a part in its current state adds to the whole: inside it, or outside of a
    /// subtracted part.
    fn adds(&self, leaf: u32, state: &State) -> bool {
        let mut adds = state.inside[leaf as usize];
        let mut edge = Some(self.leaves[leaf as usize].edge);
        while let Some(Edge { join, cut }) = edge {
            adds ^= cut;
            edge = self.joins[join as usize].edge;
        }
        adds
    }

    /// Toggles a part's inside bit; returns true if the bit of the whole changed.
    fn toggle(&self, leaf: u32, state: &mut State) -> bool {
        let bit = &mut state.inside[leaf as usize];
        *bit = !*bit;
        let (mut value, mut edge) = (*bit, self.leaves[leaf as usize].edge);
        loop {
            let join = &self.joins[edge.join as usize];
            let count = &mut state.counts[edge.join as usize];
            let before = join.value(*count);
            *count = if value != edge.cut { *count + 1 } else { *count - 1 };
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

    /// Returns an upper bound of the distance of coincident crossings, see [`Csg::coincide`], and a
    /// lower bound of the ray's speed.
    fn apart(&self, ray: &Ray64, events: &[Event]) -> (f64, f64) {
        let (line, speed) = (ray.line(), f64::from(ray.dir().abs().max_element()));
        let farthest = events.first().map_or(0.0, |e| e.t.abs()) + events.last().map_or(0.0, |e| e.t.abs());
        let reach = line.origin.abs().max_element() + farthest * speed;
        // A margin for different rounding there.
        (1.001 * GRAZING * (f64::from(self.slack) + 4.0 * f64::from(f32::EPSILON) * reach), speed)
    }

    /// Returns the end of the group of crossings that coincide with the first, each from a
    /// different part: see the head of this file.
    fn coincident(&self, ray: &Ray64, events: &[Event], from: usize, state: &mut State) -> usize {
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

    fn coincide(&self, ray: &Ray64, a: &Event, b: &Event) -> bool {
        let line = ray.line();
        let speed = line.dir.length();
        let gap = (b.t - a.t) * speed;
        let [s, u] = [a, b].map(|event| self.leaves[event.leaf as usize].slack);
        let slack = f64::from(s + u) + 4.0 * f64::from(f32::EPSILON) * line.at(a.t).abs().max_element();
        let [r, q] = [a, b].map(|event| self.leaves[event.leaf as usize].rounding);
        if gap.is_nan() || gap <= f64::from(r + q).min(slack) || gap > GRAZING * slack {
            return gap <= slack;
        }
        let [m, n] = [a, b].map(|event| {
            let object = &self.leaves[event.leaf as usize].object;
            let crossing = ShapeHit { t: event.t as f32, uv: event.uv };
            let at = object.local_line(ray).at(event.t);
            object.surface(ray, at, &crossing, event.part, &ShadingRules::default()).n_geo.as_dvec3()
        });
        // A grazing ray travels farther between faces at the same distance.
        let cosine = m.dot(line.dir).abs().max(n.dot(line.dir).abs()) / speed;
        m.dot(n).abs() >= ALIKE && gap * cosine <= slack
    }

    /// Returns the crossing whose surface is visible, of a group that changed the whole together.
    fn choose<'e>(&self, events: &'e [Event], state: &mut State) -> &'e Event {
        let mut could: Vec<&Event> = Vec::new();
        // Crossings without which the change would not happen.
        for event in events {
            if self.toggle(event.leaf, state) {
                could.push(event);
            }
            self.toggle(event.leaf, state);
        }
        // Crossings that cause the change alone: undo all, and redo each.
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

/// Reciprocal sine of grazing rays: flatter ones exceed the tolerance.
const GRAZING: f64 = 1000.0;

/// Cosine of the largest angle between coincident faces, 3.6 degrees: the rotation that rounding of
/// corners at 10^6 can cause for faces of size 1 that should share a plane.
const ALIKE: f64 = 0.998;

fn order(a: &Event, b: &Event) -> std::cmp::Ordering {
    a.t.total_cmp(&b.t).then(a.leaf.cmp(&b.leaf)).then(a.part.cmp(&b.part))
}

/// Returns two roundings of an object's coordinates, in world and in object space.
fn slack_of(object: &Object) -> f32 {
    let (Some(world), Some(local)) = (object.bounds(), object.local_bounds()) else { return 0.0 };
    let reach = |b: Aabb| b.min.abs().max(b.max.abs());
    let moved = object.to_world.as_ref().map_or(Vec3::ZERO, |to_world| to_world.spread(reach(local)));
    2.0 * f32::EPSILON * (reach(world).max_element() + moved.max_element())
}

#[cfg(test)]
mod tests;
