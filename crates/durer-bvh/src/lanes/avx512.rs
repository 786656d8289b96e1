//! SIMD operations with AVX-512, both for eight lanes with mask registers and for sixteen lanes.

use super::avx2::{FourDoubles, arithmetic_of_eight, doubles, operations, order_of_eight, proven};
use super::operations::{FloatLanes, Kernel, Lanes, WIDE, WideLanes};
use super::stack::Stack;
use crate::node::WIDTH;
use std::arch::x86_64::*;

/// The SIMD level for AVX-512. A value of this type proves that the processor supports AVX-512 F,
/// VL, and DQ, in addition to the features of the AVX2 level.
#[derive(Clone, Copy)]
pub struct Avx512(());

pub fn is_available() -> bool {
    super::avx2::is_available()
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("avx512dq")
}

/// # Safety
///
/// [`is_available`] must have returned true.
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
pub unsafe fn run<K: Kernel>(kernel: K) -> K::Output {
    kernel.run(Avx512(()))
}

impl FloatLanes for Avx512 {
    type Floats = __m256;

    arithmetic_of_eight!();
    #[inline(always)]
    fn le(self, a: __m256, b: __m256) -> u32 {
        proven!(u32::from(_mm256_cmp_ps_mask::<_CMP_LE_OQ>(a, b)))
    }
    #[inline(always)]
    fn lt(self, a: __m256, b: __m256) -> u32 {
        proven!(u32::from(_mm256_cmp_ps_mask::<_CMP_LT_OQ>(a, b)))
    }
}

impl Lanes for Avx512 {
    type Wide = SixteenFloats;
    type Doubles = EightDoubles;
    type Triple = FourDoubles;

    order_of_eight!();

    #[inline(always)]
    fn wide(self) -> SixteenFloats {
        SixteenFloats(())
    }
    #[inline(always)]
    fn join(self, [low, high]: [__m256; 2]) -> __m512 {
        proven!(_mm512_insertf32x8::<1>(_mm512_castps256_ps512(low), high))
    }
    #[inline(always)]
    fn doubles(self, a: __m256) -> EightDoubles {
        proven!(EightDoubles(_mm512_cvtps_pd(a)))
    }
    #[inline(always)]
    fn splat_double(self, x: f64) -> EightDoubles {
        proven!(EightDoubles(_mm512_set1_pd(x)))
    }
    #[inline(always)]
    fn load_doubles(self, from: &[f64; WIDTH]) -> EightDoubles {
        proven!(EightDoubles(_mm512_loadu_pd(from.as_ptr())))
    }
    #[inline(always)]
    fn store_doubles(self, a: EightDoubles) -> [f64; WIDTH] {
        let mut to = [0.0; WIDTH];
        proven!(_mm512_storeu_pd(to.as_mut_ptr(), a.0));
        to
    }
    #[inline(always)]
    fn le_doubles(self, a: EightDoubles, b: EightDoubles) -> u32 {
        proven!(u32::from(_mm512_cmp_pd_mask::<_CMP_LE_OQ>(a.0, b.0)))
    }
    #[inline(always)]
    fn singles(self, a: EightDoubles) -> __m256 {
        proven!(_mm512_cvtpd_ps(a.0))
    }
    #[inline(always)]
    fn select(self, mask: u32, a: __m256, b: __m256) -> __m256 {
        proven!(_mm256_mask_mov_ps(b, mask as u8, a))
    }
}

/// Eight `f64` values in an AVX-512 register. A value of this type also proves that the processor
/// supports AVX-512.
#[derive(Clone, Copy)]
pub struct EightDoubles(__m512d);

doubles! { EightDoubles:
    add = _mm512_add_pd;
    sub = _mm512_sub_pd;
    mul = _mm512_mul_pd;
    div = _mm512_div_pd;
    min = _mm512_min_pd;
    max = _mm512_max_pd;
    [sqrt = _mm512_sqrt_pd; copysign = _mm512_set1_pd, _mm512_and_pd, _mm512_andnot_pd, _mm512_or_pd]
}

/// The SIMD level for AVX-512 on vectors of sixteen `f32`. A value of this type proves that the
/// processor supports AVX-512.
#[derive(Clone, Copy)]
pub struct SixteenFloats(());

impl FloatLanes for SixteenFloats {
    type Floats = __m512;

    operations! { __m512:
        add(a, b) = _mm512_add_ps;
        sub(a, b) = _mm512_sub_ps;
        mul(a, b) = _mm512_mul_ps;
        div(a, b) = _mm512_div_ps;
        min(a, b) = _mm512_min_ps;
        max(a, b) = _mm512_max_ps;
        abs(a) = _mm512_abs_ps;
        mul_add(a, b, c) = _mm512_fmadd_ps;
    }
    #[inline(always)]
    fn splat(self, x: f32) -> __m512 {
        proven!(_mm512_set1_ps(x))
    }
    #[inline(always)]
    fn le(self, a: __m512, b: __m512) -> u32 {
        proven!(u32::from(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b)))
    }
    #[inline(always)]
    fn lt(self, a: __m512, b: __m512) -> u32 {
        proven!(u32::from(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b)))
    }
}

impl WideLanes for SixteenFloats {
    #[inline(always)]
    fn load(self, from: &[f32; WIDE]) -> __m512 {
        proven!(_mm512_loadu_ps(from.as_ptr()))
    }
    #[inline(always)]
    fn store(self, a: __m512) -> [f32; WIDE] {
        let mut to = [0.0; WIDE];
        proven!(_mm512_storeu_ps(to.as_mut_ptr(), a));
        to
    }
    #[inline(always)]
    fn select(self, mask: u32, a: __m512, b: __m512) -> __m512 {
        proven!(_mm512_mask_mov_ps(b, mask as u16, a))
    }
    #[inline(always)]
    fn least(self, a: __m512) -> f32 {
        proven!(_mm512_reduce_min_ps(a))
    }
    #[inline(always)]
    fn greatest(self, a: __m512) -> f32 {
        proven!(_mm512_reduce_max_ps(a))
    }
}
