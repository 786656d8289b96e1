//! Scene description as plain data: shapes, cameras, lights, materials, BSDFs, spectra and
//! textures, together with their mathematics.
//!
//! A [`scene::Scene`] holds all of them. This crate neither traces rays through a scene nor opens
//! files. Scenes are read by `durer-formats`, and compiled and rendered by `durer-render`.

pub mod asset;
pub mod bsdf;
pub mod camera;
pub mod describe;
pub mod dialect;
pub mod light;
pub mod material;
pub mod math;
pub mod medium;
pub mod sampler;
pub mod scene;
pub mod shape;
pub mod source;
pub mod spectrum;
pub mod texture;
pub mod weather;
