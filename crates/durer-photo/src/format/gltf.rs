//! glTF 2.0 files with cameras as nodes and points as a point mesh, in JSON (`.gltf`) or binary
//! (`.glb`) form.
//!
//! glTF cameras look along -z with y up. They have no distortion, and their principal point is the
//! image centre. All other lens parameters and the size of the photographs are stored in `extras`,
//! which other programs ignore. Without `extras`, photographs are assumed to have 1000 rows. The
//! world axes of glTF are the same as those of this crate.
//!
//! Source: Khronos, *glTF 2.0 Specification*, sections 3.6, 3.10, 4.4 and 5.12.

use super::flip_camera_axes;
use crate::model::{nearest_rotation, quaternion_of, rotation_of_quaternion};
use crate::{Error, Lens, Point, Pose, Reconstruction, View};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use nalgebra::{Matrix3, Matrix4, Vector3};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// Number of rows that is assumed for a photograph of unknown size.
const DEFAULT_HEIGHT: f64 = 1000.0;

/// Parts of a glTF file's JSON that are read.
#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct File {
    nodes: Vec<Node>,
    cameras: Vec<Camera>,
    meshes: Vec<Mesh>,
    accessors: Vec<Accessor>,
    buffer_views: Vec<BufferView>,
    buffers: Vec<Buffer>,
}

/// glTF node: a transform with an optional camera or mesh, and child nodes.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Node {
    name: Option<String>,
    children: Vec<usize>,
    camera: Option<usize>,
    mesh: Option<usize>,
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

/// glTF camera. Orthographic cameras have no `perspective` and are ignored.
#[derive(Deserialize)]
struct Camera {
    name: Option<String>,
    perspective: Option<Perspective>,
    #[serde(default)]
    extras: Value,
}

/// Field of view and aspect ratio of a glTF perspective camera.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Perspective {
    yfov: f64,
    aspect_ratio: Option<f64>,
}

/// Lens parameters that a glTF camera lacks, stored in its `extras`.
#[derive(Serialize, Deserialize)]
struct Extras {
    width: u32,
    height: u32,
    center: [f64; 2],
    radial: [f64; 2],
}

/// glTF mesh, of which only points are read.
#[derive(Deserialize)]
struct Mesh {
    primitives: Vec<Primitive>,
}

/// Part of a glTF mesh, in which all elements have the same topology.
#[derive(Deserialize)]
struct Primitive {
    attributes: Attributes,
    /// Topology of the primitive: 0 for points, absent for triangles.
    mode: Option<u32>,
}

/// Indices of the accessors for the positions and colours of a primitive.
#[derive(Deserialize)]
struct Attributes {
    #[serde(rename = "POSITION")]
    position: Option<usize>,
    #[serde(rename = "COLOR_0")]
    color: Option<usize>,
}

/// glTF accessor, which gives the type and number of the elements in a buffer view.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Accessor {
    buffer_view: Option<usize>,
    #[serde(default)]
    byte_offset: usize,
    component_type: u32,
    count: usize,
    #[serde(rename = "type")]
    shape: String,
}

/// glTF buffer view, which is a range of bytes in a buffer.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct BufferView {
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
}

/// glTF buffer. It is a data URI, or the binary chunk of a `.glb` file if `uri` is absent.
#[derive(Deserialize)]
struct Buffer {
    uri: Option<String>,
}

