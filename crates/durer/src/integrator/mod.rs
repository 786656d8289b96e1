//! Integrators: how much light comes along a ray.

pub mod account;
pub mod media;
pub mod spawn;
pub mod whitted;

pub use account::{Account, Node, Witness};
pub use whitted::{Settings, Whitted, refract};
