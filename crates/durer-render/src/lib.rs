//! The renderer: compiles a [`durer_scene::scene::Scene`] into a [`world::World`] (immutable
//! tables) and renders it into a [`film::Film`].

mod clock;
pub mod compile;
pub mod film;
pub mod integrator;
pub mod render;
pub mod threads;
pub mod world;
