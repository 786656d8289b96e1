//! Sixteen lanes for ray packets, stored in one AVX-512 vector or in two vectors with eight lanes.

use super::operations::{FloatLanes, Lanes, WIDE, WideLanes};
use crate::node::WIDTH;

/// Sixteen lanes stored as two vectors with eight lanes, for SIMD levels without longer vectors.
#[derive(Clone, Copy)]
pub struct TwoVectors<L>(pub L);

#[inline(always)]
fn halves(from: &[f32; WIDE]) -> (&[f32; WIDTH], &[f32; WIDTH]) {
    match (from.first_chunk(), from.last_chunk()) {
        (Some(low), Some(high)) => (low, high),
        _ => unreachable!("sixteen are twice eight"),
    }
}

macro_rules! two {
    ($($operation:ident($($x:ident),+);)*) => {$(
        #[inline(always)]
        fn $operation(self, $($x: Self::Floats),+) -> Self::Floats {
            (self.0.$operation($($x.0),+), self.0.$operation($($x.1),+))
        }
    )*};
}

impl<L: Lanes> FloatLanes for TwoVectors<L> {
    type Floats = (L::Floats, L::Floats);

    two! {
        add(a, b);
        sub(a, b);
        mul(a, b);
        div(a, b);
        abs(a);
        mul_add(a, b, c);
        min(a, b);
        max(a, b);
    }

    #[inline(always)]
    fn splat(self, x: f32) -> Self::Floats {
        (self.0.splat(x), self.0.splat(x))
    }
    #[inline(always)]
    fn le(self, a: Self::Floats, b: Self::Floats) -> u32 {
        self.0.le(a.0, b.0) & 255 | self.0.le(a.1, b.1) << WIDTH
    }
    #[inline(always)]
    fn lt(self, a: Self::Floats, b: Self::Floats) -> u32 {
        self.0.lt(a.0, b.0) & 255 | self.0.lt(a.1, b.1) << WIDTH
    }
}

impl<L: Lanes> WideLanes for TwoVectors<L> {
    #[inline(always)]
    fn load(self, from: &[f32; WIDE]) -> Self::Floats {
        let (low, high) = halves(from);
        (self.0.load(low), self.0.load(high))
    }
    #[inline(always)]
    fn store(self, a: Self::Floats) -> [f32; WIDE] {
        let mut to = [0.0; WIDE];
        to[..WIDTH].copy_from_slice(&self.0.store(a.0));
        to[WIDTH..].copy_from_slice(&self.0.store(a.1));
        to
    }
    #[inline(always)]
    fn select(self, mask: u32, a: Self::Floats, b: Self::Floats) -> Self::Floats {
        (self.0.select(mask, a.0, b.0), self.0.select(mask >> WIDTH, a.1, b.1))
    }
    #[inline(always)]
    fn least(self, a: Self::Floats) -> f32 {
        let halves = self.0.store(self.0.min(a.0, a.1));
        halves[1..].iter().fold(halves[0], |least, &x| if x < least { x } else { least })
    }
    #[inline(always)]
    fn greatest(self, a: Self::Floats) -> f32 {
        let halves = self.0.store(self.0.max(a.0, a.1));
        halves[1..].iter().fold(halves[0], |greatest, &x| if x > greatest { x } else { greatest })
    }
}
