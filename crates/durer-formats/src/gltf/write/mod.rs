//! Writer of scenes as glTF 2.0, either as a self-contained JSON file or as a binary file.
//!
//! Source: *glTF 2.0 Specification*, Khronos Group, 2021, and the extensions named in the
//! submodules. Content that glTF cannot represent is reported once for each message, and the report
//! has no span.

mod material;
mod mesh;
mod picture;

#[cfg(test)]
mod tests;

use crate::export::Export;
use crate::model::{WriteContext, Written};
use base64::Engine;
use durer_diag::Diagnostics;
use durer_scene::camera::{Camera, Projection};
use durer_scene::describe::DescribedKind;
use durer_scene::dialect::Dialect;
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::{MatrixOp, MatrixRules, Object, ObjectKind, Scene};
use durer_scene::shape::{MeshData, Shape as _};
use glam::{DAffine3, DMat3, DMat4, DVec3};
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::f32::consts::PI;

/// Writer that converts one scene to glTF, and collects its JSON arrays and its binary buffer.
struct Writer<'a> {
    scene: &'a Scene,
    output: &'a WriteContext<'a>,
    export: Export<'a>,
    buffer: Vec<u8>,
    /// Top-level arrays of the glTF file, by name.
    lists: BTreeMap<&'static str, Vec<Value>>,
    extensions: BTreeSet<&'static str>,
    /// Items that have already been written, by their source: geometries, meshes with materials,
    /// materials, textures and images.
    geometries: BTreeMap<String, Option<Value>>,
    meshes: BTreeMap<(String, Option<u32>), usize>,
    materials: BTreeMap<u32, Option<usize>>,
    textures: BTreeMap<String, Option<Value>>,
    images: BTreeMap<String, Option<usize>>,
    lights: Vec<Value>,
}

/// Encodes a scene as binary glTF if the file name ends in `.glb`, and otherwise as JSON.
pub(crate) fn write(scene: &Scene, output: &WriteContext, diagnostics: &mut Diagnostics) -> Written {
    let mut writer = Writer {
        scene,
        output,
        export: Export::new(scene, output, diagnostics),
        buffer: Vec::new(),
        lists: BTreeMap::new(),
        extensions: BTreeSet::new(),
        geometries: BTreeMap::new(),
        meshes: BTreeMap::new(),
        materials: BTreeMap::new(),
        textures: BTreeMap::new(),
        images: BTreeMap::new(),
        lights: Vec::new(),
    };
    let mut roots: Vec<usize> = Vec::new();
    for object in scene.root.iter().flat_map(|root| &root.objects) {
        roots.extend(writer.object(object));
    }
    roots.extend(writer.camera());
    for light in scene.lights.iter().flatten() {
        roots.extend(writer.light(&light.value));
    }
    writer.surroundings();
    Written { bytes: writer.file(&roots), files: Vec::new() }
}

