//! SIMD operations with NEON, which handle eight lanes as two vectors of four.

use super::operations::{FloatLanes, Lanes};
use super::stack::Stack;
use super::wide::TwoVectors;
use crate::math::Doubles;
use crate::node::WIDTH;
use std::arch::aarch64::*;

/// The SIMD level for NEON, which every 64-bit ARM processor supports.
#[derive(Clone, Copy)]
pub struct Neon;

/// Eight `f32` values in two NEON vectors of four.
#[derive(Clone, Copy)]
pub struct Pair(float32x4_t, float32x4_t);

/// Wraps unsafe instructions that share the same safety argument.
macro_rules! proven {
    ($($code:tt)*) => {
        // SAFETY: NEON is part of the target, and references are valid.
        unsafe { $($code)* }
    };
}

/// Two `f64` values in one NEON vector.
#[derive(Clone, Copy)]
pub struct TwoDoubles(float64x2_t);

impl Doubles for TwoDoubles {
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        proven!(TwoDoubles(vaddq_f64(self.0, other.0)))
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        proven!(TwoDoubles(vsubq_f64(self.0, other.0)))
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        proven!(TwoDoubles(vmulq_f64(self.0, other.0)))
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        proven!(TwoDoubles(vdivq_f64(self.0, other.0)))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        proven!(TwoDoubles(vbslq_f64(vcltq_f64(self.0, other.0), self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        proven!(TwoDoubles(vbslq_f64(vcgtq_f64(self.0, other.0), self.0, other.0)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        proven!(TwoDoubles(vsqrtq_f64(self.0)))
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        proven!(TwoDoubles(vbslq_f64(vdupq_n_u64(1 << 63), sign.0, self.0)))
    }
}

#[inline(always)]
unsafe fn bits(a: uint32x4_t, b: uint32x4_t) -> u32 {
    const WEIGHTS: [u32; 4] = [1, 2, 4, 8];
    // SAFETY: the caller guarantees this.
    proven! {
        let weights = vld1q_u32(WEIGHTS.as_ptr());
        vaddvq_u32(vandq_u32(a, weights)) | vaddvq_u32(vandq_u32(b, weights)) << 4
    }
}

impl FloatLanes for Neon {
    type Floats = Pair;

    #[inline(always)]
    fn splat(self, x: f32) -> Pair {
        proven!(Pair(vdupq_n_f32(x), vdupq_n_f32(x)))
    }
    #[inline(always)]
    fn add(self, a: Pair, b: Pair) -> Pair {
        proven!(Pair(vaddq_f32(a.0, b.0), vaddq_f32(a.1, b.1)))
    }
    #[inline(always)]
    fn sub(self, a: Pair, b: Pair) -> Pair {
        proven!(Pair(vsubq_f32(a.0, b.0), vsubq_f32(a.1, b.1)))
    }
    #[inline(always)]
    fn mul(self, a: Pair, b: Pair) -> Pair {
        proven!(Pair(vmulq_f32(a.0, b.0), vmulq_f32(a.1, b.1)))
    }
    #[inline(always)]
    fn div(self, a: Pair, b: Pair) -> Pair {
        proven!(Pair(vdivq_f32(a.0, b.0), vdivq_f32(a.1, b.1)))
    }
    #[inline(always)]
    fn abs(self, a: Pair) -> Pair {
        proven!(Pair(vabsq_f32(a.0), vabsq_f32(a.1)))
    }
    #[inline(always)]
    fn mul_add(self, a: Pair, b: Pair, c: Pair) -> Pair {
        proven!(Pair(vfmaq_f32(c.0, a.0, b.0), vfmaq_f32(c.1, a.1, b.1)))
    }
    #[inline(always)]
    fn min(self, a: Pair, b: Pair) -> Pair {
        proven!(Pair(vbslq_f32(vcltq_f32(a.0, b.0), a.0, b.0), vbslq_f32(vcltq_f32(a.1, b.1), a.1, b.1)))
    }
    #[inline(always)]
    fn max(self, a: Pair, b: Pair) -> Pair {
        proven!(Pair(vbslq_f32(vcgtq_f32(a.0, b.0), a.0, b.0), vbslq_f32(vcgtq_f32(a.1, b.1), a.1, b.1)))
    }
    #[inline(always)]
    fn le(self, a: Pair, b: Pair) -> u32 {
        proven!(bits(vcleq_f32(a.0, b.0), vcleq_f32(a.1, b.1)))
    }
    #[inline(always)]
    fn lt(self, a: Pair, b: Pair) -> u32 {
        proven!(bits(vcltq_f32(a.0, b.0), vcltq_f32(a.1, b.1)))
    }
}

impl Lanes for Neon {
    type Wide = TwoVectors<Self>;
    type Doubles = ((TwoDoubles, TwoDoubles), (TwoDoubles, TwoDoubles));
    type Triple = [f64; 3];

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
        proven! {
            let four = |a| (TwoDoubles(vcvt_f64_f32(vget_low_f32(a))), TwoDoubles(vcvt_high_f64_f32(a)));
            (four(a.0), four(a.1))
        }
    }
    #[inline(always)]
    fn splat_double(self, x: f64) -> Self::Doubles {
        let two = proven!(TwoDoubles(vdupq_n_f64(x)));
        ((two, two), (two, two))
    }
    #[inline(always)]
    fn load_doubles(self, from: &[f64; WIDTH]) -> Self::Doubles {
        proven! {
            let two = |at| TwoDoubles(vld1q_f64(from.as_ptr().add(at)));
            ((two(0), two(2)), (two(4), two(6)))
        }
    }
    #[inline(always)]
    fn store_doubles(self, ((a, b), (c, d)): Self::Doubles) -> [f64; WIDTH] {
        let mut to = [0.0; WIDTH];
        for (i, two) in [a, b, c, d].into_iter().enumerate() {
            proven!(vst1q_f64(to.as_mut_ptr().add(2 * i), two.0));
        }
        to
    }
    #[inline(always)]
    fn le_doubles(self, a: Self::Doubles, b: Self::Doubles) -> u32 {
        proven! {
            let two = |a: TwoDoubles, b: TwoDoubles| vmovn_u64(vcleq_f64(a.0, b.0));
            let four = |(a, b): (TwoDoubles, TwoDoubles), (c, d): (TwoDoubles, TwoDoubles)| {
                vcombine_u32(two(a, c), two(b, d))
            };
            bits(four(a.0, b.0), four(a.1, b.1))
        }
    }
    #[inline(always)]
    fn singles(self, (low, high): Self::Doubles) -> Pair {
        proven! {
            let four = |(a, b): (TwoDoubles, TwoDoubles)| vcvt_high_f32_f64(vcvt_f32_f64(a.0), b.0);
            Pair(four(low), four(high))
        }
    }
    #[inline(always)]
    fn triple(self, v: glam::Vec3A) -> [f64; 3] {
        v.as_dvec3().to_array()
    }
    #[inline(always)]
    fn permute(self, v: glam::Vec3A, order: &[u32; 4]) -> glam::Vec3A {
        super::scalar::Scalar.permute(v, order)
    }
    #[inline(always)]
    fn load(self, from: &[f32; WIDTH]) -> Pair {
        proven!(Pair(vld1q_f32(from.as_ptr()), vld1q_f32(from.as_ptr().add(4))))
    }
    #[inline(always)]
    fn corners(
        self,
        from: &super::operations::Rows,
        super::operations::CornerColumns { starts, corner }: super::operations::CornerColumns,
    ) -> [[Pair; 3]; 3] {
        std::array::from_fn(|k| {
            starts.map(|start| match from[k * corner + start..].first_chunk() {
                Some(row) => self.load(row),
                None => unreachable!("rows are padded to a vector"),
            })
        })
    }
    #[inline(always)]
    fn store(self, a: Pair) -> [f32; WIDTH] {
        let mut to = [0.0; WIDTH];
        proven! {
            vst1q_f32(to.as_mut_ptr(), a.0);
            vst1q_f32(to.as_mut_ptr().add(4), a.1);
        }
        to
    }
    #[inline(always)]
    fn min_as_int(self, a: Pair, b: Pair) -> Pair {
        proven! {
            let min = |a, b| vreinterpretq_f32_s32(vminq_s32(vreinterpretq_s32_f32(a), vreinterpretq_s32_f32(b)));
            Pair(min(a.0, b.0), min(a.1, b.1))
        }
    }
    #[inline(always)]
    fn max_as_int(self, a: Pair, b: Pair) -> Pair {
        proven! {
            let max = |a, b| vreinterpretq_f32_s32(vmaxq_s32(vreinterpretq_s32_f32(a), vreinterpretq_s32_f32(b)));
            Pair(max(a.0, b.0), max(a.1, b.1))
        }
    }
    #[inline(always)]
    fn lt_as_int(self, a: Pair, b: Pair) -> Pair {
        proven! {
            let before =
                |a, b| vreinterpretq_f32_u32(vcltq_s32(vreinterpretq_s32_f32(a), vreinterpretq_s32_f32(b)));
            Pair(before(a.0, b.0), before(a.1, b.1))
        }
    }
    #[inline(always)]
    fn signs(self, a: Pair) -> u32 {
        proven!(bits(vcltzq_s32(vreinterpretq_s32_f32(a.0)), vcltzq_s32(vreinterpretq_s32_f32(a.1))))
    }
    #[inline(always)]
    fn nearest(self, a: Pair, which: Pair, child_tags: &[u8; WIDTH]) -> u32 {
        proven! {
            let key = |a, which, child_tags| {
                let key = vorrq_u32(vbicq_u32(vreinterpretq_u32_f32(a), vdupq_n_u32(255)), child_tags);
                vornq_u32(key, vreinterpretq_u32_f32(which))
            };
            let child_tags = vmovl_u8(vld1_u8(child_tags.as_ptr()));
            let low = key(a.0, which.0, vmovl_u16(vget_low_u16(child_tags)));
            vminvq_u32(vminq_u32(low, key(a.1, which.1, vmovl_high_u16(child_tags))))
        }
    }
    #[inline(always)]
    fn select(self, mask: u32, a: Pair, b: Pair) -> Pair {
        const WEIGHTS: [u32; WIDTH] = [1, 2, 4, 8, 16, 32, 64, 128];
        proven! {
            let mask = vdupq_n_u32(mask);
            let low = vtstq_u32(mask, vld1q_u32(WEIGHTS.as_ptr()));
            let high = vtstq_u32(mask, vld1q_u32(WEIGHTS.as_ptr().add(4)));
            Pair(vbslq_f32(low, a.0, b.0), vbslq_f32(high, a.1, b.1))
        }
    }
    #[inline(always)]
    fn transpose(self, rows: [Pair; WIDTH]) -> [Pair; WIDTH] {
        let rows = rows.map(|row| self.store(row));
        super::scalar::Scalar.transpose(rows).map(|row| self.load(&row))
    }
    #[inline(always)]
    fn push(self, stack: &mut Stack, children: &[u32; WIDTH], near: Pair, order: &[u8; WIDTH], count: u32) {
        let near = self.store(near);
        for &lane in order.iter().take(count as usize) {
            let lane = usize::from(lane) % WIDTH;
            stack.push(children[lane], near[lane]);
        }
    }
    #[inline(always)]
    fn prefetch<T>(self, _: *const T) {}
}
