//! Shapes: what a ray can hit.
pub mod mesh;
