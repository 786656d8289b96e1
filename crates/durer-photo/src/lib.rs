//! Photogrammetry, which computes cameras and points from photographs.
//!
//! From photographs of a scene, [`matching`] finds the scene points that several of them show,
//! [`solve`] computes the positions of the cameras and the points, and [`adjust`] refines both
//! (bundle adjustment). [`resect`] computes the camera of a single photograph. [`mod@format`] reads
//! and writes the formats of other programs.
//!
//! # Conventions
//!
//! A [`Pose`] maps a world point X to P = R X + t in the camera frame: x right, y down, z forward
//! along the view direction. A [`Lens`] maps P to a pixel: with p = P.xy / P.z and r = 1 + k1 |p|²
//! + k2 |p|⁴,
//!
//! ```text
//! pixel = principal_point + focal r (p.x, aspect p.y)
//! ```
//!
//! in pixels from the upper left corner of the image. The centre of the first pixel is at (0.5,
//! 0.5). The table [`format::CONVENTIONS`] lists how the formats of other programs differ.
//!
//! Results do not depend on the number of threads, on time, or on the platform's mathematical
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
