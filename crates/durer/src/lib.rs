//! Dürer: a ray tracer that is exact, explainable and deterministic.
//!
//! A scene is built in code or read from a file, compiled into immutable data, and rendered pass by
//! pass:
//!
//! ```
//! use durer::prelude::*;
//!
//! fn main() -> Result<(), Error> {
//!     let mut scene = Scene::builder();
//!     scene.camera(PerspectiveCamera::look_at(vec3(1.0, 1.0, 6.0), Vec3::ZERO, 40.0));
//!     let position = vec3(3.0, 4.0, 5.0);
//!     scene.light(PointLight { position, candela: Some(60.0), ..Default::default() });
//!     let base_color = rgb(0.8, 0.2, 0.1);
//!     let red = scene.material(PrincipledMaterial { base_color, ..Default::default() });
//!     let corners = [vec3(-1.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.5, 0.0)];
//!     let triangle = scene.mesh(&corners, &[[0, 1, 2]]);
//!     scene.add(triangle).material(red).translate(vec3(1.0, -0.5, 0.0));
//!     scene.add(Sphere { center: vec3(-1.0, 0.0, 0.0), radius: 1.0 }).material(red);
//!     let world = scene.build()?.compile()?;
//!
//!     let job = RenderJob::for_scene(&world).size((64, 48)).samples(4_u32);
//!     let mut render = Renderer::new(&world, job)?;
//!     while let Some(progress) = render.next_pass()? {
//!         println!("{} of {} samples", progress.samples, progress.all_samples);
//!     }
//!     let picture = render.image()?;
//!     assert!(picture.pixel(20, 24).is_some_and(|color| color.x > color.z));
//! #   let file = std::env::temp_dir().join(format!("durer-doctest-{}.exr", std::process::id()));
//! #   picture.save(&file)?;
//! #   std::fs::remove_file(&file).unwrap();
//! #   return Ok(());
//!     picture.save("picture.exr")
//! }
//! ```
//!
//! This crate is the entry point to the other crates. It loads files ([`open`], [`load()`]),
//! defines the options of a render and their defaults ([`job`]), creates reports as JSON
//! ([`report`]), and re-exports the modules of the other crates.

#[cfg(feature = "load")]
mod camera_placement;
pub mod compiled;
pub mod error;
#[cfg(all(feature = "fs", any(test, feature = "testing")))]
#[doc(hidden)]
pub mod fuzz;
pub mod job;
#[cfg(feature = "load")]
pub mod load;
#[cfg(feature = "fs")]
mod mesh_file;
#[cfg(feature = "options")]
pub mod options;
pub mod prelude;
pub mod renderer;
pub mod report;

#[cfg(feature = "load")]
pub use camera_placement::CameraPlacement;
#[cfg(feature = "fs")]
pub use compiled::open;
pub use compiled::{CompileScene, CompiledScene};
pub use durer_bvh as bvh;
pub use durer_diag as diag;
pub use durer_formats as format;
pub use durer_image as image;
pub use durer_image::panics;
pub use durer_render::{compile, daylight, film, glare, integrator, measure, render, threads, world};
pub use durer_scene::{
    bsdf, camera, describe, dialect, light, material, math, medium, sampler, scene, shape, source, spectrum, texture,
    weather,
};
pub use durer_teach::{check, lesson, mistakes};
pub use error::{Error, SceneError};
pub use job::RenderJob;
#[cfg(feature = "load")]
pub use load::{LoadOptions, LoadedScene, load, load_text};
#[cfg(feature = "fs")]
pub use mesh_file::open_mesh;
pub use renderer::{Canceller, Picture, Renderer};
