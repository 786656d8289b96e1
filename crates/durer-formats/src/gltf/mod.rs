//! Reader and writer of glTF 2.0 (`.gltf` and `.glb`): scenes with nodes, meshes, materials,
//! textures, cameras, lights, skins and animations.
//!
//! Source: *glTF 2.0 Specification*, Khronos Group, 2021, and the extensions named in the
//! submodules. Errors have the codes of the Khronos glTF validator, and their messages include the
//! JSON pointer.

mod accessor;
mod animation;
mod buffers;
mod camera;
mod container;
mod deform;
mod draco;
mod flat;
mod json;
mod material;
mod meshopt;
mod nodes;
mod primitive;
mod texture;
mod variants;
mod write;

use super::growth::{LimitExceeded, ResourceLimits};
use super::model::{ReadInput, SceneFormat};
use super::report::Report;
use accessor::Accessor;
use buffers::{Buffer, BufferView};
use camera::{CameraData, LightData};
use container::{Parts, open, recognise};
use deform::Skin;
use durer_diag::{Diagnostic, Diagnostics, Span};
use durer_scene::material::PrincipledMaterial;
use durer_scene::scene::{Axis, Material, PictureBytes, Scene, Spanned, TextureImage};
use durer_scene::texture::Mapping;
use json::{JsonRef, JsonReport};
use primitive::Primitives;
use serde_json::Value;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use write::write;

/// Extensions that a file is allowed to require. The reader warns about the parts of an extension
/// that it does not support.
const SUPPORTED_EXTENSIONS: [&str; 24] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "KHR_node_visibility",
];

/// Contents of a glTF file during reading: its buffers, images, meshes and other arrays, in the
/// order in which they are read.
struct Model<'a> {
    input: &'a ReadInput<'a>,
    report: &'a JsonReport<'a>,
    parts: Parts,
    /// True if the file uses KHR_mesh_quantization, which allows integer attributes.
    quantized: bool,
    buffers: Vec<Option<Buffer>>,
    views: Vec<Option<BufferView>>,
    accessors: Vec<Option<Accessor>>,
    images: Vec<Option<PictureBytes>>,
    /// Picture of each texture, its mapping, and the span of the picture's name.
    textures: Vec<Option<(PictureBytes, Mapping, Span)>>,
    /// Texture images of the materials, by asset name.
    pictures: RefCell<BTreeMap<String, TextureImage>>,
    material_count: usize,
    /// Index of the selected material variant, if the file has any variants.
    variant: Option<usize>,
    /// Flag for each material, which is true if the alpha of the material makes it translucent.
    translucent: Vec<bool>,
    /// Flag for each material, which is true if any of the vertices that use the material have
    /// colours.
    colored: Vec<bool>,
    /// Flag for each material, which is true if the material needs tangents.
    needs_tangents: Vec<bool>,
    /// JSON pointers to the textures of materials that use the second set of texture coordinates.
    second_sets: RefCell<Vec<String>>,
    meshes: Vec<Primitives>,
    /// Default weights of the morph targets of each mesh.
    weights: Vec<Vec<f32>>,
    skins: Vec<Option<Skin>>,
    cameras: Vec<Option<CameraData>>,
    lights: Vec<Option<LightData>>,
    /// Amount of decoded data, which is counted every time the data is used. The limit on this
    /// amount keeps time and memory in proportion to the size of the file.
    work: ResourceLimits,
    /// Number of objects, and number of bytes of data that stay in memory.
    kept: ResourceLimits,
    /// Codes of the warnings that have been reported.
    reported: RefCell<BTreeSet<&'static str>>,
}

/// Entry for glTF in the list of scene formats.
pub(super) const FORMAT: SceneFormat = SceneFormat {
    name: "glTF",
    extensions: &["gltf", "glb"],
    recognise,
    read,
    write: Some(write),
    up: Axis::Y,
    is_complete_scene: false,
    light_hint: None,
};

