//! Triangle meshes: indexed triangles with optional normals and texture coordinates.

use crate::math::{Vec2, Vec3};

/// An index that is not given.
pub const NO_INDEX: u32 = u32::MAX;

/// What a mesh file holds: plain data, as written, n-gons cut into triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// Corners' positions.
    pub positions: Vec<Vec3>,
    /// Texture coordinates; may be empty.
    pub uvs: Vec<Vec2>,
    /// Normals, not necessarily of length 1; may be empty.
    pub normals: Vec<Vec3>,
    /// Three positions a triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Three texture coordinates a triangle, or [`NO_INDEX`]; empty where no triangle has any.
    pub triangle_uvs: Vec<[u32; 3]>,
    /// Three normals a triangle, or [`NO_INDEX`]; empty where no triangle has any.
    pub triangle_normals: Vec<[u32; 3]>,
}
