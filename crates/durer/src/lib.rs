//! Dürer: a ray tracer that is exact, explainable and deterministic.
//!
//! A scene file is read into a [`scene::Scene`] (plain data), compiled into a [`world::World`]
//! (immutable tables), and rendered by a [`render::Job`] into pictures.
//!
//! This crate is the face of the others: it passes on their modules, and loads files.

#[cfg(all(feature = "fs", any(test, feature = "testing")))]
#[doc(hidden)]
pub mod fuzz;
#[cfg(feature = "fs")]
pub mod load;

pub use durer_bvh as bvh;
pub use durer_diag as diag;
pub use durer_formats as format;
pub use durer_image as image;
pub use durer_image::panics;
pub use durer_render::{compile, film, integrator, render, threads, world};
pub use durer_scene::{
    bsdf, camera, describe, dialect, light, material, math, medium, sampler, scene, shape, source, spectrum, texture,
};
pub use durer_teach::{check, lesson, mistakes};
#[cfg(feature = "fs")]
pub use load::{LoadOptions, Loaded, load, load_text};
