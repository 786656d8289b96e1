//! Integrators: how much light comes along a ray.

pub mod spawn;
pub mod whitted;

pub use whitted::{Settings, Whitted};
