//! Description of a scene format: how to recognise, read and write its files.

use durer_diag::{Diagnostics, Files};
use durer_scene::dialect::MeshNormals;
use durer_scene::scene::{Axis, Scene, SceneDefaults};
use durer_scene::source::AssetSource;
use std::cell::RefCell;
use std::sync::Arc;

/// A file format of scenes, or of models that become scenes.
pub struct SceneFormat {
    /// Display name.
    pub name: &'static str,
    /// File name extensions in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Returns true if a file with these first bytes is of this format, whatever its name.
    pub recognise: fn(&[u8]) -> bool,
    /// Reads a file. Returns `None` after pushing errors to the diagnostics.
    pub read: fn(&Input, &mut Diagnostics) -> Option<Scene>,
    /// Writes a scene; warns about what the format cannot represent. `None`: the format is
    /// read-only.
    pub write: Option<WriteScene>,
    /// Up axis of most models of this format.
    pub up: Axis,
    /// True if a file with a camera is a complete scene, to which no light is added.
    pub whole: bool,
    /// The format's words for what could light a dark scene, for messages; `None`: the scene
    /// language's words.
    pub light_hint: Option<&'static str>,
}

/// Function that writes a scene.
pub type WriteScene = fn(&Scene, &Output, &mut Diagnostics) -> Vec<u8>;

/// Context of a writer, beside the scene.
pub struct Output<'a> {
    /// Name of the file with its extension.
    pub name: &'a str,
    /// Source of the files that the scene names.
    pub source: &'a dyn AssetSource,
    /// Shading of triangles without normals.
    pub normals: MeshNormals,
    /// Memory limit in bytes for decoding one picture.
    pub memory: u64,
}

/// A file to read as a scene.
pub struct Input<'a> {
    /// Bytes of the file.
    pub bytes: &'a Arc<[u8]>,
    /// Index of the file in `files`, for spans.
    pub file: u32,
    /// Registered texts; a reader adds the further files that it reads.
    pub files: &'a RefCell<Files>,
    /// File name with its extension, without its folder.
    pub name: &'a str,
    /// Source of the files that the scene names.
    pub source: &'a dyn AssetSource,
    /// Defaults for what the scene lacks.
    pub scene_defaults: &'a SceneDefaults,
    /// Memory limit in bytes for decoding one picture.
    pub memory: u64,
}
