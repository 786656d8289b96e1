//! SIMD operations with AVX2 and FMA.

use super::operations::{FloatLanes, Kernel, Lanes};
use super::stack::Stack;
use super::wide::TwoVectors;
use crate::math::Triple;
use crate::node::WIDTH;
use std::arch::asm;
use std::arch::x86_64::*;

/// The SIMD level for AVX2. A value of this type proves that the processor supports AVX2, FMA, BMI
/// 1 and 2, LZCNT, and POPCNT.
#[derive(Clone, Copy)]
pub struct Avx2(());

pub fn is_available() -> bool {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("fma")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("popcnt")
}

/// # Safety
///
/// [`is_available`] must have returned true.
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
pub unsafe fn run<K: Kernel>(kernel: K) -> K::Output {
    kernel.run(Avx2(()))
}

/// Wraps unsafe instructions that share the same safety argument.
macro_rules! proven {
    ($($code:tt)*) => {
        // SAFETY: a value of the type proves that the processor supports the instructions, and
        // references are valid.
        unsafe { $($code)* }
    };
}
pub(super) use proven;

/// Implements operations that each compile to one instruction.
macro_rules! operations {
    ($floats:ty: $($name:ident($($x:ident),+) = $instruction:ident;)*) => {$(
        #[inline(always)]
        fn $name(self, $($x: $floats),+) -> $floats {
            proven!($instruction($($x),+))
        }
    )*};
}
pub(super) use operations;

/// Implements [`FloatLanes`] for eight lanes, except comparisons.
macro_rules! arithmetic_of_eight {
    () => {
        $crate::lanes::avx2::operations! { __m256:
            add(a, b) = _mm256_add_ps;
            sub(a, b) = _mm256_sub_ps;
            mul(a, b) = _mm256_mul_ps;
            div(a, b) = _mm256_div_ps;
            min(a, b) = _mm256_min_ps;
            max(a, b) = _mm256_max_ps;
            mul_add(a, b, c) = _mm256_fmadd_ps;
        }
        #[inline(always)]
        fn splat(self, x: f32) -> __m256 {
            proven!(_mm256_set1_ps(x))
        }
        #[inline(always)]
        fn abs(self, a: __m256) -> __m256 {
            proven!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), a))
        }
    };
}
pub(super) use arithmetic_of_eight;

