//! Traits that each SIMD level implements, and access to nodes, leaves, and rays in memory.

use super::stack::Stack;
use crate::math::{Doubles, Ray, Triple};
use crate::node::{self, WIDTH, WideNode};
use crate::watertight::AxisOrder;
use glam::Vec3A;
use std::mem::offset_of;

/// Arithmetic on vectors of `f32`, implemented by each SIMD level. A value of the implementing type
/// proves that the processor supports the level.
pub(crate) trait FloatLanes: Copy {
    /// Vector with one `f32` in each lane.
    type Floats: Copy;

    fn splat(self, x: f32) -> Self::Floats;
    fn add(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn sub(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn mul(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn div(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    fn abs(self, a: Self::Floats) -> Self::Floats;
    /// Returns a * b + c, rounded once or twice.
    fn mul_add(self, a: Self::Floats, b: Self::Floats, c: Self::Floats) -> Self::Floats;
    /// Returns `a` where it is less than `b`, and `b` elsewhere, also where either is NaN.
    fn min(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// Returns `a` where it is greater than `b`, and `b` elsewhere, also where either is NaN.
    fn max(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// Returns a mask of the lanes where a <= b.
    fn le(self, a: Self::Floats, b: Self::Floats) -> u32;
    /// Returns a mask of the lanes where a < b.
    fn lt(self, a: Self::Floats, b: Self::Floats) -> u32;

    /// Returns one vector per component, with that component in all lanes.
    #[inline(always)]
    fn splat3(self, [x, y, z]: [f32; 3]) -> [Self::Floats; 3] {
        [self.splat(x), self.splat(y), self.splat(z)]
    }
}

/// Operations on vectors with eight lanes that ray queries need. Each SIMD level implements them.
pub(crate) trait Lanes: FloatLanes {
    /// Level for operations on sixteen lanes.
    type Wide: WideLanes;
    /// Vector of eight `f64` values.
    type Doubles: Doubles;
    /// Vector of three `f64` components.
    type Triple: Triple<Component = f64>;

    fn wide(self) -> Self::Wide;
    /// Joins two vectors with eight lanes each.
    fn join(self, halves: [Self::Floats; 2]) -> <Self::Wide as FloatLanes>::Floats;
    fn doubles(self, a: Self::Floats) -> Self::Doubles;
    /// Rounds to single precision.
    fn singles(self, a: Self::Doubles) -> Self::Floats;

    fn splat_double(self, x: f64) -> Self::Doubles;
    fn load_doubles(self, from: &[f64; WIDTH]) -> Self::Doubles;
    fn store_doubles(self, a: Self::Doubles) -> [f64; WIDTH];
    /// Returns a mask of the lanes where a <= b.
    fn le_doubles(self, a: Self::Doubles, b: Self::Doubles) -> u32;

    /// Converts each component to double precision.
    #[inline(always)]
    fn doubles3(self, [x, y, z]: [Self::Floats; 3]) -> [Self::Doubles; 3] {
        [self.doubles(x), self.doubles(y), self.doubles(z)]
    }

    /// Converts a vector to double precision.
    fn triple(self, v: Vec3A) -> Self::Triple;

    /// Permutes the components of a vector.
    fn permute(self, v: Vec3A, axes: &AxisOrder) -> Vec3A;

    fn load(self, from: &[f32; WIDTH]) -> Self::Floats;
    /// Loads the corners of a leaf's triangles. Lanes beyond the number of triangles have
    /// meaningless values.
    fn corners(self, from: &Rows, columns: CornerColumns) -> [[Self::Floats; 3]; 3];
    fn store(self, a: Self::Floats) -> [f32; WIDTH];
    /// Returns the minimum when compared as signed integers. It equals [`FloatLanes::min`] if
    /// neither operand is negative, and it is negative if either operand is.
    fn min_as_int(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// Returns the maximum when compared as signed integers. It equals [`FloatLanes::max`] if at
    /// least one operand is not negative.
    fn max_as_int(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// Sets all bits in the lanes where a < b, compared as signed integers, and clears all bits in
    /// the other lanes.
    fn lt_as_int(self, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// Returns a mask of the lanes whose sign bit is set.
    fn signs(self, a: Self::Floats) -> u32;
    /// Intersects three slab intervals with the interval `within` of the ray. Returns the last
    /// start, computed with [`Lanes::max_as_int`], and the first end, computed with
    /// [`Lanes::min_as_int`]. The slab that is loaded last should be passed as the last argument.
    #[inline(always)]
    fn interval(self, [x, y, z]: [[Self::Floats; 2]; 3], within: [Self::Floats; 2]) -> [Self::Floats; 2] {
        let enter = self.max_as_int(z[0], self.max_as_int(y[0], self.max_as_int(x[0], within[0])));
        let leave = self.min_as_int(z[1], self.min_as_int(y[1], self.min_as_int(x[1], within[1])));
        [enter, leave]
    }
    /// Returns the minimum of `a` over the lanes in which all bits of `which` are set. The last
    /// eight bits of `a` are ignored. In the result, they are replaced by the tag of the lane. `a`
    /// must not be negative. If no lane is selected, the result is arbitrary.
    fn nearest(self, a: Self::Floats, which: Self::Floats, child_tags: &[u8; WIDTH]) -> u32;
    /// Returns `a` in the lanes whose mask bits are set and `b` in the others. The bits of the
    /// values do not change.
    fn select(self, mask: u32, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// Moves lane k of vector i to lane i of vector k.
    fn transpose(self, rows: [Self::Floats; WIDTH]) -> [Self::Floats; WIDTH];
    /// Pushes the first `count` children in the lane order `order`, each with its entry distance.
    fn push(self, stack: &mut Stack, children: &[u32; WIDTH], near: Self::Floats, order: &[u8; WIDTH], count: u32);
    /// Prefetches the cache line at an address. The address may be invalid.
    fn prefetch<T>(self, at: *const T);
}

/// Number of lanes of [`Wide`].
pub const WIDE: usize = 2 * WIDTH;

/// Operations on vectors with sixteen lanes, for ray packets. They use either one AVX-512 vector or
/// two vectors with eight lanes.
pub(crate) trait WideLanes: FloatLanes {
    fn load(self, from: &[f32; WIDE]) -> Self::Floats;
    fn store(self, a: Self::Floats) -> [f32; WIDE];
    /// Returns `a` in the lanes whose mask bits are set and `b` in the others. The bits of the
    /// values do not change.
    fn select(self, mask: u32, a: Self::Floats, b: Self::Floats) -> Self::Floats;
    /// Returns the minimum of all lanes, which must not be NaN.
    fn least(self, a: Self::Floats) -> f32;
    /// Returns the maximum of all lanes, which must not be NaN.
    fn greatest(self, a: Self::Floats) -> f32;
}

/// Number of rows in a leaf of triangles: nine rows of coordinates and one row of numbers.
pub const ROWS: usize = 10;

/// Storage for the rows of a triangle leaf. It is long enough to load a vector from the start of
/// any of the first nine rows.
pub type Rows = [f32; ROWS_LEN];

/// Number of values in [`Rows`].
pub const ROWS_LEN: usize = ROWS * WIDTH;

/// Access to the near and far planes of boxes in all nodes of a tree, given the signs of a ray's
/// direction.
pub(crate) struct NodePlanes<'a> {
    nodes: &'a [WideNode],
    /// Addresses of the planes in the first node, for each axis.
    near: [*const u8; 3],
    far: [*const u8; 3],
}

impl<'a> NodePlanes<'a> {
    /// Selects the planes for rays whose directions are negative along the axes whose bits are set
    /// in `negative`.
    #[inline(always)]
    pub fn new(nodes: &'a [WideNode], negative: u32) -> Self {
        assert!(nodes.len() <= node::MAX_NODES);
        const ROW: usize = size_of::<[f32; WIDTH]>();
        let first = nodes.as_ptr().cast::<u8>().wrapping_add(offset_of!(WideNode, planes));
        let side = |axis: usize, upper: u32| first.wrapping_add((2 * axis + upper as usize) * ROW);
        let [x, y, z] = [negative & 1, negative >> 1 & 1, negative >> 2 & 1];
        let (near, far) = ([side(0, x), side(1, y), side(2, z)], [side(0, x ^ 1), side(1, y ^ 1), side(2, z ^ 1)]);
        NodePlanes { nodes, near, far }
    }

    /// Returns the node at a [`node_offset`](node::node_offset).
    #[inline(always)]
    pub fn at(&self, address: usize) -> NodeAccess<'a, '_> {
        // If the offset is misaligned, the rotation moves its low bits to the top, so the bounds
        // check fails.
        let number = address.rotate_right(node::UNITS.trailing_zeros());
        assert!(number < self.nodes.len());
        NodeAccess { sides: self, offset: address * node::UNIT, node: &self.nodes[number] }
    }
}

/// A node during traversal, with the near and far planes of its boxes. [`NodePlanes::at`] returns
/// it.
pub(crate) struct NodeAccess<'a, 's> {
    sides: &'s NodePlanes<'a>,
    offset: usize,
    pub node: &'a WideNode,
}

impl<'a> NodeAccess<'a, '_> {
    /// Returns the planes at which the ray enters along an axis.
    #[inline(always)]
    pub fn near(&self, axis: usize) -> &'a [f32; WIDTH] {
        // SAFETY: the row lies in the first node, and `NodePlanes::at` ensures that there is a node
        // `offset` bytes further.
        unsafe { &*self.sides.near[axis].wrapping_add(self.offset).cast() }
    }

    /// Returns the planes at which the ray leaves along an axis.
    #[inline(always)]
    pub fn far(&self, axis: usize) -> &'a [f32; WIDTH] {
        // SAFETY: see above.
        unsafe { &*self.sides.far[axis].wrapping_add(self.offset).cast() }
    }

    /// Returns the [tags](WideNode::child_tags) of the node. The address is computed in the same
    /// way as the addresses of the planes because the ray has to wait for the tags.
    #[inline(always)]
    pub fn child_tags(&self) -> &'a [u8; WIDTH] {
        let first = self.sides.nodes.as_ptr().cast::<u8>().wrapping_add(offset_of!(WideNode, child_tags));
        // SAFETY: the tags lie in the first node, and there is a node `offset` bytes further.
        unsafe { &*first.wrapping_add(self.offset).cast() }
    }
}

/// Returns the values of a ray as stored in memory: origin, direction, and interval.
#[inline(always)]
pub(crate) fn as_floats(ray: &Ray) -> &[f32; WIDTH] {
    const { assert!(size_of::<Ray>() == size_of::<[f32; WIDTH]>()) };
    // SAFETY: a ray consists of eight numbers, in the order of their declaration.
    unsafe { &*std::ptr::from_ref(ray).cast() }
}

/// Positions of the corners of a leaf's triangles in [`Rows`], with the axes permuted.
#[derive(Clone, Copy)]
pub(crate) struct CornerColumns {
    /// Start of the rows of the first corner, for each axis.
    pub starts: [usize; 3],
    /// Distance between the rows of two corners.
    pub corner: usize,
}

impl CornerColumns {
    /// Returns the positions in a leaf with `count` triangles.
    #[inline(always)]
    pub fn new(&[x, y, z, _]: &AxisOrder, count: usize) -> Self {
        assert!(count <= WIDTH);
        // The mask keeps the start within the rows.
        CornerColumns { starts: [x, y, z].map(|axis| (axis & 3) as usize * count), corner: 3 * count }
    }

    /// Returns the corners of one triangle.
    #[inline(always)]
    pub fn triangle(self, from: &Rows, lane: usize) -> [Vec3A; 3] {
        assert!(lane < WIDTH);
        let CornerColumns { starts: [x, y, z], corner } = self;
        // SAFETY: because of `new` and the assertion, the last value lies in one of the first ten
        // rows, which have at most eight numbers each.
        let at = |place: usize| unsafe { *from.get_unchecked(place + lane) };
        let (b, c) = (corner, 2 * corner);
        [
            Vec3A::new(at(x), at(y), at(z)),
            Vec3A::new(at(b + x), at(b + y), at(b + z)),
            Vec3A::new(at(c + x), at(c + y), at(c + z)),
        ]
    }
}

/// A function that can run at any SIMD level, such as a ray query. Its arguments are the fields of
/// the kernel.
pub(crate) trait Kernel {
    type Output;
    /// Runs the kernel. It must be inlined so that it is compiled for the level.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}
