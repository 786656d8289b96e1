//! Description of a scene format, which says how to recognise, read, and write files in this
//! format.

use super::asset_export::AssetFile;
use durer_diag::{Diagnostics, Files};
use durer_scene::dialect::MeshNormals;
use durer_scene::scene::{Axis, Scene, SceneDefaults};
use durer_scene::source::AssetSource;
use std::cell::RefCell;
use std::sync::Arc;

/// File format of scenes, or of models that are converted to scenes, with its name, extensions,
/// reader, and writer.
pub struct SceneFormat {
    /// Name of the format for display.
    pub name: &'static str,
    /// File name extensions in lower case, without the leading dot.
    pub extensions: &'static [&'static str],
    /// Returns true if a file that begins with these bytes is in this format, regardless of its
    /// name.
    pub recognise: fn(&[u8]) -> bool,
    /// Reads a file. If there are errors, adds them to the diagnostics and returns `None`.
    pub read: fn(&ReadInput, &mut Diagnostics) -> Option<Scene>,
    /// Writes a scene, and warns about content that the format cannot represent. `None` if the
    /// format is read-only.
    pub write: Option<WriteScene>,
    /// Up axis that most models in this format use.
    pub up: Axis,
    /// True if a file that contains a camera is a complete scene, to which no light is added.
    pub is_complete_scene: bool,
    /// Help text for a scene without light, which says what to add to a file in this format. `None`
    /// if the help text for the scene language applies.
    pub light_hint: Option<&'static str>,
}

/// Function that encodes a scene as a file, and as other files beside it.
pub type WriteScene = fn(&Scene, &WriteContext, &mut Diagnostics) -> Written;

/// Scene as a file, with the files that it refers to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Written {
    /// Bytes of the scene file.
    pub bytes: Vec<u8>,
    /// Meshes and pictures beside the scene. All of them are in one folder, which has the name of
    /// the scene file without its extension.
    pub files: Vec<AssetFile>,
}

/// Input of a scene writer other than the scene itself: the name of the file, the asset source, and
/// some settings.
pub struct WriteContext<'a> {
    /// Name of the file with its extension.
    pub name: &'a str,
    /// Source of the files that the scene refers to.
    pub source: &'a dyn AssetSource,
    /// Shading of triangles that have no normals.
    pub normals: MeshNormals,
    /// True if the 8-bit values of the textures of Phong materials are in sRGB encoding.
    pub srgb_textures: bool,
    /// Memory limit in bytes for decoding one picture.
    pub memory: u64,
}

/// Input of a scene reader: the bytes of a file, and the context needed to read them as a scene.
pub struct ReadInput<'a> {
    /// Bytes of the file.
    pub bytes: &'a Arc<[u8]>,
    /// Index of the file in `files`, which spans refer to.
    pub file: u32,
    /// Registered texts. If the reader opens other files, it adds them here.
    pub files: &'a RefCell<Files>,
    /// Name of the file with its extension but without its folder.
    pub name: &'a str,
    /// Source of the files that the scene refers to.
    pub source: &'a dyn AssetSource,
    /// Options for turning a model into a scene, such as its up axis and view.
    pub scene_defaults: &'a SceneDefaults,
    /// Memory limit in bytes for decoding one picture.
    pub memory: u64,
}
