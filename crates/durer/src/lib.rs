//! Dürer: a ray tracer that is exact, explainable and deterministic.
//!
//! A scene file is read into a [`scene::Scene`] (plain data), compiled into a [`world::World`]
//! (immutable, numbers only), and rendered by a [`render::Job`] into pictures.

pub mod bsdf;
pub mod bvh;
pub mod camera;
pub mod check;
pub mod compile;
pub mod describe;
pub mod diag;
pub mod dialect;
pub mod film;
pub mod format;
#[cfg(any(test, fuzzing))]
pub mod fuzz;
pub mod image;
pub mod integrator;
pub mod lesson;
pub mod light;
pub mod load;
pub mod material;
pub mod math;
pub mod medium;
pub mod mistakes;
pub mod panics;
pub mod render;
pub mod sampler;
pub mod scene;
pub mod shape;
pub mod source;
pub mod spectrum;
pub mod texture;
pub mod threads;
pub mod world;

pub use load::{LoadOptions, Loaded, load, load_text};
