//! SIMD operations on eight lanes, with all unsafe code of the library.
//!
//! [`Lanes`] lists the operations that traversal needs. Each level implements it once, and
//! [`AvailableLevel::run`] runs a [`Kernel`] at a level. Hits depend only on operations that are
//! never fused, so every level gives the same bits. [`FloatLanes::mul_add`] may be fused or not,
//! but only box tests use it, and they allow for either.
#![allow(unsafe_code)]

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod level;
#[cfg(target_arch = "aarch64")]
mod neon;
mod operations;
mod pages;
mod scalar;
mod stack;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod wasm;
mod wide;

pub(crate) use level::AvailableLevel;
pub use level::{PlainKernel, SimdLevel, UnsupportedSimdLevel, run_plain};
pub(crate) use operations::{
    CornerColumns, FloatLanes, Kernel, Lanes, NodePlanes, ROWS, ROWS_LEN, Rows, WIDE, WideLanes, as_floats,
};
pub(crate) use pages::parallel_vec;
pub use pages::{prefetch, vec_on_large_pages};
pub(crate) use stack::{Stack, StackStorage};

pub(crate) use crate::node::WIDTH;

#[cfg(test)]
mod tests;
