//! Meshes as PLY files, binary: places and colours of vertices, and triangles.

use crate::image::Transfer;
use crate::shape::MeshData;

pub(in crate::format) fn write(mesh: &MeshData) -> Vec<u8> {
    let mut head = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.positions.len());
    ["x", "y", "z"].iter().for_each(|axis| head += &format!("property float {axis}\n"));
    if !mesh.colors.is_empty() {
        ["red", "green", "blue", "alpha"].iter().for_each(|color| head += &format!("property uchar {color}\n"));
    }
    head += &format!("element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangles.len());
    let mut out = head.into_bytes();
    for (i, p) in mesh.positions.iter().enumerate() {
        p.to_array().iter().for_each(|x| out.extend(x.to_le_bytes()));
        if let Some([r, g, b, alpha]) = mesh.colors.get(i) {
            out.extend([r, g, b].map(|c| Transfer::Srgb.encode(*c)));
            out.push(Transfer::Linear.encode(*alpha));
        }
    }
    for triangle in &mesh.triangles {
        out.push(3);
        triangle.iter().for_each(|i| out.extend(i.to_le_bytes()));
    }
    out
}
