//! Colours of faces, which become colours of vertices.

use durer_scene::shape::MeshData;

/// Gives each triangle three vertices of its own with the colour of the triangle. Does nothing if
/// the vertices have colours, or if no triangle has one.
pub(super) fn color_faces(mesh: &mut MeshData, colors: &[[f32; 4]]) {
    if colors.is_empty() || !mesh.colors.is_empty() {
        return;
    }
    let corners: Vec<usize> = mesh.triangles.iter().flatten().map(|&corner| corner as usize).collect();
    fn spread<T: Copy>(values: &mut Vec<T>, corners: &[usize]) {
        if !values.is_empty() {
            *values = corners.iter().map(|&corner| values[corner]).collect();
        }
    }
    spread(&mut mesh.positions, &corners);
    spread(&mut mesh.second_uvs, &corners);
    spread(&mut mesh.tangents, &corners);
    let of = |corner: usize| colors.get(corner / 3).copied().unwrap_or([1.0; 4]);
    mesh.colors = (0..corners.len()).map(of).collect();
    mesh.triangles = (0..mesh.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
}