/// Reads a file; see [`read_model`](super::scene::read_model).
fn read(input: &ReadInput, diagnostics: &mut Diagnostics) -> Option<Scene> {
    let mut report = Report::new(input.file, diagnostics);
    let Some(parts) = open(input.bytes, input.name, &mut report) else {
        report.finish(diagnostics, ());
        return None;
    };
    let text = &input.bytes[parts.json.clone()];
    let mut end = parts.json.end;
    if parts.is_glb {
        // Report the lines and columns of the JSON text inside the binary file.
        report.finish(diagnostics, ());
        let mut files = input.files.borrow_mut();
        let name = files.name(input.file).unwrap_or(input.name).to_string();
        report = Report::new(files.add(name, text.into()), diagnostics);
        end = 0;
    }
    let value = match serde_json::from_slice::<Value>(text) {
        Ok(value) => value,
        Err(error) => {
            let line: usize =
                text.split_inclusive(|&b| b == b'\n').take(error.line().max(1) - 1).map(<[u8]>::len).sum();
            let at = (line + error.column().saturating_sub(1)).min(text.len());
            let message = error.to_string();
            let message = message.split(" at line ").next().unwrap_or_default();
            report.add(at..at, Diagnostic::error(format!("invalid JSON: {message}")).code("INVALID_JSON"));
            report.finish(diagnostics, ());
            return None;
        }
    };
    let findings = JsonReport::new(text, report);
    let scene = scene(input, parts, JsonRef::root(&value, &findings));
    let scene = findings.finish().finish(diagnostics, scene)?;
    input.files.borrow_mut().truncate(input.file, end, diagnostics);
    scene
}

fn scene(input: &ReadInput, parts: Parts, root: JsonRef) -> Option<Scene> {
    root.object()?;
    check_version(&root)?;
    report_unlisted_extensions(&root);
    let quantized = required(&root);
    if root.report.has_errors() {
        return None;
    }
    let mut model = Model {
        input,
        report: root.report,
        parts,
        quantized,
        buffers: Vec::new(),
        views: Vec::new(),
        accessors: Vec::new(),
        images: Vec::new(),
        textures: Vec::new(),
        pictures: RefCell::default(),
        material_count: 0,
        variant: None,
        translucent: Vec::new(),
        colored: Vec::new(),
        needs_tangents: Vec::new(),
        second_sets: RefCell::default(),
        meshes: Vec::new(),
        weights: Vec::new(),
        skins: Vec::new(),
        cameras: Vec::new(),
        lights: Vec::new(),
        work: ResourceLimits::of_file(0, u64::MAX),
        kept: ResourceLimits::with_memory(input.memory),
        reported: RefCell::default(),
    };
    // Each step depends on the results of the steps before it.
    model.buffers = model.buffers(&root);
    let slices = model.buffers.iter().flatten().filter_map(|buffer| buffer.slice.as_ref());
    let bytes: u64 = slices.map(|slice| slice.bytes().len() as u64).sum();
    model.work.add_input(bytes as usize);
    model.views = model.views(&root);
    model.accessors = model.accessors(&root);
    model.unpack_primitives(&root);
    model.images = model.images(&root);
    model.textures = model.textures(&root);
    model.colored = Model::colored(&root);
    let materials = model.materials(&root);
    model.material_count = materials.len();
    model.variant = model.chosen_variant(&root);
    let alpha =
        |at: &JsonRef| at.get("alphaMode").and_then(|mode| mode.value.as_str()).is_some_and(|mode| mode != "OPAQUE");
    let of_materials = |what: &dyn Fn(&JsonRef) -> bool| match root.get("materials") {
        Some(materials) => materials.items().map(|material| what(&material)).collect(),
        None => Vec::new(),
    };
    model.translucent = of_materials(&alpha);
    model.needs_tangents = of_materials(&material::needs_tangents);
    model.meshes = model.meshes(&root);
    model.weights = match root.get("meshes") {
        Some(meshes) => meshes.items().map(|mesh| mesh.list("weights", |w| w.number().unwrap_or(0.0))).collect(),
        None => Vec::new(),
    };
    model.skins = model.read_skins(&root);
    model.cameras = model.read_cameras(&root);
    model.lights = model.read_lights(&root);
    let mut nodes = model.read_nodes(&root);
    if root.report.has_errors() {
        return None;
    }
    let animations = model.animations(&root);
    model.animate(&root, &mut nodes, &animations);
    if root.report.has_errors() {
        return None;
    }
    let (order, maps) = model.world_transforms(&root, &nodes);
    let camera = model.camera(&order, &nodes, &maps);
    let camera_span = match camera {
        Some((_, node)) => root.report.node(node),
        None => root.span(),
    };
    let camera_names = model.camera_names(&order, &nodes);
    let mut scene =
        Scene { camera: camera.map(|(camera, _)| camera), camera_span, camera_names, animations, ..Scene::default() };
    let spanned = |(i, m): (usize, PrincipledMaterial)| Spanned {
        value: Material::Principled(Box::new(m)),
        span: root.report.span(&format!("/materials/{i}")),
    };
    scene.materials = materials.into_iter().enumerate().map(spanned).collect();
    for &i in &order {
        model.add_mesh(i, &nodes, &maps, &mut scene);
        model.light(i, &nodes[i], maps[i], &mut scene);
    }
    scene.assets.pictures = model.pictures.take();
    if scene.root.is_none() && !root.report.has_errors() {
        let number = root.get("scene").and_then(|number| number.value.as_u64()).unwrap_or(0);
        let at = format!("/scenes/{number}");
        let left_out = (0..nodes.len()).find(|i| nodes[*i].mesh.is_some() && !order.contains(i));
        let message = match left_out {
            Some(node) => {
                format!("the scene has no visible triangles: node {node} has a mesh, but is not in the scene")
            }
            None => "the scene has no visible triangles".to_string(),
        };
        root.report.report(Diagnostic::warning, "no-objects", &at, &message);
    } else {
        model.report_nodes_without_scene(&root, &nodes);
    }
    Some(scene)
}

