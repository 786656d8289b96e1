//! SIMD operations with WebAssembly's `simd128`, which handle eight lanes as two vectors of four.
//!
//! The compiler option `-C target-feature=+simd128` selects this level. There is no check at run
//! time because a module either contains the instructions or does not. Relaxed SIMD is not used,
//! because its results can differ between machines.

use super::operations::{CornerColumns, FloatLanes, Lanes, Rows};
use super::stack::Stack;
use super::wide::TwoVectors;
use crate::math::Doubles;
use crate::node::WIDTH;
use std::arch::wasm32::*;

/// Marker type for kernels that use the `simd128` instructions of WebAssembly. The type exists only
/// if the compilation target supports them.
#[derive(Clone, Copy)]
pub struct Simd128;

/// Eight `f32` values in two vectors of four.
#[derive(Clone, Copy)]
pub struct Pair(v128, v128);

/// Loads a vector from an array, starting at an index. The address does not have to be aligned.
macro_rules! load {
    ($from:expr, $at:expr) => {
        // SAFETY: callers pass an index from which at least sixteen bytes of the array remain.
        unsafe { v128_load($from.as_ptr().add($at).cast()) }
    };
}

/// Stores a vector into an array, starting at an index.
macro_rules! store {
    ($to:expr, $at:expr, $vector:expr) => {
        // SAFETY: see above.
        unsafe { v128_store($to.as_mut_ptr().add($at).cast(), $vector) }
    };
}

/// Two `f64` values in one 128-bit vector.
#[derive(Clone, Copy)]
pub struct TwoDoubles(v128);

impl Doubles for TwoDoubles {
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        TwoDoubles(f64x2_add(self.0, other.0))
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        TwoDoubles(f64x2_sub(self.0, other.0))
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        TwoDoubles(f64x2_mul(self.0, other.0))
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        TwoDoubles(f64x2_div(self.0, other.0))
    }
    // `pmin(x, y)` is `if y < x { y } else { x }`, and `pmax(x, y)` is `if x < y { y } else { x }`.
    // With swapped operands they do what the trait requires, also for NaN and zeros.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        TwoDoubles(f64x2_pmin(other.0, self.0))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        TwoDoubles(f64x2_pmax(other.0, self.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        TwoDoubles(f64x2_sqrt(self.0))
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        TwoDoubles(v128_bitselect(sign.0, self.0, u64x2_splat(1 << 63)))
    }
}

/// Implements operations on both halves with one instruction each.
macro_rules! operations {
    ($($name:ident($($x:ident),+) = $instruction:ident($($y:ident),+);)*) => {$(
        #[inline(always)]
        fn $name(self, $($x: Pair),+) -> Pair {
            Pair($instruction($($y.0),+), $instruction($($y.1),+))
        }
    )*};
}

/// Returns a mask of the sign bits of all lanes.
#[inline(always)]
fn bits(low: v128, high: v128) -> u32 {
    u32::from(i32x4_bitmask(low)) | u32::from(i32x4_bitmask(high)) << 4
}

impl FloatLanes for Simd128 {
    type Floats = Pair;

    operations! {
        add(a, b) = f32x4_add(a, b);
        sub(a, b) = f32x4_sub(a, b);
        mul(a, b) = f32x4_mul(a, b);
        div(a, b) = f32x4_div(a, b);
        abs(a) = f32x4_abs(a);
        // The operands are swapped as in `TwoDoubles`.
        min(a, b) = f32x4_pmin(b, a);
        max(a, b) = f32x4_pmax(b, a);
    }

    #[inline(always)]
    fn splat(self, x: f32) -> Pair {
        Pair(f32x4_splat(x), f32x4_splat(x))
    }
    #[inline(always)]
    fn mul_add(self, a: Pair, b: Pair, c: Pair) -> Pair {
        self.add(self.mul(a, b), c)
    }
    #[inline(always)]
    fn le(self, a: Pair, b: Pair) -> u32 {
        bits(f32x4_le(a.0, b.0), f32x4_le(a.1, b.1))
    }
    #[inline(always)]
    fn lt(self, a: Pair, b: Pair) -> u32 {
        bits(f32x4_lt(a.0, b.0), f32x4_lt(a.1, b.1))
    }
}

