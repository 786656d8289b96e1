//! Triangle meshes: indexed triangles with optional normals and texture coordinates.

use super::triangle::{face_normal, interpolate};
use super::{Crossing, Surface};
use crate::describe::{FileName, Rule};
use crate::described;
use crate::dialect::{MeshNormals, set};
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

impl MeshData {
    /// Gives every triangle corners of its own, moved out a little; see [`loosened`].
    pub fn loosen(&mut self) {
        let corners = |t: &[u32; 3]| loosened(t.map(|i| self.positions[i as usize]));
        self.positions = self.triangles.iter().flat_map(corners).collect();
        self.triangles = (0..self.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    }
}

/// The triangle of all points whose barycentric coordinates in a triangle are at least -0.00001: the same, enlarged
/// about its centroid by thrice that.
pub fn loosened([a, b, c]: [Vec3; 3]) -> [Vec3; 3] {
    const SLACK: f64 = 1e-5;
    let corners = [a.as_dvec3(), b.as_dvec3(), c.as_dvec3()];
    let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
    corners.map(|p| (p + 3.0 * SLACK * (p - centroid)).as_vec3())
}

described! {
    /// A triangle mesh in a file of its own.
    TriangleMesh ["TriangleMesh" in set::CLASSIC, "mesh" in set::F23] {
        /// Path of the mesh file: `.obj` or `.ply`.
        obj_file: FileName = FileName::default(), required, Rule::Any, ["obj_file" in set::ALL];
    }
}

/// A mesh ready to be hit: every triangle has its corners, and normals if it is smooth.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    data: MeshData,
}

impl Mesh {
    /// Takes a mesh file's data; normals are made by `rule` for triangles that bring none, or for all
    /// unless `file_normals`.
    pub fn new(mut data: MeshData, rule: MeshNormals, file_normals: bool) -> Self {
        if !file_normals {
            data.normals.clear();
            data.triangle_normals.clear();
        }
        super::normals::complete(&mut data, rule);
        Mesh { data }
    }

    /// Corners' positions.
    pub fn positions(&self) -> &[Vec3] {
        &self.data.positions
    }

    /// Three positions a triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.data.triangles
    }

    /// How many triangles it has.
    pub fn len(&self) -> usize {
        self.data.triangles.len()
    }

    /// Whether it has no triangle.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes that it takes in memory, its acceleration structure not counted.
    pub fn bytes(&self) -> usize {
        let d = &self.data;
        size_of_val(&*d.positions)
            + size_of_val(&*d.uvs)
            + size_of_val(&*d.normals)
            + size_of_val(&*d.triangles)
            + size_of_val(&*d.triangle_uvs)
            + size_of_val(&*d.triangle_normals)
    }

    /// The corners of a triangle.
    pub fn corners(&self, part: u32) -> [Vec3; 3] {
        self.data.triangles[part as usize].map(|i| self.data.positions[i as usize])
    }

    /// The surface of a triangle at a crossing.
    pub fn surface(&self, part: u32, crossing: &Crossing) -> Surface {
        let corners = self.corners(part);
        let (position, error, barycentric) = interpolate(corners, crossing.uv);
        let n_geo = face_normal(corners);
        let mix = |[a, b, c]: [Vec3; 3]| barycentric.x * a + barycentric.y * b + barycentric.z * c;
        let n_shade = attribute(&self.data.triangle_normals, &self.data.normals, part)
            .map_or(n_geo, |normals| mix(normals).normalize_or(n_geo));
        let uv = attribute(&self.data.triangle_uvs, &self.data.uvs, part)
            .map(|[a, b, c]| barycentric.x * a + barycentric.y * b + barycentric.z * c);
        // Normals in the file say which side is out, whatever way the corners go round.
        let n_geo = if n_geo.dot(n_shade) < 0.0 { -n_geo } else { n_geo };
        Surface { position, error, curvature: 0.0, n_geo, n_shade, uv, barycentric }
    }
}

/// An attribute's values at the corners of a triangle, if it has them all.
fn attribute<T: Copy>(indices: &[[u32; 3]], values: &[T], part: u32) -> Option<[T; 3]> {
    let [a, b, c] = *indices.get(part as usize)?;
    Some([*values.get(a as usize)?, *values.get(b as usize)?, *values.get(c as usize)?])
}
