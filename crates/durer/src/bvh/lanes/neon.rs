//! NEON: eight lanes as two vectors of four.

use super::{Lanes, Stack, WIDTH};
use std::arch::aarch64::*;

/// Every 64-bit ARM has NEON.
#[derive(Clone, Copy)]
pub struct Neon;

/// Two vectors.
#[derive(Clone, Copy)]
pub struct Pair(float32x4_t, float32x4_t);

/// Eight `f64` as four vectors.
type Wide = [float64x2_t; 4];

/// What an operation's safety rests on, said once.
macro_rules! proven {
    ($($code:tt)*) => {
        // SAFETY: NEON belongs to the target; references are valid.
        unsafe { $($code)* }
    };
}

#[inline(always)]
unsafe fn bits(a: uint32x4_t, b: uint32x4_t) -> u32 {
    const WEIGHTS: [u32; 4] = [1, 2, 4, 8];
    // SAFETY: as the caller's.
    proven! {
        let weights = vld1q_u32(WEIGHTS.as_ptr());
        vaddvq_u32(vandq_u32(a, weights)) | vaddvq_u32(vandq_u32(b, weights)) << 4
    }
}

impl Lanes for Neon {
    type Floats = Pair;
    type Doubles = Wide;
    type Order = u32;

    #[inline(always)]
    fn splat(self, x: f32) -> Pair {
        proven!(Pair(vdupq_n_f32(x), vdupq_n_f32(x)))
    }
    #[inline(always)]
    fn load(self, from: &[f32; WIDTH]) -> Pair {
        proven!(Pair(vld1q_f32(from.as_ptr()), vld1q_f32(from.as_ptr().add(4))))
    }
    #[inline(always)]
    fn rows(self, from: &[f32], stride: usize, axes: [usize; 3]) -> [[Pair; 3]; 3] {
        std::array::from_fn(|corner| {
            std::array::from_fn(|k| {
                let row = (3 * corner + axes[k]) * stride;
                match from[row..].first_chunk() {
                    Some(row) => self.load(row),
                    None => unreachable!("rows are padded to a vector"),
                }
            })
        })
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
    fn mul_add(self, a: Pair, b: Pair, c: Pair) -> Pair {
        proven!(Pair(vfmaq_f32(c.0, a.0, b.0), vfmaq_f32(c.1, a.1, b.1)))
    }
    #[inline(always)]
    fn min(self, a: Pair, b: Pair) -> Pair {
        proven!(Pair(vminnmq_f32(a.0, b.0), vminnmq_f32(a.1, b.1)))
    }
    #[inline(always)]
    fn max(self, a: Pair, b: Pair) -> Pair {
        proven!(Pair(vmaxnmq_f32(a.0, b.0), vmaxnmq_f32(a.1, b.1)))
    }
    #[inline(always)]
    fn le(self, a: Pair, b: Pair) -> u32 {
        proven!(bits(vcleq_f32(a.0, b.0), vcleq_f32(a.1, b.1)))
    }
    #[inline(always)]
    fn lt(self, a: Pair, b: Pair) -> u32 {
        proven!(bits(vcltq_f32(a.0, b.0), vcltq_f32(a.1, b.1)))
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
    fn splat_wide(self, x: f64) -> Wide {
        proven!([vdupq_n_f64(x); 4])
    }
    #[inline(always)]
    fn widen(self, a: Pair) -> Wide {
        proven!([
            vcvt_f64_f32(vget_low_f32(a.0)),
            vcvt_high_f64_f32(a.0),
            vcvt_f64_f32(vget_low_f32(a.1)),
            vcvt_high_f64_f32(a.1),
        ])
    }
    #[inline(always)]
    fn narrow(self, a: Wide) -> Pair {
        proven!(Pair(vcvt_high_f32_f64(vcvt_f32_f64(a[0]), a[1]), vcvt_high_f32_f64(vcvt_f32_f64(a[2]), a[3])))
    }
    #[inline(always)]
    fn add_wide(self, a: Wide, b: Wide) -> Wide {
        proven!([vaddq_f64(a[0], b[0]), vaddq_f64(a[1], b[1]), vaddq_f64(a[2], b[2]), vaddq_f64(a[3], b[3])])
    }
    #[inline(always)]
    fn sub_wide(self, a: Wide, b: Wide) -> Wide {
        proven!([vsubq_f64(a[0], b[0]), vsubq_f64(a[1], b[1]), vsubq_f64(a[2], b[2]), vsubq_f64(a[3], b[3])])
    }
    #[inline(always)]
    fn mul_wide(self, a: Wide, b: Wide) -> Wide {
        proven!([vmulq_f64(a[0], b[0]), vmulq_f64(a[1], b[1]), vmulq_f64(a[2], b[2]), vmulq_f64(a[3], b[3])])
    }
    #[inline(always)]
    fn div_wide(self, a: Wide, b: Wide) -> Wide {
        proven!([vdivq_f64(a[0], b[0]), vdivq_f64(a[1], b[1]), vdivq_f64(a[2], b[2]), vdivq_f64(a[3], b[3])])
    }
    #[inline(always)]
    fn min_wide(self, a: Wide, b: Wide) -> Wide {
        proven!([vminq_f64(a[0], b[0]), vminq_f64(a[1], b[1]), vminq_f64(a[2], b[2]), vminq_f64(a[3], b[3])])
    }
    #[inline(always)]
    fn max_wide(self, a: Wide, b: Wide) -> Wide {
        proven!([vmaxq_f64(a[0], b[0]), vmaxq_f64(a[1], b[1]), vmaxq_f64(a[2], b[2]), vmaxq_f64(a[3], b[3])])
    }
    #[inline(always)]
    fn lt_wide(self, a: Wide, b: Wide) -> u32 {
        let mut bits = 0;
        for i in 0..4 {
            // SAFETY: NEON belongs to the target.
            let less = unsafe { vcltq_f64(a[i], b[i]) };
            // SAFETY: as above.
            let (low, high) = unsafe { (vgetq_lane_u64::<0>(less), vgetq_lane_u64::<1>(less)) };
            bits |= ((low & 1 | high & 2) as u32) << (2 * i);
        }
        bits
    }
    #[inline(always)]
    fn where_equal(self, a: Wide, b: Wide, x: Wide, y: Wide) -> Wide {
        proven!([
            vbslq_f64(vceqq_f64(a[0], b[0]), x[0], y[0]),
            vbslq_f64(vceqq_f64(a[1], b[1]), x[1], y[1]),
            vbslq_f64(vceqq_f64(a[2], b[2]), x[2], y[2]),
            vbslq_f64(vceqq_f64(a[3], b[3]), x[3], y[3])
        ])
    }
    #[inline(always)]
    fn flipped(self, flip: u32) -> u32 {
        flip & 7
    }
    #[inline(always)]
    fn push(self, stack: &mut Stack, children: &[u32; WIDTH], near: Pair, flip: u32, mut mask: u32) {
        let distances = self.store(near);
        while mask != 0 {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            stack.push(children[(lane ^ flip) as usize % WIDTH], distances[(lane ^ flip) as usize % WIDTH]);
        }
    }
    #[inline(always)]
    fn prefetch<T>(self, _: &[T], _: usize) {}
    #[inline(always)]
    fn drop_beyond(self, stack: &mut Stack, t_max: f32) {
        stack.retain(|near| near <= t_max);
    }
}
