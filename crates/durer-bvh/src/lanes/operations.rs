//! What the kernel needs of a SIMD level, as traits that each level implements once, and how it
//! reads nodes, leaves and rays.

use super::stack::Stack;
use crate::math::{Doubles, Ray, Triple};
use crate::node::{self, WIDTH, WideNode};
use crate::watertight::AxisOrder;
use glam::Vec3A;
use std::mem::offset_of;

/// Arithmetic on numbers side by side; a value of the type proves that the processor has it.
pub(crate) trait Numbers: Copy {
    /// So many `f32`.
    type Floats: Copy;

    fn splat(self, x: f32) -> Self::Floats;
    fn add(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn sub(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn mul(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn div(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn abs(self, a: Self::Floats) -> Self::Floats;
    /// a * b + c, rounded once or twice.
    fn mul_add(self, a: Self::Floats, b: Self::Floats, c: Self::Floats) -> Self::Floats;
    /// `a` where it is less than `b`, else `b`: also where either is no number.
    fn min(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// `a` where it is greater than `b`, else `b`: also where either is no number.
    fn max(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// A bit for each lane where a <= b.
    fn le(self, a: Self::Floats, b: Self::Floats) -> u32;
    /// A bit for each lane where a < b.
    fn lt(self, a: Self::Floats, b: Self::Floats) -> u32;

    /// A vector in each lane.
    #[inline(always)]
    fn splat3(self, [x, y, z]: [f32; 3]) -> [Self::Floats; 3] {
        [self.splat(x), self.splat(y), self.splat(z)]
    }
}

/// What can be done with eight numbers.
pub(crate) trait Lanes: Numbers {
    /// The same for sixteen numbers.
    type Wide: Wide;
    /// So many `f64`.
    type Doubles: Doubles;
    /// A vector of `f64`.
    type Triple: Triple<Component = f64>;

    fn wide(self) -> Self::Wide;
    /// Sixteen numbers of twice eight.
    fn join(self, halves: [Self::Floats; 2]) -> <Self::Wide as Numbers>::Floats;
    fn doubles(self, a: Self::Floats) -> Self::Doubles;
    /// Rounded to single precision.
    fn singles(self, a: Self::Doubles) -> Self::Floats;

    fn splat_double(self, x: f64) -> Self::Doubles;
    fn load_doubles(self, from: &[f64; WIDTH]) -> Self::Doubles;
    fn store_doubles(self, a: Self::Doubles) -> [f64; WIDTH];
    /// A bit for each lane where a <= b.
    fn le_doubles(self, a: Self::Doubles, b: Self::Doubles) -> u32;

    /// A vector in each lane.
    #[inline(always)]
    fn doubles3(self, [x, y, z]: [Self::Floats; 3]) -> [Self::Doubles; 3] {
        [self.doubles(x), self.doubles(y), self.doubles(z)]
    }

    /// A vector in double precision.
    fn triple(self, v: Vec3A) -> Self::Triple;

    /// A vector with its components in another order.
    fn turn(self, v: Vec3A, axes: &AxisOrder) -> Vec3A;

    fn load(self, from: &[f32; WIDTH]) -> Self::Floats;
    /// The corners of the triangles of a leaf; only as many lanes as there are triangles mean
    /// anything.
    fn corners(self, from: &Rows, columns: Columns) -> [[Self::Floats; 3]; 3];
    fn store(self, a: Self::Floats) -> [f32; WIDTH];
    /// The lesser of two numbers as signed integers have it: a negative one where either is
    /// negative, else as [`Numbers::min`].
    fn sooner(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// The greater of two numbers as signed integers have it: where one of them at least is not
    /// negative as [`Numbers::max`].
    fn later(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// All bits of the lanes where a < b as signed integers have it, no bits of others.
    fn before(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// A bit for each lane that has a sign.
    fn signs(self, a: Self::Floats) -> u32;
    /// Where a ray is in slabs, each of which begins and ends somewhere, and in its own interval:
    /// the last beginning and the first end, as [`Lanes::later`] and [`Lanes::sooner`] have them.
    /// What is read from memory last should be the last slab.
    #[inline(always)]
    fn interval(self, [x, y, z]: [[Self::Floats; 2]; 3], within: [Self::Floats; 2]) -> [Self::Floats; 2] {
        let enter = self.later(z[0], self.later(y[0], self.later(x[0], within[0])));
        let leave = self.sooner(z[1], self.sooner(y[1], self.sooner(x[1], within[1])));
        [enter, leave]
    }
    /// Where `a`, of which nothing is negative, is least of the lanes that have all bits in
    /// `which`: `a` without its last eight bits, by which lanes are not compared, and with those of
    /// the lane's code instead. Something else if there are no such lanes.
    fn nearest(self, a: Self::Floats, which: Self::Floats, child_tags: &[u8; WIDTH]) -> u32;
    /// `a` in the lanes whose bits are set, `b` in others. Bits stay as they are.
    fn select(self, mask: u32, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// Lane k of vector i becomes lane i of vector k.
    fn transpose(self, rows: [Self::Floats; WIDTH]) -> [Self::Floats; WIDTH];
    /// Pushes the first `count` children in an order of lanes, each with its entry distance.
    fn push(self, stack: &mut Stack, children: &[u32; WIDTH], near: Self::Floats, order: &[u8; WIDTH], count: u32);
    /// Has the line of memory at an address, if there is one, brought near.
    fn prefetch<T>(self, at: *const T);
}

/// How many numbers lie side by side.
pub const WIDE: usize = 2 * WIDTH;

/// What can be done with sixteen numbers.
pub(crate) trait Wide: Numbers {
    fn load(self, from: &[f32; WIDE]) -> Self::Floats;
    fn store(self, a: Self::Floats) -> [f32; WIDE];
    /// `a` in the lanes whose bits are set, `b` in others. Bits stay as they are.
    fn select(self, mask: u32, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// The least of all lanes, none of which is NaN.
    fn least(self, a: Self::Floats) -> f32;
    /// The greatest of all lanes, none of which is NaN.
    fn greatest(self, a: Self::Floats) -> f32;
}

/// How many rows a leaf of triangles has: nine coordinates and a number.
pub const ROWS: usize = 10;

/// As many rows as there may be. All of a vector that begins in one of the first nine is in them.
pub type Rows = [f32; ROOM_OF_ROWS];

/// How many numbers that is.
pub const ROOM_OF_ROWS: usize = ROWS * WIDTH;

/// The sides of boxes where a ray enters and where it leaves, in each of many nodes.
pub(crate) struct Sides<'a> {
    nodes: &'a [WideNode],
    /// In the first node, by axis.
    near: [*const u8; 3],
    far: [*const u8; 3],
}

impl<'a> Sides<'a> {
    /// For rays that are negative along the axes whose bits are set.
    #[inline(always)]
    pub fn new(nodes: &'a [WideNode], negative: u32) -> Self {
        assert!(nodes.len() <= node::MAX_NODES);
        const ROW: usize = size_of::<[f32; WIDTH]>();
        let first = nodes.as_ptr().cast::<u8>().wrapping_add(offset_of!(WideNode, planes));
        let side = |axis: usize, upper: u32| first.wrapping_add((2 * axis + upper as usize) * ROW);
        let [x, y, z] = [negative & 1, negative >> 1 & 1, negative >> 2 & 1];
        let (near, far) = ([side(0, x), side(1, y), side(2, z)], [side(0, x ^ 1), side(1, y ^ 1), side(2, z ^ 1)]);
        Sides { nodes, near, far }
    }

    /// The node at an [`node_offset`](node::node_offset), which must be one of a node.
    #[inline(always)]
    pub fn at(&self, address: usize) -> At<'a, '_> {
        // Turned so, what is no multiple of a node's size is more than there can be.
        let number = address.rotate_right(node::UNITS.trailing_zeros());
        assert!(number < self.nodes.len());
        At { sides: self, offset: address * node::UNIT, node: &self.nodes[number] }
    }
}

/// A node, and where it is.
pub(crate) struct At<'a, 's> {
    sides: &'s Sides<'a>,
    offset: usize,
    pub node: &'a WideNode,
}

impl<'a> At<'a, '_> {
    /// Where a ray enters along an axis.
    #[inline(always)]
    pub fn near(&self, axis: usize) -> &'a [f32; WIDTH] {
        // SAFETY: the row is in the first node, and by `Sides::at` another node is so far behind
        // it.
        unsafe { &*self.sides.near[axis].wrapping_add(self.offset).cast() }
    }

    /// Where it leaves.
    #[inline(always)]
    pub fn far(&self, axis: usize) -> &'a [f32; WIDTH] {
        // SAFETY: as above.
        unsafe { &*self.sides.far[axis].wrapping_add(self.offset).cast() }
    }

    /// The node's [tags](WideNode::child_tags), found as soon as its sides, for they are
    /// waited for.
    #[inline(always)]
    pub fn child_tags(&self) -> &'a [u8; WIDTH] {
        let first = self.sides.nodes.as_ptr().cast::<u8>().wrapping_add(offset_of!(WideNode, child_tags));
        // SAFETY: it is in the first node, and another node is so far behind that.
        unsafe { &*first.wrapping_add(self.offset).cast() }
    }
}

/// A ray as it lies in memory: origin, direction, and interval.
#[inline(always)]
pub(crate) fn numbers_of(ray: &Ray) -> &[f32; WIDTH] {
    const { assert!(size_of::<Ray>() == size_of::<[f32; WIDTH]>()) };
    // SAFETY: it is eight numbers, in the order in which they are declared.
    unsafe { &*std::ptr::from_ref(ray).cast() }
}

/// Where the numbers of a leaf's triangles are, with axes in some order.
#[derive(Clone, Copy)]
pub(crate) struct Columns {
    /// Where the rows of the first corner begin, by axis.
    pub starts: [usize; 3],
    /// How many numbers lie between the rows of corners.
    pub corner: usize,
}

impl Columns {
    /// Of so many triangles.
    #[inline(always)]
    pub fn new(&[x, y, z, _]: &AxisOrder, count: usize) -> Self {
        assert!(count <= WIDTH);
        // So masked, no row begins later than the last.
        Columns { starts: [x, y, z].map(|axis| (axis & 3) as usize * count), corner: 3 * count }
    }

    /// The corners of one triangle.
    #[inline(always)]
    pub fn triangle(self, from: &Rows, lane: usize) -> [Vec3A; 3] {
        assert!(lane < WIDTH);
        let Columns { starts: [x, y, z], corner } = self;
        // SAFETY: by `new` and this the last is in one of the first ten rows of at most eight
        // numbers.
        let at = |place: usize| unsafe { *from.get_unchecked(place + lane) };
        let (b, c) = (corner, 2 * corner);
        [
            Vec3A::new(at(x), at(y), at(z)),
            Vec3A::new(at(b + x), at(b + y), at(b + z)),
            Vec3A::new(at(c + x), at(c + y), at(c + z)),
        ]
    }
}

/// A piece of work that runs on any level.
pub(crate) trait Kernel {
    type Output;
    /// Must be inlined, to be compiled for the level.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}
