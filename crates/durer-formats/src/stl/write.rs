//! Writer of meshes as binary STL files, which contain triangles and their normals.

use durer_scene::math::Vec3;
use durer_scene::shape::MeshData;

/// Encodes a mesh as a binary STL file.
pub(crate) fn write(mesh: &MeshData) -> Vec<u8> {
    let mut out = b"triangles".to_vec();
    out.resize(80, b' ');
    out.extend((mesh.triangles.len() as u32).to_le_bytes());
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
        let normal = (b - a).as_dvec3().cross((c - a).as_dvec3()).normalize_or_zero().as_vec3();
        let row = |p: Vec3| p.to_array();
        [normal, a, b, c].into_iter().flat_map(row).for_each(|x| out.extend(x.to_le_bytes()));
        out.extend([0; 2]);
    }
    out
}