/// Rejects versions other than 2.
fn check_version(root: &JsonRef) -> Option<()> {
    let asset = root.required("asset")?;
    asset.object()?;
    let version = asset.required("version")?;
    let number = |text: &str| text.split_once('.').and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
    let Some((major, minor)): Option<(u32, u32)> = number(version.string()?) else {
        version.error("PATTERN_MISMATCH", "a version must have the form `2.0`");
        return None;
    };
    if major != 2 {
        let message = format!("glTF version {major}.{minor} is not supported, only version 2");
        version.error("UNKNOWN_ASSET_MAJOR_VERSION", message);
        return None;
    }
    if let Some(least) = asset.get("minVersion")
        && let Some(wanted) = number(least.string()?)
    {
        if wanted > (major, minor) {
            least.error("ASSET_MIN_VERSION_GREATER_THAN_VERSION", "`minVersion` is greater than `version`");
        } else if wanted > (2, 0) {
            least.warning("UNKNOWN_ASSET_MINOR_VERSION", "only version 2.0 of glTF is supported");
        }
    }
    Some(())
}

/// Rejects required extensions that are not supported. Returns true if attributes may be quantized.
fn required(root: &JsonRef) -> bool {
    let mut quantized = false;
    for key in ["extensionsUsed", "extensionsRequired"] {
        let mut names = BTreeSet::new();
        root.list(key, |at| {
            let name = at.string().unwrap_or_default().to_string();
            quantized |= name == "KHR_mesh_quantization";
            if key == "extensionsRequired" && !SUPPORTED_EXTENSIONS.contains(&name.as_str()) {
                let tool = match name.as_str() {
                    "KHR_meshopt_compression" => {
                        "; convert the file with `gltf-transform copy`, which removes the compression"
                    }
                    "KHR_texture_basisu" => "; convert the file's pictures to PNG with `ktx extract`",
                    _ => "",
                };
                at.error("UNSUPPORTED_EXTENSION", format!("the file requires {name}, which is not supported{tool}"));
            }
            if !names.insert(name) {
                at.error("DUPLICATE_ELEMENTS", "this name is listed twice");
            }
        });
    }
    quantized
}

