//! Dürer's renderer. [`compile`] turns a [`durer_scene::scene::Scene`] into a [`world::World`],
//! which does not change during rendering. [`render`] renders the world into a [`film::Film`].

mod clock;
pub mod compile;
pub mod daylight;
pub mod film;
pub mod glare;
pub mod integrator;
pub mod measure;
pub mod render;
pub mod threads;
pub mod world;