/// Reads the cameras and points of a glTF file and ignores everything else. The format contains no
/// observations.
pub fn read(name: &str, bytes: &[u8]) -> Result<Reconstruction, Error> {
    let fail = |why: String| Error::in_file(name, why);
    let (json, binary) =
        chunks(bytes).ok_or_else(|| fail("the binary glTF file is truncated or is not version 2".into()))?;
    let file: File = serde_json::from_slice(json)
        .map_err(|error| Error::at(name, (error.line(), error.column()), format!("invalid glTF JSON: {error}")))?;
    let mut reconstruction = Reconstruction::default();
    let mut buffers = vec![None; file.buffers.len()];
    for (i, world) in world_transforms(&file).map_err(fail)? {
        let node = &file.nodes[i];
        if let Some(number) = node.camera {
            let camera =
                file.cameras.get(number).ok_or_else(|| fail(format!("node {i}: camera {number} does not exist")))?;
            // Orthographic cameras have no centre of projection.
            let Some(perspective) = &camera.perspective else { continue };
            let lens = lens(perspective, &camera.extras).map_err(|why| fail(format!("camera {number}: {why}")))?;
            let pose = pose(&world)
                .ok_or_else(|| fail(format!("node {i}: a camera cannot be scaled to zero, or mirrored")))?;
            let named = node.name.as_ref().or(camera.name.as_ref());
            let name = named.cloned().unwrap_or_else(|| reconstruction.views.len().to_string());
            let known = reconstruction.lenses.iter().position(|known| *known == lens);
            reconstruction.views.push(View {
                name,
                lens: known.unwrap_or(reconstruction.lenses.len()),
                pose: Some(pose),
            });
            reconstruction.lenses.extend(known.is_none().then_some(lens));
        }
        let mesh = node.mesh.map(|number| {
            file.meshes.get(number).ok_or_else(|| fail(format!("node {i}: mesh {number} does not exist")))
        });
        for primitive in mesh.transpose()?.iter().flat_map(|mesh| &mesh.primitives).filter(|one| one.mode == Some(0)) {
            let mut column = |number| column(&file, &mut buffers, binary, number).map_err(fail);
            let Some(positions) = primitive.attributes.position.map(&mut column).transpose()? else { continue };
            let colors = primitive.attributes.color.map(&mut column).transpose()?;
            if colors.as_ref().is_some_and(|colors| colors.len() != positions.len()) {
                return Err(fail(format!("node {i}: the numbers of colours and points differ")));
            }
            // A mesh can be instanced many times.
            if reconstruction.points.len() + positions.len() > bytes.len() {
                return Err(fail("there are more points than the file has bytes: meshes are used too often".into()));
            }
            for (k, place) in positions.iter().enumerate() {
                let position = (world * place.insert_row(3, 1.0)).xyz();
                let shade = |value: f64| (255.0 * value).round().clamp(0.0, 255.0) as u8;
                let color = colors.as_ref().map_or([128; 3], |colors| colors[k].map(shade).into());
                reconstruction.points.push(Point { position, color, track: Vec::new() });
            }
        }
    }
    Ok(reconstruction)
}

/// Splits a file into its JSON and, if the file is binary, its data chunk.
fn chunks(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    if !bytes.starts_with(b"glTF") {
        return Some((bytes, &[]));
    }
    let number = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    let json = bytes.get(20..)?.get(..number(12)?).filter(|_| number(4) == Some(2))?;
    let next = 20 + json.len();
    let binary = match number(next) {
        Some(length) => bytes.get(next + 8..)?.get(..length)?,
        None => &[],
    };
    Some((json, binary))
}

/// Returns the indices and world transforms of all nodes, with parents before their children.
fn world_transforms(file: &File) -> Result<Vec<(usize, Matrix4<f64>)>, String> {
    let count = file.nodes.len();
    let mut is_child = vec![false; count];
    for child in file.nodes.iter().flat_map(|node| &node.children) {
        match is_child.get_mut(*child) {
            None => return Err(format!("node {child} does not exist")),
            Some(true) => return Err(format!("node {child} has two parents")),
            Some(known) => *known = true,
        }
    }
    let mut all: Vec<_> = (0..count).filter(|i| !is_child[*i]).map(|i| (i, local(&file.nodes[i]))).collect();
    let mut next = 0;
    while let Some((parent, world)) = all.get(next).copied() {
        all.extend(file.nodes[parent].children.iter().map(|child| (*child, world * local(&file.nodes[*child]))));
        next += 1;
    }
    // Nodes that are their own ancestors are never reached from a root node.
    if all.len() == count { Ok(all) } else { Err("some nodes are their own ancestors".into()) }
}