/// Implements [`Lanes`] for eight lanes, except operations that use masks.
macro_rules! order_of_eight {
    () => {
        #[inline(always)]
        fn load(self, from: &[f32; WIDTH]) -> __m256 {
            proven!(_mm256_loadu_ps(from.as_ptr()))
        }
        #[inline(always)]
        fn triple(self, v: glam::Vec3A) -> $crate::lanes::avx2::FourDoubles {
            $crate::lanes::avx2::triple(v)
        }
        #[inline(always)]
        fn permute(self, v: glam::Vec3A, order: &[u32; 4]) -> glam::Vec3A {
            proven!(_mm_permutevar_ps(v.into(), _mm_loadu_si128(order.as_ptr().cast())).into())
        }
        #[inline(always)]
        fn store(self, a: __m256) -> [f32; WIDTH] {
            let mut to = [0.0; WIDTH];
            proven!(_mm256_storeu_ps(to.as_mut_ptr(), a));
            to
        }
        #[inline(always)]
        fn corners(self, from: &$crate::lanes::Rows, columns: $crate::lanes::CornerColumns) -> [[__m256; 3]; 3] {
            $crate::lanes::avx2::corners(from, columns)
        }
        #[inline(always)]
        fn transpose(self, rows: [__m256; WIDTH]) -> [__m256; WIDTH] {
            $crate::lanes::avx2::transpose(rows)
        }
        #[inline(always)]
        fn min_as_int(self, a: __m256, b: __m256) -> __m256 {
            proven!(_mm256_castsi256_ps(_mm256_min_epi32(_mm256_castps_si256(a), _mm256_castps_si256(b))))
        }
        #[inline(always)]
        fn max_as_int(self, a: __m256, b: __m256) -> __m256 {
            proven!(_mm256_castsi256_ps(_mm256_max_epi32(_mm256_castps_si256(a), _mm256_castps_si256(b))))
        }
        #[inline(always)]
        fn lt_as_int(self, a: __m256, b: __m256) -> __m256 {
            proven!($crate::lanes::avx2::is_greater(b, a))
        }
        #[inline(always)]
        fn signs(self, a: __m256) -> u32 {
            proven!(_mm256_movemask_ps(a) as u32)
        }
        #[inline(always)]
        fn interval(self, [x, y, z]: [[__m256; 2]; 3], within: [__m256; 2]) -> [__m256; 2] {
            use $crate::lanes::avx2::{greater, lesser};
            let enter = self.max_as_int(y[0], self.max_as_int(x[0], within[0]));
            let leave = self.min_as_int(y[1], self.min_as_int(x[1], within[1]));
            proven!([greater(z[0], enter), lesser(z[1], leave)])
        }
        #[inline(always)]
        fn nearest(self, a: __m256, which: __m256, child_tags: &[u8; WIDTH]) -> u32 {
            proven! {
                let (a, which) = (_mm256_castps_si256(a), _mm256_castps_si256(which));
                let child_tags = _mm256_cvtepu8_epi32(_mm_loadl_epi64(child_tags.as_ptr().cast()));
                let key = _mm256_or_si256(_mm256_and_si256(a, _mm256_set1_epi32(!255)), child_tags);
                $crate::lanes::avx2::least(_mm256_or_si256(key, _mm256_xor_si256(which, _mm256_set1_epi32(-1))))
            }
        }
        #[inline(always)]
        fn push(self, stack: &mut Stack, children: &[u32; WIDTH], near: __m256, order: &[u8; WIDTH], count: u32) {
            let (to, to_near) = stack.top();
            proven! {
                let order = _mm256_cvtepu8_epi32(_mm_loadl_epi64(order.as_ptr().cast()));
                let children = _mm256_loadu_si256(children.as_ptr().cast());
                _mm256_storeu_si256(to.cast(), _mm256_permutevar8x32_epi32(children, order));
                _mm256_storeu_ps(to_near, _mm256_permutevar8x32_ps(near, order));
                stack.grow(count.min(WIDTH as u32));
            }
        }
        #[inline(always)]
        fn prefetch<T>(self, at: *const T) {
            // SAFETY: the instruction accepts any address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(at.cast()) };
        }
    };
}
pub(super) use order_of_eight;

/// Loads the nine rows of a leaf's corners.
#[inline(always)]
pub(super) fn corners(
    from: &super::operations::Rows,
    super::operations::CornerColumns { starts, corner }: super::operations::CornerColumns,
) -> [[__m256; 3]; 3] {
    macro_rules! row {
        ($corner:literal, $k:literal) => {
            // SAFETY: `CornerColumns::new` ensures that the vector begins in one of the first nine
            // rows. The caller must prove that the processor supports the instructions.
            unsafe { _mm256_loadu_ps(from.as_ptr().add(starts[$k]).add($corner * corner)) }
        };
    }
    [[row!(0, 0), row!(0, 1), row!(0, 2)], [row!(1, 0), row!(1, 1), row!(1, 2)], [row!(2, 0), row!(2, 1), row!(2, 2)]]
}

/// Returns the minimum of eight unsigned integers.
#[inline(always)]
pub(super) fn least(a: __m256i) -> u32 {
    proven! {
        let four = _mm_min_epu32(_mm256_castsi256_si128(a), _mm256_extracti128_si256::<1>(a));
        let two = _mm_min_epu32(four, _mm_shuffle_epi32::<0b01_00_11_10>(four));
        _mm_cvtsi128_si32(_mm_min_epu32(two, _mm_shuffle_epi32::<0b10_11_00_01>(two))) as u32
    }
}

