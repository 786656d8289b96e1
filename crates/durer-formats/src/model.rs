//! What a format of scenes is: how its files are known, read and written.

use durer_diag::{Diagnostics, Files};
use durer_scene::dialect::MeshNormals;
use durer_scene::scene::{Axis, Scene, Staging};
use durer_scene::source::AssetSource;
use std::cell::RefCell;
use std::sync::Arc;

/// A format of files that hold scenes, or models that become scenes.
pub struct SceneFormat {
    /// Its name for people.
    pub name: &'static str,
    /// Endings of its files' names, in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Whether a file that begins with these bytes is of this format, whatever its name.
    pub recognise: fn(&[u8]) -> bool,
    /// Reads a file. Errors go into the collection, and then there is no scene.
    pub read: fn(&Input, &mut Diagnostics) -> Option<Scene>,
    /// Writes a scene; what the format has no words for is warned of. `None`: it is read only.
    pub write: Option<WriteScene>,
    /// What is up in most models of this format.
    pub up: Axis,
    /// Whether what has a camera is a whole scene, to which no light is added.
    pub whole: bool,
    /// What would shine in a scene that is dark, in words of the format; `None`: of ours.
    pub shines: Option<&'static str>,
}

/// Writes a scene.
pub type WriteScene = fn(&Scene, &Output, &mut Diagnostics) -> Vec<u8>;

/// What a writer needs beside the scene.
pub struct Output<'a> {
    /// The name of the file, with ending.
    pub name: &'a str,
    /// Reads the files that the scene names.
    pub source: &'a dyn AssetSource,
    /// How triangles without normals are meant.
    pub normals: MeshNormals,
    /// Bytes that one of its pictures may take while it is decoded.
    pub memory: u64,
}

/// A file that is to become a scene.
pub struct Input<'a> {
    /// Its bytes.
    pub bytes: &'a Arc<[u8]>,
    /// Its number in `files`, for spans.
    pub file: u32,
    /// The texts that were read, to which a reader adds those of further files.
    pub files: &'a RefCell<Files>,
    /// Its last name, with ending.
    pub name: &'a str,
    /// Reads the files that it names.
    pub source: &'a dyn AssetSource,
    /// How it is to be shown.
    pub staging: &'a Staging,
    /// Bytes that one of its pictures may take while it is decoded.
    pub memory: u64,
}
