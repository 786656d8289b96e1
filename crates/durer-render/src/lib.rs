//! Dürer's renderer. [`compile`] turns a [`durer_scene::scene::Scene`] into a [`world::World`],
//! which is immutable while it is rendered, and [`render`] renders the world into a [`film::Film`].

mod clock;
pub mod compile;
pub mod film;
pub mod integrator;
pub mod render;
pub mod threads;
pub mod world;