impl Writer<'_> {
    /// Warns about content that is lost or changed, once for each message.
    fn warn_lost(&mut self, message: impl Into<String>) {
        self.export.warn_lost(message);
    }

    /// Appends a value to a top-level array and returns its index.
    fn add(&mut self, list: &'static str, value: Value) -> usize {
        let list = self.lists.entry(list).or_default();
        list.push(value);
        list.len() - 1
    }

    /// Appends bytes to the buffer and returns the index of a buffer view for them.
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        self.buffer.resize(self.buffer.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.buffer.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.buffer.extend_from_slice(bytes);
        self.add("bufferViews", view)
    }

    /// Writes the node of an object. Returns `None` if the object has no visible content.
    fn object(&mut self, object: &Object) -> Option<usize> {
        match &object.node {
            ObjectKind::Group(group) => {
                let children: Vec<usize> = group.objects.iter().filter_map(|object| self.object(object)).collect();
                (!children.is_empty()).then(|| self.add("nodes", json!({ "children": children })))
            }
            ObjectKind::Transform(ops, inner) => {
                let child = self.object(inner)?;
                let map = MatrixOp::product(ops, MatrixRules::default());
                let own = self.lists.get("nodes").is_some_and(|nodes| nodes[child].get("matrix").is_none());
                if own {
                    // The node does not have a matrix yet, so the transform can be stored in it.
                    if let Some(node) = self.lists.get_mut("nodes").and_then(|nodes| nodes.get_mut(child)) {
                        node["matrix"] = columns(map);
                    }
                    return Some(child);
                }
                Some(self.add("nodes", json!({ "children": [child], "matrix": columns(map) })))
            }
            ObjectKind::Mesh(mesh) => {
                let name = mesh.obj_file.path.clone();
                let data = self.export.mesh_data(&name)?;
                self.shown(name, &data, object.material)
            }
            ObjectKind::Primitive(primitive) => {
                let Some(data) = primitive.to_mesh() else {
                    let name = DescribedKind::keyword(primitive, Dialect::Durer);
                    self.warn_lost(format!("glTF has triangles only: `{name}` is left out"));
                    return None;
                };
                self.shown(format!("{primitive:?}"), &data, object.material)
            }
            ObjectKind::Voxels(..) | ObjectKind::HeightField(_) | ObjectKind::Solid(..) => {
                self.warn_lost("glTF has triangles only: solids, grids and height fields are left out");
                None
            }
        }
    }

    fn shown(&mut self, name: String, data: &MeshData, material: Option<u32>) -> Option<usize> {
        let mesh = self.mesh(name, data, material)?;
        Some(self.add("nodes", json!({ "mesh": mesh })))
    }

    /// Writes the node of the camera and returns its index.
    fn camera(&mut self) -> Option<usize> {
        let camera = self.scene.camera.as_ref()?;
        let pose = camera.pose();
        // Angles and sizes in a Dürer scene are measured across the larger side of the picture, but
        // in glTF they are measured across its height.
        let aspect = self.scene.render_defaults.size.map_or(1.0, |(width, height)| width as f32 / height as f32);
        let narrow = aspect.max(1.0);
        let upright = |angle: f32| {
            let half = fp::tan_f64(f64::from(angle).to_radians() / 2.0) / f64::from(narrow);
            2.0 * fp::atan_f64(half)
        };
        let view = match camera {
            Camera::Orthographic(flat) => {
                let half = flat.size / 2.0;
                let ymag = half / narrow;
                let xmag = if aspect < 1.0 { half * aspect } else { half };
                json!({ "type": "orthographic", "orthographic": { "xmag": xmag, "ymag": ymag, "znear": 0.0, "zfar": 1e6 } })
            }
            other => {
                let angle = match other {
                    Camera::Perspective(plain) => plain.angle,
                    Camera::ThinLens(lens) => {
                        self.warn_lost("glTF cameras have no lens: depth of field and shift are left out");
                        lens.angle
                    }
                    _ => {
                        self.warn_lost("glTF has no camera of this kind: a perspective camera is written");
                        60.0
                    }
                };
                let mut lens = json!({ "yfov": upright(angle), "znear": 1e-3 });
                if self.scene.render_defaults.size.is_some() {
                    lens["aspectRatio"] = aspect.into();
                }
                json!({ "type": "perspective", "perspective": lens })
            }
        };
        let camera = self.add("cameras", view);
        let place = look_transform(pose.center, pose.direction, pose.up);
        Some(self.add("nodes", json!({ "camera": camera, "matrix": columns(place) })))
    }

    /// Writes the node of a light with KHR_lights_punctual, and returns the index of the node.
    fn light(&mut self, light: &Light) -> Option<usize> {
        let light = &light.with_unit_color();
        let (mut written, center, direction) = match light {
            Light::Point(point) => {
                if point.attenuation != Some(Vec3::Z) {
                    self.warn_lost(
                        "glTF lights always fall off with the squared distance: other attenuation is left out",
                    );
                }
                (json!({ "type": "point" }), point.position, Vec3::NEG_Z)
            }
            Light::Directional(far) => (json!({ "type": "directional" }), Vec3::ZERO, far.direction),
            Light::Spot(spot) => {
                let outer = spot.angle.min(90.0).to_radians();
                let inner = spot.inner_angle.to_radians().min(outer - 1e-4).max(0.0);
                let cone = json!({ "innerConeAngle": inner, "outerConeAngle": outer });
                (json!({ "type": "spot", "spot": cone }), spot.position, spot.direction)
            }
            Light::Photometric(_) => {
                self.warn_lost("lights of this kind have no counterpart in glTF");
                return None;
            }
        };
        // The intensities of glTF are photometric, and a white matte surface reflects 1 / pi of the
        // incident light in each direction.
        let color = light.color();
        let most = color.max_element();
        if most <= 0.0 {
            return None;
        }
        written["color"] = json!((color / most).to_array());
        written["intensity"] = (most * PI).into();
        self.extensions.insert("KHR_lights_punctual");
        self.lights.push(written);
        let up = direction.normalize_or(Vec3::NEG_Z).any_orthogonal_vector();
        let place = look_transform(center, direction, up);
        let light = json!({ "KHR_lights_punctual": { "light": self.lights.len() - 1 } });
        Some(self.add("nodes", json!({ "extensions": light, "matrix": columns(place) })))
    }

    fn surroundings(&mut self) {
        let background = &self.scene.background;
        if background.environment.is_some() || background.sun().is_some() || background.cie_sky.is_some() {
            self.warn_lost("glTF has no environment light: it is left out");
        } else if background.color != Vec3::ZERO && background != &durer_scene::scene::Background::default() {
            self.warn_lost("glTF has no background: its colour and light are left out");
        }
        if self.scene.fog.is_some() {
            self.warn_lost("glTF has no fog: it is left out");
        }
    }

    /// Puts the parts of the glTF file together.
    fn file(mut self, roots: &[usize]) -> Vec<u8> {
        let mut root = Map::new();
        root.insert(
            "asset".into(),
            json!({ "version": "2.0", "generator": concat!("Dürer ", env!("CARGO_PKG_VERSION")) }),
        );
        if !self.extensions.is_empty() {
            root.insert("extensionsUsed".into(), json!(self.extensions));
        }
        if !self.lights.is_empty() {
            root.insert("extensions".into(), json!({ "KHR_lights_punctual": { "lights": self.lights } }));
        }
        root.insert("scene".into(), 0.into());
        root.insert("scenes".into(), json!([if roots.is_empty() { json!({}) } else { json!({ "nodes": roots }) }]));
        for (name, list) in std::mem::take(&mut self.lists) {
            root.insert(name.into(), list.into());
        }
        self.buffer.resize(self.buffer.len().next_multiple_of(4), 0);
        let binary = self.output.name.to_lowercase().ends_with(".glb");
        if !self.buffer.is_empty() {
            let mut buffer = json!({ "byteLength": self.buffer.len() });
            if !binary {
                let text = base64::engine::general_purpose::STANDARD.encode(&self.buffer);
                buffer["uri"] = format!("data:application/octet-stream;base64,{text}").into();
            }
            root.insert("buffers".into(), json!([buffer]));
        }
        let root = Value::Object(root);
        if !binary {
            let mut text = format!("{root:#}").into_bytes();
            text.push(b'\n');
            return text;
        }
        let mut text = root.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        container(&text, &self.buffer)
    }
}

