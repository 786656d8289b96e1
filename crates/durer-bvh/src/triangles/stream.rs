//! Many rays through one tree, each a step at a time.
//!
//! A ray alone waits: for a node from memory, for the result of a test, for the processor that guessed a branch wrongly. Here
//! several are on their way, and while one waits the others go on. Rays at inner nodes and rays at leaves are on two lists, so what
//! comes next is no branch: a step writes its ray to both lists, and one of the two gets longer.

use super::TriangleBvh;
use super::fetch::{ITSELF, Places};
use super::query::{Found, Leaves};
use crate::lanes::{Kernel, Lanes, Room, Stack};
use crate::math::{Ray, Vec3};
use crate::node::{LEAF, Node, PLACE};
use crate::traverse::{RayBox, Slabs, Visitor, end_of, meet};
use std::hint::select_unpredictable;
use std::marker::PhantomData;

/// How many rays are on their way at once.
const FLYING: usize = 16;
/// At the bottom of each stack: no leaf has this number, for its items would be beyond the most.
const END: u32 = u32::MAX;

/// Of a tree of fewer bytes, most is near: there, rays are faster one by one.
const NEAR: usize = 8 << 20;

impl TriangleBvh {
    /// Answers a question for each of the rays with these numbers.
    pub(super) fn each<F: Found>(&self, rays: &[Ray], numbers: &[u32], mut answer: impl FnMut(usize, F::Answer)) {
        match self.bytes() < NEAR {
            true => numbers.iter().for_each(|&i| answer(i as usize, self.query::<_, F>(&rays[i as usize], ()))),
            false => self.stream::<F>(rays, numbers, answer),
        }
    }

    /// As [`TriangleBvh::each`], several on their way at once.
    pub(super) fn stream<F: Found>(&self, rays: &[Ray], numbers: &[u32], answer: impl FnMut(usize, F::Answer)) {
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
struct Flyer<'a, F> {
    number: usize,
    boxes: RayBox,
    leaves: Leaves<'a, (), F>,
    t_max: f32,
    child: u32,
}

/// Numbers of rays.
struct List {
    numbers: [u8; 2 * FLYING],
    len: usize,
}

impl List {
    const EMPTY: List = List { numbers: [0; 2 * FLYING], len: 0 };

    /// Adds a number if something is so.
    #[inline(always)]
    fn add(&mut self, number: u8, wanted: bool) {
        self.numbers[self.len] = number;
        self.len += usize::from(wanted);
    }
}

impl<'a, F: Found, A: FnMut(usize, F::Answer)> Stream<'a, F, A> {
    /// Puts the next ray in a place, if there is one. Rays that are not traced here are answered at once.
    #[inline(always)]
    fn start<L: Lanes>(&mut self, lanes: L, flyer: &mut Flyer<'a, F>, stack: &mut Stack) -> bool {
        for &number in self.numbers.by_ref() {
            let number = number as usize;
            let ray = &self.rays[number];
            match RayBox::new(ray, self.bvh.reach) {
                Some(boxes) if !self.bvh.nodes.is_empty() => flyer.boxes = boxes,
                _ => {
                    (self.answer)(number, self.bvh.query::<_, F>(ray, ()));
                    continue;
                }
            }
            flyer.number = number;
            flyer.leaves = Leaves::new(lanes, self.bvh, ray, &flyer.boxes, ());
            (flyer.t_max, flyer.child) = (ray.t_max, 0);
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
fn step<L: Lanes, F: Found>(lanes: L, nodes: &[Node], flyer: &mut Flyer<F>, stack: &mut Stack) {
    let slabs = Slabs::new(lanes, nodes, &flyer.boxes);
    let met = meet::<L, true>(lanes, &slabs, flyer.child as usize, lanes.splat(flyer.t_max));
    let order = met.node.order(F::ANY, flyer.boxes.negative);
    let next = met.next::<true>(lanes, F::ANY, end_of(met.mask, order != 0));
    met.push(lanes, stack, next, order);
    // If nothing was met, nothing was pushed.
    flyer.child = select_unpredictable(met.mask == 0, stack.pop_if(met.mask == 0), met.child(next & PLACE));
}

impl<'a, F: Found, A: FnMut(usize, F::Answer)> Kernel for Stream<'a, F, A> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let bvh = self.bvh;
        let places = Places::new(bvh);
        let mut rooms: Vec<Room> = (0..FLYING).map(|_| Room::new()).collect();
        let mut stacks: Vec<Stack> = rooms.iter_mut().map(Stack::new).collect();
        const NOWHERE: &Ray = &Ray::new(Vec3::ZERO, Vec3::X);
        let boxes = RayBox::wild(NOWHERE, bvh.reach).expect("a sound ray");
        let place = |_| Flyer {
            number: 0,
            boxes,
            leaves: Leaves::new(lanes, bvh, NOWHERE, &boxes, ()),
            t_max: 0.0,
            child: END,
        };
        let mut flyers: Vec<Flyer<F>> = (0..FLYING).map(place).collect();
        let (mut inner, mut leaves) = (List::EMPTY, List::EMPTY);
        for (number, (flyer, stack)) in flyers.iter_mut().zip(&mut stacks).enumerate() {
            let started = self.start(lanes, flyer, stack);
            inner.add(number as u8, started);
        }
        while inner.len + leaves.len > 0 {
            // A node for each ray that is at one.
            let before = std::mem::replace(&mut inner.len, 0);
            for k in 0..before {
                let number = inner.numbers[k];
                let (flyer, stack) = (&mut flyers[usize::from(number)], &mut stacks[usize::from(number)]);
                step(lanes, &bvh.nodes, flyer, stack);
                places.fetch::<L, ITSELF>(lanes, flyer.child);
                inner.add(number, flyer.child & LEAF == 0);
                leaves.add(number, flyer.child & LEAF != 0);
            }
            // Leaves once there are several.
            if inner.len >= leaves.len {
                continue;
            }
            let before = std::mem::replace(&mut leaves.len, 0);
            for k in 0..before {
                let number = leaves.numbers[k];
                let (flyer, stack) = (&mut flyers[usize::from(number)], &mut stacks[usize::from(number)]);
                let mut over = flyer.child == END;
                if !over {
                    let t = flyer.leaves.leaf::<L, true>(lanes, flyer.child, flyer.t_max);
                    over = t == f32::NEG_INFINITY;
                    flyer.t_max = t;
                }
                if over {
                    (self.answer)(flyer.number, flyer.leaves.answer(flyer.t_max));
                    if !self.start(lanes, flyer, stack) {
                        // Its place stays empty.
                        continue;
                    }
                } else {
                    flyer.child = stack.pop_until(flyer.t_max);
                    places.fetch::<L, ITSELF>(lanes, flyer.child);
                }
                inner.add(number, flyer.child & LEAF == 0);
                leaves.add(number, flyer.child & LEAF != 0);
            }
        }
    }
}
