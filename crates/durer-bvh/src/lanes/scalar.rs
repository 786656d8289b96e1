//! SIMD operations implemented in scalar code, for any processor.

use super::operations::{FloatLanes, Lanes};
use super::stack::Stack;
use super::wide::TwoVectors;
use crate::math::Doubles;
use crate::node::WIDTH;
use std::array::from_fn;

/// The SIMD level without SIMD instructions, for any processor.
#[derive(Clone, Copy)]
pub struct Scalar;

/// Eight `f32` values in an array.
type F = [f32; WIDTH];

/// Eight `f64` values in an array.
#[derive(Clone, Copy)]
pub struct ScalarDoubles([f64; WIDTH]);

macro_rules! plain {
    ($($name:ident)*) => {$(
        #[inline(always)]
        fn $name(self, other: Self) -> Self {
            ScalarDoubles(from_fn(|i| Doubles::$name(self.0[i], other.0[i])))
        }
    )*};
}

impl Doubles for ScalarDoubles {
    plain! { add sub mul div min max copysign }

    #[inline(always)]
    fn sqrt(self) -> Self {
        ScalarDoubles(self.0.map(f64::sqrt))
    }
}

fn mask(test: impl Fn(usize) -> bool) -> u32 {
    (0..WIDTH).fold(0, |mask, i| mask | u32::from(test(i)) << i)
}

impl FloatLanes for Scalar {
    type Floats = F;

    #[inline(always)]
    fn splat(self, x: f32) -> F {
        [x; WIDTH]
    }
    #[inline(always)]
    fn add(self, a: F, b: F) -> F {
        from_fn(|i| a[i] + b[i])
    }
    #[inline(always)]
    fn sub(self, a: F, b: F) -> F {
        from_fn(|i| a[i] - b[i])
    }
    #[inline(always)]
    fn mul(self, a: F, b: F) -> F {
        from_fn(|i| a[i] * b[i])
    }
    #[inline(always)]
    fn div(self, a: F, b: F) -> F {
        from_fn(|i| a[i] / b[i])
    }
    #[inline(always)]
    fn abs(self, a: F) -> F {
        a.map(f32::abs)
    }
    #[inline(always)]
    fn mul_add(self, a: F, b: F, c: F) -> F {
        from_fn(|i| a[i] * b[i] + c[i])
    }
    #[inline(always)]
    fn min(self, a: F, b: F) -> F {
        from_fn(|i| if a[i] < b[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn max(self, a: F, b: F) -> F {
        from_fn(|i| if a[i] > b[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn le(self, a: F, b: F) -> u32 {
        mask(|i| a[i] <= b[i])
    }
    #[inline(always)]
    fn lt(self, a: F, b: F) -> u32 {
        mask(|i| a[i] < b[i])
    }
}

impl Lanes for Scalar {
    type Wide = TwoVectors<Self>;
    type Doubles = ScalarDoubles;
    type Triple = [f64; 3];

    #[inline(always)]
    fn wide(self) -> TwoVectors<Self> {
        TwoVectors(self)
    }
    #[inline(always)]
    fn join(self, [low, high]: [F; 2]) -> (F, F) {
        (low, high)
    }
    #[inline(always)]
    fn doubles(self, a: F) -> ScalarDoubles {
        ScalarDoubles(a.map(f64::from))
    }
    #[inline(always)]
    fn splat_double(self, x: f64) -> ScalarDoubles {
        ScalarDoubles([x; WIDTH])
    }
    #[inline(always)]
    fn load_doubles(self, from: &[f64; WIDTH]) -> ScalarDoubles {
        ScalarDoubles(*from)
    }
    #[inline(always)]
    fn store_doubles(self, a: ScalarDoubles) -> [f64; WIDTH] {
        a.0
    }
    #[inline(always)]
    fn le_doubles(self, a: ScalarDoubles, b: ScalarDoubles) -> u32 {
        mask(|i| a.0[i] <= b.0[i])
    }
    #[inline(always)]
    fn singles(self, a: ScalarDoubles) -> F {
        a.0.map(|x| x as f32)
    }
    #[inline(always)]
    fn triple(self, v: glam::Vec3A) -> [f64; 3] {
        v.as_dvec3().to_array()
    }
    #[inline(always)]
    fn permute(self, v: glam::Vec3A, [x, y, z, _]: &[u32; 4]) -> glam::Vec3A {
        let [a, b, c] = v.to_array();
        let v = [a, b, c, c];
        glam::Vec3A::new(v[*x as usize & 3], v[*y as usize & 3], v[*z as usize & 3])
    }
    #[inline(always)]
    fn load(self, from: &[f32; WIDTH]) -> F {
        *from
    }
    #[inline(always)]
    fn corners(
        self,
        from: &super::operations::Rows,
        super::operations::CornerColumns { starts, corner }: super::operations::CornerColumns,
    ) -> [[F; 3]; 3] {
        from_fn(|k| starts.map(|start| from_fn(|lane| from[k * corner + start + lane])))
    }
    #[inline(always)]
    fn store(self, a: F) -> [f32; WIDTH] {
        a
    }
    #[inline(always)]
    fn min_as_int(self, a: F, b: F) -> F {
        from_fn(|i| f32::from_bits((a[i].to_bits() as i32).min(b[i].to_bits() as i32) as u32))
    }
    #[inline(always)]
    fn max_as_int(self, a: F, b: F) -> F {
        from_fn(|i| f32::from_bits((a[i].to_bits() as i32).max(b[i].to_bits() as i32) as u32))
    }
    #[inline(always)]
    fn lt_as_int(self, a: F, b: F) -> F {
        let is_before = |i: usize| (a[i].to_bits() as i32) < b[i].to_bits() as i32;
        from_fn(|i| f32::from_bits(if is_before(i) { u32::MAX } else { 0 }))
    }
    #[inline(always)]
    fn signs(self, a: F) -> u32 {
        mask(|i| a[i].is_sign_negative())
    }
    #[inline(always)]
    fn nearest(self, a: F, which: F, child_tags: &[u8; WIDTH]) -> u32 {
        let key = |i: usize| a[i].to_bits() & !255 | u32::from(child_tags[i]) | !which[i].to_bits();
        (0..WIDTH).fold(u32::MAX, |least, i| least.min(key(i)))
    }
    #[inline(always)]
    fn select(self, mask: u32, a: F, b: F) -> F {
        from_fn(|i| if mask >> i & 1 == 1 { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn transpose(self, rows: [F; WIDTH]) -> [F; WIDTH] {
        from_fn(|k| from_fn(|i| rows[i][k]))
    }
    #[inline(always)]
    fn push(self, stack: &mut Stack, children: &[u32; WIDTH], near: F, order: &[u8; WIDTH], count: u32) {
        for &lane in order.iter().take(count as usize) {
            let lane = usize::from(lane) % WIDTH;
            stack.push(children[lane], near[lane]);
        }
    }
    #[inline(always)]
    fn prefetch<T>(self, _: *const T) {}
}