/// Wraps an instruction as inline assembly, so that the compiler neither replaces nor reorders it.
macro_rules! literally {
    ($name:ident = $instruction:literal) => {
        /// # Safety
        ///
        /// The processor must have AVX2.
        #[inline]
        #[target_feature(enable = "avx2")]
        pub(super) unsafe fn $name(a: __m256, b: __m256) -> __m256 {
            let c;
            // SAFETY: the instruction computes one register from two.
            unsafe {
                asm!(
                    concat!($instruction, " {c}, {a}, {b}"),
                    a = in(ymm_reg) a,
                    b = in(ymm_reg) b,
                    c = lateout(ymm_reg) c,
                    options(pure, nomem, nostack, preserves_flags),
                );
            }
            c
        }
    };
}
// Compares signed integers. If intrinsics were used, the compiler would first compare the last
// operand with the one before it and would turn comparisons into masks, which takes longer. The
// assembly is used only for the last comparison because wrapping all of them would move vectors
// between registers.
literally!(greater = "vpmaxsd");
literally!(lesser = "vpminsd");
literally!(is_greater = "vpcmpgtd");

/// Sets all bits in the lanes whose mask bits are set.
#[inline(always)]
fn lanes_of(mask: u32) -> __m256i {
    proven! {
        let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(mask as i32), bits), bits)
    }
}

/// Transposes rows to columns: first pairs, then groups of four, then halves.
#[inline(always)]
pub(super) fn transpose([a, b, c, d, e, f, g, h]: [__m256; WIDTH]) -> [__m256; WIDTH] {
    proven! {
        let (ab, cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
        let (ef, gh) = (_mm256_unpacklo_ps(e, f), _mm256_unpacklo_ps(g, h));
        let (ab_high, cd_high) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
        let (ef_high, gh_high) = (_mm256_unpackhi_ps(e, f), _mm256_unpackhi_ps(g, h));
        let (p0, q0) = (_mm256_shuffle_ps::<0x44>(ab, cd), _mm256_shuffle_ps::<0x44>(ef, gh));
        let (p1, q1) = (_mm256_shuffle_ps::<0xee>(ab, cd), _mm256_shuffle_ps::<0xee>(ef, gh));
        let (p2, q2) = (_mm256_shuffle_ps::<0x44>(ab_high, cd_high), _mm256_shuffle_ps::<0x44>(ef_high, gh_high));
        let (p3, q3) = (_mm256_shuffle_ps::<0xee>(ab_high, cd_high), _mm256_shuffle_ps::<0xee>(ef_high, gh_high));
        [
            _mm256_permute2f128_ps::<0x20>(p0, q0),
            _mm256_permute2f128_ps::<0x20>(p1, q1),
            _mm256_permute2f128_ps::<0x20>(p2, q2),
            _mm256_permute2f128_ps::<0x20>(p3, q3),
            _mm256_permute2f128_ps::<0x31>(p0, q0),
            _mm256_permute2f128_ps::<0x31>(p1, q1),
            _mm256_permute2f128_ps::<0x31>(p2, q2),
            _mm256_permute2f128_ps::<0x31>(p3, q3),
        ]
    }
}

/// Implements arithmetic on `f64` with one instruction per operation. The instructions in brackets
/// implement `copysign`.
macro_rules! doubles {
    ($doubles:ident: $($name:ident = $instruction:ident;)*
     [sqrt = $sqrt:ident; copysign = $splat:ident, $and:ident, $andnot:ident, $or:ident]) => {
        impl $crate::math::Doubles for $doubles {
            $(
                #[inline(always)]
                fn $name(self, other: Self) -> Self {
                    proven!($doubles($instruction(self.0, other.0)))
                }
            )*
            #[inline(always)]
            fn sqrt(self) -> Self {
                proven!($doubles($sqrt(self.0)))
            }
            #[inline(always)]
            fn copysign(self, sign: Self) -> Self {
                proven! {
                    let bit = $splat(-0.0);
                    $doubles($or($andnot(bit, self.0), $and(bit, sign.0)))
                }
            }
        }
    };
}
pub(super) use doubles;

/// Four `f64` values in an AVX register.
#[derive(Clone, Copy)]
pub struct FourDoubles(__m256d);

doubles! { FourDoubles:
    add = _mm256_add_pd;
    sub = _mm256_sub_pd;
    mul = _mm256_mul_pd;
    div = _mm256_div_pd;
    min = _mm256_min_pd;
    max = _mm256_max_pd;
    [sqrt = _mm256_sqrt_pd; copysign = _mm256_set1_pd, _mm256_and_pd, _mm256_andnot_pd, _mm256_or_pd]
}

/// Converts a vector to double precision.
#[inline(always)]
pub(super) fn triple(v: glam::Vec3A) -> FourDoubles {
    proven!(FourDoubles(_mm256_cvtps_pd(v.into())))
}

impl Triple for FourDoubles {
    type Component = f64;

    #[inline(always)]
    fn z(self) -> f64 {
        proven!(_mm_cvtsd_f64(_mm256_extractf128_pd::<1>(self.0)))
    }
    #[inline(always)]
    fn sum(self) -> f64 {
        proven! {
            let xy = _mm256_castpd256_pd128(self.0);
            _mm_cvtsd_f64(_mm_add_sd(xy, _mm_unpackhi_pd(xy, xy))) + self.z()
        }
    }
    #[inline(always)]
    fn yzx(self) -> Self {
        proven!(FourDoubles(_mm256_permute4x64_pd::<0b11_00_10_01>(self.0)))
    }
}

impl FloatLanes for Avx2 {
    type Floats = __m256;

    arithmetic_of_eight!();
    #[inline(always)]
    fn le(self, a: __m256, b: __m256) -> u32 {
        proven!(_mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32)
    }
    #[inline(always)]
    fn lt(self, a: __m256, b: __m256) -> u32 {
        proven!(_mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b)) as u32)
    }
}

