//! Description of a scene format: how to recognise, read and write its files.

use durer_diag::{Diagnostics, Files};
use durer_scene::dialect::MeshNormals;
use durer_scene::scene::{Axis, Scene, SceneDefaults};
use durer_scene::source::AssetSource;
use std::cell::RefCell;
use std::sync::Arc;

/// File format of scenes, or of models that are converted to scenes: its name, extensions, reader
/// and writer.
pub struct SceneFormat {
    /// Display name.
    pub name: &'static str,
    /// File name extensions in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Returns true if a file that begins with these bytes has this format, whatever its name.
    pub recognise: fn(&[u8]) -> bool,
    /// Reads a file. Returns `None` after pushing errors to the diagnostics.
    pub read: fn(&ReadInput, &mut Diagnostics) -> Option<Scene>,
    /// Writes a scene; warns about content that the format cannot represent. `None` if the format
    /// is read-only.
    pub write: Option<WriteScene>,
    /// Up axis of most models of this format.
    pub up: Axis,
    /// True if a file with a camera is a complete scene, so that no light is added to it.
    pub is_complete_scene: bool,
    /// Help text for a scene without light: what to add to a file of this format. `None` if the
    /// words of the scene language apply.
    pub light_hint: Option<&'static str>,
}

/// Function that encodes a scene as a file.
pub type WriteScene = fn(&Scene, &WriteContext, &mut Diagnostics) -> Vec<u8>;

/// Input of a scene writer besides the scene itself: the file's name, the asset source and some
/// settings.
pub struct WriteContext<'a> {
    /// Name of the file with its extension.
    pub name: &'a str,
    /// Source of the files named by the scene.
    pub source: &'a dyn AssetSource,
    /// Shading of triangles without normals.
    pub normals: MeshNormals,
    /// Memory limit in bytes for decoding one picture.
    pub memory: u64,
}

/// Input of a scene reader: the bytes of a file, and the context needed to read it as a scene.
pub struct ReadInput<'a> {
    /// Bytes of the file.
    pub bytes: &'a Arc<[u8]>,
    /// Index of the file in `files`, for spans.
    pub file: u32,
    /// Registered texts. A reader adds further files that it reads.
    pub files: &'a RefCell<Files>,
    /// File name with its extension, without its folder.
    pub name: &'a str,
    /// Source of the files named by the scene.
    pub source: &'a dyn AssetSource,
    /// Options for turning a model into a scene, such as its up axis and view.
    pub scene_defaults: &'a SceneDefaults,
    /// Memory limit in bytes for decoding one picture.
    pub memory: u64,
}
