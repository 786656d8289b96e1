//! The normals that a mesh file brings.

use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;

/// Triangles whose normals are odd, by number.
#[derive(Debug, Default)]
pub(in crate::check) struct Given {
    /// Whose normals point to the other side than the way round of their corners says.
    pub against: Vec<u32>,
    /// Without normals, where others have some.
    pub missing: Vec<u32>,
    /// With a normal of no length.
    pub zero: Vec<u32>,
    /// How many have normals.
    pub count: usize,
}

impl Given {
    /// Looks at a mesh as it stands in its file; `None` where it has no normals.
    pub fn of(data: &MeshData) -> Option<Given> {
        let mut given = Given::default();
        for (i, triangle) in data.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|corner| data.positions[corner as usize].as_dvec3());
            let indices = data.triangle_normals.get(i).filter(|indices| !indices.contains(&NO_INDEX));
            let Some(normals) = indices.map(|indices| indices.map(|n| data.normals[n as usize].as_dvec3())) else {
                given.missing.push(i as u32);
                continue;
            };
            given.count += 1;
            if normals.iter().any(|normal| normal.length_squared() == 0.0) {
                given.zero.push(i as u32);
            }
            let face = (b - a).cross(c - a);
            // A smooth normal may lean over an edge; all three do not.
            if normals.iter().all(|normal| normal.dot(face) < 0.0) {
                given.against.push(i as u32);
            }
        }
        (given.count > 0).then_some(given)
    }

    /// Whether nearly all are against the corners.
    pub fn is_against_all(&self) -> bool {
        self.against.len() * 10 > self.count * 9
    }
}