impl Lanes for Avx2 {
    type Wide = TwoVectors<Self>;
    type Doubles = (FourDoubles, FourDoubles);
    type Triple = FourDoubles;

    order_of_eight!();

    #[inline(always)]
    fn wide(self) -> TwoVectors<Self> {
        TwoVectors(self)
    }
    #[inline(always)]
    fn join(self, [low, high]: [__m256; 2]) -> (__m256, __m256) {
        (low, high)
    }
    #[inline(always)]
    fn doubles(self, a: __m256) -> (FourDoubles, FourDoubles) {
        proven! {
            let (low, high) = (_mm256_castps256_ps128(a), _mm256_extractf128_ps::<1>(a));
            (FourDoubles(_mm256_cvtps_pd(low)), FourDoubles(_mm256_cvtps_pd(high)))
        }
    }
    #[inline(always)]
    fn splat_double(self, x: f64) -> (FourDoubles, FourDoubles) {
        proven!((FourDoubles(_mm256_set1_pd(x)), FourDoubles(_mm256_set1_pd(x))))
    }
    #[inline(always)]
    fn load_doubles(self, from: &[f64; WIDTH]) -> (FourDoubles, FourDoubles) {
        proven!((FourDoubles(_mm256_loadu_pd(from.as_ptr())), FourDoubles(_mm256_loadu_pd(from.as_ptr().add(4)))))
    }
    #[inline(always)]
    fn store_doubles(self, (low, high): (FourDoubles, FourDoubles)) -> [f64; WIDTH] {
        let mut to = [0.0; WIDTH];
        proven! {
            _mm256_storeu_pd(to.as_mut_ptr(), low.0);
            _mm256_storeu_pd(to.as_mut_ptr().add(4), high.0);
        }
        to
    }
    #[inline(always)]
    fn le_doubles(self, a: (FourDoubles, FourDoubles), b: (FourDoubles, FourDoubles)) -> u32 {
        proven! {
            let low = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(a.0.0, b.0.0));
            (low | _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(a.1.0, b.1.0)) << 4) as u32
        }
    }
    #[inline(always)]
    fn singles(self, (low, high): (FourDoubles, FourDoubles)) -> __m256 {
        proven!(_mm256_set_m128(_mm256_cvtpd_ps(high.0), _mm256_cvtpd_ps(low.0)))
    }

    #[inline(always)]
    fn select(self, mask: u32, a: __m256, b: __m256) -> __m256 {
        proven!(_mm256_blendv_ps(b, a, _mm256_castsi256_ps(lanes_of(mask))))
    }
}
