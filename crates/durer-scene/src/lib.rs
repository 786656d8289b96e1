//! Scene description: shapes, cameras, lights, materials, BSDFs, spectra and textures, as plain
//! data with their own mathematics.
//!
//! [`scene::Scene`] holds them all. Nothing here traces rays through a scene or opens files:
//! `durer-formats` reads scenes, `durer-render` compiles and renders them.

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
