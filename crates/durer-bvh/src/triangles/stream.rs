//! Traces several incoherent rays through one tree in turn, one step at a time, in order to hide
//! memory latency.
//!
//! A single ray often has to wait for a node from memory, for the result of a test, or after a
//! mispredicted branch. Here several rays are in flight. While one of them waits, the others
//! proceed. Rays at inner nodes and rays at leaves are on separate lists, so no branch chooses
//! between the two. Each step writes its ray to both lists, but only one of the lists grows.

use super::fetch::{CHILD_LINES, PrefetchAddresses};
use super::query::{HitCollector, LeafTester};
use super::tree::TriangleBvh;
use crate::lanes::{Kernel, Lanes, Stack, StackStorage};
use crate::math::{Ray, Vec3};
use crate::node::{LEAF, SLOT_BITS, WideNode};
use crate::traverse::{Slabs, TraversalRay, Visitor, extreme_bit, intersect_node};
use std::hint::select_unpredictable;
use std::marker::PhantomData;

/// Number of rays in flight.
const IN_FLIGHT: usize = 16;
/// Marker at the bottom of each stack. It differs from the codes of all leaves because the item
/// range that it encodes would exceed the maximum.
const END: u32 = u32::MAX;

/// Size of a tree in bytes below which most of it is in the cache, so tracing rays one by one is
/// faster.
const MAX_CACHED_BYTES: usize = 8 << 20;
/// Minimum number of rays for a stream. With fewer rays, there are too few to hide each other's
/// latency.
const FEWEST: usize = 4;

impl TriangleBvh {
    /// Runs a query for each of the rays whose numbers are given.
    pub(super) fn trace_each<F: HitCollector + Default>(
        &self,
        rays: &[Ray],
        numbers: &[u32],
        mut answer: impl FnMut(usize, F::Answer),
    ) {
        match numbers.len() < FEWEST || self.memory_usage() < MAX_CACHED_BYTES {
            true => numbers.iter().for_each(|&i| answer(i as usize, self.query::<_, F>(&rays[i as usize], ()))),
            false => self.stream::<F>(rays, numbers, answer),
        }
    }

    /// Runs a query for each of the rays whose numbers are given, with several rays in flight.
    pub(super) fn stream<F: HitCollector + Default>(
        &self,
        rays: &[Ray],
        numbers: &[u32],
        answer: impl FnMut(usize, F::Answer),
    ) {
        self.level.run(Stream::<F, _> { bvh: self, rays, numbers: numbers.iter(), answer, found: PhantomData });
    }
}

/// Kernel that traces the rays whose numbers are given, with several of them in flight.
struct Stream<'a, F, A> {
    bvh: &'a TriangleBvh,
    rays: &'a [Ray],
    /// Numbers of the rays that have not started yet.
    numbers: std::slice::Iter<'a, u32>,
    answer: A,
    found: PhantomData<F>,
}

/// State of a ray that a [`Stream`] is tracing: its collector, its `t_max`, and the next node or
/// leaf.
struct InFlightRay<'a, F> {
    number: usize,
    boxes: TraversalRay,
    leaves: LeafTester<'a, (), F>,
    t_max: f32,
    child: u32,
}

/// List of the slots of rays that are at inner nodes, or of rays that are at leaves.
struct List {
    numbers: [u8; 2 * IN_FLIGHT],
    len: usize,
}

impl List {
    const EMPTY: List = List { numbers: [0; 2 * IN_FLIGHT], len: 0 };

    /// Appends `number` if `wanted` is true, without a branch.
    #[inline(always)]
    fn add(&mut self, number: u8, wanted: bool) {
        self.numbers[self.len] = number;
        self.len += usize::from(wanted);
    }
}

impl<'a, F: HitCollector + Default, A: FnMut(usize, F::Answer)> Stream<'a, F, A> {
    /// Starts the next ray in a slot. Returns false if there are no more rays. Rays that are not
    /// fast are traced immediately.
    #[inline(always)]
    fn start<L: Lanes>(&mut self, lanes: L, flight: &mut InFlightRay<'a, F>, stack: &mut Stack) -> bool {
        for &number in self.numbers.by_ref() {
            let number = number as usize;
            let ray = &self.rays[number];
            match TraversalRay::new(ray, self.bvh.reach) {
                Some(boxes) if !self.bvh.nodes.is_empty() => flight.boxes = boxes,
                _ => {
                    (self.answer)(number, self.bvh.query::<_, F>(ray, ()));
                    continue;
                }
            }
            flight.number = number;
            flight.leaves = LeafTester::new(lanes, self.bvh, ray, &flight.boxes, (), F::default());
            (flight.t_max, flight.child) = (ray.t_max, 0);
            stack.clear();
            stack.push(END, f32::NEG_INFINITY);
            PrefetchAddresses::new(self.bvh).fetch::<L, CHILD_LINES>(lanes, 0);
            return true;
        }
        false
    }
}

