//! Checks the vertex normals that are stored in a mesh file.

use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;

/// Indices of the triangles of a mesh file whose vertex normals are missing, zero or opposed to the
/// winding.
#[derive(Debug, Default)]
pub(in crate::check) struct InvalidNormals {
    /// Triangles whose normals are opposed to their winding.
    pub opposed: Vec<u32>,
    /// Triangles without normals in a file in which other triangles have normals.
    pub missing: Vec<u32>,
    /// Triangles with at least one normal of length zero.
    pub zero: Vec<u32>,
    /// Number of triangles with normals.
    pub count: usize,
}

impl InvalidNormals {
    /// Examines the normals of a mesh as stored in its file. Returns `None` if it has none.
    pub fn of(data: &MeshData) -> Option<InvalidNormals> {
        let mut odd_normals = InvalidNormals::default();
        for (i, triangle) in data.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|corner| data.positions[corner as usize].as_dvec3());
            let indices = data.triangle_normals.get(i).filter(|indices| !indices.contains(&NO_INDEX));
            let Some(normals) = indices.map(|indices| indices.map(|n| data.normals[n as usize].as_dvec3())) else {
                odd_normals.missing.push(i as u32);
                continue;
            };
            odd_normals.count += 1;
            if normals.iter().any(|normal| normal.length_squared() == 0.0) {
                odd_normals.zero.push(i as u32);
            }
            let face = (b - a).cross(c - a);
            // One smooth normal can point to the other side of the face, but not all three.
            if normals.iter().all(|normal| normal.dot(face) < 0.0) {
                odd_normals.opposed.push(i as u32);
            }
        }
        (odd_normals.count > 0).then_some(odd_normals)
    }

    /// Returns true if the normals of nearly all triangles are opposed to their winding.
    pub fn is_against_all(&self) -> bool {
        self.opposed.len() * 10 > self.count * 9
    }
}
