//! From photographs to cameras and points.
//!
//! Given photographs of a scene, [`matching`] finds the same points of the scene in several of
//! them, [`solve`] finds where the photographs were taken and where the points are, and [`adjust`]
//! makes both as exact as the photographs allow (bundle adjustment). [`resect`] finds the camera of
//! a single photograph. [`mod@format`] reads and writes what other programs use.
//!
//! # Conventions
//!
//! A [`Pose`] takes a point X of the world to P = R X + t in the camera's own frame: x to the
//! right, y downwards, z forward, along the view. A [`Lens`] takes P to a pixel: with p = P.xy /
//! P.z and r = 1 + k1 |p|² + k2 |p|⁴,
//!
//! ```text
//! pixel = center + focal r (p.x, aspect p.y)
//! ```
//!
//! in pixels from the upper left corner of the picture, so that the centre of the first pixel is at
//! (0.5, 0.5). How the formats of other programs differ from this is one table,
//! [`format::CONVENTIONS`].
//!
//! Nothing here depends on the number of threads, on time, or on the platform's mathematical
//! functions.

pub mod adjust;
mod error;
pub mod explain;
pub mod feature;
pub mod format;
pub mod geometry;
mod jpeg;
mod known;
pub mod matching;
pub mod model;
pub mod photo;
pub mod random;
pub mod resect;
pub mod solve;
pub mod tour;

pub use error::Error;
pub use model::{Lens, Observation, Point, Pose, Reconstruction, View};