/// Reports extensions that the file uses without listing them.
fn report_unlisted_extensions(root: &JsonRef) {
    let listed: Vec<&str> =
        root.value["extensionsUsed"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    let (mut rest, mut unlisted) = (vec![root.value], BTreeSet::new());
    while let Some(value) = rest.pop() {
        match value {
            Value::Array(items) => rest.extend(items),
            Value::Object(fields) => {
                let own = fields.get("extensions").and_then(Value::as_object);
                unlisted
                    .extend(own.into_iter().flat_map(|own| own.keys()).filter(|name| !listed.contains(&name.as_str())));
                // Extras can contain anything.
                rest.extend(fields.iter().filter(|(name, _)| *name != "extras").map(|(_, field)| field));
            }
            _ => {}
        }
    }
    for name in unlisted {
        let message =
            format!("the file uses {name}, but `extensionsUsed` does not list it: other programs may ignore it");
        root.report.report(Diagnostic::note, "UNDECLARED_EXTENSION", "", &message);
    }
}

impl Model<'_> {
    /// Reports a warning only once for the whole file.
    fn once(&self, code: &'static str, message: &str) {
        self.once_at(code, "", message);
    }

    /// Reports a warning only once, at the first place to which it applies.
    fn once_at(&self, code: &'static str, pointer: &str, message: &str) {
        if self.reported.borrow_mut().insert(code) {
            self.report.report(Diagnostic::warning, code, pointer, message);
        }
    }

    /// Counts decoded data towards the memory limit, which is proportional to the size of the file.
    fn charge(&self, count: usize, size: usize, at: &JsonRef) -> Option<()> {
        self.charge_at(count, size, &|| at.pointer())
    }

    fn charge_at(&self, count: usize, size: usize, pointer: &dyn Fn() -> String) -> Option<()> {
        let counted = self.work.bytes(count, size);
        if counted.is_err() {
            let message = "the file repeats its data so often that they exceed the memory limit";
            self.report.report(Diagnostic::error, "too-large", &pointer(), message);
        }
        counted.ok()
    }

    /// Counts bytes of data that stay in memory.
    fn count_kept(&self, count: usize, size: usize, at: &JsonRef) -> Option<()> {
        self.report_limit(self.kept.bytes(count, size), &|| at.pointer())
    }

    /// Reports that a limit was exceeded, but only when this happens for the first time.
    fn report_limit(&self, counted: Result<(), LimitExceeded>, pointer: &dyn Fn() -> String) -> Option<()> {
        let found = counted.map_err(|LimitExceeded { message, is_first }| {
            if is_first {
                self.report.report(Diagnostic::error, "too-large", &pointer(), &message);
            }
        });
        found.ok()
    }

    /// Returns all rows of an accessor.
    fn rows<const N: usize>(&self, accessor: &Accessor, at: &JsonRef) -> Option<Vec<[f32; N]>> {
        self.rows_as(accessor, at, |row| row)
    }

    /// Returns all rows of an accessor after applying `of` to each of them.
    fn rows_as<const N: usize, T: Send>(
        &self,
        accessor: &Accessor,
        at: &JsonRef,
        of: impl Fn([f32; N]) -> T + Sync + Send,
    ) -> Option<Vec<T>> {
        self.charge(accessor.count, 4 * N, at)?;
        self.count_kept(accessor.count, size_of::<T>(), at)?;
        Some(accessor.rows(of))
    }
}

#[cfg(test)]
mod tests;