impl Lanes for Simd128 {
    type Wide = TwoVectors<Self>;
    type Doubles = ((TwoDoubles, TwoDoubles), (TwoDoubles, TwoDoubles));
    type Triple = [f64; 3];

    operations! {
        min_as_int(a, b) = i32x4_min(a, b);
        max_as_int(a, b) = i32x4_max(a, b);
        lt_as_int(a, b) = i32x4_lt(a, b);
    }

    #[inline(always)]
    fn wide(self) -> TwoVectors<Self> {
        TwoVectors(self)
    }
    #[inline(always)]
    fn join(self, [low, high]: [Pair; 2]) -> (Pair, Pair) {
        (low, high)
    }
    #[inline(always)]
    fn doubles(self, a: Pair) -> Self::Doubles {
        let two = |a| TwoDoubles(f64x2_promote_low_f32x4(a));
        let four = |a| (two(a), two(i64x2_shuffle::<1, 1>(a, a)));
        (four(a.0), four(a.1))
    }
    #[inline(always)]
    fn splat_double(self, x: f64) -> Self::Doubles {
        let two = TwoDoubles(f64x2_splat(x));
        ((two, two), (two, two))
    }
    #[inline(always)]
    fn load_doubles(self, from: &[f64; WIDTH]) -> Self::Doubles {
        let two = |at| TwoDoubles(load!(from, at));
        ((two(0), two(2)), (two(4), two(6)))
    }
    #[inline(always)]
    fn store_doubles(self, ((a, b), (c, d)): Self::Doubles) -> [f64; WIDTH] {
        let mut to = [0.0; WIDTH];
        for (i, two) in [a, b, c, d].into_iter().enumerate() {
            store!(to, 2 * i, two.0);
        }
        to
    }
    #[inline(always)]
    fn le_doubles(self, (low, high): Self::Doubles, (low_b, high_b): Self::Doubles) -> u32 {
        let two = |a: TwoDoubles, b: TwoDoubles| u32::from(i64x2_bitmask(f64x2_le(a.0, b.0)));
        let four = |a: (_, _), b: (_, _)| two(a.0, b.0) | two(a.1, b.1) << 2;
        four(low, low_b) | four(high, high_b) << 4
    }
    #[inline(always)]
    fn singles(self, (low, high): Self::Doubles) -> Pair {
        let two = |a: TwoDoubles| f32x4_demote_f64x2_zero(a.0);
        let four = |(a, b)| i64x2_shuffle::<0, 2>(two(a), two(b));
        Pair(four(low), four(high))
    }
    #[inline(always)]
    fn triple(self, v: glam::Vec3A) -> [f64; 3] {
        v.as_dvec3().to_array()
    }
    #[inline(always)]
    fn permute(self, v: glam::Vec3A, order: &[u32; 4]) -> glam::Vec3A {
        // Byte indices of each component: 4k, 4k + 1, 4k + 2, 4k + 3.
        let first = i32x4_mul(load!(order, 0), u32x4_splat(0x0404_0404));
        u8x16_swizzle(v.into(), i32x4_add(first, u32x4_splat(0x0302_0100))).into()
    }
    #[inline(always)]
    fn load(self, from: &[f32; WIDTH]) -> Pair {
        Pair(load!(from, 0), load!(from, 4))
    }
    #[inline(always)]
    fn corners(self, from: &Rows, CornerColumns { starts, corner }: CornerColumns) -> [[Pair; 3]; 3] {
        // `CornerColumns::new` ensures that each row begins in one of the first nine rows, so eight
        // numbers follow.
        std::array::from_fn(|k| {
            starts.map(|start| Pair(load!(from, k * corner + start), load!(from, k * corner + start + 4)))
        })
    }
    #[inline(always)]
    fn store(self, a: Pair) -> [f32; WIDTH] {
        let mut to = [0.0; WIDTH];
        store!(to, 0, a.0);
        store!(to, 4, a.1);
        to
    }
    #[inline(always)]
    fn signs(self, a: Pair) -> u32 {
        bits(a.0, a.1)
    }
    #[inline(always)]
    fn nearest(self, a: Pair, which: Pair, child_tags: &[u8; WIDTH]) -> u32 {
        let key = |a, which, tags| {
            let key = v128_or(v128_andnot(a, u32x4_splat(255)), tags);
            v128_or(key, v128_not(which))
        };
        let tags = u16x8_load_extend(child_tags);
        let low = key(a.0, which.0, u32x4_extend_low_u16x8(tags));
        let four = u32x4_min(low, key(a.1, which.1, u32x4_extend_high_u16x8(tags)));
        let two = u32x4_min(four, i32x4_shuffle::<2, 3, 0, 1>(four, four));
        u32x4_extract_lane::<0>(u32x4_min(two, i32x4_shuffle::<1, 0, 3, 2>(two, two)))
    }
    #[inline(always)]
    fn select(self, mask: u32, a: Pair, b: Pair) -> Pair {
        let mask = u32x4_splat(mask);
        let lanes = |weights| u32x4_eq(v128_and(mask, weights), weights);
        let (low, high) = (lanes(u32x4(1, 2, 4, 8)), lanes(u32x4(16, 32, 64, 128)));
        Pair(v128_bitselect(a.0, b.0, low), v128_bitselect(a.1, b.1, high))
    }
    #[inline(always)]
    fn transpose(self, [a, b, c, d, e, f, g, h]: [Pair; WIDTH]) -> [Pair; WIDTH] {
        // Transpose four blocks of four by four values, and swap two of the blocks.
        let ([a0, b0, c0, d0], [e0, f0, g0, h0]) = (block([a.0, b.0, c.0, d.0]), block([a.1, b.1, c.1, d.1]));
        let ([a1, b1, c1, d1], [e1, f1, g1, h1]) = (block([e.0, f.0, g.0, h.0]), block([e.1, f.1, g.1, h.1]));
        [Pair(a0, a1), Pair(b0, b1), Pair(c0, c1), Pair(d0, d1), Pair(e0, e1), Pair(f0, f1), Pair(g0, g1), Pair(h0, h1)]
    }
    #[inline(always)]
    fn push(self, stack: &mut Stack, children: &[u32; WIDTH], near: Pair, order: &[u8; WIDTH], count: u32) {
        let (near, count) = (self.store(near), count.min(WIDTH as u32));
        let (to, to_near) = stack.top();
        for (i, &lane) in order.iter().enumerate().take(count as usize) {
            let lane = usize::from(lane) % WIDTH;
            // SAFETY: `top` has space for a vector.
            unsafe {
                to.add(i).write(children[lane]);
                to_near.add(i).write(near[lane]);
            }
        }
        // SAFETY: `count` entries have been written.
        unsafe { stack.grow(count) };
    }
    #[inline(always)]
    fn prefetch<T>(self, _: *const T) {}
}

/// Extends eight bytes to sixteen bits each.
#[inline(always)]
fn u16x8_load_extend(from: &[u8; WIDTH]) -> v128 {
    // SAFETY: the reference is valid for eight bytes, and the instruction does not require
    // alignment.
    unsafe { u16x8_load_extend_u8x8(from.as_ptr()) }
}

/// Transposes four vectors of four lanes.
#[inline(always)]
fn block([a, b, c, d]: [v128; 4]) -> [v128; 4] {
    let (ab, cd) = (i32x4_shuffle::<0, 4, 1, 5>(a, b), i32x4_shuffle::<0, 4, 1, 5>(c, d));
    let (ab_high, cd_high) = (i32x4_shuffle::<2, 6, 3, 7>(a, b), i32x4_shuffle::<2, 6, 3, 7>(c, d));
    [
        i64x2_shuffle::<0, 2>(ab, cd),
        i64x2_shuffle::<1, 3>(ab, cd),
        i64x2_shuffle::<0, 2>(ab_high, cd_high),
        i64x2_shuffle::<1, 3>(ab_high, cd_high),
    ]
}
