//! Writer of meshes in the binary PLY format. `write` stores positions, colours, and triangles for
//! any program; `write_all_attributes` stores all attributes for Dürer's own reader.

use super::rows::COLUMNS;
use durer_image::Transfer;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::shape::MeshData;
use durer_scene::shape::mesh::NO_INDEX;
use durer_scene::shape::triangle::face_normal;
use std::collections::HashMap;

/// Encodes the positions, colours, and triangles of a mesh as a binary PLY file.
pub(crate) fn write(mesh: &MeshData) -> Vec<u8> {
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

/// Encodes all attributes of a mesh, including normals, both sets of texture coordinates, linear
/// colours, and tangents. If some corners have a normal or texture coordinates and others do not,
/// the others get the normal of their face or texture coordinates of 0.
pub(crate) fn write_all_attributes(mesh: &MeshData) -> Vec<u8> {
    let VertexList { vertices, triangles, normals } = VertexList::of(mesh);
    let (has_normals, has_uvs) = (!mesh.triangle_normals.is_empty(), !mesh.triangle_uvs.is_empty());
    let mut head = "ply\nformat binary_little_endian 1.0\n".to_string();
    if mesh.flat {
        head += "obj_info flat\n";
    }
    head += &format!("element vertex {}\n", vertices.len());
    let given = [
        (0..3, true),
        (3..6, has_normals),
        (6..8, has_uvs),
        (12..16, !mesh.colors.is_empty()),
        (16..18, !mesh.second_uvs.is_empty()),
        (18..22, !mesh.tangents.is_empty()),
    ];
    let columns = given.into_iter().filter(|column| column.1).flat_map(|column| column.0);
    columns.for_each(|column| head += &format!("property float {}\n", COLUMNS[column][0]));
    head += &format!("element face {}\nproperty list uchar int vertex_indices\nend_header\n", triangles.len());
    let mut out = head.into_bytes();
    for [place, uv, normal] in vertices {
        let at = place as usize;
        let mut put = |values: &[f32]| values.iter().for_each(|x| out.extend(x.to_le_bytes()));
        put(&mesh.positions[at].to_array());
        if has_normals {
            put(&normals[normal as usize].to_array());
        }
        if has_uvs {
            put(&mesh.uvs.get(uv as usize).copied().unwrap_or(Vec2::ZERO).to_array());
        }
        mesh.colors.get(at).into_iter().for_each(|color| put(color));
        mesh.second_uvs.get(at).into_iter().for_each(|uv| put(&uv.to_array()));
        mesh.tangents.get(at).into_iter().for_each(|tangent| put(tangent));
    }
    for triangle in &triangles {
        out.push(3);
        triangle.iter().for_each(|i| out.extend(i.to_le_bytes()));
    }
    out
}

/// Vertices of a PLY file to be written, which are unique triples of indices of a position, texture
/// coordinates, and a normal.
struct VertexList {
    vertices: Vec<[u32; 3]>,
    triangles: Vec<[u32; 3]>,
    /// The normals of the mesh, followed by face normals for the triangles that have none.
    normals: Vec<Vec3>,
}

impl VertexList {
    fn of(mesh: &MeshData) -> VertexList {
        let alike = |list: &[[u32; 3]]| list.is_empty() || list == mesh.triangles;
        let mut normals = mesh.normals.clone();
        if alike(&mesh.triangle_uvs) && alike(&mesh.triangle_normals) {
            let vertices = (0..mesh.positions.len() as u32).map(|i| [i; 3]).collect();
            normals.resize(mesh.positions.len(), Vec3::ZERO);
            return VertexList { vertices, triangles: mesh.triangles.clone(), normals };
        }
        let (mut vertices, mut known) = (Vec::new(), HashMap::new());
        let none = [NO_INDEX; 3];
        let triangles = mesh.triangles.iter().enumerate().map(|(i, &corners)| {
            let uvs = mesh.triangle_uvs.get(i).copied().unwrap_or(none);
            let mut own = mesh.triangle_normals.get(i).copied().unwrap_or(none);
            if !mesh.triangle_normals.is_empty() && own.contains(&NO_INDEX) {
                normals.push(face_normal(corners.map(|i| mesh.positions[i as usize])));
                own = own.map(|i| if i == NO_INDEX { normals.len() as u32 - 1 } else { i });
            }
            std::array::from_fn(|k| {
                let vertex = [corners[k], uvs[k], own[k]];
                *known.entry(vertex).or_insert_with(|| {
                    vertices.push(vertex);
                    vertices.len() as u32 - 1
                })
            })
        });
        VertexList { triangles: triangles.collect(), vertices, normals }
    }
}
