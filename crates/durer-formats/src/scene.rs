//! Readers of scene files; [`SCENE_FORMATS`] contains one entry for each format. A mesh file is
//! read as a scene with one mesh.

use super::model::SceneFormat;
pub use super::model::{ReadInput, WriteContext, WriteScene, Written};
use super::pictures::picture_error;
use super::signature::wrong_format_error;
use super::{MeshFormat, extension, obj, off, panorama, ply, read_mesh, sticks, stl};
use durer_diag::{Diagnostic, Diagnostics, Span};
use durer_image::{self as image, Encoded, ImageError};
use durer_scene::describe::FileName;
use durer_scene::light::{Illuminate as _, Light};
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::defaults::ModelAxes;
use durer_scene::scene::{Axis, Background, Group, Object, PictureBytes, Scene, Spanned, TextureImage};
use durer_scene::source::SourceError;
use durer_scene::texture::Mapping;
use glam::DVec3;
use std::path::Path;
use std::sync::Arc;

/// Scene formats, in the order in which the content of a file is checked for them. A file in none
/// of these formats is assumed to be in the scene language.
pub const SCENE_FORMATS: &[SceneFormat] = &[
    #[cfg(feature = "gltf")]
    here(super::gltf::FORMAT),
    #[cfg(feature = "pbrt")]
    here(super::pbrt::FORMAT),
    #[cfg(feature = "mitsuba")]
    here(super::mitsuba::FORMAT),
    #[cfg(feature = "collada")]
    here(super::collada::FORMAT),
    // A USD package is also a ZIP archive, so its extension decides.
    #[cfg(feature = "usd")]
    here(super::usd::FORMAT),
    #[cfg(feature = "threemf")]
    here(super::threemf::FORMAT),
    #[cfg(feature = "radiance")]
    here(super::radiance::FORMAT),
    single_mesh_format(&ply::FORMAT),
    obj::scene::FORMAT,
    single_mesh_format(&stl::FORMAT),
    single_mesh_format(&off::FORMAT),
];

/// Returns a format as it is available on the target. The page in the browser does not convert
/// scenes, and its library is smaller without the writers.
const fn here(format: SceneFormat) -> SceneFormat {
    match cfg!(target_arch = "wasm32") {
        true => SceneFormat { write: None, ..format },
        false => format,
    }
}

/// Returns the scene format for files that contain a single mesh.
const fn single_mesh_format(format: &MeshFormat) -> SceneFormat {
    let MeshFormat { name, extensions, recognise, up, .. } = *format;
    SceneFormat {
        name,
        extensions,
        recognise,
        read: one_mesh,
        write: None,
        up,
        is_complete_scene: false,
        light_hint: None,
    }
}

/// Maximum height in pixels of an environment map that is resampled for another up axis.
const MAX_ROWS: u32 = 2048;

/// Returns the scene format that a file name indicates by its extension.
pub fn scene_format_for(name: &str) -> Option<&'static SceneFormat> {
    let extension = extension(name);
    SCENE_FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str()))
}

/// Returns the writer of the format that a file name indicates by its extension. Returns `None` if
/// files with this extension are only read.
pub fn scene_writer_for(name: &str) -> Option<WriteScene> {
    // Of USD, only text is written.
    scene_format_for(name)?.write.filter(|_| !matches!(extension(name).as_str(), "usdc" | "usdz"))
}

/// Returns the format of a model, which is determined by the extension of its name or, if that is
/// unknown, by its content. Returns `None` if the file is in the scene language or if its format is
/// unknown.
pub fn find_scene_format(bytes: &[u8], name: &str) -> Option<&'static SceneFormat> {
    scene_format_for(name).or_else(|| SCENE_FORMATS.iter().find(|format| (format.recognise)(bytes)))
}

/// Returns an error if a file is to be read in one format (`None` means the scene language) but its
/// first bytes show another.
pub fn other_format(bytes: &[u8], file: u32, name: &str, format: Option<&SceneFormat>) -> Option<Diagnostic> {
    wrong_format_error(bytes, file, name, format.map_or(&[], |format| format.extensions))
}

/// Reads a model as a scene, and adds a camera, lights and a material if they are missing.
pub fn read_model(format: &SceneFormat, input: &ReadInput, diagnostics: &mut Diagnostics) -> Option<Scene> {
    let mut scene = (format.read)(input, diagnostics)?;
    let up = input.scene_defaults.up.or(scene.up).unwrap_or(format.up);
    scene.up = Some(up);
    if let Some(path) = &input.scene_defaults.view_file {
        let (name, bytes) = read_option_file(input, path, diagnostics)?;
        set_view(&mut scene, input, &name, &bytes, diagnostics)?;
    }
    if let Some(path) = &input.scene_defaults.environment {
        let (name, bytes) = read_option_file(input, path, diagnostics)?;
        let rotation = input.scene_defaults.environment_rotation.unwrap_or(0.0);
        let surrounded = set_environment(&mut scene, (&name, bytes), (up, rotation), input.memory);
        surrounded.map_err(|error| diagnostics.push(picture_error(&name, &error))).ok()?;
    }
    if !input.scene_defaults.convert_only {
        input.scene_defaults.complete(&mut scene, up, format.is_complete_scene);
    }
    Some(scene)
}

