//! Rays against triangles and boxes: the crate [`durer_bvh`], which can be used by itself.

pub(crate) use durer_bvh::internal::is_sound;
pub use durer_bvh::*;