/// Builds a GLB file that has two chunks. Source: *glTF 2.0 Specification*, chapter 4.4.
fn container(text: &[u8], buffer: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(28 + text.len() + buffer.len());
    let word = |bytes: &mut Vec<u8>, word: u32| bytes.extend(word.to_le_bytes());
    let rest = if buffer.is_empty() { 0 } else { 8 + buffer.len() };
    bytes.extend(b"glTF");
    word(&mut bytes, 2);
    word(&mut bytes, (20 + text.len() + rest) as u32);
    word(&mut bytes, text.len() as u32);
    bytes.extend(b"JSON");
    bytes.extend(text);
    if !buffer.is_empty() {
        word(&mut bytes, buffer.len() as u32);
        bytes.extend(b"BIN\0");
        bytes.extend(buffer);
    }
    bytes
}

/// Returns a matrix as sixteen numbers in column-major order.
fn columns(map: DAffine3) -> Value {
    json!(DMat4::from(map).to_cols_array().map(|x| x as f32))
}

/// Returns the transform of a camera or light that looks along its own -z axis, with y up.
fn look_transform(center: Vec3, direction: Vec3, up: Vec3) -> DAffine3 {
    let back = -direction.as_dvec3().normalize_or(DVec3::NEG_Z);
    let right = up.as_dvec3().cross(back).normalize_or(back.any_orthonormal_vector());
    DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: center.as_dvec3() }
}
