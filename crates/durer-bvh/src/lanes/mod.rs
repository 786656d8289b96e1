//! SIMD operations on eight lanes. All unsafe code of the library is in this module.
//!
//! [`Lanes`] lists the operations that traversal needs. Each level implements these operations
//! once, and [`AvailableLevel::run`] runs a [`Kernel`] at a level. Hits depend only on operations
//! that are never fused, so they are the same, bit for bit, at every level. [`FloatLanes::mul_add`]
//! may or may not be fused, but only box tests use it, and they allow for both cases.
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