/// Visits one node. The ray's child becomes the next node or leaf.
#[inline(always)]
fn step<L: Lanes, F: HitCollector>(lanes: L, nodes: &[WideNode], flight: &mut InFlightRay<F>, stack: &mut Stack) {
    let slabs = Slabs::new(lanes, nodes, &flight.boxes);
    let hits = intersect_node::<L, true>(lanes, &slabs, flight.child as usize, lanes.splat(flight.t_max));
    let order = hits.node.order(F::ANY, flight.boxes.negative);
    let next = hits.next::<true>(lanes, F::ANY, extreme_bit(hits.mask, order != 0));
    hits.push(lanes, stack, next, order);
    // If no child was hit, no child was pushed.
    flight.child = select_unpredictable(hits.mask == 0, stack.pop_if(hits.mask == 0), hits.child(next & SLOT_BITS));
}

impl<'a, F: HitCollector + Default, A: FnMut(usize, F::Answer)> Kernel for Stream<'a, F, A> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let bvh = self.bvh;
        let places = PrefetchAddresses::new(bvh);
        let count = IN_FLIGHT.min(self.numbers.len());
        let mut rooms: Vec<StackStorage> = (0..count).map(|_| StackStorage::new()).collect();
        let mut stacks: Vec<Stack> = rooms.iter_mut().map(Stack::new).collect();
        const NOWHERE: &Ray = &Ray::new(Vec3::ZERO, Vec3::X);
        let boxes = TraversalRay::robust(NOWHERE, bvh.reach).expect("a sound ray");
        let place = |_| InFlightRay {
            number: 0,
            boxes,
            leaves: LeafTester::new(lanes, bvh, NOWHERE, &boxes, (), F::default()),
            t_max: 0.0,
            child: END,
        };
        let mut flights: Vec<InFlightRay<F>> = (0..count).map(place).collect();
        let (mut inner, mut leaves) = (List::EMPTY, List::EMPTY);
        for (number, (flight, stack)) in flights.iter_mut().zip(&mut stacks).enumerate() {
            let started = self.start(lanes, flight, stack);
            inner.add(number as u8, started);
        }
        while inner.len + leaves.len > 0 {
            // Visit a node for each ray at an inner node.
            let before = std::mem::replace(&mut inner.len, 0);
            for k in 0..before {
                let number = inner.numbers[k];
                let (flight, stack) = (&mut flights[usize::from(number)], &mut stacks[usize::from(number)]);
                step(lanes, &bvh.nodes, flight, stack);
                places.fetch::<L, CHILD_LINES>(lanes, flight.child);
                inner.add(number, flight.child & LEAF == 0);
                leaves.add(number, flight.child & LEAF != 0);
            }
            // Visit leaves when most rays are at a leaf.
            if inner.len >= leaves.len {
                continue;
            }
            let before = std::mem::replace(&mut leaves.len, 0);
            for k in 0..before {
                let number = leaves.numbers[k];
                let (flight, stack) = (&mut flights[usize::from(number)], &mut stacks[usize::from(number)]);
                let mut over = flight.child == END;
                if !over {
                    let t = flight.leaves.leaf::<L, true>(lanes, flight.child, flight.t_max);
                    over = t == f32::NEG_INFINITY;
                    flight.t_max = t;
                }
                if over {
                    (self.answer)(flight.number, flight.leaves.answer(flight.t_max));
                    if !self.start(lanes, flight, stack) {
                        // The slot remains empty.
                        continue;
                    }
                } else {
                    flight.child = stack.pop_until(flight.t_max);
                    places.fetch::<L, CHILD_LINES>(lanes, flight.child);
                }
                inner.add(number, flight.child & LEAF == 0);
                leaves.add(number, flight.child & LEAF != 0);
            }
        }
    }
}
