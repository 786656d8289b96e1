//! Dürer: a ray tracer that is exact, explainable and deterministic.

pub mod bvh;
pub mod camera;
pub mod compile;
pub mod describe;
pub mod diag;
pub mod dialect;
pub mod film;
pub mod format;
pub mod image;
pub mod integrator;
pub mod light;
pub mod material;
pub mod math;
pub mod sampler;
pub mod scene;
pub mod shape;
pub mod source;
pub mod texture;
pub mod world;
