//! Many rays through one tree, each a step at a time.
//!
//! A ray alone waits: for a node from memory, for the result of a test, for the processor that
//! guessed a branch wrongly. Here several are on their way, and while one waits the others go on.
//! Rays at inner nodes and rays at leaves are on two lists, so what comes next is no branch: a step
//! writes its ray to both lists, and one of the two gets longer.

use super::fetch::{ITSELF, Places};
use super::query::{HitCollector, Leaves};
use super::tree::TriangleBvh;
use crate::lanes::{Kernel, Lanes, Stack, StackStorage};
use crate::math::{Ray, Vec3};
use crate::node::{LEAF, PLACE, WideNode};
use crate::traverse::{Slabs, TraversalRay, Visitor, end_of, intersect_node};
use std::hint::select_unpredictable;
use std::marker::PhantomData;

/// How many rays are on their way at once.
const IN_FLIGHT: usize = 16;
/// At the bottom of each stack: no leaf has this number, for its items would be beyond the most.
const END: u32 = u32::MAX;

/// Of a tree of fewer bytes, most is near: there, rays are faster one by one.
const MAX_CACHED_BYTES: usize = 8 << 20;
/// Fewer rays do not wait for each other long enough to be worth a place for each.
const FEWEST: usize = 4;

impl TriangleBvh {
    /// Answers a question for each of the rays with these numbers.
    pub(super) fn each<F: HitCollector + Default>(
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

    /// As [`TriangleBvh::each`], several on their way at once.
    pub(super) fn stream<F: HitCollector + Default>(
        &self,
        rays: &[Ray],
        numbers: &[u32],
        answer: impl FnMut(usize, F::Answer),
    ) {
        self.level.run(Stream::<F, _> { bvh: self, rays, numbers: numbers.iter(), answer, found: PhantomData });
    }
}

struct Stream<'a, F, A> {
    bvh: &'a TriangleBvh,
    rays: &'a [Ray],
    /// Of the rays that are still to be started.
    numbers: std::slice::Iter<'a, u32>,
    answer: A,
    found: PhantomData<F>,
}

/// A ray on its way.
struct InFlightRay<'a, F> {
    number: usize,
    boxes: TraversalRay,
    leaves: Leaves<'a, (), F>,
    t_max: f32,
    child: u32,
}

/// Numbers of rays.
struct List {
    numbers: [u8; 2 * IN_FLIGHT],
    len: usize,
}

impl List {
    const EMPTY: List = List { numbers: [0; 2 * IN_FLIGHT], len: 0 };

    /// Adds a number if something is so.
    #[inline(always)]
    fn add(&mut self, number: u8, wanted: bool) {
        self.numbers[self.len] = number;
        self.len += usize::from(wanted);
    }
}

impl<'a, F: HitCollector + Default, A: FnMut(usize, F::Answer)> Stream<'a, F, A> {
    /// Puts the next ray in a place, if there is one. Rays that are not traced here are answered at
    /// once.
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
            flight.leaves = Leaves::new(lanes, self.bvh, ray, &flight.boxes, (), F::default());
            (flight.t_max, flight.child) = (ray.t_max, 0);
            stack.clear();
            stack.push(END, f32::NEG_INFINITY);
            Places::new(self.bvh).fetch::<L, ITSELF>(lanes, 0);
            return true;
        }
        false
    }
}

/// One node of a ray's way: its child is the next node or leaf.
#[inline(always)]
fn step<L: Lanes, F: HitCollector>(lanes: L, nodes: &[WideNode], flight: &mut InFlightRay<F>, stack: &mut Stack) {
    let slabs = Slabs::new(lanes, nodes, &flight.boxes);
    let met = intersect_node::<L, true>(lanes, &slabs, flight.child as usize, lanes.splat(flight.t_max));
    let order = met.node.order(F::ANY, flight.boxes.negative);
    let next = met.next::<true>(lanes, F::ANY, end_of(met.mask, order != 0));
    met.push(lanes, stack, next, order);
    // If nothing was met, nothing was pushed.
    flight.child = select_unpredictable(met.mask == 0, stack.pop_if(met.mask == 0), met.child(next & PLACE));
}

impl<'a, F: HitCollector + Default, A: FnMut(usize, F::Answer)> Kernel for Stream<'a, F, A> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let bvh = self.bvh;
        let places = Places::new(bvh);
        let count = IN_FLIGHT.min(self.numbers.len());
        let mut rooms: Vec<StackStorage> = (0..count).map(|_| StackStorage::new()).collect();
        let mut stacks: Vec<Stack> = rooms.iter_mut().map(Stack::new).collect();
        const NOWHERE: &Ray = &Ray::new(Vec3::ZERO, Vec3::X);
        let boxes = TraversalRay::robust(NOWHERE, bvh.reach).expect("a sound ray");
        let place = |_| InFlightRay {
            number: 0,
            boxes,
            leaves: Leaves::new(lanes, bvh, NOWHERE, &boxes, (), F::default()),
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
            // A node for each ray that is at one.
            let before = std::mem::replace(&mut inner.len, 0);
            for k in 0..before {
                let number = inner.numbers[k];
                let (flight, stack) = (&mut flights[usize::from(number)], &mut stacks[usize::from(number)]);
                step(lanes, &bvh.nodes, flight, stack);
                places.fetch::<L, ITSELF>(lanes, flight.child);
                inner.add(number, flight.child & LEAF == 0);
                leaves.add(number, flight.child & LEAF != 0);
            }
            // Leaves once there are several.
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
                        // Its place stays empty.
                        continue;
                    }
                } else {
                    flight.child = stack.pop_until(flight.t_max);
                    places.fetch::<L, ITSELF>(lanes, flight.child);
                }
                inner.add(number, flight.child & LEAF == 0);
                leaves.add(number, flight.child & LEAF != 0);
            }
        }
    }
}
