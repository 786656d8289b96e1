//! Writer of Wavefront files, which keeps all attributes of a mesh except second texture
//! coordinates and tangents.

use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;
use std::fmt::Write;

/// Formats a mesh as a Wavefront file. Each number has the fewest digits that identify its value
/// exactly.
pub(crate) fn write(mesh: &MeshData) -> Vec<u8> {
    // Writing to a `String` never fails.
    let mut out = String::new();
    for (i, p) in mesh.positions.iter().enumerate() {
        let _ = write!(out, "v {} {} {}", p.x, p.y, p.z);
        if let Some([r, g, b, _]) = mesh.colors.get(i) {
            let [r, g, b] = [r, g, b].map(|c| f32::from(durer_image::Transfer::Srgb.encode(*c)) / 255.0);
            let _ = write!(out, " {r} {g} {b}");
        }
        out.push('\n');
    }
    mesh.uvs.iter().for_each(|uv| _ = writeln!(out, "vt {} {}", uv.x, uv.y));
    mesh.normals.iter().for_each(|n| _ = writeln!(out, "vn {} {} {}", n.x, n.y, n.z));
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        out.push('f');
        let of = |list: &[[u32; 3]], k: usize| list.get(i).map(|t| t[k]).filter(|n| *n != NO_INDEX);
        for (k, corner) in triangle.iter().enumerate() {
            let _ = write!(out, " {}", corner + 1);
            let _ = match (of(&mesh.triangle_uvs, k), of(&mesh.triangle_normals, k)) {
                (Some(uv), Some(n)) => write!(out, "/{}/{}", uv + 1, n + 1),
                (Some(uv), None) => write!(out, "/{}", uv + 1),
                (None, Some(n)) => write!(out, "//{}", n + 1),
                (None, None) => Ok(()),
            };
        }
        out.push('\n');
    }
    out.into_bytes()
}
