//! glTF 2.0: cameras as nodes, points as a mesh of points, in one file.
//!
//! glTF's cameras look down -z with y up, have no distortion, and their middle is the principal point: what a lens has beyond
//! that is not written. The world is turned upside down by no one: y of the world stays y.
//!
//! Source: Khronos, *glTF 2.0 Specification*, sections 3.10 and 5.12.

use super::opposite;
use crate::model::quaternion_of;
use crate::{Error, Reconstruction};
use serde_json::{Value, json};

/// Base 64 (RFC 4648).
pub(super) fn base64(bytes: &[u8]) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for chunk in bytes.chunks(3) {
        let bits = (0..3).fold(0, |bits, i| bits << 8 | u32::from(*chunk.get(i).unwrap_or(&0)));
        for i in 0..4 {
            let sign = SIGNS[(bits >> (18 - 6 * i)) as usize & 63];
            text.push(if i <= chunk.len() { char::from(sign) } else { '=' });
        }
    }
    text
}

/// Writes cameras and points.
pub fn write(all: &Reconstruction) -> Result<Vec<u8>, Error> {
    let (mut nodes, mut cameras) = (Vec::new(), Vec::new());
    for view in &all.views {
        let Some(pose) = &view.pose else { continue };
        let lens = &all.lenses[view.lens];
        let [width, height] = lens.size.map(f64::from);
        if width == 0.0 || height == 0.0 {
            return Err(Error::new("glTF's cameras need the size of the photographs: name their folder"));
        }
        let yfov = 2.0 * libm::atan(height / (2.0 * lens.focal * lens.aspect));
        let aspect = width * lens.aspect / height;
        let perspective = json!({"yfov": yfov, "aspectRatio": aspect, "znear": 0.01});
        nodes.push(json!({
            "name": view.name, "camera": cameras.len(), "translation": pose.center().as_slice(),
            "rotation": rotation(&opposite(pose)),
        }));
        cameras.push(json!({"name": view.name, "type": "perspective", "perspective": perspective}));
    }
    let mut gltf = json!({"asset": {"version": "2.0", "generator": "durer photo"}, "scene": 0});
    let mut put = |name: &str, value: Value| gltf[name] = value;
    if !all.points.is_empty() {
        let count = all.points.len();
        nodes.push(json!({"name": "points", "mesh": 0}));
        let positions = || all.points.iter().map(|point| point.position.map(|value| value as f32));
        let mut bytes: Vec<u8> = positions().flat_map(|p| [p.x, p.y, p.z]).flat_map(f32::to_le_bytes).collect();
        all.points.iter().for_each(|point| bytes.extend([point.color[0], point.color[1], point.color[2], 255]));
        let bound = |pick: fn(f32, f32) -> f32| {
            let first = positions().next().unwrap_or_default();
            positions().fold(first, |a, b| a.zip_map(&b, pick)).as_slice().to_vec()
        };
        put("meshes", json!([{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}, "mode": 0}]}]));
        put(
            "accessors",
            json!([
                {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3", "min": bound(f32::min), "max": bound(f32::max)},
                {"bufferView": 1, "componentType": 5121, "normalized": true, "count": count, "type": "VEC4"},
            ]),
        );
        let (positions, colors) = (12 * count, 4 * count);
        put(
            "bufferViews",
            json!([
                {"buffer": 0, "byteOffset": 0, "byteLength": positions},
                {"buffer": 0, "byteOffset": positions, "byteLength": colors},
            ]),
        );
        let uri = format!("data:application/octet-stream;base64,{}", base64(&bytes));
        put("buffers", json!([{"byteLength": bytes.len(), "uri": uri}]));
    }
    put("scenes", json!([{"nodes": (0..nodes.len()).collect::<Vec<_>>()}]));
    put("nodes", json!(nodes));
    if !cameras.is_empty() {
        put("cameras", json!(cameras));
    }
    serde_json::to_vec_pretty(&gltf).map_err(|error| Error::new(error.to_string()))
}

/// glTF's quaternion (x, y, z, w) from the camera's frame to the world.
fn rotation(pose: &crate::Pose) -> [f64; 4] {
    let [w, x, y, z] = quaternion_of(&pose.rotation.transpose());
    [x, y, z, w]
}