/// Returns the transform of a node relative to its parent.
fn local(node: &Node) -> Matrix4<f64> {
    if let Some(matrix) = node.matrix {
        return Matrix4::from_column_slice(&matrix);
    }
    let [x, y, z, w] = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let scale = Matrix3::from_diagonal(&node.scale.unwrap_or([1.0; 3]).into());
    let mut matrix = (rotation_of_quaternion([w, x, y, z]) * scale).to_homogeneous();
    matrix.fixed_view_mut::<3, 1>(0, 3).copy_from(&Vector3::from(node.translation.unwrap_or_default()));
    matrix
}

/// Converts the world transform of a camera node to a pose. Scaling does not affect cameras.
fn pose(world: &Matrix4<f64>) -> Option<Pose> {
    let axes = world.fixed_view::<3, 3>(0, 0).into_owned();
    let is_turn = axes.determinant() > 0.0 && world.iter().all(|value| value.is_finite());
    let center = world.fixed_view::<3, 1>(0, 3).into_owned();
    is_turn.then(|| flip_camera_axes(&Pose::at(&center, nearest_rotation(&axes).transpose())))
}

fn lens(perspective: &Perspective, extras: &Value) -> Result<Lens, String> {
    let half = libm::tan(perspective.yfov / 2.0);
    let ratio = perspective.aspect_ratio.unwrap_or(1.0);
    if !(0.0..std::f64::consts::PI).contains(&perspective.yfov) || half <= 0.0 || !(ratio.is_finite() && ratio > 0.0) {
        return Err("`yfov` or `aspectRatio` is out of range".into());
    }
    let beyond = match &extras["lens"] {
        Value::Null => None,
        lens => Some(Extras::deserialize(lens).map_err(|error| format!("`extras.lens` is invalid ({error})"))?),
    };
    let Some(beyond) = beyond else {
        let size = [(DEFAULT_HEIGHT * ratio).round().clamp(1.0, 1e6), DEFAULT_HEIGHT];
        return Ok(Lens::new(size.map(|side| side as u32), DEFAULT_HEIGHT / (2.0 * half)));
    };
    let vertical = f64::from(beyond.height) / (2.0 * half);
    let aspect = ratio * f64::from(beyond.height) / f64::from(beyond.width);
    // Remove rounding errors, so that square pixels have an aspect ratio of exactly 1.
    let aspect = if (aspect - 1.0).abs() < 1e-12 { 1.0 } else { aspect };
    let size = [beyond.width, beyond.height];
    if size.contains(&0) {
        return Err("`extras.lens` has a size of 0".into());
    }
    Ok(Lens { size, focal: vertical / aspect, aspect, principal_point: beyond.center, distortion: beyond.radial })
}

/// Reads the first three components of a vertex attribute. Integers are divided by their maximum
/// value.
fn column(
    file: &File,
    buffers: &mut [Option<Vec<u8>>],
    binary: &[u8],
    number: usize,
) -> Result<Vec<Vector3<f64>>, String> {
    let fail = |why: &str| format!("accessor {number} {why}");
    let accessor = file.accessors.get(number).ok_or_else(|| fail("does not exist"))?;
    let width = match &*accessor.shape {
        "VEC3" => 3,
        "VEC4" => 4,
        _ => return Err(fail("must have the type VEC3 or VEC4")),
    };
    let size = match accessor.component_type {
        5121 => 1,
        5123 => 2,
        5126 => 4,
        _ => return Err(fail("has a component type that is not allowed for positions and colours")),
    };
    let view = accessor.buffer_view.and_then(|view| file.buffer_views.get(view)).ok_or_else(|| fail("has no bytes"))?;
    let buffer = file.buffers.get(view.buffer).ok_or_else(|| fail("has no buffer"))?;
    let bytes = match &buffer.uri {
        None => binary,
        Some(uri) => {
            let packed = uri.split_once(";base64,").filter(|(kind, _)| kind.starts_with("data:"));
            let packed = packed.ok_or_else(|| fail("has its bytes in another file, which is not supported"))?.1;
            if buffers[view.buffer].is_none() {
                let decoded = STANDARD.decode(packed);
                let decoded = decoded.map_err(|error| fail(&format!("has invalid base64 data ({error})")))?;
                buffers[view.buffer] = Some(decoded);
            }
            buffers[view.buffer].as_deref().unwrap_or_default()
        }
    };
    let short = || fail("has incomplete bytes");
    let bytes = bytes.get(view.byte_offset..).and_then(|bytes| bytes.get(..view.byte_length)).ok_or_else(short)?;
    let bytes = bytes.get(accessor.byte_offset..).ok_or_else(short)?;
    let stride = view.byte_stride.unwrap_or(width * size).max(1);
    // Limit the allocation to the size of the data.
    if accessor.count > bytes.len() {
        return Err(short());
    }
    let mut rows = Vec::new();
    for row in 0..accessor.count {
        let row = row.checked_mul(stride).and_then(|start| bytes.get(start..)?.get(..3 * size)).ok_or_else(short)?;
        let value = |i: usize| match row[i * size..(i + 1) * size] {
            [a] => f64::from(a) / 255.0,
            [a, b] => f64::from(u16::from_le_bytes([a, b])) / 65535.0,
            [a, b, c, d] => f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => f64::NAN,
        };
        rows.push(Vector3::from_fn(|i, _| value(i)));
    }
    match rows.iter().flatten().all(|value| value.is_finite()) {
        true => Ok(rows),
        false => Err(fail("contains NaN or infinity")),
    }
}

