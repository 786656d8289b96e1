//! Writes meshes. Each mesh has one list of vertices for positions, normals and texture
//! coordinates.

use super::Writer;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::shape::mesh::NO_INDEX;
use durer_scene::shape::{Mesh, MeshData};
use serde_json::{Value, json};
use std::collections::HashMap;

const FLOAT: u32 = 5126;
const UNSIGNED: u32 = 5125;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

impl Writer<'_> {
    /// Returns the index of the glTF mesh for a mesh with a material, which is written when it is
    /// used for the first time.
    pub(super) fn mesh(&mut self, name: String, data: &MeshData, material: Option<u32>) -> Option<usize> {
        let key = (name, material);
        if let Some(cached) = self.meshes.get(&key) {
            return Some(*cached);
        }
        let geometry = match self.geometries.get(&key.0) {
            Some(cached) => cached.clone(),
            None => {
                let converted = self.geometry(data);
                self.geometries.insert(key.0.clone(), converted.clone());
                converted
            }
        };
        let mut primitive = geometry?;
        if let Some(number) = material.and_then(|number| self.material(number, has_vertex_alpha(data))) {
            primitive["material"] = number.into();
        }
        let number = self.add("meshes", json!({ "primitives": [primitive] }));
        self.meshes.insert(key, number);
        Some(number)
    }

    /// Writes the attributes and indices of a mesh. Returns `None` if the mesh has no triangles.
    fn geometry(&mut self, data: &MeshData) -> Option<Value> {
        if data.triangles.is_empty() || data.positions.len() >= NO_INDEX as usize {
            return None;
        }
        let smooth = Mesh::new(data.clone(), self.output.normals, true);
        let (normals, triangle_normals) = smooth.normals();
        let (order, vertices) = welded(data, &triangle_normals);
        let mut attributes = json!({});
        let list = |get: &dyn Fn(&[u32; 3]) -> Vec<f32>| -> Vec<f32> { vertices.iter().flat_map(get).collect() };
        let positions = list(&|v| data.positions[v[0] as usize].to_array().into());
        attributes["POSITION"] = self.floats(&positions, 3, true).into();
        if !triangle_normals.is_empty() {
            let normal = |v: &[u32; 3]| normals.get(v[2] as usize).copied().unwrap_or(Vec3::Z);
            // Keep normals whose length is nearly 1, so that reading them back gives the same
            // values.
            let unit = |n: Vec3| if (n.length() - 1.0).abs() < 1e-3 { n } else { n.normalize_or(Vec3::Z) };
            let normals = list(&|v| unit(normal(v)).to_array().into());
            attributes["NORMAL"] = self.floats(&normals, 3, false).into();
        }
        if !data.triangle_uvs.is_empty() {
            // In glTF, v increases downwards.
            let uv = |v: &[u32; 3]| data.uvs.get(v[1] as usize).copied().unwrap_or(Vec2::Y);
            let uvs = list(&|v| vec![uv(v).x, 1.0 - uv(v).y]);
            attributes["TEXCOORD_0"] = self.floats(&uvs, 2, false).into();
        }
        let at = |v: &[u32; 3]| v[0] as usize;
        if data.second_uvs.len() == data.positions.len() {
            let uvs = list(&|v| vec![data.second_uvs[at(v)].x, 1.0 - data.second_uvs[at(v)].y]);
            attributes["TEXCOORD_1"] = self.floats(&uvs, 2, false).into();
        }
        if data.colors.len() == data.positions.len() {
            let colors = list(&|v| data.colors[at(v)].to_vec());
            attributes["COLOR_0"] = self.floats(&colors, 4, false).into();
        }
        if data.tangents.len() == data.positions.len() {
            let tangents = list(&|v| data.tangents[at(v)].to_vec());
            attributes["TANGENT"] = self.floats(&tangents, 4, false).into();
        }
        let bytes: Vec<u8> = order.iter().flat_map(|i| i.to_le_bytes()).collect();
        let view = self.view(&bytes, Some(INDICES));
        let indices = json!({ "bufferView": view, "componentType": UNSIGNED, "count": order.len(), "type": "SCALAR" });
        let indices = self.add("accessors", indices);
        Some(json!({ "attributes": attributes, "indices": indices }))
    }

    /// Writes rows of `width` numbers, and returns the index of their accessor.
    fn floats(&mut self, values: &[f32], width: usize, bounds: bool) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes, Some(VERTICES));
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][width - 1];
        let count = values.len() / width;
        let mut accessor = json!({ "bufferView": view, "componentType": FLOAT, "count": count, "type": kind });
        if bounds {
            let over = |fold: fn(f32, f32) -> f32| -> Vec<f32> {
                let column = |c: usize| values.iter().skip(c).step_by(width).copied().reduce(fold);
                (0..width).filter_map(column).collect()
            };
            (accessor["min"], accessor["max"]) = (json!(over(f32::min)), json!(over(f32::max)));
        }
        self.add("accessors", accessor)
    }
}

/// Returns true if any of the vertex colours is not opaque.
fn has_vertex_alpha(data: &MeshData) -> bool {
    data.colors.iter().any(|color| color[3] < 1.0)
}

/// Builds a list of vertices and the indices that refer to it. Returns a vertex index for each
/// corner of a triangle. For each vertex, also returns the indices of its position, its texture
/// coordinates and its normal.
fn welded(data: &MeshData, triangle_normals: &[[u32; 3]]) -> (Vec<u32>, Vec<[u32; 3]>) {
    let (mut cached, mut vertices) = (HashMap::new(), Vec::new());
    let own = |list: &[[u32; 3]], i: usize, k: usize| list.get(i).map_or(NO_INDEX, |corners| corners[k]);
    let mut order = Vec::with_capacity(3 * data.triangles.len());
    for (i, triangle) in data.triangles.iter().enumerate() {
        for (k, corner) in triangle.iter().enumerate() {
            let vertex = [*corner, own(&data.triangle_uvs, i, k), own(triangle_normals, i, k)];
            order.push(*cached.entry(vertex).or_insert_with(|| {
                vertices.push(vertex);
                vertices.len() as u32 - 1
            }));
        }
    }
    (order, vertices)
}
