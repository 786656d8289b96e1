//! Dürer: a ray tracer that is exact, explainable and deterministic.

pub mod describe;
pub mod diag;
pub mod dialect;
pub mod film;
pub mod math;
pub mod sampler;
pub mod shape;
pub mod source;