/// Writes cameras and points to one self-contained glTF file.
pub fn write(reconstruction: &Reconstruction) -> Result<Vec<u8>, Error> {
    let (mut nodes, mut cameras) = (Vec::new(), Vec::new());
    for view in &reconstruction.views {
        let Some(pose) = &view.pose else { continue };
        let lens = &reconstruction.lenses[view.lens];
        let [width, height] = lens.size.map(f64::from);
        if width == 0.0 || height == 0.0 {
            return Err(Error::new("glTF cameras need the size of the photographs: pass their folder"));
        }
        let yfov = 2.0 * libm::atan(height / (2.0 * lens.focal * lens.aspect));
        let aspect = width * lens.aspect / height;
        let perspective = json!({"yfov": yfov, "aspectRatio": aspect, "znear": 0.01});
        nodes.push(json!({
            "name": view.name, "camera": cameras.len(), "translation": pose.center().as_slice(),
            "rotation": rotation(&flip_camera_axes(pose)),
        }));
        let ([width, height], center, radial) = (lens.size, lens.principal_point, lens.distortion);
        let extras = json!({"lens": Extras { width, height, center, radial }});
        cameras.push(json!({"name": view.name, "type": "perspective", "perspective": perspective, "extras": extras}));
    }
    let mut gltf = json!({"asset": {"version": "2.0", "generator": "durer photo"}, "scene": 0});
    let mut put = |name: &str, value: Value| gltf[name] = value;
    if !reconstruction.points.is_empty() {
        let count = reconstruction.points.len();
        nodes.push(json!({"name": "points", "mesh": 0}));
        let positions = || reconstruction.points.iter().map(|point| point.position.map(|value| value as f32));
        let mut bytes: Vec<u8> = positions().flat_map(|p| [p.x, p.y, p.z]).flat_map(f32::to_le_bytes).collect();
        reconstruction
            .points
            .iter()
            .for_each(|point| bytes.extend([point.color[0], point.color[1], point.color[2], 255]));
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
        let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&bytes));
        put("buffers", json!([{"byteLength": bytes.len(), "uri": uri}]));
    }
    put("scenes", json!([{"nodes": (0..nodes.len()).collect::<Vec<_>>()}]));
    put("nodes", json!(nodes));
    if !cameras.is_empty() {
        put("cameras", json!(cameras));
    }
    serde_json::to_vec_pretty(&gltf).map_err(|error| Error::new(error.to_string()))
}

/// Returns the glTF quaternion (x, y, z, w) of the rotation from the camera frame to the world.
fn rotation(pose: &Pose) -> [f64; 4] {
    let [w, x, y, z] = quaternion_of(&pose.rotation.transpose());
    [x, y, z, w]
}