/// Sets the camera of a scene to the last view in a Radiance file. Returns `None` if there are
/// errors.
#[cfg(feature = "radiance")]
fn set_view(
    scene: &mut Scene,
    input: &ReadInput,
    name: &str,
    bytes: &Arc<[u8]>,
    diagnostics: &mut Diagnostics,
) -> Option<()> {
    let report = super::radiance::set_view(scene, input, (name, bytes));
    let is_sound = !report.has_errors();
    diagnostics.extend(report);
    is_sound.then_some(())
}

/// Reports that Radiance's view files are not supported by this build.
#[cfg(not(feature = "radiance"))]
fn set_view(_: &mut Scene, _: &ReadInput, name: &str, _: &Arc<[u8]>, diagnostics: &mut Diagnostics) -> Option<()> {
    diagnostics.push(Diagnostic::error(format!(
        "`{name}` cannot be used, because this build does not read views of Radiance"
    )));
    None
}

/// Reads a file that an option names; the file may be at any path. Returns the name and the bytes
/// of the file.
fn read_option_file(input: &ReadInput, path: &Path, diagnostics: &mut Diagnostics) -> Option<(String, Arc<[u8]>)> {
    let read = input.source.read_user_file(path);
    let refuse = |error: SourceError| diagnostics.push(Diagnostic::error(error.to_string()).code("missing-file"));
    Some((path.display().to_string(), read.map_err(refuse).ok()?))
}

/// Reads a mesh file as a scene that contains one mesh without a material.
fn one_mesh(input: &ReadInput, diagnostics: &mut Diagnostics) -> Option<Scene> {
    let span = Span { file: input.file, start: 0, end: 0 };
    let mut own = Diagnostics::default();
    let data = read_mesh(input.bytes, input.file, input.name, &mut own);
    // A point cloud is shown as small balls, so it needs no triangles.
    own.retain(|diagnostic| diagnostic.code != super::ply::POINT_CLOUD);
    diagnostics.extend(own);
    let data = data?;
    input.files.borrow_mut().truncate(input.file, 0, diagnostics);
    let data = if data.triangles.is_empty() && !data.positions.is_empty() {
        // A file that has vertices but no faces is a point cloud.
        let points: Vec<u32> = (0..data.positions.len() as u32).collect();
        let note = Diagnostic::note(sticks::message(0, points.len())).code("points-and-lines");
        diagnostics.push(note.at(span));
        sticks::sticks_and_balls(&data, &[], &points)
    } else {
        data
    };
    let mut scene = Scene::default();
    let node = scene.add_mesh(input.name, Arc::new(data), span);
    scene.root = Some(Group { objects: vec![Object { node, material: None, span }] });
    Some(scene)
}

/// Replaces the background and the directional lights with an environment map, whose upper edge
/// points in the direction `up`.
fn set_environment(
    scene: &mut Scene,
    (name, bytes): (&str, Arc<[u8]>),
    (up, rotation): (Axis, f32),
    memory: u64,
) -> Result<(), ImageError> {
    scene.background = Background { color: Vec3::ZERO, ..Background::default() };
    let near = |light: &Spanned<Light>| light.value.position().is_some();
    scene.lights.get_or_insert_default().retain(near);
    let decoded = || Encoded::open(&bytes, name).and_then(|encoded| encoded.read(memory, image::decode_srgb));
    let sides = ModelAxes::new(up);
    let (sin, cos) = fp::sin_cos_degrees(f64::from(rotation));
    let turned = |dir: DVec3| {
        let [x, y, z] = [sides.right, sides.up, sides.front].map(|side| dir.dot(side));
        DVec3::new(x * cos + z * sin, y, z * cos - x * sin)
    };
    // If a picture cannot be decoded, the error is reported when the scene is compiled.
    if let Some(picture) = (up != Axis::Y).then(decoded).and_then(Result::ok) {
        let light = |dir: DVec3| panorama::nearest(&picture, turned(dir));
        let memory = panorama::remaining_memory([&picture], memory);
        return panorama::set_environment(scene, (name, Span::default()), picture.height.min(MAX_ROWS), memory, light);
    }
    let picture = TextureImage { bytes: PictureBytes::Memory(name.to_string(), bytes), mapping: Mapping::default() };
    scene.assets.pictures.insert(name.to_string(), picture);
    scene.background.environment = Some(FileName { path: name.to_string(), span: Span::default() });
    scene.background.environment_rotation = (rotation != 0.0).then_some(rotation);
    Ok(())
}
