//! Dürer: a ray tracer that is exact, explainable and deterministic.

pub mod describe;
pub mod diag;
pub mod dialect;
pub mod format;
pub mod math;
pub mod shape;
pub mod source;
